// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "../view.hpp"

namespace mca::automata {

struct BlockView : BlockBase {
	const Planes<const double> omega    = std::as_const(store.omega).planes(base);
	const Planes<double>       torque   = store.torque.planes(base);
	double*                    traction = at(store.traction, nLinks * tractionSize);
	const double*              tractionOfAll = store.traction.data();
	double *sxx = at(store.sxx), *syy = at(store.syy), *szz = at(store.szz), *syz = at(store.syz), *szx = at(store.szx), *sxy = at(store.sxy);
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
	Vec<v8>*   c = p.volume.column;
	gather4(push, pushSize, at, c[0][0], c[0][1], c[0][2], c[1][0]), gather4(push + 4, pushSize, at, c[1][1], c[1][2], c[2][0], c[2][1]);
	gather4(push + 8, pushSize, at, c[2][2], p.pressure, p.own.xx, p.own.yy), gather4(push + 12, pushSize, at, p.own.zz, p.own.yz, p.own.zx, p.own.xy);
	return p;
}
/// Those of eight automata in a row.
MCA_INLINE void scatterPushes(double* push, const Pushes<v8>& p)
{
	const Vec<v8>* c = p.volume.column;
	scatter4(push, pushSize, c[0][0], c[0][1], c[0][2], c[1][0]), scatter4(push + 4, pushSize, c[1][1], c[1][2], c[2][0], c[2][1]);
	scatter4(push + 8, pushSize, c[2][2], p.pressure, p.own.xx, p.own.yy), scatter4(push + 12, pushSize, p.own.zz, p.own.yz, p.own.zx, p.own.xy);
}
}
