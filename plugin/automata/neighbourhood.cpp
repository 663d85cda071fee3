// SPDX-License-Identifier: GPL-2.0-or-later
// Who is near whom: which blocks are awake, when contacts are searched.
#include "cell_grid.hpp"
#include "parallel.hpp"
#include <algorithm>
#include <cmath>

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
	if (topologyChanged && awake.size() < S.blocks.size()) S.packAll(); // neighbours of blocks that sleep read their records, which then stay as they are
	topologyChanged = false;
}

namespace {
	/// Displacements that lie in a box, of some automata.
	struct Box {
		Vec<double> low = both(1e300), high = both(-1e300);
		static Vec<double> both(double a)
		{
			Vec<double> v;
			for (int c = 0; c < dim; c++) v[c] = a;
			return v;
		}
		void add(const Box& o)
		{
			for (int c = 0; c < dim; c++) low[c] = min(low[c], o.low[c]), high[c] = max(high[c], o.high[c]);
		}
		/// Square of the diagonal [m2]: no two of them have moved against each other by more.
		double diagonal2() const { return plainSquare(high - low); }
	};
}

/// Cells of the watched automata where they were searched.
void Solver::makeNearCells()
{
	std::vector<int32_t> places(watch.size());
	for (size_t q = 0; q < places.size(); q++) places[q] = int32_t(q);
	const CellGrid       grid(searched, places, nearCell * store.largestDiameter());
	std::vector<int32_t> used(grid.cells(), -1);
	nearCells.of.resize(watch.size()), nearCells.pairs.clear(), nearCells.count = 0;
	for (size_t c = 0; c < grid.cells(); c++) {
		if (grid.begin[c] == grid.begin[c + 1]) continue;
		used[c] = nearCells.count++;
		for (int32_t p = grid.begin[c]; p < grid.begin[c + 1]; p++) nearCells.of[grid.item[p]] = used[c];
	}
	for (size_t c = 0; c < grid.cells(); c++)
		if (used[c] >= 0)
			grid.eachRunAround(grid.position.at(grid.begin[c]), [&](size_t first, size_t last) {
				for (size_t a = first; a <= last; a++)
					if (used[a] > used[c]) nearCells.pairs.push_back({ used[c], used[a] });
				return false;
			});
}

/// Whether two watched automata may have come nearer to each other since the search by more than `reach` [m], so that a pair that is not listed may touch.
bool Solver::mayTouch(double reach)
{
	const long     n   = long(watch.size());
	const int32_t* who = watch.data();
	Box            all;
	for (int c = 0; c < dim; c++) {
		const double *x = store.position[c].data(), *x0 = searched[c].data();
		double        low = 1e300, high = -1e300;
#pragma omp simd reduction(max : high) reduction(min : low)
		for (long q = 0; q < n; q++) {
			const double moved = x[who[q]] - x0[q];
			low = min(low, moved), high = max(high, moved);
		}
		all.low[c] = low, all.high[c] = high;
	}
	if (n == 0 || all.diagonal2() <= sqr(reach)) return false;
	// One fast fragment does not make a new search for all: who was in cells next to each other counts, and for others that they were a cell apart.
	if (all.diagonal2() > sqr((nearCell - 1.) * store.largestDiameter())) return true;
	if (nearCells.of.size() != watch.size()) makeNearCells();
	std::vector<Box> boxes(size_t(nearCells.count));
	for (long q = 0; q < n; q++) {
		const Vec<double> moved = store.position.at(who[q]) - searched.at(q);
		boxes[nearCells.of[q]].add({ moved, moved });
	}
	for (const Box& b : boxes)
		if (b.diagonal2() > sqr(reach)) return true;
	for (auto [a, b] : nearCells.pairs) {
		Box both = boxes[a];
		both.add(boxes[b]);
		if (both.diagonal2() > sqr(reach)) return true;
	}
	return false;
}

void Solver::searchIfNeeded()
{
	Timer  timer(timing, counters.nsSearch);
	double reach = 1e300; // a pair that is not listed may come nearer by this much before it can touch
	for (auto& sp : store.species)
		reach = std::min(reach, options.skin * sp.d);
	// links break in batches, every fourth step: each batch needs a search, and a few steps do not matter to a process that takes hundreds
	if (searchDue || mayTouch(reach) || (counters.steps % breakPeriod == 0 && breaking())) search();
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
	std::vector<int32_t> exposed;
	for (size_t i = 0; i < S.size(); i++)
		if (S.id[i] >= 0 && (S.flags[i] & exposedBit)) exposed.push_back(int32_t(i));
	searchContacts(S, exposed, contacts, contactsBefore, options.skin, threads());
	if (contacts.size()) scratch.resize(S.size(), options.account);
	settleVolumes();
	watch = watched(S, exposed, nearCell * S.largestDiameter());
	searched.resize(watch.size());
	for (size_t q = 0; q < watch.size(); q++)
		searched.set(q, S.position.at(watch[q]));
	nearCells.of.clear();
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
