// SPDX-License-Identifier: GPL-2.0-or-later
// One block of the store as the passes see it: bare pointers to its 64 lanes. Through the vectors their starts would be read again after each write.
#pragma once
#include "store.hpp"

namespace mca::automata {

struct BlockView {
	const Block&    block;
	const Material& material;
	const double    d; ///< diameter [m]
	const size_t    base;
	const double *  x, *y, *vx, *vy, *omega, *cell, *invN, *strength, *diameterOfAll, *node, *pushOfAll;
	double *        J, *dTheta, *P, *mean, *h, *factor, *rest, *szz, *eqps, *temperature, *heat, *criterion, *s, *tau, *record, *push, *fx, *fy, *torque;
	const int32_t * flags, *neighbour;
	BlockView(Store& S, size_t b)
		: block(S.blocks[b])
		, material(S.materialOf(block))
		, d(S.species[block.species].d)
		, base(b * blockSize)
		, x(S.x.data() + base)
		, y(S.y.data() + base)
		, vx(S.vx.data() + base)
		, vy(S.vy.data() + base)
		, omega(S.omega.data() + base)
		, cell(S.cell.data() + base)
		, invN(S.invN.data() + base)
		, strength(S.strength.data() + base)
		, diameterOfAll(S.diameter.data())
		, node(S.node.data())
		, pushOfAll(S.push.data())
		, J(S.J.data() + base)
		, dTheta(S.dTheta.data() + base)
		, P(S.P.data() + base)
		, mean(S.mean.data() + base)
		, h(S.h.data() + base)
		, factor(S.factor.data() + base)
		, rest(S.rest.data() + base)
		, szz(S.szz.data() + base)
		, eqps(S.eqps.data() + base)
		, temperature(S.temperature.data() + base)
		, heat(S.heat.empty() ? nullptr : S.heat.data() + base)
		, criterion(S.criterion.data() + base)
		, s(S.s.data() + base * nLinks)
		, tau(S.tau.data() + base * nLinks)
		, record(S.node.data() + base * nodeSize)
		, push(S.push.data() + base * pushSize)
		, fx(S.fx.data() + base)
		, fy(S.fy.data() + base)
		, torque(S.torque.data() + base)
		, flags(S.flags.data() + base)
		, neighbour(S.neighbour.data() + base * nLinks)
	{
	}
	/// Neighbours by link k of the eight automata from lane g on.
	const int32_t* others(int k, int g) const { return neighbour + k * blockSize + g; }
	Vec<v8>        position(int g) const { return { load(x + g), load(y + g) }; }
	Vec<v8>        velocity(int g) const { return { load(vx + g), load(vy + g) }; }
	/// s, tau of link k.
	Pair<v8> stress(int k, int g) const { return { load(s + k * blockSize + g), load(tau + k * blockSize + g) }; }
};

/// Positions of neighbours.
MCA_INLINE Vec<v8> gatherPosition(const double* node, const int32_t* at)
{
	Vec<v8> r;
	gather2(node, nodeSize, at, r.x, r.y);
	return r;
}
struct Motion {
	Vec<v8> position, velocity;
};
MCA_INLINE Motion gatherMotion(const double* node, const int32_t* at)
{
	Motion m;
	gather4(node, nodeSize, at, m.position.x, m.position.y, m.velocity.x, m.velocity.y);
	return m;
}
MCA_INLINE Tensor<v8> gatherPush(const double* push, const int32_t* at)
{
	Tensor<v8> t;
	gather4(push, pushSize, at, t.xx, t.xy, t.yx, t.yy);
	return t;
}

/// a where the lane is on, else b; intact blocks need no choice.
template <bool intact> MCA_INLINE v8 choose(m8 on, v8 a, v8 b) { return intact ? a : on ? a : b; }
template <bool intact> MCA_INLINE Vec<v8> choose(m8 on, Vec<v8> a, Vec<v8> b) { return { choose<intact>(on, a.x, b.x), choose<intact>(on, a.y, b.y) }; }
/// Lanes in which link k holds, and their weights.
MCA_INLINE m8 holding(m8 flags, int k) { return ((flags >> k) & 1) != 0; }
template <bool intact> MCA_INLINE v8 weights(m8 flags, int k)
{
	return choose<intact>(((flags >> (halfShift + k)) & 1) != 0, splat(intact ? 1. : 0.5), splat(1.));
}

/// f(b1, b2, ...) with these truth values as compile-time constants.
template <class F> MCA_INLINE void choices(F&& f) { f(); }
template <class F, class... More> MCA_INLINE void choices(F&& f, bool first, More... more)
{
	if (first) choices([&](auto... rest) { f(std::true_type {}, rest...); }, more...);
	else choices([&](auto... rest) { f(std::false_type {}, rest...); }, more...);
}
}
