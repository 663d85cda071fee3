// SPDX-License-Identifier: GPL-2.0-or-later
// Mie-Grueneisen: P = P_H (1 + Gamma0 eps/2) + Gamma0 E about the shock adiabat P_H, with rho Gamma = rho0 Gamma0 and E the internal energy per rest volume.
// In tension the thermal term alone is added to the linear law. Formulation, equation (4a).
#pragma once
#include "shockAdiabat.hpp"

#define MCA_CONSTANTS_mieGruneisen(C) \
	C(gruneisen, "-", 0, laws::notNegative, "Grueneisen parameter at rest, for equations of state that depend on the internal energy")
#define MCA_USES_mieGruneisen(U) MCA_USES_shockAdiabat(U) U(gruneisen, laws::notNegative)

namespace mca::eos {

struct MieGruneisen : ShockAdiabat {
	static constexpr bool heats = true;
	template <class E> static MCA_INLINE Thermal thermal(const E& e, double eps, double /* energy */)
	{
		return { pressure(e, eps) * (1. + 0.5 * e.gruneisen * min(eps, 0.)), e.gruneisen };
	}
};
}
