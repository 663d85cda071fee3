// SPDX-License-Identifier: GPL-2.0-or-later
// Shock adiabat D = c0 + b U with the Hugoniot jump relations eps = -U/D, P = rho0 D U; linear in tension, where the adiabat has a spinodal.
// Formulation, equations (1)-(4).
#pragma once
#include "../law.hpp"

#define MCA_CONSTANTS_shockAdiabat(C) C(hugoniotSlope, "-", 0, laws::notNegative.with("0: linear law"), "b of the shock adiabat; 0: linear")
#define MCA_USES_shockAdiabat(U) U(hugoniotSlope, laws::notNegative.with("0: linear law"))

namespace mca::eos {

struct ShockAdiabat : EosLaw {
	/// volume strain at which the clamp begins [-] (-1 for the linear law: never reached)
	template <class E> static MCA_INLINE double clampStrain(const E& e) { return e.hugoniotSlope > 0 ? (e.clampAt - 1.) / e.hugoniotSlope : -1.; }

	/// (1), (2): pressure [Pa], positive in compression. Beyond the clamp: straight on with the tangent there.
	template <class E> static MCA_INLINE double pressure(const E& e, double eps)
	{
		const double K = e.bulkModulus(), b = e.hugoniotSlope;
		const double ec  = clampStrain(e);
		const double x   = max(eps, ec);
		const double inv = 1. / fma(b, min(x, 0.), 1.); // tension: b switched off
		const double kc  = K * (1. - b * ec) * inv * inv * inv;
		const double pc  = -K * x * inv * inv;
		return eps < ec ? fma(kc, ec - eps, pc) : pc;
	}

	/// (3): dP/d(-eps) [Pa]
	template <class E> static MCA_INLINE double tangent(const E& e, double eps)
	{
		const double x   = min(max(eps, clampStrain(e)), 0.);
		const double inv = 1. / fma(e.hugoniotSlope, x, 1.);
		return e.bulkModulus() * (1. - e.hugoniotSlope * x) * inv * inv * inv;
	}

	/// (4): stored energy per rest volume [J/m3], the integral of P d(-eps). Near rest a series replaces the difference of nearly equal terms.
	template <class E> static double storedEnergy(const E& e, double eps)
	{
		const double K = e.bulkModulus(), b = e.hugoniotSlope;
		if (eps >= 0 || b == 0) return 0.5 * K * eps * eps;
		const double x = max(eps, clampStrain(e)), u = b * x;
		double       w;
		if (std::fabs(u) < 0.03) { // ln(1+u) + 1/(1+u) - 1 = sum (-1)^n (n-1)/n u^n
			double s = 0, un = u;
			for (int n = 2; n < 12; n++) {
				un *= -u; // (-1)^(n-1) u^n
				s -= un * (n - 1) / n;
			}
			w = s;
		} else
			w = std::log1p(u) + 1. / (1. + u) - 1.;
		w *= K / (b * b);
		const double d = x - eps; // beyond the clamp
		return w + d * (pressure(e, x) + 0.5 * tangent(e, x) * d);
	}
};
}
