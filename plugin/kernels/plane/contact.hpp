// SPDX-License-Identifier: GPL-2.0-or-later
// Friction of a contact in the plane, and the work it does.
#pragma once
#include "../automaton/contact.hpp"

namespace mca {
inline namespace MCA_SPACE {

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
}
