// SPDX-License-Identifier: GPL-2.0-or-later
// Pass 1: volume of each automaton from its links, pressure, and what it pushes its neighbours with.
#include "../../kernels/automaton/force.hpp"
#include "../../kernels/automaton/limit.hpp"
#include "../passes.hpp"
#include "../view.hpp"

namespace mca::automata {
namespace {
	void report(const BlockView& V, bool anyBad, BlockResult& out)
	{
		for (int l = 0; anyBad && l < V.block.count && out.bad < 0; l++)
			if (!validVolume(V.J[l])) out.bad = int64_t(V.base) + l;
	}
	void publishDilation(const BlockView& V)
	{
		for (int l = 0; l < blockSize; l++) V.record[nodeSize * l + dilationAt] = V.dTheta[l];
	}

	template <VolumeRule rule, bool intact, bool mixed, EosKind law> void sumRule(const BlockView& V, const double* contactSum, bool init, BlockResult& out)
	{
		constexpr bool        hot = LawOf<law>::heats;
		const VolumeConstants<law> c(V.material, V.d);
		const double *             D = V.diameterOfAll, d = V.d;
		const int32_t *       nb = V.neighbour, *flags = V.flags;
		alignas(64) double    sums[blockSize];
		double                nearest = 1e300;
#pragma omp simd reduction(min : nearest)
		for (int l = 0; l < blockSize; l++) {
			double sum = 0;
#pragma GCC unroll 6
			for (int k = 0; k < nLinks; k++) {
				const int32_t     j   = nb[k * blockSize + l];
				const Vec<double> r   = V.positionOfAll.at(j) - V.position.at(l);
				const double      dij = mixed ? 0.5 * (d + D[j]) : d;
				double            r2  = dot(r, r);
				if (!intact) r2 = (flags[l] >> k) & 1 ? r2 : dij * dij;
				nearest     = min(nearest, r2 / (dij * dij));
				double term = volumeTerm<rule>(dij, r2);
				if (!intact) {
					term = (flags[l] >> (halfShift + k)) & 1 ? 0.5 * term : term;
					term = (flags[l] >> k) & 1 ? term : 0.;
				}
				sum += term;
			}
			sums[l] = sum;
		}
		if (init)
			for (int l = 0; l < blockSize; l++)
				V.rest[l] = sums[l];
		if (contactSum)
			for (int l = 0; l < blockSize; l++)
				sums[l] += contactSum[l];
		double stiffest = 0, closing = 0, widest = 1.;
		int    clampCount = 0, badCount = 0;
#pragma omp simd reduction(max : stiffest, closing, widest) reduction(+ : clampCount, badCount)
		for (int l = 0; l < blockSize; l++) {
			const double        J = volumeRatio<rule>((sums[l] - V.rest[l]) * V.invN[l]), Jo = init ? J : V.J[l];
			const PressureState p = pressureStep(c, J, Jo, { V.P[l], hot ? V.heat[l] : 0. }, true);
			V.dTheta[l] = dilation(J, Jo), V.J[l] = J, V.P[l] = p.P;
			if (hot) V.heat[l] = p.e;
			V.h[l]   = pressureShare<rule>(p.P, J, V.cell[l] * V.invN[l]);
			stiffest = max(stiffest, stiffness(c, J));
			closing  = max(closing, -V.dTheta[l]);
			widest   = max(widest, J);
			clampCount += J - 1. < c.clampAt ? 1 : 0;
			badCount += validVolume(J) ? 0 : 1;
		}
		out.nearest = nearest, out.stiffest = stiffest, out.closing = closing, out.widest = widest, out.clamped = clampCount;
		report(V, badCount, out);
	}

