// SPDX-License-Identifier: GPL-2.0-or-later
#include "contacts.hpp"
#include <algorithm>
#include <cmath>
#include <omp.h>

namespace mca::automata {
namespace {
	/// Uniform grid of cells over the exposed automata; a list per cell by counting sort.
	struct CellGrid {
		double               x0 = 0, y0 = 0, inv = 0;
		int                  nx = 1, ny = 1;
		std::vector<int32_t> begin, item;
		std::vector<double>  px, py; ///< positions in the order of `item`: the cells around an automaton are three runs of it
		CellGrid(const Store& S, const std::vector<int32_t>& who, double size)
		{
			double x1 = -1e300, y1 = -1e300;
			x0 = y0 = 1e300;
			for (int32_t i : who)
				x0 = std::min(x0, S.x[i]), y0 = std::min(y0, S.y[i]), x1 = std::max(x1, S.x[i]), y1 = std::max(y1, S.y[i]);
			// debris far away must not make the grid larger than the list that it serves
			const double most = 8. * double(who.size()) + 1024.;
			while (((x1 - x0) / size + 1) * ((y1 - y0) / size + 1) > most)
				size *= 1.25;
			inv = 1. / size;
			nx = int((x1 - x0) * inv) + 1, ny = int((y1 - y0) * inv) + 1;
			begin.assign(size_t(nx) * ny + 1, 0);
			for (int32_t i : who)
				begin[cellOf(S, i) + 1]++;
			for (size_t c = 1; c < begin.size(); c++)
				begin[c] += begin[c - 1];
			for (auto v : { &px, &py })
				v->resize(who.size());
			item.resize(who.size());
			std::vector<int32_t> at(begin.begin(), begin.end() - 1);
			for (int32_t i : who) {
				const int32_t p = at[cellOf(S, i)]++;
				item[p] = i, px[p] = S.x[i], py[p] = S.y[i];
			}
		}
		int    column(double x) const { return std::max(0, std::min(int((x - x0) * inv), nx - 1)); }
		int    row(double y) const { return std::max(0, std::min(int((y - y0) * inv), ny - 1)); }
		size_t cellOf(const Store& S, int32_t i) const { return size_t(row(S.y[i])) * nx + column(S.x[i]); }
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
		const double x = S.x[i], y0 = S.y[i], far2 = 1. / sqr(grid.inv);
		const int    cx = grid.column(x), cy = grid.row(y0);
		for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, grid.ny - 1); y++) {
			const size_t first = size_t(y) * grid.nx + std::max(cx - 1, 0), last = size_t(y) * grid.nx + std::min(cx + 1, grid.nx - 1);
			for (int32_t p = grid.begin[first]; p < grid.begin[last + 1]; p++) {
				const double r2 = sqr(grid.px[p] - x) + sqr(grid.py[p] - y0);
				if (r2 < far2 && r2 < reach2(S, i, grid.item[p], skin) && f(grid.item[p])) return;
			}
		}
	}
	/// Adds to `who` the interior automata that something foreign is about to reach, in the order of the arrays.
	void addReached(const Store& S, std::vector<int32_t>& who, double size, double skin, int threads)
	{
		const CellGrid                    grid(S, who, size);
		std::vector<std::vector<int32_t>> parts(threads);
		const long                        nb = long(S.blocks.size());
		const double                      x1 = grid.x0 + (grid.nx + 1) / grid.inv, y1 = grid.y0 + (grid.ny + 1) / grid.inv, margin = 1. / grid.inv;
#pragma omp parallel for schedule(static, 1) num_threads(threads)
		for (int t = 0; t < threads; t++)
			for (long b = nb * t / threads; b < nb * (t + 1) / threads; b++)
				for (int l = 0; l < S.blocks[b].count; l++) {
					const int32_t i = int32_t(b * blockSize + l);
					if (exposed(S, i) || S.x[i] < grid.x0 - margin || S.y[i] < grid.y0 - margin || S.x[i] > x1 || S.y[i] > y1) continue;
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
