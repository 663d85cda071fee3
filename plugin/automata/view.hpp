// SPDX-License-Identifier: GPL-2.0-or-later
// One block of the store as the passes see it: bare pointers to its 64 lanes. Through the vectors their starts would be read again after each write.
#pragma once
#include "store.hpp"
#include <utility>

namespace mca::automata {

struct BlockBase {
	Store&          store;
	const size_t    base;
	const Block&    block    = store.blocks[base / blockSize];
	const Material& material = store.materialOf(block);
	const double    d        = store.species[block.species].d; ///< diameter [m]
	/// First of the entries of this block, of which there are `each` per automaton; null where the array is empty.
	template <class T> T*      at(std::vector<T>& v, size_t each = 1) const { return v.empty() ? nullptr : v.data() + base * each; }
	const Planes<const double> positionOfAll = std::as_const(store.position).planes(), position = std::as_const(store.position).planes(base),
				   velocity = std::as_const(store.velocity).planes(base);
	const Planes<double> force          = store.force.planes(base);
	const double *       cell = at(store.cell), *invN = at(store.invN), *strength = at(store.strength), *weight = at(store.weight),
		     *diameterOfAll = store.diameter.data(), *node = store.node.data(), *pushOfAll = store.push.data();
	double *J = at(store.J), *dTheta = at(store.dTheta), *P = at(store.P), *mean = at(store.mean), *viscous = at(store.viscous), *h = at(store.h),
	       *factor = at(store.factor), *rest = at(store.rest), *eqps = at(store.eqps), *temperature = at(store.temperature),
	       *heat = at(store.heat), *damage = at(store.damage), *criterion = at(store.criterion), *record = at(store.node, nodeSize),
	       *push = at(store.push, pushSize);
	const Flags *  flags = at(store.flags), *flagsOfAll = store.flags.data();
	const int32_t* neighbour = at(store.neighbour, nLinks);
	BlockBase(Store& S, size_t b)
		: store(S)
		, base(b * blockSize)
	{
	}
	/// Neighbours by link k of the eight automata from lane g on.
	const int32_t* others(int k, int g) const { return neighbour + k * blockSize + g; }
};

/// Number of automata from which on their arrays are beyond the caches: a pass then asks for those of the next block while it computes this one.
/// Neighbours are in the same block or in those before and behind it, so their records are there when they are gathered.
constexpr size_t prefetchFrom = dim == 2 ? 40000 : 4000;
template <class T> MCA_INLINE void prefetch(const std::vector<T>& v, size_t block, size_t each)
{
	const char* p = reinterpret_cast<const char*>(v.data() + block * blockSize * each);
	for (size_t q = 0; q < blockSize * each * sizeof(T); q += 64) __builtin_prefetch(p + q, 0, 2);
}
/// What pass 1 gathers.
MCA_INLINE void prefetchRecords(const Store& S, size_t b)
{
	if (S.size() < prefetchFrom || b + 1 >= S.blocks.size()) return;
	prefetch(S.node, b + 1, nodeSize), prefetch(S.neighbour, b + 1, nLinks);
}
/// Positions of neighbours.
MCA_INLINE Vec<v8> gatherPosition(const double* node, const int32_t* at)
{
	Vec<v8> r;
	gather(node, nodeSize, at, r);
	return r;
}

/// a where the lane is on, else b; intact blocks need no choice.
template <bool intact> MCA_INLINE v8 choose(m8 on, v8 a, v8 b) { return intact ? a : on ? a : b; }
template <bool intact> MCA_INLINE Vec<v8> choose(m8 on, Vec<v8> a, Vec<v8> b)
{
	for (int c = 0; c < dim; c++) a[c] = choose<intact>(on, a[c], b[c]);
	return a;
}
/// Lanes in which link k holds, and their weights.
MCA_INLINE m8 holding(m8 flags, int k) { return ((flags >> k) & 1) != 0; }
template <bool intact> MCA_INLINE v8 weights(m8 flags, int k)
{
	const v8 half = dim == 3 && !intact ? ((flags >> (outlineShift + k)) & 1) != 0 ? splat(0.25) : splat(0.5) : splat(intact ? 1. : 0.5);
	return choose<intact>(((flags >> (halfShift + k)) & 1) != 0, half, splat(1.));
}

/// f(b1, b2, ...) with these truth values as compile-time constants.
template <class F> MCA_INLINE void choices(F&& f) { f(); }
template <class F, class... More> MCA_INLINE void choices(F&& f, bool first, More... more)
{
	if (first) choices([&](auto... rest) { f(std::true_type {}, rest...); }, more...);
	else choices([&](auto... rest) { f(std::false_type {}, rest...); }, more...);
}
}
#if MCA_DIM == 2
#include "plane/view.hpp"
#else
#include "space/view.hpp"
#endif
