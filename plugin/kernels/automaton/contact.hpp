// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts: pairs that are not linked. Each side has a rest distance of its own; no tension, Coulomb friction.
#pragma once
#include "deviator.hpp"
#include "volume.hpp"

namespace mca {
inline namespace MCA_SPACE {

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
/// Distance at which this side of a pair meets the other [m]; factor: of the volume by links, 0 where there is none.
MCA_INLINE double meetsAt(double d, double factor)
{
	if constexpr (Lattice::looseRest == 1.) return d;
	else return factor > 0. ? d : Lattice::looseRest * d;
}
/// Rest distance after this step; d: meetsAt(). A pair that had come into contact already closer than d gets it back as it parts; no energy is in it then.
/// A link that has just broken starts at its present distance: where who is loose meets others closer, round-off must not decide.
MCA_INLINE double restAfter(double rest, double r2, double d)
{
	constexpr double share = Lattice::looseRest == 1. ? 1. : touchShare;
	return r2 < share * (rest * rest) ? rest : min(std::sqrt(r2), d);
}
/// Surfaces meet at d (who is loose gets meetsAt() as the pair parts); a pair that is found closer (its link broke, or its automata have just become a surface)
/// starts without push.
MCA_INLINE double restAtStart(double d, double r2) { return min(d, std::sqrt(r2)); }
/// Arm of an automaton over the distance of a pair [-].
MCA_INLINE double arm(double d, double dOther) { return d / (d + dOther); }
}
}
#if MCA_DIM == 2
#include "../plane/contact.hpp"
#else
#include "../space/contact.hpp"
#endif
