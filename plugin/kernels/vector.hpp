// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors and tensors of the space in which the automata move.
#pragma once
#include "dimension.hpp"
#if MCA_DIM == 2
#include "plane/vector.hpp"
#else
#include "space/vector.hpp"
#endif
