// SPDX-License-Identifier: GPL-2.0-or-later
// A uniform grid of cells over points: who is in a cell, and in those around it.
#pragma once
#include "vectors.hpp"
#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace mca::automata {

/// The cells alone: which one a place is in.
struct Cells {
	Vec<double> low {}, high {}; ///< corners of the box that holds all [m]
	double      inv = 0;         ///< cells per length [1/m]
	Vec<int>    count {};

	Cells() = default;
	/// Cells of at least `size` [m] around these points; a single one where there are none.
	Cells(const Vectors& points, double size)
	{
		if (points.empty() || !(size > 0)) {
			inv = 1.;
			for (int c = 0; c < dim; c++) count[c] = 1;
			return;
		}
		for (int c = 0; c < dim; c++) {
			low[c] = 1e300, high[c] = -1e300;
			for (double x : points[c])
				low[c] = std::min(low[c], x), high[c] = std::max(high[c], x);
		}
		// debris far away must not make the grid larger than the list that it serves
		const double most  = 8. * double(points.size()) + 1024.;
		const auto   cells = [&] {
                        double all = 1;
                        for (int c = 0; c < dim; c++)
                                all *= (high[c] - low[c]) / size + 1;
                        return all;
		};
		while (cells() > most)
			size *= 1.25;
		inv = 1. / size;
		for (int c = 0; c < dim; c++)
			count[c] = int((high[c] - low[c]) * inv) + 1;
	}
	size_t cells() const
	{
		size_t all = 1;
		for (int c = 0; c < dim; c++)
			all *= size_t(count[c]);
		return all;
	}
	/// The cell of a place, moved by so many cells, within the grid.
	Vec<int> cell(Vec<double> x, int by) const
	{
		Vec<int> at;
		for (int c = 0; c < dim; c++)
			at[c] = std::max(0, std::min(std::max(0, std::min(int((x[c] - low[c]) * inv), count[c] - 1)) + by, count[c] - 1));
		return at;
	}
	size_t cellOf(Vec<double> x) const { return cellNumber(cell(x, 0), count); }
	/// Whether two places are in one cell or in two next to each other.
	bool adjacent(Vec<double> x, Vec<double> y) const
	{
		const Vec<int> a = cell(x, 0), b = cell(y, 0);
		for (int c = 0; c < dim; c++)
			if (std::abs(a[c] - b[c]) > 1) return false;
		return true;
	}
	/// Whether a place is so far outside that the cells around it hold nothing.
	bool away(Vec<double> x) const
	{
		for (int c = 0; c < dim; c++)
			if (x[c] < low[c] - 1. / inv || x[c] > low[c] + (count[c] + 1) / inv) return true;
		return false;
	}
	/// f(first, last): runs of cells with consecutive numbers that cover the cell of a place and those around it, until f returns true.
	template <class F> void eachRunAround(Vec<double> x, F&& f) const
	{
		eachRun(cell(x, -1), cell(x, 1), [&](Vec<int> first, Vec<int> last) { return f(cellNumber(first, count), cellNumber(last, count)); });
	}
};

struct CellGrid : Cells {
	std::vector<int32_t> begin, item; ///< a list per cell by counting sort
	Vectors              position;    ///< in the order of `item`: the cells around a point are a few runs of it

	/// Cells of at least `size` [m]; names: what `item` calls the points, in the order of the points.
	CellGrid(const Vectors& points, const std::vector<int32_t>& names, double size)
	        : CellGrid(Cells(points, size), points, names)
	{
	}
	CellGrid(const Cells& cells, const Vectors& points, const std::vector<int32_t>& names)
	        : Cells(cells)
	{
		const size_t n = points.size();
		begin.assign(Cells::cells() + 1, 0);
		std::vector<int32_t> at(n);
		for (size_t q = 0; q < n; q++)
			at[q] = int32_t(cellOf(points.at(q))), begin[at[q] + 1]++;
		for (size_t c = 1; c < begin.size(); c++)
			begin[c] += begin[c - 1];
		position.resize(n), item.resize(n);
		std::vector<int32_t> next(begin.begin(), begin.end() - 1);
		for (size_t q = 0; q < n; q++) {
			const int32_t p = next[at[q]]++;
			item[p]         = names[q], position.set(p, points.at(q));
		}
	}
};
}
