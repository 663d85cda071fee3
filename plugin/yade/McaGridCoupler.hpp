// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "McaEngine.hpp"
#include "McaGridEngine.hpp"
#include "McaRoles.hpp"
#include "automata/solver.hpp"
#include "interface/transfer.hpp"
#include <deque>

namespace yade {

class McaGridCoupler : public GlobalEngine, public McaDriver {
public:
	void action() override;
	void preSave(McaGridCoupler&);
	void postLoad(McaGridCoupler&);

	/// Finds its two sides and ties the row, once; throws before anything has moved.
	void prepare(Scene* scene) override;
	/// Whether this coupler integrates that engine.
	bool drives(const McaSolverEngine* engine, Scene* scene) override;

	// Python
	vector<int>      rowIds() const;
	vector<Vector2i> rowNodes() const;
	vector<Vector2r> rowShares() const;
	py::dict         energies();

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(McaGridCoupler, GlobalEngine,
		"Ties a row of automata to a side, or part of a side, of a block of :yref:`McaGridEngine`. The side runs along the centres of one "
		"close-packed row; each automaton on it stands for "
		"the half of its cell that is not grid. The row moves with the nodes (linear on each edge of the grid) and hands its mass and forces to them "
		"by the same weights, so momentum and energy are "
		"exact. Its spin stays free: it then follows the rotation of the medium, not that of the edge alone. At the start the row takes the velocity "
		"of the grid. "
		"Order of engines: :yref:`McaTimeStepper`, :yref:`McaEngine`, :yref:`McaGridEngine`, couplers. Without McaEngine the row is taken from "
		"O.bodies, which Law2 and NewtonIntegrator move: "
		"InteractionLoop, McaGridEngine, couplers, NewtonIntegrator. "
		"A row off the line, gaps, overlaps, whole automata on the line, unlike materials and edges of another size are errors before the first step.",
		((shared_ptr<McaEngine>, automata, , , "automata; empty: the only McaEngine of the scene, or O.bodies when there is none; read when the row "
		    "is tied, a later change is refused"))
		((shared_ptr<McaGridEngine>, grid, , , "grid; empty: the only McaGridEngine of the scene; read when the row is tied, a later change is "
		    "refused"))
		((int, block, 0, , "number of the block; read when the row is tied, a later change is refused"))
		((string, side, "left", , "side of the block: 'bottom', 'right', 'top' or 'left'; read when the row is tied, a later change is refused"))
		((int, start, 0, , "first node of the side; read when the row is tied, a later change is refused"))
		((int, end, -1, , "last node of the side, inclusive; -1: the last there is; read when the row is tied, a later change is refused"))
		((vector<int>, ids, , , "bodies of the row in any order; empty: all automata on the line; read when the row is tied, a later change is "
		    "refused"))
		((Real, tolerance, 1e-4, , "allowed distance from the line, over the diameter [-]; read when the row is tied, a later change is refused"))
		((Vector2r, ratio, Vector2r(0.5, 4.5), , "smallest and largest edge of the grid on the interface, over the diameter [-]; read when the row "
		    "is tied, a later change is refused"))
		((bool, otherMaterials, false, , "allow unlike materials on the two sides; read when the row is tied, a later change is refused"))
		((sdk::Blob, state, , Attr::hidden, "the map"))
		((string, tiedAs, "", Attr::hidden, "the attributes with which the row was tied"))
		,
		timingDeltas = shared_ptr<TimingDeltas>(new TimingDeltas);
		,
		.add_property("rowIds", &McaGridCoupler::rowIds, "Ids of the tied bodies in order along the side; empty before the first step.")
		.add_property("rowNodes", &McaGridCoupler::rowNodes, "Open nodes (first, second) of the edge that carries each tied body.")
		.add_property("rowShares", &McaGridCoupler::rowShares, "Shares of the two nodes in each tied body [-]; they add to 1.")
		.def("energies", &McaGridCoupler::energies, "Sums over all automata and grids that are coupled in the scene, per 1 m of thickness: 'kinetic' "
		    "[J/m], 'total' [J/m] (stays constant), 'booked' [J/m] "
			"(the same from the work of the forces: constant to round-off when the accounts are kept), 'momentumX', 'momentumY', 'impulseX', "
			"'impulseY' (from outside) [N s/m], 'angularMomentum' about the origin [N s].")
	)
	// clang-format on

private:
	vector<mca::interface::Carried> row;
	vector<long>                    places; ///< of each in the solver's order of tied automata
	bool                            tied = false;
	bool                            loaded = false; ///< from a file and not yet compared with what it refers to
	boost::weak_ptr<Scene>          home; ///< scene of the tied bodies
	shared_ptr<McaEngine>           foundAutomata;
	shared_ptr<McaGridEngine>       foundGrid;
	void                            step();
	void                            find(Scene*);
	string                          asText() const;
	void                            checkHome(Scene*);
	template <class F> void         inBoth(F&& f);
	void                            makeRow(Scene*);
	void                            tieRow(Scene*);
	void                            checkTied(Scene*);
	vector<mca::interface::RowPoint> candidates(Scene*, std::deque<mca::Material>& keep) const;
	void                            forcesToNodes(Scene*);
	void                            motionToRow(Scene*, bool positions);
	vector<McaGridCoupler*>         all(Scene*) const;
};
REGISTER_SERIALIZABLE(McaGridCoupler);
} // namespace yade
