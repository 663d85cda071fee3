// SPDX-License-Identifier: GPL-2.0-or-later
// Energy of the deviator in the plane.
#pragma once
#include "../automaton/energy.hpp"
#include "pair.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// Of one side of a pair, over the volume that it stands for [J/m3]: with the stiffness of the pair, which between unlike materials is neither's own. s, tau: J
/// times the stresses.
inline double pairEnergy(double s, double tau, double J, double twoG) { return twoG > 0 ? (sqr(s) + sqr(tau)) / (J * twoG) : 0.; }
inline double pairEnergy(Pair<double> stress, double J, double twoG) { return pairEnergy(stress.normal, stress.shear, J, twoG); }
/// Of the deviator: pairs = sum of pairEnergy() with the weights of the links. A side stands for one share of the full cell; szz for the volume of all,
/// which on weighted rims is not the cell.
inline double deviatorEnergy(double G, double d, double pairs, double J, double szz, double invN)
{
	return G > 0 ? Lattice::cell(d) / nLinks * (pairs + J * sqr(szz) / (4. * G * invN)) : 0.;
}
}
}
