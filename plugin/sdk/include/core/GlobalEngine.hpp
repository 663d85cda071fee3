// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Engine.hpp>

namespace yade {
class GlobalEngine : public Engine { // 0x68 bytes
public:
	GlobalEngine() = default;
	virtual ~GlobalEngine();
	YADE_SDK_STOCK_CLASS
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(GlobalEngine)
