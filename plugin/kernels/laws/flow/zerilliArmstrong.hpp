// SPDX-License-Identifier: GPL-2.0-or-later
// Flow stress of Zerilli and Armstrong (1987), of body-centred (C2 = 0) and face-centred (C1 = C5 = 0) metals in one. Formulation, equation (11c).
// Strain rates below the reference rate count as that: thermally activated flow has no lower bound, and its constants hold from there on.
#pragma once
#include "../law.hpp"

#define MCA_CONSTANTS_zerilliArmstrong(C) \
	C(thermalStress, "Pa", 0, laws::notNegative, "C1 of Zerilli-Armstrong, the stress that temperature and rate change whatever the strain (bcc)") \
	C(thermalHardening, "Pa", 0, laws::notNegative, "C2 of Zerilli-Armstrong, factor of the root of the plastic strain (fcc)") \
	C(thermalDecay, "1/K", 0, laws::notNegative, "C3 of Zerilli-Armstrong") \
	C(rateDecay, "1/K", 0, laws::notNegative, "C4 of Zerilli-Armstrong")
#define MCA_USES_zerilliArmstrong(U) \
	U(yieldStress, laws::notNegative) \
	U(hardeningModulus, laws::notNegative) \
	U(hardeningExponent, laws::upToOne) \
	U(referenceRate, laws::positive) \
	U(thermalStress, laws::notNegative) \
	U(thermalHardening, laws::notNegative) \
	U(thermalDecay, laws::notNegative) \
	U(rateDecay, laws::notNegative)

namespace mca::flow {

struct ZerilliArmstrong : FlowLaw {
	static constexpr bool heats = true, isDear = true, dependsOnRate = true;

	/// The part that temperature and rate change, at the reference rate [Pa], and its slope.
	template <class Y> static MCA_INLINE StaticYield thermalPart(const Y& y, double eqps, double temperature)
	{
		const double ep = max(eqps, 1e-4), near = min(eqps * 1e4, 1.),
			     soft  = fastExp(-y.thermalDecay * temperature); // a straight line below 1e-4, as powerHardening
		const double grown = y.thermalHardening * std::sqrt(ep);
		return { fma(grown, near, y.thermalStress) * soft, (near < 1. ? 1. : 0.5) * grown / ep * soft };
	}

	/// At the reference rate.
	template <class Y> static MCA_INLINE StaticYield staticYield(const Y& y, double eqps, double temperature)
	{
		const PowerHardening h = powerHardening(y.hardeningModulus, y.hardeningExponent, eqps);
		const StaticYield    t = thermalPart(y, eqps, temperature);
		return { fma(h.power, h.near, y.yieldStress) + t.stress, h.slope + t.slope };
	}

	template <class Y> static double flowStress(const Y& y, double eqps, double rate, double temperature)
	{
		const double grows = std::exp(y.rateDecay * temperature * std::log(max(rate / y.referenceRate, 1.)));
		return staticYield(y, eqps, temperature).stress + thermalPart(y, eqps, temperature).stress * (grows - 1.);
	}

	/// trial - 3G d = Y(eps_p + d, d/dt) by Newton steps in x = ln(d/(dt rate0)): the gap is concave in x, so from a start that is too large they come down
	/// to the root without passing it. The start is the smaller of the answers without rate and with the rate alone. Five leave a residual below 1e-6 Y.
	template <class Y>
	static MCA_INLINE double increment(const Y& y, const StaticYield& s, double trial, double threeG, double dt, double eqps, double temperature)
	{
		const double d0 = dt * y.referenceRate, k = threeG + s.slope, over = max(trial - s.stress, 0.), slow = over / k;
		const double hot = max(thermalPart(y, eqps, temperature).stress, 1e-12 * s.stress), power = max(y.rateDecay * temperature, 1e-12);
		double       x = min(fastLog(max(slow, 1e-300)) - fastLog(d0), fastLog(1. + over / hot) / power);
		for (int it = 0; it < 5; it++) {
			const double z = max(x, 0.), flow = k * d0 * fastExp(z), grown = hot * fastExp(power * z);
			x = z + (over - flow - (grown - hot)) / (flow + power * grown);
		}
		return x > 0. ? d0 * fastExp(x) : slow; // slower than the reference rate
	}
};
} // namespace mca::flow
