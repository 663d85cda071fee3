// SPDX-License-Identifier: GPL-2.0-or-later
// Pass 3: forces and torques from the pressures, stresses and velocities of both sides of each link.
#include "../passes.hpp"
#include "../view.hpp"

namespace mca::automata {
namespace {
	/// Stresses of link k at its other ends j: in the opposite plane of their blocks.
	MCA_INLINE Pair<v8> stressesOfOthers(const double* s, const double* tau, const int32_t* j, int k)
	{
		v8 normal {}, shear {};
		for (int l = 0; l < lanes; l++) {
			const int32_t at = j[l] + int32_t(uint32_t(j[l]) / blockSize) * ((nLinks - 1) * blockSize) + Lattice::opposite(k) * blockSize;
			normal[l] = s[at], shear[l] = tau[at];
		}
		return { normal, shear };
	}
	/// Per lane: (12) with the coefficients of the pair.
	template <VolumeRule rule> MCA_INLINE v8 viscosityMixed(const BlockView& V, const Store& S, const int32_t* j, v8 along, v8 invR2, v8 dij, v8 w)
	{
		v8 q;
		for (int l = 0; l < lanes; l++) {
			const PairViscosity c = ofLink(S.pairViscosity(V.block.species, j[l]), rule);
			q[l] = w[l] * viscousCoefficient(along[l], invR2[l], c.linear, c.quadratic, Lattice::width(dij[l]));
		}
		return q;
	}
	/// (6) over the vector, by both sides' shares H.
	template <VolumeRule rule> MCA_INLINE v8 pressureOver(const BlockView& V, const double* H, int g, const int32_t* j, v8 w, v8 dij, v8 invR2)
	{
		v8 over {};
		for (int l = 0; l < lanes; l++)
			over[l] = w[l] * (V.h[g + l] + H[j[l]]) * pressureShape<rule>(dij[l], invR2[l]);
		return over;
	}
	MCA_INLINE v8 restDistances(const BlockView& V, const int32_t* j)
	{
		v8 d;
		for (int l = 0; l < lanes; l++) d[l] = 0.5 * (V.d + V.diameterOfAll[j[l]]);
		return d;
	}
	/// The share of the viscosity in the pushes of automata.
	MCA_INLINE v8 viscousShares(const BlockView& V, const int32_t* at)
	{
		v8 share, unused;
		gather2(V.node + viscousShareAt, nodeSize, at, share, unused);
		return share;
	}
	/// pressurePush() of eight links.
	MCA_INLINE Vec<v8> atOutline(const BlockView& V, const Tensor<v8>& own, const Tensor<v8>& other, const EightTriangles& mine, const int32_t* j, int k)
	{
		const EightTriangles theirs(V.flagsOfAll, j);
		const Vec<v8>        push = times(own, outlineDirection(mine.of, k)) - times(other, outlineDirection(theirs.of, Lattice::opposite(k)));
		return choose<false>(mine.any() | theirs.any(), push, times(own + other, k));
	}
	template <VolumeRule rule, bool intact, bool mixed, bool viscous, bool account> void run(const BlockView& V, const Store& S, const Extra& E)
	{
		const double *      H = S.h.data(), *s = S.s.data(), *tau = S.tau.data(), d = V.d; // of all
		const PairViscosity own = ofLink(viscosityOf(V.material), rule);
		const bool          outline = !intact && V.block.outline;
		int32_t             self[blockSize];
		for (int l = 0; l < blockSize; l++)
			self[l] = int32_t(V.base) + l;
		for (int g = 0; g < blockSize; g += lanes) {
			const Vec<v8> x = load(V.position, g), v = load(V.velocity, g), none {};
			const m8      bits  = intact ? m8 {} : widen(V.flags + g);
			const EightTriangles triangles(V.flags + g);
			Vec<v8>       force = none, ofPressure = none, ofViscosity = none;
			v8            torque = {};
			Tensor<v8>    push, viscousPush;
			if (rule == VolumeRule::affine) push = gatherPush(V.pushOfAll, self + g);
			if (account && rule == VolumeRule::affine) viscousPush = push * viscousShares(V, self + g);
#pragma GCC unroll 6
			for (int k = 0; k < nLinks; k++) {
				const int32_t* j = V.others(k, g);
				const Motion   other  = gatherMotion(V.node, j);
				const Pair<v8> theirs = stressesOfOthers(s, tau, j, k);
				const Vec<v8>  r      = other.position - x;
				const v8       dij    = mixed ? restDistances(V, j) : splat(d);
				const m8       on    = holding(bits, k);
				const v8       w = choose<intact>(on, weights<intact>(bits, k), splat(0.));
				const v8       r2 = choose<intact>(on, dot(r, r), dij * dij), invR2 = 1. / r2;
				const v8       area  = pairArea(w, dij);
				const Pair<v8> mine  = V.stress(k, g), both { area * (mine.normal + theirs.normal), area * (mine.shear + theirs.shear) };
				const auto     pressureOf = [&](const Tensor<v8>& a, const Tensor<v8>& b) { // pushes i by its negative
					return choose<intact>(on, outline ? atOutline(V, a, b, triangles, j, k) : times(a + b, k), none);
				};
				Tensor<v8> theirPush;
				if (rule == VolumeRule::affine) theirPush = gatherPush(V.pushOfAll, j);
				Vec<v8> press;
				if (rule == VolumeRule::affine) press = pressureOf(push, theirPush);
				else press = r * pressureOver<rule>(V, H, g, j, w, dij, invR2);
				v8 along = both.normal * invR2;
				if (viscous) {
					const v8 closing = dot(r, other.velocity - v);
					const v8 q       = mixed ? viscosityMixed<rule>(V, S, j, closing, invR2, dij, w)
								 : w * viscousCoefficient(closing, invR2, own.linear, own.quadratic, Lattice::width(d));
					along += q;
					if (account) ofViscosity = fma(q, r, ofViscosity);
				}
				if (account) ofPressure = ofPressure - press;
				if (account && rule == VolumeRule::affine) { // what of it is viscous
					const Vec<v8> q = pressureOf(viscousPush, theirPush * viscousShares(V, j));
					ofViscosity     = ofViscosity - q, ofPressure += q;
				}
				force += linkForce(r, along, both.shear * invR2, press);
				if (mixed)
					for (int l = 0; l < lanes; l++)
						torque[l] = fma(arm(d, V.diameterOfAll[j[l]]), both.shear[l], torque[l]);
				else
					torque = fma(0.5, both.shear, torque);
			}
			store(V.force, g, force), store(V.torque + g, torque);
			if (account) store(E.volumetric, V.base + g, ofPressure), store(E.viscous, V.base + g, ofViscosity);
		}
	}
	void addContacts(const BlockView& V, const Extra& E)
	{
		for (int c = 0; c < dim; c++)
			for (int l = 0; l < blockSize; l++) V.force[c][l] += E.contactForce[c][V.base + l];
		for (int l = 0; l < blockSize; l++) V.torque[l] += E.contactT[0][V.base + l];
	}
}

void forcePass(Store& S, size_t b, VolumeRule rule, const Extra& E)
{
	prefetchLinks(S, b);
	const BlockView V(S, b);
	dispatch(rule, [&](auto r) {
		choices([&](auto intact, auto mixed, auto viscous,
		            auto account) { run<r.value, intact.value, mixed.value, viscous.value, account.value>(V, S, E); },
		        V.block.intact, V.block.mixed, V.material.viscosity.active() || V.block.mixed, E.account);
	});
	if (V.block.contact && E.contactT[0]) addContacts(V, E);
}
}
