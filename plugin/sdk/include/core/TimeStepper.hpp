// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/GlobalEngine.hpp>

namespace yade {
// action() calls computeTimeStep(scene); runs every timeStepUpdateInterval steps while active
class TimeStepper : public GlobalEngine { // 0x70 bytes
public:
	bool         active                 = true; // 0x68
	unsigned int timeStepUpdateInterval = 1;    // 0x6c
	TimeStepper()                       = default;
	virtual ~TimeStepper();
	YADE_SDK_STOCK_CLASS
	bool         isActivated() override;
	void         action() override;
	virtual void computeTimeStep(Scene*); // slot 14
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(TimeStepper)
