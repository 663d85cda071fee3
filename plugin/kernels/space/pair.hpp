// SPDX-License-Identifier: GPL-2.0-or-later
// Stresses in space, in the frame of the laboratory: a deviator of each automaton, from what its links measure of its deformation, and a traction of each side
// of a pair, against what the pair does beside that: none in a uniform state. Sides of contacts, and of links that span no volume, hold all of it.
#pragma once
#include "../automaton/deviator.hpp"
#include "../deviator.hpp"

namespace mca {
inline namespace MCA_SPACE {

inline Symmetric<double> symmetricOf(const Deviator& s) { return { s.xx, s.yy, s.zz, s.yz, s.zx, s.xy }; }

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
/// The side with another normal part.
MCA_INLINE Vec<double> withNormal(Vec<double> side, Vec<double> r, double normal)
{
	const double length2 = plainSquare(r);
	return side + r * ((normal * std::sqrt(length2) - plainDot(side, r)) / length2);
}
/// The side without a negative normal part.
MCA_INLINE Vec<double> withoutPush(Vec<double> side, Vec<double> r) { return side - r * (min(plainDot(side, r), 0.) / plainSquare(r)); }

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
	Vec<T> middle; ///< r [m]
};
/// r now [m]; u = relative displacement of the step [m]; spin: pairSpin().
template <class T> MCA_INLINE PairMotion<T> pairMotion(Vec<T> r, Vec<T> u, Vec<T> spin)
{
	const Vec<T> m   = fma(-0.5, u, r);
	const T      inv = 1. / dot(m, m), perLength = root(inv);
	return { (u - cross(spin, m)) * perLength, fma(dot(spin, m), m, cross(m, u)) * inv, m * perLength, m };
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
/// Implicit mid-point: half of the increment before the turn, half after it. apart: what of the strain is left out.
template <class T> MCA_INLINE Advance<T> advance(Vec<T> before, const PairMotion<T>& p, Vec<T> apart, T twoG)
{
	const Vec<T> half = (p.strain - apart) * (0.5 * twoG), now = rotated(before + half, p.turn);
	return { now + half, now - half };
}
/// With a dilation left out along the pair alone.
template <class T> MCA_INLINE Vec<T> advanced(Vec<T> before, Vec<T> r, Vec<T> u, Vec<T> spin, T pairDilation, T twoG)
{
	const PairMotion<T> p = pairMotion(r, u, spin);
	return advance(before, p, p.normal * pairDilation, twoG).trial;
}

/// What the links of an automaton measure of its deformation in a step, at its middle [-].
template <class T> struct Deformation {
	Symmetric<T> strain;
	Vec<T>       turn; ///< 2 tan(angle/2) along the axis, exactly, where nothing strains
};
/// Sums over the links with their weights.
template <class T> struct DeformationSums {
	Tensor<T>    moved = {}, middle = {}; ///< of u and of r at the middle (x) e_k [m]
	Symmetric<T> spun = {};               ///< of what spins beyond the own do across the links (x) n [-]
	/// beyond: pairSpin() without the turn of the automaton itself.
	MCA_INLINE void add(int k, Vec<T> u, const PairMotion<T>& p, Vec<T> beyond, T w)
	{
		addDyad(moved, k, u * w), addDyad(middle, k, p.middle * w), spun += symmetricDyad(cross(beyond, p.normal), p.normal * w);
	}
	MCA_INLINE void add(int k, Vec<T> u, const PairMotion<T>& p, Vec<T> beyond)
	{
		addDyad(moved, k, u), addDyad(middle, k, p.middle), spun += symmetricDyad(cross(beyond, p.normal), p.normal);
	}
};
/// The same for any set of links that spans a volume. The strain leaves out what spins explain, as that of a pair does, so that at rest the two are one law of
/// pairs, in waves, too. perSlot = 1/(shares of slots in one direction): 1/spread, of parts of cells more.
template <class T> MCA_INLINE Deformation<T> deformation(const DeformationSums<T>& s, T perSlot)
{
	const Tensor<T> C   = cofactor(s.middle);
	const T         per = 1. / dot(s.middle.column[0], C.column[0]);
	Vec<T>          L[dim]; // columns of the gradient: sum of u times the inverse of that of r
	for (int b = 0; b < dim; b++)
		L[b] = fma(C.column[0][b] * per, s.moved.column[0], fma(C.column[1][b] * per, s.moved.column[1], s.moved.column[2] * (C.column[2][b] * per)));
	const Symmetric<T> all { L[0][0], L[1][1], L[2][2], 0.5 * (L[1][2] + L[2][1]), 0.5 * (L[2][0] + L[0][2]), 0.5 * (L[0][1] + L[1][0]) };
	return { all - s.spun * perSlot, { 0.5 * (L[1][2] - L[2][1]), 0.5 * (L[2][0] - L[0][2]), 0.5 * (L[0][1] - L[1][0]) } };
}
/// R a R^T of the turn w.
template <class T> MCA_INLINE Symmetric<T> rotated(const Symmetric<T>& a, Vec<T> w)
{
	const Vec<T> x = rotated(Vec<T> { a.xx, a.xy, a.zx }, w), y = rotated(Vec<T> { a.xy, a.yy, a.yz }, w), z = rotated(Vec<T> { a.zx, a.yz, a.zz }, w);
	// rows of R a, turned once more
	const Vec<T> rx = rotated(Vec<T> { x[0], y[0], z[0] }, w), ry = rotated(Vec<T> { x[1], y[1], z[1] }, w), rz = rotated(Vec<T> { x[2], y[2], z[2] }, w);
	return { rx[0], ry[1], rz[2], ry[2], rz[0], rx[1] };
}
/// Deviator of an automaton before yield, and that of the step before in the frame of now.
template <class T> struct DeviatorAdvance {
	Symmetric<T> trial, before;
};
template <class T> MCA_INLINE DeviatorAdvance<T> advance(const Symmetric<T>& before, const Deformation<T>& d, T twoG)
{
	const Symmetric<T> half = deviatorOf(d.strain) * (0.5 * twoG), now = rotated(before + half, d.turn);
	return { now + half, now - half };
}

/// old: stress of the step before; weight: 1, 1/2 where a link counts half; what a link that has just broken held goes on in its contact, so it has none in
/// `holds`.
template <bool account, class T>
MCA_INLINE void add(PairSums<T>& to, Vec<T> old, const Advance<T>& a, Vec<T> apart, T weight, T holds)
{
	to.square += square(a.trial) * weight;
	if (account) {
		const T before = dot(a.before, apart);
		to.squareBefore += holds * square(old), to.both += weight * product(a.before, a.trial);
		to.dilationBefore += holds * before, to.dilationTrial += weight * dot(a.trial, apart);
		to.dilationLost += (weight - holds) * before;
	}
}
/// The deviator of the automaton counts as a third of its slots.
template <bool account, class T> MCA_INLINE void add(PairSums<T>& to, const Symmetric<T>& old, const DeviatorAdvance<T>& a, T invN)
{
	const T share = 1. / (3. * invN);
	to.square += share * dot(a.trial, a.trial);
	if (account) to.squareBefore += share * dot(old, old), to.both += share * dot(a.before, a.trial);
}

/// Equivalent stress [Pa]: meanSquare = mean over the slots of the squares of the tractions, sides without a link counted as zero, and a third of that of the
/// deviator.
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

/// Stress with which the automaton pushes its neighbours beside P, kept as its negative: minus its deviator, and what the tractions of its own sides do with
/// its deformation [Pa]. sides = sum of weight times J times traction (x) n, full = cell of the whole packing. What is below the last bit of a strain is
/// nothing, as it is in P: else the front of numbers that are not zero runs twice as fast into material at rest. bulk: rho0 c0^2 [Pa].
MCA_INLINE Symmetric<double> ownPush(const Symmetric<double>& deviator, const Symmetric<double>& sides, double J, double full, double cell, double bulk)
{
	const Symmetric<double> own = sides * (full / (cell * (Lattice::spread * J))) - deviator;
	const double            least = 2.3e-16 * bulk;
	return own * (dot(own, own) > least * least ? 1. : 0.);
}
/// P with the mean of it [Pa].
MCA_INLINE double meanPressure(double P, const Symmetric<double>& own) { return P + (1. / 3.) * trace(own); }
/// With what an automaton pushes its neighbours.
template <class T> struct Pushes {
	Tensor<T>    force; ///< along e_k that on link k [N]
	Symmetric<T> own;   ///< J times ownPush(); nothing where links span no volume [Pa]
};
/// volume: affinePush() times the cell over J [m2]; pressure: J times P with the viscous one [Pa]
template <class T> MCA_INLINE Pushes<T> pushes(const Tensor<T>& volume, T pressure, const Symmetric<T>& own)
{
	Pushes<T> p { {}, own };
	for (int c = 0; c < dim; c++)
		p.force.column[c] = fma(pressure, volume.column[c], times(own, volume.column[c]));
	return p;
}
/// What both ends of link k push the first with, as its negative [N].
template <class T> MCA_INLINE Vec<T> linkPush(const Pushes<T>& a, const Pushes<T>& b, int k) { return times(a.force, k) + times(b.force, k); }
/// Couple with which they turn the first, since their strain leaves out what spins explain [N m]; the other has its negative. n: unit vector of the pair,
/// mine, theirs: weight of the link over spread times the cells of the whole packing times the arm of the other side [m3].
template <class T> MCA_INLINE Vec<T> linkCouple(const Pushes<T>& a, const Pushes<T>& b, Vec<T> n, T mine, T theirs)
{
	return cross(n, times(a.own, n * mine) - times(b.own, n * theirs));
}

/// Force of a link: both = ofBothSides(), push: linkPush(); viscous: over the vector.
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
