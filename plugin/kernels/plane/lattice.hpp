// SPDX-License-Identifier: GPL-2.0-or-later
// The hexagonal packing: the one place that knows how many neighbours an automaton has and where they stand.
#pragma once
#include "../vector.hpp"

namespace mca {
inline namespace MCA_SPACE {

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
	using Flags = int32_t; ///< holds three fields of bits for the links
	static constexpr int flagField = 8;
	using Bearing = double; ///< where a neighbour stands: angle in the plane [rad]
	static double bearing(Vec<double> r) { return std::atan2(r[1], r[0]); }
	/// det F of links with some sum of r (x) e_k is this times its determinant [1/m2]: F = that sum / (spread d).
	static double perVolume(double d) { return 1. / (spread * spread * (d * d)); }
	/// The same for the squares of the slopes of the volume by the positions of neighbours.
	static double perSlope(double d) { return perVolume(d); }
	static MCA_INLINE double power(double d, double r2) { return d * d / r2; }                    ///< (d/r)^dim
	static MCA_INLINE double shape(double d, double invR2) { return d * d * invR2 * invR2; }      ///< d^dim/r^(dim + 2) [1/m2]
	/// The stretch of all distances with this ratio of volumes.
	static double stretch(double volumes) { return std::sqrt(volumes); }
	/// S0 d [m2].
	template <class T> static MCA_INLINE T area(T d) { return (d * width(1.)) * d; }
	static constexpr int    volumeLinks = 3;  ///< fewer links span no volume
	static constexpr double facets      = 1.1547005383792517; ///< area of the pairs that a crack along the closest rows cuts, over its own [-]
	static constexpr double looseRest   = 1.;  ///< loose automata crystallise
	static constexpr double minVolume   = 0.2; ///< see minVolume in volume.hpp
	static constexpr double stripes     = 64.; ///< largest eigenvalue of the filter's operator
	/// Largest stable step: sound, times d/cP; the rotation of an automaton against its neighbours, omega^2 = 32 G/(rho d^2), times d/cS.
	static constexpr double soundStep = 1.65, turningStep = 0.35355339059327376;
	/// Share of the viscous pressure in the damping of the fastest sound wave: the operator of the volume has the largest eigenvalue 1.377/d^2, that wave
	/// omega = 1.212 cP/d.
	static constexpr double volumeDamping = 1.377 / (2. * 1.212);
	static constexpr double linkViscosity = 1.; ///< share of the linear viscosity that links have of their own, beside (12a)
	static constexpr bool affineOnly = false; ///< whether it allows no other rule for the volume
	static constexpr bool neighboursHold = false; ///< see heldByNeighbour(): second neighbours would touch from a strain of 0.55 on
	static constexpr const char* name = "hexagonal";
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
/// Sum over the links of (cofactor(F) e_k)^2; e: sum of e_k (x) e_k.
template <class T> MCA_INLINE T squareOfPushes(const Tensor<T>& F, const Symmetric<T>& e)
{
	return e.xx * (F.yy * F.yy + F.xy * F.xy) - 2. * e.xy * (F.yy * F.yx + F.xy * F.xx) + e.yy * (F.yx * F.yx + F.xx * F.xx);
}
/// A times direction of link k.
template <class T> MCA_INLINE Vec<T> times(const Tensor<T>& A, int k)
{
	return { fma(Lattice::x[k], A.xx, Lattice::y[k] * A.xy), fma(Lattice::x[k], A.yx, Lattice::y[k] * A.yy) };
}
/// A times c.
template <class T> MCA_INLINE Vec<T> times(const Tensor<T>& A, Vec<T> c) { return { fma(c[0], A.xx, c[1] * A.xy), fma(c[0], A.yx, c[1] * A.yy) }; }
}
}
