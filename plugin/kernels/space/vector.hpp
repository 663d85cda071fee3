// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors and tensors of space, for one automaton (T = double) or eight side by side (T = v8). The one place that knows their components; what is written out
// here stays in registers, whatever the compiler thinks of loops.
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
/// Columns: the tensor times the unit vectors.
template <class T> struct Tensor {
	Vec<T> column[dim];
};
template <class T> struct Symmetric {
	T xx, yy, zz, yz, zx, xy;
};

template <class T> MCA_INLINE Vec<T> operator-(Vec<T> a) { return { -a[0], -a[1], -a[2] }; }
template <class T> MCA_INLINE Vec<T> operator+(Vec<T> a, Vec<T> b) { return { a[0] + b[0], a[1] + b[1], a[2] + b[2] }; }
template <class T> MCA_INLINE Vec<T> operator-(Vec<T> a, Vec<T> b) { return { a[0] - b[0], a[1] - b[1], a[2] - b[2] }; }
template <class T> MCA_INLINE Vec<T>   operator*(Vec<T> a, T f) { return { a[0] * f, a[1] * f, a[2] * f }; }
template <class T> MCA_INLINE void     operator+=(Vec<T>& a, Vec<T> b) { a[0] += b[0], a[1] += b[1], a[2] += b[2]; }
template <class F, class T> MCA_INLINE Vec<T> fma(F f, Vec<T> a, Vec<T> b) { return { fma(f, a[0], b[0]), fma(f, a[1], b[1]), fma(f, a[2], b[2]) }; }
template <class T> MCA_INLINE T               dot(Vec<T> a, Vec<T> b) { return fma(a[0], b[0], fma(a[1], b[1], a[2] * b[2])); }
template <class T> MCA_INLINE Vec<T> cross(Vec<T> a, Vec<T> b)
{
	return { fma(a[1], b[2], -a[2] * b[1]), fma(a[2], b[0], -a[0] * b[2]), fma(a[0], b[1], -a[1] * b[0]) };
}
/// some vector of this length
template <class T> MCA_INLINE Vec<T> ofLength(T d) { return { d, T {}, T {} }; }
// every product rounded: the same bits on machines with and without fma
inline double      plainDot(Vec<double> a, Vec<double> b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double      plainSquare(Vec<double> a) { return plainDot(a, a); }
inline Vec<double> plainCross(Vec<double> a, Vec<double> b) { return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] }; }
/// sum of the magnitudes of the components
inline double        sumOfMagnitudes(Vec<double> a) { return std::fabs(a[0]) + std::fabs(a[1]) + std::fabs(a[2]); }
inline bool          isZero(Vec<double> a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }
inline Vec<bool>     everyWay() { return { true, true, true }; }
inline std::ostream& operator<<(std::ostream& s, Vec<double> a) { return s << "(" << a[0] << ", " << a[1] << ", " << a[2] << ")"; }

/// What turns: a spin, an angle, a torque.
template <class T> using Turn = Vec<T>;
constexpr int     turns = 3; ///< its components
inline Turn<bool> everyTurn() { return everyWay(); }

