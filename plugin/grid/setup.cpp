// SPDX-License-Identifier: GPL-2.0-or-later
// Set-up of a grid: blocks, joining of sides, masses, initial state.
#include "grid.hpp"
#include "sweep.hpp"
#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace mca::grid {

Grid::Grid(const GridOptions& options)
        : options_(options)
{
	if (!(options.safety > 0 && options.safety <= 1))
		throw Error("grid: safety = " + std::to_string(options.safety) + " is not allowed; it must be in (0, 1].");
}
Grid::~Grid() = default;

std::vector<double> gradedLine(double a, double b, double h0, double h1)
{
	const double len = std::fabs(b - a);
	if (!(h0 > 0) || !(h1 > 0) || !std::isfinite(h0) || !std::isfinite(h1) || !(len > 0) || !std::isfinite(len))
		throw Error("graded line: ends must differ and first and last spacing be finite and above zero.");
	// sum of a geometric series from h0 to h1 over n cells, then all stretched to fit
	const int           n = std::max(1, int(std::lround(std::fabs(h1 - h0) < 1e-9 * h0 ? len / h0 : len * std::log(h1 / h0) / (h1 - h0))));
	std::vector<double> x(size_t(n) + 1, 0.);
	const double        f = n > 1 ? std::pow(h1 / h0, 1. / (n - 1)) : 1.;
	double              h = h0;
	for (int k = 0; k < n; k++, h *= f) x[size_t(k) + 1] = x[size_t(k)] + h;
	const double s = (b - a) / x.back();
	for (double& v : x) v = a + v * s;
	x.back() = b;
	return x;
}

int Grid::addRectangle(const Material& m, const std::vector<double>& xs, const std::vector<double>& ys, const BlockOptions& o)
{
	const int ni = int(xs.size()) - 1, nj = int(ys.size()) - 1;
	std::vector<double> x, y;
	x.reserve(xs.size() * ys.size());
	y.reserve(xs.size() * ys.size());
	for (const double b : ys)
		for (const double a : xs) {
			x.push_back(a);
			y.push_back(b);
		}
	return addBlock(m, ni, nj, x, y, o);
}

int Grid::addBlock(const Material& m, int ni, int nj, const std::vector<double>& x, const std::vector<double>& y, const BlockOptions& options)
{
	auto b     = std::make_unique<Block>();
	b->options = options;
	if (b->options.name.empty()) b->options.name = "block" + std::to_string(blocks_.size());
	const std::string& name = b->options.name;
	if (built_) throw Error("block '" + name + "': the grid is complete already; add all blocks before boundaries, gauges and steps.");
	if (ni < 1 || nj < 1)
		throw Error(
			"block '" + name + "': " + std::to_string(ni) + " x " + std::to_string(nj)
			+ " cells is not allowed; at least 1 x 1 (two grid lines each way).");
	const size_t n = size_t(ni + 1) * size_t(nj + 1);
	if (x.size() != n || y.size() != n)
		throw Error("block '" + name + "': " + std::to_string(ni) + " x " + std::to_string(nj) + " cells need " + std::to_string(n) + " nodes, but "
		            + std::to_string(x.size()) + " x and " + std::to_string(y.size()) + " y coordinates were given.");
	validate(m, name);
	if (!(options.hourglass >= 0 && options.hourglass <= 4))
		throw Error("block '" + name + "': hourglass = " + std::to_string(options.hourglass) + " is not allowed; it must be in [0, 4].");
	b->material = m;
	b->account  = options_.account || m.eos.heats();
	b->allocate(ni, nj);
	for (int j = 0; j <= nj; j++)
		for (int i = 0; i <= ni; i++) {
			const size_t k = size_t(j) * size_t(ni + 1) + size_t(i);
			if (!std::isfinite(x[k]) || !std::isfinite(y[k]))
				throw Error(
					"block '" + name + "', node (" + std::to_string(i) + ", " + std::to_string(j)
					+ "): coordinates are not finite; give finite numbers [m].");
			b->x[b->node(i, j)] = x[k];
			b->y[b->node(i, j)] = y[k];
		}
	b->takeRestGeometry();
	blocks_.push_back(std::move(b));
	return int(blocks_.size()) - 1;
}

