// SPDX-License-Identifier: GPL-2.0-or-later
// Materials and grids the grid tests share.
#pragma once
#include "grid/grid.hpp"
#include <cstring>
#include <gtest/gtest.h>
#include <random>

namespace gridtest {
using namespace mca;
using namespace mca::grid;

inline Material steel(YieldKind kind = YieldKind::elastic)
{
	Material m;
	m.eos                = { 7830., 4578., 1.33, 1.67 };
	m.G                  = 80e9;
	m.yield.kind         = kind;
	m.viscosity          = { 0.1, 1.2 };
	if (kind != YieldKind::elastic) m.yield.yieldStress = 0.792e9;
	if (kind == YieldKind::linearHardening) m.yield.hardeningModulus = 0.5e9;
	if (kind == YieldKind::johnsonCook) {
		m.yield.hardeningModulus = 0.51e9, m.yield.hardeningExponent = 0.26, m.yield.rateCoefficient = 0.014, m.yield.thermalSoftening = 1.03,
		m.yield.meltTemperature = 1793., m.yield.heatPerWork = 0.9 / (7830. * 477.);
	}
	return m;
}

inline std::vector<double> line(double a, double b, int n)
{
	std::vector<double> x;
	for (int k = 0; k <= n; k++) x.push_back(a + (b - a) * k / n);
	return x;
}

/// Rectangle [0,lx] x [0,ly] whose nodes are moved at random by up to `skew` of a cell; outline nodes stay when keepOutline.
inline int
addSkew(Grid& g, const Material& m, int ni, int nj, double lx, double ly, double skew, unsigned seed, const BlockOptions& o = {}, bool keepOutline = false)
{
	std::mt19937                           r(seed);
	std::uniform_real_distribution<double> u(-skew, skew);
	std::vector<double>                    x, y;
	for (int j = 0; j <= nj; j++)
		for (int i = 0; i <= ni; i++) {
			const bool   edge = keepOutline && (i == 0 || j == 0 || i == ni || j == nj);
			const double a = u(r), b = u(r);
			x.push_back((i + (edge ? 0 : a)) * lx / ni);
			y.push_back((j + (edge ? 0 : b)) * ly / nj);
		}
	return g.addBlock(m, ni, nj, x, y, o);
}

/// All numbers of all blocks and open nodes, for comparison bit by bit.
inline std::vector<double> everything(const Grid& g)
{
	std::vector<double> v;
	for (int k = 0; k < g.blocks(); k++) {
		const Block& b = g.block(k);
		for (int j = 0; j <= b.nj; j++)
			for (int i = 0; i <= b.ni; i++)
				for (const double* a : { b.x, b.y, b.vx, b.vy }) v.push_back(a[b.node(i, j)]);
		for (int j = 0; j < b.nj; j++)
			for (int i = 0; i < b.ni; i++)
				for (const double* a : { b.sxx, b.syy, b.sxy, b.eqps, b.rx, b.ry, b.energy, b.temperature })
					if (a) v.push_back(a[b.cell(i, j)]);
	}
	for (const auto* a : { &g.open().x, &g.open().y, &g.open().vx, &g.open().vy }) v.insert(v.end(), a->begin(), a->end());
	return v;
}

inline bool sameBits(const std::vector<double>& a, const std::vector<double>& b)
{
	return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}
}
