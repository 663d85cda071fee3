// SPDX-License-Identifier: GPL-2.0-or-later
// Options, counters and energy account of the automata: the same in the plane and in space.
#pragma once
#include "../kernels/volume_rule.hpp"
#include <cstdint>

namespace mca {

struct AutomataOptions {
	VolumeRule volumeRule   = VolumeRule::affine;
	double     linkFactor   = 1.2;  ///< automata closer than this times their rest distance are linked at build [-]
	double     skin         = 0.4;  ///< contact search range beyond touching, in rest distances [-]
	bool       sleeping     = true; ///< leave out blocks that nothing has reached
	bool       account      = false; ///< keep the energy account
	bool       contacts     = true; ///< search for contacts
	double     volumeFilter = 0.1; ///< rate at which the shortest waves of volume fade in flowing material, times d/c0 [-]; affine rule
	bool       acrossMasks  = false; ///< the caller has made one group of all masks
	bool       fullLinks    = false; ///< keep full weight of links and cells at weighted rims (no half bonds)
};

/// Energies, in the plane per thickness [J/m], in space [J]; independent ones from state functions and each dissipation's own increments, booked ones
/// from forces and velocities.
template <class Vector, class Turned> struct AccountOf {
	double kinetic = 0, volumetric = 0, deviatoric = 0;                    ///< now
	double plastic = 0, viscous = 0, friction = 0, fracture = 0, coupling = 0, boundary = 0; ///< dissipated (coupling: exchanged) since build
	double left     = 0; ///< energy of automata that were erased, less that of added ones, and what was put in as stress: the sum goes on
	double leftMass = 0, leftKinetic = 0, leftVolumetric = 0, leftDeviatoric = 0; ///< parts of it [kg/m, in space kg; J/m, in space J]
	double external = 0;                                                   ///< work of external forces and driven automata
	double bookedVolumetric = 0, bookedDeviatoric = 0, bookedViscous = 0;  ///< work of the internal forces
	double centre = 0; ///< velocities stand half a step after stresses: kinetic energy, work from outside and of viscous forces then, minus now
	double kineticStart = 0, heated = 0; ///< heated: dissipation that stands in the internal energy of Mie-Grueneisen materials
	Vector momentum {}; ///< [N s/m]
	Turned angular {};  ///< angular momentum about the origin [N s]
	Vector impulse {};  ///< of external forces, driven and viscous boundaries [N s/m]
	Vector leftMomentum {}; ///< that erased automata had, less that of added ones [N s/m]
	/// kinetic energy gained minus all work booked: round-off
	double bookedError() const { return kinetic + leftKinetic - kineticStart - bookedVolumetric - bookedDeviatoric - bookedViscous - external + boundary; }
	/// independent sum at the time of the stresses
	double total() const
	{
		return kinetic + volumetric + deviatoric + plastic + viscous + friction + fracture + coupling + boundary + left - external + centre;
	}
};

struct AutomataCounters {
	int64_t steps = 0, searches = 0, localSearches = 0, blockSteps = 0, brokenLinks = 0, clamped = 0, sorts = 0;
	double  deepest = 1e300; ///< smallest r/d seen
	double  nsDensity = 0, nsStress = 0, nsForce = 0, nsContact = 0, nsSearch = 0, nsIntegrate = 0, nsFracture = 0;
};
}
