// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaInfo.hpp"
#include "isa.hpp"
#include "roof.hpp"
#include "threads.hpp"

namespace yade {
YADE_PLUGIN((McaInfo));

string McaInfo::isa() const { return mca::isa(); }
string McaInfo::version() const { return MCA_VERSION; }
int    McaInfo::threads() const { return mca::threads(); }
static int checked(const char* call, int n)
{
	if (n < 1 || n > 1024) throw std::runtime_error(string("McaInfo.") + call + ": threads = " + std::to_string(n) + " must be from 1 to 1024.");
	return n;
}
Real McaInfo::triad(int n) const { return mca::measureTriad(checked("triad", n)); }
Real McaInfo::flops(int n) const { return mca::measureFlops(checked("flops", n)); }
} // namespace yade
