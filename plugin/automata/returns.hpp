// SPDX-License-Identifier: GPL-2.0-or-later
// Radial returns of a block, for the passes over stresses.
#pragma once
#include "../kernels/automaton/fracture.hpp"
#include "view.hpp"

namespace mca::automata {

/// Radial return of each automaton of a block.
struct Returns {
	alignas(64) double trial[blockSize], scale[blockSize], flow[blockSize];
	Return             of(int l) const { return { scale[l], flow[l] }; }
};
/// (11e) of all, and what it makes of their criteria; sigma: Mises stresses after the return. The largest criterion.
inline double growDamage(const BlockView& V, const Returns& R, const double* sigma, double dt)
{
	const DuctileDamage c     = V.material.fracture.damage;
	const Yield         yield = V.material.yield;
	double              worst = 0, flow = 0;
	for (int l = 0; l < blockSize; l++) flow = max(flow, R.flow[l]);
#pragma omp simd
	for (int l = 0; l < (flow > 0. ? blockSize : 0); l++)
		V.damage[l] += damageGrowth(c, yield, R.flow[l], V.mean[l], sigma[l], V.temperature[l], dt);
#pragma omp simd reduction(max : worst)
	for (int l = 0; l < blockSize; l++) {
		V.criterion[l] = criterion(V.criterion[l], V.damage[l], V.strength[l]);
		worst          = max(worst, V.flags[l] & linkBits ? V.criterion[l] : 0.);
	}
	return worst;
}
/// Radial return of a dear law for eight automata, if any of them is above its static yield stress; else they stay elastic.
template <YieldKind kind> void returnWhereAbove(const BlockView& V, double threeG, double dt, int g, Returns& to)
{
	const Yield&       yield = V.material.yield;
	alignas(64) double stress[lanes], slope[lanes];
	double             over = 0;
#pragma omp simd reduction(max : over)
	for (int l = 0; l < lanes; l++) {
		const StaticYield s = staticYield<kind>(yield, V.eqps[g + l], V.temperature[g + l]);
		stress[l] = s.stress, slope[l] = s.slope;
		over = max(over, to.trial[g + l] - s.stress);
	}
	if (!(over > 0.)) return;
#pragma omp simd
	for (int l = 0; l < lanes; l++) {
		const Return r = radialReturn<kind>(
			yield, StaticYield { stress[l], slope[l] }, to.trial[g + l], V.eqps[g + l], V.temperature[g + l], threeG, dt);
		to.scale[g + l] = r.scale, to.flow[g + l] = r.dEqps;
	}
}
/// (11) of all, whose trial stresses are there; most: the largest of them, hottest: the highest temperature.
template <YieldKind kind> MCA_INLINE void returnAll(const BlockView& V, double most, double hottest, double dt, Returns& to)
{
	const Yield  yield  = V.material.yield;
	const double threeG = 3. * V.material.G;
	// logarithms and powers are most of the cost: not where nobody reaches the yield stress of unstrained material at the highest temperature
	if constexpr (LawOf<kind>::isDear) {
		std::fill(to.scale, to.scale + blockSize, 1.), std::fill(to.flow, to.flow + blockSize, 0.);
		if (most > staticYield<kind>(yield, 0., hottest).stress)
			for (int g = 0; g < blockSize; g += lanes)
				returnWhereAbove<kind>(V, threeG, dt, g, to);
	} else
#pragma omp simd
		for (int l = 0; l < blockSize; l++) {
			const Return r = radialReturn<kind>(yield, to.trial[l], V.eqps[l], LawOf<kind>::heats ? V.temperature[l] : 0., threeG, dt);
			to.scale[l] = r.scale, to.flow[l] = r.dEqps;
		}
}
}
