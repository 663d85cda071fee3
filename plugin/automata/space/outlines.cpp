// SPDX-License-Identifier: GPL-2.0-or-later
// Where bodies end in space: at whole automata, whose volume the links measure that they have. No outlines through centres, no links that count half.
#include "../solver.hpp"
#include <algorithm>

namespace mca::automata {

/// Weights of the slots of automata that are parts of a cell.
void Solver::makeOutlines(const Solver* old)
{
	Store& S = store;
	for (size_t i = 0; i < S.size(); i++)
		if (S.id[i] >= 0 && !(old && indexIn(*old, S.id[i]) >= 0)) S.invN[i] = 1. / slots(i);
}
/// Sum of the weights of its links, at least what it weighs; all of them in a whole automaton, since sides without a link count as sides without stress.
double Solver::slots(size_t i) const { return nLinks * std::min(store.weight[i], 1.); }

void Solver::checkOutlines(const std::vector<Automaton>& automata, const Solver*) const
{
	for (const Automaton& a : automata)
		if (a.triangles != 0)
			throw Error(
				"automaton " + std::to_string(a.id) + ": triangles = " + std::to_string(a.triangles)
				+ " must be 0 in space: outlines through centres are of the plane only.");
}
}
