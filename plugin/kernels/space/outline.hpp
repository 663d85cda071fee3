// SPDX-License-Identifier: GPL-2.0-or-later
// Outlines through centres are of the plane only: in space bodies end at whole automata. What loops over links ask of an outline, for all dimensions alike.
#pragma once
#include "../automaton/links.hpp"

namespace mca {
inline namespace MCA_SPACE {

using Triangles = uint32_t;
constexpr Flags  outlineBits = 0; ///< of the flags
inline Triangles trianglesIn(Flags) { return 0; }
inline Flags     withoutTriangles(Flags flags) { return flags; }
constexpr int    trianglesBeside(Triangles, int) { return 0; }
/// Adds what link k measures of F.
inline void addMeasured(Tensor<double>& sum, Flags, int k, Vec<double> r) { addDyad(sum, Lattice::direction(k), r); }
}
}
