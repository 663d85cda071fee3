// SPDX-License-Identifier: GPL-2.0-or-later
// Pair stresses of an automaton, its yield and the work that goes with both. Formulation, equations (7)-(11).
// n = unit vector i -> j, r = x_j - x_i; tension positive. Each side of a pair has its own stress, kept as J times it. What it consists of: plane/pair.hpp and
// space/pair.hpp.
#pragma once
#include "../lattice.hpp"
#include "../material.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// Shares of the dilations of two automata in the linear strain that a pair leaves out of its deviator [-].
struct DilationShares {
	double own, other;
};
/// A third of the mean of both.
constexpr DilationShares ofBoth { 1. / 6., 1. / 6. };
/// A third of that of the side itself: links of the affine rule. What the stress of a side does with its automaton's volume stands in meanPressure() then, and
/// the stiffness is symmetric everywhere, rims included.
constexpr DilationShares ofOwn { 1. / 3., 0. };
/// Linear strain that a pair leaves out of its deviator; own, other: dilation() of both automata [-].
template <class T> MCA_INLINE T pairDilation(T own, T other, DilationShares share) { return fma(share.own, own, share.other * other); }
/// 1/J of the step before, from J now and its dilation().
template <class T> MCA_INLINE T perOldRatio(T dilation, T J) { return (2. + dilation) / ((2. - dilation) * J); }
/// Series rule for the stiffness 2G of a pair [Pa]; q = arm of the first / distance.
MCA_INLINE double seriesTwoG(double Ga, double Gb, double q) { return Ga > 0 && Gb > 0 ? 2. / (q / Ga + (1. - q) / Gb) : 0.; }

/// Sums over the pairs of an automaton. Those with 'before' and 'dilation' are for the energy account.
template <class T> struct PairSums {
	T square {};         ///< of the trial stresses
	T squareBefore {};   ///< of the stresses before the step
	T both {};           ///< of the products of the two
	T dilationBefore {}; ///< of normal stress before times pairDilation()
	T dilationTrial {};
	T dilationLost {}; ///< as dilationBefore, of links that have just broken
};

/// Plastic work per mass of a step [J/kg]: goes into the internal energy.
MCA_INLINE double plasticHeat(double J, double trial, const Return& r, double perRho) { return J * r.scale * trial * r.dEqps * perRho; }
/// (11), temperature after the step [K].
MCA_INLINE double warmed(const Yield& y, double temperature, double trial, const Return& r)
{
	return fma(y.heatPerWork * r.scale * trial, r.dEqps, temperature);
}

/// Work of a step, booked for the energy account [J/m].
struct PairWork {
	double plastic;
	double coupling; ///< pair work that goes into volume change rather than into the stored deviatoric energy J sigma_eq^2/(6G); zero in a uniform field
};
}
}
#if MCA_DIM == 2
#include "../plane/pair.hpp"
#else
#include "../space/pair.hpp"
#endif
