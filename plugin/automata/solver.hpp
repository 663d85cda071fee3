// SPDX-License-Identifier: GPL-2.0-or-later
// The automata solver: movable cellular automata on flat arrays, in plane strain or in space (kernels/dimension.hpp). Knows nothing of YADE.
//   solver.build(...); loop { solver.computeForces(); solver.integrate(dt); }
// Leapfrog: positions at whole steps, velocities at half steps. computeForces() gives the forces at the present positions.
#pragma once
#include "bonds.hpp"
#include "common.hpp"
#include "contacts.hpp"
#include <functional>
#include <string>

namespace mca::automata {

constexpr double nearCell = 4; ///< size of the cells in which displacements since a search are compared [diameters]

/// One automaton as the caller gives it. SI units, in plane strain per unit thickness.
struct Automaton {
	Vec<double> position {}, velocity {};
	Turn<double> omega {}, angle {};
	double  mass = 0, inertia = 0, diameter = 0, weight = 1, strength = 1;
	double  eqps = 0, damage = 0;
	double  temperature = 0; ///< [K]; 0: the material's reference temperature
	int32_t material = 0, id = 0, group = 0;
	Vec<bool>   free  = everyWay(); ///< per direction: moves as forces say
	Turn<bool>  freeR = everyTurn();
	Vec<bool>   mirror {}; ///< lies on a plane of symmetry with this normal, beyond which the body goes on as its image; in space only
	int         triangles = 0; ///< of the packing that it shall stand for, to end at an outline (5g); 0: what its mass says
	bool    isNew = false; ///< build with an old solver: another automaton than the one that had this number there
};

/// What a loop of its own (YADE's) keeps of an automaton's links, see Solver::knowing().
struct LinkRecord {
	int32_t id = 0;
	Flags   flags = 0;       ///< Flag bits
	int32_t partner[nLinks]; ///< caller's numbers; -1: none
	double  invN = 1. / nLinks;
	LinkRecord() { std::fill(partner, partner + nLinks, -1); }
};

using Options  = AutomataOptions;
using Counters = AutomataCounters;
using Account  = AccountOf<Vec<double>, Turn<double>>;

class MCA_API Solver {
public:
	/// Builds arrays and links. Throws Error: coincident automata, wrong spacing, bad mass, unknown material, non-finite input.
	/// old: the solver of the set before automata were added or erased; those it knew by the same number keep links, stresses, contacts and history,
	/// and new links form only with automata that it did not know.
	void build(const std::vector<Automaton>& automata, const std::vector<Material>& materials, const Options& options, const Solver* old = nullptr);

	/// A solver that knows these automata by their numbers and links and nothing else: `old` of build() for a caller that keeps the history itself.
	static Solver knowing(const std::vector<Automaton>& automata, const std::vector<Material>& materials, const std::vector<LinkRecord>& links);

	/// Forces at the present positions from the last move. Throws Error (deep overlap, non-finite result); positions stay as they are.
	void computeForces();
	/// Velocities and positions by dt [s]. Throws Error when dt is not positive.
	void integrate(double dt);
	/// Largest stable step after the last computeForces() [s].
	double criticalStep() const { return dtLimit; }

