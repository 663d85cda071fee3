// SPDX-License-Identifier: GPL-2.0-or-later
// Energy of the deviator in space.
#pragma once
#include "../automaton/energy.hpp"
#include "pair.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// Of one side of a pair, over the volume that it stands for [J/m3]: with the stiffness of the pair, which between unlike materials is neither's own. stress: J
/// times the traction.
inline double pairEnergy(Vec<double> stress, double J, double twoG) { return twoG > 0 ? 1.5 * plainSquare(stress) / (J * twoG) : 0.; }
/// Of the deviator of the automaton, and of its sides: pairs = sum of pairEnergy() with the weights of the links. A side stands for one share of the full cell.
inline double deviatorEnergy(double G, double d, double cell, double J, const Symmetric<double>& deviator, double pairs)
{
	return G > 0 ? cell * J * dot(deviator, deviator) / (4. * G) + Lattice::cell(d) / nLinks * pairs : 0.;
}
}
}
