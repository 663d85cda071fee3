// SPDX-License-Identifier: GPL-2.0-or-later
// Volume of an automaton from its links and contacts, and its pressure. Formulation, equations (5) and (6), and the affine rule.
#pragma once
#include "../lattice.hpp"
#include "../material.hpp"
#include "../volume_rule.hpp"

namespace mca {
inline namespace MCA_SPACE {

using mca::dispatch; // of laws, beside that of volume rules below

/// f(rule as a compile-time constant)
template <class F> MCA_INLINE auto dispatch(VolumeRule rule, F&& f)
{
	if (rule == VolumeRule::affine) return f(std::integral_constant<VolumeRule, VolumeRule::affine> {});
	if (rule == VolumeRule::inversePower) return f(std::integral_constant<VolumeRule, VolumeRule::inversePower> {});
	return f(std::integral_constant<VolumeRule, VolumeRule::meanDistance> {});
}
/// Contacts of the affine rule follow (5): the rule by which a pair that is no link adds to a volume.
constexpr VolumeRule ofContacts(VolumeRule rule) { return rule == VolumeRule::affine ? VolumeRule::inversePower : rule; }

/// det F0 of the links that measure a volume [-]. In the plane: three in a row or a star have 0.25; three with a gap have 0.17, two have 0.083: none.
/// In space: five links and more that are not in a plane, and the symmetric sets of four.
constexpr double minVolume = Lattice::minVolume;

/// What one pair adds to the sum of the volume rule [-]: (5) inversePower (d/r)^dim - 1; meanDistance r/d - 1 (the published mean linear strain).
template <VolumeRule rule> MCA_INLINE double volumeTerm(double d, double r2)
{
	if constexpr (rule == VolumeRule::meanDistance) return std::sqrt(r2) / d - 1.;
	else return Lattice::power(d, r2) - 1.;
}
/// J = Omega/Omega0 [-] from the mean of the volume terms.
template <VolumeRule rule> MCA_INLINE double volumeRatio(double meanTerm)
{
	const double q = 1. + meanTerm;
	if constexpr (rule == VolumeRule::inversePower) return 1. / q;
	else return q * q;
}
/// The mean of the volume terms that makes J [-].
template <VolumeRule rule> MCA_INLINE double meanTerm(double J)
{
	if constexpr (rule == VolumeRule::inversePower) return 1. / J - 1.;
	else return std::sqrt(J) - 1.;
}
/// (6), one side's share h [N/m]: the repulsive pair force is (h_i + h_j) pressureShape() times the vector i -> j.
/// omegaPerN = Omega0_i / N_i [m2], P [Pa], J [-].
template <VolumeRule rule> MCA_INLINE double pressureShare(double P, double J, double omegaPerN)
{
	if constexpr (rule == VolumeRule::inversePower) return P * J * J * omegaPerN * Lattice::dim;
	else return P * omegaPerN * Lattice::dim * std::sqrt(J);
}
template <VolumeRule rule> MCA_INLINE double pressureShape(double d, double invR2)
{
	if constexpr (rule == VolumeRule::meanDistance) return std::sqrt(invR2) / d;
	else return Lattice::shape(d, invR2);
}

/// det F of links with this sum of r (x) e_k; perVolume: of the lattice.
template <class T> MCA_INLINE T linkDeterminant(const Tensor<T>& sum, double perVolume) { return determinant(sum) * perVolume; }

/// What the volume of an automaton needs of its material and diameter; law: kind of its equation of state.
template <EosKind law> struct VolumeConstants {
	Eos    eos;
	double d2;      ///< diameter squared [m2]
	double perVolume, perSlope; ///< of the lattice
	double G43;     ///< 4 G/3 [Pa]
	double perRho;  ///< 1/rho0 [m3/kg]
	double clampAt; ///< volume strain at which the equation of state is clamped [-]
	VolumeConstants(const Material& m, double d)
		: eos(m.eos)
		, d2(d * d)
		, perVolume(Lattice::perVolume(d))
		, perSlope(Lattice::perSlope(d))
		, G43(m.G * (4. / 3.))
		, perRho(1. / m.eos.rho0)
		, clampAt(LawOf<law>::clampStrain(m.eos))
	{
	}
};

/// Pressure and internal energy at a new volume.
struct PressureState {
	double P; ///< [Pa]
	double e; ///< internal energy per mass, where the equation of state needs it [J/kg]
};
/// J: new volume ratio, Jo: that of the step before, old: pressure and energy then. ofLinks: the volume is that of links. Contacts push by the cold curve
/// alone: so does an automaton without links work, and its internal energy keeps the rest.
template <EosKind law> MCA_INLINE PressureState pressureStep(const VolumeConstants<law>& c, double J, double Jo, PressureState old, bool ofLinks)
{
	PressureState now { pressure<law>(c.eos, J - 1.), old.e };
	if constexpr (LawOf<law>::heats) {
		double       e   = old.e;
		const double hot = pressureWithWork<law>(c.eos, J - 1., J - Jo, old.P, e), work = 0.5 * (old.P + now.P) * (J - Jo) * c.perRho;
		now = { ofLinks ? hot : now.P, ofLinks ? e : old.e - work };
	}
	return now;
}
/// Increment of the volume strain over a step, at its middle [-].
MCA_INLINE double dilation(double J, double Jo) { return 2. * (J - Jo) / (J + Jo); }
MCA_INLINE bool   validVolume(double J) { return J > 0. && J < 1e6; } // false for NaN as well
/// (3) over the density: square of a longitudinal wave's speed in the rest frame [m2/s2]; bulk, shear >= 1: how much stiffer than in the perfect packing.
template <EosKind law> MCA_INLINE double stiffness(const VolumeConstants<law>& c, double J, double bulk = 1., double shear = 1.)
{
	return (tangent<law>(c.eos, J - 1.) * bulk + c.G43 * shear) * c.perRho / J;
}

/// What contacts push with is the face of an automaton, not its mass: at a flat outline that of a whole cell [m2]. Debris, which has its volume from them, has
/// what it weighs. cell: Omega0 times weight, factor: of the links' volume.
MCA_INLINE double contactCell(double d, double cell, double factor) { return factor > 0. ? min(Lattice::cell(d), 2. * cell) : cell; }
/// The volume that contacts alone give an automaton [-]; sum of their volume terms.
MCA_INLINE double contactRatio(double sum) { return 1. / fma(sum, 1. / nLinks, 1.); }

// ---- the affine rule: F = sum r (x) e_k / (spread d), J = factor det F + rest. Exact in any homogeneous deformation of any arrangement of two or more links
// that are not in a line, and without geometric stiffness under pressure. Contacts have a volume of their own, by rule (5): it pushes from the first touch,
// whatever the links hold; an automaton without links has no other.

/// State of rest of an automaton's links.
struct AffineRest {
	double factor; ///< J = factor det F + rest; 0: too few links to have a volume
	double rest;   ///< last bit of J = 1 at rest: no pressure, whether asleep or awake
};
/// sum = sum of r (x) e_k at rest [m].
template <EosKind law> MCA_INLINE AffineRest affineRest(const VolumeConstants<law>& c, const Tensor<double>& sum)
{
	const double det = linkDeterminant(sum, c.perVolume), factor = det > minVolume ? 1. / det : 0.;
	return { factor, factor > 0. ? 1. - factor * det : 0. };
}
/// J by the links (det: linkDeterminant()), or by the contacts (sum of their volume terms) where the links have none.
MCA_INLINE double affineRatio(double det, double factor, double rest, double contactSum)
{
	return factor > 0. ? factor * det + rest : contactRatio(contactSum);
}
template <EosKind law> MCA_INLINE double affineRatio(const VolumeConstants<law>& c, const Tensor<double>& sum, double factor, double rest, double contactSum)
{
	return affineRatio(linkDeterminant(sum, c.perVolume), factor, rest, contactSum);
}
/// The factor with which other links measure the volume J; det: linkDeterminant() of these links.
MCA_INLINE double affineFactor(double J, double rest, double det) { return det > minVolume && J > 0. ? (J - rest) / det : 0.; }
/// A pressure P pushes link k by P cell affinePush() e_k [N/m]: P dV/dr, V = cell J. [1/m]
template <EosKind law, class T> MCA_INLINE Tensor<T> affinePush(const VolumeConstants<law>& c, const Tensor<T>& sum, T factor)
{
	return cofactor(sum) * (factor * c.perVolume);
}
/// Sum of (dJ/dr_k)^2 over the links, over that of the perfect packing, at least 1 [-]: how much more the volume feels the motion of neighbours. directions:
/// sum of e_k (x) e_k.
template <EosKind law, class T> MCA_INLINE T volumeSlope(const VolumeConstants<law>& c, const Tensor<T>& F, const Symmetric<T>& e, T factor)
{
	return max(factor * factor * squareOfPushes(F, e) * c.perSlope * (1. / nLinks), T {} + 1.);
}
/// How much stiffer sound is at outlines than inside, over the slope of the volume: covers every body of triangles, of which a single one is the stiffest.
constexpr double atOutlines = 2.1;
/// stiffness(), and how much stiffer than in the perfect packing: the volume by its slope, the pair law by the closest link, nearest2 = smallest r^2 [m2].
/// Covers edges and corners of free surfaces up to nu = 0.49, measured; beyond 4 what is torn and sheared. At an outline light automata move light ones: see
/// atOutlines.
template <EosKind law> MCA_INLINE double affineStiffness(const VolumeConstants<law>& c, double J, double slope, double nearest2, bool outline)
{
	const double inBody = max(min(slope * slope, 4.), slope);
	const double shear  = max(0.5 * c.d2 / nearest2, 1.);
	return stiffness<law>(c, J, outline ? atOutlines * slope : inBody, outline ? atOutlines * shear : shear);
}
}
}
