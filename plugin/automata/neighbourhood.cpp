// SPDX-License-Identifier: GPL-2.0-or-later
// Who is near whom: which blocks are awake, when contacts are searched.
#include "parallel.hpp"
#include <algorithm>
#include <cmath>
#include <omp.h>

namespace mca::automata {

void Solver::wakeAround(size_t block)
{
	Store& S = store;
	S.blocks[block].awake = true;
	for (int32_t q = adjacentBegin[block]; q < adjacentBegin[block + 1]; q++) {
		const int32_t a    = adjacent[q];
		S.blocks[a].awake = true;
		for (int32_t p = adjacentBegin[a]; p < adjacentBegin[a + 1]; p++)
			S.blocks[adjacent[p]].awake = true;
	}
}

// Forces reach two links in one step (through the volume of the neighbour's neighbour), so two rings of blocks around a moving one are computed.
void Solver::wake()
{
	Store& S = store;
	if (awake.size() == S.blocks.size() && !topologyChanged) return;
	for (size_t b = 0; b < S.blocks.size(); b++)
		if (S.blocks[b].moving && !S.blocks[b].ringsAwake) {
			wakeAround(b);
			S.blocks[b].ringsAwake = true;
		}
	for (auto& [a, b] : contactAdjacent)
		if (S.blocks[a].moving != S.blocks[b].moving || S.blocks[a].awake != S.blocks[b].awake) wakeAround(a), wakeAround(b);
	awake.clear();
	for (size_t b = 0; b < S.blocks.size(); b++)
		if (S.blocks[b].awake) awake.push_back(int32_t(b));
	if (topologyChanged) S.packAll(); // neighbours of blocks that sleep read their records, which then stay as they are
	topologyChanged = false;
}

void Solver::searchIfNeeded()
{
	Timer  timer(timing, counters.nsSearch);
	Store& S = store;
	bool   due = searchDue;
	double reach = 1e300; // a pair that is not listed may come nearer by this much before it can touch
	for (auto& sp : S.species)
		reach = std::min(reach, options.skin * sp.d);
	const long    n = long(exposed.size());
	const int32_t* who = exposed.data();
	// no two have moved against each other by more than the diagonal of the box that holds all displacements, nor by more than twice the largest
	double diagonal2 = 0, most = 0;
	for (int c = 0; c < dim; c++) {
		const double *x = S.position[c].data(), *x0 = searched[c].data();
		double        low = 1e300, high = -1e300;
#pragma omp parallel for simd schedule(static) reduction(max : high) reduction(min : low) if (n > 4096)
		for (long q = 0; q < n; q++) {
			const double moved = x[who[q]] - x0[q];
			low = min(low, moved), high = max(high, moved);
		}
		diagonal2 += sqr(high - low);
	}
	if (n > 0 && diagonal2 > sqr(reach))
		for (long q = 0; q < n; q++)
			most = max(most, plainSquare(S.position.at(who[q]) - searched.at(q)));
	due |= 4. * most > sqr(reach);
	// links break in batches, every fourth step: each batch needs a search, and a few steps do not matter to a process that takes hundreds
	if (!due && counters.steps % breakPeriod == 0) due = breaking();
	if (due) search();
}

void Solver::search()
{
	Store& S = store;
	if (counters.steps % breakPeriod == 0) {
		Timer t(timing, counters.nsFracture);
		breakLinks();
	}
	if (counters.steps >= lastSort + 2000) sortInSpace();
	for (int32_t i : contacts.rowOwner) // entries of owners that may have none any more
		scratch.eachArray([&](auto& v, Presence) {
			if (!v.empty()) v[i] = 0.;
		});
	searchContacts(S, contacts, options.skin, std::max(1, omp_get_max_threads()));
	if (contacts.size()) scratch.resize(S.size(), options.account);
	settleVolumes();
	exposed.clear();
	for (size_t i = 0; i < S.size(); i++)
		if (S.id[i] >= 0 && (S.flags[i] & exposedBit)) exposed.push_back(int32_t(i));
	searched.resize(exposed.size());
	for (size_t q = 0; q < exposed.size(); q++)
		searched.set(q, S.position.at(exposed[q]));
	contactAdjacent.clear();
	if (options.sleeping && awake.size() < S.blocks.size()) {
		for (size_t c = 0; c < contacts.size(); c++) {
			const int32_t a = contacts.owner[c] / blockSize, b = contacts.other[c] / blockSize;
			if (a < b) contactAdjacent.push_back({ a, b });
		}
		std::sort(contactAdjacent.begin(), contactAdjacent.end());
		contactAdjacent.erase(std::unique(contactAdjacent.begin(), contactAdjacent.end()), contactAdjacent.end());
	}
	topologyChanged = true;
	searchDue       = false;
	counters.searches++;
}
}
