// SPDX-License-Identifier: GPL-2.0-or-later
// Yield stress linear in the plastic strain.
#pragma once
#include "perfect.hpp"

#define MCA_CONSTANTS_linearHardening(C) C(hardeningModulus, "Pa", 0, laws::notNegative, "dY/d(plastic strain) of linearHardening; B of Johnson-Cook")
#define MCA_USES_linearHardening(U) MCA_USES_perfect(U) U(hardeningModulus, laws::notNegative)

namespace mca::flow {

struct LinearHardening : FlowLaw {
	template <class Y> static MCA_INLINE StaticYield staticYield(const Y& y, double eqps, double)
	{
		return { fma(y.hardeningModulus, eqps, y.yieldStress), y.hardeningModulus };
	}
};
}
