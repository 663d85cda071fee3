// SPDX-License-Identifier: GPL-2.0-or-later
#include "../threads.hpp"
#include "cell_grid.hpp"
#include "contact_pairs.hpp"
#include <algorithm>
#include <cmath>

namespace mca::automata {
namespace {
	bool    exposed(const Store& S, int32_t i) { return S.flags[i] & exposedBit; }
	/// Places of some.
	Vectors of(const std::vector<int32_t>& who, const Vectors& place)
	{
		Vectors at;
		at.resize(who.size());
		for (size_t q = 0; q < who.size(); q++)
			at.set(q, place.at(who[q]));
		return at;
	}
	/// Calls f(j) for all automata of the grid that are closer to i than (1 + skin) times their rest distance, i included, until it returns true.
	/// The size of the cells is at least the largest such distance.
	template <class F> void around(const Store& S, const Vectors& place, const CellGrid& grid, int32_t i, double skin, F&& f)
	{
		const Vec<double> x    = place.at(i);
		const auto        at   = grid.position.planes();
		const double      far2 = 1. / sqr(grid.inv);
		grid.eachRunAround(x, [&](size_t first, size_t last) {
			for (int32_t p = grid.begin[first]; p < grid.begin[last + 1]; p++) {
				const double r2 = plainSquare(at.at(p) - x);
				if (r2 < far2 && r2 < reach2(S, i, grid.item[p], skin) && f(grid.item[p])) return true;
			}
			return false;
		});
	}
	/// What interior automata of a cell may be reached by: nothing, the exposed of one body (to which it is foreign), or anything.
	struct Reaching {
		static constexpr int64_t anything = int64_t(1) << 40, nothing = anything + 1; // groups are 32 bits; nothing is the largest
		std::vector<int64_t>     by;
		Reaching(const Store& S, const CellGrid& grid)
			: by(grid.cells(), nothing)
		{
			const auto add = [](int64_t& to, int64_t more) { to = to == more || to == nothing || more == nothing ? std::min(to, more) : anything; };
			for (size_t c = 0; c < grid.cells(); c++) {
				int64_t here = nothing;
				for (int32_t p = grid.begin[c]; p < grid.begin[c + 1]; p++) {
					const int32_t j = grid.item[p];
					add(here, linkCount(S.flags[j]) < Lattice::volumeLinks ? anything : S.group[j]);
				}
				if (here == nothing) continue;
				grid.eachRunAround(grid.position.at(grid.begin[c]), [&](size_t first, size_t last) {
					for (size_t a = first; a <= last; a++)
						add(by[a], here);
					return false;
				});
			}
		}
		bool may(size_t cell, int32_t group) const { return by[cell] != nothing && by[cell] != group; }
	};
	/// Interior automata that something foreign is about to reach, in the order of the arrays.
	std::vector<int32_t> reached(const Store& S, const Vectors& place, const CellGrid& grid, double skin, int threads)
	{
		const Reaching                    reaching(S, grid);
		std::vector<std::vector<int32_t>> parts(threads);
		const long                        nb = long(S.blocks.size());
		eachPart(threads, [&](int t) {
			for (long b = nb * t / threads; b < nb * (t + 1) / threads; b++)
				for (int l = 0; l < S.blocks[b].count; l++) {
					const int32_t     i = int32_t(b * blockSize + l);
					const Vec<double> x = place.at(i);
					if (exposed(S, i) || grid.away(x) || !reaching.may(grid.cellOf(x), S.group[i])) continue;
					around(S, place, grid, i, skin, [&](int32_t j) {
						if (!touching(S, j, i)) return false;
						parts[t].push_back(i);
						return true;
					});
				}
		});
		std::vector<int32_t> all;
		for (auto& p : parts)
			all.insert(all.end(), p.begin(), p.end());
		return all;
	}
	/// What an old contact of the pair held, or a link that has just broken.
	void carryOver(const Store& S, const Contacts& old, const std::vector<int32_t>& oldRow, Contacts& C, size_t c)
	{
		const int32_t i = C.owner[c], j = C.other[c];
		if (!oldRow.empty() && oldRow[i] >= 0)
			for (int32_t q = old.rowBegin[oldRow[i]]; q < old.rowBegin[oldRow[i] + 1]; q++)
				if (old.other[q] == j) {
					setSide(C, c, sideOf(old, size_t(q))), C.rest[c] = old.rest[q];
					return;
				}
		takeLinkStress(S, C, c);
	}
	/// Rows of some of the owners.
	struct RowPart {
		std::vector<int32_t> owner, other, rowOwner, rowSize;
	};
	/// Contacts of these automata in one part per thread.
	std::vector<RowPart> findRows(const Store& S, const Vectors& place, const CellGrid& grid, const std::vector<int32_t>& who, double skin, int threads)
	{
		std::vector<RowPart> parts(threads);
		const long        n = long(who.size());
		eachPart(threads, [&](int t) {
			RowPart&             P = parts[t];
			std::vector<int32_t> row;
			for (long q = n * t / threads; q < n * (t + 1) / threads; q++) {
				const int32_t i  = who[q];
				row.clear();
				around(S, place, grid, i, skin, [&](int32_t j) {
					if (j != i && touching(S, i, j) && !heldApart(S, i, j)) row.push_back(j);
					return false;
				});
				if (row.empty()) continue;
				std::sort(row.begin(), row.end(), [&](int32_t a, int32_t b) { return S.id[a] < S.id[b]; });
				P.rowOwner.push_back(i);
				P.rowSize.push_back(int32_t(row.size()));
				P.owner.insert(P.owner.end(), row.size(), i);
				P.other.insert(P.other.end(), row.begin(), row.end());
			}
		});
		return parts;
	}
}

std::vector<int32_t> watched(const Store& S, const Vectors& place, const std::vector<int32_t>& exposed, const Cells& cells)
{
	std::vector<int32_t> all = exposed;
	if (exposed.empty()) return all;
	const CellGrid grid(cells, of(exposed, place), exposed);
	const Reaching reaching(S, grid);
	for (size_t b = 0; b < S.blocks.size(); b++)
		for (int l = 0; l < S.blocks[b].count; l++) {
			const int32_t     i = int32_t(b * blockSize) + l;
			const Vec<double> x = place.at(i);
			if (!(S.flags[i] & exposedBit) && !grid.away(x) && reaching.may(grid.cellOf(x), S.group[i])) all.push_back(i);
		}
	std::inplace_merge(all.begin(), all.begin() + long(exposed.size()), all.end());
	return all;
}

void searchContacts(Store& S, const Vectors& place, const std::vector<int32_t>& exposed, Contacts& C, Contacts& old, double skin, int threads)
{
	for (auto& b : S.blocks)
		b.contact = false;
	std::swap(old, C); // arrays keep their memory: with two lists by turns no search allocates
	C.rowBegin.assign(1, 0), C.rowOwner.clear(), C.owner.clear(), C.other.clear();
	if (exposed.empty()) return C.eachArray([&](auto& v, Presence) { v.clear(); });
	const double               cell = longestReach(S, skin);
	CellGrid                   grid(of(exposed, place), exposed, cell);
	std::vector<int32_t>       who  = exposed;
	const std::vector<int32_t> more = reached(S, place, grid, skin, threads);
	if (more.size()) {
		who.insert(who.end(), more.begin(), more.end());
		std::inplace_merge(who.begin(), who.begin() + long(exposed.size()), who.end());
		grid = CellGrid(of(who, place), who, cell);
	}
	std::vector<int32_t> oldRow;
	if (old.rows()) {
		oldRow.assign(S.size(), -1);
		for (size_t r = 0; r < old.rows(); r++)
			oldRow[old.rowOwner[r]] = int32_t(r);
	}
	const auto parts = findRows(S, place, grid, who, skin, threads);
	for (const RowPart& P : parts) {
		C.owner.insert(C.owner.end(), P.owner.begin(), P.owner.end());
		C.other.insert(C.other.end(), P.other.begin(), P.other.end());
		C.rowOwner.insert(C.rowOwner.end(), P.rowOwner.begin(), P.rowOwner.end());
		for (int32_t s : P.rowSize)
			C.rowBegin.push_back(C.rowBegin.back() + s);
	}
	const size_t m = C.size();
	C.eachArray([&](auto& v, Presence) { v.resize(m); });
	const auto           table = pairConstants(S);
	std::vector<int32_t> rowOf(S.size(), -1);
	for (size_t r = 0; r < C.rows(); r++)
		rowOf[C.rowOwner[r]] = int32_t(r), S.blocks[C.rowOwner[r] / blockSize].contact = true;
	eachPart(threads, [&](int t) {
		for (size_t c = m * t / threads; c < m * (t + 1) / threads; c++) {
			const int32_t j = C.other[c];
			for (int32_t q = C.rowBegin[rowOf[j]]; q < C.rowBegin[rowOf[j] + 1]; q++)
				if (C.other[q] == C.owner[c]) C.reverse[c] = q;
			start(S, table, C, c), carryOver(S, old, oldRow, C, c);
		}
	});
}
}
