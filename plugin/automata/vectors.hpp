// SPDX-License-Identifier: GPL-2.0-or-later
// A vector for each automaton or contact: a flat array per component, since loops run over one component at a time.
#pragma once
#include "../kernels/vector.hpp"
#include <type_traits>
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
	void clear()
	{
		for (auto& v : plane)
			v.clear();
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

// What turns is a number for each automaton in the plane, a vector in space: the same names for both.
using Turns = std::conditional_t<turns == 1, std::vector<double>, Vectors>;
inline double                     turnAt(const std::vector<double>& v, size_t i) { return v[i]; }
inline Vec<double>                turnAt(const Vectors& v, size_t i) { return v.at(i); }
inline void                       setTurn(std::vector<double>& v, size_t i, double a) { v[i] = a; }
inline void                       setTurn(Vectors& v, size_t i, Vec<double> a) { v.set(i, a); }
inline void                       addTurn(std::vector<double>& v, size_t i, double a) { v[i] += a; }
inline void                       addTurn(Vectors& v, size_t i, Vec<double> a) { v.add(i, a); }
inline std::vector<double>&       turnPlane(std::vector<double>& v, int) { return v; }
inline const std::vector<double>& turnPlane(const std::vector<double>& v, int) { return v; }
inline std::vector<double>&       turnPlane(Vectors& v, int c) { return v[c]; }
inline const std::vector<double>& turnPlane(const Vectors& v, int c) { return v[c]; }
template <class T> T&             turnComponent(T& a, int) { return a; }
template <class T> T&             turnComponent(Vec<T>& a, int c) { return a[c]; }
template <class T> const T&       turnComponent(const Vec<T>& a, int c) { return a[c]; }
/// The turns of all as bare pointers.
struct Rotations {
	const double* plane[turns];
	explicit Rotations(const Turns& v)
	{
		for (int c = 0; c < turns; c++) plane[c] = turnPlane(v, c).data();
	}
	MCA_INLINE Turn<double> at(size_t i) const
	{
		Turn<double> a;
		for (int c = 0; c < turns; c++) turnComponent(a, c) = plane[c][i];
		return a;
	}
};
/// Whether any component is on.
inline bool any(bool a) { return a; }
inline bool any(Vec<bool> a)
{
	bool some = false;
	for (bool b : a.component) some |= b;
	return some;
}

/// f(array) for each array of these quantities.
template <class F, class T> void eachPlane(F&& f, std::vector<T>& v) { f(v); }
template <class F> void          eachPlane(F&& f, Vectors& v)
{
	for (auto& plane : v)
		f(plane);
}
template <class F, class... V> void eachPlane(F&& f, V&... v) { (eachPlane(f, v), ...); }
} // namespace mca::automata
