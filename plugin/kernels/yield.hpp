// SPDX-License-Identifier: GPL-2.0-or-later
// Yield stress and radial return. Formulation, equations (10)-(11). Shared by automata and grid.
// The kind is a template parameter: a material that does not yield, harden or heat pays nothing for it.
#pragma once
#include "math.hpp"
#include <limits>
#include <type_traits>

namespace mca {

enum class YieldKind { elastic, perfect, linearHardening, johnsonCook };

struct Yield {
	YieldKind kind = YieldKind::elastic;
	double    A    = std::numeric_limits<double>::infinity(); ///< initial yield stress [Pa]
	double    B    = 0;                                       ///< hardening modulus [Pa] (linear: dY/d eps_p; Johnson-Cook: B)
	double    n    = 1;                                       ///< hardening exponent [-]
	double    C    = 0;                                       ///< rate coefficient [-]
	double    rate0 = 1;                                      ///< reference strain rate [1/s]
	double    m     = 1;                                      ///< thermal softening exponent [-]
	double    Tm    = std::numeric_limits<double>::infinity(); ///< melting temperature [K]
	double    T0    = 298;                                     ///< reference (initial) temperature [K]
	double    heatPerWork = 0; ///< temperature rise per plastic work: beta/(rho0 cp) [K m3/J]
};

struct Return {
	double scale;  ///< M: the trial deviator is multiplied by it [-]
	double dEqps;  ///< increment of the equivalent plastic strain [-]
};

/// Static yield stress [Pa] and its slope dY/d eps_p [Pa] at fixed temperature (Johnson & Cook 1983 without the rate factor).
/// The power law is vertical at zero strain: its slope is that at 1e-4.
struct StaticYield {
	double stress, slope;
};
template <YieldKind kind> MCA_INLINE StaticYield staticYield(const Yield& y, double eqps, double temperature)
{
	if constexpr (kind == YieldKind::elastic) return { std::numeric_limits<double>::infinity(), 0. };
	else if constexpr (kind == YieldKind::perfect) return { y.A, 0. };
	else if constexpr (kind == YieldKind::linearHardening) return { fma(y.B, eqps, y.A), y.B };
	else {
		const double hom  = min(max((temperature - y.T0) / (y.Tm - y.T0), 0.), 1.);
		const double soft = 1. - fastPow(hom, y.m);
		const double ep = max(eqps, 1e-4), power = y.B * fastPow(ep, y.n);
		const double near = min(eqps * 1e4, 1.); // straight from A to the power law below 1e-4
		return { fma(power, near, y.A) * soft, (near < 1. ? 1. : y.n) * power / ep * soft };
	}
}

/// Radial return (11): sigmaTrial = trial equivalent stress [Pa], s: static yield stress before the step, threeG = 3 G [Pa], dt [s].
/// Johnson-Cook solves sigmaTrial - 3G d = Y(eps_p + d, d/dt) by two Newton steps from a close start: the residual is below 1e-6 Y.
/// Below the static yield stress the answer is { 1, 0 } exactly, so a caller may leave it out there.
/// Straight-line code: loops over automata or cells vectorise.
template <YieldKind kind> MCA_INLINE Return radialReturn(const Yield& y, const StaticYield& s, double sigmaTrial, double threeG, double dt)
{
	if constexpr (kind == YieldKind::elastic) return { 1., 0. };
	else {
		double d = max(sigmaTrial - s.stress, 0.) / (threeG + s.slope);
		if constexpr (kind == YieldKind::johnsonCook) {
			const double perRate = 1. / (dt * y.rate0);
			// Start: rate term and elastic unloading alone, 3G d + Y C ln(d/(dt rate0)) = sigmaTrial - Y, is w + ln w = l with w = 3G d/(Y C): Lambert's W of
			// exp l, here within 1 % (Winitzki 2003). From the rate-free answer Newton's steps would leave the range where l is small: low rates, short steps.
			const double k = threeG + s.slope, YC = max(y.C * s.stress, 1e-12 * threeG);
			const double l = fastLog(k / (YC * perRate)) + max(sigmaTrial - s.stress, 0.) / YC;
			const double q = l > 30. ? l : fastLog(1. + fastExp(min(l, 30.)));
			d              = q * (1. - fastLog(1. + q) / (2. + q)) * YC / k;
			for (int it = 0; it < 2; it++) {
				const double r     = d * perRate;
				const double f     = 1. + y.C * fastLog(max(r, 1.));
				const double df    = r > 1. ? y.C / max(d, 1e-300) : 0.;
				const double Ys    = fma(s.slope, d, s.stress);
				const double resid = sigmaTrial - threeG * d - Ys * f;
				d                  = max(d + resid / (threeG + s.slope * f + Ys * df), 0.);
			}
			d = sigmaTrial > s.stress ? d : 0.;
		}
		// a trial at zero stress scales by one
		const double scale = sigmaTrial > 0. ? (sigmaTrial - threeG * d) / sigmaTrial : 1.;
		return { d > 0. ? max(scale, 0.) : 1., d };
	}
}
template <YieldKind kind> MCA_INLINE Return radialReturn(const Yield& y, double sigmaTrial, double eqps, double temperature, double threeG, double dt)
{
	return radialReturn<kind>(y, staticYield<kind>(y, eqps, temperature), sigmaTrial, threeG, dt);
}

/// Calls f with the kind as a compile-time constant: the branch is taken once per block of automata or cells, not per element.
template <class F> inline void dispatch(YieldKind k, F&& f)
{
	switch (k) {
		case YieldKind::elastic: f(std::integral_constant<YieldKind, YieldKind::elastic> {}); break;
		case YieldKind::perfect: f(std::integral_constant<YieldKind, YieldKind::perfect> {}); break;
		case YieldKind::linearHardening: f(std::integral_constant<YieldKind, YieldKind::linearHardening> {}); break;
		case YieldKind::johnsonCook: f(std::integral_constant<YieldKind, YieldKind::johnsonCook> {}); break;
	}
}
}
