// SPDX-License-Identifier: GPL-2.0-or-later
// Which pairs are contacts, and what a new one starts with: the same for a list that is made anew and for one that is added to.
#pragma once
#include "contacts.hpp"

namespace mca::automata {

inline bool linked(const Store& S, int32_t i, int32_t j)
{
	for (int k = 0; k < nLinks; k++)
		if (holds(S.flags[i], k) && S.neighbour[linkSlot(i, k)] == j) return true;
	return false;
}
inline bool touching(const Store& S, int32_t i, int32_t j) { return mayTouch(S.flags[i], S.flags[j], S.group[i] == S.group[j]); }
/// Pairs that are no contacts though they may touch.
inline bool heldApart(const Store& S, int32_t i, int32_t j)
{
	const auto of = [&](int32_t a) { return [&S, a](int k) { return S.neighbour[linkSlot(size_t(a), k)]; }; };
	return linked(S, i, j) || heldByNeighbour(i, S.flags[i], S.factor[i], of(i), j, S.flags[j], S.factor[j], of(j));
}
/// Square of the distance from which on a pair is not listed [m2].
inline double reach2(const Store& S, int32_t i, int32_t j, double skin) { return sqr(S.restDistance(i, j) * (1. + skin)); }
/// That of the largest automata [m], and a little more: round-off must not decide what is looked at.
inline double longestReach(const Store& S, double skin) { return S.largestDiameter() * (1. + skin) * (1. + 1e-9); }

/// What a pair of species has in common.
struct PairConstants {
	double d, arm, twoG, friction, viscLinear, viscQuadratic, perTwoG, perOwnG;
};
inline double reciprocal(double v) { return v > 0. ? 1. / v : 0.; }
inline std::vector<PairConstants> pairConstants(const Store& S)
{
	std::vector<PairConstants> table;
	for (const Species& a : S.species)
		for (const Species& b : S.species) {
			const Material &    m = S.materials[a.material], &o = S.materials[b.material];
			const PairRule&     rule = S.pairRules.of(a.material, b.material);
			const PairViscosity v    = viscosityOf(m, o, rule);
			const double        q = arm(a.d, b.d), twoG = seriesTwoG(m.G, o.G, q);
			table.push_back(
				{ 0.5 * (a.d + b.d), q, twoG, frictionOf(m, o, rule), v.linear, v.quadratic, reciprocal(twoG), reciprocal(m.G) });
		}
	return table;
}
/// Half-contact c of its owner and other, without stress.
inline void start(const Store& S, const std::vector<PairConstants>& table, Contacts& C, size_t c)
{
	const int32_t        i = C.owner[c], j = C.other[c];
	const PairConstants& p = table[size_t(S.speciesOf(i)) * S.species.size() + S.speciesOf(j)];
	setSide(C, c, Side<double> {});
	C.d[c] = p.d, C.rest[c] = restAtStart(p.d, S.distance2(i, j));
	C.arm[c] = p.arm, C.twoG[c] = p.twoG, C.friction[c] = p.friction, C.viscLinear[c] = p.viscLinear, C.viscQuadratic[c] = p.viscQuadratic;
	C.perTwoG[c] = p.perTwoG, C.perOwnG[c] = p.perOwnG;
}
/// Takes over the stress of a link that has just broken.
inline void takeLinkStress(const Store& S, Contacts& C, size_t c)
{
	const int32_t i = C.owner[c], j = C.other[c];
	for (int k = 0; k < nLinks; k++)
		if (hasHeld(S.flags[i], k) && !holds(S.flags[i], k) && S.neighbour[linkSlot(i, k)] == j) setSide(C, c, S.stressAt(linkSlot(i, k)));
}
}
