// SPDX-License-Identifier: GPL-2.0-or-later
// What the solver keeps of an automaton and of a contact, each quantity once. The arrays, the saved state with its version, sorting, the lengths that are
// checked after loading and McaEngine.field() follow from these rows. MCA_VECTOR and MCA_TURN are the one place that knows the components of a vector and of
// a rotation.
#pragma once
#include <cstdint>

/// A row of vectors: one row per component.
#define MCA_VECTOR(F, x, y, type, presence, shownX, shownY, text) F(x, type, presence, shownX, text) F(y, type, presence, shownY, text)
/// A row of rotations or torques: plane motion turns about one axis.
#define MCA_TURN(F, z, type, presence, shown, text) F(z, type, presence, shown, text)

/// F(name, type, presence, shown, text); presence: `always` an entry per automaton, `whenUsed`: empty in scenes without it; shown: name for
/// McaEngine.field(), "" for none. SI units per unit thickness.
#define MCA_AUTOMATON_FIELDS(F) \
	F(factor, double, always, "", "affine rule: J of the links = factor det F; 0 = too few links to have a volume [-]") \
	MCA_VECTOR(F, x, y, double, always, "x", "y", "position [m]") \
	MCA_VECTOR(F, vx, vy, double, always, "vx", "vy", "velocity [m/s]") \
	MCA_TURN(F, omega, double, always, "omega", "spin [rad/s]") \
	MCA_TURN(F, angle, double, always, "angle", "turned angle [rad]") \
	F(mass, double, always, "mass", "[kg/m]") \
	MCA_TURN(F, inertia, double, always, "", "[kg m]") \
	MCA_VECTOR(F, perMassX, perMassY, double, always, "", "", "1/mass [m/kg]; zero where the degree of freedom is blocked") \
	MCA_TURN(F, perInertia, double, always, "", "1/inertia [1/(kg m)]; zero where it is blocked") \
	F(diameter, double, always, "diameter", "[m]") \
	F(cell, double, always, "", "Omega0 [m2]") \
	F(invN, double, always, "", "1/N of the volume rule [-]") \
	F(rest, double, always, "", "sum of the volume rule at rest [-]") \
	F(J, double, always, "volumeRatio", "volume ratio [-]") \
	F(dTheta, double, always, "", "last increment of the volume strain [-]") \
	F(P, double, always, "", "pressure of the equation of state [Pa]") \
	F(mean, double, always, "pressure", "mean pressure: P, in the affine rule with the part of (5f) [Pa]") \
	F(h, double, always, "", "pressure share of (6) [N/m]") \
	F(szz, double, always, "stressZZ", "deviator normal to the plane [Pa]") \
	F(eqps, double, always, "plasticStrain", "equivalent plastic strain [-]") \
	F(temperature, double, always, "temperature", "[K]") \
	F(strength, double, always, "strength", "factor on the fracture criteria [-]") \
	F(criterion, double, always, "", "largest criterion / its limit [-]; a pair breaks at a mean of 1") \
	F(heat, double, whenUsed, "", "internal energy per mass, where a law heats [J/kg]") \
	MCA_VECTOR(F, fx, fy, double, always, "fx", "fy", "force of the last computeForces() [N/m]") \
	MCA_TURN(F, torque, double, always, "", "torque of it [N]") \
	MCA_VECTOR(F, outsideX, outsideY, double, whenUsed, "", "", "force from outside [N/m]") \
	MCA_TURN(F, outsideTorque, double, whenUsed, "", "torque from outside [N]") \
	MCA_VECTOR(F, dampX, dampY, double, whenUsed, "", "", "viscous boundary rho c A [kg/(m s)]") \
	F(weight, double, always, "weight", "share of the full cell [-]") \
	F(flags, int32_t, always, "", "Flag bits") \
	F(id, int32_t, always, "", "caller's number, -1: padding") \
	F(group, int32_t, always, "", "link group")

/// F(name, type, presence, text) per half-contact; presence: `saved`, or `scratch`: filled anew by each step.
#define MCA_CONTACT_FIELDS(F) \
	F(owner, int32_t, saved, "automaton whose side this is") \
	F(other, int32_t, saved, "automaton at the other side") \
	F(reverse, int32_t, saved, "place of the other half") \
	F(s, double, saved, "J times normal stress of this side [Pa]") \
	F(tau, double, saved, "J times shear stress of this side [Pa]") \
	F(rest, double, saved, "rest distance of this side: that of the two automata, or less when they came into contact already closer [m]") \
	F(d, double, saved, "mean diameter [m]") \
	F(twoG, double, saved, "2G of the pair [Pa]") \
	F(friction, double, saved, "[-]") \
	F(viscLinear, double, saved, "linear coefficient of (12) [kg/(m2 s)]") \
	F(viscQuadratic, double, saved, "quadratic coefficient of (12) [kg/m3]") \
	F(arm, double, saved, "arm of the owner over the distance [-]") \
	F(perTwoG, double, scratch, "1/twoG [1/Pa]; 0 where that is zero") \
	F(perOwnG, double, scratch, "1/G of the owner's material [1/Pa]; 0 where that is zero") \
	MCA_CONTACT_VECTOR(F, dx, dy, double, scratch, "from owner to other in this step [m]") \
	F(r2, double, scratch, "its square [m2]") \
	F(pushing, double, scratch, "1 where this side pushes, else 0") \
	F(touch, double, scratch, "1 where any side pushes, else 0") \
	F(along, double, scratch, "(x_j-x_i).(v_j-v_i) [m2/s]") \
	F(press, double, scratch, "pressure force over the vector [N/m2]; before that products of stresses for the account") \
	F(first, double, scratch, "volume term, then square of the stress, friction's work, force x") \
	F(second, double, scratch, "(r/rest)^2, then normal stress before, coupling's work, force y") \
	F(third, double, scratch, "shear stress before, plastic work")
#define MCA_CONTACT_VECTOR(F, x, y, type, presence, text) F(x, type, presence, text) F(y, type, presence, text)

namespace mca::automata {
#define MCA_ARRAY(name, ...) #name " "
constexpr const char* automatonFieldNames = MCA_AUTOMATON_FIELDS(MCA_ARRAY);
constexpr const char* contactFieldNames   = MCA_CONTACT_FIELDS(MCA_ARRAY);
#undef MCA_ARRAY
}
