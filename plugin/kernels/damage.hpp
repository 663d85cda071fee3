// SPDX-License-Identifier: GPL-2.0-or-later
// Damage of ductile metals by plastic flow: the strain at which they part depends on triaxiality, strain rate and temperature. Formulation, equation (11e).
// A material without it pays nothing.
#pragma once
#include "yield.hpp"

namespace mca {

enum class DamageKind { none, johnsonCook };
constexpr int damageKinds = 2;

/// Constants of Johnson and Cook (1985) [-].
struct DuctileDamage {
	DamageKind kind = DamageKind::none;
	double     D1 = 0, D2 = 0, D3 = 0, D4 = 0, D5 = 0;
	bool       active() const { return kind != DamageKind::none; }
};

/// Where the constants give less, or nothing (strong tension): flow parts at once.
constexpr double leastFractureStrain = 1e-6;

/// Plastic strain at fracture [-]; triaxiality: mean stress over Mises stress, tension positive; rate over the reference rate; temperature over its way to
/// melting, 0 to 1.
MCA_INLINE double fractureStrain(const DuctileDamage& c, double triaxiality, double rate, double homologous)
{
	const double byStress = fma(c.D2, fastExp(c.D3 * triaxiality), c.D1), byRate = fma(c.D4, fastLog(max(rate, 1.)), 1.);
	return max(byStress * byRate * fma(c.D5, homologous, 1.), leastFractureStrain);
}

/// Growth of the damage in a step of dt [s] with plastic strain dEqps, at mean pressure P and Mises stress sigma after it [Pa] (11e).
MCA_INLINE double damageGrowth(const DuctileDamage& c, const Yield& y, double dEqps, double P, double sigma, double temperature, double dt)
{
	const double homologous = min(max((temperature - y.referenceTemperature) / (y.meltTemperature - y.referenceTemperature), 0.), 1.);
	// without a Mises stress the triaxiality has no limit; its exponential ends at that of 1e4
	const double triaxiality = min(max(-P / max(sigma, 1e-300), -1e4), 1e4);
	const double growth      = dEqps / fractureStrain(c, triaxiality, dEqps / (dt * y.referenceRate), homologous);
	return dEqps > 0. ? growth : 0.;
}
}