	/// Sums over the links, as the affine rule needs them.
	struct LinkSums {
		TensorLanes<blockSize>    dyads;        ///< of r (x) e_k [m]
		SymmetricLanes<blockSize> directions;   ///< of e_k (x) e_k; not filled where all links hold
		alignas(64) double nearest2[blockSize]; ///< smallest r^2 [m2]
	};
	/// The same for an automaton at an outline: with the directions of its triangles instead of those of its links.
	MCA_INLINE void addAtOutline(Tensor<v8>& sum, Symmetric<v8>& e, const EightTriangles& triangles, int k, m8 on, Vec<v8> r)
	{
		const Vec<v8> c      = outlineDirection(triangles.of, k);
		Symmetric<v8> square = {}, direction = {};
		addSquare(square, c), addDirection(direction, k, on ? splat(1.) : splat(0.));
		addEither(e, triangles.any(), square, direction);
		addDyad(sum, c, r);
	}
	template <bool intact> MCA_INLINE void sumLinks(const BlockView& V, LinkSums& to)
	{
		const bool outline = !intact && V.block.outline;
		for (int g = 0; g < blockSize; g += lanes) {
			const Vec<v8> own     = load(V.position, g), none {};
			const m8      bits    = intact ? m8 {} : widen(V.flags + g);
			const EightTriangles triangles(V.flags + g);
			Tensor<v8>    sum     = {};
			Symmetric<v8> e       = {};
			v8            nearest = splat(1e300);
#pragma GCC unroll 6
			for (int k = 0; k < nLinks; k++) {
				const m8 on = holding(bits, k);
				Vec<v8>  r  = gatherPosition(V.node, V.others(k, g)) - own; // zero without a link: the slot leads to itself
				nearest     = min(nearest, choose<intact>(on, dot(r, r), splat(V.d * V.d)));
				r           = choose<intact>(on, r, none);
				if (outline) {
					addAtOutline(sum, e, triangles, k, on, r);
					continue;
				}
				if (!intact) addDirection(e, k, on ? splat(1.) : splat(0.));
				addDyad(sum, k, r);
			}
			to.dyads.setLanes(g, sum), store(to.nearest2 + g, nearest);
			if (!intact) to.directions.setLanes(g, e);
		}
	}
	template <bool intact, EosKind law> void affineRule(const BlockView& V, const double* contactSum, double perMove, bool init, BlockResult& out)
	{
		constexpr bool        hot = LawOf<law>::heats;
		const VolumeConstants<law> c(V.material, V.d);
		const BulkViscosity        viscosity(V.material, V.d, perMove);
		LinkSums              L;
		sumLinks<intact>(V, L);
		if (init)
			for (int l = 0; l < blockSize; l++) {
				const AffineRest r = affineRest(c, L.dyads.at(l));
				V.factor[l] = r.factor, V.rest[l] = r.rest;
			}
		double nearest = 1e300, stiffest = 0, closing = 0, widest = 1.;
		int    clampCount = 0, badCount = 0;
#pragma omp simd reduction(max : stiffest, closing, widest) reduction(+ : clampCount, badCount) reduction(min : nearest)
		for (int l = 0; l < blockSize; l++) {
			const Tensor<double>    F = L.dyads.at(l);
			const Symmetric<double> e = intact ? isotropic(Lattice::spread) : L.directions.at(l);
			const double            J = affineRatio(c, F, V.factor[l], V.rest[l], contactSum ? contactSum[l] : 0.), Jo = init ? J : V.J[l];
			const PressureState     p = pressureStep(c, J, Jo, { V.P[l], hot ? V.heat[l] : 0. }, V.factor[l] > 0.);
			const Tensor<double>    t     = affinePush(c, F, V.factor[l]);
			const double            slope = volumeSlope(c, F, e, V.factor[l]);
			const bool outline = !intact && trianglesIn(V.flags[l]);
			stiffest           = max(stiffest, affineStiffness(c, J, slope, L.nearest2[l], outline));
			V.dTheta[l] = dilation(J, Jo), V.J[l] = J, V.P[l] = p.P;
			const double q = V.factor[l] > 0. ? viscosity.pressure(V.dTheta[l], slope, tangent<law>(c.eos, J - 1.)) : 0.;
			V.viscous[l]   = perMove > 0. ? q : V.viscous[l]; // forces once more without a move: as before
			if (hot) V.heat[l] = p.e;
			L.dyads.set(l, t);
			closing = max(closing, -V.dTheta[l]);
			widest  = max(widest, outline ? turningAtOutlines * J : J);
			nearest = min(nearest, L.nearest2[l] / c.d2);
			clampCount += J - 1. < c.clampAt ? 1 : 0;
			badCount += validVolume(J) ? 0 : 1;
		}
		for (int g = 0; g < blockSize; g += lanes) scatter(V.push + pushSize * g, pushSize, L.dyads.lanes(g));
		if (contactSum) { // contacts have a volume of their own
#pragma omp simd reduction(max : stiffest) reduction(+ : clampCount)
			for (int l = 0; l < blockSize; l++) {
				const double J = contactRatio(contactSum[l]);
				const double cell = contactCell(V.d, V.cell[l], V.factor[l]);
				V.h[l]            = pressureShare<ofContacts(VolumeRule::affine)>(pressure<law>(c.eos, J - 1.), J, cell * (1. / nLinks));
				stiffest          = max(stiffest, stiffness(c, J) * (cell / V.cell[l]));
				clampCount += J - 1. < c.clampAt ? 1 : 0;
			}
		}
		out.nearest = nearest, out.stiffest = stiffest, out.closing = closing, out.widest = widest, out.clamped = clampCount;
		report(V, badCount, out);
	}
}

void volumePass(Store& S, size_t b, VolumeRule rule, const Extra& X, bool init, BlockResult& out)
{
	prefetchRecords(S, b);
	const BlockView V(S, b);
	const double*   contactSum = V.block.contact && X.contactSum ? X.contactSum + V.base : nullptr;
	dispatch(V.material.eos.kind, [&](auto law) {
		dispatch(rule, [&](auto r) {
			if constexpr (r.value == VolumeRule::affine)
				choices([&](auto intact) { affineRule<intact.value, law.value>(V, contactSum, X.perMove, init, out); }, V.block.intact);
			else
				choices([&](auto intact, auto mixed) { sumRule<r.value, intact.value, mixed.value, law.value>(V, contactSum, init, out); },
				        V.block.intact, V.block.mixed);
		});
	});
	publishDilation(V);
}
}
