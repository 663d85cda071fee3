// SPDX-License-Identifier: GPL-2.0-or-later
// The solver as those see it who need not know in how many dimensions it moves: vectors have three components always, those out of the plane are zero in
// plane strain, and automata go by the caller's numbers. solver.hpp says what each call does.
#pragma once
#include "../kernels/api.hpp"
#include "../kernels/deviator.hpp"
#include "../kernels/dimension.hpp"
#include "../kernels/material.hpp"
#include "../kernels/wall.hpp"
#include "common.hpp"
#include "pair_rules.hpp"
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace mca {

namespace plane {
	namespace automata {
		class Solver;
	}
}

using Triple = std::array<double, 3>;
using Ways   = std::array<bool, 3>;

/// One automaton as the caller gives it.
struct AutomatonStart {
	Triple  position {}, velocity {}, spin {}, angle {};
	double  mass = 0, inertia = 0, diameter = 0, weight = 1, strength = 1, eqps = 0, damage = 0;
	double  temperature = 0; ///< [K]; 0: the material's reference temperature
	int32_t material = 0, id = 0, group = 0;
	Ways    free { true, true, true }, freeSpin { true, true, true }; ///< per direction: moves, turns as forces say
	Ways    mirror {}; ///< lies on a plane of symmetry with this normal; in space only
	int     triangles = 0; ///< of the packing that it shall stand for, to end at an outline (5g); 0: what its mass says
	bool    isNew = false; ///< build with an old solver: another automaton than the one that had this number there
};
/// What does not change by itself.
struct AutomatonFixed {
	double  mass = 0, inertia = 0, diameter = 0, strength = 0;
	int32_t material = 0, group = 0;
	Ways    free {}, freeSpin {};
	bool    tied = false;
};
struct AutomatonNow {
	Triple position {}, velocity {}, spin {}, angle {};
	double pressure = 0, volumeRatio = 1, plasticStrain = 0, damage = 0, temperature = 0, equivalentStress = 0;
	double stressZZ = 0; ///< deviator along z [Pa]
	std::optional<double> dissipated; ///< where a law heats
	double tension = 0;  ///< the pressure of the equation of state when it is negative [Pa]
	int    links = 0, brokenLinks = 0;
};
/// What the caller sets.
struct AutomatonChange {
	std::optional<Triple>  position, velocity, spin, angle;
	std::optional<double>  plasticStrain, damage, temperature, strength;
	std::optional<int32_t> group;
	std::optional<Ways>    free, freeSpin;
};

/// Links that have broken, in the order in which they did.
struct BrokenLinks {
	std::vector<double> time;                 ///< of the solver [s]
	std::vector<int>    first, second, cause; ///< the caller's numbers; BreakCause
	std::vector<Triple> middle, normal;       ///< of the link [m]; unit vector from the first to the second
};
/// Broken pairs that have not parted, in the order in which they broke.
struct CohesivePairs {
	std::vector<int>    first, second;  ///< the caller's numbers
	std::vector<double> opening, spent; ///< now [m]; share of the fracture energy [-]
};
/// A rigid body beside the automata.
struct WallStart {
	int      id = 0;
	WallForm form;
	double   friction = 0; ///< Coulomb coefficient [-]; the smaller of both counts
	double   mass     = 0; ///< [kg], in plane strain kg/m; 0: nothing that touches it moves it
};
/// A contact that has held a shear force.
struct WallTouch {
	int   automaton = 0, wall = 0; ///< the caller's numbers
	Point shear;                   ///< on the automaton [N/m, in space N]
};
struct WallPush {
	Point force, torque; ///< on the wall, about its position
};

class MCA_API Automata {
public:
	virtual ~Automata() = default;
	virtual int    dimension() const = 0;
	/// The solver of plane strain itself; null in space.
	virtual plane::automata::Solver* asPlane() = 0;

	virtual void build(const std::vector<AutomatonStart>&, const std::vector<Material>&, const AutomataOptions&, const Automata* old) = 0;
	virtual void computeForces() = 0;
	virtual void integrate(double dt) = 0;
	virtual double kick(double dt) const = 0; ///< time over which the forces of a step of dt act on velocities [s]
	virtual double criticalStep() const = 0;
	virtual int    stiffest() const = 0; ///< the automaton that limits the step

	virtual void addForce(int id, const Triple& force, const Triple& torque) = 0;
	/// Velocity along an axis, which must be blocked, for the next integrate() [m/s].
	virtual void drive(int id, int axis, double velocity) = 0;
	virtual void addGravity(const Triple& acceleration) = 0;
	virtual void addPressure(int id, double pressure) = 0; ///< on the free side of an automaton [Pa]
	virtual void resist(double share) = 0;
	virtual void checkStress(int id, double pressure, const Deviator& deviator) const = 0;
	virtual void setStress(int id, double pressure, const Deviator& deviator) = 0;
	virtual void setPairRules(const PairRules& rules, bool loaded) = 0;
	virtual void clearForces() = 0;
	virtual bool hasForces() const = 0; ///< some have been added at some time
	virtual void setDamping(int id, const Triple& b) = 0;
	virtual void set(int id, const AutomatonChange&) = 0;
	virtual void moved() = 0;
	/// Rigid bodies that automata touch from the next pushWalls() on; contacts go on by the numbers.
	virtual void setWalls(const std::vector<WallStart>&) = 0;
	/// Puts the forces of the walls, which are at these places in the order of setWalls(), on the automata for the next integrate() and returns theirs.
	/// level: where the plane of plane strain lies [m]. Throws Error where somebody is too deep in a wall.
	virtual const std::vector<WallPush>& pushWalls(const std::vector<WallPlace>&, double level) = 0;
	virtual std::vector<WallTouch> wallTouches() const = 0; ///< what a saved state keeps of it
	virtual void                   setWallTouches(const std::vector<WallTouch>&) = 0;
	virtual void searchAnew() = 0;

	virtual bool           holds(int id) const = 0;
	virtual AutomatonFixed fixed(int id) const = 0;
	virtual AutomatonNow   now(int id) const = 0;
	virtual size_t         tiedCount() const = 0;
	virtual const std::vector<Material>& materials() const = 0;
	virtual AccountOf<Triple, Triple>    account() const = 0;
	virtual std::vector<std::pair<int32_t, int32_t>> links() const = 0;
	virtual BrokenLinks                              brokenLinks() const = 0;
	virtual CohesivePairs                            cohesivePairs() const = 0;
	virtual size_t                                   cut(const std::vector<std::pair<int32_t, int32_t>>&) = 0;
	/// One quantity of these automata. Throws Error that lists the names when there is none of this name, with `call` in it.
	virtual std::vector<double> quantity(const std::vector<int>& ids, const std::string& name, const std::string& call) const = 0;
	struct Work {
		long blocks = 0, awake = 0, contacts = 0;
	};
	virtual Work work() const = 0; ///< blocks of 64, those that are awake, pairs in contact range

	virtual AutomataOptions&        options() = 0;
	virtual const AutomataCounters& counters() const = 0;
	virtual void                    setTiming(bool on) = 0;
	virtual std::string save() const = 0;
	virtual void        load(const std::string& bytes) = 0;
	virtual void        checkOrder(const std::vector<int>& ids) const = 0;
};

namespace plane {
	MCA_API std::unique_ptr<Automata> makeAutomata(); ///< without automata
	MCA_API double cellOf(double diameter);           ///< area at rest of an automaton of this diameter [m2]
}
namespace space {
	MCA_API std::unique_ptr<Automata> makeAutomata();
	MCA_API double cellOf(double diameter); ///< [m3]
}
/// In 2 dimensions or 3.
inline std::unique_ptr<Automata> automataIn(int dimension) { return dimension == 3 ? space::makeAutomata() : plane::makeAutomata(); }
inline double                    cellIn(int dimension, double diameter) { return dimension == 3 ? space::cellOf(diameter) : plane::cellOf(diameter); }
}
