// SPDX-License-Identifier: GPL-2.0-or-later
// Pass 3 in space: forces and torques from the pressures, tractions and velocities of both sides of each link.
#include "../passes.hpp"
#include "../view.hpp"

namespace mca::automata {
namespace {
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
		Shares(const BlockView& V, const int32_t* at) { gather(V.sharesOfAll, sharesSize, at, volume, mean, viscous); }
	};
	template <bool intact, bool mixed, bool viscous, bool account> void run(const BlockView& V, const Store& S, const Extra& E)
	{
		const PairViscosity own = ofLink(viscosityOf(V.material), VolumeRule::affine);
		const double        whole = Lattice::cell(V.d) / Lattice::spread;
		int32_t             self[blockSize];
		for (int l = 0; l < blockSize; l++) self[l] = int32_t(V.base) + l;
		for (int g = 0; g < blockSize; g += lanes) {
			const Vec<v8>    x = load(V.position, g), v = load(V.velocity, g), none {};
			const m8         bits = intact ? m8 {} : widen(V.flags + g);
			const Pushes<v8> push = gatherPushes(V.pushOfAll, self + g);
			Vec<v8>          force = none, torque = none, ofPressure = none, ofViscosity = none;
#pragma GCC unroll 12
			for (int k = 0; k < nLinks; k++) {
				const int32_t*   j     = V.others(k, g);
				const Motion     other = viscous ? gatherVelocity(V.node, j) : Motion { gatherPosition(V.node, j), none, none };
				const Pushes<v8> theirs = gatherPushes(V.pushOfAll, j);
				const Vec<v8>    r   = other.position - x;
				const m8         on  = holding(bits, k);
				const v8         w   = choose<intact>(on, weights<intact>(bits, k), splat(0.));
				v8               dij = splat(V.d);
				if (mixed)
					for (int l = 0; l < lanes; l++) dij[l] = 0.5 * (V.d + V.diameterOfAll[j[l]]);
				const v8      r2 = choose<intact>(on, dot(r, r), dij * dij), invR2 = 1. / r2;
				const Vec<v8> mine = gatherTraction(V.tractions(k, g), inRow), theirSide = tractionsOfOthers(V.tractionOfAll, j, k);
				const Vec<v8> both  = ofBothSides(pairArea(w, dij), mine, theirSide);
				const v8      part  = weights<intact>(bits, k);
				const Vec<v8> all = linkPush(push, theirs, k), // i by its negative
					      press = choose<intact>(on, intact ? all : all * part, none);
				v8            q {};
				if (viscous) {
					const v8 closing = dot(r, other.velocity - v);
					q = mixed ? viscosityMixed(V, S, j, closing, invR2, dij, w)
						  : w * viscousCoefficient(closing, invR2, own.linear, own.quadratic, Lattice::width(V.d));
				}
				if (account) {
					const Shares  a(V, self + g), b(V, j);
					const Vec<v8> p = times(a.volume, k) * part, o = times(b.volume, k) * part;
					ofViscosity = fma(q, r, ofViscosity) - choose<intact>(on, fma(a.viscous, p, o * b.viscous), none);
					ofPressure += -choose<intact>(on, fma(a.mean, p, o * b.mean), none);
				}
				const v8      perLength = root(invR2);
				const Vec<v8> turning = cross(r, both) * perLength, n = r * perLength;
				force += linkForce(r, both, perLength, q, press);
				v8 q1 = splat(0.5), ofMine = w * (whole * 0.5), ofTheirs = ofMine;
				if (mixed)
					for (int l = 0; l < lanes; l++) {
						q1[l]    = arm(V.d, V.diameterOfAll[j[l]]);
						ofMine[l]   = w[l] * (1. - q1[l]) * whole;
						ofTheirs[l] = w[l] * q1[l] * (Lattice::cell(V.diameterOfAll[j[l]]) / Lattice::spread);
					}
				torque = fma(q1, turning, torque) + linkCouple(push, theirs, n, ofMine, ofTheirs);
			}
			store(V.force, g, force), store(V.torque, g, torque);
			if (account) store(E.volumetric, V.base + g, ofPressure), store(E.viscous, V.base + g, ofViscosity);
		}
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
