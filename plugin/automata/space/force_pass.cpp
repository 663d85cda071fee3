// SPDX-License-Identifier: GPL-2.0-or-later
// Pass 3 in space: forces and torques from the pressures, tractions and velocities of both sides of each link.
#include "../passes.hpp"
#include "../view.hpp"
#include <utility>

namespace mca::automata {
namespace {
	template <int... k, class F> MCA_INLINE void eachOf(std::integer_sequence<int, k...>, F&& f) { (f(std::integral_constant<int, k> {}), ...); }
	/// f(number of a link as a compile-time constant)
	template <class F> MCA_INLINE void eachLink(F&& f) { eachOf(std::make_integer_sequence<int, nLinks> {}, f); }
	template <class P> MCA_INLINE void add(const P& to, size_t at, Vec<v8> a) { store(to, at, load(to, at) + a); }
	/// Tractions of link k at its other ends j: in the opposite plane of their blocks.
	MCA_INLINE Vec<v8> tractionsOfOthers(const double* traction, const int32_t* j, int k)
	{
		int32_t at[lanes];
		for (int l = 0; l < lanes; l++)
			at[l] = j[l] + int32_t(uint32_t(j[l]) / blockSize) * ((nLinks - 1) * blockSize) + Lattice::opposite(k) * blockSize;
		return gatherTraction(traction, at);
	}
	/// Per lane: (12) with the coefficients of the pair.
	MCA_INLINE v8 viscosityMixed(const BlockView& V, const Store& S, const int32_t* j, v8 along, v8 invR2, v8 dij, v8 w)
	{
		v8 q;
		for (int l = 0; l < lanes; l++) {
			const PairViscosity c = ofLink(S.pairViscosity(V.block.species, j[l]), VolumeRule::affine);
			q[l] = w[l] * viscousCoefficient(along[l], invR2[l], c.linear, c.quadratic, Lattice::width(dij[l]));
		}
		return q;
	}
	/// For the account: with what mean and viscous pressures push.
	struct Shares {
		Tensor<v8> volume;
		v8         mean, viscous;
		Shares(const double* shares, const int32_t* at) { gather(shares, sharesSize, at, volume, mean, viscous); }
	};
	/// Own pushes of a block.
	struct OwnPushes {
		TensorLanes<blockSize>    force;
		SymmetricLanes<blockSize> own;
		explicit OwnPushes(const BlockView& V)
		{
			for (int g = 0; g < blockSize; g += lanes) {
				const Pushes<v8> p = gatherPushes(V.push + pushSize * g, inRow);
				force.setLanes(g, p.force), own.setLanes(g, p.own);
			}
		}
		Pushes<v8> at(int g) const { return { force.lanes(g), own.lanes(g) }; }
	};
	/// Force and torque of link k on the eight automata from lane g on.
	template <int k, bool intact, bool mixed, bool viscous, bool account>
	MCA_INLINE void addLink(const BlockView& V, const Store& S, const Extra& E, const OwnPushes& pushes, const PairViscosity& own, int g)
	{
		const int32_t*   j      = V.others(k, g);
		const Vec<v8>    x      = load(V.position, g), none {};
		const m8         bits   = intact ? m8 {} : widen(V.flags + g);
		const Motion     other  = viscous ? gatherVelocity(V.node, j) : Motion { gatherPosition(V.node, j), none, none };
		const Pushes<v8> push   = pushes.at(g), theirs = gatherPushes(V.pushOfAll, j);
		const Vec<v8>    r      = other.position - x;
		const m8         on     = holding(bits, k);
		const v8         w      = choose<intact>(on, weights<intact>(bits, k), splat(0.));
		v8               dij    = splat(V.d);
		if (mixed)
			for (int l = 0; l < lanes; l++) dij[l] = 0.5 * (V.d + V.diameterOfAll[j[l]]);
		const v8      r2   = choose<intact>(on, dot(r, r), dij * dij), invR2 = 1. / r2;
		const Vec<v8> mine = gatherTraction(V.tractions(k, g), inRow), theirSide = tractionsOfOthers(V.tractionOfAll, j, k);
		const Vec<v8> both = ofBothSides(pairArea(w, dij), mine, theirSide);
		const v8      part = weights<intact>(bits, k);
		const Vec<v8> all  = linkPush(push, theirs, k), // i by its negative
			      press = choose<intact>(on, intact ? all : all * part, none);
		v8            q {};
		if (viscous) {
			const v8 closing = dot(r, other.velocity - load(V.velocity, g));
			q = mixed ? viscosityMixed(V, S, j, closing, invR2, dij, w)
				  : w * viscousCoefficient(closing, invR2, own.linear, own.quadratic, Lattice::width(V.d));
		}
		if (account) {
			const Shares  a(V.shares + sharesSize * g, inRow), b(V.sharesOfAll, j);
			const Vec<v8> p = times(a.volume, k) * part, o = times(b.volume, k) * part;
			add(E.viscous, V.base + g, r * q - choose<intact>(on, fma(a.viscous, p, o * b.viscous), none));
			add(E.volumetric, V.base + g, -choose<intact>(on, fma(a.mean, p, o * b.mean), none));
		}
		const v8      perLength = root(invR2), whole = splat(Lattice::cell(V.d) / Lattice::spread);
		const Vec<v8> turning = cross(r, both) * perLength, n = r * perLength;
		v8            q1 = splat(0.5), ofMine = w * (whole * 0.5), ofTheirs = ofMine;
		if (mixed)
			for (int l = 0; l < lanes; l++) {
				q1[l]       = arm(V.d, V.diameterOfAll[j[l]]);
				ofMine[l]   = w[l] * (1. - q1[l]) * whole[l];
				ofTheirs[l] = w[l] * q1[l] * (Lattice::cell(V.diameterOfAll[j[l]]) / Lattice::spread);
			}
		add(V.force, g, linkForce(r, both, perLength, q, press));
		add(V.torque, g, fma(q1, turning, linkCouple(push, theirs, n, ofMine, ofTheirs)));
	}
	/// Link by link through the whole block: the code of all twelve at once is longer than the cache for instructions.
	template <bool intact, bool mixed, bool viscous, bool account> void run(const BlockView& V, const Store& S, const Extra& E)
	{
		const PairViscosity own = ofLink(viscosityOf(V.material), VolumeRule::affine);
		const OwnPushes     pushes(V);
		for (int g = 0; g < blockSize; g += lanes) {
			const Vec<v8> none {};
			store(V.force, g, none), store(V.torque, g, none);
			if (account) store(E.volumetric, V.base + g, none), store(E.viscous, V.base + g, none);
		}
		eachLink([&](auto k) {
#pragma GCC unroll 1
			for (int g = 0; g < blockSize; g += lanes) addLink<k.value, intact, mixed, viscous, account>(V, S, E, pushes, own, g);
		});
	}
	void addContacts(const BlockView& V, const Extra& E)
	{
		for (int c = 0; c < dim; c++)
			for (int l = 0; l < blockSize; l++) V.force[c][l] += E.contactForce[c][V.base + l];
		for (int c = 0; c < turns; c++)
			for (int l = 0; l < blockSize; l++) V.torque[c][l] += E.contactT[c][V.base + l];
	}
}

void forcePass(Store& S, size_t b, VolumeRule, const Extra& E)
{
	prefetchLinks(S, b);
	const BlockView V(S, b);
	const bool viscous = ofLink(viscosityOf(V.material), VolumeRule::affine).linear > 0.;
	// the rare ones share a version
	if (V.block.mixed) choices([&](auto account) { run<false, true, true, account.value>(V, S, E); }, E.account);
	else if (E.account) choices([&](auto intact) { run<intact.value, false, true, true>(V, S, E); }, V.block.intact);
	else choices([&](auto intact, auto friction) { run<intact.value, false, friction.value, false>(V, S, E); }, V.block.intact, viscous);
	if (V.block.contact && E.contactT[0]) addContacts(V, E);
}
}
