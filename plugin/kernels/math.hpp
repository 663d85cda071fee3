// SPDX-License-Identifier: GPL-2.0-or-later
// Elementary functions that the compiler can vectorise. The C library's log, exp and pow are calls: in a loop over automata
// or cells they cost more than all the rest of the update. These are straight-line code, accurate to about 2e-16 relative (log, exp)
// and give the same bits on every machine level that has the same contraction (the library is built with -ffp-contract=off).
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>

/// Into the loops that must vectorise, whatever the compiler's own estimate of their size.
#define MCA_INLINE inline __attribute__((always_inline))

namespace mca {

/// a*b+c, one rounding where the processor has it, two roundings elsewhere; never a call into the C library.
inline double fma(double a, double b, double c)
{
#ifdef __FMA__
	return __builtin_fma(a, b, c);
#else
	return a * b + c;
#endif
}

inline double  root(double a) { return std::sqrt(a); }
inline double  max(double a, double b) { return a > b ? a : b; }
inline double  min(double a, double b) { return a < b ? a : b; }
inline double  sqr(double a) { return a * a; }
inline int64_t bitsOf(double a)
{
	int64_t i;
	std::memcpy(&i, &a, sizeof i);
	return i;
}
inline double fromBits(int64_t i)
{
	double a;
	std::memcpy(&a, &i, sizeof a);
	return a;
}

/// Natural logarithm of a positive normal number [-]. x = 2^k m with m in [sqrt(1/2), sqrt(2)); ln m = 2 atanh((m-1)/(m+1)) as a series.
MCA_INLINE double fastLog(double x)
{
	const uint64_t bits = uint64_t(bitsOf(x));
	// adding the distance from sqrt(1/2) to 1 moves the exponent at the right mantissa, without a branch
	const uint64_t biased = (bits + (0x3ff0000000000000ULL - 0x3fe6a09e667f3bcdULL)) >> 52;
	const double   m      = fromBits(int64_t(bits - ((biased - 1023) << 52)));
	// integer to double through the bits of 2^52 + biased: AVX2 has no conversion from 64-bit integers
	const double k = fromBits(int64_t(biased | 0x4330000000000000ULL)) - (4503599627370496. + 1023.);
	const double  t = (m - 1.) / (m + 1.), z = t * t;
	// pairs of pairs: hardly more operations than one behind the other, a third of the time to wait for them
	const double z2 = z * z, z4 = z2 * z2;
	const double low  = fma(fma(1. / 9., z, 1. / 7.), z2, fma(1. / 5., z, 1. / 3.));
	const double high = fma(fma(1. / 17., z, 1. / 15.), z2, fma(1. / 13., z, 1. / 11.));
	const double p    = fma(fma(fma(1. / 21., z, 1. / 19.), z4, high), z4, low);
	const double lnM = fma(2. * t * z, p, 2. * t);
	return fma(k, 1.90821492927058770002e-10, lnM) + k * 6.93147180369123816490e-01; // ln 2 in two parts
}

/// exp(x) [-] for x in [-700, 700] (outside: clamped to that range).
MCA_INLINE double fastExp(double x)
{
	x              = min(max(x, -700.), 700.);
	const double s = 6755399441055744.; // 1.5 * 2^52: adding and taking away rounds to the nearest integer
	const double y = fma(x, 1.4426950408889634, s);
	const double k = y - s;
	const double r = fma(k, -1.90821492927058770002e-10, fma(k, -6.93147180369123816490e-01, x));
	const double r2 = r * r, r4 = r2 * r2;
	const double a  = fma(fma(1. / 24., r, 1. / 6.), r2, fma(0.5, r, 1.));
	const double b  = fma(fma(1. / 40320., r, 1. / 5040.), r2, fma(1. / 720., r, 1. / 120.));
	const double c  = fma(fma(1. / 479001600., r, 1. / 39916800.), r2, fma(1. / 3628800., r, 1. / 362880.));
	const double p  = fma(fma(fma(1. / 6227020800., r4, c), r4 * r4, fma(b, r4, a)), r, 1.);
	// the integer sits in the low bits of y: shift it into the exponent
	return fromBits(int64_t(uint64_t(bitsOf(p)) + (uint64_t(bitsOf(y)) << 52)));
}

/// The same two in single precision, to 1e-6 and 1e-4: for starts of iterations. x: positive and normal; in [-80, 0], below it that of -80.
MCA_INLINE float roughLog(float x)
{
	uint32_t bits;
	std::memcpy(&bits, &x, sizeof bits);
	const int32_t k = int32_t(bits - 0x3f3504f3U) >> 23; // from sqrt(1/2)
	bits -= uint32_t(k) << 23;
	float m;
	std::memcpy(&m, &bits, sizeof m);
	const float t = (m - 1.f) / (m + 1.f), z = t * t;
	return float(k) * 0.69314718f + t * ((0.4f * z + 0.66666667f) * z + 2.f);
}
MCA_INLINE float roughExp(float x)
{
	x             = x > -80.f ? x : -80.f;
	const float y = x * 1.44269504f + 12582912.f, r = x - (y - 12582912.f) * 0.69314718f; // 1.5 * 2^23
	const float p = (((1.f / 120.f * r + 1.f / 24.f) * r + 1.f / 6.f) * r + 0.5f) * r * r + (1.f + r);
	uint32_t    a, k;
	std::memcpy(&a, &p, sizeof a), std::memcpy(&k, &y, sizeof k);
	a += k << 23;
	float e;
	std::memcpy(&e, &a, sizeof e);
	return e;
}

/// x^e for x >= 0; 0^e = 0 for e > 0. Relative error about |e ln x| 2e-16.
MCA_INLINE double fastPow(double x, double e)
{
	const double power = fastExp(e * fastLog(max(x, 1e-300)));
	return x > 1e-300 ? power : 0.;
}

/// Text as a number (FNV-1a); start: that of the text before it.
constexpr uint64_t nameHash(const char* text, uint64_t start = 1469598103934665603ULL)
{
	for (; *text; text++)
		start = (start ^ uint8_t(*text)) * 1099511628211ULL;
	return start;
}
}
