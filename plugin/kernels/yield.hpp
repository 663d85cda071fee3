// SPDX-License-Identifier: GPL-2.0-or-later
// Yield stress and radial return. Formulation, equations (10)-(11). The laws are in laws/flow. Shared by automata and grid.
// The kind is a template parameter: a material that does not yield, harden or heat pays nothing for it.
#pragma once
#include "laws/list.hpp"

namespace mca {

struct Return {
	double scale;  ///< M: the trial deviator is multiplied by it [-]
	double dEqps;  ///< increment of the equivalent plastic strain [-]
};

/// Static yield stress [Pa] and its slope dY/d eps_p [Pa] at fixed temperature.
template <YieldKind kind> MCA_INLINE StaticYield staticYield(const Yield& y, double eqps, double temperature)
{
	return LawOf<kind>::staticYield(y, eqps, temperature);
}

/// Yield stress [Pa] at plastic strain [-], strain rate [1/s] and temperature [K].
inline double flowStress(const Yield& y, double eqps, double rate, double temperature)
{
	return dispatch(y.kind, [&](auto k) {
		using Law = LawOf<k.value>;
		if constexpr (Law::dependsOnRate) return Law::flowStress(y, eqps, rate, temperature);
		else return Law::staticYield(y, eqps, temperature).stress;
	});
}

/// Radial return (11): sigmaTrial = trial equivalent stress [Pa], s: static yield stress at eqps and temperature, threeG = 3 G [Pa], dt [s].
/// The static curve is a straight line over one step. Below the static yield stress the answer is { 1, 0 } exactly, so a caller may leave it out there.
/// Straight-line code: loops over automata or cells vectorise.
template <YieldKind kind>
MCA_INLINE Return radialReturn(const Yield& y, const StaticYield& s, double sigmaTrial, double eqps, double temperature, double threeG, double dt)
{
	using Law = LawOf<kind>;
	if constexpr (!Law::yields) return { 1., 0. };
	else {
		double d = max(sigmaTrial - s.stress, 0.) / (threeG + s.slope);
		if constexpr (Law::dependsOnRate) {
			d = Law::increment(y, s, sigmaTrial, threeG, dt, eqps, temperature);
			d = sigmaTrial > s.stress ? d : 0.;
		}
		// a trial at zero stress scales by one
		const double scale = sigmaTrial > 0. ? (sigmaTrial - threeG * d) / sigmaTrial : 1.;
		return { d > 0. ? max(scale, 0.) : 1., d };
	}
}
template <YieldKind kind> MCA_INLINE Return radialReturn(const Yield& y, double sigmaTrial, double eqps, double temperature, double threeG, double dt)
{
	return radialReturn<kind>(y, staticYield<kind>(y, eqps, temperature), sigmaTrial, eqps, temperature, threeG, dt);
}
}
