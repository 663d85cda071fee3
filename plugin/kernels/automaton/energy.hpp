// SPDX-License-Identifier: GPL-2.0-or-later
// Energy that an automaton holds [J/m].
#pragma once
#include "volume.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// Stored in the volume ratio J by the cold curve.
inline double coldEnergy(const Material& m, double cell, double J) { return cell * storedEnergy(m.eos, J - 1.); }
/// Of the volume; e = internal energy per mass [J/kg], where the equation of state has one.
inline double volumeEnergy(const Material& m, double cell, double J, double e) { return m.eos.heats() ? cell * m.eos.rho0 * e : coldEnergy(m, cell, J); }
/// What one side of a link loses when it breaks and goes on as a contact, which has full weight: the force of the pair goes on, so its stress is that of the
/// link times the weight. e = pairEnergy() of the link.
inline double lostAtBreak(double d, double weight, double e) { return Lattice::cell(d) / nLinks * (weight - weight * weight) * e; }
}
}
#if MCA_DIM == 2
#include "../plane/energy.hpp"
#else
#include "../space/energy.hpp"
#endif
