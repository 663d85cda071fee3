// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "../../kernels/automaton/contact.hpp"
#include "../../kernels/automaton/energy.hpp"
#include "../fields.hpp"
#include "../sides.hpp"

namespace mca::automata {

/// Numbers of a record of pushes: those of Pushes; of one for the account: affinePush() times the cell, J times the mean and the viscous pressure.
constexpr int pushSize = 16, sharesSize = tensorSize;
/// Numbers of a record of motion, and places in it behind position and velocity.
constexpr int nodeSize = 12, spinAt = 6;
/// Writes the motion of the eight automata from i on; the rest comes from the passes.
template <class S> void packRecords(const S& store, double* to, size_t i)
{
	const Vec<v8> r = load(store.position.planes(), i), v = load(store.velocity.planes(), i), w = load(store.omega.planes(), i);
	scatter4(to, nodeSize, r[0], r[1], r[2], v[0]);
	scatter4(to + 4, nodeSize, v[1], v[2], w[0], w[1]);
	scatter4(to + 8, nodeSize, w[2], v8 {}, v8 {}, v8 {});
}

constexpr int tractionSize = 4; ///< numbers of the record of a traction: the other side reads it whole
struct LinkStresses {
	std::vector<double> traction; ///< a record for each link: J times the traction of this side [Pa], 0
	std::vector<double> shares;   ///< sharesSize per automaton, for the account; rebuilt in every step
	void                resizeStresses(size_t links) { traction.assign(links * tractionSize, 0.); }
	void                resizeShares(size_t automata) { shares.resize(automata * sharesSize); }
	size_t              stresses() const { return traction.size() / tractionSize; }
	Side<double>        stressAt(size_t slot) const
	{
		const double* t = traction.data() + slot * tractionSize;
		return { t[0], t[1], t[2] };
	}
	void setStress(size_t slot, Side<double> v)
	{
		for (int c = 0; c < dim; c++) traction[slot * tractionSize + c] = v[c];
	}
};
/// Of contact c, in the list of contacts or a view of it.
template <class C> MCA_INLINE Side<double> sideOf(const C& contacts, size_t c) { return contacts.traction.at(c); }
template <class C> MCA_INLINE void         setSide(C& contacts, size_t c, Side<double> v) { contacts.traction.set(c, v); }
template <class C> void                    pushSide(C& contacts, Side<double> v) { contacts.traction.push_back(v); }
template <class C> MCA_INLINE void         setBefore(C& contacts, size_t c, Side<double> v) { contacts.before.set(c, v); }

/// What friction needs of contact c of a view.
template <class C> MCA_INLINE ContactSide contactSide(const C& V, size_t c, double J, double scale)
{
	const Vec<double> normal = Lattice::bearing(V.between.at(c));
	return { V.before.at(c), V.traction.at(c), normal, V.press[c], V.r2[c], V.d[c], V.friction[c], J, scale, V.touch[c] > 0. };
}
/// Trial stress of contact c of a view, and that of the step before as it counts for the account.
struct ContactTrial {
	Side<double> trial, before;
};
MCA_INLINE ContactTrial contactTrial(Side<double> old, Vec<double> r, Vec<double> u, Vec<double> spin, double dilation, double twoG)
{
	const auto motion = pairMotion(r, u, spin);
	const auto a = advance(old, motion, motion.normal * dilation, twoG);
	return { a.trial, a.before };
}
/// What counts as the stress before the step. Pairs that have slid into each other do not touch and strain without limit near zero distance.
MCA_INLINE Side<double> before(const ContactTrial& t, Side<double> old, bool touches) { return where(touches, t.before) + where(!touches, old); }

/// Deviators from automaton `from` on [Pa].
template <class S> SymmetricPlanes deviators(S& store, size_t from = 0)
{
#define MCA_PLANE(name, ...) const_cast<double*>(store.name.data()) + from,
	return { { MCA_DEVIATORS(MCA_PLANE) } };
#undef MCA_PLANE
}
template <class S> Symmetric<double> deviatorAt(const S& store, size_t i) { return deviators(store).at(i); }
/// Energy of the deviator of an automaton and of its pairs [J].
template <class S> double deviatorEnergyAt(const S& store, size_t i, double pairs)
{
	return deviatorEnergy(store.materialOf(i).G, store.diameter[i], store.cell[i], store.J[i], deviatorAt(store, i), pairs);
}
/// Mises stress; sum over its links of the squares of the stresses [Pa2].
template <class S> double equivalentStressAt(const S& store, size_t i, double squares)
{
	const Symmetric<double> s = deviatorAt(store, i);
	return mca::equivalentStress(squares * store.invN[i] + dot(s, s) / 3.);
}
/// Where automata have planes of symmetry.
template <class S> bool hasMirrors(const S& store) { return !store.mirrorFirst.empty(); }
/// f(axis, normal in the packing) for the planes of symmetry of an automaton; those that it has not are zero.
template <class S, class F> void eachMirror(const S& store, size_t i, F&& f)
{
	f(0, store.mirrorFirst.at(i)), f(1, store.mirrorSecond.at(i)), f(2, store.mirrorThird.at(i));
}
/// Whether what a file says of planes of symmetry is possible: for all automata or for none, and normals are of unit length or zero.
template <class S> bool mirrorsFit(const S& store)
{
	const size_t n = store.mirrorFirst.size();
	bool         fit = store.mirrorSecond.size() == n && store.mirrorThird.size() == n && (n == 0 || n == store.size());
	for (size_t i = 0; fit && i < n; i++)
		eachMirror(store, i, [&](int, Vec<double> normal) { fit &= isZero(normal) || std::fabs(plainSquare(normal) - 1.) < 1e-9; });
	return fit;
}
/// Bits of the planes of symmetry on which an automaton lies, and the share of it that is on this side of them.
template <class S> int mirrorsOf(const S& store, size_t i)
{
	if (!hasMirrors(store)) return 0;
	return int(!isZero(store.mirrorFirst.at(i))) + 2 * int(!isZero(store.mirrorSecond.at(i))) + 4 * int(!isZero(store.mirrorThird.at(i)));
}
template <class S> bool   isMirrored(const S& store, size_t i) { return mirrorsOf(store, i) != 0; }
inline double             shareWithin(int planes) { return 1. / double(1 << __builtin_popcount(unsigned(planes))); }
template <class S> double mirrorShare(const S& store, size_t i) { return shareWithin(mirrorsOf(store, i)); }
/// The share of a pair that is on this side of the planes on which both lie.
template <class S> double pairShare(const S& store, size_t i, size_t j) { return shareWithin(mirrorsOf(store, i) & mirrorsOf(store, j)); }
/// What the links of an automaton that hold measure of F, at the present positions (S8), (S9).
template <class S> Tensor<double> measured(const S& store, size_t i)
{
	const Flags    flags = store.flags[i];
	Tensor<double> sum   = {};
	for (int k = 0; k < nLinks; k++)
		if (holds(flags, k)) addDyad(sum, Lattice::direction(k), store.between(i, size_t(store.neighbour[linkSlot(i, k)])) * linkWeight(flags, k));
	sum = sum * (1. / shareOfStar(flags, store.weight[i]));
	if (hasMirrors(store)) eachMirror(store, i, [&](int axis, Vec<double> normal) { mirror(sum, axis, normal); });
	return sum;
}
/// Push of link k of automaton i by unit pressures of both ends, as its negative [m2]; own, other: their unitPush().
template <class S> Vec<double> unitPushOfLink(const S& store, size_t i, int k, const Tensor<double>& own, const Tensor<double>& other)
{
	return times(own + other, k) * linkWeight(store.flags[i], k);
}
/// A pressure of 1 Pa pushes link k by this times its direction [m2].
template <class S> Tensor<double> unitPush(const S& store, size_t i)
{
	const double cell = store.cell[i] / shareOfStar(store.flags[i], store.weight[i]);
	return cofactor(measured(store, i)) * (store.factor[i] * Lattice::perVolume(store.diameter[i]) * cell);
}
/// Stress of the whole automaton [Pa], without its pressure.
template <class S> void setDeviator(S& store, size_t i, const Deviator& s)
{
	for (int k = 0; k < nLinks; k++) store.setStress(linkSlot(i, k), {});
	deviators(store).set(i, symmetricOf(s));
}
/// Weight of a link in the exchange of volume (5e).
inline double exchangeWeight(Flags flags, double weight, int k) { return linkWeight(flags, k) / shareOfStar(flags, weight); }
template <class C> bool sidesAre(const C& contacts, size_t n) { return contacts.traction.size() == n; }
/// J times all that acts along a pair beside the pressure, over its distance r: the traction of its side and that of the deviator.
template <class S> Side<double> wholeSideAt(const S& store, size_t i, int k, Vec<double> r)
{
	return store.stressAt(linkSlot(i, k)) + times(deviatorAt(store, i) * store.J[i], Lattice::bearing(r));
}
/// J times the normal stress of the side of a pair, over its distance r.
template <class S> double normalStressAt(const S& store, size_t i, int k, Vec<double> r)
{
	const Vec<double> n = Lattice::bearing(r);
	return plainDot(store.stressAt(linkSlot(i, k)), n) + store.J[i] * plainDot(times(deviatorAt(store, i), n), n);
}
/// Sides of what has lost its volume hold all of its stress.
template <class S> void deviatorToSides(S& store, size_t i)
{
	const Symmetric<double> s = deviatorAt(store, i) * store.J[i];
	for (int k = 0; k < nLinks; k++)
		if (holds(store.flags[i], k)) {
			const size_t at = linkSlot(i, k);
			store.setStress(at, store.stressAt(at) + times(s, Lattice::bearing(store.between(i, size_t(store.neighbour[at])))));
		}
	deviators(store).set(i, {});
}
}
