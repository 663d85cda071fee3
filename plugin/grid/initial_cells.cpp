// SPDX-License-Identifier: GPL-2.0-or-later
// Stress, plastic strain and temperature of cells at the start.
#include "../kernels/deviator.hpp"
#include "grid.hpp"
#include <cmath>
#include <limits>
#include <sstream>

namespace mca::grid {
namespace {
	std::string text(double v)
	{
		std::ostringstream s;
		s << v;
		return s.str();
	}
	/// Area at rest of a cell of this area under a pressure p.
	double restAreaAt(const Eos& e, double area, double p, const std::string& where)
	{
		double low = -0.5, high = 0.5; // of the volume strain: the pressure falls with it
		if (!(pressure(e, low) > p && pressure(e, high) < p))
			throw Error(where + ": the equation of state has no pressure of " + text(p) + " Pa at volume ratios from 0.5 to 1.5.");
		for (int n = 0; p != 0. && n < 100; n++) (pressure(e, 0.5 * (low + high)) > p ? low : high) = 0.5 * (low + high);
		return p == 0. ? area : area / (1. + low);
	}
}

/// Which values the cells can have; where: of a cell, for messages.
void Grid::checkCells(const Block& b, const CellFields& f) const
{
	const size_t n = size_t(b.ni) * size_t(b.nj);
	const auto   refuse = [&](const std::string& what) { throw Error("cells of block '" + b.options.name + "': " + what); };
	for (const auto* v : { &f.pressure, &f.sxx, &f.syy, &f.sxy, &f.eqps, &f.temperature }) {
		if (!v->empty() && v->size() != n)
			refuse(std::to_string(v->size()) + " values were given for " + std::to_string(n) + " cells.");
		for (double x : *v)
			if (!std::isfinite(x)) refuse("a value is not finite; give finite numbers.");
	}
	for (double x : f.eqps)
		if (!(x >= 0 && x <= 1e6)) refuse("plasticStrain = " + text(x) + " must be from 0 to 1e6.");
	for (double x : f.temperature)
		if (!(x > 0 && x <= 1e9)) refuse("temperature = " + text(x) + " K must be above 0 and at most 1e9.");
	if (!f.temperature.empty() && !b.temperature)
		refuse("the flow stress of its material does not depend on temperature; leave it out.");
	if (!f.pressure.empty() && b.material.eos.heats())
		refuse("a stress cannot be given where the equation of state has an internal energy "
		    "(mieGruneisen); "
		            "choose another eos, or load the grid instead.");
	const auto given = [](const std::vector<double>& v, size_t k, double before) { return v.empty() ? before : v[k]; };
	for (size_t k = 0; k < n; k++) {
		const int    i = int(k) % b.ni, j = int(k) / b.ni;
		const size_t c = b.cell(i, j);
		const double sxx = given(f.sxx, k, b.sxx[c]), syy = given(f.syy, k, b.syy[c]), sxy = given(f.sxy, k, b.sxy[c]);
		const double strain = given(f.eqps, k, b.eqps[c]);
		const double T = given(f.temperature, k, b.temperature ? b.temperature[c] : b.material.yield.referenceTemperature);
		const double sigma = Deviator { sxx, syy, -sxx - syy, 0., 0., sxy }.mises();
		const double limit = dispatch(b.material.yield.kind, [&](auto law) {
			return LawOf<law.value>::yields ? staticYield<law.value>(b.material.yield, strain, T).stress : std::numeric_limits<double>::infinity();
		});
		if (sigma > limit * (1. + 1e-12) || (b.material.G == 0. && sigma > 0.))
			throw Error(b.cellName(i, j) + ": the stress has a Mises stress of " + text(sigma) + " Pa, and the material flows at "
			            + text(b.material.G == 0. ? 0. : limit) + " Pa; give less.");
		if (f.pressure.empty()) continue;
		if (f.pressure[k] < -b.material.fracture.spall)
			throw Error(b.cellName(i, j) + ": the tension of " + text(-f.pressure[k]) + " Pa is above spallStrength, "
			            + text(b.material.fracture.spall) + " Pa; give less.");
		restAreaAt(b.material.eos, b.area(i, j), f.pressure[k], b.cellName(i, j));
	}
}

void Grid::setCells(int block, const CellFields& f)
{
	mustBeBuilt();
	checkedBlock(block, "cells");
	if (steps_ > 0) throw Error("cells: the grid has moved already; set stresses, plastic strains and temperatures before the first step.");
	Block& b = *blocks_[size_t(block)];
	checkCells(b, f);
	for (size_t k = 0; k < size_t(b.ni) * size_t(b.nj); k++) {
		const int    i = int(k) % b.ni, j = int(k) / b.ni;
		const size_t c = b.cell(i, j);
		if (!f.pressure.empty())
			b.sxx[c] = f.sxx[k], b.syy[c] = f.syy[k], b.sxy[c] = f.sxy[k],
			b.restArea[c] = restAreaAt(b.material.eos, b.area(i, j), f.pressure[k], b.cellName(i, j));
		if (!f.eqps.empty()) b.eqps[c] = f.eqps[k];
		if (!f.temperature.empty()) b.temperature[c] = f.temperature[k];
	}
	restRanges();
	ratesKnown_ = false;
}
}