	/// External force [N/m] and torque [N] of automaton i for the next integrate().
	void addForce(size_t i, Vec<double> force, Turn<double> torque);
	void clearForces();
	/// Velocity of automaton i along an axis for the next integrate() [m/s]; what its own mass takes is booked as work of the outside. Throws Error
	/// where it is not blocked along that axis, or tied.
	void   drive(size_t i, int axis, double velocity);
	/// Cundall's damping: takes this share of every component of force and torque away where it drives the motion, and adds it where it slows it down,
	/// as a force from outside for the next integrate(). Not physics: a way to a state of rest.
	void   resist(double share);
	/// Force that a pressure of 1 Pa inside of automaton i and of those it is linked to gives it: minus that is what 1 Pa on the free surface does [m].
	Vec<double> perPressure(size_t i) const;
	/// Puts a stress [Pa] into automaton i as it lies now: the deviator into its links, the pressure as a volume ratio; its rest state changes, nobody
	/// moves. Who has no volume by its links gets the deviator alone. Throws Error where the material does not bear it.
	void   setStress(size_t i, double pressure, const Deviator& deviator);
	void   checkStress(size_t i, double pressure, const Deviator& deviator) const; ///< throws what setStress() would
	/// Of pairs of materials; others than before count from the next computeForces() on. loaded: the contacts of a saved state have them already.
	/// Throws Error, and keeps those that are there, where their strength is too much for the fracture energy.
	void   setPairRules(const PairRules& rules, bool loaded = false)
	{
		if (rules == store.pairRules) return;
		if (!loaded) checkCohesion(rules);
		searchDue |= !loaded;
		store.pairRules = rules;
	}
	/// Viscous (transmitting) boundary: force -b v, b = rho c A [kg/(m s)] per direction.
	void setDamping(size_t i, Vec<double> b);
	/// Automaton i is carried by others from now on: it keeps no mass of its own in the sums and moves with the velocity it is told.
	/// freeSpin: its rotation stays its own. Returns its place t in the order of the calls.
	size_t tie(size_t i, bool freeSpin = false);
	void   setTiedVelocity(size_t i, Vec<double> velocity, Turn<double> omega);
	/// Length of the last move [s]; 0: none, or others have moved automata since.
	double sinceLast() const { return lastMove; }
	/// Ways of the blocks, largest component of anyone, summed over the steps [m]; kept where somebody has given it their number.
	std::vector<double> travelled;
	/// Time [s] over which the forces of a step of dt act on the velocities: half of the step before and half of this one.
	double kick(double dt) const { return lastDt > 0 ? 0.5 * (lastDt + dt) : dt; }
	/// Place of the caller's number in the arrays, or -1. Changes with every sort.
	int64_t indexOf(int32_t id) const { return id >= 0 && size_t(id) < place.size() ? place[id] : -1; }

