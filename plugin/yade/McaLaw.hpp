// SPDX-License-Identifier: GPL-2.0-or-later
// The law of the automata in YADE's own loop: what has to be known of all pairs of an automaton before any pair force can be computed.
#pragma once
#include "McaPhys.hpp"
#include "McaSolverEngine.hpp"
#include "automata/solver.hpp"
#include <core/Body.hpp>
#include <map>
#include <thread>

namespace yade {

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
	py::list links() const;
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(McaLaw, McaSolverEngine,
		"First half of the law of movable cellular automata in YADE's loop (plane strain x, y): volume and pressure of every automaton, trial "
		"stresses of its pairs, radial return, fracture "
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
		"O.periodic, clumps of automata, yade.mpy, states that :yref:`McaEngine` has moved. An engine whose automata are all new starts from the "
		"beginning.",
		((string, volumeRule, "affine", , "'affine', 'inversePower' or 'meanDistance', see McaEngine; read when links are made, a change after that "
		    "is refused"))
		((Real, linkFactor, 1.2, , "bodies closer than this many diameters are linked [-], 1.02 to 1.5; read when links are made, a change after the "
		    "first step is refused"))
		((Real, linkFactorUsed, 0, Attr::hidden, "with which links were made [-]; 0: none yet"))
		((Real, volumeFilter, 0.1, , "rate at which stripes of volume fade in flowing material, in c0/d [-], 0 to 1; see McaEngine; read in every "
		    "step"))
		((Real, filterTime, 0, Attr::hidden, "since the last exchange of volume [s]"))
		((int, seed, 1, , "seed of the scattered strengths; read when automata are taken in: in the first step and when bodies are added"))
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
		,
		/* ctor */
		,
		.def("energies", &McaLaw::energies, "Energies [J/m] now, and dissipations since O.trackEnergy was set: 'kinetic', 'volumetric', "
		    "'deviatoric', 'plastic', 'viscous', 'friction', 'fracture', 'coupling', 'total'; 'joined': what total owes to bodies added and erased "
		    "since. Raises RuntimeError while the simulation runs in the background.")
		.def("counters", &McaLaw::counters, "Work done so far: steps, brokenLinks, clamped, deepest.")
		.def("links", &McaLaw::links, "Pairs of body ids whose link holds, list of (id1, id2). Raises RuntimeError while the simulation runs in the "
		    "background.")
	)
	// clang-format on

	/// One side of a pair; p is null where there is none.
	struct Side {
		McaPhys* p     = nullptr;
		int      side  = 0;
		int      other = -1; ///< place in rows
	};
	struct Row {
		int                  id = 0;
		int                  mask = 1;
		State*               state    = nullptr;
		const McaMat*        mat      = nullptr;
		McaState*            m        = nullptr;
		McaLawState*         l        = nullptr;
		const mca::Material* material = nullptr;
		Real                 d        = 0; ///< diameter [m]
		Side                 link[mca::nLinks];
		int                  firstContact = 0, lastContact = 0; ///< in contacts, ascending ids
		Real                 lost      = 0;                     ///< normal stress of links that have broken in this step, with their weights [Pa]
		Real                 curvature = 0;                     ///< second difference of the volume
		Vector3r             motion = Vector3r::Zero(); ///< velocity [m/s] and spin [rad/s] of the last move
		bool                 fresh  = false;            ///< has made no move
		// of this step
		Real   limit = 0, stiff = 0, closing = 0, turning = 1, nearestLink = 1, nearestContact = 1;
		bool   clampedNow = false, bad = false;
		Real   plastic = 0, coupling = 0, friction = 0, heated = 0;
	};

private:
	using MaskTable = std::map<int, int>; ///< Body.mask -> a body that has it
	std::thread::id            worker;    ///< that computes the steps
	vector<std::pair<const Engine*, bool>> seen; ///< O.engines that were found good: engine, dead
	vector<const Engine*>      newtons;
	vector<std::pair<Real, int>> newtonsGood; ///< damping and mask
	MaskTable                  automataGood, othersGood;
	vector<Row>                rows;  ///< automata, ascending ids
	vector<int>                place; ///< of body ids in rows, or -1
	vector<Side>               contacts;
	vector<std::pair<int, Real>> unsettled;
	vector<int>                relinked; ///< ids whose links have changed because bodies were erased or added
	vector<mca::Material>      materials;
	vector<const McaMat*>      known;
	long                       revision = 0; ///< grows when constants of pairs have changed
	mca::VolumeRule            rule() const;
	void                       forget();
	void                       checkOptions(const Scene&) const;
	void                       lastMotion(Row&) const;
	bool                       hasMoved() const;
	void                       checkEngines(const Scene&);
	McaState&                  checkBody(const Scene&, const Body&) const;
	void                       checkOther(const Body&) const;
	void                       checkUntouched(const Row&) const;
	void                       checkState(const Row&) const;
	void                       checkMasks(const MaskTable& automata, const MaskTable& others);
	void                       takeIn(Scene*);
	void                       gather(Scene*);
	void                       readMaterials(Scene*);
	void                       pairConstants(const Row&, const Side&) const;
	void                       findLinks(Scene*);
	void                       keepVolumes(Scene*);
	void                       findContacts(Scene*);
	bool                       breaks(const Row&, int k) const;
	void                       breakLinks();
	void                       unlink(Row&, const Side&, int k);
	Real                       determinantNow(const Row&) const;
	void                       keepVolume(int i, Real J);
	void                       settleVolumes(bool account);
	Real                       distance2(const Row&, const Side&) const;
	Real                       distance(const Row& r, const Side& s) const { return std::sqrt(distance2(r, s)); }
	void                       contactVolume(Row&);
	void                       filterVolumes(bool account);
	void                       volume(Row&, bool withContacts);
	template <mca::EosKind law> void       volumeBy(Row&, bool withContacts);
	void                       stress(Row&);
	mca::Pair<Real>                        trial(const Row&, const Side&, mca::Pair<Real> before, Real dilation) const;
	void                                   finishPressure(Row&) const;
	void                       contactFriction(Row&, const Side&, mca::Pair<Real> before, Real scale);
	void                       scaleStresses(const Row&, Real ratio);
	void                       checkResults();
	[[noreturn]] void          overlapError(const Row&, const Side&, Real ratio) const;
	Real                       coldEnergyAt(const Row&, Real J) const;
	Real                       contactEnergyAt(const Row&, Real Jc) const;
	void                       stateEnergies(Scene&, Real& volumetric, Real& deviatoric, Real& kinetic, Real& centre) const;
	void                       bookEnergies(Scene*);
	void                       refuseWhileRunning(const char* what) const;
	int                        energyIndex[8] = { -1, -1, -1, -1, -1, -1, -1, -1 };
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
