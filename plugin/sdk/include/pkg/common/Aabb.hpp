// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Bound.hpp>

namespace yade {
class Aabb : public Bound { // 0x90 bytes
public:
	Aabb();
	virtual ~Aabb();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(Aabb)