	Account  account() const;
	Options  options;
	Counters counters;
	Store    store;
	Contacts contacts;
	Bonds    bonds; ///< broken pairs that still hold together
	double   time = 0;
	/// Links that hold, both ends once: (id, id).
	std::vector<std::pair<int32_t, int32_t>> links() const;
	/// Breaks these links (pairs of callers' numbers) at the start of the next computeForces(), as fracture does; returns how many of them hold.
	/// Throws Error for an unknown number.
	size_t cut(const std::vector<std::pair<int32_t, int32_t>>& pairs);
	/// All that have broken, in turn.
	struct {
		std::vector<double>  time;
		std::vector<int32_t> first, second, cause; ///< BreakCause
		Vectors              middle, normal;       ///< of the link [m]; from the first to the second
	} broken;
	/// After positions or velocities were changed from outside: new contact search, no strain from the change. Call computeForces() before
	/// changing anything, so that the strain of the last step is not lost.
	void moved();
	/// The next computeForces() searches contacts anew: their range or the groups have changed.
	void searchAnew() { searchDue = true; }
	/// Whether the rotation of automaton i is its own, about some axis.
	bool turnsFreely(size_t i) const
	{
		bool some = false;
		for (int c = 0; c < turns; c++) some |= turnPlane(store.perInertia, c)[i] > 0;
		return some;
	}
	/// Automata carried by others.
	size_t tiedCount() const { return tied.size(); }
	/// Sum of the volume terms of the contacts of automaton i [-].
	double contactSum(size_t i) const { return scratch.sum.empty() ? 0. : scratch.sum[i]; }
	/// Mises stress [Pa].
	double equivalentStress(size_t i) const;
	/// The automaton that limits the time step.
	size_t stiffestAutomaton() const;
	/// All state as bytes, and back; continuing is bit-identical. load throws Error and changes nothing when the bytes are no state:
	/// every length, index, flag and number is checked. Damage that leaves a possible state is not seen: whoever keeps the bytes keeps a checksum.
	std::string save() const;
	void        load(const std::string& bytes);
	/// Numbers of all automata, ascending.
	std::vector<int> ids() const;
	/// Throws Error unless `order` is ids(): what the caller keeps beside the saved state belongs to it.
	void checkOrder(const std::vector<int>& order) const;
	/// Whether automaton `id` was the t-th to be tied.
	bool isTied(size_t t, int32_t id) const { return t < tied.size() && store.id[size_t(tied[t])] == id; }
	/// The timers of counters run only when asked.
	bool timing = false;
	/// Tests: what breaks makes the whole list of contacts anew, not only what it adds; nothing else changes by a bit.
	bool wholeLists = false;

private:
	void   makeBlocks(const std::vector<Automaton>& automata);
	struct Near { ///< automata to be linked to one
		int     count = 0;
		int32_t other[nLinks];
		Lattice::Bearing bearing[nLinks];
	};
	void   makeLinks(const Solver* old);
	void   makeOutlines(const Solver* old);
	void   checkOutlines(const std::vector<Automaton>& automata, const Solver* old) const;
	void   halveLinks(size_t i, const std::function<bool(size_t)>& isFresh);
	void   makeMirrors(const std::vector<Automaton>& automata, const Solver* old);
	bool   closes(size_t i, int k) const;
	Triangles trianglesAround(size_t i) const;
	double slots(size_t i) const;
	void   dropOutside(size_t i);
	void   placeLinks(const std::vector<Near>& near, const Solver* old);
	void   checkPlaces() const;
	/// Place of a number in the old solver, -1 when that was another automaton or there is none.
	int64_t indexIn(const Solver& old, int32_t id) const { return size_t(id) < isNew.size() && isNew[size_t(id)] ? -1 : old.indexOf(id); }
	void   inheritLinks(const Solver& old);
	void   inheritState(const Solver& old);
	void   inheritTied(const Solver& old);
	void   inheritContacts(const Solver& old);
	void   makeAdjacency();
	void   classify();
	void   sortInSpace();
	void   searchIfNeeded();
	void   placeInNearCells();
	bool   mayTouch(double reach);
	void   watchToo(int32_t i);
	void   watchForeign(int32_t i);
	void   watchEnds(const std::vector<int32_t>& ends);
	void   readyWatch();
	std::vector<int32_t> exposed() const;
	void   search();
	void   searchEnds(const std::vector<int32_t>& ends);
	void   afterSearch();
	void   wake();
	void   wakeAround(size_t block);
	template <class F> void eachBreaking(F&& f) const;
	bool   breaking() const;
	double determinantNow(size_t i) const;
	void   keepVolume(size_t i, double J);
	void   scaleStresses(size_t i, double ratio);
	int    linkOf(size_t i, size_t j) const;
	void   noteBreak(size_t i, int k, BreakCause cause);
	BreakCause           causeAt(size_t i, int k) const;
	Breaking             breakingOf(size_t i, int k) const;
	bool                 bondAt(size_t i, int k, BreakCause cause);
	bool                 spansVolume(size_t i) const;
	double               lostToBond(size_t i, int k, Vec<double> r) const;
	void                 leavePush(size_t i, int k);
	void                 pullTogether();
	double               energyOfBonds() const;
	void                 checkCohesion(const PairRules& rules) const;
	LinkEnd              linkEnd(size_t i, int k) const;
	std::vector<int32_t> breakLinks();
	void   settleVolumes();
	void   filterVolumes();
	void   volumeChanges(size_t block, double lasted);
	double shiftVolume(size_t i, double J);
	// computeForces() in its order
	void  exchangeVolumes();
	Extra extra();
	void  volumes(const Extra&);
	void  stresses(const Extra&);
	void  forces(const Extra&);
	void  viscousHeats();
	void  bookPasses();
	void  limitStep();
	bool  isPushed(size_t block) const { return !pushed.empty() && pushed[block]; }
	void  checkResults(double nearestContact, size_t closest);
	// integrate()
	struct ForceShares {
		Vec<double> volumetric, viscous;
	};
	void        checkForces();
	ForceShares sharesOf(size_t i) const;
	struct Kicked;
	void        bookBlock(size_t b, double kick, double after, const Kicked& to);
	void        bookStep(double kick, double after);
	void   unlink(size_t i, int k, bool books);
	double ownMass() const; ///< of all that are not tied
	double coldEnergyAt(size_t i, double J) const;
	double contactEnergyAt(size_t i, double Jc) const;
	double deviatorEnergyOf(size_t i) const; ///< of links and szz [J/m]
	template <class F> void eachAwake(F&& f);
	template <class F> void archive(F&& f);
	static uint64_t         layout(); ///< of the saved state: follows from the names and kinds of what archive() lists
	void                    checkBroken() const;
	void                    checkBonds() const;
	void                    checkState() const; ///< after loading: throws Error unless all fits together
	[[noreturn]] void       overlapError(size_t i, size_t j, double ratio) const;

