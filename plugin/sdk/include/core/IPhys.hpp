// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {
class IPhys : public Serializable, public Indexable { // 0x20 bytes
public:
	IPhys() = default;
	virtual ~IPhys();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX_ROOT
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(IPhys)
