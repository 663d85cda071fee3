// SPDX-License-Identifier: GPL-2.0-or-later
// The order of the automata in memory: strips, columns of one diameter inside a strip. Neighbours in the same strip stay within two columns, in the
// nearest cache; the taller the strips, the fewer links lead to another one, the less compact the blocks that sleep and wake.
#pragma once
#include "../kernels/vector.hpp"
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace mca::automata {

constexpr double stripHeight = 32; ///< [diameters]

struct SpaceKey {
	int32_t                      species;
	std::array<int64_t, dim - 1> strip;
	int64_t                      column;    ///< of the first component
	std::array<double, dim - 1>  across;    ///< the others
	int32_t                      id, place; ///< caller's number; entry of the arrays that are sorted
	SpaceKey(int32_t species_, Vec<double> at, double d, int32_t id_, int32_t place_)
		: species(species_)
		, column(int64_t(std::floor(at[0] / d)))
		, id(id_)
		, place(place_)
	{
		for (int c = 1; c < dim; c++)
			strip[c - 1] = int64_t(std::floor(at[c] / (stripHeight * d))), across[c - 1] = at[c];
	}
	bool operator<(const SpaceKey& o) const
	{
		return std::tie(species, strip, column, across, id) < std::tie(o.species, o.strip, o.column, o.across, o.id);
	}
};
}
