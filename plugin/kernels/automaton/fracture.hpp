// SPDX-License-Identifier: GPL-2.0-or-later
// When a link breaks, and what becomes of the volume that it has measured: a break changes no volume and creates no energy.
#pragma once
#include "contact.hpp"

namespace mca {
inline namespace MCA_SPACE {

constexpr int breakPeriod = 4; ///< steps between two tests for breaking links

/// The criteria of a material as factors.
struct Criteria {
	double perStrain, perSpall, perMises; ///< 1 over the limit [-], [1/Pa], [1/Pa]
	double ofMises, ofPressure;           ///< two-parameter criterion: ofMises sigma_eq - ofPressure P
	explicit Criteria(const Fracture& f)
	        : perStrain(1. / f.strain), perSpall(1. / f.spall), perMises(1. / f.mises), ofMises(0.5 * (f.ratio + 1.)), ofPressure(1.5 * (f.ratio - 1.))
	{
	}
};
/// The largest criterion of an automaton over its limit [-]; a pair breaks at a mean of 1.
MCA_INLINE double criterion(const Criteria& c, double eqps, double P, double equivalentStress, double strength)
{
	const double one = max(eqps * c.perStrain, -P * c.perSpall);
	return max(one, fma(c.ofMises, equivalentStress, -c.ofPressure * P) * c.perMises) / strength;
}

/// The same where flow damages, too: damage 1 is the limit.
MCA_INLINE double criterion(double ofOthers, double damage, double strength) { return max(ofOthers, damage / strength); }

/// One end of a link that is tested.
struct LinkEnd {
	double criterion, s, J, P, strength; ///< s: J times the normal stress of this side [Pa]
};
/// rule: of the pair of materials.
inline bool breaks(const Fracture& f, const LinkEnd& a, const LinkEnd& b, double r2, double d, const PairRule& rule = {})
{
	if (0.5 * (a.criterion + b.criterion) >= rule.strength) return true;
	if (r2 < sqr(collapsed * d)) return true; // sheared so far that the packing is gone: what follows is contact
	const double limit = min(f.pairStress, rule.tension);
	if (!std::isfinite(limit)) return false;
	const double tension = 0.5 * (a.s / a.J + b.s / b.J - a.P - b.P); // mean of both sides
	return tension >= 0.5 * limit * (a.strength + b.strength);
}

/// Whether it breaks by nothing else than that it is sheared past its packing.
inline bool collapses(const LinkEnd& a, const LinkEnd& b, double r2, double d, const PairRule& rule)
{
	return !(0.5 * (a.criterion + b.criterion) >= rule.strength) && r2 < sqr(collapsed * d);
}
/// Why a link broke; the first four are the criteria of automata.
enum class BreakCause : int32_t { plasticStrain, spall, stress, damage, pairStress, collapsed, cut };
constexpr int breakCauses = 7;
/// Criteria of an automaton apart, in the order of BreakCause [-].
struct CriteriaApart {
	double of[4];
	CriteriaApart(const Criteria& c, double eqps, double P, double equivalentStress, double damage, double strength)
		: of { eqps * c.perStrain / strength, -P * c.perSpall / strength,
		       fma(c.ofMises, equivalentStress, -c.ofPressure * P) * c.perMises / strength, damage / strength }
	{
	}
};
/// Of a link that breaks: the criterion with the largest mean where the mean of the ends' largest reaches the limit, else what breaks() asks next.
inline BreakCause causeOf(
	const LinkEnd& a, const LinkEnd& b, const CriteriaApart& ofA, const CriteriaApart& ofB, double r2, double d, const PairRule& rule = {})
{
	if (collapses(a, b, r2, d, rule)) return BreakCause::collapsed;
	if (!(0.5 * (a.criterion + b.criterion) >= rule.strength)) return BreakCause::pairStress;
	int most = 0;
	for (int k = 1; k < 4; k++)
		if (ofA.of[k] + ofB.of[k] > ofA.of[most] + ofB.of[most]) most = k;
	return BreakCause(most);
}

/// Sum of the volume rule at rest with which the links that are left go on at the volume J; sum: of what they and the contacts measure now.
template <VolumeRule rule> inline double restKeeping(double J, double sum, double invN) { return sum - meanTerm<rule>(J) / invN; }

/// An automaton that has lost its volume has it from its contacts alone. Under pressure their rest distances are set so that the pressure goes on;
/// tension cannot: it is released. With the affine rule contacts have had a volume of their own: the more compressed of the two goes on.
struct Settling {
	bool   holds; ///< the contacts take the volume over
	double need;  ///< volume term that each near contact must have [-]
	/// J: volume to take over; Jc: that of the contacts; near: contacts about as near as in the packing.
	Settling(VolumeRule rule, double J, double Jc, int near, double invN)
		: holds(near >= Lattice::volumeLinks && J < Jc)
		, need((rule == VolumeRule::meanDistance ? meanTerm<VolumeRule::meanDistance>(J) : meanTerm<VolumeRule::inversePower>(J))
		       / (near * (rule == VolumeRule::affine ? 1. / nLinks : invN))) // contactRatio()
	{
	}
	/// Only neighbours about as near as in the packing can take over: a far one would push across a gap.
	static bool isNear(double r, double d) { return r < 1.1 * d; }
	/// Rest distance of a contact at distance r [m].
	double restDistance(VolumeRule rule, double r, double d) const
	{
		if (!holds || !isNear(r, d)) return min(r, d);
		return rule == VolumeRule::meanDistance ? r / (1. + need) : r * Lattice::stretch(1. + need);
	}
};
}
}
