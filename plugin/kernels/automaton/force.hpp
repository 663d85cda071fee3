// SPDX-License-Identifier: GPL-2.0-or-later
// Force of a pair from the pressures and stresses of both sides, and artificial viscosity. Formulation, equations (6), (12) and (12a).
// r = x_j - x_i; forces are those on i, j has their negatives.
#pragma once
#include "deviator.hpp"
#include "volume.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// Half of S r = S0 d J [m2]: with stresses kept as J times them, exactly the Cauchy stress in any homogeneous deformation. weight: 1, 1/2 on a weighted rim.
template <class T> MCA_INLINE T pairArea(T weight, T d) { return 0.5 * weight * Lattice::area(d); }

/// (12): viscous pair force over the vector i -> j [N/m]: negative (repulsive) when approaching, zero in expansion.
/// along = r.(v_j-v_i) [m2/s]; linear = rho c1 c [Pa s/m], quadratic = rho c2 [Pa s2/m2], width = contact width [m].
template <class T> MCA_INLINE T viscousCoefficient(T along, T invR2, double linear, double quadratic, double width)
{
	const T a = min(along, 0.);
	return fma(-quadratic * a, root(invR2), linear) * a * invR2 * width;
}
/// What artificial viscosity needs of a pair.
struct PairViscosity {
	double linear, quadratic; ///< [Pa s/m], [Pa s2/m2]
};
MCA_INLINE PairViscosity viscosityOf(const Material& m) { return { m.viscosity.linear * m.eos.rho0 * m.eos.c0, m.viscosity.quadratic * m.eos.rho0 }; }
/// The smaller of both sides' coefficients: a heavy neighbour must not overdamp a light automaton.
MCA_INLINE PairViscosity viscosityOf(const Material& a, const Material& b, const PairRule& rule)
{
	const PairViscosity p = viscosityOf(a), q = viscosityOf(b);
	return { min(p.linear, q.linear) * rule.viscosity, min(p.quadratic, q.quadratic) * rule.viscosity };
}
/// Coulomb coefficient of a pair.
inline double frictionOf(const Material& a, const Material& b, const PairRule& rule)
{
	return rule.friction >= 0. ? rule.friction : min(a.friction, b.friction);
}
/// Of a link: in the affine rule the quadratic part is that of the volume, (12a). The linear one stays beside it: links of a material with little strength
/// collapse without, at unchanged volume.
MCA_INLINE PairViscosity ofLink(PairViscosity p, VolumeRule rule) 
{
	return { Lattice::linkViscosity * p.linear, rule == VolumeRule::affine ? 0. : p.quadratic };
}
/// (12a): viscous pressure of an automaton of the affine rule.
struct BulkViscosity {
	double linear, quadratic; ///< times the increment of the volume strain and its square: over one move [Pa]
	double bulk;              ///< rho0 c0^2 [Pa]
	/// perMove = 1/length of the last move [1/s]; zero: no viscosity
	BulkViscosity(const Material& m, double d, double perMove)
		: linear(m.viscosity.linear * m.eos.rho0 * m.eos.c0 * (d * perMove))
		, quadratic(m.viscosity.quadratic * m.eos.rho0 * sqr(d * perMove))
		, bulk(m.eos.bulkModulus())
	{
	}
	/// slope: volumeSlope(); the length over which a volume is measured shrinks with it, and so the damping stays that of the perfect packing.
	/// tangent: dP/d(-eps) now [Pa]; the linear part has the impedance of sound in what is compressed, since a strong shock is damped by its end, too.
	double pressure(double dilation, double slope, double tangent) const
	{
		const double a = min(dilation, 0.);
		return fma(quadratic / slope * a, a, -linear * std::sqrt(max(tangent, 0.) / (bulk * slope)) * a);
	}
};
/// Its heat over a move, per volume at rest [J/m3].
MCA_INLINE double viscousWork(double q, double dilation, double J) { return -2. * q * J * dilation / (2. + dilation); }
/// Pairs of these materials have the same constants.
inline bool samePairs(const Material& a, const Material& b)
{
	return a.G == b.G && a.friction == b.friction && a.eos.rho0 == b.eos.rho0 && a.eos.c0 == b.eos.c0 && a.viscosity.linear == b.viscosity.linear
		&& a.viscosity.quadratic == b.viscosity.quadratic;
}

}
}