const Block& Grid::checkedBlock(int block, const char* what) const
{
	if (block < 0 || block >= blocks())
		throw Error(
			std::string(what) + ": there is no block " + std::to_string(block) + "; the grid has " + std::to_string(blocks())
			+ ", numbered from 0.");
	return *blocks_[size_t(block)];
}

void Grid::openInteriorNode(int block, int i, int j)
{
	if (built_) throw Error("open node: the grid is complete already; name open nodes right after the blocks.");
	checkedBlock(block, "open node");
	Block& b = *blocks_[size_t(block)];
	if (i < 0 || j < 0 || i > b.ni || j > b.nj)
		throw Error("block '" + b.options.name + "': there is no node (" + std::to_string(i) + ", " + std::to_string(j) + ").");
	if (b.isPerimeter(i, j)) return;
	const int  n  = j * (b.ni + 1) + i;
	const auto it = std::lower_bound(b.interiorOpen.begin(), b.interiorOpen.end(), n);
	if (it == b.interiorOpen.end() || *it != n) b.interiorOpen.insert(it, n);
}

void Grid::build()
{
	if (built_) return;
	if (blocks_.empty()) throw Error("grid: there is no block; add one first.");
	allocateOpen();
	join();
	refuseHangingNodes();
	for (auto& b : blocks_) b->takeRestGeometry(); // joining may have moved nodes by rounding
	masses();
	double c = 0;
	for (auto& b : blocks_) c = std::max(c, b->material.cP());
	restSpeed_ = 1e-30 * c; // far below rounding of any wave: keeps the forerunners of a front from waking the whole grid
	built_     = true;
	restRanges();
}

void Grid::allocateOpen()
{
	OpenNodes& o = open_;
	for (size_t k = 0; k < blocks_.size(); k++) {
		Block& b    = *blocks_[k];
		b.firstCopy = int(o.copyNode.size());
		b.nCopies   = 2 * (b.ni + 1) + 2 * (b.nj - 1) + int(b.interiorOpen.size());
		for (int c = b.firstCopy; c < b.firstCopy + b.nCopies; c++) {
			int i, j;
			b.nodeOfCopy(c, i, j);
			o.copyNode.push_back(b.node(i, j));
			o.copyBlock.push_back(int(k));
		}
		for (int j = 0; j <= b.nj; j++)
			b.interiorOpenRowStart[size_t(j) + 1]
			        = int(std::lower_bound(b.interiorOpen.begin(), b.interiorOpen.end(), (j + 1) * (b.ni + 1)) - b.interiorOpen.begin());
	}
	const size_t n = o.copyNode.size();
	o.copyMaster.assign(n, -1);
	o.copyMass.assign(n, 0.);
	o.copyVx.assign(n, 0.);
	o.copyVy.assign(n, 0.);
	for (auto& c : o.corner) c.assign(n, 0.);
}

namespace {
	struct Bins {
		double                                      size;
		std::unordered_map<int64_t, std::vector<int>> of;
		static int64_t key(int64_t a, int64_t b) { return a * 0x9E3779B97F4A7C15LL + b; }
		int64_t        index(double x) const { return int64_t(std::floor(x / size)); }
	};

	/// Shortest edge of the outline at a copy [m].
	double edgeLength(const Block& b, int i, int j)
	{
		double h = std::numeric_limits<double>::infinity();
		for (const auto& d : { std::pair<int, int> { 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 } }) {
			const int p = i + d.first, q = j + d.second;
			if (p < 0 || q < 0 || p > b.ni || q > b.nj) continue;
			const size_t m = b.node(i, j), n = b.node(p, q);
			h              = std::min(h, std::hypot(b.x[n] - b.x[m], b.y[n] - b.y[m]));
		}
		return h;
	}
	constexpr double joinTolerance = 1e-6; ///< of the edge length
}