template <class T> MCA_INLINE Tensor<T> operator*(const Tensor<T>& a, T f) { return { a.column[0] * f, a.column[1] * f, a.column[2] * f }; }
template <class T> MCA_INLINE Tensor<T> operator+(const Tensor<T>& a, const Tensor<T>& b)
{
	return { a.column[0] + b.column[0], a.column[1] + b.column[1], a.column[2] + b.column[2] };
}
template <class T> MCA_INLINE T determinant(const Tensor<T>& A) { return dot(A.column[0], cross(A.column[1], A.column[2])); }
/// d(det A)/dA
template <class T> MCA_INLINE Tensor<T> cofactor(const Tensor<T>& A)
{
	return { cross(A.column[1], A.column[2]), cross(A.column[2], A.column[0]), cross(A.column[0], A.column[1]) };
}
template <class T> MCA_INLINE Symmetric<T> operator*(const Symmetric<T>& a, T f) { return { a.xx * f, a.yy * f, a.zz * f, a.yz * f, a.zx * f, a.xy * f }; }
template <class T> MCA_INLINE Symmetric<T> operator+(const Symmetric<T>& a, const Symmetric<T>& b)
{
	return { a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.yz + b.yz, a.zx + b.zx, a.xy + b.xy };
}
template <class T> MCA_INLINE Symmetric<T> operator-(const Symmetric<T>& a, const Symmetric<T>& b) 
{
	return { a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.yz - b.yz, a.zx - b.zx, a.xy - b.xy };
}
template <class T> MCA_INLINE void         operator+=(Symmetric<T>& a, const Symmetric<T>& b) { a = a + b; }
/// f times the unit tensor
template <class T> MCA_INLINE Symmetric<T> isotropic(T f) { return { f, f, f, T {}, T {}, T {} }; }
template <class T> MCA_INLINE T            trace(const Symmetric<T>& a) { return a.xx + a.yy + a.zz; }
template <class T> MCA_INLINE Symmetric<T> deviatorOf(const Symmetric<T>& a) { return a - isotropic(trace(a) * (1. / 3.)); }
template <class T> MCA_INLINE Vec<T>       times(const Symmetric<T>& a, Vec<T> v)
{
	return { fma(a.xx, v[0], fma(a.xy, v[1], a.zx * v[2])), fma(a.xy, v[0], fma(a.yy, v[1], a.yz * v[2])), fma(a.zx, v[0], fma(a.yz, v[1], a.zz * v[2])) };
}
template <class T> MCA_INLINE Vec<T> times(const Tensor<T>& a, Vec<T> v) { return fma(v[0], a.column[0], fma(v[1], a.column[1], a.column[2] * v[2])); }
template <class T> MCA_INLINE Symmetric<T> cofactor(const Symmetric<T>& a)
{
	return { fma(a.yy, a.zz, -a.yz * a.yz), fma(a.zz, a.xx, -a.zx * a.zx), fma(a.xx, a.yy, -a.xy * a.xy),
		 fma(a.xy, a.zx, -a.xx * a.yz), fma(a.xy, a.yz, -a.yy * a.zx), fma(a.yz, a.zx, -a.zz * a.xy) };
}
/// sum of the products of all nine components
template <class T> MCA_INLINE T dot(const Symmetric<T>& a, const Symmetric<T>& b)
{
	return fma(a.xx, b.xx, fma(a.yy, b.yy, a.zz * b.zz)) + 2. * fma(a.yz, b.yz, fma(a.zx, b.zx, a.xy * b.xy));
}
/// The symmetric part of a (x) b.
template <class T> MCA_INLINE Symmetric<T> symmetricDyad(Vec<T> a, Vec<T> b)
{
	return { a[0] * b[0], a[1] * b[1], a[2] * b[2],
		 0.5 * fma(a[1], b[2], a[2] * b[1]), 0.5 * fma(a[2], b[0], a[0] * b[2]), 0.5 * fma(a[0], b[1], a[1] * b[0]) };
}
/// a where the lane is on, else b.
MCA_INLINE Symmetric<v8> either(m8 on, const Symmetric<v8>& a, const Symmetric<v8>& b)
{
	return { on ? a.xx : b.xx, on ? a.yy : b.yy, on ? a.zz : b.zz, on ? a.yz : b.yz, on ? a.zx : b.zx, on ? a.xy : b.xy };
}

/// Vectors in memory: a plane of numbers per component.
template <class P> struct Planes {
	P*            plane[dim];
	MCA_INLINE P* operator[](int c) const { return plane[c]; }
	MCA_INLINE Vec<double> at(size_t i) const { return { plane[0][i], plane[1][i], plane[2][i] }; }
	MCA_INLINE void        set(size_t i, Vec<double> v) const { plane[0][i] = v[0], plane[1][i] = v[1], plane[2][i] = v[2]; }
};
template <class P> MCA_INLINE Vec<v8> load(const Planes<P>& p, size_t i) { return { load(p.plane[0] + i), load(p.plane[1] + i), load(p.plane[2] + i) }; }
MCA_INLINE void                       store(const Planes<double>& p, size_t i, Vec<v8> v)
{
	store(p.plane[0] + i, v[0]), store(p.plane[1] + i, v[1]), store(p.plane[2] + i, v[2]);
}

