// SPDX-License-Identifier: GPL-2.0-or-later
// Pass 1 in space: volume of each automaton from its links, pressure, and what it pushes its neighbours with.
#include "../../kernels/automaton/force.hpp"
#include "../../kernels/automaton/limit.hpp"
#include "../../kernels/space/stiffness.hpp"
#include "../passes.hpp"
#include "../view.hpp"

namespace mca::automata {
namespace {
	/// Sums over the links.
	struct LinkSums {
		TensorLanes<blockSize>    dyads;        ///< of r (x) e_k [m]
		SymmetricLanes<blockSize> directions;   ///< of e_k (x) e_k; not filled where all links hold
		alignas(64) double nearest2[blockSize]; ///< smallest (r/d)^2 [-]
	};
	/// Not inlined: once for all laws.
	template <bool intact, bool mixed> __attribute__((noinline)) void sumLinks(const BlockView& V, LinkSums& to)
	{
		for (int g = 0; g < blockSize; g += lanes) {
			const Vec<v8> own = load(V.position, g), none {};
			const m8      bits = intact ? m8 {} : widen(V.flags + g);
			Tensor<v8>    sum = {};
			Symmetric<v8> e = {};
			v8            nearest = splat(1e300);
#pragma GCC unroll 12
			for (int k = 0; k < nLinks; k++) {
				const m8       on = holding(bits, k);
				const int32_t* j  = V.others(k, g);
				const Vec<v8>  r  = choose<intact>(on, gatherPosition(V.node, j) - own, none);
				v8             perD2 = splat(1. / (V.d * V.d));
				if (mixed)
					for (int l = 0; l < lanes; l++) perD2[l] = 1. / sqr(0.5 * (V.d + V.diameterOfAll[j[l]]));
				nearest = min(nearest, choose<intact>(on, dot(r, r) * perD2, splat(1.)));
				const v8 w = weights<intact>(bits, k);
				if (!intact) addDirection(e, k, on ? w : splat(0.));
				addDyad(sum, k, intact ? r : r * w);
			}
			to.dyads.setLanes(g, sum), store(to.nearest2 + g, nearest);
			if (!intact) to.directions.setLanes(g, e);
		}
	}
	/// Sums of automata that end at faces made those of full stars (S8), and those at planes of symmetry (S9).
	void completeStars(const BlockView& V, LinkSums& to)
	{
		for (int l = 0; l < blockSize; l++) {
			if (!(V.flags[l] & halfBits) && !isMirrored(V.store, V.base + size_t(l))) continue;
			const double   per = 1. / shareOfStar(V.flags[l], V.weight[l]);
			Tensor<double> F = to.dyads.at(l) * per;
			Symmetric<double> e = to.directions.at(l) * per;
			if (hasMirrors(V.store))
				eachMirror(V.store, V.base + size_t(l), [&](int axis, Vec<double> normal) { mirror(F, axis, normal), mirror(e, normal); });
			to.dyads.set(l, F), to.directions.set(l, e);
		}
	}
	/// What follows from the sums alone. In loops of its own, eight automata at once: in that over single ones tensors would keep it from being vectorised.
	struct Shape {
		alignas(64) double det[blockSize], slope[blockSize], bulk[blockSize], shear[blockSize]; ///< linkDeterminant(), volumeSlope(), stiffening()
	};
	/// Fills the record of pushes, too: affinePush().
	template <bool intact, EosKind law> void shapes(const BlockView& V, const VolumeConstants<law>& c, const LinkSums& L, Shape& to)
	{
		for (int g = 0; g < blockSize; g += lanes) {
			const Tensor<v8>    F = L.dyads.lanes(g);
			const Symmetric<v8> e = intact ? isotropic(splat(Lattice::spread)) : L.directions.lanes(g);
			const v8            factor = load(V.factor + g);
			const Stiffening<v8> s = stiffening(F, e, factor, load(L.nearest2 + g) * c.d2, c.d2);
			store(to.det + g, linkDeterminant(F, c.perVolume)), store(to.slope + g, volumeSlope(c, F, e, factor));
			store(to.bulk + g, s.bulk), store(to.shear + g, s.shear);
			scatter(V.push + pushSize * g, pushSize, affinePush(c, F, factor));
		}
	}
	/// Volumes that contacts alone would give, and what they push with.
	template <EosKind law> void contactShares(const BlockView& V, const VolumeConstants<law>& c, const double* contactSum, BlockResult& out)
	{
		double             stiffest = out.stiffest;
		int                clampCount = 0;
		alignas(64) double mass[blockSize]; // Omega0 times weight, of what is beyond planes of symmetry as well
		for (int l = 0; l < blockSize; l++) mass[l] = V.block.weighted ? V.cell[l] / mirrorShare(V.store, V.base + size_t(l)) : V.cell[l];
#pragma omp simd reduction(max : stiffest) reduction(+ : clampCount)
		for (int l = 0; l < blockSize; l++) {
			const double J = contactRatio(contactSum[l]), cell = contactCell(V.d, mass[l], V.factor[l]);
			V.h[l]         = pressureShare<ofContacts(VolumeRule::affine)>(pressure<law>(c.eos, J - 1.), J, cell * (1. / nLinks));
			stiffest       = max(stiffest, stiffness(c, J) * (cell / mass[l]));
			clampCount += J - 1. < c.clampAt ? 1 : 0;
		}
		out.stiffest = stiffest, out.clamped += clampCount;
	}
	template <bool intact, bool mixed, EosKind law> void run(const BlockView& V, const double* contactSum, double perMove, bool init, BlockResult& out)
	{
		constexpr bool             hot = LawOf<law>::heats;
		const VolumeConstants<law> c(V.material, V.d);
		const BulkViscosity        viscosity(V.material, V.d, perMove);
		LinkSums                   L;
		sumLinks<intact, mixed>(V, L);
		if (V.block.weighted) completeStars(V, L);
		for (int l = 0; init && l < blockSize; l++) {
			const AffineRest r = affineRest(c, L.dyads.at(l));
			V.factor[l] = r.factor, V.rest[l] = r.rest;
		}
		Shape shape;
		shapes<intact>(V, c, L, shape);
		const auto ratio = [&](int l) { return affineRatio(shape.det[l], V.factor[l], V.rest[l], contactSum ? contactSum[l] : 0.); };
		for (int l = 0; init && l < blockSize; l++) V.J[l] = ratio(l); // no dilation yet
		double nearest = 1e300, stiffest = 0, closing = 0, widest = 1.;
		int    clampCount = 0, badCount = 0;
#pragma omp simd reduction(max : stiffest, closing, widest) reduction(+ : clampCount, badCount) reduction(min : nearest)
		for (int l = 0; l < blockSize; l++) {
			const double        J = ratio(l), Jo = V.J[l];
			const PressureState p = pressureStep(c, J, Jo, { V.P[l], hot ? V.heat[l] : 0. }, V.factor[l] > 0.);
			stiffest    = max(stiffest, stiffness<law>(c, J, shape.bulk[l], shape.shear[l]));
			V.dTheta[l] = dilation(J, Jo), V.J[l] = J, V.P[l] = p.P;
			const double q = V.factor[l] > 0. ? viscosity.pressure(V.dTheta[l], shape.slope[l], tangent<law>(c.eos, J - 1.)) : 0.;
			V.viscous[l]   = perMove > 0. ? q : V.viscous[l]; // forces once more without a move: as before
			if (hot) V.heat[l] = p.e;
			closing = max(closing, -V.dTheta[l]);
			widest  = max(widest, J);
			nearest = min(nearest, L.nearest2[l]);
			clampCount += J - 1. < c.clampAt ? 1 : 0;
			badCount += validVolume(J) ? 0 : 1;
		}
		out.nearest = nearest, out.stiffest = stiffest, out.closing = closing, out.widest = widest, out.clamped = clampCount;
		if (contactSum) contactShares(V, c, contactSum, out);
		for (int l = 0; badCount && l < V.block.count && out.bad < 0; l++)
			if (!validVolume(V.J[l])) out.bad = int64_t(V.base) + l;
	}
}

void volumePass(Store& S, size_t b, VolumeRule, const Extra& X, bool init, BlockResult& out)
{
	prefetchRecords(S, b);
	const BlockView V(S, b);
	const double*   contactSum = V.block.contact && X.contactSum ? X.contactSum + V.base : nullptr;
	dispatch(V.material.eos.kind, [&](auto law) {
		choices([&](auto whole, auto mixed) { run<whole.value && !mixed.value, mixed.value, law.value>(V, contactSum, X.perMove, init, out); },
		        V.block.intact, V.block.mixed);
	});
}
}
