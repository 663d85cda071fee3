// SPDX-License-Identifier: GPL-2.0-or-later
// Energy that an automaton holds [J/m].
#pragma once
#include "volume.hpp"

namespace mca {

/// Stored in the volume ratio J by the cold curve.
inline double coldEnergy(const Material& m, double cell, double J) { return cell * storedEnergy(m.eos, J - 1.); }
/// Of the volume; e = internal energy per mass [J/kg], where the equation of state has one.
inline double volumeEnergy(const Material& m, double cell, double J, double e) { return m.eos.heats() ? cell * m.eos.rho0 * e : coldEnergy(m, cell, J); }
/// Of one side of a pair, over the volume that it stands for [J/m3]: with the stiffness of the pair, which between unlike materials is neither's own. s, tau: J
/// times the stresses.
inline double pairEnergy(double s, double tau, double J, double twoG) { return twoG > 0 ? (sqr(s) + sqr(tau)) / (J * twoG) : 0.; }
/// What one side of a link loses when it breaks and goes on as a contact, which has full weight: the force of the pair goes on, so its stress is that of the
/// link times the weight. e = pairEnergy() of the link.
inline double lostAtBreak(double d, double weight, double e) { return Lattice::cell(d) / nLinks * (weight - weight * weight) * e; }
/// Of the deviator: pairs = sum of pairEnergy() with the weights of the links. A side stands for one share of the full cell; szz for the volume of all,
/// which on weighted rims is not the cell.
inline double deviatorEnergy(double G, double d, double pairs, double J, double szz, double invN)
{
	return G > 0 ? Lattice::cell(d) / nLinks * (pairs + J * sqr(szz) / (4. * G * invN)) : 0.;
}
}
