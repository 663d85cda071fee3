// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {
class Bound : public Serializable, public Indexable { // 0x90 bytes
public:
	int      lastUpdateIter = 0;                       // 0x20
	Vector3r refPos         = Vector3r(NaN, NaN, NaN); // 0x28, m
	Real     sweepLength    = 0;                       // 0x40, m
	Vector3r color          = Vector3r(1, 1, 1);       // 0x48
	Vector3r min            = Vector3r(NaN, NaN, NaN); // 0x60, m
	Vector3r max            = Vector3r(NaN, NaN, NaN); // 0x78, m
	Bound()                 = default;
	virtual ~Bound();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX_ROOT
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(Bound)
