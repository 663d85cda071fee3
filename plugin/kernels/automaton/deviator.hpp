// SPDX-License-Identifier: GPL-2.0-or-later
// Pair stresses of an automaton, its yield and the work that goes with both. Formulation, equations (7)-(11).
// n = unit vector i -> j, r = x_j - x_i, t = n turned by +90 degrees; tension positive. Each side of a pair has its own stress, kept as J times it.
#pragma once
#include "../lattice.hpp"
#include "../material.hpp"

namespace mca {

/// Normal and shear part of a pair: stress [Pa], or strain increment [-].
template <class T> struct Pair {
	T normal, shear;
};
template <class T> MCA_INLINE T square(Pair<T> a) { return fma(a.normal, a.normal, a.shear * a.shear); }
template <class T> MCA_INLINE T product(Pair<T> a, Pair<T> b) { return fma(a.normal, b.normal, a.shear * b.shear); }

/// (7), (8): strain increments over the last step, at its middle. r now [m]; u = relative displacement of the step [m];
/// spin = (omega_i q_i + omega_j q_j)/(q_i + q_j) dt [-], q = distance from centre to contact.
template <class T> MCA_INLINE Pair<T> strainIncrement(Vec<T> r, Vec<T> u, T spin)
{
	const Vec<T> m   = fma(-0.5, u, r);
	const T      inv = 1. / dot(m, m);
	return { dot(m, u) * inv, cross(m, u) * inv - spin };
}
/// Linear strain that goes with a dilation, mean of two automata: a third of half their sum.
constexpr double linearShare = 1. / 6.;
/// Turn of a pair in a step by the spins of both [-]: arm of the first over the distance.
MCA_INLINE double pairSpin(double omega, double other, double arm, double dt) { return fma(omega, arm, other * (1. - arm)) * dt; }
/// Mean linear strain that a pair takes for its two automata; own, other: dilation() [-].
template <class T> MCA_INLINE T pairDilation(T own, T other) { return (own + other) * linearShare; }
/// 1/J of the step before, from J now and its dilation().
template <class T> MCA_INLINE T perOldRatio(T dilation, T J) { return (2. + dilation) / ((2. - dilation) * J); }
/// Stress of one side before yield; before: that of the last step.
template <class T> MCA_INLINE Pair<T> trialStress(Pair<T> before, Pair<T> strain, T pairDilation, T twoG)
{
	return { fma(twoG, strain.normal - pairDilation, before.normal), fma(twoG, strain.shear, before.shear) };
}
/// Series rule for the stiffness 2G of a pair [Pa]; q = arm of the first / distance.
MCA_INLINE double seriesTwoG(double Ga, double Gb, double q) { return Ga > 0 && Gb > 0 ? 2. / (q / Ga + (1. - q) / Gb) : 0.; }

/// Sums over the pairs of an automaton. Those with 'before' and 'dilation' are for the energy account.
template <class T> struct PairSums {
	T square {};         ///< of the trial stresses
	T squareBefore {};   ///< of the stresses before the step
	T both {};           ///< of the products of the two
	T dilationBefore {}; ///< of normal stress before times pairDilation()
	T dilationTrial {};
	/// weight: 1, 1/2 on a weighted rim; what a link that has just broken held goes on in its contact, so it has none in `holds`
	template <bool account> MCA_INLINE void add(Pair<T> before, Pair<T> trial, T pairDilation, T weight, T holds)
	{
		square += mca::square(trial) * weight;
		if (account) {
			squareBefore += holds * mca::square(before), both += weight * product(before, trial);
			dilationBefore += holds * before.normal * pairDilation, dilationTrial += weight * trial.normal * pairDilation;
		}
	}
};

/// (9): out-of-plane deviator before yield (plane strain) [Pa].
MCA_INLINE double trialSzz(double twoG, double dilation, double before) { return fma(-twoG * (1. / 3.), dilation, before); }
/// Equivalent stress squared [Pa2] (10): meanSquare = mean over the slots of s^2 + tau^2; szz = out-of-plane deviator.
MCA_INLINE double equivalentStress2(double meanSquare, double szz) { return fma(3., meanSquare, 1.5 * szz * szz); }
MCA_INLINE double equivalentStress(double meanSquare, double szz) { return std::sqrt(equivalentStress2(meanSquare, szz)); }
/// The same with the pair stresses scaled by the radial return, szz after it.
MCA_INLINE double equivalentStressAfter(double scale, double meanSquare, double szz) { return std::sqrt(fma(3. * scale * scale, meanSquare, 1.5 * szz * szz)); }

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
/// sums: of links (and of contacts in `both` and `square`); szz before, trial and after; sixth = cell of the full packing / neighbours; invN = 1/slots.
MCA_INLINE PairWork pairWork(
	const PairSums<double>& sums, double trial, const Return& r, double J, double dilation, double szzBefore, double szzTrial, double szz, double threeG,
	double sixth, double invN)
{
	const double before = equivalentStress(sums.squareBefore * invN, szzBefore);
	// the stress before the step along the direction of flow: the two need not be parallel
	const double both  = 3. * sums.both * invN + 1.5 * szzBefore * szzTrial;
	const double along = trial > 0. ? both / trial : 0.;
	const double pairs = sixth / invN; // volume the pairs stand for: the cell, but on weighted rims
	const double vol   = (sums.dilationBefore + r.scale * sums.dilationTrial) * invN + 0.5 * (szzBefore + szz) * dilation * (1. / 3.);
	return { pairs * J * 0.5 * (along + trial * r.scale) * r.dEqps, pairs * J * (vol - (threeG > 0 ? dilation * before * before / (2. * threeG) : 0.)) };
}
}
