// SPDX-License-Identifier: GPL-2.0-or-later
#include "sweep.hpp"
#include <algorithm>
#include <cstring>

namespace mca::grid {

void Workspace::fit(size_t pitch, bool edges)
{
	if (pitch <= pitch_ && (edges_ || !edges)) return;
	pitch_ = std::max(pitch, pitch_);
	edges_ = edges || edges_;
	arena_ = Arena(17, pitch_);
	size_t k = 0;
	for (RowForces& f : ring_)
		for (double** p : { &f.t0x, &f.t0y, &f.t1x, &f.t1y, &f.rx, &f.ry })
			*p = arena_.array(k++);
	for (double*& m : mean_)
		m = arena_.array(k++);
	zeros_ = arena_.array(k);
}

CellConstants cellConstants(const Block& b, double dtPrevious)
{
	CellConstants c;
	c.eos       = b.material.eos;
	c.yield     = b.material.yield;
	c.viscosity = b.material.viscosity;
	c.G         = b.material.G;
	c.hourglass = b.options.hourglass;
	c.spall     = b.material.fracture.spall;
	c.dt        = dtPrevious;
	return c;
}

namespace {

	/// Nodes [lo,hi) between two rows of cells: force = (cells below) + (cells above), then v^(n+1/2), x^(n+1).
	template <bool account>
	void moveNodes(
		const Block& b, int j, int lo, int hi, const RowForces& below, const RowForces& above, double dt, double kick, double restSpeed, double* wx,
		double* wy)
	{
		const size_t n = b.node(0, j);
		double* __restrict x        = b.x + n;
		double* __restrict y        = b.y + n;
		double* __restrict vx       = b.vx + n;
		double* __restrict vy       = b.vy + n;
		const double* __restrict im = b.invMass + n;
		const double* __restrict b0x = below.t0x;
		const double* __restrict b0y = below.t0y;
		const double* __restrict b1x = below.t1x;
		const double* __restrict b1y = below.t1y;
		const double* __restrict brx = below.rx;
		const double* __restrict bry = below.ry;
		const double* __restrict a0x = above.t0x;
		const double* __restrict a0y = above.t0y;
		const double* __restrict a1x = above.t1x;
		const double* __restrict a1y = above.t1y;
		const double* __restrict arx = above.rx;
		const double* __restrict ary = above.ry;
		double* __restrict mx = wx;
		double* __restrict my = wy;
#pragma omp simd
		for (int i = lo; i < hi; i++) {
			// below: corner 2 of the left cell, corner 3 of the right one; above: corner 1 of the left cell, corner 0 of the right one
			const double fx = ((brx[i] - b1x[i]) - (b0x[i - 1] + brx[i - 1])) + ((a1x[i - 1] + arx[i - 1]) + (a0x[i] - arx[i]));
			const double fy = ((bry[i] - b1y[i]) - (b0y[i - 1] + bry[i - 1])) + ((a1y[i - 1] + ary[i - 1]) + (a0y[i] - ary[i]));
			const double s  = kick * im[i];
			const double ux = vx[i] + s * fx, uy = vy[i] + s * fy;
			const bool   moves = std::fabs(ux) + std::fabs(uy) > restSpeed;
			const double nx = moves ? ux : 0., ny = moves ? uy : 0.;
			if constexpr (account) {
				mx[i] = 0.5 * (vx[i] + nx);
				my[i] = 0.5 * (vy[i] + ny);
			}
			vx[i] = nx;
			vy[i] = ny;
			x[i] += dt * nx;
			y[i] += dt * ny;
		}
	}

