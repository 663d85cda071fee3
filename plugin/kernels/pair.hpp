// SPDX-License-Identifier: GPL-2.0-or-later
// The law of a pair of automata, as pure functions: lattice constants, density term, strain increment, forces.
// Used by the fast solver and by the law in YADE's own loop alike. Formulation, equations (5)-(9) and (12).
// n = unit vector i -> j, r = |x_j - x_i|, d = rest distance, t = n turned by +90 degrees; tension positive.
#pragma once
#include "simd.hpp"

namespace mca {

/// Constants of the perfect packing; in each Omega0 = N0 S0 d / (2 dim).
template <int dim> struct Lattice;
template <> struct Lattice<2> { // hexagonal, per unit thickness
	static constexpr int neighbours = 6;
	static double        cell(double d) { return 0.86602540378443864676 * d * d; } ///< Omega0 [m2]
	static double        width(double d) { return d * 0.57735026918962576451; }    ///< S0 [m]
};
template <> struct Lattice<3> { // face-centred cubic
	static constexpr int neighbours = 12;
	static double        cell(double d) { return d * d * d * 0.70710678118654752440; } ///< Omega0 [m3]
	static double        width(double d) { return d * d * 0.35355339059327376220; }    ///< S0 [m2]
};

/// affine (default): J = det F from the links; inversePower: mean of (d/r)^dim; meanDistance: mean linear strain, as published.
enum class VolumeRule { affine, inversePower, meanDistance };

/// Directions of the six links in the frame of the packing; link k points at 60 k degrees, so the reverse of link k is (k + 3) % 6.
constexpr double linkX[6] = { 1., 0.5, -0.5, -1., -0.5, 0.5 };
constexpr double linkY[6] = { 0., 0.86602540378443864676, 0.86602540378443864676, 0., -0.86602540378443864676, -0.86602540378443864676 };

/// What one pair adds to the sum of the volume rule [-]: (5) inversePower (d/r)^dim - 1; meanDistance r/d - 1 (the published mean linear strain).
template <VolumeRule rule, int dim> inline double volumeTerm(double d, double r2)
{
	if constexpr (rule == VolumeRule::meanDistance) return std::sqrt(r2) / d - 1.;
	else if constexpr (dim == 2) return d * d / r2 - 1.;
	else {
		const double q = d / std::sqrt(r2);
		return q * q * q - 1.;
	}
}

/// J = Omega/Omega0 [-] from the mean of the volume terms.
template <VolumeRule rule, int dim> inline double volumeRatio(double meanTerm)
{
	const double q = 1. + meanTerm;
	if constexpr (rule == VolumeRule::inversePower) return 1. / q;
	else return dim == 2 ? q * q : q * q * q;
}

/// (6), one side's share h: the repulsive pair force is (h_i + h_j) pressureShape() times the vector i -> j.
/// omegaPerN = Omega0_i / N_i [m^dim], P [Pa], J [-].
template <VolumeRule rule, int dim> inline double pressureShare(double P, double J, double omegaPerN)
{
	if constexpr (rule == VolumeRule::inversePower) return P * J * J * omegaPerN * dim;
	else return P * omegaPerN * dim * (dim == 2 ? std::sqrt(J) : std::pow(J, 2. / 3.));
}
template <VolumeRule rule, int dim> inline double pressureShape(double d, double invR2)
{
	if constexpr (rule == VolumeRule::meanDistance) return std::sqrt(invR2) / d;
	else if constexpr (dim == 2) return d * d * invR2 * invR2;
	else return d * d * d * invR2 * invR2 * std::sqrt(invR2);
}

template <class T> struct PairStrain {
	T normal; ///< dr/r [-]
	T shear;  ///< dgamma [-]
};
/// (7), (8): strain increments over the last step, at its middle. (dx, dy) = x_j - x_i now [m]; (ux, uy) = relative displacement of the step [m];
/// spin = (omega_i q_i + omega_j q_j)/(q_i + q_j) dt [-], q = distance from centre to contact. T: double, or several pairs side by side.
template <class T> MCA_INLINE PairStrain<T> strainIncrement(T dx, T dy, T ux, T uy, T spin)
{
	const T mx = fma(-0.5, ux, dx), my = fma(-0.5, uy, dy);
	const T inv = 1. / fma(mx, mx, my * my);
	return { fma(mx, ux, my * uy) * inv, fma(mx, uy, -my * ux) * inv - spin };
}

/// (12): viscous pair force over the vector i -> j [N/m]: negative (repulsive) when approaching, zero in expansion.
/// along = (x_j-x_i).(v_j-v_i) [m2/s]; linear = rho c1 c [Pa s/m], quadratic = rho c2 [Pa s2/m2], width = contact width [m].
template <class T> MCA_INLINE T viscousCoefficient(T along, T invR2, double linear, double quadratic, double width)
{
	const T a = min(along, 0.);
	return fma(-quadratic * a, root(invR2), linear) * a * invR2 * width;
}

/// Equivalent stress squared [Pa2] (10): meanSquare = mean over the slots of s^2 + tau^2; szz = out-of-plane deviator (plane strain).
template <int dim> inline double equivalentStress2(double meanSquare, double szz)
{
	return dim == 2 ? fma(3., meanSquare, 1.5 * szz * szz) : 4.5 * meanSquare;
}

/// Largest stable step [s] of the hexagonal packing (13), d [m]: the rotation of an automaton against its neighbours has omega^2 = 32 G/(rho d^2), which limits
/// the step for Poisson ratios below 0.48; sound waves limit it to 1.65 d/cP, less with viscosity. cP with the tangent at the present state, cS [m/s];
/// zeta = viscous damping ratio c1 + c2 |dv|/c [-].
inline double stableStep(double d, double cP, double cS, double zeta)
{
	const double sound = 1.65 * d / cP * (std::sqrt(1. + zeta * zeta) - zeta);
	return cS > 0. ? min(sound, 0.35355339059327376 * d / cS) : sound;
}
}
