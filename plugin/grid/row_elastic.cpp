// SPDX-License-Identifier: GPL-2.0-or-later
#include "rowkernel.hpp"

namespace mca::grid {
RowKernel chooseElastic(const Block& block) { return chooseRowKernel<YieldKind::elastic>(block); }
}
