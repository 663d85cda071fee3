// SPDX-License-Identifier: GPL-2.0-or-later
// Where a body ends: the triangles of the packing around an automaton that belong to it, and what follows for its weight, its links and its volume. The outline
// of such a body runs through the centres of its outermost automata. Formulation, equations (5g) and (7b).
#pragma once
#include "../automaton/links.hpp"
#include <cmath>

namespace mca {
inline namespace MCA_SPACE {

constexpr uint32_t outlineBits = uint32_t(linkBits) << outlineShift; ///< of the flags
static_assert(outlineShift + nLinks <= 32, "the bits of the triangles do not fit");
/// Bit k: the triangle between links k and k + 1 belongs to the body.
using Triangles = uint32_t;

/// All links with full weight: those at weighted rims exchange no volume (5e).
inline bool isWholeStar(Flags flags) { return isWhole(flags); }

constexpr int  nextLink(int k) { return (k + 1) % nLinks; }
constexpr int  lastLink(int k) { return (k + nLinks - 1) % nLinks; }
constexpr bool hasTriangle(Triangles t, int k) { return (t >> k) & 1; }
inline int     triangleCount(Triangles t) { return __builtin_popcount(t); }
/// Of link k: how many of the two triangles beside it belong to the body.
constexpr int trianglesBeside(Triangles t, int k) { return int(hasTriangle(t, k)) + int(hasTriangle(t, lastLink(k))); }
/// Share of the full cell: of mass, volume and inertia [-].
inline double outlineWeight(Triangles t) { return triangleCount(t) * (1. / nLinks); }
/// The triangles whose two links and the edge between their far ends hold. links: of the automaton; opposite(k): whether the ends of links k and k + 1 are
/// linked.
template <class F> Triangles trianglesOf(int32_t links, F&& opposite)
{
	Triangles t = 0;
	for (int k = 0; k < nLinks; k++)
		if (holds(links, k) && holds(links, nextLink(k)) && opposite(k)) t |= 1u << k;
	return t;
}
/// Whether the automaton ends at an outline: some triangles are missing, and its mass is that of those that are there. Its volume and its weight are then
/// theirs; who stands for another share of its cell has the volume of its links.
inline bool endsAtOutline(Triangles t, double weight)
{
	const int n = triangleCount(t);
	return n > 0 && n < nLinks && std::fabs(weight - outlineWeight(t)) < 1e-6;
}

// In the flags of an automaton: its triangles while it ends at an outline, else none. A link that breaks takes them from both of its ends: what is torn has the
// volume of the links that are left.
inline Triangles trianglesIn(int32_t flags) { return uint32_t(flags) >> outlineShift; }
inline int32_t   withTriangles(int32_t flags, Triangles t) { return int32_t((uint32_t(flags) & ~outlineBits) | t << outlineShift); }
inline int32_t   withoutTriangles(int32_t flags) { return withTriangles(flags, 0); }

/// Takes the place of the direction of link k in F = sum r (x) c_k / (spread d): the mean of the gradients in the triangles, exact in every homogeneous
/// deformation. Without triangles: the direction itself.
inline Vec<double> outlineDirection(Triangles t, int k)
{
	const int  n         = triangleCount(t);
	const auto direction = [](int q) { return Vec<double> { Lattice::x[q], Lattice::y[q] }; };
	if (n == 0 || n == nLinks) return direction(k);
	const Vec<double> before = direction(k) + direction(lastLink(k)), after = direction(k) + direction(nextLink(k)), none { 0., 0. };
	return ((hasTriangle(t, k) ? before : none) + (hasTriangle(t, lastLink(k)) ? after : none)) * (2. * Lattice::spread / (3. * n));
}
/// outlineDirection() of all sets and links, one behind the other.
struct OutlineTable {
	static constexpr int perSet = nLinks * dim;
	double               direction[(1 << nLinks) * perSet];
	OutlineTable()
	{
		for (Triangles t = 0; t < 1u << nLinks; t++)
			for (int k = 0; k < nLinks; k++)
				Planes<double> { { at(t, k), at(t, k) + 1 } }.set(0, outlineDirection(t, k));
	}
	double*     at(Triangles t, int k) { return direction + t * perSet + k * dim; }
	Vec<double> of(Triangles t, int k) const { return Vec<double> { direction[t * perSet + k * dim], direction[t * perSet + k * dim + 1] }; }
};
inline const OutlineTable outlineTable;
/// Of eight automata.
MCA_INLINE Vec<v8> outlineDirection(const int32_t* triangles, int k)
{
	Vec<v8> c;
	gather(outlineTable.direction + k * dim, OutlineTable::perSet, triangles, c);
	return c;
}

/// Adds what link k measures of F, with the direction that its outline gives it.
inline void addMeasured(Tensor<double>& sum, Flags flags, int k, Vec<double> r) { addDyad(sum, outlineTable.of(trianglesIn(flags), k), r); }

/// What is shown as pressure, and judged by fracture criteria: at an outline P of the equation of state, since a part of a star has a mean of its own even in
/// a uniform field; mean = meanPressure().
inline double shownPressure(double P, double mean, int32_t flags) { return trianglesIn(flags) ? P : mean; }

/// Push of the pressures of both ends along link k; own, other: their affinePush(), a, b: their triangles.
inline Vec<double> pressurePush(const Tensor<double>& own, const Tensor<double>& other, Triangles a, Triangles b, int k)
{
	if (!(a | b)) return times(own + other, k);
	return times(own, outlineTable.of(a, k)) - times(other, outlineTable.of(b, Lattice::opposite(k)));
}
}
}