void Grid::join()
{
	OpenNodes&          o = open_;
	const size_t        n = o.copyNode.size();
	std::vector<double> h(n);
	double              hMax = 0;
	for (size_t c = 0; c < n; c++) {
		const Block& b = *blocks_[size_t(o.copyBlock[c])];
		int          i, j;
		b.nodeOfCopy(int(c), i, j);
		h[c] = edgeLength(b, i, j);
		hMax = std::max(hMax, h[c]);
	}
	Bins bins { 2 * hMax, {} };
	for (size_t c = 0; c < n; c++) {
		Block&       b = *blocks_[size_t(o.copyBlock[c])];
		const double x = b.x[o.copyNode[c]], y = b.y[o.copyNode[c]], tol = joinTolerance * h[c];
		int          master = -1;
		for (int64_t p = bins.index(x - tol); p <= bins.index(x + tol) && master < 0; p++)
			for (int64_t q = bins.index(y - tol); q <= bins.index(y + tol) && master < 0; q++) {
				const auto it = bins.of.find(Bins::key(p, q));
				if (it == bins.of.end()) continue;
				for (const int m : it->second)
					if (std::hypot(o.x[size_t(m)] - x, o.y[size_t(m)] - y) <= tol) {
						master = m;
						break;
					}
			}
		if (master < 0) {
			master = int(o.x.size());
			o.x.push_back(x);
			o.y.push_back(y);
			o.firstCopy.push_back(int(c));
			bins.of[Bins::key(bins.index(x), bins.index(y))].push_back(master);
		} else {
			o.repeats.push_back(int(c));
			b.x[o.copyNode[c]] = o.x[size_t(master)];
			b.y[o.copyNode[c]] = o.y[size_t(master)];
		}
		o.copyMaster[c] = master;
	}
	const size_t m = o.x.size();
	for (auto* v : { &o.vx, &o.vy, &o.mass, &o.addedMass, &o.fx, &o.fy, &o.lx, &o.ly, &o.ex, &o.ey, &o.wx, &o.wy }) v->assign(m, 0.);
}

void Grid::refuseHangingNodes() const
{
	if (blocks_.size() < 2) return;
	const OpenNodes& o = open_;
	double           hMax = 0;
	struct Edge { int a, b, block; };
	std::vector<Edge> edges;
	for (size_t k = 0; k < blocks_.size(); k++) {
		const Block& b   = *blocks_[k];
		const auto   add = [&](int i, int j, int p, int q) {
                        edges.push_back({ o.copyMaster[size_t(b.copyOf(i, j))], o.copyMaster[size_t(b.copyOf(p, q))], int(k) });
                        hMax = std::max(hMax, std::hypot(b.x[b.node(i, j)] - b.x[b.node(p, q)], b.y[b.node(i, j)] - b.y[b.node(p, q)]));
		};
		for (int i = 0; i < b.ni; i++) add(i, 0, i + 1, 0), add(i, b.nj, i + 1, b.nj);
		for (int j = 0; j < b.nj; j++) add(0, j, 0, j + 1), add(b.ni, j, b.ni, j + 1);
	}
	Bins bins { hMax, {} };
	for (int m = 0; m < o.size(); m++) bins.of[Bins::key(bins.index(o.x[size_t(m)]), bins.index(o.y[size_t(m)]))].push_back(m);
	for (const Edge& e : edges) {
		const double ax = o.x[size_t(e.a)], ay = o.y[size_t(e.a)], dx = o.x[size_t(e.b)] - ax, dy = o.y[size_t(e.b)] - ay, len2 = dx * dx + dy * dy;
		const double x0 = std::min(ax, ax + dx), x1 = std::max(ax, ax + dx), y0 = std::min(ay, ay + dy), y1 = std::max(ay, ay + dy);
		for (int64_t p = bins.index(x0); p <= bins.index(x1); p++)
			for (int64_t q = bins.index(y0); q <= bins.index(y1); q++) {
				const auto it = bins.of.find(Bins::key(p, q));
				if (it == bins.of.end()) continue;
				for (const int m : it->second) {
					if (m == e.a || m == e.b) continue;
					const double rx = o.x[size_t(m)] - ax, ry = o.y[size_t(m)] - ay, s = (rx * dx + ry * dy) / len2;
					if (s <= joinTolerance || s >= 1 - joinTolerance || std::fabs(rx * dy - ry * dx) > joinTolerance * len2) continue;
					throw Error(
						"block '" + blocks_[size_t(e.block)]->options.name + "' touches another block, but " + nodeName(m)
						+ " lies between two of its nodes. Blocks that touch must share their nodes: give both the same grid lines "
					          "there, or leave a gap.");
				}
			}
	}
}

