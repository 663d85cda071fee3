// SPDX-License-Identifier: GPL-2.0-or-later
// Edge viscosity with limiter (Caramana, Shashkov & Whalen 1998, J. Comput. Phys. 144, 70): acts along the velocity difference of each edge that
// shortens, none in uniform compression, rigid rotation or shear along a front. Formulation, section 3. An option: the scalar one costs less.
#include "sweep.hpp"
#include <cmath>

namespace mca::grid {

namespace {
	/// 1 - psi of an edge from the velocity slopes of the edges before and after it on the same grid line, projected on this edge.
	inline double oneMinusPsi(
		double dvx, double dvy, double dx, double dy, double bvx, double bvy, double bx, double by, bool before, double avx, double avy, double ax,
		double ay, bool after)
	{
		const double vv = dvx * dvx + dvy * dvy, xx = dx * dx + dy * dy;
		if (!(vv > 0.)) return 0.; // no difference, no force
		const double slope = vv / xx;
		const auto   ratio = [&](double px, double py, double qx, double qy) {
                        const double along = qx * dx + qy * dy; // of the same line, so above zero on any usable mesh
                        return along > 0. ? (px * dvx + py * dvy) / along / slope : 0.;
		};
		double l = before ? ratio(bvx, bvy, bx, by) : 0., r = after ? ratio(avx, avy, ax, ay) : 0.;
		if (!before) l = after ? r : 1.;
		if (!after) r = before ? l : 1.;
		const double psi = max(0., min(min(0.5 * (l + r), 1.), min(2. * l, 2. * r)));
		return 1. - psi;
	}

	struct Edge {
		double gx, gy; ///< force on the first node [N/m]
		double mu;     ///< viscous coefficient per length [Pa s/m]
	};

