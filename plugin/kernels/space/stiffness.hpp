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
template <class T> MCA_INLINE T largestStretch(const Tensor<T>& sum, const Symmetric<T>& rest, T factor, double d2)
{
	const Tensor<T> C = cofactor(sum) * (factor * (1. / (Lattice::spread * Lattice::spread * d2))); // times rest: cofactor of F
	const Vec<T> a = times(C, { rest.xx, rest.xy, rest.zx }), b = times(C, { rest.xy, rest.yy, rest.yz }), c = times(C, { rest.zx, rest.yz, rest.zz });
	const Symmetric<T> B = symmetricDyad(a, a) + symmetricDyad(b, b) + symmetricDyad(c, c), off = deviatorOf(B);
	return max((1. / 3.) * trace(B) + root((2. / 3.) * dot(off, off)), T {} + 1.);
}
/// How much stiffer than in the whole packing at rest: at surfaces by the slope of their volume at rest, by deformation, and for the pair law by the closest
/// link.
template <class T> struct Stiffening {
	T bulk, shear;
};
/// nearest2 = smallest r^2 [m2]. sum: of r (x) e_k, directions: of e_k (x) e_k. Covers edges and corners up to nu = 0.49, measured.
template <class T> MCA_INLINE Stiffening<T> stiffening(const Tensor<T>& sum, const Symmetric<T>& directions, T factor, T nearest2, double d2)
{
	const Symmetric<T> rest = directions * (T {} + 1. / Lattice::spread), C = cofactor(rest);
	const T one = T {} + 1., det = rest.xx * C.xx + rest.xy * C.xy + rest.zx * C.zx, perDet = factor > 0. ? one / det : T {};
	const T slope = max((1. / 3.) * trace(C) * perDet, one), stretch = largestStretch(sum, rest, factor, d2);
	return { max(min(slope * slope, one * 4.), slope) * stretch, max(max(0.5 * d2 / nearest2, slope * stretch), one) };
}
/// stiffness() with that.
template <EosKind law>
MCA_INLINE double
affineStiffness(const VolumeConstants<law>& c, double J, const Tensor<double>& sum, const Symmetric<double>& directions, double factor, double nearest2)
{
	const Stiffening<double> s = stiffening(sum, directions, factor, nearest2, c.d2);
	return stiffness<law>(c, J, s.bulk, s.shear);
}
}
}
