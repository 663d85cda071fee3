// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors and tensors of the plane in which the automata move, for one automaton (T = double) or eight side by side (T = v8). The one place that knows their
// components; what is written out here stays in registers, whatever the compiler thinks of loops.
#pragma once
#include "../dimension.hpp"
#include "../simd.hpp"
#include <ostream>

namespace mca {
inline namespace MCA_SPACE {

using mca::fma, mca::load, mca::store; // those of numbers, beside those of vectors below

template <class T> struct Vec {
	T                   component[dim];
	MCA_INLINE T&       operator[](int c) { return component[c]; }
	MCA_INLINE const T& operator[](int c) const { return component[c]; }
};
template <class T> struct Tensor {
	T xx, xy, yx, yy;
};
template <class T> struct Symmetric {
	T xx, xy, yy;
};

template <class T> MCA_INLINE Vec<T> operator-(Vec<T> a) { return { -a[0], -a[1] }; }
template <class T> MCA_INLINE Vec<T> operator+(Vec<T> a, Vec<T> b) { return { a[0] + b[0], a[1] + b[1] }; }
template <class T> MCA_INLINE Vec<T> operator-(Vec<T> a, Vec<T> b) { return { a[0] - b[0], a[1] - b[1] }; }
template <class T> MCA_INLINE Vec<T>   operator*(Vec<T> a, T f) { return { a[0] * f, a[1] * f }; }
template <class T> MCA_INLINE void     operator+=(Vec<T>& a, Vec<T> b) { a[0] += b[0], a[1] += b[1]; }
template <class F, class T> MCA_INLINE Vec<T> fma(F f, Vec<T> a, Vec<T> b) { return { fma(f, a[0], b[0]), fma(f, a[1], b[1]) }; }
template <class T> MCA_INLINE T               dot(Vec<T> a, Vec<T> b) { return fma(a[0], b[0], a[1] * b[1]); }
/// component of b across a, positive when b points to the left of a, times |a|
template <class T> MCA_INLINE T cross(Vec<T> a, Vec<T> b) { return fma(a[0], b[1], -a[1] * b[0]); }
/// a turned by a right angle to the left
template <class T> MCA_INLINE Vec<T> turned(Vec<T> a) { return { -a[1], a[0] }; }
/// some vector of this length
template <class T> MCA_INLINE Vec<T> ofLength(T d) { return { d, T {} }; }
// every product rounded: the same bits on machines with and without fma
inline double plainDot(Vec<double> a, Vec<double> b) { return a[0] * b[0] + a[1] * b[1]; }
inline double plainSquare(Vec<double> a) { return plainDot(a, a); }
inline double plainCross(Vec<double> a, Vec<double> b) { return a[0] * b[1] - a[1] * b[0]; }
/// sum of the magnitudes of the components
inline double        sumOfMagnitudes(Vec<double> a) { return std::fabs(a[0]) + std::fabs(a[1]); }
inline bool          isZero(Vec<double> a) { return a[0] == 0 && a[1] == 0; }
inline Vec<bool>     everyWay() { return { true, true }; }
inline std::ostream& operator<<(std::ostream& s, Vec<double> a) { return s << "(" << a[0] << ", " << a[1] << ")"; }

/// What turns: a spin, an angle, a torque. Motion in the plane turns about one axis.
template <class T> using Turn = T;
constexpr int     turns = 1; ///< its components
inline Turn<bool> everyTurn() { return true; }
// as of vectors
inline double plainDot(double a, double b) { return a * b; }
inline double plainSquare(double a) { return a * a; }
inline double sumOfMagnitudes(double a) { return std::fabs(a); }
inline bool   isZero(double a) { return a == 0; }

template <class T> MCA_INLINE Tensor<T> operator*(const Tensor<T>& a, T f) { return { a.xx * f, a.xy * f, a.yx * f, a.yy * f }; }
template <class T> MCA_INLINE Tensor<T> operator+(const Tensor<T>& a, const Tensor<T>& b) { return { a.xx + b.xx, a.xy + b.xy, a.yx + b.yx, a.yy + b.yy }; }
template <class T> MCA_INLINE T         determinant(const Tensor<T>& A) { return A.xx * A.yy - A.xy * A.yx; }
/// d(det A)/dA
template <class T> MCA_INLINE Tensor<T> cofactor(const Tensor<T>& A) { return { A.yy, -A.yx, -A.xy, A.xx }; }
/// sum += a in the lanes that are on, else b
MCA_INLINE void addEither(Symmetric<v8>& sum, m8 on, const Symmetric<v8>& a, const Symmetric<v8>& b)
{
	sum.xx += on ? a.xx : b.xx, sum.xy += on ? a.xy : b.xy, sum.yy += on ? a.yy : b.yy;
}
/// f times the unit tensor
inline Symmetric<double> isotropic(double f) { return { f, 0., f }; }

/// Vectors in memory: a plane of numbers per component.
template <class P> struct Planes {
	P*            plane[dim];
	MCA_INLINE P* operator[](int c) const { return plane[c]; }
	MCA_INLINE Vec<double> at(size_t i) const { return { plane[0][i], plane[1][i] }; }
	MCA_INLINE void        set(size_t i, Vec<double> v) const { plane[0][i] = v[0], plane[1][i] = v[1]; }
};
template <class P> MCA_INLINE Vec<v8> load(const Planes<P>& p, size_t i) { return { load(p.plane[0] + i), load(p.plane[1] + i) }; }
MCA_INLINE void                       store(const Planes<double>& p, size_t i, Vec<v8> v) { store(p.plane[0] + i, v[0]), store(p.plane[1] + i, v[1]); }

/// Tensors of n automata, a plane per entry.
template <int n> struct TensorLanes {
	alignas(64) double xx[n], xy[n], yx[n], yy[n];
	MCA_INLINE Tensor<double> at(int l) const { return { xx[l], xy[l], yx[l], yy[l] }; }
	MCA_INLINE void           set(int l, const Tensor<double>& t) { xx[l] = t.xx, xy[l] = t.xy, yx[l] = t.yx, yy[l] = t.yy; }
	MCA_INLINE Tensor<v8> lanes(int g) const { return { load(xx + g), load(xy + g), load(yx + g), load(yy + g) }; }
	MCA_INLINE void       setLanes(int g, const Tensor<v8>& t) { store(xx + g, t.xx), store(xy + g, t.xy), store(yx + g, t.yx), store(yy + g, t.yy); }
};
template <int n> struct SymmetricLanes {
	alignas(64) double xx[n], xy[n], yy[n];
	MCA_INLINE Symmetric<double> at(int l) const { return { xx[l], xy[l], yy[l] }; }
	MCA_INLINE void              setLanes(int g, const Symmetric<v8>& t) { store(xx + g, t.xx), store(xy + g, t.xy), store(yy + g, t.yy); }
};

// Records of eight automata.
constexpr int   tensorSize = dim * dim;
MCA_INLINE void gather(const double* base, int stride, const int32_t* at, Vec<v8>& a) { gather2(base, stride, at, a[0], a[1]); }
MCA_INLINE void gather(const double* base, int stride, const int32_t* at, Tensor<v8>& t) { gather4(base, stride, at, t.xx, t.xy, t.yx, t.yy); }
MCA_INLINE void scatter(double* base, int stride, const Tensor<v8>& t) { scatter4(base, stride, t.xx, t.xy, t.yx, t.yy); }

// Cells of a regular grid.
/// number of a cell among `count` cells per direction
inline size_t cellNumber(Vec<int> cell, Vec<int> count) { return size_t(cell[1]) * count[0] + cell[0]; }
/// f(first, last) for each run of cells with consecutive numbers in the box from `low` to `high`
template <class F> MCA_INLINE void eachRun(Vec<int> low, Vec<int> high, F&& f)
{
	for (int y = low[1]; y <= high[1]; y++)
		if (f(Vec<int> { low[0], y }, Vec<int> { high[0], y })) return;
}
/// f(offset) for a cell and those around it
template <class F> MCA_INLINE void eachNeighbour(F&& f)
{
	for (int64_t x = -1; x <= 1; x++)
		for (int64_t y = -1; y <= 1; y++) f(Vec<int64_t> { x, y });
}
}
}
