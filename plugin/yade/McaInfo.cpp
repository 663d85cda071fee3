// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaInfo.hpp"
#include "isa.hpp"
#include "roof.hpp"

namespace yade {
YADE_PLUGIN((McaInfo));

string McaInfo::isa() const { return mca::isa(); }
string McaInfo::version() const { return MCA_VERSION; }
int    McaInfo::threads() const { return mca::threads(); }
Real   McaInfo::triad(int n) const { return mca::measureTriad(n < 1 ? 1 : n); }
Real   McaInfo::flops(int n) const { return mca::measureFlops(n < 1 ? 1 : n); }
} // namespace yade
