// SPDX-License-Identifier: GPL-2.0-or-later
#include "boundary.hpp"
#include <algorithm>
#include <cmath>

namespace mca::grid {

double Table::at(double t) const
{
	if (value.empty()) return 0.;
	if (value.size() == 1 || t <= time.front()) return value.front();
	if (t >= time.back()) return value.back();
	const size_t k = size_t(std::upper_bound(time.begin(), time.end(), t) - time.begin());
	const double w = (t - time[k - 1]) / (time[k] - time[k - 1]);
	return value[k - 1] + w * (value[k] - value[k - 1]);
}

void Table::validate(const std::string& what) const
{
	if (value.empty() || value.size() != time.size())
		throw Error(what + ": a table needs as many values as times, at least one; it has " + std::to_string(time.size()) + " times and "
		            + std::to_string(value.size()) + " values.");
	for (size_t k = 0; k < value.size(); k++) {
		if (!std::isfinite(value[k]) || !std::isfinite(time[k]))
			throw Error(what + ": entry " + std::to_string(k) + " of the table is not finite; give finite times [s] and values.");
		if (!(std::fabs(value[k]) <= 1e18))
			throw Error(
				what + ": entry " + std::to_string(k) + " of the table is " + std::to_string(value[k])
				+ "; it must lie within -1e18 and 1e18, beyond which no number of the grid stays finite.");
		if (k && !(time[k] > time[k - 1]))
			throw Error(
				what + ": times must rise, but entry " + std::to_string(k) + " (" + std::to_string(time[k])
				+ " s) does not exceed the one before it.");
	}
}

int Boundary::addTable(const Table& t)
{
	tables_.push_back(t);
	return int(tables_.size()) - 1;
}

void Boundary::mark(int node)
{
	const auto it = std::lower_bound(special_.begin(), special_.end(), node);
	if (it == special_.end() || *it != node) special_.insert(it, node);
}

std::pair<size_t, size_t> Boundary::constraintsOf(int node) const
{
	const auto less = [](const Constraint& c, int n) { return c.node < n; };
	const auto lo   = std::lower_bound(constraints_.begin(), constraints_.end(), node, less);
	const auto hi   = std::lower_bound(lo, constraints_.end(), node + 1, less);
	return { size_t(lo - constraints_.begin()), size_t(hi - constraints_.begin()) };
}

/// A velocity is prescribed along the same direction at both ends: then the edge may not be viscous as well.
bool Boundary::heldAlike(int a, int b) const
{
	const auto ra = constraintsOf(a), rb = constraintsOf(b);
	for (size_t p = ra.first; p < ra.second; p++)
		for (size_t q = rb.first; q < rb.second; q++)
			if (std::fabs(constraints_[p].nx * constraints_[q].ny - constraints_[p].ny * constraints_[q].nx) < 1e-6) return true;
	return false;
}

void Boundary::constrain(int node, double nx, double ny, int table, const std::string& where)
{
	const auto range = constraintsOf(node);
	for (size_t k = range.first; k < range.second; k++) {
		const Constraint& c = constraints_[k];
		if (std::fabs(c.nx * ny - c.ny * nx) > 1e-6) continue;
		const Table &a = tables_[size_t(c.table)], &b = tables_[size_t(table)];
		const double sign = c.nx * nx + c.ny * ny > 0 ? 1. : -1.;
		bool         same = a.time == b.time && a.value.size() == b.value.size();
		for (size_t e = 0; same && e < a.value.size(); e++) same = a.value[e] == sign * b.value[e];
		if (same) return; // the corner of two sides held alike
		std::ostringstream s;
		s << "overlapping boundary conditions at " << where << ": two different velocities are prescribed along the direction (" << nx << ", " << ny
		  << "). Remove one of them.";
		throw Error(s.str());
	}
	if (range.second - range.first >= 2)
		throw Error("overlapping boundary conditions at " + where + ": more than two velocity components are prescribed. Remove one of them.");
	constraints_.insert(constraints_.begin() + long(range.second), Constraint { node, nx, ny, table });
	const auto near = viscousAt_.equal_range(node);
	for (auto it = near.first; it != near.second; ++it)
		if (heldAlike(node, it->second)) {
			constraints_.erase(constraints_.begin() + long(range.second));
			throw Error(
				"overlapping boundary conditions at " + where + ": the edge is viscous and its velocity is prescribed. Remove one of them.");
		}
	mark(node);
}

void Boundary::load(const EdgeLoad& l, const std::string& where)
{
	const auto range = loadOf_.equal_range({ l.a, l.b });
	for (auto it = range.first; it != range.second; ++it) {
		const EdgeLoad& o = edgeLoads_[it->second];
		if (o.kind == LoadKind::viscous || l.kind == LoadKind::viscous || o.kind == l.kind)
			throw Error(
				"overlapping boundary conditions at " + where + ": the edge already carries a "
				+ (o.kind == LoadKind::viscous            ? "viscous boundary"
			                   : o.kind == LoadKind::pressure ? "pressure"
			                                                  : "traction")
				+ ". Remove one of them.");
	}
	if (l.kind == LoadKind::viscous && heldAlike(l.a, l.b))
		throw Error("overlapping boundary conditions at " + where + ": the edge is viscous and its velocity is prescribed. Remove one of them.");
	edgeLoads_.push_back(l);
	index(edgeLoads_.size() - 1);
}

void Boundary::index(size_t k)
{
	const EdgeLoad& l = edgeLoads_[k];
	loadOf_.insert({ { l.a, l.b }, k });
	if (l.kind != LoadKind::viscous) return;
	viscousAt_.insert({ l.a, l.b });
	viscousAt_.insert({ l.b, l.a });
	mark(l.a);
	mark(l.b);
}

void Boundary::indexAll()
{
	loadOf_.clear();
	viscousAt_.clear();
	special_.clear();
	for (size_t k = 0; k < edgeLoads_.size(); k++) index(k);
	for (const Constraint& c : constraints_) mark(c.node);
}

void Boundary::forces(OpenNodes& o, double t) const
{
	std::fill(o.lx.begin(), o.lx.end(), 0.);
	std::fill(o.ly.begin(), o.ly.end(), 0.);
	if (edgeLoads_.empty() && nodeLoads_.empty()) return;
	std::vector<double> now(tables_.size());
	for (size_t k = 0; k < tables_.size(); k++) now[k] = tables_[k].at(t);
	for (const EdgeLoad& l : edgeLoads_) {
		double fx = 0, fy = 0;
		const size_t a = size_t(l.a), b = size_t(l.b);
		if (l.kind == LoadKind::traction) {
			fx = 0.5 * l.restLength * now[size_t(l.tableX)];
			fy = 0.5 * l.restLength * now[size_t(l.tableY)];
		} else if (l.kind == LoadKind::pressure) { // outward normal times length: (dy, -dx)
			const double p = now[size_t(l.tableX)];
			fx             = -0.5 * p * (o.y[b] - o.y[a]);
			fy             = 0.5 * p * (o.x[b] - o.x[a]);
		} else
			continue;
		o.lx[a] += fx, o.ly[a] += fy;
		o.lx[b] += fx, o.ly[b] += fy;
	}
	for (const NodeLoad& l : nodeLoads_) {
		o.lx[size_t(l.node)] += now[size_t(l.tableX)];
		o.ly[size_t(l.node)] += now[size_t(l.tableY)];
	}
}

void Boundary::viscous(const OpenNodes& o)
{
	if (viscousAt_.empty()) return;
	const size_t n = size_t(o.size());
	cxx_.assign(n, 0.);
	cxy_.assign(n, 0.);
	cyy_.assign(n, 0.);
	for (const EdgeLoad& l : edgeLoads_) {
		if (l.kind != LoadKind::viscous) continue;
		const double dx = o.x[size_t(l.b)] - o.x[size_t(l.a)], dy = o.y[size_t(l.b)] - o.y[size_t(l.a)];
		const double len = std::sqrt(dx * dx + dy * dy), nx = dy / len, ny = -dx / len;
		// Lysmer & Kuhlemeyer: traction -rho cP v_n n - rho cS v_t t, half of the edge to each end
		const double xx = 0.5 * len * (l.zP * nx * nx + l.zS * ny * ny), yy = 0.5 * len * (l.zP * ny * ny + l.zS * nx * nx);
		const double xy = 0.5 * len * (l.zP - l.zS) * nx * ny;
		for (const int k : { l.a, l.b }) {
			cxx_[size_t(k)] += xx;
			cxy_[size_t(k)] += xy;
			cyy_[size_t(k)] += yy;
		}
	}
}

/// Node with constraints or viscous edges: its new velocity, and the forces of both.
Boundary::Special Boundary::accelerateSpecial(const OpenNodes& o, int node, double mid, double kick, double restSpeed) const
{
	const size_t k  = size_t(node);
	const double fx = o.fx[k] + o.lx[k] + o.ex[k], fy = o.fy[k] + o.ly[k] + o.ey[k], m = o.mass[k] / kick;
	double       xx = 0, xy = 0, yy = 0;
	if (!viscousAt_.empty()) xx = 0.5 * cxx_[k], xy = 0.5 * cxy_[k], yy = 0.5 * cyy_[k];
	// (m/kick + C/2) u = (m/kick - C/2) v + F: stable for any step, and dissipates exactly C w . w
	const double bx = m * o.vx[k] - (xx * o.vx[k] + xy * o.vy[k]) + fx, by = m * o.vy[k] - (xy * o.vx[k] + yy * o.vy[k]) + fy;
	const double axx = m + xx, ayy = m + yy, det = axx * ayy - xy * xy;
	Special      r;
	r.ux = (ayy * bx - xy * by) / det;
	r.uy = (axx * by - xy * bx) / det;
	const auto range = constraintsOf(node);
	if (range.second - range.first == 1) {
		const Constraint& c      = constraints_[range.first];
		const double      change = tables_[size_t(c.table)].at(mid) - (r.ux * c.nx + r.uy * c.ny);
		r.ux += change * c.nx;
		r.uy += change * c.ny;
	} else if (range.second - range.first == 2) {
		const Constraint &c = constraints_[range.first], &d = constraints_[range.first + 1];
		const double      p = tables_[size_t(c.table)].at(mid), q = tables_[size_t(d.table)].at(mid), sine = c.nx * d.ny - c.ny * d.nx;
		r.ux = (p * d.ny - q * c.ny) / sine;
		r.uy = (q * c.nx - p * d.nx) / sine;
	}
	if (!(std::fabs(r.ux) + std::fabs(r.uy) > restSpeed)) r.ux = r.uy = 0.;
	const double wx = 0.5 * (o.vx[k] + r.ux), wy = 0.5 * (o.vy[k] + r.uy);
	r.qx = -2. * (xx * wx + xy * wy), r.qy = -2. * (xy * wx + yy * wy);
	const bool held = range.second > range.first;
	r.rx = held ? m * (r.ux - o.vx[k]) - fx - r.qx : 0.;
	r.ry = held ? m * (r.uy - o.vy[k]) - fy - r.qy : 0.;
	return r;
}

void Boundary::accelerate(OpenNodes& o, double t, double dt, double kick, double restSpeed, Account& acc)
{
	viscous(o);
	std::vector<Special> special;
	special.reserve(special_.size());
	for (const int k : special_) special.push_back(accelerateSpecial(o, k, t + 0.5 * dt, kick, restSpeed));

	// all nodes as if they were free
	const long n = o.size();
	double *   x = o.x.data(), *y = o.y.data(), *vx = o.vx.data(), *vy = o.vy.data(), *wx = o.wx.data(), *wy = o.wy.data();
	double *   ex = o.ex.data(), *ey = o.ey.data();
	const double *m = o.mass.data(), *fx = o.fx.data(), *fy = o.fy.data(), *lx = o.lx.data(), *ly = o.ly.data();
	double     loads = 0, external = 0, impulseX = 0, impulseY = 0;
#pragma omp simd
	for (long k = 0; k < n; k++) {
		const double s  = kick / m[k];
		const double ux = vx[k] + s * (fx[k] + lx[k] + ex[k]), uy = vy[k] + s * (fy[k] + ly[k] + ey[k]);
		const bool   moves = std::fabs(ux) + std::fabs(uy) > restSpeed;
		wx[k] = moves ? ux : 0.;
		wy[k] = moves ? uy : 0.;
	}
	for (size_t q = 0; q < special_.size(); q++) {
		const size_t k = size_t(special_[q]);
		wx[k] = special[q].ux;
		wy[k] = special[q].uy;
	}
#pragma omp simd reduction(+ : loads, external, impulseX, impulseY)
	for (long k = 0; k < n; k++) {
		const double ux = wx[k], uy = wy[k];
		wx[k] = 0.5 * (vx[k] + ux);
		wy[k] = 0.5 * (vy[k] + uy);
		loads += lx[k] * wx[k] + ly[k] * wy[k];
		external += ex[k] * wx[k] + ey[k] * wy[k];
		impulseX += lx[k] + ex[k];
		impulseY += ly[k] + ey[k];
		ex[k] = ey[k] = 0.;
		vx[k] = ux;
		vy[k] = uy;
		x[k] += dt * ux;
		y[k] += dt * uy;
	}
	double held = 0, damped = 0;
	for (size_t q = 0; q < special_.size(); q++) {
		const Special& r = special[q];
		const size_t   k = size_t(special_[q]);
		held += r.rx * wx[k] + r.ry * wy[k];
		damped += r.qx * wx[k] + r.qy * wy[k];
		impulseX += r.rx + r.qx;
		impulseY += r.ry + r.qy;
	}
	acc.loads += kick * loads;
	acc.external += kick * external;
	acc.constraints += kick * held;
	acc.viscous += kick * damped;
	acc.impulseX += kick * impulseX;
	acc.impulseY += kick * impulseY;
}
}
