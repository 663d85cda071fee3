// SPDX-License-Identifier: GPL-2.0-or-later
// What the solver keeps of an automaton and of a contact, each quantity once. The arrays, the saved state with its version, sorting, the lengths that are
// checked after loading and McaEngine.field() follow from these rows. The rows of vectors hold the names of their components in saved states and for scripts;
// nothing else in this folder knows how many there are.
#pragma once
#include "../kernels/dimension.hpp"
#include <cstdint>
#if MCA_DIM == 2
#include "plane/fields.hpp"
#else
#include "space/fields.hpp"
#endif

/// F(name, type, presence, shown, text), V(name, presence, scripts, text, names of the components); presence: `always` an entry per automaton, `whenUsed`:
/// empty in scenes without it; shown: name for McaEngine.field(), "" for none; scripts: whether it shows the components. SI units, in the plane per thickness.
#define MCA_AUTOMATON_FIELDS(F, V) \
	F(factor, double, always, "", "affine rule: J of the links = factor det F; 0 = too few links to have a volume [-]") \
	V(position, always, shown, "[m]", MCA_COMPONENTS("x", "y", "z")) \
	V(velocity, always, shown, "[m/s]", MCA_COMPONENTS("vx", "vy", "vz")) \
	MCA_TURN(F, V, omega, always, "omega", shown, "spin [rad/s]") \
	MCA_TURN(F, V, angle, always, "angle", hidden, "turned angle, about each axis [rad]") \
	F(mass, double, always, "mass", "[kg/m]") \
	F(inertia, double, always, "", "[kg m]") \
	V(perMass, always, hidden, "1/mass [m/kg]; zero where the degree of freedom is blocked", MCA_COMPONENTS("perMassX", "perMassY", "perMassZ")) \
	MCA_TURN(F, V, perInertia, always, "", hidden, "1/inertia [1/(kg m)]; zero where it is blocked") \
	F(diameter, double, always, "diameter", "[m]") \
	F(cell, double, always, "", "Omega0 [m2]") \
	F(invN, double, always, "", "1/N of the volume rule [-]") \
	F(rest, double, always, "", "sum of the volume rule at rest [-]") \
	F(J, double, always, "volumeRatio", "volume ratio [-]") \
	F(dTheta, double, always, "", "last increment of the volume strain [-]") \
	F(P, double, always, "", "pressure of the equation of state [Pa]") \
	F(mean, double, always, "pressure", "mean pressure: P, in the affine rule with the part of (5f) [Pa]") \
	F(viscous, double, always, "", "viscous pressure (12a) of the last move [Pa]") \
	F(h, double, always, "", "pressure share of (6) [N/m]") \
	MCA_DEVIATORS(F) \
	F(eqps, double, always, "plasticStrain", "equivalent plastic strain [-]") \
	F(temperature, double, always, "temperature", "[K]") \
	F(strength, double, always, "strength", "factor on the fracture criteria [-]") \
	F(criterion, double, always, "", "largest criterion / its limit [-]; a pair breaks at a mean of 1") \
	F(heat, double, whenUsed, "", "internal energy per mass, where a law heats [J/kg]") \
	F(damage, double, whenUsed, "damage", "of plastic flow, where some material has a damage model (11e) [-]") \
	V(force, always, shown, "of the last computeForces() [N/m]", MCA_COMPONENTS("fx", "fy", "fz")) \
	MCA_TURN(F, V, torque, always, "", hidden, "torque of it [N]") \
	V(outside, whenUsed, hidden, "force from outside [N/m]", MCA_COMPONENTS("outsideX", "outsideY", "outsideZ")) \
	MCA_TURN(F, V, outsideTorque, whenUsed, "", hidden, "torque from outside [N]") \
	V(damp, whenUsed, hidden, "viscous boundary rho c A [kg/(m s)]", MCA_COMPONENTS("dampX", "dampY", "dampZ")) \
	F(weight, double, always, "weight", "share of the full cell [-]") \
	MCA_MIRRORS(V) \
	F(flags, Flags, always, "", "Flag bits") \
	F(id, int32_t, always, "", "caller's number, -1: padding") \
	F(group, int32_t, always, "", "link group")

