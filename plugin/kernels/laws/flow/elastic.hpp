// SPDX-License-Identifier: GPL-2.0-or-later
// No flow at all.
#pragma once
#include "../law.hpp"

#define MCA_CONSTANTS_elastic(C)
#define MCA_USES_elastic(U)

namespace mca::flow {

struct Elastic : FlowLaw {
	static constexpr bool yields = false;
	template <class Y> static MCA_INLINE StaticYield staticYield(const Y&, double, double) { return { std::numeric_limits<double>::infinity(), 0. }; }
};
}
