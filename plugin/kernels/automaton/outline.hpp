// SPDX-License-Identifier: GPL-2.0-or-later
// Where a body ends, and what follows for its weight, its links and its volume.
#pragma once
#include "../dimension.hpp"
#if MCA_DIM == 2
#include "../plane/outline.hpp"
#else
#include "../space/outline.hpp"
#endif