	std::vector<int32_t>     place;
	std::vector<char>        isNew; ///< by number, in build only
	std::vector<BlockResult> results;
	std::vector<BlockWork>   works;
	/// Work in a step of one block [J/m], impulses [N s/m].
	struct StepWork {
		double      volumetric = 0, viscous = 0, deviatoric = 0, external = 0, boundary = 0, centre = 0;
		Vec<double> impulse {};
	};
	std::vector<StepWork>    stepWorks;
	ContactWork              contactWork; ///< of the present step
	ContactScratch           scratch;
	struct {
		Vectors volumetric, viscous; ///< volumetric and viscous share of the forces of links
	} accountForce;
	std::vector<double>      takesPart, curvature, change; ///< scratch of filterVolumes()
	double                   filterTime = 0;    ///< since its last call [s]
	bool                     flows = false;     ///< some material yields
	int64_t                  lastSort = 0;
	size_t                   knownBonds = 0; ///< of bonds, those that broke before the present step
	std::vector<int32_t>     asked; ///< numbers of pairs whose links break at the start of the next step
	std::vector<std::pair<int32_t, double>> unsettled; ///< lost its links in the present search, with the volume that contacts must take over
	Vectors              searched; ///< where all automata were at the last search of all: the list of contacts is that of these places, see searchEnds()
	std::vector<int32_t> watch;    ///< whose displacements since then tell when contacts are searched anew, see watched(); in any order
	// what follows from these two
	Vectors           watchPlace;   ///< those of the watched
	std::vector<char> isWatched;    ///< of all automata
	BlockBoxes        searchedBoxes; ///< made when they are needed
	struct {
		Cells                                    cells; ///< of all automata
		std::vector<int32_t>                     used;  ///< number of each cell that holds someone watched, else -1; made when they are needed
		std::vector<int32_t>                     of;    ///< cell of each watched automaton
		std::vector<std::pair<int32_t, int32_t>> pairs; ///< of cells next to each other, once
		int32_t                                  count = 0;
	} nearCells; ///< where they were at the last search
	Contacts                 contactsBefore; ///< memory for the next search
	std::vector<int32_t>     adjacentBegin, adjacent; ///< blocks next to a block by links
	std::vector<std::pair<int32_t, int32_t>> contactAdjacent;
	std::vector<int32_t>     awake;
	std::vector<int32_t>     tied;
	Vectors                                  tiedVelocity; ///< before the present step
	Turns                                    tiedSpin;     ///< before the present step
	double                   lastDt = 0, lastMove = 0, dtLimit = 0, contactSpeed2 = 0;
	bool                     topologyChanged = true; ///< the list of awake blocks is out of date
	bool                     searchDue       = false;
	Account                  sums;
	std::vector<char>        pushed; ///< of the blocks: holds forces from outside
};
}
