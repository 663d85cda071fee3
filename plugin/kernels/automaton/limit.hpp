// SPDX-License-Identifier: GPL-2.0-or-later
// Largest stable time step. Formulation, equation (13).
#pragma once
#include "../lattice.hpp"
#include "../material.hpp"

namespace mca {

/// Largest stable step [s] of the hexagonal packing (13), d [m]: the rotation of an automaton against its neighbours has omega^2 = 32 G/(rho d^2), which limits
/// the step for Poisson ratios below 0.48; sound waves limit it to 1.65 d/cP, less with viscosity. cP with the tangent at the present state, cS [m/s];
/// zeta = viscous damping ratio c1 + c2 |dv|/c [-].
inline double stableStep(double d, double cP, double cS, double zeta)
{
	const double sound = 1.65 * d / cP * (std::sqrt(1. + zeta * zeta) - zeta);
	return cS > 0. ? min(sound, 0.35355339059327376 * d / cS) : sound;
}
/// At a state: stiff = stiffness() [m2/s2], pressed = stiffness of the stiffest that meets something else [Pa], 0 for who meets nobody: its pressure moves
/// lighter neighbours, too, from one side. approach = speed with which neighbours close in [m/s]. What turns an automaton against its neighbours grows with J
/// (`widest`): shear stresses are those of the present volume.
inline double stepLimit(const Material& m, double d, double stiff, double pressed, double approach, double widest)
{
	const double cP = std::sqrt(0.5 * (stiff + max(stiff, pressed / m.eos.rho0)));
	return stableStep(d, cP, m.cS() * std::sqrt(max(widest, 1.)), m.viscosity.active() ? m.viscosity.linear + m.viscosity.quadratic * approach / cP : 0.);
}
/// Before anything has moved; J: volume ratio.
inline double stepLimitAtRest(const Material& m, double d, double J = 1.)
{
	return stableStep(d * min(1., J), longitudinalSpeed(m.eos, m.G, J - 1.), m.cS(), m.viscosity.linear);
}
/// Pairs that meet: no more than an eighth of their distance in a step. speed2: square of the largest relative speed [m2/s2].
inline double stepLimitOfContacts(double d, double speed2) { return 0.125 * d / std::sqrt(speed2); }
}
