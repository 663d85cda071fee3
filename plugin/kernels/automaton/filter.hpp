// SPDX-License-Identifier: GPL-2.0-or-later
// Smoothing of the shortest waves of volume in flowing material (5e), affine rule. J is a mean over the links, so two interleaved sub-lattices can
// drift apart in volume without any force between them: only the shear stiffness of the pairs holds them together, and where the material flows
// that is gone. Linked neighbours exchange volume by the fourth difference of J: stripes fade, smooth fields stay, the sum of J is kept.
#pragma once
#include "outline.hpp"

namespace mca {
inline namespace MCA_SPACE {

constexpr int filterPeriod = 8; ///< steps between two exchanges

/// Exchange per fourth difference [-]: one over the largest eigenvalue takes a stripe of alternate rows away at once. rate [-] times c0/d is how fast
/// stripes fade; time since the last exchange [s].
inline double volumeExchange(double rate, double c0, double time, double d) { return min(rate * c0 * time / d, 1.) * (1. / Lattice::stripes); }
/// Who exchanges: flows, has a whole star of links, and a volume measured by them (factor > 0).
inline bool exchangesVolume(double eqps, Flags flags, double factor) { return eqps > 0. && isWholeStar(flags) && factor > 0.; }
}
}
