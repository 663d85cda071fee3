// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "../view.hpp"

namespace mca::automata {

struct BlockView : BlockBase {
	const Planes<const double> omega    = std::as_const(store.omega).planes(base);
	const Planes<double>       torque   = store.torque.planes(base);
	double*                    traction = at(store.traction, nLinks * tractionSize);
	double*                    shares   = at(store.shares, sharesSize);
	const double*              sharesOfAll = store.shares.data();
	const double*              tractionOfAll = store.traction.data();
	const SymmetricPlanes      deviator = deviators(store, base);
	BlockView(Store& S, size_t b)
		: BlockBase(S, b)
	{
	}
	/// Tractions of link k of the eight automata from lane g on.
	double* tractions(int k, int g) const { return traction + (k * blockSize + g) * tractionSize; }
};

constexpr int32_t inRow[lanes] = { 0, 1, 2, 3, 4, 5, 6, 7 }; ///< places of eight records one behind the other
/// What passes 2 and 3 read.
MCA_INLINE void prefetchLinks(const Store& S, size_t b)
{
	if (S.size() < prefetchFrom || b + 1 >= S.blocks.size()) return;
	prefetchRecords(S, b), prefetch(S.push, b + 1, pushSize), prefetch(S.traction, b + 1, nLinks * tractionSize);
}

struct Motion {
	Vec<v8> position, velocity, omega;
};
/// All that moves.
MCA_INLINE Motion gatherMotion(const double* node, const int32_t* at)
{
	Motion m;
	v8     unused[2];
	gather4(node, nodeSize, at, m.position[0], m.position[1], m.position[2], m.velocity[0]);
	gather4(node + 4, nodeSize, at, m.velocity[1], m.velocity[2], m.omega[0], m.omega[1]);
	gather4(node + 8, nodeSize, at, m.omega[2], unused[0], unused[1], unused[1]);
	return m;
}
/// Without the spin.
MCA_INLINE Motion gatherVelocity(const double* node, const int32_t* at)
{
	Motion m;
	gather4(node, nodeSize, at, m.position[0], m.position[1], m.position[2], m.velocity[0]);
	gather2(node + 4, nodeSize, at, m.velocity[1], m.velocity[2]);
	return m;
}
MCA_INLINE Vec<v8> gatherTraction(const double* traction, const int32_t* at)
{
	Vec<v8> t;
	gather(traction, tractionSize, at, t);
	return t;
}
MCA_INLINE Pushes<v8> gatherPushes(const double* push, const int32_t* at)
{
	Pushes<v8> p;
	gather(push, pushSize, at, p.force, p.own);
	return p;
}
}
