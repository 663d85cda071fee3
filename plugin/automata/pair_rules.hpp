// SPDX-License-Identifier: GPL-2.0-or-later
// What is given for pairs of materials.
#pragma once
#include "../kernels/material.hpp"
#include <algorithm>
#include <vector>

namespace mca {

struct PairRules {
	std::vector<PairRule> list;
	bool                  operator==(const PairRules& other) const { return list == other.list; }
	/// Of this pair of materials; one that changes nothing where none is given.
	const PairRule& of(int a, int b) const
	{
		static const PairRule none;
		for (const PairRule& r : list)
			if (r.names(a, b)) return r;
		return none;
	}
	/// Whether some pair of this material has a normal stress of its own, and the least factor on the criteria of its links.
	struct Weakest {
		bool   tension  = false;
		double strength = 1;
	};
	Weakest weakest(int material) const
	{
		Weakest w;
		for (const PairRule& r : list)
			if (r.first == material || r.second == material) w.tension |= std::isfinite(r.tension), w.strength = std::min(w.strength, r.strength);
		return w;
	}
};
}
