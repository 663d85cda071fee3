// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts: pairs that are not linked. Each side has a rest distance of its own; no tension, Coulomb friction.
#pragma once
#include "deviator.hpp"
#include "volume.hpp"

namespace mca {

/// A link of material that can break does so when it is shorter than this; pairs found closer do not touch [rest distances]
constexpr double collapsed = 0.4;
/// Contacts may not overlap deeper: (r/d)^2 [-]
constexpr double deepestContact = 0.25;
/// Nor links [-]
constexpr double deepestLink = 0.04;
/// A pair touches when its distance squared is below this share of its rest distance squared: a pair that has just got its present distance as
/// rest distance must not touch by round-off, since the viscosity acts from the first touch
constexpr double touchShare = 1. - 1e-14;

/// 1 where a side pushes at this distance squared, else 0. Two automata that have slid into each other do not touch until they have parted: near zero distance
/// a pair force has no meaning, and the volume they share is held by their other neighbours.
MCA_INLINE double pushes(double r2, double rest, double d) { return r2 < touchShare * sqr(rest) ? (rest >= collapsed * d ? 1. : 0.) : 0.; }
/// Rest distance after this step: a pair that had come into contact already closer than d gets it back as it parts; no energy is in it then.
MCA_INLINE double restAfter(double rest, double r2, double d) { return r2 < rest * rest ? rest : min(std::sqrt(r2), d); }
/// Surfaces meet at d; a pair that is found closer (its link broke, or its automata have just become a surface) starts without push.
MCA_INLINE double restAtStart(double d, double r2) { return min(d, std::sqrt(r2)); }
/// Arm of an automaton over the distance of a pair [-].
MCA_INLINE double arm(double d, double dOther) { return d / (d + dOther); }

/// One side of a contact in a step; stresses J times them [Pa].
struct ContactSide {
	Pair<double> before;   ///< over the J of the step before
	Pair<double> trial;    ///< over J: before yield and friction
	double       pressure; ///< pressure force of the pair over r [N/m2]
	double       r2, d;    ///< [m2], [m]
	double       friction; ///< [-]
	double       J, scale; ///< of the owner: volume ratio; J times the scale of its radial return
	bool         touches;
};
/// (10), then no tension and Coulomb friction: normal pair force S s/r - push <= 0. Each side keeps within it, so their mean does.
MCA_INLINE Pair<double> afterFriction(const ContactSide& c)
{
	const double sMax = c.pressure * c.r2 / (Lattice::width(c.d) * c.d);
	const double s = min(c.trial.normal * c.scale, sMax), tMax = c.friction * (sMax - s);
	return { s, min(max(c.trial.shear * c.scale, -tMax), tMax) };
}
/// What one side of a contact dissipates in a step [J/m].
struct ContactWork {
	double friction = 0, coupling = 0, plastic = 0;
};
/// This side's half, area S0 d/2; stress/(2G) = elastic strain. Taken out at the mean of the stresses before and after the step, as the forces do their
/// work; a pair that parts loses what it still held. after = afterFriction(c); own, other: dilation() of both; perTwoG = 1/(2G of the pair), perOwnG = 1/(G of
/// the owner), 0 where that is zero.
MCA_INLINE ContactWork contactWork(const ContactSide& c, Pair<double> after, double perTwoG, double perOwnG, double own, double other)
{
	const double area = 0.5 * Lattice::width(c.d) * c.d, perJ = area / c.J, perG = 0.5 * perJ * perTwoG, perOwn = 0.25 * perJ * perOwnG;
	const double so = c.before.normal * c.J, to = c.before.shear * c.J, st = c.trial.normal * c.J, tt = c.trial.shear * c.J;
	const double s0 = c.trial.normal * c.scale, t0 = c.trial.shear * c.scale, s = after.normal, t = after.shear, held = perG * fma(so, so, to * to);
	// the radial return took (so + s)(st - s0) with the stiffness of the pair; booked as plastic with the links: (so + s0)(st - s0) with the owner's own
	const double plastic = (perG * (so + s) - perOwn * (so + s0)) * (st - s0) + (perG * (to + t) - perOwn * (to + t0)) * (tt - t0);
	// as for links: pair work that goes into volume change
	const double coupling = area * 0.5 * (so + s) * pairDilation(own, other, ofBoth) - own * held,
		     rubbed   = perG * ((so + s) * (s0 - s) + (to + t) * (t0 - t));
	return { c.touches ? rubbed : held, c.touches ? coupling : 0., c.touches ? plastic : 0. };
}
}
