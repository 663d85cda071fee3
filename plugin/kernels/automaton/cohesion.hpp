// SPDX-License-Identifier: GPL-2.0-or-later
// Cohesion: a pair whose link has broken still pulls, less and less as it opens, until its fracture energy is spent. Formulation, equations (11f)-(11h).
#pragma once
#include "fracture.hpp"

namespace mca {
inline namespace MCA_SPACE {

/// A broken pair that has not parted yet. Its pull grows with the opening up to `first`, falls linearly from there to nothing at `last`; where it has been
/// wider before it goes along a straight line through the origin.
struct Bond {
	double rest      = 0; ///< distance of the pair at which it is closed [m]
	double stiffness = 0; ///< before it softens, in all directions [N/m2], in space [N/m]
	double first = 0, last = 0; ///< opening at which it softens, and at which it parts [m]
	double most = 0;            ///< widest so far [m]
};
/// Largest opening at which a pair may part, over its diameter [-]: one that broke under little pull would hold over any distance.
constexpr double widestBond = 0.5;

/// What follows from both ends of the link that breaks.
struct Breaking {
	Side<double> pull;      ///< force of the link, none where it pushes [N/m], in space [N]
	double       distance;  ///< [m]
	double       normal;    ///< normal part of the pull
	double       area;      ///< of the pair [m], in space [m2]
	double       diameter;  ///< [m]
	double       modulus;   ///< rho0 cP^2 of both [Pa]
	double       energy;    ///< G_f of both [J/m2]; 0: no cohesion
	Side<double> stress;    ///< force of the deviators
	double       pressure;  ///< of the pressures, along the pair, negative in tension
	double       lost;      ///< energy that the stresses of both sides lose as their contact starts without what pulls [J/m], in space [J]
};
/// (11g): area of a pair over its share of a crack along the closest rows, of which a pair of the packing crosses more than one.
inline double crackArea(double area) { return area / Lattice::facets; }
/// What a contact takes over of the stress of a side: what pushes along the pair.
inline Side<double> pushOnly(Side<double> side, Vec<double> r) { return withNormal({}, r, min(normalStress(side, r), 0.)); }
/// Energy that a side of a link of this weight loses on the way to pushOnly() of it in a contact; e, ePush: pairEnergy() of both [Pa].
inline double lostToBond(double d, double weight, double e, double ePush) { return Lattice::cell(d) / nLinks * (weight * e - weight * weight * ePush); }
/// pull: of the deviators of both sides, pressure: of both, over the area of the pair, r from the first to the second.
inline Breaking
breakingPair(Side<double> pull, Vec<double> r, double pressure, double area, double d, const Material& a, const Material& b, double lost)
{
	const double       distance = std::sqrt(plainSquare(r));
	const double       normal   = max(normalStress(pull, r) - pressure, 0.); // exactly nothing where the pair pushes
	const Side<double> whole    = withNormal(pull, r, normal);
	const auto         modulus  = [](const Material& m) { return m.eos.rho0 * sqr(m.cP()); };
	const double       energy   = min(a.fracture.energy, b.fracture.energy);
	return { whole, distance, normal, area, d, min(modulus(a), modulus(b)), energy, pull, pressure, lost };
}
/// Links that a script has cut, or whose automata have sheared past each other, hold nothing.
inline bool isCohesive(BreakCause cause) { return cause != BreakCause::cut && cause != BreakCause::collapsed; }
/// (11f): the area under the whole line, from the closed pair to the parted one, is G_f times the area of the crack; parts at once (first = 0) where there is
/// no cohesion, nothing pulls, or the elastic part alone exceeds that.
inline Bond startBond(const Breaking& b)
{
	const double pull = std::sqrt(plainSquare(b.pull)), stiffness = b.modulus * b.area / b.diameter;
	if (!(b.energy > 0 && pull > 0)) return {};
	const double first = pull / stiffness, last = min(2. * b.energy * crackArea(b.area) / pull, widestBond * b.diameter);
	if (!(last > first)) return {};
	return { b.distance - b.normal / stiffness, stiffness, first, last, first };
}
/// Largest spacing at which a strength [Pa] can be reached with G_f [J/m2]: with a larger one the elastic energy of a pair alone exceeds it [m].
inline double longestSpacing(double modulus, double energy, double strength) { return 2. * modulus * energy / (Lattice::facets * sqr(strength)); }
/// Throws Error where a strength of a pair of materials is too much for its fracture energy at this diameter [m].
inline void checkCohesion(const Material& a, const Material& b, double d, const PairRule& rule = {})
{
	const double energy = min(a.fracture.energy, b.fracture.energy), modulus = min(a.eos.rho0 * sqr(a.cP()), b.eos.rho0 * sqr(b.cP()));
	if (!(energy > 0)) return;
	const auto check = [&](const char* name, double strength) {
		if (!std::isfinite(strength) || d <= longestSpacing(modulus, energy, strength)) return;
		std::ostringstream s;
		s << "fractureEnergy = " << energy << " J/m2 with " << name << " = " << strength << " Pa and automata of diameter " << d
		  << " m: a pair would hold more than that when it breaks. Remedy: a diameter of at most " << longestSpacing(modulus, energy, strength)
		  << " m, or a strength of at most " << std::sqrt(2. * modulus * energy / (Lattice::facets * d))
		  << " Pa: cracks then need the same energy, and start at less stress.";
		throw Error(s.str());
	};
	for (const Fracture& f : { a.fracture, b.fracture }) {
		check("spallStrength", f.spall * rule.strength), check("pairStrength", f.pairStress);
		check("fractureStress / strengthRatio", f.mises / f.ratio * rule.strength);
	}
	check("pairStrength of the pair of materials", rule.tension);
}

/// Energy that it holds as the link breaks [J/m], in space [J].
inline double heldAtStart(const Bond& b) { return 0.5 * b.stiffness * sqr(b.first); }
/// What the last move has done against the pair and nothing keeps. The volumes at the break are those of all links: they have the work of the pressures as if
/// their force had acted to its end (affine; the other volume rules keep none of it). The deviators have none; where the pair pushes, its contact books their
/// half itself. What acts at the end of the move is the pull of what holds on, else nothing: half of the work comes from there.
/// u: relative displacement of the move [m].
inline double workAtBreak(const Breaking& b, Vec<double> r, Vec<double> u, bool affine, bool holdsOn)
{
	const auto   force    = [&](Side<double> side) { return contactForce(r, scaled(side, b.distance), 1. / sqr(b.distance), 0., 0.); };
	const double pressure = (affine ? b.pressure : -b.pressure) * dot(r, u) / b.distance;
	const double stress = holdsOn || b.normal > 0. ? dot(force(b.stress), u) : 0.;
	return 0.5 * (pressure + stress + (holdsOn ? dot(force(b.pull), u) : 0.));
}

/// Pull over the opening now [N/m2], in space [N/m].
MCA_INLINE double secant(const Bond& b)
{
	if (b.most <= b.first) return b.stiffness;
	return b.most < b.last ? b.stiffness * b.first * (b.last - b.most) / ((b.last - b.first) * b.most) : 0.;
}
/// Share of its fracture energy that is spent [-].
MCA_INLINE double shareSpent(const Bond& b) { return (min(b.most, b.last) - b.first) / (b.last - b.first); }
/// What opening it so far has cost [J/m], in space [J]: half of pull times `last` when it has parted.
MCA_INLINE double spent(const Bond& b) { return 0.5 * b.stiffness * b.first * b.last * shareSpent(b); }

/// Size of an opening [m]: what is closed along the pair does not count.
MCA_INLINE double wide(Side<double> opening, Vec<double> r) { return std::sqrt(plainSquare(withoutPush(opening, r))); }

/// Opening of a bond over the last move: r now [m], u = relative displacement of the move [m], spin: pairSpin(). Its normal part is that of the distance.
MCA_INLINE Side<double> opened(Side<double> before, double rest, Vec<double> r, Vec<double> u, Turn<double> spin)
{
	const Vec<double> m = fma(-0.5, u, r);
	return withNormal(advanced(before, r, u, spin, 0., std::sqrt(dot(m, m))), r, std::sqrt(dot(r, r)) - rest);
}
/// Energy that it holds now [J/m], in space [J].
inline double heldNow(const Bond& b, Side<double> opening, Vec<double> r) { return 0.5 * secant(b) * sqr(wide(opening, r)); }
/// What a bond does to its ends.
struct Pull {
	Vec<double>  force;         ///< on the first [N/m], in space [N]; the other has its negative
	Turn<double> torque, other; ///< [N], in space [N m]
};
/// Widens the bond to its opening and returns what it does; arm: of the first end.
MCA_INLINE Pull pullOf(Bond& b, Side<double> opening, Vec<double> r, double arm)
{
	const Side<double> w = withoutPush(opening, r);
	const double       r2 = dot(r, r);
	b.most                = max(b.most, wide(opening, r));
	const Side<double> both = scaled(w, secant(b) * std::sqrt(r2));
	const Vec<double>  F     = contactForce(r, both, 1. / r2, 0., 0.);
	return { F, contactTorque(arm, r, both, F), contactTorque(1. - arm, r, both, F) };
}
}
}
