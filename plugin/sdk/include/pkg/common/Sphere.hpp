// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Shape.hpp>

namespace yade {
class Sphere : public Shape { // 0x68 bytes
public:
	Real radius; // 0x60, m
	Sphere();
	virtual ~Sphere();
	YADE_SDK_STOCK_CLASS
#if MCA_YADE_NUMBER >= 20260100
	Real getVolume() override;
#endif
	YADE_SDK_STOCK_INDEX
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(Sphere)
