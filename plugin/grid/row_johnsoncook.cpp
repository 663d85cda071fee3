// SPDX-License-Identifier: GPL-2.0-or-later
#include "rowkernel.hpp"

namespace mca::grid {
RowKernel chooseJohnsonCook(const Block& block) { return chooseRowKernel<YieldKind::johnsonCook>(block); }
}
