// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "McaMat.hpp"
#include "McaSolverEngine.hpp"
#include "automata/solver.hpp"
#include <sdk/Blob.hpp>
#include <core/Timing.hpp>

namespace yade {
class Body;

class McaEngine : public McaSolverEngine {
public:
	void action() override;
	Real criticalTimeStep() const override;
	void prepare(Scene* scene) override;
	/// Before the first step: bodies are gathered anew at the next one.
	void forget();
	void preSave(McaEngine&);
	void postLoad(McaEngine&);

	// the two halves of a step, for the coupler
	void computeForces(Scene* scene);
	void integrate(Scene* scene);
	mca::automata::Solver& automata() { return *solver; }
	void ensureBuilt(Scene* scene);

	// Python
	void       writeBack();
	void       reload();
	py::object fieldByName(const string& name);
	py::object identifiers();
	py::dict   energies();
	py::dict   counters();
	py::dict   phases();
	py::list   linkList();
	void       setViscous(const vector<int>& ids, const Vector2r& normal);
	long       automataCount() const { return solver ? long(order.size()) : 0; }
	Vector2r   momentum();

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(McaEngine, McaSolverEngine,
		"Movable cellular automata in plane strain (x, y) on flat arrays: gathers all bodies whose material is :yref:`McaMat` and shape :yref:`Sphere`, keeps its own pairs, integrates them "
		"and writes back to the bodies at the end of a run, every writePeriod steps and when sync() is called. "
		"Masses are per 1 m of thickness: density times the area an automaton stands for (packings.addBodies sets them). "
		"Bodies with different masks do not link at the start; they meet as contacts. Blocked degrees of freedom keep their velocity. "
		"Changes made to bodies by a script are taken over after a run has ended, or at once by reload().",
		((string, volumeRule, "affine", , "'affine' (default: J = det F of the links, exact in any homogeneous deformation), 'inversePower' (density from the mean of (d/r)^2) or 'meanDistance' (as published; its lattice buckles under strong plastic compression)"))
		((Real, linkFactor, 1.2, , "bodies closer than this many diameters are linked at the start [-]"))
		((Real, skin, 0.4, , "range of the contact search beyond touching, in diameters [-]"))
		((Real, volumeFilter, 0.1, , "rate at which stripes of volume (alternate rows) fade in flowing material, in c0/d [-]; 0 ... 1, 0: off. They cost no force, so nothing else takes them away; affine rule"))
		((bool, sleeping, true, , "leave out regions that nothing has reached; changes no result"))
		((bool, contacts, true, , "search for contacts"))
		((bool, account, false, , "keep the energy account (also on when O.trackEnergy)"))
		((bool, adaptive, true, , "set O.dt in every step to dtFactor times the largest stable one, growing at most 10 % a step; otherwise O.dt is checked only"))
		((Real, dtFactor, 0.4, , "share of the largest stable time step [-], 0 < dtFactor <= 1"))
		((int, writePeriod, 0, , "write back to the bodies every so many steps; 0: only at the end of a run and when asked"))
		((int, seed, 1, , "seed of the scattered strengths"))
		((bool, readForces, false, , "add the forces that other engines put on the bodies (O.forces)"))
		((Vector2r, gravity, Vector2r::Zero(), , "acceleration of all automata [m/s2]"))
		((long, lastWritten, -1, Attr::readonly|Attr::noSave, "step of the last write-back"))
		((bool, forcesReady, false, Attr::hidden, "forces of this step are computed; integration has yet to follow"))
		((sdk::Blob, state, , Attr::hidden, "state of the solver"))
		((vector<int>, order, , Attr::hidden, "body ids, ascending"))
		((vector<Vector3r>, viscous, , Attr::hidden, "of setViscous(), kept for the next time that bodies are gathered: id [-] and coefficients along x and y [kg/(m s)]"))
		,
		timingDeltas = shared_ptr<TimingDeltas>(new TimingDeltas);
		,
		.def("sync", &McaEngine::writeBack, "Write positions, velocities and states to the bodies now.")
		.def("reload", &McaEngine::reload, "Take over positions and velocities that the script has changed, and added or erased bodies, before the next step.")
		.def("field", &McaEngine::fieldByName, (py::arg("name")), "Copy of one quantity of all automata in the order of `ids`, numpy (N,): 'x', 'y' [m], 'vx', 'vy' [m/s], 'omega' [rad/s], 'angle' [rad], 'mass' [kg/m], 'pressure' [Pa], 'volumeRatio' [-], 'equivalentStress' [Pa], 'plasticStrain' [-], 'temperature' [K], 'stressZZ' [Pa], 'fx', 'fy' [N/m], 'links' [-], 'brokenLinks' [-], 'strength' [-], 'diameter' [m], 'weight' [-], 'material' [-].")
		.add_property("ids", &McaEngine::identifiers, "Ids of the bodies, ascending; numpy (N,) int.")
		.def("energies", &McaEngine::energies, "Energies [J/m] now; dissipations since the start when the account is kept. 'bookedError': kinetic energy minus all work booked (round-off); 'halfStep': what 'kinetic', 'external' and 'viscous' change in the half step between the stresses and the velocities; 'total': independent sum at the time of the stresses.")
		.def("counters", &McaEngine::counters, "Work done so far: steps, searches, sorts, blockSteps (blocks of 64 computed), blocks, brokenLinks, clamped (equation of state beyond its clamp), deepest (smallest distance / rest distance), contacts, awake.")
		.def("links", &McaEngine::linkList, "Pairs of body ids whose link holds, list of (id1, id2).")
		.def("setViscous", &McaEngine::setViscous, (py::arg("ids"), py::arg("normal")), "Viscous (transmitting) boundary of Lysmer and Kuhlemeyer (1969) on these bodies: traction -rho cP v_n n - rho cS v_t on their outer width; normal is (1,0), (-1,0), (0,1) or (0,-1).")
		.def("phases", &McaEngine::phases, "Time spent per phase [ns] while O.timingEnabled.")
		.add_property("count", &McaEngine::automataCount, "Number of automata.")
		.add_property("momentum", &McaEngine::momentum, "Momentum of all automata [N s/m].")
	)
	// clang-format on

private:
	shared_ptr<mca::automata::Solver> solver;
	bool                              loaded = false, stale = false, checkBodies = true;
	vector<Vector3r>                  writtenPos, writtenVel;
	vector<Real>                      writtenSpin;
	int                               energyIndex[12] = { -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1 };
	mca::automata::Options solverOptions(Scene*) const;
	void                   gather(Scene*, const mca::automata::Solver* old);
	void                   adoptChanges(Scene*);
	void                   changeBodies(Scene*);
	void                   readExternal(Scene*);
	void                   writeBodies(Scene*);
	void                   writeEnergies(Scene*);
	void                   finish(Scene*);
	void                   checkStep(Scene*) const;
	bool                   shortenStep(Scene* scene, Real limit) const;
	Real                   drawStrength(const McaMat&, int id) const;
};
REGISTER_SERIALIZABLE(McaEngine);
} // namespace yade
