// SPDX-License-Identifier: GPL-2.0-or-later
// Time histories of points that move with the material, and momentary values along a line.
#pragma once
#include "block.hpp"

namespace mca::grid {

/// Staggering: position and pressure at t, velocity at t - dt/2, deviatoric stress and plastic strain at t - dt.
struct Sample {
	double time;       ///< t [s]
	double x, y;       ///< [m]
	double vx, vy;     ///< [m/s]
	double pressure;   ///< [Pa]
	double sxx, syy, sxy; ///< deviatoric stress [Pa]
	double eqps;       ///< [-]
};

/// Where a point sits: cell and bilinear coordinates in [0,1].
struct Location {
	int    block = -1, i = 0, j = 0;
	double u = 0, v = 0;
};

struct Gauge {
	Location            at;
	int                 period = 1;
	std::vector<Sample> history;
};

/// Finds a point in one block at present positions; false when it lies outside.
bool     locate(const Block& b, double x, double y, Location& at);
Sample   sample(const Block& b, const Location& at, double time);
}