void Grid::masses()
{
	OpenNodes& o = open_;
	for (size_t k = 0; k < blocks_.size(); k++) {
		Block& b = *blocks_[k];
		for (int j = 0; j <= b.nj; j++)
			for (int i = 0; i <= b.ni; i++) {
				double area = 0;
				for (int q = j - 1; q <= j; q++)
					for (int p = i - 1; p <= i; p++)
						if (p >= 0 && q >= 0 && p < b.ni && q < b.nj) area += 0.25 * b.restArea[b.cell(p, q)];
				const double m = area * b.material.eos.rho0;
				b.invMass[b.node(i, j)] = 1. / m;
				const int c = b.copyOf(i, j);
				if (c < 0) continue;
				o.copyMass[size_t(c)] = m;
				o.mass[size_t(o.copyMaster[size_t(c)])] += m;
			}
	}
}

void Grid::setVelocity(int block, const std::function<std::array<double, 2>(double, double)>& v)
{
	mustBeBuilt();
	checkedBlock(block, "initial velocity");
	if (steps_ > 0) throw Error("initial velocity: the grid has moved already; set velocities before the first step.");
	Block& b = *blocks_[size_t(block)];
	std::vector<std::array<double, 2>> all;
	for (int j = 0; j <= b.nj; j++)
		for (int i = 0; i <= b.ni; i++) {
			const size_t n = b.node(i, j);
			all.push_back(v(b.x[n], b.y[n]));
			if (!std::isfinite(all.back()[0]) || !std::isfinite(all.back()[1]))
				throw Error("initial velocity of block '" + b.options.name + "', node (" + std::to_string(i) + ", " + std::to_string(j)
				            + "): not finite; give finite numbers [m/s].");
		}
	for (int j = 0; j <= b.nj; j++)
		for (int i = 0; i <= b.ni; i++) {
			const auto&  u = all[size_t(j) * size_t(b.ni + 1) + size_t(i)];
			const size_t n = b.node(i, j);
			b.vx[n] = u[0], b.vy[n] = u[1];
			const int c = b.copyOf(i, j);
			if (c >= 0) open_.copyVx[size_t(c)] = u[0], open_.copyVy[size_t(c)] = u[1];
		}
	averageVelocities();
	restRanges();
	ratesKnown_ = false;
}

namespace {
	bool isStressed(const Block& b)
	{
		for (int j = 0; j < b.nj; j++)
			for (int i = 0; i < b.ni; i++) {
				const size_t c = b.cell(i, j);
				if (b.sxx[c] != 0. || b.syy[c] != 0. || b.sxy[c] != 0. || b.pressureOf(i, j) != 0.) return true;
			}
		return false;
	}
}

