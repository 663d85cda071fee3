// SPDX-License-Identifier: GPL-2.0-or-later
#include "gauge.hpp"
#include <algorithm>
#include <cmath>

namespace mca::grid {

namespace {
	/// Bilinear coordinates of a point in cell (i,j) by Newton's method; false when it lies outside.
	bool inside(const Block& b, int i, int j, double x, double y, double& u, double& v)
	{
		const size_t n0 = b.node(i, j), n1 = b.node(i, j + 1);
		const double x0 = b.x[n0], x1 = b.x[n0 + 1], x2 = b.x[n1 + 1], x3 = b.x[n1];
		const double y0 = b.y[n0], y1 = b.y[n0 + 1], y2 = b.y[n1 + 1], y3 = b.y[n1];
		const double tol = 1e-9 * (std::fabs(x2 - x0) + std::fabs(y2 - y0));
		if (x < std::min(std::min(x0, x1), std::min(x2, x3)) - tol || x > std::max(std::max(x0, x1), std::max(x2, x3)) + tol) return false;
		if (y < std::min(std::min(y0, y1), std::min(y2, y3)) - tol || y > std::max(std::max(y0, y1), std::max(y2, y3)) + tol) return false;
		u = v = 0.5;
		for (int it = 0; it < 20; it++) {
			const double fx = (1 - u) * (1 - v) * x0 + u * (1 - v) * x1 + u * v * x2 + (1 - u) * v * x3 - x;
			const double fy = (1 - u) * (1 - v) * y0 + u * (1 - v) * y1 + u * v * y2 + (1 - u) * v * y3 - y;
			const double xu = (1 - v) * (x1 - x0) + v * (x2 - x3), xv = (1 - u) * (x3 - x0) + u * (x2 - x1);
			const double yu = (1 - v) * (y1 - y0) + v * (y2 - y3), yv = (1 - u) * (y3 - y0) + u * (y2 - y1);
			const double det = xu * yv - xv * yu;
			if (!(std::fabs(det) > 0)) return false;
			const double du = (yv * fx - xv * fy) / det, dv = (xu * fy - yu * fx) / det;
			u -= du;
			v -= dv;
			if (std::fabs(du) + std::fabs(dv) < 1e-14) break;
		}
		const double e = 1e-9;
		return u > -e && u < 1 + e && v > -e && v < 1 + e;
	}
}

bool locate(const Block& b, double x, double y, Location& at)
{
	for (int j = 0; j < b.nj; j++)
		for (int i = 0; i < b.ni; i++)
			if (inside(b, i, j, x, y, at.u, at.v)) {
				at.i = i;
				at.j = j;
				return true;
			}
	return false;
}

Sample sample(const Block& b, const Location& at, double time)
{
	const size_t n0 = b.node(at.i, at.j), n1 = b.node(at.i, at.j + 1), c = b.cell(at.i, at.j);
	const double w[4] = { (1 - at.u) * (1 - at.v), at.u * (1 - at.v), at.u * at.v, (1 - at.u) * at.v };
	const auto   mean = [&](const double* f) { return (w[0] * f[n0] + w[1] * f[n0 + 1]) + (w[2] * f[n1 + 1] + w[3] * f[n1]); };
	return { time, mean(b.x), mean(b.y), mean(b.vx), mean(b.vy), b.pressureOf(at.i, at.j), b.sxx[c], b.syy[c], b.sxy[c], b.eqps[c] };
}
}