/// Symmetric tensors in memory: a plane of numbers per entry.
struct SymmetricPlanes {
	double* entry[6];
	MCA_INLINE Symmetric<double> at(size_t i) const { return { entry[0][i], entry[1][i], entry[2][i], entry[3][i], entry[4][i], entry[5][i] }; }
	MCA_INLINE void              set(size_t i, const Symmetric<double>& a) const
	{
		entry[0][i] = a.xx, entry[1][i] = a.yy, entry[2][i] = a.zz, entry[3][i] = a.yz, entry[4][i] = a.zx, entry[5][i] = a.xy;
	}
};
MCA_INLINE Symmetric<v8> load(const SymmetricPlanes& p, size_t i)
{
	return { load(p.entry[0] + i), load(p.entry[1] + i), load(p.entry[2] + i), load(p.entry[3] + i), load(p.entry[4] + i), load(p.entry[5] + i) };
}
MCA_INLINE void store(const SymmetricPlanes& p, size_t i, const Symmetric<v8>& a)
{
	store(p.entry[0] + i, a.xx), store(p.entry[1] + i, a.yy), store(p.entry[2] + i, a.zz), store(p.entry[3] + i, a.yz), store(p.entry[4] + i, a.zx),
		store(p.entry[5] + i, a.xy);
}

/// One automaton of eight.
MCA_INLINE Vec<double>    laneOf(const Vec<v8>& a, int l) { return { a[0][l], a[1][l], a[2][l] }; }
MCA_INLINE Tensor<double> laneOf(const Tensor<v8>& a, int l) { return { laneOf(a.column[0], l), laneOf(a.column[1], l), laneOf(a.column[2], l) }; }
MCA_INLINE void           setLane(Tensor<v8>& a, int l, const Tensor<double>& b)
{
	for (int c = 0; c < dim; c++)
		for (int q = 0; q < dim; q++) a.column[c][q][l] = b.column[c][q];
}

/// Tensors of n automata, a plane per entry.
template <int n> struct TensorLanes {
	alignas(64) double entry[dim * dim][n];
	MCA_INLINE Vec<double>    columnAt(int c, int l) const { return { entry[3 * c][l], entry[3 * c + 1][l], entry[3 * c + 2][l] }; }
	MCA_INLINE Tensor<double> at(int l) const { return { columnAt(0, l), columnAt(1, l), columnAt(2, l) }; }
	MCA_INLINE void           setColumn(int c, int l, Vec<double> v) { entry[3 * c][l] = v[0], entry[3 * c + 1][l] = v[1], entry[3 * c + 2][l] = v[2]; }
	MCA_INLINE void           set(int l, const Tensor<double>& t)
	{
		for (int c = 0; c < dim; c++) setColumn(c, l, t.column[c]);
	}
	MCA_INLINE Vec<v8>        lanesOf(int c, int g) const { return { load(entry[3 * c] + g), load(entry[3 * c + 1] + g), load(entry[3 * c + 2] + g) }; }
	MCA_INLINE Tensor<v8> lanes(int g) const { return { lanesOf(0, g), lanesOf(1, g), lanesOf(2, g) }; }
	MCA_INLINE void       setLanes(int g, const Tensor<v8>& t)
	{
		for (int c = 0; c < dim; c++)
			for (int q = 0; q < dim; q++) store(entry[3 * c + q] + g, t.column[c][q]);
	}
};
template <int n> struct SymmetricLanes {
	alignas(64) double xx[n], yy[n], zz[n], yz[n], zx[n], xy[n];
	MCA_INLINE Symmetric<double> at(int l) const { return { xx[l], yy[l], zz[l], yz[l], zx[l], xy[l] }; }
	MCA_INLINE void              set(int l, const Symmetric<double>& t)
	{
		xx[l] = t.xx, yy[l] = t.yy, zz[l] = t.zz, yz[l] = t.yz, zx[l] = t.zx, xy[l] = t.xy;
	}
	MCA_INLINE Symmetric<v8>     lanes(int g) const { return { load(xx + g), load(yy + g), load(zz + g), load(yz + g), load(zx + g), load(xy + g) }; }
	MCA_INLINE void              setLanes(int g, const Symmetric<v8>& t)
	{
		store(xx + g, t.xx), store(yy + g, t.yy), store(zz + g, t.zz), store(yz + g, t.yz), store(zx + g, t.zx), store(xy + g, t.xy);
	}
};

