// SPDX-License-Identifier: GPL-2.0-or-later
// What others must know of a stock NewtonIntegrator.
#pragma once
#include <core/Engine.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	struct NewtonFacts {
		Real damping; // [-]
		int  mask;    // bodies without a common bit are left out; 0 or less: none is
	};
	/// Of an engine whose class name is NewtonIntegrator. The class is not declared, since it differs between versions of YADE; where the two lie is found
	/// in the first call, by setting them through Python in an object made for that. Takes Python's lock then, never again.
	NewtonFacts newtonFacts(const Engine& newton);
} // namespace sdk
} // namespace yade