	/// Internal energy of cells [lo,hi): minus the work of their corner forces; w0, w1: mean velocities of the node rows below and above.
	void cellWork(double* e, int lo, int hi, const RowForces& f, const double* w0x, const double* w0y, const double* w1x, const double* w1y, double dt)
	{
		double* __restrict energy    = e;
		const double* __restrict t0x = f.t0x;
		const double* __restrict t0y = f.t0y;
		const double* __restrict t1x = f.t1x;
		const double* __restrict t1y = f.t1y;
		const double* __restrict rx  = f.rx;
		const double* __restrict ry  = f.ry;
#pragma omp simd
		for (int i = lo; i < hi; i++) {
			const CellPattern w = cellPattern(w0x[i], w0y[i], w0x[i + 1], w0y[i + 1], w1x[i + 1], w1y[i + 1], w1x[i], w1y[i]);
			energy[i] += dt * (((t0x[i] * w.x20 + t0y[i] * w.y20) + (t1x[i] * w.x31 + t1y[i] * w.y31)) + (rx[i] * w.hx + ry[i] * w.hy));
		}
	}

	/// Forces of the four cells around node (i,j) into the slots of its copy; a null row of cells adds nothing.
	void toSlots(const Block& b, int i, int copy, const RowForces* below, const RowForces* above, const Step& s)
	{
		if (above) {
			if (i < b.ni) {
				s.cornerX[0][copy] = above->t0x[i] - above->rx[i];
				s.cornerY[0][copy] = above->t0y[i] - above->ry[i];
			}
			if (i > 0) {
				s.cornerX[1][copy] = above->t1x[i - 1] + above->rx[i - 1];
				s.cornerY[1][copy] = above->t1y[i - 1] + above->ry[i - 1];
			}
		}
		if (below) {
			if (i > 0) {
				s.cornerX[2][copy] = -(below->t0x[i - 1] + below->rx[i - 1]);
				s.cornerY[2][copy] = -(below->t0y[i - 1] + below->ry[i - 1]);
			}
			if (i < b.ni) {
				s.cornerX[3][copy] = below->rx[i] - below->t1x[i];
				s.cornerY[3][copy] = below->ry[i] - below->t1y[i];
			}
		}
	}

	bool isMoving(const Block& b, size_t n) { return b.vx[n] != 0. || b.vy[n] != 0.; }

	/// Closed nodes of node row j, which lies between two rows of cells; open ones only get their slots filled.
	void nodeRow(Block& b, int j, const RowForces& below, const RowForces& above, const Step& s, double* wx, double* wy)
	{
		const Range r = hull(b.awake[size_t(j) - 1], b.awake[size_t(j)]);
		if (r.empty()) return;
		const int lo = std::max(r.lo, 1), hi = std::min(r.hi + 1, b.ni); // nodes of the cells, without the two columns at the sides

		// open nodes inside the block: put back what the vector loop does to them
		const int first = b.interiorOpenRowStart[size_t(j)], last = b.interiorOpenRowStart[size_t(j) + 1];
		struct Kept { double x, y, vx, vy; };
		std::vector<Kept> kept;
		for (int k = first; k < last; k++) {
			const size_t n = b.node(b.interiorOpen[size_t(k)] % (b.ni + 1), j);
			kept.push_back({ b.x[n], b.y[n], b.vx[n], b.vy[n] });
		}
		if (b.account) moveNodes<true>(b, j, lo, hi, below, above, s.dt, s.kick, s.restSpeed, wx, wy);
		else moveNodes<false>(b, j, lo, hi, below, above, s.dt, s.kick, s.restSpeed, wx, wy);
		if (b.account) wx[0] = wy[0] = wx[b.ni] = wy[b.ni] = 0.;
		for (int k = first; k < last; k++) {
			const int    i = b.interiorOpen[size_t(k)] % (b.ni + 1);
			const size_t n = b.node(i, j);
			const Kept&  o = kept[size_t(k - first)];
			b.x[n] = o.x, b.y[n] = o.y, b.vx[n] = o.vx, b.vy[n] = o.vy;
			if (b.account) wx[i] = wy[i] = 0.;
			if (i >= r.lo && i <= r.hi) toSlots(b, i, b.copyOf(i, j), &below, &above, s);
		}
		if (r.lo == 0) toSlots(b, 0, b.firstCopy + b.perimeterCopy(0, j), &below, &above, s);
		if (r.hi == b.ni) toSlots(b, b.ni, b.firstCopy + b.perimeterCopy(b.ni, j), &below, &above, s);

		if (!b.allAwake) {
			Range m { lo, hi };
			while (m.lo < m.hi && !isMoving(b, b.node(m.lo, j))) m.lo++;
			while (m.lo < m.hi && !isMoving(b, b.node(m.hi - 1, j))) m.hi--;
			b.moving[size_t(j)] = m;
		}
	}

