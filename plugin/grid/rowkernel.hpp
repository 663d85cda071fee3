// SPDX-License-Identifier: GPL-2.0-or-later
// The cell loop of one row: loads, kernels/cell.hpp, stores. One instance per combination of features, so an unused feature costs nothing.
#pragma once
#include "sweep.hpp"
#include <algorithm>

namespace mca::grid {

/// Cells [lo,hi) of row j. most: largest equivalent stress before the radial return [Pa].
/// flatten: one call left in the loop and nothing vectorises.
template <YieldKind kind, GridViscosity visc, bool hourglass, EosKind eos, bool flows>
__attribute__((flatten)) uint64_t cellLoop(const Block& b, int j, int lo, int hi, const CellConstants& constants, const RowForces& f, double& most)
{
	const CellConstants c  = constants;
	const size_t        n0 = b.node(0, j), n1 = b.node(0, j + 1), c0 = b.cell(0, j);
	const double* __restrict x0  = b.x + n0;
	const double* __restrict y0  = b.y + n0;
	const double* __restrict x1  = b.x + n1;
	const double* __restrict y1  = b.y + n1;
	const double* __restrict vx0 = b.vx + n0;
	const double* __restrict vy0 = b.vy + n0;
	const double* __restrict vx1 = b.vx + n1;
	const double* __restrict vy1 = b.vy + n1;
	const double* __restrict restArea = b.restArea + c0;
	const double* __restrict energy   = LawOf<eos>::heats ? b.energy + c0 : nullptr;
	double* __restrict sxx  = b.sxx + c0;
	double* __restrict syy  = b.syy + c0;
	double* __restrict sxy  = b.sxy + c0;
	double* __restrict eqps = b.eqps + c0;
	double* __restrict rx   = b.rx + c0;
	double* __restrict ry   = b.ry + c0;
	double* __restrict temperature = LawOf<kind>::heats ? b.temperature + c0 : nullptr;
	double* __restrict t0x = f.t0x;
	double* __restrict t0y = f.t0y;
	double* __restrict t1x = f.t1x;
	double* __restrict t1y = f.t1y;
	uint64_t worst   = 0; // bits of doubles that are not negative sort like the numbers; signs and NaN come out above all of them
	double   largest = 0;
#pragma omp simd reduction(max : worst, largest)
	for (int i = lo; i < hi; i++) {
		const CellPattern p = cellPattern(x0[i], y0[i], x0[i + 1], y0[i + 1], x1[i + 1], y1[i + 1], x1[i], y1[i]);
		const CellPattern v = cellPattern(vx0[i], vy0[i], vx0[i + 1], vy0[i + 1], vx1[i + 1], vy1[i + 1], vx1[i], vy1[i]);
		CellState         s = { sxx[i], syy[i], sxy[i], 0., 0., 0., 0. };
		if constexpr (LawOf<kind>::yields) s.eqps = eqps[i];
		if constexpr (hourglass) {
			s.rx = rx[i];
			s.ry = ry[i];
		}
		if constexpr (LawOf<kind>::heats) s.temperature = temperature[i];
		double e = 0.;
		if constexpr (LawOf<eos>::heats) e = energy[i] / restArea[i];
		const CellForces out = updateCell<kind, visc, hourglass, eos, flows>(c, p, v, restArea[i], e, s);
		sxx[i] = s.sxx;
		syy[i] = s.syy;
		sxy[i] = s.sxy;
		if constexpr (LawOf<kind>::yields) eqps[i] = s.eqps;
		if constexpr (hourglass) {
			rx[i] = s.rx;
			ry[i] = s.ry;
		}
		if constexpr (LawOf<kind>::heats) temperature[i] = s.temperature;
		t0x[i] = out.t0x;
		t0y[i] = out.t0y;
		t1x[i] = out.t1x;
		t1y[i] = out.t1y;
		const uint64_t rate = uint64_t(bitsOf(out.rate));
		worst               = rate > worst ? rate : worst;
		if constexpr (!flows) largest = max(largest, out.trial);
	}
	most = largest;
	return worst;
}

constexpr int segment = 16; ///< cells that are tried together without flow
constexpr int segments = 16; ///< of them whose yield stresses are computed together: one alone would cost as much

/// Equivalent stresses of segments before the step, squared, and static yield stresses below which none of their cells yields [Pa2], [Pa].
struct Segments {
	alignas(64) double before2[segments], least[segments];
};
/// Cells [lo, hi) of row j, at most segments * segment.
template <YieldKind kind> Segments lookAt(const Block& b, int j, int lo, int hi, const Yield& yield)
{
	constexpr bool     heats = LawOf<kind>::heats;
	Segments           found;
	alignas(64) double strain[segments], hottest[segments];
	std::fill(strain, strain + segments, 0.), std::fill(hottest, hottest + segments, 0.);
	for (int q = 0, from = lo; from < hi; q++, from += segment) {
		const int     n  = std::min(segment, hi - from);
		const size_t  at = b.cell(from, j);
		double        before2 = 0, hot = 0, least = 1e300;
		const double *sxx = b.sxx + at, *syy = b.syy + at, *sxy = b.sxy + at, *temperature = heats ? b.temperature + at : nullptr, *eqps = b.eqps + at;
#pragma omp simd reduction(max : before2, hot) reduction(min : least)
		for (int i = 0; i < n; i++) {
			before2 = max(before2, 3. * (sxx[i] * sxx[i] + syy[i] * syy[i] + sxx[i] * syy[i] + sxy[i] * sxy[i]));
			least   = min(least, eqps[i]);
			if constexpr (heats) hot = max(hot, temperature[i]);
		}
		found.before2[q] = before2, strain[q] = least, hottest[q] = hot;
	}
#pragma omp simd
	for (int q = 0; q < segments; q++)
		found.least[q] = staticYield<kind>(yield, strain[q], hottest[q]).stress;
	return found;
}

/// What a step changes of a segment.
template <bool hourglass> struct Kept {
	static constexpr int arrays = hourglass ? 5 : 3;
	double* const        state[5];
	double               kept[arrays][segment];
	Kept(const Block& b, size_t at, int n)
	        : state { b.sxx + at, b.syy + at, b.sxy + at, b.rx + at, b.ry + at }
	{
		for (int q = 0; q < arrays; q++)
			for (int i = 0; i < n; i++) kept[q][i] = state[q][i];
	}
	void putBack(int n) const
	{
		for (int q = 0; q < arrays; q++) std::copy(kept[q], kept[q] + n, state[q]);
	}
};

/// Laws that are dear: logarithms and powers are more than half of a cell's cost. A segment below the yield stress of its least strained and hottest
/// cells is first computed without flow; if a cell comes to yield all the same, the old state is put back and computed anew. Neighbours that flow are
/// computed together: the loop over a row has much to prepare.
template <YieldKind kind, GridViscosity visc, bool hourglass, EosKind eos>
uint64_t dearRow(const Block& b, int j, int lo, int hi, const CellConstants& constants, const RowForces& f)
{
	uint64_t   worst = 0;
	double     most  = 0;
	int        flowing = lo; // from here to the present segment cells wait for their turn with flow
	const auto flow = [&](int to) {
		if (flowing < to) worst = std::max(worst, cellLoop<kind, visc, hourglass, eos, true>(b, j, flowing, to, constants, f, most));
	};
	for (int first = lo; first < hi; first += segments * segment) {
		const int      last = std::min(first + segments * segment, hi);
		const Segments look = lookAt<kind>(b, j, first, last, constants.yield);
		for (int q = 0, from = first; from < last; q++, from += segment) {
			if (!(look.before2[q] < sqr(0.98 * look.least[q]))) continue;
			const int             to = std::min(from + segment, last);
			const Kept<hourglass> kept(b, b.cell(from, j), to - from);
			const uint64_t        bits = cellLoop<kind, visc, hourglass, eos, false>(b, j, from, to, constants, f, most);
			if (!(most <= look.least[q])) {
				kept.putBack(to - from);
				continue;
			}
			flow(from), flowing = to, worst = std::max(worst, bits);
		}
	}
	flow(hi);
	return worst;
}

template <YieldKind kind, GridViscosity visc, bool hourglass, EosKind eos>
uint64_t rowKernel(const Block& b, int j, int lo, int hi, const CellConstants& constants, const RowForces& f)
{
	double most;
	if constexpr (LawOf<kind>::isDear) return dearRow<kind, visc, hourglass, eos>(b, j, lo, hi, constants, f);
	else return cellLoop<kind, visc, hourglass, eos, true>(b, j, lo, hi, constants, f, most);
}

template <YieldKind kind> RowKernel rowKernelOf(const Block& b)
{
	using V      = GridViscosity;
	const bool v = b.material.viscosity.active() && !b.options.edgeViscosity, h = b.options.hourglass > 0;
	return dispatch(b.material.eos.kind, [&](auto eos) -> RowKernel {
		if (v) return h ? rowKernel<kind, V::scalar, true, eos.value> : rowKernel<kind, V::scalar, false, eos.value>;
		return h ? rowKernel<kind, V::none, true, eos.value> : rowKernel<kind, V::none, false, eos.value>;
	});
}
}
