// SPDX-License-Identifier: GPL-2.0-or-later
// The law of the automata in YADE's own loop: what has to be known of all pairs of an automaton before any pair force can be computed.
#pragma once
#include "McaPhys.hpp"
#include "McaSolverEngine.hpp"
#include "kernels/volume_rule.hpp"
#include <core/Body.hpp>
#include <thread>

namespace yade {
class McaLawLoop;

class McaLaw : public McaSolverEngine {
public:
	void step() override;
	bool movesAutomata() const override { return true; }
	Real criticalTimeStep() const override { return dtLimit; }
	void prepare(Scene* scene) override;
	/// Forces of all pairs to the bodies, in a fixed order; ends the step. Throws mca::Error when one is not finite, before it adds any.
	void addForces(Scene* scene);
	py::dict energies();
	py::dict counters() const;
	mca::VolumeRule rule() const;
	/// Of O.engines, as the last step found them.
	const vector<const Engine*>& integrators() const { return newtons; }
	py::list links() const;
	long     cut(py::object pairs);
	void     setPair(py::object first, py::object second, Real strength, Real pairStrength, py::object frictionAngle, Real viscosity);
	void     postLoad(McaLaw&);
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(McaLaw, McaSolverEngine,
		"First half of the law of movable cellular automata in YADE's loop (plane strain x, y, or space): volume and pressure of every automaton, "
		"trial stresses of its pairs, radial return, fracture "
		"and contact friction, by the same formulas, at the same steps and in the same order as :yref:`McaEngine`, written plainly. O.engines: "
		"ForceResetter, collider "
		"(Bo1_Sphere_Aabb with aabbEnlargeFactor 1.4), McaLaw, InteractionLoop (Ig2_Sphere_Sphere_ScGeom with interactionDetectionFactor 1.4, "
		":yref:`Ip2_McaMat_McaMat_McaPhys`, for walls "
		":yref:`Ip2_FrictMat_McaMat_McaPhys`, :yref:`Law2_ScGeom_McaPhys_Mca`), :yref:`McaForces`, NewtonIntegrator(damping=0). Bodies closer than "
		"linkFactor diameters with the same mask are linked in the "
		"first step; bodies added later link with each other and with free places of old ones in the same way. Who loses or gets links because "
		"bodies are erased or added keeps its volume and stresses. "
		"O.dt is checked against the largest stable step, or set by :yref:`McaTimeStepper`. Bodies, materials, engines and masks are looked at in "
		"every step; what cannot be computed ends the run with an error "
		"before anything moves: masks of two automata without a common bit (YADE's collider skips such pairs), damping or a mask of NewtonIntegrator "
		"that concerns automata, dead or doubled engines, "
		"O.periodic, clumps of automata, yade.mpy, states that :yref:`McaEngine` has moved. In space volumeRule is 'affine', and planes of symmetry "
		"(state.mirrors) are refused: they are of :yref:`McaEngine`. Whether bodies are in plane strain or in space follows from their mass. An "
		"engine whose automata are all new starts from the "
		"beginning.",
		((string, volumeRule, "affine", , "'affine', 'inversePower' or 'meanDistance', see McaEngine; read when links are made, a change after that "
		    "is refused"))
		((Real, linkFactor, 1.2, , "bodies closer than this many diameters are linked [-], 1.02 to 1.5; read when links are made, a change after the "
		    "first step is refused"))
		((bool, linkAcrossMasks, false, , "bodies of different masks, which must have a common bit, link, too; see McaEngine. Read when automata "
		    "are taken "
		    "in: in the first step and when bodies are added"))
		((vector<shared_ptr<Material>>, pairMaterials, , Attr::hidden, "of setPair(): two materials each"))
		((vector<Real>, pairNumbers, , Attr::hidden, "of setPair(): strength, pairStrength [Pa], friction (-1: not given) and viscosity each"))
		((Real, linkFactorUsed, 0, Attr::hidden, "with which links were made [-]; 0: none yet"))
		((Real, volumeFilter, 0.1, , "rate at which stripes of volume fade in flowing material, in c0/d [-], 0 to 1; see McaEngine; read in every "
		    "step"))
		((Real, filterTime, 0, Attr::hidden, "since the last exchange of volume [s]"))
		((int, seed, 1, , "seed of the scattered strengths; read when automata are taken in: in the first step and when bodies are added"))
		((int, dimension, 0, Attr::readonly, "2 in plane strain, 3 in space: that of the bodies; 0 before the first step; output. In space energies "
		    "are in J, not J/m"))
		((long, steps, 0, Attr::readonly, "steps done; output"))
		((Real, dtLimit, std::numeric_limits<Real>::infinity(), Attr::readonly, "largest stable time step at the present state [s]; output"))
		((int, stiffest, -1, Attr::readonly, "body that limits the time step; output"))
		((Real, lastMove, 0, Attr::readonly, "time step that led to the present positions [s]; output"))
		((long, pushedAt, -1, Attr::hidden, "O.iter whose forces were given to the bodies"))
		((long, doneAt, -1, Attr::hidden, "O.iter whose stresses are computed: once only, also when something stops the step half-way"))
		((Real, deepest, 1, Attr::readonly, "smallest distance of a pair over its rest distance seen [-]; output"))
		((long, clamped, 0, Attr::readonly, "times the equation of state was beyond its clamp; output"))
		((long, brokenLinks, 0, Attr::readonly, "links broken; output"))
		((Real, plastic, 0, Attr::readonly, "plastic work so far, while O.trackEnergy [J/m]; output"))
		((Real, viscous, 0, Attr::readonly, "heat of the artificial viscosity so far, while O.trackEnergy [J/m]; output"))
		((Real, lastViscous, 0, Attr::hidden, "its part of the last step [J/m]"))
		((Real, frictional, 0, Attr::readonly, "energy lost in contacts so far, while O.trackEnergy [J/m]; output"))
		((Real, fracture, 0, Attr::readonly, "energy released by fracture so far, while O.trackEnergy [J/m]; output"))
		((Real, coupling, 0, Attr::readonly, "work of the pair stresses that went into volume so far, while O.trackEnergy [J/m]; output"))
		((Real, heated, 0, Attr::readonly, "part of the dissipation that stands in the internal energy of mieGruneisen materials [J/m]; output"))
		((Real, joined, 0, Attr::readonly, "energy that added bodies have brought minus what erased ones have taken along, while O.trackEnergy "
		    "[J/m]: energies()['total'] changes by it, and total - joined goes on; output"))
		((Real, lastTotal, 0, Attr::hidden, "energies()['total'] of the last step [J/m]"))
		((long, bookedAt, -1, Attr::hidden, "O.iter of the last step with O.trackEnergy"))
		((vector<int>, members, , Attr::hidden, "ids of the automata of the last step"))
		((vector<int>, asked, , Attr::hidden, "ids of pairs whose links break in the next step"))
		,
		/* ctor */
		,
		.def("energies", &McaLaw::energies, "Energies [J/m] now, and dissipations since O.trackEnergy was set: 'kinetic', 'volumetric', "
		    "'deviatoric', 'plastic', 'viscous', 'friction', 'fracture', 'coupling', 'total'; 'joined': what total owes to bodies added and erased "
		    "since. Raises RuntimeError while the simulation runs in the background.")
		.def("counters", &McaLaw::counters, "Work done so far: steps, brokenLinks, clamped, deepest.")
		.def("links", &McaLaw::links, "Pairs of body ids whose link holds, list of (id1, id2). Raises RuntimeError while the simulation runs in the "
		    "background.")
		.def("setPair", &McaLaw::setPair, (py::arg("material1"), py::arg("material2"), py::arg("strength") = 1.,
		    py::arg("pairStrength") = std::numeric_limits<Real>::infinity(), py::arg("frictionAngle") = py::object(), py::arg("viscosity") = 1.),
		    "What holds between two materials in place of what follows from "
		    "both; see "
		    "McaEngine.setPair(). strength, viscosity [-], pairStrength [Pa], frictionAngle [rad]. Counts from the next step on. Raises "
		    "RuntimeError for numbers out of "
		    "range and while the simulation runs in the background.")
		.def("cut", &McaLaw::cut, (py::arg("pairs")), "Break these links at the start of the next step; see McaEngine.cut(). Links are there from the "
		    "first step on. Returns how many of them hold. Raises RuntimeError while the simulation runs in the background, TypeError when pairs are "
		    "none.")
	)
	// clang-format on

private:
	std::thread::id                        worker;  ///< that computes the steps
	vector<std::pair<const Engine*, bool>> seen;    ///< O.engines that were found good: engine, dead
	vector<const Engine*>                  newtons;
	shared_ptr<McaLawLoop>                 loop;    ///< of `dimension`
	void                                   checkOptions(const Scene&) const;
	void                                   checkEngines(const Scene&);
	McaLawLoop&                            loopOf(const Scene&);
	void                                   refuseWhileRunning(const char* what) const;
};
REGISTER_SERIALIZABLE(McaLaw);

class McaDensity : public McaLaw {
	YADE_SDK_OLD_NAME(McaDensity, McaLaw, "The name that :yref:`McaLaw` had before; scripts and files that use it go on working.")
};
REGISTER_SERIALIZABLE(McaDensity);

class McaForces : public GlobalEngine {
public:
	void action() override;
	// clang-format off
	YADE_CLASS_BASE_DOC(McaForces, GlobalEngine,
		"Adds the pair forces that :yref:`Law2_ScGeom_McaPhys_Mca` has left in the pairs to the bodies, for each body in the order of its links and "
		"of its contacts' ids: the sums do not depend on "
		"the number of threads, nor on the order of O.interactions after loading. Stops the run before anything moves when a force is not finite. "
		"Comes after InteractionLoop. No attributes of its own.")
	// clang-format on
};
REGISTER_SERIALIZABLE(McaForces);
} // namespace yade
