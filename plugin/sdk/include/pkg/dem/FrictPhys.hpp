// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <pkg/common/NormShearPhys.hpp>

namespace yade {
class FrictPhys : public NormShearPhys { // 0x68 bytes
public:
	Real tangensOfFrictionAngle; // 0x60
#if MCA_YADE_NUMBER >= 20260100
	Real frictDissip; // 0x68
#endif
	FrictPhys();
	virtual ~FrictPhys();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(FrictPhys)
