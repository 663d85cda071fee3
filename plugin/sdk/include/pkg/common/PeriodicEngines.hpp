// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/GlobalEngine.hpp>
#include <core/Scene.hpp>
#include <sys/time.h>

namespace yade {
// runs when a period of virtual time, real time or steps has passed
class PeriodicEngine : public GlobalEngine { // 0xb8 bytes
public:
	Real virtPeriod   = 0;          // 0x68, s
	Real realPeriod   = 0;          // 0x70, s
	long iterPeriod   = 0;          // 0x78, steps
	long nDo          = -1;         // 0x80
	bool initRun      = false;      // 0x88
	long firstIterRun = 0;          // 0x90
	Real virtLast     = 0;          // 0x98, s
	Real realLast     = getClock(); // 0xa0, s
	long iterLast     = 0;          // 0xa8
	long nDone        = 0;          // 0xb0
	PeriodicEngine()  = default;
	virtual ~PeriodicEngine();
	YADE_SDK_STOCK_CLASS
	bool        isActivated() override;
	static Real getClock() // s since the epoch
	{
		timeval now;
		gettimeofday(&now, nullptr);
		return now.tv_sec + 1e-6 * now.tv_usec;
	}
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(PeriodicEngine)
