// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "McaMat.hpp"
#include "McaSolverEngine.hpp"
#include "automata/automata.hpp"
#include <boost/weak_ptr.hpp>
#include <functional>
#include <grid/boundary.hpp>
#include <sdk/Blob.hpp>
#include <core/Timing.hpp>

namespace yade {
class Body;

class McaEngine : public McaSolverEngine {
public:
	void step() override;
	Real criticalTimeStep() const override;
	void prepare(Scene* scene) override;
	void bringUpToDate() override;
	bool carriesRows() const override { return solver && solver->tiedCount() > 0; }
	bool setsStep() const override { return adaptive && !dead; }
	bool movesAutomata() const override { return true; }
	void stepIsSet() override { adaptive = false; }
	bool built() const { return bool(solver); }
	/// Before the first step: bodies are gathered anew at the next one.
	void forget();
	void preSave(McaEngine&);
	void postLoad(McaEngine&);

	// the two halves of a step, for the coupler
	void computeForces(Scene* scene);
	void integrate(Scene* scene);
	void finish(Scene* scene);
	/// In plane strain. Throws mca::Error in space.
	mca::automata::Solver& automata();
	/// ensureBuilt() where a script asks: only in a scene that has this engine and where something may have changed.
	void refresh(Scene* scene);
	/// The solver holds what the bodies hold: gathers them the first time, later takes over what scripts have changed. Throws mca::Error.
	void ensureBuilt(Scene* scene);

