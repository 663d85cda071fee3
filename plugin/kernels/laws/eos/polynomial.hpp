// SPDX-License-Identifier: GPL-2.0-or-later
// Polynomial: P = K mu + A2 mu^2 + A3 mu^3 + (B0 + B1 mu) E with the compression mu = 1/J - 1 and the internal energy E per rest volume; in tension P = -K eps
// + B0 E. Formulation, equations (4c), (4d).
#pragma once
#include "../law.hpp"

#define MCA_CONSTANTS_polynomial(C) \
	C(quadraticModulus, "Pa", 0, laws::finite, "A2 of the polynomial equation of state; its A1 is the bulk modulus") \
	C(cubicModulus, "Pa", 0, laws::finite, "A3 of the polynomial equation of state") \
	C(gruneisenSlope, "-", 0, laws::notNegative, "B1 of the polynomial equation of state; its B0 is gruneisen")
#define MCA_USES_polynomial(U) \
	U(quadraticModulus, laws::finite) \
	U(cubicModulus, laws::finite) \
	U(gruneisen, laws::notNegative) \
	U(gruneisenSlope, laws::notNegative)

namespace mca::eos {

struct Polynomial : EosLaw {
	static constexpr bool heats = true;

	template <class E, class Need> static void check(const E& e, Need&& need)
	{
		const auto   slope = [&](double mu) { return e.bulkModulus() + (2. * e.quadraticModulus + 3. * e.cubicModulus * mu) * mu; };
		const double turn  = e.cubicModulus != 0 ? min(max(-e.quadraticModulus / (3. * e.cubicModulus), 0.), 1.) : 0.;
		need(slope(1.) > 0 && slope(turn) > 0, "quadraticModulus [Pa]", e.quadraticModulus,
		     "such that, with cubicModulus, the pressure grows up to twice the density");
	}

	/// twice the rest density
	template <class E> static MCA_INLINE double clampStrain(const E&) { return -0.5; }

	/// (4c) without energy. Beyond the clamp: straight on with the slope there.
	template <class E> static MCA_INLINE double pressure(const E& e, double eps)
	{
		const double x = min(max(eps, clampStrain(e)), 0.), mu = 1. / (1. + x) - 1.;
		const double p = fma(fma(e.cubicModulus, mu, e.quadraticModulus), mu, e.bulkModulus()) * mu;
		return p - (eps - x) * (eps < 0. ? slope(e, mu) : e.bulkModulus());
	}

	/// (4d): slope of the Hugoniot P = A/(1 - B eta/2), E = P eta/2, eta = -eps: stiffer than any state a shock leads to.
	template <class E> static MCA_INLINE double tangent(const E& e, double eps)
	{
		const double x = min(max(eps, clampStrain(e)), 0.), mu = 1. / (1. + x) - 1., B = fma(e.gruneisenSlope, mu, e.gruneisen);
		const double perD = 1. / max(1. + 0.5 * B * x, e.clampAt), P = pressure(e, x) * perD;
		return (slope(e, mu) + 0.5 * P * (B - e.gruneisenSlope * sqr(1. + mu) * x)) * perD;
	}

	/// Eight points of Gauss and Legendre over the compression, good to 1e-12.
	template <class E> static double storedEnergy(const E& e, double eps)
	{
		if (eps >= 0) return 0.5 * e.bulkModulus() * eps * eps;
		const double at[4]     = { 0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363 };
		const double weight[4] = { 0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763 };
		const double x = max(eps, clampStrain(e)), d = x - eps;
		double       w = 0;
		for (int k = 0; k < 4; k++) w += weight[k] * (pressure(e, 0.5 * x * (1. - at[k])) + pressure(e, 0.5 * x * (1. + at[k])));
		return -0.5 * x * w + d * (pressure(e, x) + 0.5 * slope(e, 1. / (1. + x) - 1.) * d);
	}

	template <class E> static MCA_INLINE Thermal thermal(const E& e, double eps, double /* energy */)
	{
		const double x = min(max(eps, clampStrain(e)), 0.);
		return { pressure(e, eps), fma(e.gruneisenSlope, 1. / (1. + x) - 1., e.gruneisen) };
	}

private:
	/// -dP/deps without energy [Pa]
	template <class E> static MCA_INLINE double slope(const E& e, double mu)
	{
		return fma(fma(3. * e.cubicModulus, mu, 2. * e.quadraticModulus), mu, e.bulkModulus()) * sqr(1. + mu);
	}
};
} // namespace mca::eos
