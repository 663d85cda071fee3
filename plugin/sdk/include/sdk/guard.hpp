// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	// Compares these declarations with the YADE in the process; returns the number of checks made, throws std::runtime_error naming each that failed.
	int guard();
} // namespace sdk
} // namespace yade