	// Python; each under the lock
	void       writeBack();
	void       reload();
	py::object fieldByName(const string& name);
	py::dict   fieldsByName(py::object names);
	py::object identifiers();
	py::dict   energies();
	py::dict   countersNow();
	py::dict   phases();
	py::list   linkList();
	py::dict   brokenLinks();
	py::dict   cohesivePairs();
	long       cut(py::object pairs);
	void       setViscous(const vector<int>& ids, const py::object& normal);
	void       prescribe(const vector<int>& ids, py::object x, py::object y, py::object z);
	void       push(const vector<int>& ids, py::object x, py::object y, py::object z);
	void       prescribeTemperature(const vector<int>& ids, py::object temperature);
	void       press(const vector<int>& ids, py::object pressure);
	void       clearLoads();
	void       setStress(const vector<int>& ids, py::object stress);
	void       setPair(py::object first, py::object second, Real strength, Real pairStrength, py::object frictionAngle, Real viscosity);
	long       automataCount() const;
	py::object momentum();

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(McaEngine, McaSolverEngine,
		"Movable cellular automata in plane strain (x, y) or in space on flat arrays: gathers all bodies whose material is :yref:`McaMat` and shape "
		":yref:`Sphere`, keeps its own pairs and integrates them. "
		"The dimension follows from the bodies: plane strain when all of them are blocked along z and about x and y, else space; a scene of both is "
		"refused. "
		"Whenever a script can look - the loop has stopped, a PyRunner or recorder is due, a file is written - the bodies hold what the engine "
		"holds, and what the script then changes counts from the next "
		"step on: positions, velocities, blocked degrees of freedom, masks, materials and their constants, plastic strains, temperatures, strengths, "
		"bodies added and erased. What cannot be taken over "
		"(mass, radius, results such as the pressure) is refused before anything moves. While the loop runs in the background, field() and the like "
		"read the present state; bodies are those of the last look. "
		"Masses are density times the volume that an automaton stands for, in plane strain per 1 m of thickness (packings.addBodies sets them); so are "
		"all forces, energies and momenta. "
		"Bodies with different masks do not link at the start; they meet as contacts. Blocked degrees of freedom keep their velocity. "
		"Automata touch every wall, box, facet and sphere of another material, alone or in a clump, whose mask is not 0 (12b): a penalty of the "
		"automaton's moduli with the smaller friction of both. What such a body gets goes to O.forces, per m of thickness in plane strain, and "
		"whatever YADE has moves it (NewtonIntegrator with a mask that no automaton has, TranslationEngine before it). With readForces and an "
		"InteractionLoop that loop has them. Members of a clump are rigid whatever their material: a clump of automata is such a body. Other "
		"shapes, and "
		"rigid bodies in a scene coupled to a grid, are refused.",
		((string, volumeRule, "affine", , "'affine' (default: J = det F of the links, exact in any homogeneous deformation), 'inversePower' (density "
		    "from the mean of (d/r)^2) or 'meanDistance' (as published; its lattice buckles under strong plastic compression); in space 'affine' only. "
		    "Read when bodies are gathered; a later change is refused"))
		((Real, linkFactor, 1.2, , "bodies closer than this many diameters are linked at the start [-], 1.02 ... 1.5. Read when bodies are gathered; "
		    "a later change is refused"))
		((Real, skin, 0.4, , "range of the contact search beyond touching, in diameters [-], 0.05 ... 1. Read at every look"))
		((Real, volumeFilter, 0.1, , "rate at which stripes of volume (alternate rows) fade in flowing material, in c0/d [-]; 0 ... 1, 0: off. They "
		    "cost no force, so nothing else takes them away; affine rule. Read at every look"))
		((bool, linkAcrossMasks, false, , "bodies of different masks link, too; else a mask is a body of its own that meets others as contacts. Read "
		    "when bodies are gathered; a later change is refused"))
		((Real, damping, 0, , "as in NewtonIntegrator: the share of each component of force and torque that is taken away where it drives the "
		    "motion and "
		    "added where it slows it down [-], 0 (default: none) ... 0.95. Not physics: a way to a state of rest, see equilibrium.relax(). Its work is "
		    "in 'external'; refused in a scene coupled to a grid. Read in every step"))
		((bool, sleeping, true, , "leave out regions that nothing has reached; changes no result. Read when bodies are gathered; a later change is "
		    "refused"))
		((bool, contacts, true, , "search for contacts. Read when bodies are gathered; a later change is refused"))
		((bool, account, false, , "keep the energy account (also on when O.trackEnergy). Read in every step"))
		((bool, adaptive, true, , "set O.dt in every step to dtFactor times the largest stable one, growing at most 10 % a step; otherwise O.dt is "
		    "checked only. Read in every step"))
		((Real, dtFactor, 0.4, , "share of the largest stable time step [-], 1e-6 ... 1. Read in every step"))
		((int, writePeriod, 0, , "write to the bodies every so many steps even if nobody looks; 0 (default): only when somebody can look. Read in "
		    "every step"))
		((int, seed, 1, , "seed of the scattered strengths; read when a body is taken over for the first time"))
		((bool, readForces, false, , "add the forces that other engines put on the bodies (O.forces). Read in every step"))
		((Vector2r, gravity, Vector2r::Zero(), , "acceleration of all automata [m/s2]; refused in a scene coupled to a grid, which has none. Read in "
		    "every step"))
		((Real, gravityZ, 0, , "acceleration of all automata along z [m/s2]; in space only. Read in every step"))
		((int, dimension, 2, Attr::readonly, "2: plane strain, 3: space; found when bodies are gathered"))
		((long, lastWritten, -1, Attr::readonly|Attr::noSave, "step whose end the bodies hold since they were written last; -1: before the first"))
		((bool, forcesReady, false, Attr::hidden, "forces of this step are computed; integration has yet to follow"))
		((bool, bodiesSaved, false, Attr::hidden, "the bodies saved with it hold what it holds, so that differences are a script's"))
		((sdk::Blob, state, , Attr::hidden, "state of the solver"))
		((vector<int>, order, , Attr::hidden, "body ids, ascending"))
		((vector<Vector3r>, viscous, , Attr::hidden, "of setViscous(), kept for the next time that bodies are gathered: id [-] and coefficients "
		    "along x and y [kg/(m s)]"))
		((vector<int>, wallPairs, , Attr::hidden, "automaton and wall of each contact with one that has held a shear force, for the file"))
		((vector<Vector3r>, wallShears, , Attr::hidden, "that force on the automaton [N/m, in space N]"))
		((vector<shared_ptr<Material>>, pairMaterials, , Attr::hidden, "of setPair(): two materials each"))
		((vector<Real>, pairNumbers, , Attr::hidden, "of setPair(): strength, pairStrength [Pa], friction (-1: not given) and viscosity each"))
		((vector<Vector3r>, loadRows, , Attr::hidden, "of prescribe(), push(), prescribeTemperature() and press(): what and where, number of "
		    "bodies, number "
		    "of points of the table"))
		((vector<int>, loadIds, , Attr::hidden, "bodies of all of them"))
		((vector<Vector2r>, loadPoints, , Attr::hidden, "points of their tables: time [s] and velocity [m/s], force [N/m, in space N], temperature "
		    "[K] or pressure [Pa]"))
		((vector<Real>, viscousZ, , Attr::hidden, "coefficients along z of the same [kg/s]"))
		,
		timingDeltas = shared_ptr<TimingDeltas>(new TimingDeltas);
		,
		.def("sync", &McaEngine::writeBack, "Write positions, velocities and states to the bodies of its scene now. Needed only while the loop runs "
		    "in the background; at any other time they are up to date. Raises RuntimeError when its scene is gone.")
		.def("reload", &McaEngine::reload, "Take over in the next step what the script has changed in the bodies while the loop runs in the "
		    "background; at any other time that happens by itself. Raises RuntimeError when its scene is gone.")
		.def("field", &McaEngine::fieldByName, (py::arg("name")), "Copy of one quantity of all automata now, in the order of `ids`, numpy (N,): 'x', "
		    "'y' [m], 'vx', 'vy' [m/s], 'omega' [rad/s], 'angle' [rad], 'mass' [kg/m], 'pressure' [Pa], 'volumeRatio' [-], 'equivalentStress' [Pa], "
		    "'plasticStrain' [-], 'damage' [-] (0 where no material has a damage model), 'temperature' [K], 'stressZZ' [Pa], 'fx', 'fy' [N/m], "
		    "'links' [-], 'brokenLinks' [-], 'strength' [-], 'diameter' "
		    "[m], 'weight' [-], 'material' [-]; in space 'z', 'vz', 'fz' as well, 'omegaX', 'omegaY', 'omegaZ' for 'omega', no 'angle', "
		    "'deviatorXX', 'deviatorYY', 'deviatorZZ', 'deviatorYZ', 'deviatorZX', 'deviatorXY' [Pa] for 'stressZZ', and mass and "
		    "forces are in kg and N. What a script has changed in the bodies counts already. Raises RuntimeError for another "
		    "name.")
		.def("fields", &McaEngine::fieldsByName, (py::arg("names")), "Copies of several quantities of one moment, dict of name -> numpy (N,) in the "
		    "order of `ids`; names: a list of those that field() takes, and 'ids' (int). Bodies and engine are compared once, not once for each "
		    "name. Raises RuntimeError for another name, TypeError when names is no list or tuple of texts.")
		.add_property("ids", &McaEngine::identifiers, "Ids of the bodies, ascending; numpy (N,) int.")
		.def("energies", &McaEngine::energies, "Energies now, in plane strain [J/m], in space [J]; dissipations since the start when the account is "
		    "kept. 'bookedError': kinetic energy minus all work booked (round-off); 'halfStep': what 'kinetic', 'external' and 'viscous' change in the "
		    "half step between the stresses and the velocities; 'total': independent sum at the time of the stresses.")
		.def("counters", &McaEngine::countersNow, "Work done so far: steps, searches (for contacts of all), localSearches (where links broke), sorts, "
		    "blockSteps (blocks of 64 computed), blocks, brokenLinks, clamped (equation of state beyond its clamp), "
		    "deepest (smallest distance / rest distance), contacts, awake.")
		.def("prescribe", &McaEngine::prescribe,
		    (py::arg("ids"), py::arg("x") = py::object(), py::arg("y") = py::object(), py::arg("z") = py::object()),
		    "Prescribe velocities [m/s] of these bodies: each of x, y, z a number, or a pair (times, values) that is linear between its points and "
		    "constant before and after (times are O.time [s]); None leaves that direction as it is. Blocks these degrees of freedom "
		    "(blockedDOFs). The work is in 'external'. Counts from the next step on; of two for one body and direction the later one. Raises "
		    "RuntimeError for a body that is no automaton, a table that is none, z in plane strain.")
		.def("push", &McaEngine::push, (py::arg("ids"), py::arg("x") = py::object(), py::arg("y") = py::object(), py::arg("z") = py::object()), "Put "
		    "forces [N/m, in space N] on each of these bodies: each of x, y, z as in prescribe(). Several on one body add up. The work is in "
		    "'external'.")
		.def("prescribeTemperature", &McaEngine::prescribeTemperature, (py::arg("ids"), py::arg("temperature")), "Prescribe the temperature [K] of "
		    "these "
		    "bodies: a number, or a pair (times, values) as in prescribe(), above 0. It stands in state.temperature and softens flow stresses that "
		    "depend on it; what plastic flow heats is overwritten in every step, and no heat is conducted. Raises RuntimeError as prescribe().")
		.def("press", &McaEngine::press, (py::arg("ids"), py::arg("pressure")), "Put a pressure [Pa] on the free side of these bodies: a number, or a "
		    "pair (times, values) as in prescribe(); negative pulls. It acts along the surface as it lies now: with the ids of a whole body its work "
		    "is minus the pressure times the change of the body's volume. Bodies inside a body feel nothing where it is strained evenly, a corner "
		    "that is named feels both of its sides, and what has lost its links' volume feels nothing. The work is in 'external'. Raises "
		    "RuntimeError as "
		    "prescribe().")
		.def("clearLoads", &McaEngine::clearLoads, "Forget all of prescribe(), push(), prescribeTemperature() and press(). Degrees of freedom stay "
		    "blocked, "
		    "with their last velocity.")
		.def("setStress", &McaEngine::setStress, (py::arg("ids"), py::arg("stress")), "Put a stress [Pa], positive in tension, into these bodies as "
		    "they lie "
		    "now (initial or residual stress): numpy or lists (N, 3) xx, yy, xy in plane strain, where zz follows from Hooke's law, or (N, 4) with zz, "
		    "and (N, 6) xx, yy, zz, yz, zx, xy in space; one row for all will do. Nobody moves: the state of rest of each body changes, its mass "
		    "does not, and its "
		    "volumeRatio becomes that of the pressure. Corners with too few links for a volume get the deviator alone. What is out of balance "
		    "afterwards moves: equilibrium.relax() leads it to rest. The energy "
		    "put in is in 'left'. Raises RuntimeError above the yield stress, for pressures that the "
		    "equation of state does not have, for numbers that are not finite or too few.")
		.def("setPair", &McaEngine::setPair, (py::arg("material1"), py::arg("material2"), py::arg("strength") = 1.,
		    py::arg("pairStrength") = std::numeric_limits<Real>::infinity(), py::arg("frictionAngle") = py::object(), py::arg("viscosity") = 1.),
		    "What holds between two materials (McaMat), in place of what "
		    "follows from "
		    "both: weak interfaces, glue. strength [-]: factor on all fracture criteria of their links (0.1: they break at a tenth); pairStrength "
		    "[Pa]: normal "
		    "stress at which links break, beside the criteria of both; frictionAngle [rad]: of their contacts, None: the smaller of both; viscosity "
		    "[-]: factor on the smaller viscosity of both, 0 ... 1. Glue within one body: give its two sides two materials of the same constants. "
		    "Counts from the next "
		    "step on, replaces an earlier rule of the same two, and is saved. Raises RuntimeError for what is no McaMat, for twice the same "
		    "material and "
		    "for numbers out of range.")
		.def("links", &McaEngine::linkList, "Pairs of body ids whose link holds, list of (id1, id2).")
		.def("cut", &McaEngine::cut, (py::arg("pairs")), "Break these links (list of (id1, id2), as links() gives them) at the start of the next step, "
		    "as fracture does: no stress passes that pulls, pressure and friction do; the energy is booked as fracture. Returns how many of them hold. "
		    "yade_mca.cracks.cut() finds them by a line or a predicate. Raises RuntimeError for an id that is no automaton of this engine or with "
		    "contacts=False, TypeError when pairs are none.")
		.def("brokenLinks", &McaEngine::brokenLinks, "All links that have broken so far, in turn, dict of numpy arrays (N,): 'time' [s] since the "
		    "engine's first step, 'id1' < 'id2', 'x', 'y', 'z' [m] the middle of the link, 'nx', 'ny', 'nz' [-] its direction, across the crack, and "
		    "'cause' (int): an index of yade_mca.cracks.CAUSES.")
		.def("cohesivePairs", &McaEngine::cohesivePairs, "Pairs whose links have broken and that hold together until their fractureEnergy is spent "
		    "(11f), in the order in which they broke, dict of numpy arrays (N,): 'id1', 'id2', 'opening' [m] now, 'spent' [-] share of the "
		    "fracture energy, below 1. Those of brokenLinks() that are missing here have parted.")
		.def("setViscous", &McaEngine::setViscous, (py::arg("ids"), py::arg("normal")), "Viscous (transmitting) boundary of Lysmer and Kuhlemeyer "
		    "(1969) on these bodies: traction -rho cP v_n n - rho cS v_t on their outer width, in space on their share of the rectangle they "
		    "cover; normal is (1,0), (-1,0), (0,1) or (0,-1), in space one of the six of three components. Read now; "
		    "RuntimeError for another normal and for an id that is no automaton.")
		.def("phases", &McaEngine::phases, "Time spent per phase [ns] while O.timingEnabled.")
		.add_property("count", &McaEngine::automataCount, "Number of automata.")
		.add_property("momentum", &McaEngine::momentum, "Momentum of all automata: Vector2 [N s/m] in plane strain, Vector3 [N s] in space.")
	)
	// clang-format on

private:
	/// What a body held when body and engine were last the same.
	struct Same {
		shared_ptr<State> state;
		shared_ptr<Shape> shape;
		const Material*   material = nullptr; ///< one of known
		// written by the engine
		Vector3r    pos = Vector3r::Zero(), vel = Vector3r::Zero(), angVel = Vector3r::Zero();
		Quaternionr ori = Quaternionr::Identity();
		Vector3r    angle = Vector3r::Constant(NaN); ///< of ori, as the solver has it
		Real        pressure = 0, volumeRatio = 1, equivalentStress = 0, plasticStrain = 0, damage = 0, temperature = 0, stressZZ = 0, dissipated = 0;
		int         links = 0, brokenLinks = 0;
		// read only
		Real     mass = 0, inertia = 0, radius = 0, strength = 0;
		int      mask = 0, triangles = 0, mirrors = 0;
		unsigned blocked = 0;
	};
	shared_ptr<mca::Automata>    solver;
	vector<shared_ptr<Body>>     walls;  ///< rigid bodies that automata touch
	vector<mca::WallStart>       wallStarts;
	bool                         forcesAreReset = false; ///< the scene has a ForceResetter
	vector<mca::WallPlace>       wallPlaces; ///< in this step
	vector<Quaternionr>          wallTurns;  ///< their orientations
	const vector<mca::WallPush>* wallPushes = nullptr;
	boost::weak_ptr<Scene>       home;   ///< scene of its bodies
	vector<shared_ptr<Body>>     bodies; ///< of order
	vector<Same>                 same;   ///< of order
	vector<shared_ptr<Material>> known;  ///< of the solver's materials
	bool looked = true;  ///< a script may have changed something since the last step
	int  lost   = -1;    ///< body whose change by a script was lost; told by the next step
	bool stale  = false; ///< the bodies do not hold the present state
	bool wrote  = false; ///< they hold what this engine has written, not only what a script or a file gave
	bool stressGiven = false; ///< by setStress()
	long lastMoved = -1; ///< step that moved the automata last
	bool         warnedEmpty = false, warnedTension = false;
	mutable bool warnedGravity = false;
	int  energyIndex[12] = { -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1 };

