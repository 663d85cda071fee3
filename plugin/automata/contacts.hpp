// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts: pairs that are not linked. The search looks only at automata that may touch something (rim, broken, flowing);
// the passes run over half-contacts as one flat list and add up the rows of each owner in a fixed order.
#pragma once
#include "passes.hpp"

namespace mca::automata {

/// A link of material that can break does so when it is shorter than this; pairs found closer do not touch [rest distances]
constexpr double collapsed = 0.4;
/// Contacts may not overlap deeper: (r/d)^2 [-]
constexpr double deepest = 0.25;
/// A pair touches when its distance squared is below this share of its rest distance squared: a pair that has just got its present distance as
/// rest distance must not touch by round-off, since the viscosity acts from the first touch
constexpr double touchShare = 1. - 1e-14;

/// 1 where a half-contact pushes at this distance squared, else 0. Two automata that have slid into each other do not touch until they have parted: near zero distance
/// a pair force has no meaning, and the volume they share is held by their other neighbours.
inline double pushes(double r2, double rest, double d) { return r2 < touchShare * sqr(rest) ? (rest >= collapsed * d ? 1. : 0.) : 0.; }

/// Arrays of one entry per automaton that the contact passes fill for the passes over links.
struct ContactScratch {
	std::vector<double> sum, square, old, scale, fx, fy, torque, volX, volY, visX, visY;
	std::vector<double> terms; ///< per half-contact
};

struct ContactWork {
	double friction = 0, coupling = 0, plastic = 0;
};

/// New list of contacts from all exposed automata closer than (1 + skin) times their rest distance; stresses of pairs that go on are kept.
/// Deterministic: rows in the order of the arrays, entries of a row in the order of their callers' numbers.
void searchContacts(Store& S, Contacts& C, double skin, int threads);

/// Fills perTwoG and perOwnG, which are not part of the saved state.
void contactReciprocals(const Store& S, Contacts& C);
/// Geometry of this step and volume terms: fills scratch.sum. Returns (r/d)^2 of the closest contact; closest: its place in the list when it is too deep.
double contactDensity(const Store& S, Contacts& C, VolumeRule rule, ContactScratch& out, size_t& closest);
/// Trial stresses; fills scratch.square, and for the account scratch.old, the products of old and trial stresses. Returns the largest relative speed squared [m2/s2] of listed pairs.
double contactTrial(const Store& S, Contacts& C, double dt, ContactScratch& out, bool account);
/// Pressure of the pairs that push, from the volumes after the density pass.
void contactPressure(const Store& S, Contacts& C, VolumeRule rule);
/// Radial return by scratch.scale, then no tension and Coulomb friction.
void contactFriction(const Store& S, Contacts& C, const ContactScratch& in, ContactWork* work);
/// Forces; fills scratch.fx, fy, torque (and the shares of pressure and viscosity for the account).
void contactForces(Contacts& C, ContactScratch& out, bool account);
}
