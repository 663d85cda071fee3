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

/// Laws that are dear: logarithms and powers are more than half of a cell's cost. A segment below the yield stress of its least strained and hottest
/// cells is first computed without flow; if a cell comes to yield all the same, the old state is put back and computed anew.
template <YieldKind kind, GridViscosity visc, bool hourglass, EosKind eos>
uint64_t dearRow(const Block& b, int j, int lo, int hi, const CellConstants& constants, const RowForces& f)
{
	constexpr bool heats = LawOf<kind>::heats;
	uint64_t       worst = 0;
	for (int from = lo; from < hi; from += segment) {
		const int    to = std::min(from + segment, hi), n = to - from;
		const size_t at = b.cell(from, j);
		double       before2 = 0, hottest = 0, leastStrain = 1e300, most = 0;
		const double *sxx = b.sxx + at, *syy = b.syy + at, *sxy = b.sxy + at, *temperature = heats ? b.temperature + at : nullptr, *eqps = b.eqps + at;
#pragma omp simd reduction(max : before2, hottest) reduction(min : leastStrain)
		for (int i = 0; i < n; i++) {
			before2 = max(before2, 3. * (sxx[i] * sxx[i] + syy[i] * syy[i] + sxx[i] * syy[i] + sxy[i] * sxy[i]));
			leastStrain = min(leastStrain, eqps[i]);
			if constexpr (heats) hottest = max(hottest, temperature[i]);
		}
		const double least = staticYield<kind>(constants.yield, leastStrain, hottest).stress;
		if (before2 < sqr(0.98 * least)) {
			double  kept[5][segment];
			double* state[5] = { b.sxx + at, b.syy + at, b.sxy + at, b.rx + at, b.ry + at };
			const int arrays = hourglass ? 5 : 3;
			for (int q = 0; q < arrays; q++)
				std::copy(state[q], state[q] + n, kept[q]);
			const uint64_t bits = cellLoop<kind, visc, hourglass, eos, false>(b, j, from, to, constants, f, most);
			if (most <= least) {
				worst = std::max(worst, bits);
				continue;
			}
			for (int q = 0; q < arrays; q++)
				std::copy(kept[q], kept[q] + n, state[q]);
		}
		worst = std::max(worst, cellLoop<kind, visc, hourglass, eos, true>(b, j, from, to, constants, f, most));
	}
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
