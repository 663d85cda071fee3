// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Material.hpp>

namespace yade {
class ElastMat : public Material { // 0x60 bytes
public:
	Real young   = 1e9; // 0x50, Pa
	Real poisson = .25; // 0x58
	ElastMat() { createIndex(); }
	virtual ~ElastMat();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX
};
class FrictMat : public ElastMat { // 0x68 bytes
public:
	Real frictionAngle; // 0x60, rad
	FrictMat();
	virtual ~FrictMat();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(ElastMat)
YADE_SDK_STOCK_ARCHIVE(FrictMat)
