// SPDX-License-Identifier: GPL-2.0-or-later
// The packing of the automata: how many neighbours an automaton has, where they stand, and the numbers that follow from it.
#pragma once
#include "dimension.hpp"
#if MCA_DIM == 2
#include "plane/lattice.hpp"
#else
#include "space/lattice.hpp"
#endif
