// SPDX-License-Identifier: GPL-2.0-or-later
// Times of engines (O.timingEnabled, yade.timing.stats()) and of phases inside an engine.
// Stock YADE is built without its TIMING_DELTAS_* macros, but the pointer Engine::timingDeltas is there and yade.timing reads it, so an engine
// that makes the object in its constructor and calls start() and checkpoint() gets its phases into the table.
#pragma once
#include <lib/base/Math.hpp>
#include <time.h>

namespace yade {
struct TimingInfo {
	using delta = unsigned long long; // ns
	long        nExec = 0;
	delta       nsec  = 0;
	static bool enabled; // O.timingEnabled
	static delta getNow(bool evenIfDisabled = false)
	{
		if (!enabled && !evenIfDisabled) return 0;
		timespec now;
		clock_gettime(CLOCK_MONOTONIC, &now);
		return delta(now.tv_sec) * 1000000000ULL + delta(now.tv_nsec);
	}
};
class TimingDeltas {
	TimingInfo::delta last = 0;
	size_t            next = 0; // number of the coming checkpoint in this step
public:
	vector<TimingInfo> data;
	vector<string>     labels;
	void               start()
	{
		if (!TimingInfo::enabled) return;
		next = 0;
		last = TimingInfo::getNow();
	}
	// ends the phase `label`; the order of the phases is the same in every step
	void checkpoint(const string& label)
	{
		if (!TimingInfo::enabled) return;
		if (next >= data.size()) {
			data.resize(next + 1);
			labels.resize(next + 1);
			labels[next] = label;
		}
		const TimingInfo::delta now = TimingInfo::getNow();
		data[next].nExec++;
		data[next].nsec += now - last;
		last = now;
		next++;
	}
	void reset()
	{
		data.clear();
		labels.clear();
	}
};
} // namespace yade
