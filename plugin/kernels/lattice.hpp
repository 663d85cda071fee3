// SPDX-License-Identifier: GPL-2.0-or-later
// The packing of the automata: the one place that knows how many neighbours an automaton has and where they stand.
#pragma once
#include "vector.hpp"

namespace mca {

/// Hexagonal packing in plane strain, per unit thickness. Link k points at 60 k degrees in the frame of the packing. Omega0 = N0 S0 d / (2 dim).
struct Hexagonal {
	static constexpr int dim = mca::dim, neighbours = 6;
	static_assert(dim == 2, "a packing of the plane");
	static constexpr double turn = 3.14159265358979323846 / 3.; ///< angle between two links next to each other [rad]
	/// direction of link k [-]
	static constexpr double x[neighbours] = { 1., 0.5, -0.5, -1., -0.5, 0.5 };
	static constexpr double y[neighbours] = { 0., 0.86602540378443864676, 0.86602540378443864676, 0., -0.86602540378443864676, -0.86602540378443864676 };
	/// sum of direction (x) direction over all links = spread times the unit tensor
	static constexpr double spread = double(neighbours) / dim;
	/// the same link in the slots of its other end
	static constexpr int opposite(int k) { return (k + neighbours / 2) % neighbours; }
	static double        cell(double d) { return 0.86602540378443864676 * d * d; } ///< Omega0 [m2]
	static double        width(double d) { return d * 0.57735026918962576451; }    ///< S0 [m]
	static double        angle(Vec<double> r) { return std::atan2(r[1], r[0]); }   ///< in the plane [rad]
};
/// The packing that the solvers are built for.
using Lattice = Hexagonal;
constexpr int nLinks = Lattice::neighbours;

/// Stands for direction (x) direction of link k in a sum over links; w: 1 where the link holds, else 0. All of them make spread exactly.
template <class T> MCA_INLINE void addDirection(Symmetric<T>& sum, int k, T w)
{
	sum.xx += w * (Lattice::x[k] * Lattice::x[k]), sum.xy += w * (Lattice::x[k] * Lattice::y[k]), sum.yy += w * (1. - Lattice::x[k] * Lattice::x[k]);
}
/// v (x) direction of link k in a sum over links.
template <class T> MCA_INLINE void addDyad(Tensor<T>& sum, int k, Vec<T> v)
{
	sum.xx = fma(Lattice::x[k], v[0], sum.xx), sum.yx = fma(Lattice::x[k], v[1], sum.yx);
	if (Lattice::y[k] != 0.) sum.xy = fma(Lattice::y[k], v[0], sum.xy), sum.yy = fma(Lattice::y[k], v[1], sum.yy);
}
/// c (x) c in a sum over links.
template <class T> MCA_INLINE void addSquare(Symmetric<T>& sum, Vec<T> c)
{
	sum.xx = fma(c[0], c[0], sum.xx), sum.xy = fma(c[0], c[1], sum.xy), sum.yy = fma(c[1], c[1], sum.yy);
}
/// v (x) c in a sum over links.
template <class T> MCA_INLINE void addDyad(Tensor<T>& sum, Vec<T> c, Vec<T> v)
{
	sum.xx = fma(c[0], v[0], sum.xx), sum.yx = fma(c[0], v[1], sum.yx);
	sum.xy = fma(c[1], v[0], sum.xy), sum.yy = fma(c[1], v[1], sum.yy);
}
/// A times direction of link k.
template <class T> MCA_INLINE Vec<T> times(const Tensor<T>& A, int k)
{
	return { fma(Lattice::x[k], A.xx, Lattice::y[k] * A.xy), fma(Lattice::x[k], A.yx, Lattice::y[k] * A.yy) };
}
/// A times c.
template <class T> MCA_INLINE Vec<T> times(const Tensor<T>& A, Vec<T> c) { return { fma(c[0], A.xx, c[1] * A.xy), fma(c[0], A.yx, c[1] * A.yy) }; }
}
