// SPDX-License-Identifier: GPL-2.0-or-later
// Largest stable time step. Formulation, equation (13).
#pragma once
#include "../lattice.hpp"
#include "../material.hpp"
#include "volume.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// Largest stable step [s] of the packing (13), d [m]: the rotation of an automaton against its neighbours limits it for Poisson ratios below 0.48; sound waves
/// limit it above, and more with viscosity. cP with the tangent at the present state, cS [m/s]; zeta = dampingRatio() [-].
inline double stableStep(double d, double cP, double cS, double zeta)
{
	const double sound = Lattice::soundStep * d / cP * (std::sqrt(1. + zeta * zeta) - zeta);
	return cS > 0. ? min(sound, Lattice::turningStep * d / cS) : sound;
}
/// Damping ratio of the fastest sound wave [-]; cP with the tangent at the present state, approach = d |theta'| [m/s]. (12a) has 2 c2 as the
/// slope of its quadratic part, and in its linear part a speed of sound that is at most cP. Links damp by c1 at rest, and no more where the tangent has become
/// stiffer.
inline double dampingRatio(const Material& m, VolumeRule rule, double cP, double approach)
{
	const Viscosity& v = m.viscosity;
	if (rule != VolumeRule::affine) return v.active() ? v.linear + v.quadratic * approach / cP : 0.;
	return (Lattice::linkViscosity * v.linear * m.cP() + Lattice::volumeDamping * (v.linear * cP + 2. * v.quadratic * approach)) / cP;
}
/// Square of the frequency with which an automaton at an outline turns against its neighbours, over that inside: they move, too. Covers bodies of four
/// triangles or more; one to three alone have up to 1.375, so that their limit is 5 % shorter.
constexpr double turningAtOutlines = 1.25;
/// At a state: stiff = stiffness() [m2/s2], pressed = stiffness of the stiffest that meets something else [Pa], 0 for who meets nobody: its pressure moves
/// lighter neighbours, too, from one side. approach = speed with which neighbours close in [m/s]. What turns an automaton against its neighbours grows with J
/// (`widest`, at an outline times turningAtOutlines): shear stresses are those of the present volume.
inline double stepLimit(const Material& m, VolumeRule rule, double d, double stiff, double pressed, double approach, double widest)
{
	const double cP = std::sqrt(0.5 * (stiff + max(stiff, pressed / m.eos.rho0)));
	return stableStep(d, cP, m.cS() * std::sqrt(max(widest, 1.)), dampingRatio(m, rule, cP, approach));
}
/// Before anything has moved; J: volume ratio.
inline double stepLimitAtRest(const Material& m, double d, double J = 1.)
{
	const double cP = longitudinalSpeed(m.eos, m.G, J - 1.);
	return stableStep(d * min(1., J), cP, m.cS(), dampingRatio(m, VolumeRule::affine, cP, 0.));
}
/// Pairs that meet: no more than an eighth of their distance in a step. speed2: square of the largest relative speed [m2/s2].
inline double stepLimitOfContacts(double d, double speed2) { return 0.125 * d / std::sqrt(speed2); }
}
}
