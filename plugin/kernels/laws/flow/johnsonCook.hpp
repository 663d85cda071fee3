// SPDX-License-Identifier: GPL-2.0-or-later
// Flow stress of Johnson and Cook (1983). Formulation, equation (11a).
#pragma once
#include "../law.hpp"

#define MCA_CONSTANTS_johnsonCook(C) \
	C(hardeningExponent, "-", 1, laws::notNegative, "n of Johnson-Cook") \
	C(rateCoefficient, "-", 0, laws::notNegative, "C of Johnson-Cook") \
	C(referenceRate, "1/s", 1, laws::positive, "strain rate at which the static curve holds, for laws that depend on the rate") \
	C(thermalSoftening, "-", 1, laws::notNegative, "m of Johnson-Cook") \
	C(meltTemperature, "K", std::numeric_limits<double>::infinity(), laws::aboveZero.with("infinite: never"), "melting temperature")
#define MCA_USES_johnsonCook(U) \
	U(yieldStress, laws::notNegative) \
	U(hardeningModulus, laws::notNegative) \
	U(hardeningExponent, laws::upToOne) \
	U(rateCoefficient, laws::belowOne) \
	U(referenceRate, laws::positive) \
	U(thermalSoftening, laws::positive) \
	U(meltTemperature, laws::aboveZero)

namespace mca::flow {

struct JohnsonCook : FlowLaw {
	static constexpr bool heats = true, isDear = true, dependsOnRate = true;

	template <class Y, class Need> static void check(const Y& y, Need&& need)
	{
		need(y.meltTemperature > y.referenceTemperature, "meltTemperature [K]", y.meltTemperature, "above referenceTemperature");
	}

	/// Without the rate factor.
	template <class Y> static MCA_INLINE StaticYield staticYield(const Y& y, double eqps, double temperature)
	{
		const double hom  = min(max((temperature - y.referenceTemperature) / (y.meltTemperature - y.referenceTemperature), 0.), 1.);
		const double soft = 1. - fastPow(hom, y.thermalSoftening);
		const PowerHardening h = powerHardening(y.hardeningModulus, y.hardeningExponent, eqps);
		return { fma(h.power, h.near, y.yieldStress) * soft, h.slope * soft };
	}

	/// The whole of it [Pa]; rate [1/s].
	template <class Y> static double flowStress(const Y& y, double eqps, double rate, double temperature)
	{
		return staticYield(y, eqps, temperature).stress * (1. + y.rateCoefficient * std::log(max(rate / y.referenceRate, 1.)));
	}

	/// Plastic strain d of the step above the static yield stress s: trial - 3G d = Y(eps_p + d, d/dt) by two Newton steps from a close start; the residual
	/// is below 1e-6 Y.
	template <class Y> static MCA_INLINE double increment(const Y& y, const StaticYield& s, double trial, double threeG, double dt, double, double)
	{
		const double perRate = 1. / (dt * y.referenceRate), C = y.rateCoefficient;
		// Start: rate term and elastic unloading alone, 3G d + Y C ln(d/(dt rate0)) = trial - Y, is w + ln w = l with w = 3G d/(Y C): Lambert's W of
		// exp l, here within 1 % (Winitzki 2003). From the rate-free answer Newton's steps would leave the range where l is small: low rates, short
		// steps.
		const double k = threeG + s.slope, YC = max(C * s.stress, 1e-12 * threeG);
		const double l = fastLog(k / (YC * perRate)) + max(trial - s.stress, 0.) / YC;
		const double q = l > 30. ? l : fastLog(1. + fastExp(min(l, 30.)));
		double       d = q * (1. - fastLog(1. + q) / (2. + q)) * YC / k;
		for (int it = 0; it < 2; it++) {
			const double r     = d * perRate;
			const double f     = 1. + C * fastLog(max(r, 1.));
			const double df    = r > 1. ? C / max(d, 1e-300) : 0.;
			const double Ys    = fma(s.slope, d, s.stress);
			const double resid = trial - threeG * d - Ys * f;
			d                  = max(d + resid / (threeG + s.slope * f + Ys * df), 0.);
		}
		return d;
	}
};
}
