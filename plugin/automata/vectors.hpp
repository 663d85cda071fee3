// SPDX-License-Identifier: GPL-2.0-or-later
// A vector for each automaton or contact: a flat array per component, since loops run over one component at a time.
#pragma once
#include "../kernels/vector.hpp"
#include <vector>

namespace mca::automata {

struct Vectors {
	std::vector<double>        plane[dim];
	std::vector<double>&       operator[](int c) { return plane[c]; }
	const std::vector<double>& operator[](int c) const { return plane[c]; }
	auto                       begin() { return plane; }
	auto                       begin() const { return plane; }
	auto                       end() { return plane + dim; }
	auto                       end() const { return plane + dim; }
	size_t                     size() const { return plane[0].size(); }
	bool                       empty() const { return plane[0].empty(); }
	void                       resize(size_t n)
	{
		for (auto& v : plane)
			v.resize(n, 0.);
	}
	void push_back(Vec<double> v)
	{
		for (int c = 0; c < dim; c++)
			plane[c].push_back(v[c]);
	}
	/// As bare pointers from entry `from` on; null where there are no entries.
	Planes<double> planes(size_t from = 0)
	{
		Planes<double> p;
		for (int c = 0; c < dim; c++)
			p.plane[c] = empty() ? nullptr : plane[c].data() + from;
		return p;
	}
	Planes<const double> planes(size_t from = 0) const
	{
		Planes<const double> p;
		for (int c = 0; c < dim; c++)
			p.plane[c] = empty() ? nullptr : plane[c].data() + from;
		return p;
	}
	Vec<double> at(size_t i) const
	{
		Vec<double> v;
		for (int c = 0; c < dim; c++)
			v[c] = plane[c][i];
		return v;
	}
	void set(size_t i, Vec<double> v)
	{
		for (int c = 0; c < dim; c++)
			plane[c][i] = v[c];
	}
	void add(size_t i, Vec<double> v)
	{
		for (int c = 0; c < dim; c++)
			plane[c][i] += v[c];
	}
};

/// f(array) for each array of these quantities.
template <class F, class T> void eachPlane(F&& f, std::vector<T>& v) { f(v); }
template <class F> void          eachPlane(F&& f, Vectors& v)
{
	for (auto& plane : v)
		f(plane);
}
template <class F, class... V> void eachPlane(F&& f, V&... v) { (eachPlane(f, v), ...); }
} // namespace mca::automata