MCA_INLINE Symmetric<double> laneOf(const Symmetric<v8>& a, int l) { return { a.xx[l], a.yy[l], a.zz[l], a.yz[l], a.zx[l], a.xy[l] }; }
MCA_INLINE void              setLane(Symmetric<v8>& a, int l, const Symmetric<double>& b)
{
	a.xx[l] = b.xx, a.yy[l] = b.yy, a.zz[l] = b.zz, a.yz[l] = b.yz, a.zx[l] = b.zx, a.xy[l] = b.xy;
}

// Records of eight automata, read and written by four numbers at once: those of tensors have twelve, the last three unused.
constexpr int   tensorSize = 12;
MCA_INLINE void gather(const double* base, int stride, const int32_t* at, Vec<v8>& a)
{
	v8 unused;
	gather4(base, stride, at, a[0], a[1], a[2], unused);
}
/// Records of a tensor and two numbers.
MCA_INLINE void gather(const double* base, int stride, const int32_t* at, Tensor<v8>& t, v8& a, v8& b)
{
	Vec<v8>* c = t.column;
	v8       unused;
	gather4(base, stride, at, c[0][0], c[0][1], c[0][2], c[1][0]), gather4(base + 4, stride, at, c[1][1], c[1][2], c[2][0], c[2][1]);
	gather4(base + 8, stride, at, c[2][2], a, b, unused);
}
MCA_INLINE void scatter(double* base, int stride, const Tensor<v8>& t, v8 a, v8 b)
{
	const Vec<v8>* c = t.column;
	scatter4(base, stride, c[0][0], c[0][1], c[0][2], c[1][0]), scatter4(base + 4, stride, c[1][1], c[1][2], c[2][0], c[2][1]);
	scatter4(base + 8, stride, c[2][2], a, b, v8 {});
}
MCA_INLINE void scatter(double* base, int stride, const Tensor<v8>& t) { scatter(base, stride, t, v8 {}, v8 {}); }
/// Records of a tensor and a symmetric tensor; the tenth number is unused.
MCA_INLINE void gather(const double* base, int stride, const int32_t* at, Tensor<v8>& t, Symmetric<v8>& s)
{
	Vec<v8>* c = t.column;
	v8       a;
	gather4(base, stride, at, c[0][0], c[0][1], c[0][2], c[1][0]), gather4(base + 4, stride, at, c[1][1], c[1][2], c[2][0], c[2][1]);
	gather4(base + 8, stride, at, c[2][2], a, s.xx, s.yy), gather4(base + 12, stride, at, s.zz, s.yz, s.zx, s.xy);
}
MCA_INLINE void scatter(double* base, int stride, const Tensor<v8>& t, const Symmetric<v8>& s)
{
	const Vec<v8>* c = t.column;
	scatter4(base, stride, c[0][0], c[0][1], c[0][2], c[1][0]), scatter4(base + 4, stride, c[1][1], c[1][2], c[2][0], c[2][1]);
	scatter4(base + 8, stride, c[2][2], v8 {}, s.xx, s.yy), scatter4(base + 12, stride, s.zz, s.yz, s.zx, s.xy);
}

// Cells of a regular grid.
/// number of a cell among `count` cells per direction
inline size_t cellNumber(Vec<int> cell, Vec<int> count) { return (size_t(cell[2]) * count[1] + cell[1]) * count[0] + cell[0]; }
/// f(first, last) for each run of cells with consecutive numbers in the box from `low` to `high`
template <class F> MCA_INLINE void eachRun(Vec<int> low, Vec<int> high, F&& f)
{
	for (int z = low[2]; z <= high[2]; z++)
		for (int y = low[1]; y <= high[1]; y++)
			if (f(Vec<int> { low[0], y, z }, Vec<int> { high[0], y, z })) return;
}
/// f(offset) for a cell and those around it
template <class F> MCA_INLINE void eachNeighbour(F&& f)
{
	for (int64_t x = -1; x <= 1; x++)
		for (int64_t y = -1; y <= 1; y++)
			for (int64_t z = -1; z <= 1; z++) f(Vec<int64_t> { x, y, z });
}
}
}
