// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "../../kernels/automaton/contact.hpp"
#include "../../kernels/automaton/energy.hpp"
#include "../sides.hpp"

namespace mca::automata {

/// Numbers of a record of pushes: a tensor, link k is pushed by T e_k [N/m].
constexpr int pushSize = tensorSize;
/// Numbers of a record of motion, and places in it behind position and velocity.
constexpr int nodeSize = 8, spinAt = 4, dilationAt = 5, viscousShareAt = 6;
/// Writes the motion of the eight automata from i on; the rest comes from the passes.
template <class S> void packRecords(const S& store, double* to, size_t i)
{
	const Vec<v8> r = load(store.position.planes(), i), v = load(store.velocity.planes(), i);
	scatter4(to, nodeSize, r[0], r[1], v[0], v[1]);
	scatter4(to + spinAt, nodeSize, load(&store.omega[i]), load(&store.dTheta[i]), v8 {}, v8 {});
}

/// A plane of 64 numbers per link and block.
struct LinkStresses {
	std::vector<double> s, tau; ///< J times normal and shear pair stress of this side [Pa]
	void                resizeStresses(size_t links) { s.assign(links, 0.), tau.assign(links, 0.); }
	void                resizeShares(size_t) { }
	size_t              stresses() const { return s.size() == tau.size() ? s.size() : 0; }
	Side<double>        stressAt(size_t slot) const { return { s[slot], tau[slot] }; }
	void                setStress(size_t slot, Side<double> v) { s[slot] = v.normal, tau[slot] = v.shear; }
};
/// Of contact c, in the list of contacts or a view of it.
template <class C> MCA_INLINE Side<double> sideOf(const C& contacts, size_t c) { return { contacts.s[c], contacts.tau[c] }; }
template <class C> MCA_INLINE void         setSide(C& contacts, size_t c, Side<double> v) { contacts.s[c] = v.normal, contacts.tau[c] = v.shear; }
template <class C> void                    pushSide(C& contacts, Side<double> v) { contacts.s.push_back(v.normal), contacts.tau.push_back(v.shear); }
template <class C> MCA_INLINE void         setBefore(C& contacts, size_t c, Side<double> v) { contacts.second[c] = v.normal, contacts.third[c] = v.shear; }

/// What friction needs of contact c of a view.
template <class C> MCA_INLINE ContactSide contactSide(const C& V, size_t c, double J, double scale)
{
	return { { V.second[c], V.third[c] }, { V.s[c], V.tau[c] }, V.press[c], V.r2[c], V.d[c], V.friction[c], J, scale, V.touch[c] > 0. };
}
/// Trial stress of contact c of a view, and that of the step before as it counts for the account.
struct ContactTrial {
	Side<double> trial, before;
};
MCA_INLINE ContactTrial contactTrial(Side<double> old, Vec<double> r, Vec<double> u, double spin, double dilation, double twoG)
{
	return { advanced(old, r, u, spin, dilation, twoG), old };
}
/// What counts as the stress before the step.
MCA_INLINE Side<double> before(const ContactTrial& t, Side<double>, bool) { return t.before; }

/// Energy of the deviator of an automaton that pairs and its out-of-plane stress hold [J/m].
template <class S> double deviatorEnergyAt(const S& store, size_t i, double pairs)
{
	return deviatorEnergy(store.materialOf(i).G, store.diameter[i], pairs, store.J[i], store.szz[i], store.invN[i]);
}
/// Mises stress; sum over its links of the squares of the stresses [Pa2].
template <class S> double equivalentStressAt(const S& store, size_t i, double squares) { return mca::equivalentStress(squares * store.invN[i], store.szz[i]); }
template <class C> bool sidesAre(const C& contacts, size_t n) { return contacts.s.size() == n && contacts.tau.size() == n; }
/// What the links of an automaton that hold measure of F, at the present positions.
template <class S> Tensor<double> measured(const S& store, size_t i)
{
	Tensor<double> sum = {};
	for (int k = 0; k < nLinks; k++)
		if (holds(store.flags[i], k)) addMeasured(sum, store.flags[i], k, store.between(i, size_t(store.neighbour[linkSlot(i, k)])));
	return sum;
}
/// Push of link k of automaton i by unit pressures of both ends, as its negative [m]; own, other: their unitPush().
template <class S> Vec<double> unitPushOfLink(const S& store, size_t i, int k, const Tensor<double>& own, const Tensor<double>& other)
{
	return pressurePush(own, other, trianglesIn(store.flags[i]), trianglesIn(store.flags[size_t(store.neighbour[linkSlot(i, k)])]), k);
}
/// A pressure of 1 Pa pushes link k by this times its direction [m].
template <class S> Tensor<double> unitPush(const S& store, size_t i)
{
	return cofactor(measured(store, i)) * (store.factor[i] * Lattice::perVolume(store.diameter[i]) * store.cell[i]);
}
/// Stress of the whole automaton [Pa], without its pressure: along all links, and along z. Kept as J times it, which J must be set before.
template <class S> void setDeviator(S& store, size_t i, const Deviator& s)
{
	for (int k = 0; k < nLinks; k++) {
		if (!holds(store.flags[i], k)) continue;
		const size_t at = linkSlot(i, k);
		store.setStress(at, scaled(sideOf(s, store.between(i, size_t(store.neighbour[at]))), store.J[i]));
	}
	store.szz[i] = outOfPlane(s);
}
template <class S> bool   hasMirrors(const S&) { return false; }
template <class S> bool   isMirrored(const S&, size_t) { return false; }
template <class S> bool   mirrorsFit(const S&) { return true; }
template <class S> double mirrorShare(const S&, size_t) { return 1.; }
template <class S> double pairShare(const S&, size_t, size_t) { return 1.; }
/// Weight of a link in the exchange of volume (5e): weighted rims take no part.
inline double exchangeWeight(Flags, double, int) { return 1.; }
/// J times all that acts along a pair beside the pressure, over its distance r: the stress of its side.
template <class S> Side<double> wholeSideAt(const S& store, size_t i, int k, Vec<double>) { return store.stressAt(linkSlot(i, k)); }
/// J times the normal stress of the side of a pair, over its distance r.
template <class S> double normalStressAt(const S& store, size_t i, int k, Vec<double> r) { return normalStress(store.stressAt(linkSlot(i, k)), r); }
/// Sides of what has lost its volume hold all of its stress: they do as it is.
template <class S> void deviatorToSides(S&, size_t) { }
}
