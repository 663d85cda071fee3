// SPDX-License-Identifier: GPL-2.0-or-later
// Rows of fields.hpp that are others in space.
#pragma once
#include "../../kernels/automaton/links.hpp"

/// Names of the components of a vector.
#define MCA_COMPONENTS(first, second, third) first, second
/// A row of rotations or torques: plane motion turns about one axis.
#define MCA_TURN(F, V, name, presence, shown, scripts, text) F(name, double, presence, shown, text)
#define MCA_TURN_SUM(F, V, name, presence, text) F(name, presence, text)
/// Stresses of an automaton beside those of its pairs.
#define MCA_DEVIATORS(F) F(szz, double, always, "stressZZ", "deviator normal to the plane [Pa]")
/// Planes of symmetry are of space only.
#define MCA_MIRRORS(V)
/// Stresses of contacts.
#define MCA_CONTACT_SIDES(F, V) \
	F(s, double, saved, "J times normal stress of this side [Pa]") \
	F(tau, double, saved, "J times shear stress of this side [Pa]")
/// What the step keeps of them: in `second` and `third`.
#define MCA_CONTACT_BEFORE(F, V)

/// Opening of broken pairs that hold together.
#define MCA_BOND_SIDES(F, V) \
	F(s, double, saved, "opening along the pair [m]") \
	F(tau, double, saved, "opening across it [m]")

/// Stresses of links, and names of what the solver keeps beside the rows, as they are saved.
#define MCA_LINK_STRESSES store.s, store.tau
#define MCA_SOLVER_VECTORS "accountForce.volX, accountForce.volY, accountForce.visX, accountForce.visY, searchX, searchY, tiedVx, tiedVy, tiedW"
