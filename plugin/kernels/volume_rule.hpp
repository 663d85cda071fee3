// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace mca {
/// affine (default): J = det F from the links; inversePower: mean of (d/r)^dim; meanDistance: mean linear strain, as published.
enum class VolumeRule { affine, inversePower, meanDistance };
}
