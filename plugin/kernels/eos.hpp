// SPDX-License-Identifier: GPL-2.0-or-later
// Equation of state: pressure from the volume strain eps = J - 1 = Omega/Omega0 - 1 (negative in compression).
// Shock adiabat D = c0 + b U with the Hugoniot jump relations eps = -U/D, P = rho0 D U; linear in tension, where the adiabat has a spinodal.
// Formulation, equations (1)-(4). Shared by automata and grid.
#pragma once
#include "math.hpp"

namespace mca {

struct Eos {
	double rho0   = 0;   ///< density at rest [kg/m3]
	double c0     = 0;   ///< bulk sound speed [m/s]; bulk modulus K = rho0 c0^2
	double b      = 0;   ///< slope of the shock adiabat D = c0 + b U [-]; 0: linear law
	double gamma0 = 0;   ///< Grueneisen parameter [-], used when mieGrueneisen
	bool   mieGrueneisen = false;
	double clampAt = 0.15; ///< smallest 1 + b eps; beyond it the tangent stays constant

	double bulkModulus() const { return rho0 * c0 * c0; }
	/// volume strain at which the clamp begins [-] (-1 for the linear law: never reached)
	double clampStrain() const { return b > 0 ? (clampAt - 1.) / b : -1.; }
};

/// (1), (2): pressure [Pa], positive in compression. Beyond the clamp: straight on with the tangent there.
inline double pressure(const Eos& e, double eps)
{
	const double K   = e.bulkModulus();
	const double ec  = e.clampStrain();
	const double x   = max(eps, ec);
	const double inv = 1. / fma(e.b, min(x, 0.), 1.); // tension: b switched off
	const double kc  = K * (1. - e.b * ec) * inv * inv * inv;
	const double pc  = -K * x * inv * inv;
	return eps < ec ? fma(kc, ec - eps, pc) : pc;
}

/// (3): dP/d(-eps) [Pa]
inline double tangent(const Eos& e, double eps)
{
	const double x   = min(max(eps, e.clampStrain()), 0.);
	const double inv = 1. / fma(e.b, x, 1.);
	return e.bulkModulus() * (1. - e.b * x) * inv * inv * inv;
}

inline bool clamped(const Eos& e, double eps) { return eps < e.clampStrain(); }

/// (4): stored energy per rest volume [J/m3], the integral of P d(-eps). Near rest a series replaces the difference of nearly equal terms.
inline double storedEnergy(const Eos& e, double eps)
{
	const double K = e.bulkModulus();
	if (eps >= 0 || e.b == 0) return 0.5 * K * eps * eps;
	const double x = max(eps, e.clampStrain()), u = e.b * x;
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
	w *= K / (e.b * e.b);
	const double d = x - eps; // beyond the clamp
	return w + d * (pressure(e, x) + 0.5 * tangent(e, x) * d);
}

/// Mie-Grueneisen, optional: P = P_H (1 + Gamma eps/2) + Gamma0 rho0 e with rho Gamma = rho0 Gamma0; e = internal energy per mass [J/kg].
/// In tension the thermal term alone is added to the linear law.
inline double pressureMieGrueneisen(const Eos& e, double eps, double internalEnergy)
{
	return pressure(e, eps) * (1. + 0.5 * e.gamma0 * min(eps, 0.)) + e.gamma0 * e.rho0 * internalEnergy;
}

/// The same with the work of this step in the energy: P = A + B e and e = e_old - (P_old + P)/2 d eps / rho0 solved together, so that internal
/// energy grows by exactly the pressure's work. energy [J/kg]: old in, new out.
inline double pressureWithWork(const Eos& eos, double eps, double dEps, double pOld, double& energy)
{
	const double A = pressureMieGrueneisen(eos, eps, 0.), B = eos.gamma0 * eos.rho0, half = 0.5 * dEps / eos.rho0;
	const double e = energy - half * pOld, p = (A + B * e) / (1. + B * half);
	energy         = e - half * p;
	return p;
}

/// Longitudinal sound speed [m/s] with the tangent of (3) at the current density: rho0 c^2 = J (-dP/deps + 4G/3).
inline double longitudinalSpeed(const Eos& e, double shearModulus, double eps)
{
	return std::sqrt((1. + eps) * (tangent(e, eps) + (4. / 3.) * shearModulus) / e.rho0);
}
}