	// bodies (McaEngineBodies.cpp, McaEngineChanges.cpp)
	struct Change;
	bool              standsIn(const Scene& scene) const; ///< in its O.engines
	shared_ptr<Scene> myScene(const char* call) const;
	void              settleIn(Scene* scene);
	bool              isMine(int id) const { return solver && solver->holds(id); }
	void              gather(Scene* scene);
	void              checkBodies(const Scene&, int dimensionNow) const;
	Vector3r          place(const mca::AutomatonNow&, const State&) const;
	template <class F> void dropDampers(F&& goes);
	void              bind(Scene* scene);
	void              adoptChanges(Scene* scene);
	bool              wallsAreOthers(const Scene&) const;
	static bool       mayBeTouched(const Body& b);
	mca::WallStart    wallOf(const Scene&, const Body&) const;
	/// One of prescribe(), push(), prescribeTemperature() and press(); of kind and axis the first number of a row tells.
	struct Load {
		int              kind, axis;
		vector<int>      ids;
		mca::grid::Table table;
	};
	vector<Load>      loads; ///< as loadRows, loadIds and loadPoints say
	vector<Load>      loadList() const;
	void              load(int kind, const vector<int>& ids, const py::object (&along)[3], const char* call);
	void              dropLoads(const std::function<bool(int)>& goes);
	void              forgetLoads();
	void              pushLoads(const Scene&);
	void              driveLoads(const Scene&);
	void              heatLoads(const Scene&);
	void              checkLoads(const mca::Automata* of) const;
	void              checkDriven(const Body& b, const Vector3r& was) const;
	void              givePairRules(bool loaded = false);
	void              gatherWalls(Scene* scene);
	void              pushWalls(Real lastStep);
	void              tellWalls(Scene* scene);
	void              saveWalls();
	void              loadWalls(mca::Automata& to) const;
	vector<Change>    changes(bool& rebuild);
	Change            changeOf(size_t q, bool& rebuild);
	bool              untouched(size_t q) const;
	bool              sameBodies(const Scene& scene) const;
	bool              sameMaterials() const;
	void              apply(const vector<Change>& list);
	void              writeBodies(Scene* scene);
	void              writeEnergies(Scene* scene);
	bool              writeBody(State& s, Same& was, const mca::AutomatonNow& now) const;
	void              takeConstants(size_t q);
	void              takeResults(size_t q);
	// step
	mca::AutomataOptions solverOptions(Scene*) const;
	Vector3r             acceleration() const { return Vector3r(gravity[0], gravity[1], gravityZ); }
	void                 takeOptions(Scene*);
	void                 checkScene(Scene*) const;
	void                 readExternal(Scene*);
	void                 checkStep(Scene*) const;
	template <class F> auto read(const char* call, F&& f);
};
REGISTER_SERIALIZABLE(McaEngine);
} // namespace yade
