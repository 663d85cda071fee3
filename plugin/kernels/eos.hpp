// SPDX-License-Identifier: GPL-2.0-or-later
// Equation of state: pressure from the volume strain eps = J - 1 = Omega/Omega0 - 1 (negative in compression), and from the internal energy where the law
// heats. With the kind as a template parameter for loops that must vectorise; without it for a single call. The laws are in laws/eos. Shared by automata and
// grid.
#pragma once
#include "laws/list.hpp"

namespace mca {

/// Pressure [Pa], positive in compression: of contacts always, of the volume where the law does not heat. Beyond the clamp: straight on with the tangent there.
template <EosKind kind> MCA_INLINE double pressure(const Eos& e, double eps) { return LawOf<kind>::pressure(e, eps); }
inline double pressure(const Eos& e, double eps)
{
	return dispatch(e.kind, [&](auto k) { return pressure<k.value>(e, eps); });
}

/// dP/d(-eps) [Pa], which limits the time step.
template <EosKind kind> MCA_INLINE double tangent(const Eos& e, double eps) { return LawOf<kind>::tangent(e, eps); }
inline double tangent(const Eos& e, double eps)
{
	return dispatch(e.kind, [&](auto k) { return tangent<k.value>(e, eps); });
}

inline bool clamped(const Eos& e, double eps) { return eps < e.clampStrain(); }

/// Stored energy per rest volume [J/m3], the integral of pressure() d(-eps).
inline double storedEnergy(const Eos& e, double eps)
{
	return dispatch(e.kind, [&](auto k) { return LawOf<k.value>::storedEnergy(e, eps); });
}

/// Pressure [Pa] of a law that heats; internalEnergy per mass [J/kg].
template <EosKind kind> MCA_INLINE double hotPressure(const Eos& e, double eps, double internalEnergy)
{
	const Thermal t = LawOf<kind>::thermal(e, eps, e.rho0 * internalEnergy);
	return t.A + t.B * e.rho0 * internalEnergy;
}

/// The same with the work of this step in the energy: P = A + B e and e = e_old - (P_old + P)/2 d eps / rho0 solved together, so that internal
/// energy grows by exactly the pressure's work. energy [J/kg]: old in, new out.
template <EosKind kind> MCA_INLINE double pressureWithWork(const Eos& eos, double eps, double dEps, double pOld, double& energy)
{
	const Thermal t = LawOf<kind>::thermal(eos, eps, eos.rho0 * energy);
	const double  A = t.A, B = t.B * eos.rho0, half = 0.5 * dEps / eos.rho0;
	const double  e = energy - half * pOld, p = (A + B * e) / (1. + B * half);
	energy          = e - half * p;
	return p;
}
/// For a single call; where the law does not heat, the energy stays as it is.
inline double pressureWithWork(const Eos& eos, double eps, double dEps, double pOld, double& energy)
{
	return dispatch(eos.kind, [&](auto k) {
		if constexpr (LawOf<k.value>::heats) return pressureWithWork<k.value>(eos, eps, dEps, pOld, energy);
		else return pressure<k.value>(eos, eps);
	});
}
inline double hotPressure(const Eos& eos, double eps, double internalEnergy)
{
	return dispatch(eos.kind, [&](auto k) {
		if constexpr (LawOf<k.value>::heats) return hotPressure<k.value>(eos, eps, internalEnergy);
		else return pressure<k.value>(eos, eps);
	});
}

/// Longitudinal sound speed [m/s] with the tangent at the current density: rho0 c^2 = J (-dP/deps + 4G/3).
inline double longitudinalSpeed(const Eos& e, double shearModulus, double eps)
{
	return std::sqrt((1. + eps) * (tangent(e, eps) + (4. / 3.) * shearModulus) / e.rho0);
}
}
