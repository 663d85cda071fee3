// SPDX-License-Identifier: GPL-2.0-or-later
#include "map.hpp"
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace mca::interface {
namespace {
	template <class... T> [[noreturn]] void refuse(const SideNodes& side, const T&... words)
	{
		std::ostringstream s;
		s.precision(6);
		s << "interface at block '" << side.block << "': ";
		(s << ... << words);
		throw Error(s.str());
	}
	struct Place {
		size_t point;
		double along, off; ///< along the side from its first node, distance from the line (positive away from the grid) [m]
	};
	std::string at(const RowPoint& p)
	{
		std::ostringstream s;
		s << "body " << p.id << " at (" << p.x << ", " << p.y << ") m";
		return s.str();
	}
	void compare(const RowPoint& p, const SideNodes& side)
	{
		const Material &a = *p.material, &b = *side.material;
		const auto unlike = [&](const char* what, double u, double v, const char* unit) {
			if (std::fabs(u - v) <= 1e-6 * std::max(std::fabs(u), std::fabs(v))) return;
                        refuse(side, at(p), " has ", what, " ", u, " ", unit, ", the block ", v, " ", unit,
			            "; unlike materials reflect waves (1 % of impedance reflects 0.5 %). Give both sides the same material, or allow it with "
			                 "otherMaterials.");
		};
		unlike("density", a.eos.rho0, b.eos.rho0, "kg/m3");
		unlike("bulkSoundSpeed", a.eos.c0, b.eos.c0, "m/s");
		unlike("shearModulus", a.G, b.G, "Pa");
	}
	/// A whole row: neighbours one diameter apart, each with the half of its cell that is not grid.
	void checkSpacing(const std::vector<RowPoint>& points, const std::vector<Place>& row, const SideNodes& side, const MapOptions& o)
	{
		for (size_t k = 0; k < row.size(); k++) {
			const RowPoint& p = points[row[k].point];
			if (side.material && p.material && !o.otherMaterials) compare(p, side);
			const bool inner = k > 0 && k + 1 < row.size();
			if (inner && std::fabs(p.weight - 0.5) > 0.05)
				refuse(side, at(p), " stands for ", p.weight,
				       " of its cell; on the line it must be 1/2, the other half is grid. Make the packing in an outline that ends on the "
				       "line.");
			if (!inner && p.weight > 0.85)
				refuse(side, at(p), " at the end of the row stands for ", p.weight, " of its cell; the half beyond the line is grid.");
			if (!k) continue;
			const RowPoint& q = points[row[k - 1].point];
			const double    d = 0.5 * (p.diameter + q.diameter), r = row[k].along - row[k - 1].along;
			if (r > (1. + 10. * o.tolerance) * d)
				refuse(side, "gap: ", at(q), " and body ", p.id, " are ", r, " m apart along the line, ", r / d,
				       " diameters; neighbours in the row must be 1 apart.");
			if (r < (1. - 10. * o.tolerance) * d)
				refuse(side, "overlap: ", at(q), " and body ", p.id, " are ", r, " m apart along the line, ", r / d,
				       " diameters; neighbours in the row must be 1 apart.");
		}
	}
	/// From end to end of the side, and the edges of the grid beside it. s: places of the nodes along the side [m].
	void
	checkEnds(const std::vector<RowPoint>& points, const std::vector<Place>& row, const std::vector<double>& s, const SideNodes& side, const MapOptions& o)
	{
		const size_t nodes  = s.size();
		const double length = s.back();
		const RowPoint &first = points[row.front().point], &last = points[row.back().point];
		if (row.front().along > first.diameter)
			refuse(side, "gap: the row begins with ", at(first), ", ", row.front().along,
			       " m after the side's first node; at most one diameter is allowed.");
		if (length - row.back().along > last.diameter)
			refuse(side, "gap: the row ends with ", at(last), ", ", length - row.back().along,
			       " m before the side's last node; at most one diameter is allowed.");
		for (size_t k = 0; k + 1 < nodes; k++) {
			const double ratio = (s[k + 1] - s[k]) / first.diameter;
			if (ratio < o.smallestRatio * (1 - 1e-9) || ratio > o.largestRatio * (1 + 1e-9))
				refuse(side, "the edge between nodes ", k, " and ", k + 1, " of the side is ", s[k + 1] - s[k], " m long, ", ratio,
				       " times the spacing of the automata (body ", first.id, "); allowed are ", o.smallestRatio, " to ", o.largestRatio,
				       ". Let the grid begin with the spacing of the automata and grow away from the interface.");
		}
	}
	/// Each automaton of the row on its edge of the grid.
	std::vector<Carried> carriedBy(const std::vector<RowPoint>& points, const std::vector<Place>& row, const std::vector<double>& s, const SideNodes& side)
	{
		const size_t nodes = s.size();
		std::vector<Carried> out;
		size_t               e = 0;
		for (const Place& c : row) {
			const RowPoint& p = points[c.point];
			while (e + 2 < nodes && c.along > s[e + 1]) e++;
			const double l = s[e + 1] - s[e];
			double       w = (c.along - s[e]) / l;
			if (std::fabs(w) < 1e-9) w = 0.;
			if (std::fabs(1. - w) < 1e-9) w = 1.;
			w = std::min(std::max(w, 0.), 1.);
			Carried m { p.id, side.node[e], side.node[e + 1], 1. - w, w, 0., 0., p.mass };
			m.rx = p.x - (m.Na * side.x[e] + m.Nb * side.x[e + 1]);
			m.ry = p.y - (m.Na * side.y[e] + m.Nb * side.y[e + 1]);
			out.push_back(m);
		}
		return out;
	}
}

std::vector<Carried> makeMap(const std::vector<RowPoint>& points, const SideNodes& side, const MapOptions& o)
{
	const size_t nodes = side.node.size();
	if (nodes < 2) refuse(side, "the side has ", nodes, " node; at least one edge (two nodes) is needed.");
	const double x0 = side.x.front(), y0 = side.y.front(), lx = side.x.back() - x0, ly = side.y.back() - y0, length = std::hypot(lx, ly);
	if (!(length > 0)) refuse(side, "first and last node lie at the same place; a straight line is needed.");
	const double tx = lx / length, ty = ly / length;
	double       nx = -ty, ny = tx; // away from the grid
	if ((side.inX - x0) * nx + (side.inY - y0) * ny > 0) nx = -nx, ny = -ny;
	std::vector<double> s(nodes);
	for (size_t k = 0; k < nodes; k++) {
		s[k]             = (side.x[k] - x0) * tx + (side.y[k] - y0) * ty;
		const double off = (side.x[k] - x0) * nx + (side.y[k] - y0) * ny;
		if (std::fabs(off) > 1e-9 * length)
			refuse(side, "node ", k, " of the side at (", side.x[k], ", ", side.y[k], ") m lies ", std::fabs(off),
			       " m off the line between its ends; the interface must be straight.");
		if (k && !(s[k] > s[k - 1])) refuse(side, "nodes ", k - 1, " and ", k, " of the side do not follow each other along the line.");
	}

	std::vector<Place> row;
	for (size_t q = 0; q < points.size(); q++) {
		const RowPoint& p     = points[q];
		const double    along = (p.x - x0) * tx + (p.y - y0) * ty, off = (p.x - x0) * nx + (p.y - y0) * ny, d = p.diameter, tol = o.tolerance * d;
		if (!(d > 0) || !std::isfinite(along + off)) refuse(side, "body ", p.id, ": position and diameter must be finite and the diameter above zero.");
		const bool beside = along < -tol || along > length + tol;
		if (std::fabs(off) <= tol) {
			if (!beside) {
				row.push_back({ q, along, off });
				continue;
			}
			const double beyond = along < 0 ? -along : along - length;
			if (o.onlyGiven || beyond < (1. - o.tolerance) * d)
				refuse(side, at(p), " lies on the line, but ", beyond, " m (", beyond / d,
				       " diameters) beyond the end of the side (allowed: ", tol, " m); make the side longer or the row shorter.");
		} else if (o.onlyGiven)
			refuse(side, at(p), " lies ", std::fabs(off), " m (", std::fabs(off) / d, " diameters) off the line; allowed are ", tol, " m.");
		else if (!beside && std::fabs(off) < 0.45 * d)
			refuse(side, at(p), " lies ", std::fabs(off), " m (", std::fabs(off) / d, " diameters) off the line; allowed are ", tol,
			       " m. Move the packing so that the centres of one close-packed row lie on the line.");
		else if (!beside && off < 0 && off > -1.5 * d)
			refuse(side, at(p), " overlaps the grid: it lies ", -off, " m inside the block. The automata must end with the row on the line.");
	}
	if (row.size() < 2) {
		double         nearest = 1e300;
		const RowPoint* who    = nullptr;
		for (const RowPoint& p : points) {
			const double along = (p.x - x0) * tx + (p.y - y0) * ty, off = (p.x - x0) * nx + (p.y - y0) * ny;
			const double r = std::hypot(off, std::max({ 0., -along, along - length }));
			if (r < nearest) nearest = r, who = &p;
		}
		if (!who) refuse(side, "there are no automata to tie.");
		refuse(side, "gap: ", row.size(), " automata lie on the line; the nearest of all, ", at(*who), ", is ", nearest,
		       " m away. The row must run through its centres.");
	}
	std::sort(row.begin(), row.end(), [&](const Place& a, const Place& b) {
		return a.along != b.along ? a.along < b.along : points[a.point].id < points[b.point].id;
	});

	checkSpacing(points, row, side, o);
	checkEnds(points, row, s, side, o);
	return carriedBy(points, row, s, side);
}

void checkRow(const std::vector<Carried>& row, int openNodes)
{
	const auto need = [](bool ok, int id, const char* what) {
		if (!ok) throw Error("interface: the saved map is damaged: " + std::string(what) + " of body " + std::to_string(id) + ".");
	};
	std::set<int> known;
	for (const Carried& c : row) {
		need(c.id >= 0 && known.insert(c.id).second, c.id, "the number");
		need(c.a >= 0 && c.a < openNodes && c.b >= 0 && c.b < openNodes && c.a != c.b, c.id, "a node");
		need(c.Na >= 0 && c.Nb >= 0 && std::fabs(c.Na + c.Nb - 1.) < 1e-12, c.id, "the shares of the nodes");
		need(std::fabs(c.rx) < 1e150 && std::fabs(c.ry) < 1e150 && c.mass > 0 && c.mass < 1e150, c.id, "place or mass");
	}
}
}
