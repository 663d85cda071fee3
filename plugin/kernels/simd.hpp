// SPDX-License-Identifier: GPL-2.0-or-later
// Eight automata side by side. Neighbours are read as records of four numbers and transposed in registers: three times faster than one
// gather instruction per number on the machines measured. Plain GNU vector types, so every instruction level compiles the same source.
#pragma once
#include "math.hpp"
#include <immintrin.h>

// everything below is inlined: how a wide vector would be passed to a function on a narrow machine does not matter
#pragma GCC diagnostic ignored "-Wpsabi"

namespace mca {

typedef double  v2 __attribute__((vector_size(16)));
typedef double  v4 __attribute__((vector_size(32)));
typedef double  v8 __attribute__((vector_size(64)));
typedef int64_t m8 __attribute__((vector_size(64)));
constexpr int   lanes = 8;

MCA_INLINE v8 splat(double a) { return v8 { a, a, a, a, a, a, a, a }; }
MCA_INLINE v8 load(const double* p)
{
	v8 r;
	std::memcpy(&r, p, sizeof r);
	return r;
}
MCA_INLINE void store(double* p, v8 a) { std::memcpy(p, &a, sizeof a); }
MCA_INLINE m8   widen(const int32_t* p) { return m8 { p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7] }; }
MCA_INLINE m8   widen(const int64_t* p)
{
	m8 r;
	std::memcpy(&r, p, sizeof r);
	return r;
}
MCA_INLINE v8   max(v8 a, v8 b) { return a > b ? a : b; }
MCA_INLINE v8   min(v8 a, v8 b) { return a < b ? a : b; }
MCA_INLINE v8   min(v8 a, double b) { return min(a, splat(b)); }

