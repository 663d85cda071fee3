// SPDX-License-Identifier: GPL-2.0-or-later
#include "walls.hpp"
#include <cmath>
#include <sstream>

namespace mca::automata {
namespace {
	Point pointOf(const Vec<double>& v, double rest)
	{
		Point p { { rest, rest, rest } };
		for (int c = 0; c < dim; c++) p[c] = v[c];
		return p;
	}
	Vec<double> vectorOf(const Point& p)
	{
		Vec<double> v {};
		for (int c = 0; c < dim; c++) v[c] = p[c];
		return v;
	}
	/// Rotations are about the last axes; in the plane about the one normal to it.
	Point pointOfTurn(const Turn<double>& t)
	{
		Point p;
		for (int c = 0; c < turns; c++) p[3 - turns + c] = turnComponent(t, c);
		return p;
	}
	Turn<double> turnOf(const Point& p)
	{
		Turn<double> t {};
		for (int c = 0; c < turns; c++) turnComponent(t, c) = p[3 - turns + c];
		return t;
	}
	/// Largest component of the way between two boxes [m]; not above zero: they meet.
	double apart(const WallBounds& a, const WallBounds& b)
	{
		double most = -1e300;
		for (int c = 0; c < 3; c++) most = max(most, max(a.low[c] - b.high[c], b.low[c] - a.high[c]));
		return most;
	}
	/// How far a box has moved or grown along c [m].
	double wayOf(const WallBounds& a, const WallBounds& b, int c) { return max(std::fabs(b.low[c] - a.low[c]), std::fabs(b.high[c] - a.high[c])); }
	WallBounds boundsOf(const Store& S, size_t block, double level)
	{
		WallBounds b { pointOf(S.position.at(block * blockSize), level), pointOf(S.position.at(block * blockSize), level) };
		for (int c = 0; c < dim; c++) {
			const double* x   = &S.position[c][block * blockSize];
			double        low = x[0], high = x[0];
#pragma omp simd reduction(min : low) reduction(max : high)
			for (int l = 0; l < blockSize; l++) low = min(low, x[l]), high = max(high, x[l]);
			b.low[c] = low, b.high[c] = high;
		}
		return b;
	}
	bool earlier(const WallTouch& a, const WallTouch& b) { return a.automaton != b.automaton ? a.automaton < b.automaton : a.wall < b.wall; }
}

void Walls::set(std::vector<WallStart> list)
{
	walls = std::move(list);
	bounds.clear(), pushes.assign(walls.size(), {});
	forget();
	stiffest = 0;
}

/// Where they are now, and how far that is from where they were.
void Walls::follow(const std::vector<WallPlace>& places)
{
	double most = 0;
	const bool first = bounds.size() != walls.size();
	bounds.resize(walls.size());
	for (size_t w = 0; w < walls.size(); w++) {
		if (!first && !places[w].moved) continue;
		const WallBounds now = mca::boundsOf(walls[w].form, places[w]);
		for (int c = 0; !first && c < 3; c++) most = max(most, wayOf(bounds[w], now, c));
		bounds[w] = now;
	}
	moved += most;
	if (first) known = false;
}

/// Which walls a block may touch while it and they travel less than half a diameter.
void Walls::look(const Solver& solver, size_t block, double level)
{
	const Store&     S = solver.store;
	const double     d = S.species[size_t(S.blocks[block].species)].d, reach = 0.5 * d;
	const WallBounds box = boundsOf(S, block, level);
	Near&            n = near[block];
	n.walls.clear();
	n.from = solver.travelled[block] + moved, n.slack = 1e300;
	for (size_t w = 0; w < walls.size(); w++) {
		const double way = apart(box, bounds[w]) - reach;
		if (way < 0.5 * d) n.walls.push_back(int32_t(w)), n.slack = min(n.slack, 0.5 * d);
		else n.slack = min(n.slack, way);
	}
	n.lanes.clear();
	if (n.walls.empty()) return;
	n.slack = 0.5 * d; // those left out are farther
	for (size_t i = block * blockSize; i < block * blockSize + size_t(S.blocks[block].count); i++) {
		const Point x = pointOf(S.position.at(i), level);
		for (int32_t w : n.walls)
			if (isNear(bounds[size_t(w)], x, d * (1. + 1e-9))) {
				n.lanes.push_back(int32_t(i));
				break;
			}
	}
}

bool Walls::hidden(const WallGap& gap, double d) const
{
	for (const WallGap& g : found)
		if (isHidden(gap, g, d)) return true;
	return false;
}

void Walls::touch(Solver& solver, size_t i, size_t wall, const WallGap& gap, const WallPlace& place)
{
	const Store&     S = solver.store;
	const WallStart& w = walls[wall];
	const Material&  m = S.materialOf(i);
	const double     d = S.diameter[i], radius = 0.5 * d, overlap = radius - gap.distance;
	const auto       refuse = [&](const std::string& what) {
                std::ostringstream s;
                s << "automaton " << S.id[i] << " at " << S.position.at(i) << " m and wall " << w.id << ": " << what;
                throw Error(s.str());
	};
	if (gap.distance < deepestWall * radius) {
		std::ostringstream s;
		s << "the automaton's centre is " << gap.distance << " m from its surface, less than half of the radius " << radius
		  << " m: it stood there from the start, or was pressed in faster than the penalty can hold. Positions are those before the step.";
		refuse(s.str());
	}
	if (dim == 2 && std::fabs(gap.normal[2]) > 1e-9)
		refuse("the surface ends, or is inclined, within the plane of plane strain; let it go on along z beyond the automata, by a radius at least.");
	if (S.flags[i] & tiedBit) refuse("the automaton is tied to a grid, which does not know of walls; keep them away from tied rows.");
	const Point         centre = gap.foot + gap.normal * gap.distance, at = centre - gap.normal * (radius - 0.5 * overlap);
	const Point         own = pointOf(S.velocity.at(i), 0.) + cross(pointOfTurn(turnAt(S.omega, i)), at - centre);
	const WallStiffness k(m.eos.bulkModulus(), m.G, Lattice::width(d) * mirrorShare(S, i), d);
	WallTouch           t { S.id[i], w.id, {} };
	const auto          old = std::lower_bound(held.begin(), held.end(), t, earlier);
	if (old != held.end() && !earlier(t, *old)) t.shear = old->shear;
	const Point force = wallForce(k, min(m.friction, w.friction), overlap, gap.normal, own - velocityAt(place, at), solver.sinceLast(), t.shear);
	now.push_back(t);
	solver.addForce(i, vectorOf(force), turnOf(cross(at - centre, force)));
	pushes[wall].force = pushes[wall].force - force, pushes[wall].torque = pushes[wall].torque - cross(at - place.position, force);
	stiffness += max(k.normal / S.mass[i], k.shear * (1. / S.mass[i] + radius * radius / S.inertia[i]));
	if (w.mass > 0) onWall[wall] += k.normal;
}

void Walls::pushBlock(Solver& solver, size_t block, const std::vector<WallPlace>& places, double level)
{
	const Store& S = solver.store;
	struct Met {
		WallGap gap;
		size_t  wall;
	};
	std::vector<Met> met;
	for (const int32_t i : near[block].lanes) {
		const double     d = S.diameter[size_t(i)];
		const Point      x = pointOf(S.position.at(size_t(i)), level);
		met.clear();
		for (int32_t w : near[block].walls) {
			if (!isNear(bounds[size_t(w)], x, 0.5 * d)) continue;
			const WallGap gap = gapTo(walls[size_t(w)].form, places[size_t(w)], x);
			if (gap.distance < 0.5 * d) met.push_back({ gap, size_t(w) });
		}
		if (met.empty()) continue;
		found.clear();
		if (met.size() > 1) // it takes memory
			std::stable_sort(met.begin(), met.end(), [](const Met& a, const Met& b) { return a.gap.distance < b.gap.distance; });
		stiffness = 0;
		for (const Met& m : met) {
			if (hidden(m.gap, d)) continue;
			touch(solver, size_t(i), m.wall, m.gap, places[m.wall]);
			found.push_back(m.gap);
		}
		stiffest = max(stiffest, stiffness);
	}
}

const std::vector<WallPush>& Walls::push(Solver& solver, const std::vector<WallPlace>& places, double level)
{
	const size_t blocks = solver.store.blocks.size();
	if (solver.travelled.size() != blocks) solver.travelled.assign(blocks, 0.), known = false;
	if (sorts != solver.counters.sorts || near.size() != blocks) known = false;
	follow(places);
	now.clear(), stiffest = 0, onWall.assign(walls.size(), 0.);
	std::fill(pushes.begin(), pushes.end(), WallPush());
	if (!known) near.assign(blocks, {});
	for (size_t b = 0; b < blocks; b++) {
		if (!known || solver.travelled[b] + moved - near[b].from >= near[b].slack) look(solver, b, level);
		if (!near[b].walls.empty()) pushBlock(solver, b, places, level);
	}
	known = true, sorts = solver.counters.sorts;
	std::sort(now.begin(), now.end(), earlier);
	double lightest = 0;
	for (size_t w = 0; w < walls.size(); w++)
		if (walls[w].mass > 0) lightest = max(lightest, onWall[w] / walls[w].mass);
	stiffest += lightest;
	return pushes;
}

double Walls::limit(double free) const { return stiffest > 0 && free > 0 ? stepBeside(free, stiffest) : free; }
}