void Grid::averageVelocities()
{
	OpenNodes&          o = open_;
	std::vector<double> m(size_t(o.size()), 0.);
	std::fill(o.vx.begin(), o.vx.end(), 0.);
	std::fill(o.vy.begin(), o.vy.end(), 0.);
	for (size_t c = 0; c < o.copyNode.size(); c++) {
		const size_t k = size_t(o.copyMaster[c]);
		m[k] += o.copyMass[c];
		o.vx[k] += o.copyMass[c] * o.copyVx[c];
		o.vy[k] += o.copyMass[c] * o.copyVy[c];
	}
	for (size_t k = 0; k < m.size(); k++) {
		o.vx[k] /= m[k];
		o.vy[k] /= m[k];
	}
	for (const int c : o.firstCopy) // a node of one block keeps its velocity to the last bit
		if (m[size_t(o.copyMaster[size_t(c)])] == o.copyMass[size_t(c)]) {
			o.vx[size_t(o.copyMaster[size_t(c)])] = o.copyVx[size_t(c)];
			o.vy[size_t(o.copyMaster[size_t(c)])] = o.copyVy[size_t(c)];
		}
	for (size_t c = 0; c < o.copyNode.size(); c++) {
		Block&       b = *blocks_[size_t(o.copyBlock[c])];
		const size_t k = size_t(o.copyMaster[c]);
		b.vx[o.copyNode[c]] = o.vx[k];
		b.vy[o.copyNode[c]] = o.vy[k];
	}
}

/// A block without stress wakes from its moving nodes alone.
void Grid::restRanges()
{
	for (auto& p : blocks_) {
		Block& b   = *p;
		b.allAwake = !options_.skip || isStressed(b);
		b.awake.assign(size_t(b.nj), b.allAwake ? Range { 0, b.ni } : Range {});
		for (int j = 0; j <= b.nj; j++) {
			Range m { 0, b.ni + 1 };
			while (m.lo < m.hi && b.vx[b.node(m.lo, j)] == 0. && b.vy[b.node(m.lo, j)] == 0.) m.lo++;
			while (m.lo < m.hi && b.vx[b.node(m.hi - 1, j)] == 0. && b.vy[b.node(m.hi - 1, j)] == 0.) m.hi--;
			b.moving[size_t(j)] = m;
		}
		wake(b);
	}
}

void Grid::addNodeMass(int node, double mass)
{
	mustBeBuilt();
	checkNodes({ node }, "added mass");
	if (!(mass >= 0) || !std::isfinite(mass) )
		throw Error("added mass at " + nodeName(node) + ": " + std::to_string(mass) + " kg/m is not allowed; it must be finite and not negative.");
	open_.mass[size_t(node)] += mass;
	open_.addedMass[size_t(node)] += mass;
}

int Grid::addGauge(double x, double y, int period)
{
	mustBeBuilt();
	if (period < 1) throw Error("gauge: period = " + std::to_string(period) + " is not allowed; it must be 1 step or more.");
	Gauge g;
	g.period = period;
	for (int b = 0; b < blocks() && g.at.block < 0; b++)
		if (locate(*blocks_[size_t(b)], x, y, g.at)) g.at.block = b;
	if (g.at.block < 0) {
		std::ostringstream s;
		s << "gauge: the point (" << x << ", " << y << ") m lies outside all blocks; give a point inside one.";
		throw Error(s.str());
	}
	gauges_.push_back(g);
	return int(gauges_.size()) - 1;
}

std::vector<Sample> Grid::probeLine(double x0, double y0, double x1, double y1, int n) const
{
	if (!std::isfinite(x0) || !std::isfinite(y0) || !std::isfinite(x1) || !std::isfinite(y1))
		throw Error("probeLine: start and end must be finite points [m].");
	if (n < 1 || n > 1000000) throw Error("probeLine: n = " + std::to_string(n) + " points; it must be from 1 to 1000000.");
	std::vector<Sample> out;
	for (int k = 0; k < n; k++) {
		const double w = n > 1 ? double(k) / (n - 1) : 0.;
		Location     at;
		for (const auto& b : blocks_)
			if (locate(*b, x0 + w * (x1 - x0), y0 + w * (y1 - y0), at)) {
				out.push_back(sample(*b, at, time_));
				break;
			}
	}
	return out;
}
}