	/// Edge from a to b of a cell with centre (cx, cy); open = 1 - psi.
	inline Edge edgeForce(
		double ax, double ay, double bx, double by, double avx, double avy, double bvx, double bvy, double cx, double cy, double open, double rho,
		double rhoC, const Viscosity& v)
	{
		const double dx = bx - ax, dy = by - ay, ux = bvx - avx, uy = bvy - avy;
		const double speed = std::sqrt(ux * ux + uy * uy);
		const double mx = cx - 0.5 * (ax + bx), my = cy - 0.5 * (ay + by); // from the middle of the edge to the centre: the side of the median mesh
		const double facing = std::fabs(ux * my - uy * mx) / max(speed, 1e-300); // its length seen along the velocity difference
		const bool   closing = ux * dx + uy * dy < 0.;
		const double mu      = closing ? open * (v.linear * rhoC + v.quadratic * rho * speed) : 0.;
		return { mu * facing * ux, mu * facing * uy, mu };
	}
}

void edgeLimiterRow(Block& b, int j)
{
	const size_t n = b.node(0, j);
	Range        r = { 0, 0 };
	if (j > 0) r = hull(r, b.awake[size_t(j) - 1]);
	if (j < b.nj) r = hull(r, b.awake[size_t(j)]);
	const double *x = b.x + n, *y = b.y + n, *vx = b.vx + n, *vy = b.vy + n;
	const auto    difference = [](const double* f, long from, long to) { return f[to] - f[from]; };
	for (long i = r.lo; i < r.hi; i++) {
		const bool before = i > 0, after = i + 2 <= b.ni;
		const long p = before ? i - 1 : i, q = after ? i + 2 : i + 1;
		b.limiterX[n + size_t(i)] = oneMinusPsi(
			difference(vx, i, i + 1), difference(vy, i, i + 1), difference(x, i, i + 1), difference(y, i, i + 1), difference(vx, p, i),
			difference(vy, p, i), difference(x, p, i), difference(y, p, i), before, difference(vx, i + 1, q), difference(vy, i + 1, q),
			difference(x, i + 1, q), difference(y, i + 1, q), after);
	}
	if (j == b.nj || b.awake[size_t(j)].empty()) return;
	const long w      = long(b.pitch);
	const bool before = j > 0, after = j + 2 <= b.nj;
	for (long i = b.awake[size_t(j)].lo; i <= b.awake[size_t(j)].hi; i++) {
		const long p = before ? i - w : i, q = after ? i + 2 * w : i + w;
		b.limiterY[n + size_t(i)] = oneMinusPsi(
			difference(vx, i, i + w), difference(vy, i, i + w), difference(x, i, i + w), difference(y, i, i + w), difference(vx, p, i),
			difference(vy, p, i), difference(x, p, i), difference(y, p, i), before, difference(vx, i + w, q), difference(vy, i + w, q),
			difference(x, i + w, q), difference(y, i + w, q), after);
	}
}

template <EosKind eos> __attribute__((flatten)) uint64_t edgeLoop(const Block& b, int j, int lo, int hi, const CellConstants& constants, const RowForces& f)
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
	const double* __restrict below    = b.limiterX + n0;
	const double* __restrict above    = b.limiterX + n1;
	const double* __restrict sides    = b.limiterY + n0;
	const double* __restrict restArea = b.restArea + c0;
	const double* __restrict hgx = b.rx + c0;
	const double* __restrict hgy = b.ry + c0;
	double* __restrict t0x = f.t0x;
	double* __restrict t0y = f.t0y;
	double* __restrict t1x = f.t1x;
	double* __restrict t1y = f.t1y;
	double* __restrict rx  = f.rx;
	double* __restrict ry  = f.ry;
	uint64_t worst = 0;
#pragma omp simd reduction(max : worst)
	for (int i = lo; i < hi; i++) {
		const CellPattern p    = cellPattern(x0[i], y0[i], x0[i + 1], y0[i + 1], x1[i + 1], y1[i + 1], x1[i], y1[i]);
		const double      area = cellArea(p), rho = c.eos.rho0 * restArea[i] / area;
		const double      modulus = tangent<eos>(c.eos, area / restArea[i] - 1.) + (4. / 3.) * c.G, rhoC = std::sqrt(rho * modulus);
		const double      cx = 0.25 * ((x0[i] + x0[i + 1]) + (x1[i] + x1[i + 1])), cy = 0.25 * ((y0[i] + y0[i + 1]) + (y1[i] + y1[i + 1]));
		const auto&       v  = c.viscosity;
		const Edge e0 = edgeForce(x0[i], y0[i], x0[i + 1], y0[i + 1], vx0[i], vy0[i], vx0[i + 1], vy0[i + 1], cx, cy, below[i], rho, rhoC, v);
		const Edge        e1 = edgeForce(
			       x0[i + 1], y0[i + 1], x1[i + 1], y1[i + 1], vx0[i + 1], vy0[i + 1], vx1[i + 1], vy1[i + 1], cx, cy, sides[i + 1], rho, rhoC, v);
		const Edge e2 = edgeForce(x1[i], y1[i], x1[i + 1], y1[i + 1], vx1[i], vy1[i], vx1[i + 1], vy1[i + 1], cx, cy, above[i], rho, rhoC, v);
		const Edge e3 = edgeForce(x0[i], y0[i], x1[i], y1[i], vx0[i], vy0[i], vx1[i], vy1[i], cx, cy, sides[i], rho, rhoC, v);
		// corner forces f0 = e0 + e3, f1 = e1 - e0, f2 = -e1 - e2, f3 = e2 - e3 in the form T0, T1, R of kernels/cell.hpp
		t0x[i] += 0.5 * ((e0.gx + e3.gx) + (e1.gx + e2.gx));
		t0y[i] += 0.5 * ((e0.gy + e3.gy) + (e1.gy + e2.gy));
		t1x[i] += 0.5 * ((e1.gx - e0.gx) + (e3.gx - e2.gx));
		t1y[i] += 0.5 * ((e1.gy - e0.gy) + (e3.gy - e2.gy));
		rx[i] = hgx[i] + 0.5 * ((e1.gx + e2.gx) - (e0.gx + e3.gx));
		ry[i] = hgy[i] + 0.5 * ((e1.gy + e2.gy) - (e0.gy + e3.gy));
		const double   trace = cellHalfTrace(p), u = (trace + std::sqrt(max(trace * trace - area * area, 0.))) / (area * area * rho);
		const double   uv   = u * max(max(e0.mu, e1.mu), max(e2.mu, e3.mu)) * std::sqrt(max(area, 0.));
		const double   rate = area > 0. ? uv + std::sqrt(modulus * u + uv * uv) + 0. * (rx[i] + ry[i]) : std::numeric_limits<double>::infinity();
		const uint64_t bits = uint64_t(bitsOf(rate));
		worst               = bits > worst ? bits : worst;
	}
	return worst;
}

uint64_t edgeRow(const Block& b, int j, int lo, int hi, const CellConstants& constants, const RowForces& f)
{
	return dispatch(constants.eos.kind, [&](auto eos) { return edgeLoop<eos.value>(b, j, lo, hi, constants, f); });
}
}
