// SPDX-License-Identifier: GPL-2.0-or-later
// A stress as callers give it, the same in the plane and in space.
#pragma once
#include <cmath>

namespace mca {

/// Deviator of a stress [Pa]; in the plane without yz and zx.
struct Deviator {
	double xx = 0, yy = 0, zz = 0, yz = 0, zx = 0, xy = 0;
	/// Mises stress [Pa].
	double mises() const { return std::sqrt(1.5 * (xx * xx + yy * yy + zz * zz + 2. * (yz * yz + zx * zx + xy * xy))); }
};
/// A stress as its pressure and deviator.
struct SplitStress {
	double   pressure = 0;
	Deviator deviator;
	explicit SplitStress(const Deviator& s)
		: pressure(-(s.xx + s.yy + s.zz) / 3.)
		, deviator { s.xx + pressure, s.yy + pressure, s.zz + pressure, s.yz, s.zx, s.xy }
	{
	}
};
}
