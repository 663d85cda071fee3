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
	const double * x = S.x.data(), *y = S.y.data(), *x0 = searchX.data(), *y0 = searchY.data();
	// no two have moved against each other by more than the diagonal of the box that holds all displacements, nor by more than twice the largest
	double most = 0, left = 1e300, right = -1e300, low = 1e300, high = -1e300;
#pragma omp parallel for simd schedule(static) reduction(max : most, right, high) reduction(min : left, low) if (n > 4096)
	for (long q = 0; q < n; q++) {
		const double dx = x[who[q]] - x0[q], dy = y[who[q]] - y0[q];
		most = max(most, dx * dx + dy * dy);
		left = min(left, dx), right = max(right, dx), low = min(low, dy), high = max(high, dy);
	}
	due |= n > 0 && 4. * most > sqr(reach) && sqr(right - left) + sqr(high - low) > sqr(reach);
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
		for (auto v : { &scratch.sum, &scratch.square, &scratch.old, &scratch.scale, &scratch.fx, &scratch.fy, &scratch.torque, &scratch.volX,
		                &scratch.volY, &scratch.visX, &scratch.visY })
			if (!v->empty()) (*v)[i] = 0.;
	searchContacts(S, contacts, options.skin, std::max(1, omp_get_max_threads()));
	if (contacts.size()) {
		for (auto v : { &scratch.sum, &scratch.square, &scratch.scale, &scratch.fx, &scratch.fy, &scratch.torque })
			v->resize(S.size(), 0.);
		if (options.account)
			for (auto v : { &scratch.old, &scratch.volX, &scratch.volY, &scratch.visX, &scratch.visY })
				v->resize(S.size(), 0.);
	}
	settleVolumes();
	exposed.clear();
	for (size_t i = 0; i < S.size(); i++)
		if (S.id[i] >= 0 && (S.flags[i] & exposedBit)) exposed.push_back(int32_t(i));
	searchX.resize(exposed.size()), searchY.resize(exposed.size());
	for (size_t q = 0; q < exposed.size(); q++)
		searchX[q] = S.x[exposed[q]], searchY[q] = S.y[exposed[q]];
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
