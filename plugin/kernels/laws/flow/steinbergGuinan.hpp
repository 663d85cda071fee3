// SPDX-License-Identifier: GPL-2.0-or-later
// Flow stress of Steinberg, Cochran and Guinan (1980) without its pressure term. Formulation, equation (11d).
// In the original, yield stress and shear modulus grow with the pressure and fall with the temperature by the same factor G(P,T)/G0. The solvers keep G
// constant: the elastic energy and the time step stand on it. The factor's pressure part is left out with that of G; its thermal part stays, since it takes the
// strength away where plastic work heats.
#pragma once
#include "../law.hpp"

#define MCA_CONSTANTS_steinbergGuinan(C) \
	C(strainFactor, "-", 0, laws::notNegative, "beta of Steinberg-Guinan") \
	C(largestYieldStress, "Pa", std::numeric_limits<double>::infinity(), laws::aboveZero.with("infinite: no limit"), \
	  "limit of the hardening of Steinberg-Guinan at room temperature") \
	C(softeningPerKelvin, "1/K", 0, laws::notNegative, "share of the yield stress of Steinberg-Guinan that a kelvin takes away, -G'T/G0")
#define MCA_USES_steinbergGuinan(U) \
	U(yieldStress, laws::positive) \
	U(strainFactor, laws::notNegative) \
	U(hardeningExponent, laws::upToOne) \
	U(largestYieldStress, laws::aboveZero) \
	U(softeningPerKelvin, laws::notNegative) \
	U(meltTemperature, laws::aboveZero)

namespace mca::flow {

struct SteinbergGuinan : FlowLaw {
	static constexpr bool heats = true, isDear = true;

	template <class Y, class Need> static void check(const Y& y, Need&& need)
	{
		need(y.largestYieldStress >= y.yieldStress, "largestYieldStress [Pa]", y.largestYieldStress, "at least yieldStress");
	}

	template <class Y> static MCA_INLINE StaticYield staticYield(const Y& y, double eqps, double temperature)
	{
		const double base = fma(y.strainFactor, eqps, 1.), hard = y.yieldStress * fastPow(base, y.hardeningExponent);
		const double cool  = max(1. - y.softeningPerKelvin * max(temperature - y.referenceTemperature, 0.), 0.),
			     soft  = temperature < y.meltTemperature ? cool : 0.;
		const double slope = hard < y.largestYieldStress ? hard * y.hardeningExponent * y.strainFactor / base : 0.;
		return { min(hard, y.largestYieldStress) * soft, slope * soft };
	}
};
} // namespace mca::flow
