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

	/// Plastic strain d of the step above the static yield stress s: trial - 3G d = Y(eps_p + d, d/dt) by a step of Newton's and one of Halley's
	/// from a close start; the residual is below 1e-10 Y for C = 0.014, 1e-7 Y for 0.06, 2e-4 Y for 0.3. In single precision where a later step
	/// makes good what it leaves: divisions are most of the cost.
	template <class Y> static MCA_INLINE double increment(const Y& y, const StaticYield& s, double trial, double threeG, double dt, double, double)
	{
		const double C = y.rateCoefficient, least = dt * y.referenceRate, perLeast = 1. / least; // slower than the reference rate: static
		// Start: rate term and elastic unloading alone, 3G d + Y C ln(d/(dt rate0)) = trial - Y, is w + ln w = l with w = 3G d/(Y C): Lambert's W of
		// exp l, here within 1 % (Winitzki 2003), with ln(1 + exp l) by a Pade approximant. From the rate-free answer Newton's steps would leave the
		// range where l is small: low rates, short steps.
		const double k = threeG + s.slope, YC = max(C * s.stress, 1e-12 * threeG), share = YC / k, over = max(trial - s.stress, 0.);
		const float  l = float(over / YC) - roughLog(float(min(max(share * perLeast, 1e-30), 1e30))), z = roughExp(l > 0.f ? -l : l);
		const float  q = (l > 0.f ? l : 0.f) + z * (3.f * z + 6.f) / (z * (z + 6.f) + 6.f);
		double       d = max(share * double(q * (1.f - roughLog(1.f + q) / (2.f + q))), least);
		const auto   residual = [&](double f, double Ys) { return trial - threeG * d - Ys * f; };
		const auto   down     = [&](double f, double Ys) { return fma(fma(s.slope, f, threeG), d, Ys * C); }; // minus d times the slope of the residual
		{
			const double f = 1. + C * double(roughLog(float(d * perLeast))), Ys = fma(s.slope, d, s.stress);
			d = max(d + residual(f, Ys) * d / down(f, Ys), least);
		}
		const double f = 1. + C * fastLog(d * perLeast), Ys = fma(s.slope, d, s.stress), r = residual(f, Ys), g = down(f, Ys);
		d += 2. * r * g * d / (2. * g * g - r * C * fma(-2. * s.slope, d, Ys));
		return over > k * least ? max(d, least) : over / k;
	}
};
}
