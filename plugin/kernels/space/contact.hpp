// SPDX-License-Identifier: GPL-2.0-or-later
// Friction of a contact in space, and the work it does.
#pragma once
#include "../automaton/contact.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// One side of a contact in a step; stresses J times them [Pa].
struct ContactSide {
	Vec<double> before;   ///< over the J of the step before
	Vec<double> trial;    ///< over J: before yield and friction
	Vec<double> normal;   ///< unit vector from the owner to the other
	double      pressure; ///< pressure force of the pair over r [N/m]
	double      r2, d;    ///< [m2], [m]
	double      friction; ///< [-]
	double      J, scale; ///< of the owner: volume ratio; J times the scale of its radial return
	bool        touches;
};
/// Radial return, then no tension and Coulomb friction: normal pair force S s/r - push <= 0, shear along its own direction. Each side keeps within it, so
/// their mean does.
MCA_INLINE Vec<double> afterFriction(const ContactSide& c)
{
	const double      sMax = c.pressure * c.r2 / Lattice::area(c.d);
	const Vec<double> t    = c.trial * c.scale;
	const double      s = dot(t, c.normal), kept = min(s, sMax), tMax = c.friction * (sMax - kept);
	const Vec<double> shear = fma(-s, c.normal, t);
	const double      size2 = dot(shear, shear), share = size2 > tMax * tMax ? tMax / std::sqrt(size2) : 1.;
	return fma(kept, c.normal, shear * share);
}
/// What one side of a contact dissipates in a step [J].
struct ContactWork {
	double friction = 0, coupling = 0, plastic = 0;
};
/// This side's half, S0 d/2; stress/(2G) = elastic strain. Taken out at the mean of the stresses before and after the step, as the forces do their work; a pair
/// that parts loses what it still held. after = afterFriction(c); own, other: dilation() of both; perTwoG = 1/(2G of the pair), perOwnG = 1/(G of the owner), 0
/// where that is zero.
MCA_INLINE ContactWork contactWork(const ContactSide& c, Vec<double> after, double perTwoG, double perOwnG, double own, double other)
{
	const double      area = 0.5 * Lattice::area(c.d), perJ = area / c.J, perG = 0.5 * perJ * perTwoG, perOwn = 0.25 * perJ * perOwnG;
	const Vec<double> old = c.before * c.J, trial = c.trial * c.J, returned = c.trial * c.scale, mean = old + after;
	const double      held = perG * dot(old, old);
	// the radial return took mean times its change with the stiffness of the pair; booked as plastic with the links: with the owner's own
	const double plastic  = dot(mean * perG - (old + returned) * perOwn, trial - returned);
	const double coupling = area * 0.5 * dot(mean, c.normal) * pairDilation(own, other, ofBoth) - own * held, rubbed = perG * dot(mean, returned - after);
	return { c.touches ? rubbed : held, c.touches ? coupling : 0., c.touches ? plastic : 0. };
}
}
}
