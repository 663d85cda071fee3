// SPDX-License-Identifier: GPL-2.0-or-later
// What this machine can do at best, measured now: the yardstick of every cost figure, since machines and their load drift.
#pragma once
#include "kernels/api.hpp"

namespace mca {
/// Memory bandwidth of a = b + s c on arrays far larger than any cache [B/s], three streams counted (McCalpin's STREAM, 1995); best of several passes.
MCA_API double measureTriad(int threads);
/// Fused multiply-adds on registers [flop/s], two per operation where the processor has them; best of several passes.
MCA_API double measureFlops(int threads);
} // namespace mca
