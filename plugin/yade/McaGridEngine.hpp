// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "McaMat.hpp"
#include "McaSolverEngine.hpp"
#include "grid/grid.hpp"
#include <core/Timing.hpp>
#include <sdk/Blob.hpp>

namespace yade {

class McaGridEngine : public McaSolverEngine {
public:
	void step() override;
	Real criticalTimeStep() const override;
	bool carriesRows() const override { return carries; }
	bool setsStep() const override { return adaptive && !dead; }
	bool usesStep() const override { return true; }
	void stepIsSet() override { adaptive = false; }
	/// A row is tied to it from now on.
	void carry() { carries = true; }
	void preSave(McaGridEngine&);
	void postLoad(McaGridEngine&);

	// the two halves of a step, for the coupler; both use scene->dt
	void             computeForces(Scene* scene);
	void             integrate(Scene* scene);
	mca::grid::Grid& grid();

	// Python: set-up
	int  addRectangle(shared_ptr<Material> material, py::object xs, py::object ys, const string& name, Real hourglass, bool edgeViscosity);
	int  addBlock(shared_ptr<Material> material, py::object x, py::object y, const string& name, Real hourglass, bool edgeViscosity);
	void openInteriorNode(int block, int i, int j)
	{
		locked([&] { grid().openInteriorNode(block, i, j); });
	}
	int openNode(int block, int i, int j)
	{
		return locked([&] { return grid().openNode(block, i, j); });
	}
	py::list sideNodes(int block, const string& side, int start, int end);
	void fix(int block, const string& side, bool x, bool y, int start, int end);
	void fixNodes(py::object nodes, bool x, bool y);
	void symmetry(int block, const string& side);
	void prescribe(int block, const string& side, py::object vx, py::object vy, int start, int end);
	void prescribeNodes(py::object nodes, const Vector2r& direction, py::object velocity);
	void traction(int block, const string& side, py::object x, py::object y, int start, int end);
	void pressureLoad(int block, const string& side, py::object p, int start, int end);
	void viscous(int block, const string& side, int start, int end);
	void force(py::object nodes, py::object fx, py::object fy);
	void setVelocity(int block, py::object velocity);
	void setCells(int block, py::object stress, py::object plasticStrain, py::object temperature);
	int  addGauge(const Vector2r& at, int period);
	// Python: reading
	py::object view(int block, const string& what);
	py::object gaugeHistory(int k);
	py::dict   probeLine(const Vector2r& from, const Vector2r& to, int n);
	py::dict   energies();
	py::list   blockList();
	string     criticalCell()
	{
		return locked([&] { return grid().criticalCell(); });
	}
	Real awake() const
	{
		return locked([&] { return solver ? solver->awakeFraction() : 0.; });
	}
	Real time() const
	{
		return locked([&] { return solver ? solver->time() : 0.; });
	}
	long steps() const
	{
		return locked([&] { return solver ? solver->steps() : 0L; });
	}
	long       cellCount() const;

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(McaGridEngine, McaSolverEngine,
		"Lagrangian grid in plane strain (x, y), per 1 m of thickness: structured blocks of quadrilateral cells with the materials of "
		":yref:`McaMat`. Compatible staggered scheme "
		"(Caramana, Burton, Shashkov and Whalen 1998) with Wilkins' (1964) strength, Hughes-Winget rotation, Flanagan-Belytschko hourglass "
		"stiffness: energy and momentum are exact to round-off. "
		"Add blocks first, then boundaries, velocities and gauges. Blocks whose sides touch share the nodes there. "
		"Sides are 'bottom' (first row of nodes), 'right', 'top', 'left' (first column). A velocity, traction or force is a number or a pair (times "
		"[s], values), piecewise linear in time.",
		((bool, account, true, , "keep internal energy, works and impulses; read when the first block is added, never again"))
		((bool, sleeping, true, , "leave out cells that nothing has reached; changes no result, bit for bit; read when the first block is added, "
		    "never again"))
		((bool, adaptive, true, , "set O.dt in every step to dtFactor times the largest stable one, growing at most 10 % a step; otherwise O.dt is "
		    "checked only; read in every step"))
		((Real, dtFactor, 0.6, , "share of the largest stable time step [-], 0 < dtFactor <= 1; read in every step"))
		((bool, carries, false, Attr::hidden, "rows of automata are tied to it"))
		((sdk::Blob, state, , Attr::hidden, "state of the solver"))
		,
		timingDeltas = shared_ptr<TimingDeltas>(new TimingDeltas);
		,
		.def("addRectangle", &McaGridEngine::addRectangle, (py::arg("material"), py::arg("xs"), py::arg("ys"), py::arg("name") = "",
		    py::arg("hourglass") = 1., py::arg("edgeViscosity") = false), "Block on the grid lines xs, ys (rising, [m]); returns its number. "
		        "hourglass: multiplier of the exact stiffness of the bilinear square [-], 0 to 4. edgeViscosity: edge viscosity with limiter instead "
		        "of the scalar one.")
		.def("addBlock", &McaGridEngine::addBlock, (py::arg("material"), py::arg("x"), py::arg("y"), py::arg("name") = "", py::arg("hourglass") = 1.,
		    py::arg("edgeViscosity") = false), "Block with nodes at x, y, arrays (rows+1, cells per row+1) [m], cells counter-clockwise; returns its "
		        "number.")
		.def("openInteriorNode", &McaGridEngine::openInteriorNode, (py::arg("block"), py::arg("i"), py::arg("j")), "Makes node i of row j off the "
		    "sides one that can be held or loaded; call right after the blocks.")
		.def("openNode", &McaGridEngine::openNode, (py::arg("block"), py::arg("i"), py::arg("j")), "Number of the open node at (i, j), -1 when it is "
		    "none.")
		.def("sideNodes", &McaGridEngine::sideNodes, (py::arg("block"), py::arg("side"), py::arg("start") = 0, py::arg("end") = -1), "Numbers of the "
		    "open nodes of a side, in order of rising i or j, start to end inclusive.")
		.def("fix", &McaGridEngine::fix, (py::arg("block"), py::arg("side"), py::arg("x") = true, py::arg("y") = true, py::arg("start") = 0,
		    py::arg("end") = -1), "Holds the nodes start to end of a side.")
		.def("fixNodes", &McaGridEngine::fixNodes, (py::arg("nodes"), py::arg("x") = true, py::arg("y") = true), "Holds open nodes.")
		.def("symmetry", &McaGridEngine::symmetry, (py::arg("block"), py::arg("side")), "Nodes of a straight side move in its line only.")
		.def("prescribe", &McaGridEngine::prescribe, (py::arg("block"), py::arg("side"), py::arg("x") = py::object(), py::arg("y") = py::object(),
		    py::arg("start") = 0, py::arg("end") = -1), "Prescribes velocity components [m/s] on a side; None leaves a component free.")
		.def("prescribeNodes", &McaGridEngine::prescribeNodes, (py::arg("nodes"), py::arg("direction"), py::arg("velocity")), "Prescribes the "
		    "velocity [m/s] of open nodes along a direction.")
		.def("traction", &McaGridEngine::traction, (py::arg("block"), py::arg("side"), py::arg("x") = 0., py::arg("y") = 0., py::arg("start") = 0,
		    py::arg("end") = -1), "Traction [Pa] per rest length on the edges between nodes start and end of a side.")
		.def("pressure", &McaGridEngine::pressureLoad, (py::arg("block"), py::arg("side"), py::arg("value"), py::arg("start") = 0,
		    py::arg("end") = -1), "Pressure [Pa] normal to the present outline.")
		.def("viscous", &McaGridEngine::viscous, (py::arg("block"), py::arg("side"), py::arg("start") = 0, py::arg("end") = -1), "Transmitting "
		    "boundary of Lysmer and Kuhlemeyer (1969): traction -rho cP v_n n - rho cS v_t.")
		.def("force", &McaGridEngine::force, (py::arg("nodes"), py::arg("x") = 0., py::arg("y") = 0.), "Force [N/m] on each of the open nodes.")
		.def("setVelocity", &McaGridEngine::setVelocity, (py::arg("block"), py::arg("velocity")), "Initial velocity [m/s]: a pair for the whole "
		    "block or an array (rows+1, cells per row+1, 2). Shared nodes get the mean weighted by mass.")
		.def("setCells", &McaGridEngine::setCells, (py::arg("block"), py::arg("stress") = py::object(), py::arg("plasticStrain") = py::object(),
		    py::arg("temperature") = py::object()), "Initial state of the cells of a block, before the first step. stress [Pa], positive in "
		    "tension: xx, yy, "
		    "xy (zz follows from Hooke's law in plane strain) or xx, yy, xy, zz, one row for all cells or an array (rows, cells, 3 or 4); "
		    "plasticStrain [-] and temperature "
		    "[K]: a number or an array (rows, cells); None: as it is. Nodes stay where they are and keep their masses: the areas at rest become "
		    "those under which the cells "
		    "have this pressure. Raises RuntimeError after the first step, above the yield stress, for another number of values, for a temperature "
		    "where no "
		    "flow stress depends on it, and for a stress with eos='mieGruneisen'.")
		.def("addGauge", &McaGridEngine::addGauge, (py::arg("at"), py::arg("period") = 1), "Records the history of the point at (x, y) [m] every "
		    "period steps; returns its number.")
		.def("gauge", &McaGridEngine::gaugeHistory, (py::arg("number")), "History of a gauge, numpy (n, 10): time [s], x, y [m] and pressure [Pa] "
		    "(column 5) at that time, vx, vy [m/s] half a step before it, s_xx, s_yy, s_xy [Pa] (deviatoric) and plastic strain [-] one step before "
		    "it.")
		.def("probeLine", &McaGridEngine::probeLine, (py::arg("start"), py::arg("end"), py::arg("n")), "Present values at n points of a line, dict "
		    "of numpy (m,): x, y, vx, vy, pressure, sxx, syy, sxy, plasticStrain; points outside are left out.")
		.def("view", &McaGridEngine::view, (py::arg("block"), py::arg("what")), "Read-only numpy view without a copy. Nodes (rows+1, cells+1): 'x', "
		    "'y' [m], 'vx', 'vy' [m/s]. Cells (rows, cells): 'sxx', 'syy', 'sxy' deviatoric [Pa], 'plasticStrain' [-], 'restArea' [m2], 'energy' "
		    "internal [J/m] (with account), 'temperature' [K] (Johnson-Cook), 'pressure' [Pa]: computed when asked for, refreshed by asking again.")
		.def("energies", &McaGridEngine::energies, "Energies and works [J/m], momentum and impulse [N s/m] of the whole grid now. 'total' = kinetic "
		    "+ internal - all works: stays constant to round-off.")
		.def("criticalCell", &McaGridEngine::criticalCell, "The cell that sets criticalTimeStep, as text.")
		.add_property("blocks", &McaGridEngine::blockList, "Blocks: list of dicts with name, cells (per row, rows).")
		.add_property("awakeFraction", &McaGridEngine::awake, "Part of the cells that are computed [-].")
		.add_property("time", &McaGridEngine::time, "Time of the positions [s].")
		.add_property("steps", &McaGridEngine::steps, "Steps done.")
		.add_property("count", &McaGridEngine::cellCount, "Number of cells.")
	)
	// clang-format on

private:
	shared_ptr<mca::grid::Grid>             solver;
	vector<shared_ptr<vector<double>>>      pressures; ///< buffers behind the views, one per block
	int                                     energyIndex[6] = { -1, -1, -1, -1, -1, -1 };
	void setVelocities(int block, const vector<double>& v, const vector<long>& shape);
	mca::grid::BlockOptions blockOptions(const string& name, Real hourglass, bool edgeViscosity) const;
};
REGISTER_SERIALIZABLE(McaGridEngine);
} // namespace yade
