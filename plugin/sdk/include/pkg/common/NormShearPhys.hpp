// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/IPhys.hpp>

namespace yade {
class NormPhys : public IPhys { // 0x40 bytes
public:
	Real     kn;          // 0x20, N/m
	Vector3r normalForce; // 0x28, N
	NormPhys();
	virtual ~NormPhys();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX
};
class NormShearPhys : public NormPhys { // 0x60 bytes
public:
	Real     ks;         // 0x40, N/m
	Vector3r shearForce; // 0x48, N
	NormShearPhys();
	virtual ~NormShearPhys();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(NormPhys)
YADE_SDK_STOCK_ARCHIVE(NormShearPhys)
