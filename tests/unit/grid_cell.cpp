// SPDX-License-Identifier: GPL-2.0-or-later
// One cell and small patches: what a one-point quadrilateral must do exactly.
#include "grid_scene.hpp"
using namespace gridtest;

TEST(GridCell, FreeRectangleAtRestStaysExactlyAtRest)
{
	Grid g({ true, false, 0.9 });
	addSkew(g, steel(YieldKind::perfect), 7, 5, 0.07, 0.05, 0.2, 3);
	g.build();
	const auto before = everything(g);
	for (int k = 0; k < 10; k++) g.step(0.5 * g.criticalTimeStep());
	EXPECT_TRUE(sameBits(before, everything(g)));
}

TEST(GridCell, PatchTestOnSkewMeshIsExact)
{
	// prescribed linear velocity field on the outline; inside must follow: same velocity gradient, no hourglass force
	const double L[4] = { 3., -2., 1.5, 4. };
	Material     m    = steel();
	m.viscosity       = { 0., 0. };
	Grid g({ true, true, 0.9 });
	const int    n = 6;
	addSkew(g, m, n, n, 0.06, 0.06, 0.2, 5);
	g.setVelocity(0, [&](double x, double y) { return std::array<double, 2> { L[0] * x + L[1] * y, L[2] * x + L[3] * y }; });
	const Block& b = g.block(0);
	std::vector<double> x0, y0;
	for (int j = 0; j <= n; j++)
		for (int i = 0; i <= n; i++) {
			x0.push_back(b.x[b.node(i, j)]);
			y0.push_back(b.y[b.node(i, j)]);
			const int k = g.openNode(0, i, j);
			if (k < 0) continue;
			const double vx = L[0] * x0.back() + L[1] * y0.back(), vy = L[2] * x0.back() + L[3] * y0.back();
			g.prescribe({ k }, 1, 0, Table(vx));
			g.prescribe({ k }, 0, 1, Table(vy));
		}
	double t = 0;
	for (int k = 0; k < 20; k++) {
		const double dt = 0.5 * g.criticalTimeStep();
		g.step(dt);
		t += dt;
	}
	double worst = 0, hourglass = 0, spread = 0, scale = 0;
	for (int j = 0; j <= n; j++)
		for (int i = 0; i <= n; i++) {
			const size_t k = size_t(j) * (n + 1) + i, q = b.node(i, j);
			worst = std::max(worst, std::fabs(b.x[q] - (x0[k] + t * (L[0] * x0[k] + L[1] * y0[k]))));
			worst = std::max(worst, std::fabs(b.y[q] - (y0[k] + t * (L[2] * x0[k] + L[3] * y0[k]))));
		}
	for (int j = 0; j < n; j++)
		for (int i = 0; i < n; i++) {
			const size_t c = b.cell(i, j);
			scale     = std::max(scale, std::fabs(b.sxy[c]));
			spread    = std::max(spread, std::fabs(b.sxy[c] - b.sxy[0]) + std::fabs(b.sxx[c] - b.sxx[0]));
			hourglass = std::max(hourglass, (std::fabs(b.rx[c]) + std::fabs(b.ry[c])) / 0.01);
		}
	EXPECT_LT(worst, 1e-12 * 0.06);
	EXPECT_GT(scale, 1e4); // the field does strain the patch
	EXPECT_LT(spread, 1e-9 * scale);
	EXPECT_LT(hourglass, 1e-9 * scale);
}

