// SPDX-License-Identifier: GPL-2.0-or-later
// The largest stable step at the present state (13), over all blocks: the sleeping ones with their state of rest.
#include "../kernels/automaton/limit.hpp"
#include "solver.hpp"
#include <algorithm>

namespace mca::automata {

void Solver::limitStep()
{
	const Store& S       = store;
	double       limit = 1e300, pressed = 0; // stiffest of what meets something else [Pa]
	const auto   meets = [](const Block& B) { return B.mixed || B.contact; };
	for (size_t b = 0; b < S.blocks.size(); b++)
		if (meets(S.blocks[b])) pressed = std::max(pressed, results[b].stiffest * S.materialOf(S.blocks[b]).eos.rho0);
	for (size_t b = 0; b < S.blocks.size(); b++) {
		const Block&       B = S.blocks[b];
		const BlockResult& R = results[b];
		const double       d = S.species[B.species].d, approach = lastMove > 0 ? R.closing * d / lastMove : 0.;
		limit = std::min(limit, stepLimit(S.materialOf(B), options.volumeRule, d, R.stiffest, meets(B) ? pressed : 0., approach, R.widest));
	}
	double smallest = 1e300;
	for (auto& sp : S.species)
		smallest = std::min(smallest, sp.d);
	dtLimit = contactSpeed2 > 0 ? std::min(limit, stepLimitOfContacts(smallest, contactSpeed2)) : limit;
}

size_t Solver::stiffestAutomaton() const
{
	const Store& S    = store;
	size_t       who  = 0;
	double       most = -1;
	for (size_t b = 0; b < S.blocks.size(); b++)
		for (int l = 0; l < S.blocks[b].count; l++) {
			const size_t    i = b * blockSize + l;
			const Material& m = S.materialOf(S.blocks[b]);
			const double    k = dispatch(m.eos.kind, [&](auto law) { return stiffness(VolumeConstants<law.value>(m, S.diameter[i]), S.J[i]); })
				/ sqr(S.diameter[i]);
			if (k > most) most = k, who = i;
		}
	return who;
}
}
