// SPDX-License-Identifier: GPL-2.0-or-later
// Where bodies end: outlines through centres (formulation, (5g), (7b)) and weighted rims, made with the links.
#include "../solver.hpp"
#include <algorithm>
#include <cmath>
#include <sstream>

namespace mca::automata {

/// What automata are at the outlines of their bodies; those that were there before stay what they were, unless they have got a link.
void Solver::makeOutlines(const Solver* old)
{
	Store&       S       = store;
	const size_t n       = S.size();
	const auto   isFresh = [&](size_t i) { return S.id[i] >= 0 && !(old && indexIn(*old, S.id[i]) >= 0); };
	const auto hasGotLinks = [&](size_t i) {
		return S.id[i] >= 0 && !isFresh(i) && S.flags[i] & int32_t(linkBits) & ~old->store.flags[size_t(indexIn(*old, S.id[i]))];
	};
	for (size_t i = 0; i < n; i++)
		if (isFresh(i)) {
			const Triangles t = trianglesAround(i);
			if (endsAtOutline(t, S.weight[i])) S.flags[i] = withTriangles(S.flags[i], t);
		} else if (hasGotLinks(i))
			S.flags[i] = withoutTriangles(S.flags[i]), S.invN[i] = 1. / slots(i);
	for (size_t i = 0; i < n; i++)
		if (isFresh(i)) dropOutside(i);
	if (!options.fullLinks)
		for (size_t i = 0; i < n; i++)
			if (isFresh(i) && S.weight[i] < 0.999) halveLinks(i, isFresh);
}

/// Whether both ends of links k and k + 1 hold and are linked to each other.
bool Solver::closes(size_t i, int k) const
{
	const Store&  S = store;
	const size_t  j = size_t(S.neighbour[linkSlot(i, k)]);
	const int32_t other = S.neighbour[linkSlot(i, nextLink(k))];
	const int     between = (k + 2) % nLinks; // from one end to the other
	return holds(S.flags[j], between) && S.neighbour[linkSlot(j, between)] == other;
}
Triangles Solver::trianglesAround(size_t i) const
{
	return trianglesOf(store.flags[i], [&](int k) { return closes(i, k); });
}
/// That an automaton which was made to end at an outline does: else its surface would be another one than the script has asked for.
void Solver::checkOutlines(const std::vector<Automaton>& automata, const Solver* old) const
{
	for (const Automaton& a : automata) {
		if (a.triangles == 0 || (old && indexIn(*old, a.id) >= 0)) continue;
		const int    found = triangleCount(trianglesAround(size_t(indexOf(a.id))));
		const double meant = a.triangles * (1. / nLinks);
		if (found == a.triangles && std::fabs(a.weight - meant) < 1e-6) continue;
		std::ostringstream s;
		s << "automaton " << a.id << " at " << a.position << " m was made to stand for " << a.triangles << " of the " << nLinks
		  << " triangles around it (state.triangles, rim='triangles'), but its neighbours make " << found << ", and its mass is " << a.weight
		  << " of a full cell instead of " << meant << ". Take packings whole, give each body a mask of its own, and keep the density and the masses "
		     "of packings.addBodies; or set state.triangles = 0 for an ordinary automaton of that mass.";
		throw Error(s.str());
	}
}
void Solver::makeMirrors(const std::vector<Automaton>& automata, const Solver*)
{
	for (const Automaton& a : automata)
		if (any(a.mirror))
			throw Error(
				"automaton " + std::to_string(a.id) + ": planes of symmetry (state.mirrors) are of bodies in space; in plane strain set it "
				"to 0 and block the motion across a row of half weight.");
}
/// Sum of the weights of its links, at least what it weighs.
double Solver::slots(size_t i) const
{
	double sum = 0;
	for (int k = 0; k < nLinks; k++)
		if (holds(store.flags[i], k)) sum += linkWeight(store.flags[i], k);
	return std::max(sum, nLinks * store.weight[i]);
}
/// Two automata at outlines that no triangle joins are no neighbours in their body.
void Solver::dropOutside(size_t i)
{
	Store&          S = store;
	const Triangles t = trianglesIn(S.flags[i]);
	for (int k = 0; t && k < nLinks; k++) {
		if (!holds(S.flags[i], k) || trianglesBeside(t, k)) continue;
		const size_t    j = size_t(S.neighbour[linkSlot(i, k)]);
		const Triangles other = trianglesIn(S.flags[j]);
		const int       back  = Lattice::opposite(k);
		if (!other || trianglesBeside(other, back)) continue;
		S.flags[i] &= ~slotBits(k), S.flags[j] &= ~slotBits(back);
		S.neighbour[linkSlot(i, k)] = int32_t(i), S.neighbour[linkSlot(j, back)] = int32_t(j);
		S.flags[i] |= exposedBit, S.flags[j] |= exposedBit;
	}
}

/// Links along weighted rims: both ends are cut cells and the pair borders on one triangle of the lattice only.
void Solver::halveLinks(size_t i, const std::function<bool(size_t)>& isFresh)
{
	Store&     S      = store;
	const auto common = [&](size_t j) { // neighbours of both
		int n = 0;
		for (int a = 0; a < nLinks; a++)
			for (int b = 0; b < nLinks; b++)
				n += ((S.flags[i] >> a) & 1) && ((S.flags[j] >> b) & 1) && S.neighbour[linkSlot(i, a)] == S.neighbour[linkSlot(j, b)];
		return n;
	};
	for (int k = 0; k < nLinks; k++) {
		if (!holds(S.flags[i], k)) continue;
		const size_t j = size_t(S.neighbour[linkSlot(i, k)]);
		if (isFresh(j) && S.weight[j] < 0.999 && common(j) <= 1) S.flags[i] |= 1 << (halfShift + k); // at both ends or at none
	}
	S.invN[i] = 1. / slots(i);
}
}
