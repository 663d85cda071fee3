// SPDX-License-Identifier: GPL-2.0-or-later
// Linear law P = -K eps: the shock adiabat with b = 0. Formulation, equation (2).
#pragma once
#include "../law.hpp"

#define MCA_CONSTANTS_linear(C)
#define MCA_USES_linear(U)

namespace mca::eos {

struct Linear : EosLaw {
	template <class E> static MCA_INLINE double clampStrain(const E&) { return -1.; }
	template <class E> static MCA_INLINE double pressure(const E& e, double eps) { return -e.bulkModulus() * eps; }
	template <class E> static MCA_INLINE double tangent(const E& e, double) { return e.bulkModulus(); }
	template <class E> static double            storedEnergy(const E& e, double eps) { return 0.5 * e.bulkModulus() * eps * eps; }
};
}
