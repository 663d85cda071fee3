// SPDX-License-Identifier: GPL-2.0-or-later
// A state that was read from somewhere: whatever made it, no sweep may index or divide by what it holds unless it was looked at here.
#include "grid.hpp"
#include <algorithm>
#include <cmath>

namespace mca::grid {
namespace {
	void need(bool ok, const char* what)
	{
		if (!ok) throw Error(std::string("grid: the saved state is damaged (") + what + "); it cannot be restored.");
	}
	/// beyond it squares overflow; NaN is not inside
	constexpr double largest = 1e150;
	bool             finite(double x) { return std::fabs(x) < largest; }
	bool             finite(const std::vector<double>& v)
	{
		return std::all_of(v.begin(), v.end(), [](double x) { return finite(x); });
	}
	bool within(const std::vector<int>& v, int end)
	{
		return std::all_of(v.begin(), v.end(), [&](int k) { return k >= 0 && k < end; });
	}
	/// f(x) for the numbers of the first `width` entries of `rows` rows
	template <class F> bool rows(const Block& b, const double* v, int width, int count, F&& f)
	{
		bool ok = true;
		for (int j = 0; j < count; j++)
			for (int i = 0; i < width; i++) ok &= f(v[size_t(j) * b.pitch + size_t(i)]);
		return ok;
	}
	bool ranges(const std::vector<Range>& v, int count, int end)
	{
		return v.size() == size_t(count)
			&& std::all_of(v.begin(), v.end(), [&](const Range& r) { return r.lo >= 0 && r.lo <= end && r.hi >= 0 && r.hi <= end; });
	}
} // namespace

void Grid::checkBlock(const Block& b, int copies) const
{
	const auto number = [](double x) { return finite(x); };
	const auto above  = [](double x) { return x > 0 && x < largest; };
	validate(b.material, b.options.name);
	need(b.options.hourglass >= 0 && b.options.hourglass <= 4, "hourglass");
	need(b.account || !b.material.eos.heats(), "account");
	for (const double* v : { b.x, b.y, b.vx, b.vy }) need(rows(b, v, b.ni + 1, b.nj + 1, number), "a position or velocity");
	need(rows(b, b.restArea, b.ni, b.nj, above), "a rest area");
	if (built_) need(rows(b, b.invMass, b.ni + 1, b.nj + 1, above), "a mass");
	for (const double* v : { b.sxx, b.syy, b.sxy, b.eqps, b.rx, b.ry, b.energy, b.temperature })
		if (v && failure_.empty()) need(rows(b, v, b.ni, b.nj, number), "a stress, strain or energy"); // a grid that was stopped by them does not go on
	need(ranges(b.awake, b.nj, b.ni) && ranges(b.moving, b.nj + 1, b.ni + 1), "what is awake");
	if (b.allAwake)
		for (const Range& r : b.awake) need(r.lo == 0 && r.hi == b.ni, "what is awake");
	need(b.bandWorst.size() + 1 == b.bandStart.size(), "the number of bands");

	// open nodes inside the block: ascending, and the first of each row
	int before = -1;
	for (const int n : b.interiorOpen) {
		need(n > before && n / (b.ni + 1) < b.nj && !b.isPerimeter(n % (b.ni + 1), n / (b.ni + 1)), "an open node");
		before = n;
	}
	need(b.interiorOpenRowStart.size() == size_t(b.nj) + 2, "the open nodes of a row");
	if (!built_) return;
	for (int j = -1; j <= b.nj; j++)
		need(b.interiorOpenRowStart[size_t(j) + 1]
		             == int(std::lower_bound(b.interiorOpen.begin(), b.interiorOpen.end(), int64_t(j + 1) * (b.ni + 1)) - b.interiorOpen.begin()),
		     "the open nodes of a row");
	need(b.firstCopy == copies && size_t(b.nCopies) == 2 * (size_t(b.ni) + 1) + 2 * (size_t(b.nj) - 1) + b.interiorOpen.size(), "the number of open nodes");
}

void Grid::checkOpen() const
{
	const OpenNodes& o = open_;
	const size_t     n = o.x.size(), copies = o.copyNode.size();
	for (const auto* v : { &o.y, &o.vx, &o.vy, &o.mass, &o.addedMass, &o.fx, &o.fy, &o.lx, &o.ly, &o.ex, &o.ey, &o.wx, &o.wy })
		need(v->size() == n, "the number of open nodes");
	for (const auto* v : { &o.copyMass, &o.copyVx, &o.copyVy }) need(v->size() == copies && finite(*v), "the open nodes of blocks");
	for (const auto& v : o.corner) need(v.size() == copies && (!failure_.empty() || finite(v)), "the forces on open nodes");
	need(o.copyMaster.size() == copies && o.copyBlock.size() == copies && o.firstCopy.size() == n && o.repeats.size() + n == copies,
	     "the number of open nodes");
	size_t c = 0;
	for (size_t k = 0; k < blocks_.size(); k++)
		for (int q = 0; built_ && q < blocks_[k]->nCopies; q++, c++) {
			int i, j;
			need(c < copies, "the number of open nodes");
			blocks_[k]->nodeOfCopy(int(c), i, j);
			need(o.copyBlock[c] == int(k) && o.copyNode[c] == blocks_[k]->node(i, j), "an open node of a block");
		}
	need(c == copies, "the number of open nodes");
	need(within(o.copyMaster, int(n)) && within(o.repeats, int(copies)) && within(o.firstCopy, int(copies)), "an open node");
	std::vector<char> seen(copies, 0); // each copy is either the first of its node or one of the others
	for (size_t k = 0; k < n; k++) {
		const size_t f = size_t(o.firstCopy[k]);
		need(!seen[f] && size_t(o.copyMaster[f]) == k, "the first copy of an open node");
		seen[f] = 1;
	}
	for (const int r : o.repeats) {
		need(!seen[size_t(r)], "a copy of an open node");
		seen[size_t(r)] = 1;
	}
	for (const auto* v : { &o.x, &o.y, &o.vx, &o.vy, &o.addedMass, &o.lx, &o.ly, &o.wx, &o.wy }) need(finite(*v), "a number of an open node");
	for (const auto* v : { &o.fx, &o.fy, &o.ex, &o.ey })
		need(!failure_.empty() || between_ || finite(*v), "a force on an open node"); // integrate() looks at them
	for (const double m : o.mass) need(m > 0 && finite(m), "the mass of an open node");
}

void Boundary::checkState(int nodes) const
{
	const int  tables = int(tables_.size());
	const auto node   = [&](int k) { return k >= 0 && k < nodes; };
	const auto table  = [&](int k) { return k >= 0 && k < tables; };
	for (const Table& t : tables_) t.validate("grid: the saved state is damaged: boundary condition");
	for (size_t k = 0; k < constraints_.size(); k++) {
		const Constraint& c = constraints_[k];
		need(node(c.node) && table(c.table) && std::fabs(std::hypot(c.nx, c.ny) - 1.) < 1e-6, "a prescribed velocity");
		need(k < 1 || constraints_[k - 1].node <= c.node, "the order of the prescribed velocities");
		need(k < 2 || constraints_[k - 2].node < c.node, "three prescribed velocities at one node");
		if (k && constraints_[k - 1].node == c.node)
			need(std::fabs(constraints_[k - 1].nx * c.ny - constraints_[k - 1].ny * c.nx) > 1e-7, "two prescribed velocities along one direction");
	}
	for (const EdgeLoad& l : edgeLoads_) {
		need(node(l.a) && node(l.b) && l.a != l.b && l.restLength > 0 && finite(l.restLength) && l.zP >= 0 && finite(l.zP) && l.zS >= 0 && finite(l.zS),
		     "a load on an edge");
		need(l.kind == LoadKind::viscous || (table(l.tableX) && (l.kind == LoadKind::pressure || table(l.tableY))), "a load on an edge");
	}
	for (const NodeLoad& l : nodeLoads_) need(node(l.node) && table(l.tableX) && table(l.tableY), "a force on a node");
}

void Grid::checkState() const
{
	need(options_.safety > 0 && options_.safety <= 1, "an option");
	int copies = 0;
	for (const auto& b : blocks_) {
		checkBlock(*b, copies);
		if (built_) copies += b->nCopies;
	}
	need(!built_ || !blocks_.empty(), "the number of blocks");
	checkOpen();
	boundary_.checkState(open_.size());
	for (const Gauge& g : gauges_) {
		need(g.at.block >= 0 && g.at.block < blocks() && g.period > 0 && finite(g.at.u) && finite(g.at.v), "a gauge");
		const Block& b = *blocks_[size_t(g.at.block)];
		need(g.at.i >= 0 && g.at.i < b.ni && g.at.j >= 0 && g.at.j < b.nj, "a gauge");
		for (const Sample& s : g.history)
			for (const double v : { s.time, s.x, s.y, s.vx, s.vy, s.pressure, s.sxx, s.syy, s.sxy, s.eqps })
				need(!failure_.empty() || finite(v), "the history of a gauge");
	}
	for (const double v : { time_, dtPrevious_, dtNow_, restSpeed_, maxRate_, restRate_ })
		need(v >= 0 && (finite(v) || !failure_.empty()), "a time or rate");
	for (const double v : { account_.loads, account_.external, account_.constraints, account_.viscous, account_.impulseX, account_.impulseY })
		need(!failure_.empty() || finite(v), "the account of energy");
	need(steps_ >= 0 && (built_ || (!between_ && steps_ == 0)), "the number of steps");
}
} // namespace mca::grid
