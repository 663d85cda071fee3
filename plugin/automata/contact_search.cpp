// SPDX-License-Identifier: GPL-2.0-or-later
#include "contacts.hpp"
#include <algorithm>
#include <cmath>
#include <omp.h>

namespace mca::automata {
namespace {
	/// Uniform grid of cells over the exposed automata; a list per cell by counting sort.
	struct CellGrid {
		Vec<double>          low {}, high {}; ///< corners of the box that holds all [m]
		double               inv = 0;         ///< cells per length [1/m]
		Vec<int>             count {};
		std::vector<int32_t> begin, item;
		Vectors              position; ///< in the order of `item`: the cells around an automaton are a few runs of it
		CellGrid(const Store& S, const std::vector<int32_t>& who, double size)
		{
			for (int c = 0; c < dim; c++) {
				low[c] = 1e300, high[c] = -1e300;
				for (int32_t i : who)
					low[c] = std::min(low[c], S.position[c][i]), high[c] = std::max(high[c], S.position[c][i]);
			}
			// debris far away must not make the grid larger than the list that it serves
			const double most  = 8. * double(who.size()) + 1024.;
			const auto   cells = [&] {
                                double n = 1;
                                for (int c = 0; c < dim; c++)
                                        n *= (high[c] - low[c]) / size + 1;
                                return n;
			};
			while (cells() > most)
				size *= 1.25;
			inv        = 1. / size;
			size_t all = 1;
			for (int c = 0; c < dim; c++)
				count[c] = int((high[c] - low[c]) * inv) + 1, all *= size_t(count[c]);
			begin.assign(all + 1, 0);
			for (int32_t i : who)
				begin[cellOf(S, i) + 1]++;
			for (size_t c = 1; c < begin.size(); c++)
				begin[c] += begin[c - 1];
			position.resize(who.size());
			item.resize(who.size());
			std::vector<int32_t> at(begin.begin(), begin.end() - 1);
			for (int32_t i : who) {
				const int32_t p = at[cellOf(S, i)]++;
				item[p]         = i, position.set(p, S.position.at(i));
			}
		}
		/// The cell of a place, moved by so many cells, within the grid.
		Vec<int> cell(Vec<double> x, int by) const
		{
			Vec<int> at;
			for (int c = 0; c < dim; c++)
				at[c] = std::max(0, std::min(std::max(0, std::min(int((x[c] - low[c]) * inv), count[c] - 1)) + by, count[c] - 1));
			return at;
		}
		size_t cellOf(const Store& S, int32_t i) const { return cellNumber(cell(S.position.at(i), 0), count); }
	};
	bool linked(const Store& S, int32_t i, int32_t j)
	{
		for (int k = 0; k < nLinks; k++)
			if (holds(S.flags[i], k) && S.neighbour[linkSlot(i, k)] == j) return true;
		return false;
	}
	bool   exposed(const Store& S, int32_t i) { return S.flags[i] & exposedBit; }
	bool   touching(const Store& S, int32_t i, int32_t j) { return mayTouch(S.flags[i], S.flags[j], S.group[i] == S.group[j]); }
	double reach2(const Store& S, int32_t i, int32_t j, double skin) { return sqr(S.restDistance(i, j) * (1. + skin)); }
	/// Calls f(j) for all automata of the grid that are closer to i than (1 + skin) times their rest distance, i included, until it returns true.
	/// The size of the cells is at least the largest such distance.
	template <class F> void around(const Store& S, const CellGrid& grid, int32_t i, double skin, F&& f)
	{
		const Vec<double> x    = S.position.at(i);
		const auto        at   = grid.position.planes();
		const double      far2 = 1. / sqr(grid.inv);
		eachRun(grid.cell(x, -1), grid.cell(x, 1), [&](Vec<int> first, Vec<int> last) {
			for (int32_t p = grid.begin[cellNumber(first, grid.count)]; p < grid.begin[cellNumber(last, grid.count) + 1]; p++) {
				const double r2 = plainSquare(at.at(p) - x);
				if (r2 < far2 && r2 < reach2(S, i, grid.item[p], skin) && f(grid.item[p])) return true;
			}
			return false;
		});
	}
	/// Adds to `who` the interior automata that something foreign is about to reach, in the order of the arrays.
	void addReached(const Store& S, std::vector<int32_t>& who, double size, double skin, int threads)
	{
		const CellGrid                    grid(S, who, size);
		std::vector<std::vector<int32_t>> parts(threads);
		const long                        nb = long(S.blocks.size());
		Vec<double>                       low, high;
		for (int c = 0; c < dim; c++)
			low[c] = grid.low[c] - 1. / grid.inv, high[c] = grid.low[c] + (grid.count[c] + 1) / grid.inv;
		const auto away = [&](size_t i) {
			for (int c = 0; c < dim; c++)
				if (S.position[c][i] < low[c] || S.position[c][i] > high[c]) return true;
			return false;
		};
#pragma omp parallel for schedule(static, 1) num_threads(threads)
		for (int t = 0; t < threads; t++)
			for (long b = nb * t / threads; b < nb * (t + 1) / threads; b++)
				for (int l = 0; l < S.blocks[b].count; l++) {
					const int32_t i = int32_t(b * blockSize + l);
					if (exposed(S, i) || away(i)) continue;
					around(S, grid, i, skin, [&](int32_t j) {
						if (!touching(S, j, i)) return false;
						parts[t].push_back(i);
						return true;
					});
				}
		const size_t middle = who.size();
		for (auto& p : parts)
			who.insert(who.end(), p.begin(), p.end());
		std::inplace_merge(who.begin(), who.begin() + middle, who.end());
	}
	/// stress of a pair before: an old contact, or a link that has just broken
	void carryOver(const Store& S, const Contacts& old, const std::vector<int32_t>& oldRow, int32_t i, int32_t j, double& s, double& tau, double& rest)
	{
		if (!oldRow.empty() && oldRow[i] >= 0)
			for (int32_t c = old.rowBegin[oldRow[i]]; c < old.rowBegin[oldRow[i] + 1]; c++)
				if (old.other[c] == j) {
					s = old.s[c], tau = old.tau[c], rest = old.rest[c];
					return;
				}
		for (int k = 0; k < nLinks; k++)
			if (hasHeld(S.flags[i], k) && !holds(S.flags[i], k) && S.neighbour[linkSlot(i, k)] == j)
				s = S.s[linkSlot(i, k)], tau = S.tau[linkSlot(i, k)];
	}
	/// What a pair of species has in common.
	struct PairConstants {
		double d, arm, twoG, friction, viscLinear, viscQuadratic;
	};
	std::vector<PairConstants> pairConstants(const Store& S)
	{
		std::vector<PairConstants> table;
		for (const Species& a : S.species)
			for (const Species& b : S.species) {
				const Material &m = S.materials[a.material], &o = S.materials[b.material];
				PairConstants   p { 0.5 * (a.d + b.d), arm(a.d, b.d), 0, std::min(m.friction, o.friction), 0, 0 };
				const PairViscosity v = viscosityOf(m, o);
				p.twoG = seriesTwoG(m.G, o.G, p.arm), p.viscLinear = v.linear, p.viscQuadratic = v.quadratic;
				table.push_back(p);
			}
		return table;
	}
	void constants(const Store& S, const std::vector<PairConstants>& table, Contacts& C, size_t c)
	{
		const int32_t        i = C.owner[c], j = C.other[c];
		const PairConstants& p = table[size_t(S.speciesOf(i)) * S.species.size() + S.speciesOf(j)];
		C.d[c]                 = p.d;
		C.rest[c]              = restAtStart(C.d[c], S.distance2(i, j));
		C.arm[c] = p.arm, C.twoG[c] = p.twoG, C.friction[c] = p.friction, C.viscLinear[c] = p.viscLinear, C.viscQuadratic[c] = p.viscQuadratic;
	}
	/// Rows of some of the owners.
	struct RowPart {
		std::vector<int32_t> owner, other, rowOwner, rowSize;
	};
	/// Contacts of these automata in one part per thread.
	std::vector<RowPart> findRows(const Store& S, const CellGrid& grid, const std::vector<int32_t>& who, double skin, int threads)
	{
		std::vector<RowPart> parts(threads);
		const long        n = long(who.size());
#pragma omp parallel for schedule(static, 1) num_threads(threads)
		for (int t = 0; t < threads; t++) {
			RowPart&             P = parts[t];
			std::vector<int32_t> row;
			for (long q = n * t / threads; q < n * (t + 1) / threads; q++) {
				const int32_t i  = who[q];
				row.clear();
				around(S, grid, i, skin, [&](int32_t j) {
					if (j != i && touching(S, i, j) && !linked(S, i, j)) row.push_back(j);
					return false;
				});
				if (row.empty()) continue;
				std::sort(row.begin(), row.end(), [&](int32_t a, int32_t b) { return S.id[a] < S.id[b]; });
				P.rowOwner.push_back(i);
				P.rowSize.push_back(int32_t(row.size()));
				P.owner.insert(P.owner.end(), row.size(), i);
				P.other.insert(P.other.end(), row.begin(), row.end());
			}
		}
		return parts;
	}
}

void searchContacts(Store& S, Contacts& C, double skin, int threads)
{
	std::vector<int32_t> who;
	for (size_t b = 0; b < S.blocks.size(); b++)
		for (int l = 0; l < S.blocks[b].count; l++)
			if (S.flags[b * blockSize + l] & exposedBit) who.push_back(int32_t(b * blockSize + l));
	for (auto& b : S.blocks)
		b.contact = false;
	Contacts old;
	std::swap(old, C);
	C.rowBegin.assign(1, 0);
	if (who.empty()) return;
	double dMax = 0;
	for (auto& sp : S.species)
		dMax = std::max(dMax, sp.d);
	const double cell = dMax * (1. + skin);
	addReached(S, who, cell, skin, threads);
	const CellGrid       grid(S, who, cell);
	std::vector<int32_t> oldRow;
	if (old.rows()) {
		oldRow.assign(S.size(), -1);
		for (size_t r = 0; r < old.rows(); r++)
			oldRow[old.rowOwner[r]] = int32_t(r);
	}
	const auto parts = findRows(S, grid, who, skin, threads);
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
#pragma omp parallel for schedule(static) num_threads(threads)
	for (long c = 0; c < long(m); c++) {
		const int32_t j = C.other[c];
		for (int32_t q = C.rowBegin[rowOf[j]]; q < C.rowBegin[rowOf[j] + 1]; q++)
			if (C.other[q] == C.owner[c]) C.reverse[c] = q;
		constants(S, table, C, c);
		carryOver(S, old, oldRow, C.owner[c], j, C.s[c], C.tau[c], C.rest[c]);
	}
	contactReciprocals(S, C);
}
}
