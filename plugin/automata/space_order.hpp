// SPDX-License-Identifier: GPL-2.0-or-later
// The order of the automata in memory: strips, columns of one diameter inside a strip. Neighbours in the same strip stay within two columns, in the
// nearest cache; the taller the strips, the fewer links lead to another one, the less compact the blocks that sleep and wake.
#pragma once
#include <cmath>
#include <cstdint>
#include <tuple>

namespace mca::automata {

constexpr double stripHeight = 32; ///< [diameters]

struct SpaceKey {
	int32_t species;
	int64_t strip, column;
	double  y;
	int32_t id, place; ///< caller's number; entry of the arrays that are sorted
	SpaceKey(int32_t species_, double x, double y_, double d, int32_t id_, int32_t place_)
	        : species(species_), strip(int64_t(std::floor(y_ / (stripHeight * d)))), column(int64_t(std::floor(x / d))), y(y_), id(id_), place(place_)
	{
	}
	bool operator<(const SpaceKey& o) const { return std::tie(species, strip, column, y, id) < std::tie(o.species, o.strip, o.column, o.y, o.id); }
};
}
