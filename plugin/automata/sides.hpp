// SPDX-License-Identifier: GPL-2.0-or-later
// The stresses of links and contacts in memory, and the records of motion that neighbours read.
#pragma once
#include "../kernels/automaton/links.hpp"
#include "vectors.hpp"

namespace mca::automata {
constexpr int blockSize = 64;
/// place of link k of automaton i in the link arrays
inline size_t linkSlot(size_t i, int k) { return ((i / blockSize) * nLinks + k) * blockSize + i % blockSize; }
}
#if MCA_DIM == 2
#include "plane/sides.hpp"
#else
#include "space/sides.hpp"
#endif
