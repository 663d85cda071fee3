// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors and tensors of the space in which the automata move, for one automaton (T = double) or eight side by side (T = v8).
#pragma once
#include "simd.hpp"

namespace mca {

template <class T> struct Vec {
	T x, y;
};
template <class T> struct Tensor {
	T xx, xy, yx, yy;
};
template <class T> struct Symmetric {
	T xx, xy, yy;
};

template <class T> MCA_INLINE Vec<T> operator-(Vec<T> a, Vec<T> b) { return { a.x - b.x, a.y - b.y }; }
template <class T> MCA_INLINE Vec<T> operator*(Vec<T> a, T f) { return { a.x * f, a.y * f }; }
template <class T> MCA_INLINE T      dot(Vec<T> a, Vec<T> b) { return fma(a.x, b.x, a.y * b.y); }
/// component of b across a, positive when b points to the left of a, times |a|
template <class T> MCA_INLINE T         cross(Vec<T> a, Vec<T> b) { return fma(a.x, b.y, -a.y * b.x); }
template <class T> MCA_INLINE Tensor<T> operator+(const Tensor<T>& a, const Tensor<T>& b) { return { a.xx + b.xx, a.xy + b.xy, a.yx + b.yx, a.yy + b.yy }; }
template <class T> MCA_INLINE T         determinant(const Tensor<T>& A) { return A.xx * A.yy - A.xy * A.yx; }
/// d(det A)/dA
template <class T> MCA_INLINE Tensor<T> cofactor(const Tensor<T>& A) { return { A.yy, -A.yx, -A.xy, A.xx }; }
}
