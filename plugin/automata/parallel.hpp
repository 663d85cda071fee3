// SPDX-License-Identifier: GPL-2.0-or-later
// Loops over the blocks that are awake, and the clock over the phases of a step.
#pragma once
#include "../threads.hpp"
#include "solver.hpp"
#include <chrono>

namespace mca::automata {

/// Adds the time from its birth to its death to a counter; does nothing when timing is off.
class Timer {
	using Clock = std::chrono::steady_clock;
	double*           to;
	Clock::time_point start;

public:
	Timer(bool on, double& counter)
	        : to(on ? &counter : nullptr)
	{
		if (to) start = Clock::now();
	}
	~Timer()
	{
		if (to) *to += double(std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count());
	}
};

/// f(block) for each block that is awake, on all threads.
template <class F> void Solver::eachAwake(F&& f)
{
	inParts(long(awake.size()), 16, [&](long first, long last) { // few blocks are not worth waking a thread for
		for (long q = first; q < last; q++)
			f(size_t(awake[q]));
	});
}
}
