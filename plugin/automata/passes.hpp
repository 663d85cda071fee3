// SPDX-License-Identifier: GPL-2.0-or-later
// The three passes of one step over the links of one block: density and pressure, stress and yield, forces.
// Each automaton computes its own side of its pairs from gathered neighbours, so no two threads write the same entry and the
// result does not depend on their number. What a block does not need is removed by template parameters, never by tests inside the loops.
#pragma once
#include "store.hpp"

namespace mca::automata {

/// Reduced over a block by each pass; combined in block order.
struct BlockResult {
	double stiffest = 0; ///< max of (tangent + 4G/3) / (rho0 J) [m2/s2]
	double closing  = 0; ///< max of -dTheta [-]
	double widest   = 1; ///< max of J, at least 1 [-]
	double nearest  = 1e300; ///< min of (r/d)^2 over links [-]
	double criterion = 0; ///< max of Store::criterion [-]
	int64_t clamped = 0; ///< automata beyond the clamp of the equation of state
	int64_t bad     = -1; ///< first automaton with a non-finite result
};

/// Dissipation booked by the passes of one step for one block [J/m]; only when the account is kept.
struct BlockWork {
	double plastic = 0, coupling = 0;
	double heated = 0; ///< part of it that went into the internal energy of Mie-Grueneisen materials
};

/// Scratch that exists only for some scenes; null where the scene does not need it.
struct Extra {
	double        perMove     = 0;       ///< 1/length of the last move [1/s]; 0: none yet
	const double* contactSum  = nullptr; ///< per automaton: volume terms of its contacts
	const double* contactSq   = nullptr; ///< per automaton: squares of the stresses of its contacts [Pa2]
	const double* contactOld  = nullptr; ///< account: products of the stresses before the step and the trial stresses
	double*       scale       = nullptr; ///< per automaton: M of the radial return, for its contacts
	const double*        contactT[turns] = {};   ///< per automaton: torques of its contacts [N]
	Planes<const double> contactForce = {};      ///< and their forces [N/m]
	bool                 account      = false;   ///< whether the shares below are wanted
	Planes<double>       volumetric = {}, viscous = {}; ///< account: shares of the force
};

/// Pass 1: volume (5), pressure (1)-(3), pressure share (6). With init the raw sum of volume terms is stored as the state of rest.
void volumePass(Store& S, size_t block, VolumeRule rule, const Extra& X, bool init, BlockResult& out);
/// Pass 2: pair stresses (7)-(9), radial return (10)-(11), mean pressure, fracture criteria; dt = length of the last move [s]: zero leaves the stresses.
void stressPass(Store& S, size_t block, VolumeRule rule, double dt, const Extra& X, BlockResult& out, BlockWork* work);
/// Mie-Grueneisen materials only: the heat of the viscosity of the last step goes into the internal energy.
void viscousHeat(Store& S, size_t block, VolumeRule rule, double dt, BlockWork* work);
/// Pass 3: forces and torques.
void forcePass(Store& S, size_t block, VolumeRule rule, const Extra& X);
}
