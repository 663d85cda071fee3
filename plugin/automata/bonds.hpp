// SPDX-License-Identifier: GPL-2.0-or-later
// Broken pairs that still hold together, in the order in which they broke. Few, short-lived, and known by the numbers of their automata: beside the passes.
#pragma once
#include "../kernels/automaton/cohesion.hpp"
#include "store.hpp"

namespace mca::automata {

struct Bonds {
#define MCA_NUMBER(name, type, presence, text) std::vector<type> name;
#define MCA_VECTOR(name, presence, text, ...) Vectors name;
	MCA_BOND_FIELDS(MCA_NUMBER, MCA_VECTOR)
#undef MCA_VECTOR
#undef MCA_NUMBER
	std::vector<Pull>   pull;     ///< of this step
	std::vector<double> spentNow; ///< in this step [J/m], in space [J]
	size_t              size() const { return first.size(); }
	Bond                at(size_t q) const { return { rest[q], stiffness[q], from[q], until[q], most[q] }; }
	/// f(array) for every array with one entry per pair
	template <class F> void eachArray(F&& f)
	{
#define MCA_NUMBER(name, type, presence, text) f(name);
#define MCA_VECTOR(name, presence, text, ...) \
	for (auto& plane : name) f(plane);
		MCA_BOND_FIELDS(MCA_NUMBER, MCA_VECTOR)
#undef MCA_VECTOR
#undef MCA_NUMBER
	}
	void add(int32_t a, int32_t b, const Bond& bond, Side<double> opening)
	{
		first.push_back(a), second.push_back(b), pushSide(*this, opening);
		rest.push_back(bond.rest), stiffness.push_back(bond.stiffness);
		from.push_back(bond.first), until.push_back(bond.last), most.push_back(bond.most);
	}
	/// Keeps those for which f(q) holds, in their order.
	template <class F> void keep(F&& f)
	{
		std::vector<char> stays(size());
		size_t            n = 0;
		for (size_t q = 0; q < size(); q++) n += stays[q] = f(q);
		if (n == size()) return;
		eachArray([&](auto& v) {
			size_t to = 0;
			for (size_t q = 0; q < v.size(); q++)
				if (stays[q]) v[to++] = v[q];
			v.resize(n);
		});
	}
};
}
