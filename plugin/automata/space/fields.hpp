// SPDX-License-Identifier: GPL-2.0-or-later
// Rows of fields.hpp that are others in the plane.
#pragma once
#include "../../kernels/automaton/links.hpp"

/// Names of the components of a vector.
#define MCA_COMPONENTS(first, second, third) first, second, third
/// A row of rotations or torques.
#define MCA_TURN(F, V, name, presence, shown, scripts, text) V(name, presence, scripts, text, #name "X", #name "Y", #name "Z")
#define MCA_TURN_SUM(F, V, name, presence, text) V(name, presence, text, #name "X", #name "Y", #name "Z")
/// Stresses of an automaton beside those of its pairs.
#define MCA_DEVIATORS(F) \
	F(sxx, double, always, "deviatorXX", "deviator of the stress [Pa]") \
	F(syy, double, always, "deviatorYY", "[Pa]") \
	F(szz, double, always, "deviatorZZ", "[Pa]") \
	F(syz, double, always, "deviatorYZ", "[Pa]") \
	F(szx, double, always, "deviatorZX", "[Pa]") \
	F(sxy, double, always, "deviatorXY", "[Pa]")
/// Where an automaton lies on a plane of symmetry: the direction of its normal x, y, z in the frame of the packing [-], else 0.
#define MCA_MIRRORS(V) \
	V(mirrorFirst, whenUsed, hidden, "normal of a plane of symmetry x = const in the packing", "mirrorFirstx", "mirrorFirsty", "mirrorFirstz") \
	V(mirrorSecond, whenUsed, hidden, "normal of a plane of symmetry y = const in the packing", "mirrorSecondx", "mirrorSecondy", "mirrorSecondz") \
	V(mirrorThird, whenUsed, hidden, "normal of a plane of symmetry z = const in the packing", "mirrorThirdx", "mirrorThirdy", "mirrorThirdz")
/// Stresses of contacts.
#define MCA_CONTACT_SIDES(F, V) V(traction, saved, "J times traction of this side [Pa]", "tx", "ty", "tz")
#define MCA_CONTACT_BEFORE(F, V) V(before, scratch, "traction before this step, turned with the pair [Pa]", "bx", "by", "bz")

/// Opening of broken pairs that hold together.
#define MCA_BOND_SIDES(F, V) V(traction, saved, "opening [m]", "tx", "ty", "tz")

/// Stresses of links, and names of what the solver keeps beside the rows, as they are saved.
#define MCA_LINK_STRESSES store.traction
#define MCA_SOLVER_VECTORS "accountForce.volumetric, accountForce.viscous, searched, tiedVelocity, tiedSpin: components in turn"
