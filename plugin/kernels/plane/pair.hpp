// SPDX-License-Identifier: GPL-2.0-or-later
// What a side of a pair holds in the plane: a normal and a shear stress in the frame of the pair, which turns with it; an out-of-plane deviator beside them.
// Formulation, equations (5f), (6)-(11). t = n turned by +90 degrees.
#pragma once
#include "../automaton/deviator.hpp"
#include "../deviator.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// Normal and shear part of a pair: stress [Pa], or strain increment [-].
template <class T> struct Pair {
	T normal, shear;
};
template <class T> MCA_INLINE T square(Pair<T> a) { return fma(a.normal, a.normal, a.shear * a.shear); }
template <class T> MCA_INLINE T product(Pair<T> a, Pair<T> b) { return fma(a.normal, b.normal, a.shear * b.shear); }
inline double plainSquare(Pair<double> a) { return sqr(a.normal) + sqr(a.shear); } // every product rounded

/// What a side of a pair holds.
template <class T> using Side = Pair<T>;
template <class T> MCA_INLINE Pair<T> scaled(Pair<T> a, T f) { return { a.normal * f, a.shear * f }; }
/// a where it holds, else none
MCA_INLINE Pair<double> where(bool holds, Pair<double> a) { return { holds ? a.normal : 0., holds ? a.shear : 0. }; }
/// What a side along r holds of a stress, and what is normal to the plane [Pa].
inline Pair<double> sideOf(const Deviator& s, Vec<double> r)
{
	const double      per = 1. / std::sqrt(dot(r, r));
	const Vec<double> n   = r * per, on { s.xx * n[0] + s.xy * n[1], s.xy * n[0] + s.yy * n[1] };
	return { dot(on, n), cross(n, on) };
}
inline double outOfPlane(const Deviator& s) { return s.zz; }
/// Mean of both sides of a pair, over the area that each has a half of.
MCA_INLINE Pair<double> ofBothSides(double area, Pair<double> mine, Pair<double> theirs)
{
	return { area * (mine.normal + theirs.normal), area * (mine.shear + theirs.shear) };
}
/// Of a side whose other end is this far away.
MCA_INLINE double normalStress(Pair<double> side, Vec<double>) { return side.normal; }
/// The side with another normal part.
MCA_INLINE Pair<double> withNormal(Pair<double> side, Vec<double>, double normal) { return { normal, side.shear }; }
/// The side without a negative normal part.
MCA_INLINE Pair<double> withoutPush(Pair<double> side, Vec<double>) { return { max(side.normal, 0.), side.shear }; }

/// (7), (8): strain increments over the last step, at its middle. r now [m]; u = relative displacement of the step [m];
/// spin = (omega_i q_i + omega_j q_j)/(q_i + q_j) dt [-], q = distance from centre to contact.
template <class T> MCA_INLINE Pair<T> strainIncrement(Vec<T> r, Vec<T> u, T spin)
{
	const Vec<T> m   = fma(-0.5, u, r);
	const T      inv = 1. / dot(m, m);
	return { dot(m, u) * inv, cross(m, u) * inv - spin };
}
/// 2 tan(a/2) of a turn by a, to fifth order: what strainIncrement(), on the chord of the middle of the step, sees of it.
template <class T> MCA_INLINE T chord(T a)
{
	const T q = a * a * (1. / 12.);
	return fma(fma(q * 1.2, q, q), a, a);
}
/// Turn of a pair in a step by the spins of both [-]: arm of the first over the distance.
MCA_INLINE double pairSpin(double omega, double other, double arm, double dt) { return chord(fma(omega, arm, other * (1. - arm)) * dt); }
/// Stress of one side before yield; before: that of the last step.
template <class T> MCA_INLINE Pair<T> trialStress(Pair<T> before, Pair<T> strain, T pairDilation, T twoG)
{
	return { fma(twoG, strain.normal - pairDilation, before.normal), fma(twoG, strain.shear, before.shear) };
}
/// Both in one: the stress of a side over the last step.
template <class T> MCA_INLINE Pair<T> advanced(Pair<T> before, Vec<T> r, Vec<T> u, T spin, T pairDilation, T twoG)
{
	return trialStress(before, strainIncrement(r, u, spin), pairDilation, twoG);
}

