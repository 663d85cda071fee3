// SPDX-License-Identifier: GPL-2.0-or-later
// Where bodies end in space: at whole automata, whose volume the links measure that they have, or at plane faces through the centres of automata that stand
// for a part of their cell (S8); planes of symmetry (S9).
#include "../solver.hpp"
#include <algorithm>
#include <cmath>
#include <sstream>

namespace mca::automata {
namespace {
	constexpr double whole = 0.999; ///< weight from which on an automaton is one
	constexpr double edge  = 0.26;  ///< weight up to which it may be at the edge of two faces
	/// Normals of planes that cross no link between others than those on it, and across which the packing is its own image. Across {110} it is, too,
	/// but the next automata on both sides are linked.
	const Vec<double> symmetries[] = { { 1., 0., 0. }, { 0., 1., 0. }, { 0., 0., 1. } };
	/// The direction of the packing that points along `axis`, from the links of automaton i; zero when they span no volume.
	Vec<double> normalInPacking(const Store& S, size_t i, int axis)
	{
		Tensor<double> M = {};
		Vec<double>    b {};
		for (int k = 0; k < nLinks; k++)
			if (holds(S.flags[i], k)) {
				const Vec<double> e = Lattice::direction(k);
				addDyad(M, k, e), b += e * Lattice::bearing(S.between(i, size_t(S.neighbour[linkSlot(i, k)])))[axis];
			}
		const double det = determinant(M);
		if (!(std::fabs(det) > 1e-6)) return {};
		const Tensor<double> C = cofactor(M); // M is symmetric: its inverse is C/det
		return (C.column[0] * b[0] + C.column[1] * b[1] + C.column[2] * b[2]) * (1. / det);
	}
	/// Whether it has links to both sides of the plane across `axis` on which it lies.
	bool reachesBeyond(const Store& S, size_t i, int axis)
	{
		double low = 0, high = 0;
		for (int k = 0; k < nLinks; k++)
			if (holds(S.flags[i], k)) {
				const double c = Lattice::bearing(S.between(i, size_t(S.neighbour[linkSlot(i, k)])))[axis];
				low = std::min(low, c), high = std::max(high, c);
			}
		return low < -0.1 && high > 0.1;
	}
	[[noreturn]] void refuse(const Automaton& a, int axis, const std::string& why)
	{
		std::ostringstream s;
		s << "automaton " << a.id << " at " << a.position << " m: state.mirrors says that it lies on a plane of symmetry with its normal along "
		  << "xyz"[axis] << ", " << why;
		throw Error(s.str());
	}
	/// Where the plane of symmetry with this normal lies, from the first automaton on it.
	struct Plane {
		const Automaton* first = nullptr;
		void check(const Automaton& a, int axis)
		{
			if (!first) first = &a;
			if (std::fabs(a.position[axis] - first->position[axis]) > 1e-6 * a.diameter)
				refuse(a, axis,
				       "but automaton " + std::to_string(first->id) + " on it is elsewhere along that axis; a scene has one such plane.");
			if (a.free[axis] || a.velocity[axis] != 0.)
				refuse(a, axis, "but it may leave the plane; block that direction and set the velocity along it to 0.");
			for (int c = 0; c < dim; c++)
				if (c != axis && a.freeR[c]) refuse(a, axis, "but it may turn out of the plane; block the rotations about the other two axes.");
			int planes = 0;
			for (int c = 0; c < dim; c++) planes += a.mirror[c];
			if (a.weight > std::ldexp(1., -planes) + 1e-6)
				refuse(a, axis,
				       "but its mass is not that of the part of the cell on this side; take it from packings.fcc(mirror=...) and addBodies.");
		}
	};
}

/// Weights of the slots of automata that are parts of a cell, and of their links.
void Solver::makeOutlines(const Solver* old)
{
	Store&     S       = store;
	const auto isFresh = [&](size_t i) { return S.id[i] >= 0 && !(old && indexIn(*old, S.id[i]) >= 0); };
	for (size_t i = 0; i < S.size(); i++) {
		if (!isFresh(i)) continue;
		if (S.weight[i] < whole && !options.fullLinks) halveLinks(i, isFresh);
		S.invN[i] = 1. / slots(i);
	}
}
/// All slots of a whole automaton, since sides without a link count as sides without stress; of a part of one that part.
double Solver::slots(size_t i) const { return nLinks * std::min(store.weight[i], 1.); }

/// Links within a face: both ends are parts of cells, and some of the four automata that neighbour both of them are missing. Along the edge of two faces at
/// right angles: at most one is left.
void Solver::halveLinks(size_t i, const std::function<bool(size_t)>& isFresh)
{
	Store&     S      = store;
	const auto common = [&](size_t j) {
		int n = 0;
		for (int a = 0; a < nLinks; a++)
			for (int b = 0; b < nLinks; b++)
				n += holds(S.flags[i], a) && holds(S.flags[j], b) && S.neighbour[linkSlot(i, a)] == S.neighbour[linkSlot(j, b)];
		return n;
	};
	for (int k = 0; k < nLinks; k++) {
		if (!holds(S.flags[i], k)) continue;
		const size_t j = size_t(S.neighbour[linkSlot(i, k)]);
		if (!isFresh(j) || !(S.weight[j] < whole)) continue;
		const int n = common(j); // at both ends the same
		if (n < 4) S.flags[i] |= Flags(1) << (halfShift + k);
		if (n < 2 && std::max(S.weight[i], S.weight[j]) < edge) S.flags[i] |= Flags(1) << (outlineShift + k);
	}
}

void Solver::makeMirrors(const std::vector<Automaton>& automata, const Solver* old)
{
	Store&     S = store;
	Plane      planes[dim];
	for (const Automaton& a : automata) {
		if (!any(a.mirror)) continue;
		if (!hasMirrors(S)) S.mirrorFirst.resize(S.size()), S.mirrorSecond.resize(S.size()), S.mirrorThird.resize(S.size());
		const size_t  i = size_t(indexOf(a.id));
		const int64_t known = old ? indexIn(*old, a.id) : -1;
		int           count = 0;
		for (int axis = 0; axis < dim; axis++) count += a.mirror[axis];
		// beyond the planes it goes on: it is at no surface, where other automata of its body could touch it
		const bool inside = std::fabs(a.weight - std::ldexp(1., -count)) < 1e-6 && isWholeStar(S.flags[i]);
		if (inside && (known < 0 || !(old->store.flags[size_t(known)] & exposedBit))) S.flags[i] &= ~Flags(exposedBit);
		for (int axis = 0; axis < dim; axis++) {
			if (!a.mirror[axis]) continue;
			planes[axis].check(a, axis);
			Vectors& to = axis == 0 ? S.mirrorFirst : axis == 1 ? S.mirrorSecond : S.mirrorThird;
			if (known >= 0 && hasMirrors(old->store)) { // as it was before the body deformed
				const Store& O = old->store;
				to.set(i, (axis == 0 ? O.mirrorFirst : axis == 1 ? O.mirrorSecond : O.mirrorThird).at(size_t(known)));
				continue;
			}
			if (reachesBeyond(S, i, axis)) refuse(a, axis, "but it is linked to automata on both sides of it; the body must end there.");
			const Vec<double> n = normalInPacking(S, i, axis);
			const auto        along = [&](const Vec<double>& p) { return std::fabs(plainDot(p, n)); };
			const auto        best  = std::max_element(symmetries, symmetries + dim, [&](auto& p, auto& q) { return along(p) < along(q); });
			if (linkCount(S.flags[i]) < 3) continue; // debris: there is nothing to complete
			if (along(*best) < 0.999)
				refuse(a, axis,
				       "which is none of the packing as it stands there; turn the packing so that an edge of its cubic cell points along "
				       "that axis.");
			to.set(i, *best);
		}
	}
}

void Solver::checkOutlines(const std::vector<Automaton>& automata, const Solver*) const
{
	for (const Automaton& a : automata)
		if (a.triangles != 0)
			throw Error(
				"automaton " + std::to_string(a.id) + ": triangles = " + std::to_string(a.triangles)
				+ " must be 0 in space: outlines through centres are of the plane only.");
}
}
