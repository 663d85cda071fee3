// SPDX-License-Identifier: GPL-2.0-or-later
// How stiff an automaton in space is for the motion of its neighbours, for the stable step.
#pragma once
#include "../automaton/volume.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// Largest square by which the deformation of links with this sum of r (x) e_k, at rest `rest` = sum of e_k (x) e_k over spread, changes areas; at least 1 [-].
/// In the direction of strongest compression waves are as much stiffer. Exact where two directions are alike and the third is shorter, at most a third above
/// else.
/// factor: J = factor det F; at rest 1/determinant(rest).
MCA_INLINE double largestStretch(const Tensor<double>& sum, const Symmetric<double>& rest, double factor, double d2)
{
	const Tensor<double> C = cofactor(sum) * (factor / (Lattice::spread * Lattice::spread * d2)); // times rest: cofactor of F
	const Vec<double> a = times(C, { rest.xx, rest.xy, rest.zx }), b = times(C, { rest.xy, rest.yy, rest.yz }),
			  c = times(C, { rest.zx, rest.yz, rest.zz });
	const Symmetric<double> B = symmetricDyad(a, a) + symmetricDyad(b, b) + symmetricDyad(c, c), off = deviatorOf(B);
	return max((1. / 3.) * trace(B) + std::sqrt((2. / 3.) * dot(off, off)), 1.);
}
/// stiffness(), and how much stiffer than in the whole packing at rest: at surfaces by the slope of their volume at rest, by deformation, and for the pair law
/// by the closest link, nearest2 = smallest r^2 [m2]. sum: of r (x) e_k, directions: of e_k (x) e_k. Covers edges and corners up to nu = 0.49, measured.
template <EosKind law>
MCA_INLINE double
affineStiffness(const VolumeConstants<law>& c, double J, const Tensor<double>& sum, const Symmetric<double>& directions, double factor, double nearest2)
{
	const Symmetric<double> rest = directions * (1. / Lattice::spread), C = cofactor(rest);
	const double det = rest.xx * C.xx + rest.xy * C.xy + rest.zx * C.zx, perDet = factor > 0. ? 1. / det : 0.;
	const double slope = max((1. / 3.) * trace(C) * perDet, 1.), stretch = largestStretch(sum, rest, factor, c.d2);
	const double shear = max(0.5 * c.d2 / nearest2, slope * stretch);
	return stiffness<law>(c, J, max(min(slope * slope, 4.), slope) * stretch, max(shear, 1.));
}
}
}
