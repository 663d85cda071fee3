// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "../../kernels/automaton/outline.hpp"
#include "../view.hpp"

namespace mca::automata {

struct BlockView : BlockBase {
	const double* omega = at(store.omega);
	double *      szz = at(store.szz), *s = at(store.s, nLinks), *tau = at(store.tau, nLinks), *torque = at(store.torque);
	BlockView(Store& S, size_t b)
		: BlockBase(S, b)
	{
	}
	/// s, tau of link k.
	Pair<v8> stress(int k, int g) const { return { load(s + k * blockSize + g), load(tau + k * blockSize + g) }; }
};

/// What passes 2 and 3 read.
MCA_INLINE void prefetchLinks(const Store& S, size_t b)
{
	if (S.size() < prefetchFrom || b + 1 >= S.blocks.size()) return;
	prefetchRecords(S, b), prefetch(S.push, b + 1, pushSize), prefetch(S.s, b + 1, nLinks), prefetch(S.tau, b + 1, nLinks);
}

struct Motion {
	Vec<v8> position, velocity;
};
MCA_INLINE Motion gatherMotion(const double* node, const int32_t* at)
{
	Motion m;
	gather4(node, nodeSize, at, m.position[0], m.position[1], m.velocity[0], m.velocity[1]);
	return m;
}
/// Triangles of eight automata; at: their flags, one behind the other, or where they stand among those of all.
struct EightTriangles {
	alignas(32) int32_t of[lanes];
	explicit EightTriangles(const int32_t* flags)
	{
		for (int l = 0; l < lanes; l++) of[l] = int32_t(trianglesIn(flags[l]));
	}
	EightTriangles(const int32_t* flagsOfAll, const int32_t* at)
	{
		for (int l = 0; l < lanes; l++) of[l] = int32_t(trianglesIn(flagsOfAll[at[l]]));
	}
	m8 any() const { return widen(of) != 0; }
};

MCA_INLINE Tensor<v8> gatherPush(const double* push, const int32_t* at)
{
	Tensor<v8> t;
	gather(push, pushSize, at, t);
	return t;
}
}
