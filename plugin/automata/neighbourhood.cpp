// SPDX-License-Identifier: GPL-2.0-or-later
// Who is near whom: which blocks are awake, when contacts are searched.
#include "cell_grid.hpp"
#include "parallel.hpp"
#include <algorithm>
#include <cmath>
#include <tuple>

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

/// Puts those watched that have no cell yet into the cells where they were searched.
void Solver::placeInNearCells()
{
	auto& N = nearCells;
	if (N.used.empty()) N.used.assign(N.cells.cells(), -1), N.of.clear(), N.pairs.clear(), N.count = 0;
	for (size_t q = N.of.size(); q < watch.size(); q++) {
		const Vec<double> x    = watchPlace.at(q);
		int32_t&          cell = N.used[N.cells.cellOf(x)];
		if (cell < 0) {
			N.cells.eachRunAround(x, [&](size_t first, size_t last) {
				for (size_t a = first; a <= last; a++)
					if (N.used[a] >= 0) N.pairs.push_back({ N.used[a], N.count });
				return false;
			});
			cell = N.count++;
		}
		N.of.push_back(cell);
	}
}

/// Whether two watched automata may have come nearer to each other since the search by more than `reach` [m], so that a pair that is not listed may touch.
bool Solver::mayTouch(double reach)
{
	const long     n   = long(watch.size());
	const int32_t* who = watch.data();
	Box            all;
	for (int c = 0; c < dim; c++) {
		const double *x = store.position[c].data(), *x0 = watchPlace[c].data();
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
	placeInNearCells();
	std::vector<Box> boxes(size_t(nearCells.count));
	for (long q = 0; q < n; q++) {
		const Vec<double> moved = store.position.at(who[q]) - watchPlace.at(q);
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

/// One more, which a search has just not looked at.
void Solver::watchToo(int32_t i)
{
	if (isWatched[size_t(i)]) return;
	isWatched[size_t(i)] = 1;
	watch.push_back(i), watchPlace.push_back(searched.at(size_t(i)));
}

/// The interior automata around i that may touch it: those that watched() finds by it.
void Solver::watchForeign(int32_t i)
{
	const Store&      S = store;
	const Vec<double> x = searched.at(size_t(i));
	searchedBoxes.eachNear(x, 2. / nearCells.cells.inv, [&](size_t b) {
		for (int l = 0; l < S.blocks[b].count; l++) {
			const size_t j = b * blockSize + size_t(l);
			const bool   meets = !isWatched[j] && mca::mayTouch(S.flags[size_t(i)], S.flags[j], S.group[size_t(i)] == S.group[j]);
			if (meets && nearCells.cells.adjacent(x, searched.at(j))) watchToo(int32_t(j));
		}
	});
}

/// Ends of links that broke are exposed, and may be foreign to more than before.
void Solver::watchEnds(const std::vector<int32_t>& ends)
{
	if (searchedBoxes.low.empty()) searchedBoxes.make(store, searched);
	for (int32_t i : ends)
		watchToo(i);
	std::vector<std::tuple<size_t, bool, int32_t>> seen; // one for all that are alike
	for (int32_t i : ends) {
		const bool                               debris = linkCount(store.flags[size_t(i)]) < Lattice::volumeLinks;
		const std::tuple<size_t, bool, int32_t> kind { nearCells.cells.cellOf(searched.at(size_t(i))), debris, debris ? 0 : store.group[size_t(i)] };
		if (std::find(seen.begin(), seen.end(), kind) != seen.end()) continue;
		seen.push_back(kind);
		watchForeign(i);
	}
}

/// What follows from the lists of places and of the watched.
void Solver::readyWatch()
{
	watchPlace.resize(watch.size());
	isWatched.assign(store.size(), 0);
	for (size_t q = 0; q < watch.size(); q++)
		watchPlace.set(q, searched.at(size_t(watch[q]))), isWatched[size_t(watch[q])] = 1;
	nearCells.used.clear(), nearCells.of.clear(), searchedBoxes = {};
}

void Solver::searchIfNeeded()
{
	Timer  timer(timing, counters.nsSearch);
	double reach = 1e300; // a pair that is not listed may come nearer by this much before it can touch
	for (auto& sp : store.species)
		reach = std::min(reach, options.skin * sp.d);
	if (searched.size() != store.size()) searchDue = true;
	// links break in batches, every fourth step: each batch needs a search, and a few steps do not matter to a process that takes hundreds
	std::vector<int32_t> ends;
	if (!asked.empty() || (counters.steps % breakPeriod == 0 && breaking())) {
		Timer t(timing, counters.nsFracture);
		ends = breakLinks();
	}
	if (ends.size() && !searchDue) watchEnds(ends);
	if (searchDue || mayTouch(reach)) search();
	else if (ends.size()) searchEnds(ends);
}

std::vector<int32_t> Solver::exposed() const
{
	std::vector<int32_t> who;
	for (size_t i = 0; i < store.size(); i++)
		if (store.id[i] >= 0 && (store.flags[i] & exposedBit)) who.push_back(int32_t(i));
	return who;
}

void Solver::search()
{
	Store& S = store;
	if (counters.steps >= lastSort + 2000 && unsettled.empty()) sortInSpace(); // those go by places
	for (int32_t i : contacts.rowOwner) // entries of owners that may have none any more
		scratch.eachArray([&](auto& v, Presence) {
			if (!v.empty()) v[i] = 0.;
		});
	searched = S.position;
	const std::vector<int32_t> who = exposed();
	searchContacts(S, searched, who, contacts, contactsBefore, options.skin, threads());
	nearCells.cells = Cells(searched, nearCell * S.largestDiameter());
	watch           = watched(S, searched, who, nearCells.cells);
	readyWatch();
	searchDue = false;
	counters.searches++;
	afterSearch();
}

// The list of contacts is always that of the places of the last search of all: pairs that were in range there, may touch by now and are not linked. The speeds
// of all listed pairs limit the time step, so what is listed must not depend on how it was found.
void Solver::searchEnds(const std::vector<int32_t>& ends)
{
	if (wholeLists) searchContacts(store, searched, exposed(), contacts, contactsBefore, options.skin, threads());
	else addContacts(store, searched, searchedBoxes, ends, contacts, options.skin);
	counters.localSearches++;
	afterSearch();
}

void Solver::afterSearch()
{
	if (contacts.size()) scratch.resize(store.size(), options.account);
	settleVolumes();
	contactAdjacent.clear();
	if (options.sleeping && awake.size() < store.blocks.size()) {
		for (size_t c = 0; c < contacts.size(); c++) {
			const int32_t a = contacts.owner[c] / blockSize, b = contacts.other[c] / blockSize;
			if (a < b) contactAdjacent.push_back({ a, b });
		}
		std::sort(contactAdjacent.begin(), contactAdjacent.end());
		contactAdjacent.erase(std::unique(contactAdjacent.begin(), contactAdjacent.end()), contactAdjacent.end());
	}
	topologyChanged = true;
}
}