	/// Where cell row j keeps its forces: rows at the ends of a band outlive the sweep of the band.
	RowForces rowForces(const Block& b, int band, int j, Workspace& ws)
	{
		const int j0 = b.bandStart[size_t(band)], j1 = b.bandStart[size_t(band) + 1];
		RowForces f  = j == j0 ? b.seamRow[size_t(band) * 2] : j == j1 - 1 ? b.seamRow[size_t(band) * 2 + 1] : ws.ring(j);
		if (!b.limiterX) { // without edge viscosity the hourglass force of the state is the one that acts
			f.rx = b.rx + b.cell(0, j);
			f.ry = b.ry + b.cell(0, j);
		}
		return f;
	}

	/// Cells asleep next to cells awake give no force: their buffers must say so.
	void clearAsleep(const Block& b, int j, const RowForces& f)
	{
		Range h = b.awake[size_t(j)];
		if (j > 0) h = hull(h, b.awake[size_t(j) - 1]);
		if (j + 1 < b.nj) h = hull(h, b.awake[size_t(j) + 1]);
		if (h.empty()) return;
		const Range r = b.awake[size_t(j)].empty() ? Range { h.hi, h.hi } : b.awake[size_t(j)];
		for (double* p : { f.t0x, f.t0y, f.t1x, f.t1y }) {
			for (int i = std::max(h.lo - 1, 0); i < r.lo; i++) p[i] = 0.;
			for (int i = r.hi; i < std::min(h.hi + 1, b.ni); i++) p[i] = 0.;
		}
		if (!b.limiterX) return;
		for (double* p : { f.rx, f.ry }) {
			for (int i = std::max(h.lo - 1, 0); i < r.lo; i++) p[i] = 0.;
			for (int i = r.hi; i < std::min(h.hi + 1, b.ni); i++) p[i] = 0.;
		}
	}
}

void sweepBand(Block& b, int band, const Step& s, Workspace& ws)
{
	ws.fit(b.pitch, b.limiterX != nullptr);
	const int           j0 = b.bandStart[size_t(band)], j1 = b.bandStart[size_t(band) + 1];
	const CellConstants constants = cellConstants(b, s.dtPrevious);
	const RowKernel     kernel    = dispatch(b.material.yield.kind, [&](auto kind) { return rowKernelOf<kind.value>(b); });
	uint64_t            worst     = 0;
	RowForces           below;
	for (int j = j0; j < j1; j++) {
		const RowForces f = rowForces(b, band, j, ws);
		const Range     r = b.awake[size_t(j)];
		if (!b.allAwake) clearAsleep(b, j, f);
		if (!r.empty()) {
			worst = std::max(worst, kernel(b, j, r.lo, r.hi, constants, f));
			if (b.limiterX) worst = std::max(worst, edgeRow(b, j, r.lo, r.hi, constants, f));
		}
		if (j > j0) {
			nodeRow(b, j, below, f, s, ws.meanVx(j), ws.meanVy(j));
			const Range q = b.awake[size_t(j) - 1];
			if (b.account && !q.empty()) {
				const bool seam = j - 1 == j0; // the row below the first cells is a seam or a side: its turn comes later
				cellWork(
					b.energy + b.cell(0, j - 1), q.lo, q.hi, below, seam ? ws.zeros() : ws.meanVx(j - 1),
					seam ? ws.zeros() : ws.meanVy(j - 1), ws.meanVx(j), ws.meanVy(j), s.kick);
			}
		}
		if (j == 0)
			for (int i = r.lo; i <= r.hi && !r.empty(); i++) toSlots(b, i, b.firstCopy + i, nullptr, &f, s);
		if (j == b.nj - 1)
			for (int i = r.lo; i <= r.hi && !r.empty(); i++) toSlots(b, i, b.firstCopy + (b.ni + 1) + i, &f, nullptr, s);
		below = f;
	}
	const Range q = b.awake[size_t(j1) - 1];
	if (b.account && j1 - j0 > 1 && !q.empty())
		cellWork(b.energy + b.cell(0, j1 - 1), q.lo, q.hi, below, ws.meanVx(j1 - 1), ws.meanVy(j1 - 1), ws.zeros(), ws.zeros(), s.kick);
	b.bandWorst[size_t(band)] = worst;
}

void finishSeam(Block& b, int band, const Step& s, Workspace& ws)
{
	ws.fit(b.pitch, b.limiterX != nullptr);
	const int       j = b.bandStart[size_t(band) + 1];
	const RowForces below = rowForces(b, band, j - 1, ws), above = rowForces(b, band + 1, j, ws);
	nodeRow(b, j, below, above, s, ws.meanVx(0), ws.meanVy(0));
	if (!b.account) return;
	const Range q = b.awake[size_t(j) - 1], r = b.awake[size_t(j)];
	if (!q.empty()) cellWork(b.energy + b.cell(0, j - 1), q.lo, q.hi, below, ws.zeros(), ws.zeros(), ws.meanVx(0), ws.meanVy(0), s.kick);
	if (!r.empty()) cellWork(b.energy + b.cell(0, j), r.lo, r.hi, above, ws.meanVx(0), ws.meanVy(0), ws.zeros(), ws.zeros(), s.kick);
}

void openNodeWork(Block& b, int i, int j, const double* cx[4], const double* cy[4], int copy, double wx, double wy, double dt)
{
	static const int di[4] = { 0, -1, -1, 0 }, dj[4] = { 0, 0, -1, -1 };
	for (int c = 0; c < 4; c++) {
		const int ci = i + di[c], cj = j + dj[c];
		if (ci < 0 || cj < 0 || ci >= b.ni || cj >= b.nj) continue;
		b.energy[b.cell(ci, cj)] -= dt * (cx[c][copy] * wx + cy[c][copy] * wy);
	}
}

void wake(Block& b)
{
	if (b.allAwake) return;
	for (int j = 0; j <= b.nj; j++) { // add the open nodes at the ends of each node row, and the two rows that are all open
		Range& m = b.moving[size_t(j)];
		if (j == 0 || j == b.nj) {
			m = { 0, b.ni + 1 };
			while (m.lo < m.hi && !isMoving(b, b.node(m.lo, j))) m.lo++;
			while (m.lo < m.hi && !isMoving(b, b.node(m.hi - 1, j))) m.hi--;
		} else {
			if (isMoving(b, b.node(0, j))) m = hull(m, { 0, 1 });
			if (isMoving(b, b.node(b.ni, j))) m = hull(m, { b.ni, b.ni + 1 });
			for (int k = b.interiorOpenRowStart[size_t(j)]; k < b.interiorOpenRowStart[size_t(j) + 1]; k++) {
				const int i = b.interiorOpen[size_t(k)] % (b.ni + 1);
				if (isMoving(b, b.node(i, j))) m = hull(m, { i, i + 1 });
			}
		}
	}
	bool all = true;
	for (int j = 0; j < b.nj; j++) {
		Range& r = b.awake[size_t(j)];
		if (r.lo == 0 && r.hi == b.ni) continue;
		const Range m = hull(b.moving[size_t(j)], b.moving[size_t(j) + 1]);
		if (!m.empty()) { // node i touches cells i-1 and i
			Range c { (m.lo - 1) / wakeCells * wakeCells, (m.hi + wakeCells - 1) / wakeCells * wakeCells };
			c.lo = std::max(c.lo, 0);
			c.hi = std::min(c.hi, b.ni);
			r    = hull(r, c);
		}
		all = all && r.lo == 0 && r.hi == b.ni;
	}
	b.allAwake = all;
}
}
