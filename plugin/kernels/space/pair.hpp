// SPDX-License-Identifier: GPL-2.0-or-later
// What a side of a pair holds in space: a traction in the frame of the laboratory, which is turned with the pair. In a uniform state it is the deviator times
// n, and that of the other side its negative.
#pragma once
#include "../automaton/deviator.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// What a side of a pair holds.
template <class T> using Side = Vec<T>;
template <class T> MCA_INLINE T       square(Vec<T> a) { return dot(a, a); }
template <class T> MCA_INLINE T       product(Vec<T> a, Vec<T> b) { return dot(a, b); }
template <class T> MCA_INLINE Vec<T>  scaled(Vec<T> a, T f) { return a * f; }
/// a where it holds, else none
MCA_INLINE Vec<double> where(bool holds, Vec<double> a) { return { holds ? a[0] : 0., holds ? a[1] : 0., holds ? a[2] : 0. }; }
/// Mean of both sides of a pair, over the area that each has a half of.
template <class T> MCA_INLINE Vec<T> ofBothSides(T area, Vec<T> mine, Vec<T> theirs) { return (mine - theirs) * area; }
/// Of a side whose other end is this far away.
MCA_INLINE double normalStress(Vec<double> side, Vec<double> r) { return plainDot(side, r) / std::sqrt(plainSquare(r)); }

/// 2 tan(a/2) along the axis of a turn by a, to fifth order: what pairMotion(), on the chord of the middle of the step, sees of it.
template <class T> MCA_INLINE Vec<T> chord(Vec<T> a)
{
	const T q = dot(a, a) * (1. / 12.);
	return fma(fma(q * 1.2, q, q), a, a);
}
/// Turn of a pair in a step by the spins of both [-]: arm of the first over the distance.
MCA_INLINE Vec<double> pairSpin(Vec<double> omega, Vec<double> other, double arm, double dt) { return chord(fma(arm, omega, other * (1. - arm)) * dt); }

/// What a pair does over the last step, at its middle.
template <class T> struct PairMotion {
	Vec<T> strain; ///< [-], along the pair and across it: both have the stiffness 2G
	Vec<T> turn;   ///< [-], about the pair with the mean spin
	Vec<T> normal; ///< n
};
/// r now [m]; u = relative displacement of the step [m]; spin: pairSpin().
template <class T> MCA_INLINE PairMotion<T> pairMotion(Vec<T> r, Vec<T> u, Vec<T> spin)
{
	const Vec<T> m   = fma(-0.5, u, r);
	const T      inv = 1. / dot(m, m), perLength = root(inv);
	return { (u - cross(spin, m)) * perLength, fma(dot(spin, m), m, cross(m, u)) * inv, m * perLength };
}
/// a turned by w = 2 tan(angle/2) along the axis (Cayley): its length stays.
template <class T> MCA_INLINE Vec<T> rotated(Vec<T> a, Vec<T> w)
{
	const Vec<T> c = cross(w, a);
	return fma(1. / fma(0.25, dot(w, w), T {} + 1.), fma(0.5, cross(w, c), c), a);
}
/// Traction of a side before yield, and that of the step before in the frame of now.
template <class T> struct Advance {
	Vec<T> trial, before;
};
/// Implicit mid-point: half of the increment before the turn, half after it.
template <class T> MCA_INLINE Advance<T> advance(Vec<T> before, const PairMotion<T>& p, T pairDilation, T twoG)
{
	const Vec<T> half = fma(-pairDilation, p.normal, p.strain) * (0.5 * twoG), now = rotated(before + half, p.turn);
	return { now + half, now - half };
}
template <class T> MCA_INLINE Vec<T> advanced(Vec<T> before, Vec<T> r, Vec<T> u, Vec<T> spin, T pairDilation, T twoG)
{
	return advance(before, pairMotion(r, u, spin), pairDilation, twoG).trial;
}

/// old: stress of the step before; weight: 1, 1/2 where a link counts half; what a link that has just broken held goes on in its contact, so it has none in
/// `holds`.
template <bool account, class T>
MCA_INLINE void add(PairSums<T>& to, Vec<T> old, const Advance<T>& a, Vec<T> normal, T pairDilation, T weight, T holds)
{
	to.square += square(a.trial) * weight;
	if (account) {
		const T before = dot(a.before, normal) * pairDilation;
		to.squareBefore += holds * square(old), to.both += weight * product(a.before, a.trial);
		to.dilationBefore += holds * before, to.dilationTrial += weight * dot(a.trial, normal) * pairDilation;
		to.dilationLost += (weight - holds) * before;
	}
}

/// Equivalent stress [Pa]: meanSquare = mean over the slots of the squares of the tractions, sides without a link counted as zero.
MCA_INLINE double equivalentStress(double meanSquare) { return std::sqrt(4.5 * meanSquare); }

/// sums: of links (and of contacts in `both` and `square`); share = cell of the full packing / neighbours; invN = 1/slots.
/// conjugate: meanPressure() does the work that goes into volume; a link that has just broken was in it before the step.
MCA_INLINE PairWork
pairWork(const PairSums<double>& sums, double trial, const Return& r, double J, double dilation, double threeG, double share, double invN, bool conjugate)
{
	const double squares = 2.25 * sums.squareBefore * invN + 0.5 * sqr(r.scale * trial); // of the equivalent stress, mean over the step
	// the stress before the step along the direction of flow: the two need not be parallel
	const double along = trial > 0. ? 4.5 * sums.both * invN / trial : 0.;
	const double pairs = share / invN; // volume the pairs stand for: the cell, but on weighted rims
	const double apart = 1.5 * invN * (conjugate ? -sums.dilationLost : sums.dilationBefore + r.scale * sums.dilationTrial);
	return { pairs * J * 0.5 * (along + trial * r.scale) * r.dEqps, pairs * J * (apart - (threeG > 0 ? dilation * squares / (2. * threeG) : 0.)) };
}

/// P and what the deviators of the automaton's own sides do with its volume [Pa]. normals = sum of weight times J times the tractions along n, full = cell of
/// the whole packing. In a uniform field of a whole star the second part is zero. What is below the last bit of a strain is nothing, as it is in P: else the
/// front of numbers that are not zero runs twice as fast into material at rest. bulk: rho0 c0^2 [Pa].
MCA_INLINE double meanPressure(double P, double normals, double J, double full, double cell, double bulk)
{
	const double own = full / cell * normals / (nLinks * J);
	return P + (std::fabs(own) > 2.3e-16 * bulk ? own : 0.);
}

/// Force of a link: both = ofBothSides(), push: of the pressures; viscous: over the vector.
template <class T> MCA_INLINE Vec<T> linkForce(Vec<T> r, Vec<T> both, T perLength, T viscous, Vec<T> push)
{
	return fma(perLength, both, fma(viscous, r, -push));
}
/// Force of a contact: both = ofBothSides(), viscous = viscousCoefficient(), pressure over r [N/m].
MCA_INLINE Vec<double> contactForce(Vec<double> r, Vec<double> both, double invR2, double viscous, double pressure)
{
	return fma(std::sqrt(invR2), both, r * (viscous - pressure));
}
/// Torque of a contact about its owner's centre, which is arm times the distance away.
MCA_INLINE Vec<double> contactTorque(double arm, Vec<double> r, Vec<double>, Vec<double> force) { return cross(r, force) * arm; }
}
}
