// SPDX-License-Identifier: GPL-2.0-or-later
// Where bodies end in space: at whole automata, or at plane faces through the centres of automata that stand for a part of their cell, whose links within
// the face count half; at planes of symmetry moreover with the half that is not there. Formulation, (S8), (S9).
#pragma once
#include "../automaton/links.hpp"

namespace mca {
inline namespace MCA_SPACE {

using Triangles = uint32_t;
constexpr Flags  outlineBits = 0; ///< of the flags
inline Triangles trianglesIn(Flags) { return 0; }
inline Flags     withoutTriangles(Flags flags) { return flags; }
constexpr int    trianglesBeside(Triangles, int) { return 0; }
/// All links with full weight, or all that an automaton at a face, an edge or a corner has, of which those within a face count half (S8).
inline bool isWholeStar(Flags flags)
{
	const int halves = __builtin_popcount(unsigned((flags & halfBits) >> halfShift));
	const int quarters = __builtin_popcount(unsigned((flags & edgeBits) >> outlineShift));
	const int sum = 4 * linkCount(flags) - 2 * halves - quarters; // four times that of the weights
	return isWhole(flags) || (halves > 0 && brokenCount(flags) == 0 && (sum == 2 * nLinks || sum == nLinks || sum == nLinks / 2));
}
/// Share of the full star that the weighted links of an automaton make: that of the cell where it ends at faces (S8), else its sums are as they are.
MCA_INLINE double shareOfStar(Flags flags, double weight) { return flags & halfBits ? weight : 1.; }
/// Columns of F by the packing's own directions made those of a body that goes on beyond a plane of symmetry (S9). axis: of its normal in the laboratory,
/// normal: the same in the packing; zero: there is no such plane.
inline void mirror(Tensor<double>& F, int axis, Vec<double> normal)
{
	Vec<double> along {}; // F normal
	for (int q = 0; q < dim; q++) along = fma(normal[q], F.column[q], along);
	const double length = plainSquare(normal), across = along[axis];
	for (int q = 0; q < dim; q++) {
		for (int c = 0; c < dim; c++)
			if (c != axis) F.column[q][c] -= along[c] * normal[q];
		F.column[q][axis] += (across * normal[q] - F.column[q][axis]) * length;
	}
}
/// The same for a sum of directions (x) directions.
inline void mirror(Symmetric<double>& e, Vec<double> n)
{
	const Vec<double> t { e.xx * n[0] + e.xy * n[1] + e.zx * n[2], e.xy * n[0] + e.yy * n[1] + e.yz * n[2], e.zx * n[0] + e.yz * n[1] + e.zz * n[2] };
	const double      nn = plainDot(n, t);
	const Vec<double> off = t - n * nn; // what couples the normal to the plane
	e.xx -= 2. * off[0] * n[0], e.yy -= 2. * off[1] * n[1], e.zz -= 2. * off[2] * n[2];
	e.yz -= off[1] * n[2] + off[2] * n[1], e.zx -= off[2] * n[0] + off[0] * n[2], e.xy -= off[0] * n[1] + off[1] * n[0];
}
}
}
