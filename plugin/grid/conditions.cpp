// SPDX-License-Identifier: GPL-2.0-or-later
// Boundary conditions of a grid, stated by side or by node.
#include "grid.hpp"
#include <algorithm>
#include <cmath>

namespace mca::grid {

std::string Grid::nodeName(int node) const
{
	if (node < 0 || node >= open_.size()) return "open node " + std::to_string(node);
	const int    c = open_.firstCopy[size_t(node)];
	const Block& b = *blocks_[size_t(open_.copyBlock[size_t(c)])];
	int          i, j;
	b.nodeOfCopy(c, i, j);
	return "block '" + b.options.name + "', node (" + std::to_string(i) + ", " + std::to_string(j) + "), cell (" + std::to_string(std::min(i, b.ni - 1))
		+ ", " + std::to_string(std::min(j, b.nj - 1)) + ")";
}

void Grid::checkNodes(const std::vector<int>& nodes, const char* what) const
{
	if (nodes.empty()) throw Error(std::string(what) + ": the list of nodes is empty; it must name at least one open node (sideNodes, openNode).");
	for (const int n : nodes)
		if (n < 0 || n >= open_.size())
			throw Error(std::string(what) + ": there is no open node " + std::to_string(n) + "; the grid has " + std::to_string(open_.size())
			            + ". Nodes off the sides must be opened right after the blocks are added.");
}

int Grid::openNode(int block, int i, int j)
{
	mustBeBuilt();
	const Block& b = checkedBlock(block, "open node");
	if (i < 0 || j < 0 || i > b.ni || j > b.nj)
		throw Error("block '" + b.options.name + "': there is no node (" + std::to_string(i) + ", " + std::to_string(j) + ").");
	const int c = b.copyOf(i, j);
	return c < 0 ? -1 : open_.copyMaster[size_t(c)];
}

std::vector<int> Grid::sideNodes(int block, Side side, int from, int to)
{
	mustBeBuilt();
	const Block& b     = checkedBlock(block, "side");
	const bool   alongI = side == Side::bottom || side == Side::top;
	const int    last  = alongI ? b.ni : b.nj;
	if (from < 0 || to < -1 || to > last || from > (to < 0 ? last : to))
		throw Error(
			"side of block '" + b.options.name + "': nodes start = " + std::to_string(from) + " to end = " + std::to_string(to)
			+ " are not allowed; the side has nodes 0 to " + std::to_string(last) + ", and -1 is the last.");
	if (to < 0) to = last;
	std::vector<int> out;
	for (int k = from; k <= to; k++) {
		const int i = alongI ? k : side == Side::left ? 0 : b.ni, j = alongI ? (side == Side::bottom ? 0 : b.nj) : k;
		out.push_back(open_.copyMaster[size_t(b.copyOf(i, j))]);
	}
	return out;
}

void Grid::prescribe(const std::vector<int>& nodes, double nx, double ny, const Table& velocity)
{
	mustBeBuilt();
	checkNodes(nodes, "prescribed velocity");
	velocity.validate("prescribed velocity [m/s]");
	const double len = std::hypot(nx, ny);
	if (!(len > 0 && len < 1e100)) throw Error("prescribed velocity: the direction must be finite and not zero.");
	const int t = boundary_.addTable(velocity);
	for (const int n : nodes) boundary_.constrain(n, nx / len, ny / len, t, nodeName(n));
}

void Grid::fix(const std::vector<int>& nodes, bool x, bool y)
{
	if (x) prescribe(nodes, 1, 0, Table(0.));
	if (y) prescribe(nodes, 0, 1, Table(0.));
}

void Grid::symmetry(int block, Side side)
{
	const std::vector<int> n = sideNodes(block, side);
	const size_t           a = size_t(n.front()), b = size_t(n.back());
	const double           dx = open_.x[b] - open_.x[a], dy = open_.y[b] - open_.y[a], len = std::hypot(dx, dy);
	for (const int k : n)
		if (!(len > 0) || std::fabs((open_.x[size_t(k)] - open_.x[a]) * dy - (open_.y[size_t(k)] - open_.y[a]) * dx) > 1e-9 * len * len)
			throw Error("symmetry: the side is not straight at " + nodeName(k) + "; hold its nodes one by one instead.");
	prescribe(n, dy, -dx, Table(0.));
}

std::vector<EdgeLoad> Grid::sideEdges(int block, Side side, int from, int to)
{
	std::vector<int> n     = sideNodes(block, side, from, to);
	if (n.size() < 2)
		throw Error(
			"side of block '" + blocks_[size_t(block)]->options.name + "': start = " + std::to_string(from) + " and end = " + std::to_string(to)
			+ " are one node, which has no edge to load; name at least two nodes.");
	const Block&     b     = *blocks_[size_t(block)];
	const bool       alongI = side == Side::bottom || side == Side::top, flip = side == Side::top || side == Side::left;
	const double     rho   = b.material.eos.rho0;
	std::vector<EdgeLoad> out;
	for (size_t k = 0; k + 1 < n.size(); k++) {
		EdgeLoad l;
		l.a      = n[flip ? k + 1 : k];
		l.b      = n[flip ? k : k + 1];
		const int s = from + int(k);
		l.block  = block;
		l.i      = alongI ? s : side == Side::left ? 0 : b.ni - 1;
		l.j      = alongI ? (side == Side::bottom ? 0 : b.nj - 1) : s;
		l.tableX = l.tableY = -1;
		l.restLength = std::hypot(open_.x[size_t(l.b)] - open_.x[size_t(l.a)], open_.y[size_t(l.b)] - open_.y[size_t(l.a)]);
		l.zP     = rho * b.material.cP();
		l.zS     = rho * b.material.cS();
		l.kind   = LoadKind::traction;
		out.push_back(l);
	}
	return out;
}

void Grid::traction(int block, Side side, const Table& tx, const Table& ty, int from, int to)
{
	tx.validate("traction x [Pa]");
	ty.validate("traction y [Pa]");
	std::vector<EdgeLoad> edges = sideEdges(block, side, from, to);
	const int x = boundary_.addTable(tx), y = boundary_.addTable(ty);
	for (EdgeLoad& l : edges) {
		l.tableX = x;
		l.tableY = y;
		boundary_.load(l, blocks_[size_t(block)]->cellName(l.i, l.j));
	}
}

void Grid::pressureLoad(int block, Side side, const Table& p, int from, int to)
{
	p.validate("pressure [Pa]");
	std::vector<EdgeLoad> edges = sideEdges(block, side, from, to);
	const int t = boundary_.addTable(p);
	for (EdgeLoad& l : edges) {
		l.kind   = LoadKind::pressure;
		l.tableX = t;
		boundary_.load(l, blocks_[size_t(block)]->cellName(l.i, l.j));
	}
}

void Grid::viscous(int block, Side side, int from, int to)
{
	for (EdgeLoad& l : sideEdges(block, side, from, to)) {
		l.kind = LoadKind::viscous;
		boundary_.load(l, blocks_[size_t(block)]->cellName(l.i, l.j));
	}
}

void Grid::nodalForce(const std::vector<int>& nodes, const Table& fx, const Table& fy)
{
	mustBeBuilt();
	checkNodes(nodes, "nodal force");
	fx.validate("nodal force x [N/m]");
	fy.validate("nodal force y [N/m]");
	const int x = boundary_.addTable(fx), y = boundary_.addTable(fy);
	for (const int n : nodes) boundary_.load(NodeLoad { n, x, y });
}
}
