// SPDX-License-Identifier: GPL-2.0-or-later
// The face-centred cubic packing: the one place that knows how many neighbours an automaton has and where they stand.
#pragma once
#include "../vector.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// Directions in the frame of the packing, which the solver never needs: sums over links give F times its constant rotation, of which only the determinant and
/// the cofactor times directions count. Omega0 = N0 S0 d / (2 dim).
struct FaceCentred {
	static constexpr int dim = mca::dim, neighbours = 12;
	static_assert(dim == 3, "a packing of space");
	static constexpr double h = 0.70710678118654752440;
	/// direction of link k [-]
	static constexpr double x[neighbours] = { h, h, h, h, 0., 0., -h, -h, -h, -h, 0., 0. };
	static constexpr double y[neighbours] = { h, -h, 0., 0., h, h, -h, h, 0., 0., -h, -h };
	static constexpr double z[neighbours] = { 0., 0., h, -h, h, -h, 0., 0., -h, h, -h, h };
	static Vec<double>      direction(int k) { return { x[k], y[k], z[k] }; }
	/// sum of direction (x) direction over all links = spread times the unit tensor
	static constexpr double spread = double(neighbours) / dim;
	/// the same link in the slots of its other end
	static constexpr int opposite(int k) { return (k + neighbours / 2) % neighbours; }
	static double        cell(double d) { return h * (d * d * d); }     ///< Omega0 [m3]
	static double        width(double d) { return 0.5 * h * (d * d); }  ///< S0 [m2]
	static double        inertia(double mass, double d) { return 0.12217741154217143 * mass * (d * d); } ///< of the sphere of this volume [kg m2]
	using Flags = int64_t; ///< holds three fields of bits for the links
	static constexpr int flagField = 16;
	using Bearing = Vec<double>; ///< where a neighbour stands: unit vector
	static Bearing bearing(Vec<double> r) { return r * (1. / std::sqrt(plainSquare(r))); }
	/// det F of links with some sum of r (x) e_k is this times its determinant [1/m3]: F = that sum / (spread d).
	static double perVolume(double d) { return 1. / (spread * spread * spread * (d * d * d)); }
	/// The same for the squares of the slopes of the volume by the positions of neighbours.
	static double            perSlope(double d) { return 1. / (spread * spread * spread * spread * ((d * d) * (d * d))); }
	static MCA_INLINE double power(double d, double r2) ///< (d/r)^dim
	{
		const double q = d * d / r2;
		return q * std::sqrt(q);
	}
	static MCA_INLINE double shape(double d, double invR2) { return (d * d * d) * (invR2 * invR2 * std::sqrt(invR2)); } ///< d^dim/r^(dim + 2) [1/m2]
	/// The stretch of all distances with this ratio of volumes.
	static double stretch(double volumes) { return std::cbrt(volumes); }
	/// S0 d [m3].
	template <class T> static MCA_INLINE T area(T d) { return (d * d) * (0.5 * h) * d; }
	static constexpr int    volumeLinks = 4;    ///< fewer links span no volume
	/// Distance at which the side of a loose automaton meets others, over d: spheres at random fill 0.64 of space (Scott and Kilgour 1969), in the packing
	/// 0.7405. Debris that met at d would fill more room than the metal it comes from.
	static constexpr double facets      = 1.224744871391589; ///< area of the pairs that a crack along the closest planes cuts, over its own [-]
	static constexpr double looseRest   = 0.9525;
	static constexpr double minVolume   = 0.03; ///< see minVolume in volume.hpp
	static constexpr double stripes     = 256.; ///< largest eigenvalue of the filter's operator
	/// Largest stable step: sound, times d/cP; the rotation of an automaton against its neighbours, omega^2 = 32.74 G/(rho d^2) for the inertia of the
	/// sphere, times d/cS.
	static constexpr double soundStep = 1.27, turningStep = 0.3495;
	/// Share of the viscous pressure in the damping of the fastest sound wave: the operator of the volume has the largest eigenvalue 2/d^2, that wave
	/// omega = 1.575 cP/d.
	static constexpr double      volumeDamping = 2. / (2. * 1.575);
	static constexpr double      linkViscosity = 1.; ///< share of the linear viscosity that links have of their own, beside (12a)
	static constexpr bool        affineOnly    = true; ///< whether it allows no other rule for the volume
	static constexpr bool        neighboursHold = true; ///< see heldByNeighbour(): second neighbours would touch from a strain of 0.35 on
	static constexpr const char* name          = "face-centred cubic";
};
/// The packing that the solvers are built for.
using Lattice = FaceCentred;
constexpr int nLinks = Lattice::neighbours;

/// Stands for direction (x) direction of link k in a sum over links; w: 1 where the link holds, else 0.
template <class T> MCA_INLINE void addDirection(Symmetric<T>& sum, int k, T w)
{
	sum.xx += w * (Lattice::x[k] * Lattice::x[k]), sum.yy += w * (Lattice::y[k] * Lattice::y[k]), sum.zz += w * (Lattice::z[k] * Lattice::z[k]);
	sum.yz += w * (Lattice::y[k] * Lattice::z[k]), sum.zx += w * (Lattice::z[k] * Lattice::x[k]), sum.xy += w * (Lattice::x[k] * Lattice::y[k]);
}
/// v (x) direction of link k in a sum over links: two of three columns.
template <class T> MCA_INLINE void addDyad(Tensor<T>& sum, int k, Vec<T> v)
{
	if (Lattice::x[k] != 0.) sum.column[0] = fma(Lattice::x[k], v, sum.column[0]);
	if (Lattice::y[k] != 0.) sum.column[1] = fma(Lattice::y[k], v, sum.column[1]);
	if (Lattice::z[k] != 0.) sum.column[2] = fma(Lattice::z[k], v, sum.column[2]);
}
/// v (x) c in a sum over links.
template <class T> MCA_INLINE void addDyad(Tensor<T>& sum, Vec<T> c, Vec<T> v)
{
	for (int q = 0; q < dim; q++) sum.column[q] = fma(c[q], v, sum.column[q]);
}
/// Sum over the links of (cofactor(F) e_k)^2; e: sum of e_k (x) e_k.
template <class T> MCA_INLINE T squareOfPushes(const Tensor<T>& F, const Symmetric<T>& e)
{
	const Tensor<T> C = cofactor(F);
	const Vec<T>    a = C.column[0], b = C.column[1], c = C.column[2];
	return e.xx * dot(a, a) + e.yy * dot(b, b) + e.zz * dot(c, c) + 2. * (e.yz * dot(b, c) + e.zx * dot(c, a) + e.xy * dot(a, b));
}
/// A times direction of link k: the sum or difference of two columns.
template <class T> MCA_INLINE Vec<T> times(const Tensor<T>& A, int k)
{
	const Vec<T>&first = A.column[Lattice::x[k] != 0. ? 0 : 1], &second = A.column[Lattice::z[k] != 0. ? 2 : 1];
	const double f = Lattice::x[k] != 0. ? Lattice::x[k] : Lattice::y[k], s = Lattice::z[k] != 0. ? Lattice::z[k] : Lattice::y[k];
	return { fma(f, first[0], s * second[0]), fma(f, first[1], s * second[1]), fma(f, first[2], s * second[2]) };
}
}
}