TEST(GridCell, RigidRotationLeavesStressUnchanged)
{
	// one step of any angle, on the kernel itself: invariants stay, components turn
	const CellConstants c = [] {
		CellConstants k;
		k.eos = steel().eos, k.G = 80e9, k.hourglass = 1, k.dt = 1e-6;
		return k;
	}();
	for (const double angle : { 1e-3, 0.1, 1.0, 2.0 }) {
		const double x[4] = { 0., 1.1, 1.3, -0.1 }, y[4] = { 0., 0.1, 1.2, 0.9 };
		double       X[4], Y[4], vx[4], vy[4];
		for (int k = 0; k < 4; k++) {
			X[k]  = std::cos(angle) * x[k] - std::sin(angle) * y[k];
			Y[k]  = std::sin(angle) * x[k] + std::cos(angle) * y[k];
			vx[k] = (X[k] - x[k]) / c.dt;
			vy[k] = (Y[k] - y[k]) / c.dt;
		}
		const auto pattern = [](const double* a, const double* b) { return cellPattern(a[0], b[0], a[1], b[1], a[2], b[2], a[3], b[3]); };
		const CellPattern p0 = pattern(x, y), p = pattern(X, Y), v = pattern(vx, vy);
		CellState         s  = { 3e8, -1e8, 2e8, 0, 1e5, -2e5, 0 };
		const CellState   s0 = s;
		updateCell<YieldKind::elastic, GridViscosity::scalar, true, EosKind::shockAdiabat>(c, p, v, cellArea(p0), 0., s);
		const double C = std::cos(angle), S = std::sin(angle);
		const double xx = C * C * s0.sxx + S * S * s0.syy - 2 * C * S * s0.sxy, yy = S * S * s0.sxx + C * C * s0.syy + 2 * C * S * s0.sxy;
		const double xy = C * S * (s0.sxx - s0.syy) + (C * C - S * S) * s0.sxy;
		EXPECT_NEAR(s.sxx, xx, 1e-3) << angle; // of 3e8 Pa
		EXPECT_NEAR(s.syy, yy, 1e-3) << angle;
		EXPECT_NEAR(s.sxy, xy, 1e-3) << angle;
		EXPECT_NEAR(s.rx, C * s0.rx - S * s0.ry, 1e-4) << angle;
		EXPECT_NEAR(s.ry, S * s0.rx + C * s0.ry, 1e-4) << angle;
	}
}

TEST(GridCell, HourglassStiffnessOfTheSquareIsTheBilinearOne)
{
	// amplitude a of the pattern (1,-1,1,-1): force a/4 (4/3)(lambda + 3 mu) per corner
	Material      m = steel();
	CellConstants c;
	c.eos = m.eos, c.G = m.G, c.hourglass = 1, c.dt = 1.;
	const double a = 1e-9, h = 0.01;
	const double hg[4] = { 1, -1, 1, -1 }, x[4] = { 0, h, h, 0 }, y[4] = { 0, 0, h, h };
	double       vx[4], X[4];
	for (int k = 0; k < 4; k++) vx[k] = a * hg[k], X[k] = x[k] + vx[k];
	CellState         s  = { 0, 0, 0, 0, 0, 0, 0 };
	const CellPattern p  = cellPattern(X[0], y[0], X[1], y[1], X[2], y[2], X[3], y[3]), v = cellPattern(vx[0], 0, vx[1], 0, vx[2], 0, vx[3], 0);
	updateCell<YieldKind::elastic, GridViscosity::none, true, EosKind::shockAdiabat>(c, p, v, h * h, 0., s);
	const double lambda = m.eos.bulkModulus() - 2. / 3. * m.G;
	EXPECT_NEAR(s.rx, 0.25 * (4. / 3.) * (lambda + 3 * m.G) * a, 1e-5 * s.rx);
	EXPECT_NEAR(s.ry, 0., 1e-9 * s.rx);
}

TEST(GridCell, InvertedCellShowsInTheRate)
{
	CellConstants c;
	c.eos = steel().eos, c.G = 80e9, c.dt = 1e-8;
	CellState    s = { 0, 0, 0, 0, 0, 0, 0 };
	const double r = updateCell<YieldKind::elastic, GridViscosity::none, false, EosKind::shockAdiabat>(
				 c, cellPattern(0, 0, 0, 1, 1, 1, 1, 0), { 0, 0, 0, 0, 0, 0 }, 1., 0., s)
				 .rate;
	EXPECT_FALSE(std::isfinite(r));
}