#ifdef __AVX512F__
MCA_INLINE v8 fma(v8 a, v8 b, v8 c) { return v8(_mm512_fmadd_pd(__m512d(a), __m512d(b), __m512d(c))); }
MCA_INLINE v8 root(v8 a) { return v8(_mm512_maskz_sqrt_pd(0xff, __m512d(a))); }
#else
// narrower machines: the same in halves or quarters
#ifdef __FMA__
typedef v4 part;
MCA_INLINE part fmaPart(part a, part b, part c) { return part(_mm256_fmadd_pd(__m256d(a), __m256d(b), __m256d(c))); }
MCA_INLINE part rootPart(part a) { return part(_mm256_sqrt_pd(__m256d(a))); }
#else
typedef v2 part;
MCA_INLINE part fmaPart(part a, part b, part c) { return a * b + c; }
MCA_INLINE part rootPart(part a) { return part(_mm_sqrt_pd(__m128d(a))); }
#endif
MCA_INLINE v8 fma(v8 a, v8 b, v8 c)
{
	part A[sizeof(v8) / sizeof(part)], B[sizeof(v8) / sizeof(part)], C[sizeof(v8) / sizeof(part)];
	std::memcpy(A, &a, sizeof a), std::memcpy(B, &b, sizeof b), std::memcpy(C, &c, sizeof c);
	for (size_t i = 0; i < sizeof(v8) / sizeof(part); i++)
		A[i] = fmaPart(A[i], B[i], C[i]);
	std::memcpy(&a, A, sizeof a);
	return a;
}
MCA_INLINE v8 root(v8 a)
{
	part A[sizeof(v8) / sizeof(part)];
	std::memcpy(A, &a, sizeof a);
	for (size_t i = 0; i < sizeof(v8) / sizeof(part); i++)
		A[i] = rootPart(A[i]);
	std::memcpy(&a, A, sizeof a);
	return a;
}
#endif
/// Fields 0-3 of the records of eight automata; a record has `stride` numbers.
MCA_INLINE void gather4(const double* base, int stride, const int32_t* at, v8& a, v8& b, v8& c, v8& d)
{
	v4 r[lanes];
	for (int i = 0; i < lanes; i++)
		std::memcpy(&r[i], base + size_t(at[i]) * stride, sizeof(v4));
	auto     pair = [&](int lo, int hi) { return __builtin_shufflevector(r[lo], r[hi], 0, 1, 2, 3, 4, 5, 6, 7); };
	const v8 r04 = pair(0, 4), r15 = pair(1, 5), r26 = pair(2, 6), r37 = pair(3, 7);
	const v8 ac01 = __builtin_shufflevector(r04, r15, 0, 8, 2, 10, 4, 12, 6, 14), bd01 = __builtin_shufflevector(r04, r15, 1, 9, 3, 11, 5, 13, 7, 15);
	const v8 ac23 = __builtin_shufflevector(r26, r37, 0, 8, 2, 10, 4, 12, 6, 14), bd23 = __builtin_shufflevector(r26, r37, 1, 9, 3, 11, 5, 13, 7, 15);
	a = __builtin_shufflevector(ac01, ac23, 0, 1, 8, 9, 4, 5, 12, 13), c = __builtin_shufflevector(ac01, ac23, 2, 3, 10, 11, 6, 7, 14, 15);
	b = __builtin_shufflevector(bd01, bd23, 0, 1, 8, 9, 4, 5, 12, 13), d = __builtin_shufflevector(bd01, bd23, 2, 3, 10, 11, 6, 7, 14, 15);
}
/// The other way: fields 0-3 of eight records in a row.
MCA_INLINE void scatter4(double* base, int stride, v8 a, v8 b, v8 c, v8 d)
{
	const v8 ab = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14),
		 cd = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14); // a0 b0 a2 b2 | a4 b4 a6 b6
	const v8 AB = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15), CD = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15); // the odd ones
	const v8 r02 = __builtin_shufflevector(ab, cd, 0, 1, 8, 9, 2, 3, 10, 11), r46 = __builtin_shufflevector(ab, cd, 4, 5, 12, 13, 6, 7, 14, 15);
	const v8 r13 = __builtin_shufflevector(AB, CD, 0, 1, 8, 9, 2, 3, 10, 11), r57 = __builtin_shufflevector(AB, CD, 4, 5, 12, 13, 6, 7, 14, 15);
	auto     put = [&](v8 two, int lo, int hi) {
                std::memcpy(base + lo * stride, &two, sizeof(v4));
                std::memcpy(base + hi * stride, reinterpret_cast<const char*>(&two) + sizeof(v4), sizeof(v4));
	};
	put(r02, 0, 2), put(r13, 1, 3), put(r46, 4, 6), put(r57, 5, 7);
}
/// Fields 0-1.
MCA_INLINE void gather2(const double* base, int stride, const int32_t* at, v8& a, v8& b)
{
	v2 r[lanes];
	for (int i = 0; i < lanes; i++)
		std::memcpy(&r[i], base + size_t(at[i]) * stride, sizeof(v2));
	auto     four = [&](int i, int j) { return __builtin_shufflevector(r[i], r[j], 0, 1, 2, 3); };
	const v4 e0 = four(0, 2), e1 = four(4, 6), o0 = four(1, 3), o1 = four(5, 7);
	const v8 even = __builtin_shufflevector(e0, e1, 0, 1, 2, 3, 4, 5, 6, 7), odd = __builtin_shufflevector(o0, o1, 0, 1, 2, 3, 4, 5, 6, 7);
	a = __builtin_shufflevector(even, odd, 0, 8, 2, 10, 4, 12, 6, 14), b = __builtin_shufflevector(even, odd, 1, 9, 3, 11, 5, 13, 7, 15);
}
MCA_INLINE v8 fma(double a, v8 b, v8 c) { return fma(splat(a), b, c); }
MCA_INLINE v8 fma(v8 a, v8 b, double c) { return fma(a, b, splat(c)); }
MCA_INLINE v8 fma(double a, v8 b, double c) { return fma(splat(a), b, splat(c)); }
}
