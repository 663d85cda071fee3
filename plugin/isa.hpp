// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "kernels/api.hpp"

namespace mca {
/// Instruction level this build of the solver library was compiled for: "x86-64", "x86-64-v3", "x86-64-v4".
MCA_API const char* isa();
} // namespace mca
