// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/GlobalEngine.hpp>

namespace yade {
class BoundaryController : public GlobalEngine { // 0x68 bytes
public:
	BoundaryController() = default;
	virtual ~BoundaryController();
	YADE_SDK_STOCK_CLASS
	void action() override;
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(BoundaryController)
