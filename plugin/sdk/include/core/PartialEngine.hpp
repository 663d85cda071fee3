// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Engine.hpp>

namespace yade {
class PartialEngine : public Engine { // 0x80 bytes
public:
	vector<int> ids; // 0x68
	PartialEngine() = default;
	virtual ~PartialEngine();
	YADE_SDK_STOCK_CLASS
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(PartialEngine)