/// weight: 1, 1/2 on a weighted rim; what a link that has just broken held goes on in its contact, so it has none in `holds`
template <bool account, class T> MCA_INLINE void add(PairSums<T>& to, Pair<T> before, Pair<T> trial, T pairDilation, T weight, T holds)
{
	to.square += square(trial) * weight;
	if (account) {
		to.squareBefore += holds * square(before), to.both += weight * product(before, trial);
		to.dilationBefore += holds * before.normal * pairDilation, to.dilationTrial += weight * trial.normal * pairDilation;
		to.dilationLost += (weight - holds) * before.normal * pairDilation;
	}
}

/// (9): out-of-plane deviator before yield (plane strain) [Pa].
MCA_INLINE double trialSzz(double twoG, double dilation, double before) { return fma(-twoG * (1. / 3.), dilation, before); }
/// Equivalent stress squared [Pa2] (10): meanSquare = mean over the slots of s^2 + tau^2; szz = out-of-plane deviator.
MCA_INLINE double equivalentStress2(double meanSquare, double szz) { return fma(3., meanSquare, 1.5 * szz * szz); }
MCA_INLINE double equivalentStress(double meanSquare, double szz) { return std::sqrt(equivalentStress2(meanSquare, szz)); }
/// The same with the pair stresses scaled by the radial return, szz after it.
MCA_INLINE double equivalentStressAfter(double scale, double meanSquare, double szz) { return std::sqrt(fma(3. * scale * scale, meanSquare, 1.5 * szz * szz)); }

/// sums: of links (and of contacts in `both` and `square`); szz before, trial and after; sixth = cell of the full packing / neighbours; invN = 1/slots.
/// conjugate: meanPressure() does the work that goes into volume; a link that has just broken was in it before the step.
MCA_INLINE PairWork pairWork(
	const PairSums<double>& sums, double trial, const Return& r, double J, double dilation, double szzBefore, double szzTrial, double szz, double threeG,
	double sixth, double invN, bool conjugate)
{
	const double before = equivalentStress(sums.squareBefore * invN, szzBefore);
	// the stress before the step along the direction of flow: the two need not be parallel
	const double both  = 3. * sums.both * invN + 1.5 * szzBefore * szzTrial;
	const double along = trial > 0. ? both / trial : 0.;
	const double pairs = sixth / invN; // volume the pairs stand for: the cell, but on weighted rims
	const double vol   = (sums.dilationBefore + r.scale * sums.dilationTrial) * invN + 0.5 * (szzBefore + szz) * dilation * (1. / 3.);
	const double apart = conjugate ? -sums.dilationLost * invN : vol;
	return { pairs * J * 0.5 * (along + trial * r.scale) * r.dEqps, pairs * J * (apart - (threeG > 0 ? dilation * before * before / (2. * threeG) : 0.)) };
}

/// (5f): P and what the deviators of the automaton's own sides do with its volume [Pa]. normals = sum of weight J s over its links, full = cell of the whole
/// packing. In a uniform field of a whole star the second part is zero. What is below the last bit of a strain is nothing, as it is in P: else the front of
/// numbers that are not zero runs twice as fast into material at rest. bulk: rho0 c0^2 [Pa].
MCA_INLINE double meanPressure(double P, double normals, double J, double szz, double invN, double full, double cell, double bulk)
{
	const double own = full / cell * fma(normals, 2. / (3. * nLinks * J), szz / (3. * nLinks * invN));
	return P + (std::fabs(own) > 2.3e-16 * bulk ? own : 0.);
}

/// Force of a link: stress = sum over both sides times the area, over r [N/m over m]; push: of the pressures.
template <class T> MCA_INLINE Vec<T> linkForce(Vec<T> r, T along, T across, Vec<T> push) { return fma(along, r, fma(across, turned(r), -push)); }
/// Force of a contact: stress as for links, viscous = viscousCoefficient(), pressure over r [N/m2].
template <class T> MCA_INLINE Vec<T> contactForce(Vec<T> r, Pair<T> stress, T invR2, T viscous, T pressure)
{
	const T along = fma(stress.normal, invR2, viscous - pressure), across = stress.shear * invR2;
	return fma(along, r, turned(r) * across);
}
/// Torque of a contact about its owner's centre, which is arm times the distance away; stress as for the force.
MCA_INLINE double contactTorque(double arm, Vec<double>, Pair<double> stress, Vec<double>) { return arm * stress.shear; }
}
}