/// F(name, type, presence, text), V(name, presence, text, names) per half-contact; presence: `saved`, or `scratch`: filled anew by each step.
#define MCA_CONTACT_FIELDS(F, V) \
	F(owner, int32_t, saved, "automaton whose side this is") \
	F(other, int32_t, saved, "automaton at the other side") \
	F(reverse, int32_t, saved, "place of the other half") \
	MCA_CONTACT_SIDES(F, V) \
	F(rest, double, saved, "rest distance of this side: that of the two automata, or less when they came into contact already closer [m]") \
	F(d, double, saved, "mean diameter [m]") \
	F(twoG, double, saved, "2G of the pair [Pa]") \
	F(friction, double, saved, "[-]") \
	F(viscLinear, double, saved, "linear coefficient of (12) [kg/(m2 s)]") \
	F(viscQuadratic, double, saved, "quadratic coefficient of (12) [kg/m3]") \
	F(arm, double, saved, "arm of the owner over the distance [-]") \
	MCA_CONTACT_BEFORE(F, V) \
	F(perTwoG, double, scratch, "1/twoG [1/Pa]; 0 where that is zero") \
	F(perOwnG, double, scratch, "1/G of the owner's material [1/Pa]; 0 where that is zero") \
	V(between, scratch, "from owner to other in this step [m], then the force on the owner [N/m]", MCA_COMPONENTS("dx", "dy", "dz")) \
	F(r2, double, scratch, "its square [m2]") \
	F(pushing, double, scratch, "1 where this side pushes, else 0") \
	F(touch, double, scratch, "1 where any side pushes, else 0") \
	F(along, double, scratch, "(x_j-x_i).(v_j-v_i) [m2/s]") \
	F(press, double, scratch, "pressure force over the vector [N/m2]; before that products of stresses for the account") \
	F(first, double, scratch, "volume term, then square of the stress, friction's work") \
	F(second, double, scratch, "(r/rest)^2, then normal stress before, coupling's work") \
	F(third, double, scratch, "shear stress before, plastic work")

/// F(name, type, presence, text), V(name, presence, text, names) per broken pair that still holds together (Bond), saved.
#define MCA_BOND_FIELDS(F, V) \
	F(first, int32_t, saved, "number of one automaton") \
	F(second, int32_t, saved, "of the other") \
	MCA_BOND_SIDES(F, V) \
	F(rest, double, saved, "distance at which it is closed [m]") \
	F(stiffness, double, saved, "before it softens [N/m2]") \
	F(from, double, saved, "opening from which on it softens [m]") \
	F(until, double, saved, "opening at which it parts [m]") \
	F(most, double, saved, "widest opening so far [m]")

/// F(name, presence, text), V(name, presence, text, names) per automaton: sums over its contacts, saved; presence: `always` in scenes with contacts,
/// `whenUsed`: for the account only.
#define MCA_CONTACT_SUMS(F, V) \
	F(sum, always, "volume terms [-]") \
	F(square, always, "squares of the stresses [Pa2]") \
	F(old, whenUsed, "products of the stresses before the step and the trial stresses [Pa2]") \
	F(scale, always, "M of the radial return, for its contacts [-]") \
	V(force, always, "[N/m]", MCA_COMPONENTS("fx", "fy", "fz")) \
	MCA_TURN_SUM(F, V, torque, always, "[N]") \
	V(volumetric, whenUsed, "share of the force [N/m]", MCA_COMPONENTS("volX", "volY", "volZ")) \
	V(viscous, whenUsed, "share of the force [N/m]", MCA_COMPONENTS("visX", "visY", "visZ"))

namespace mca::automata {
/// Whether an array is there in every scene, and whether it is part of the saved state.
enum class Presence { always, whenUsed, saved, scratch };
/// Whether McaEngine.field() shows a vector.
enum class Scripts { shown, hidden };

#define MCA_NUMBER(name, ...) #name,
#define MCA_VECTOR(name, presence, scripts, text, ...) __VA_ARGS__,
constexpr const char* automatonFieldNames[] = { MCA_AUTOMATON_FIELDS(MCA_NUMBER, MCA_VECTOR) };
#undef MCA_VECTOR
#define MCA_VECTOR(name, presence, text, ...) __VA_ARGS__,
constexpr const char* contactFieldNames[] = { MCA_CONTACT_FIELDS(MCA_NUMBER, MCA_VECTOR) };
constexpr const char* bondFieldNames[]    = { MCA_BOND_FIELDS(MCA_NUMBER, MCA_VECTOR) };
constexpr const char* contactSumNames[]   = { MCA_CONTACT_SUMS(MCA_NUMBER, MCA_VECTOR) };
#undef MCA_VECTOR
#undef MCA_NUMBER
/// Vectors that the solver keeps beside these rows, in the order of Solver::archive().
constexpr const char* solverVectorNames = MCA_SOLVER_VECTORS;
}
