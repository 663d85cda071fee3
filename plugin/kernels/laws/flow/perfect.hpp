// SPDX-License-Identifier: GPL-2.0-or-later
// Constant yield stress.
#pragma once
#include "../law.hpp"

#define MCA_CONSTANTS_perfect(C) \
	C(yieldStress, "Pa", std::numeric_limits<double>::infinity(), laws::zeroOrMore.with("infinite: elastic"), "initial yield stress; A of Johnson-Cook")
#define MCA_USES_perfect(U) U(yieldStress, laws::zeroOrMore.with("infinite: elastic"))

namespace mca::flow {

struct Perfect : FlowLaw {
	template <class Y> static MCA_INLINE StaticYield staticYield(const Y& y, double, double) { return { y.yieldStress, 0. }; }
};
}
