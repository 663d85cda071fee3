// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {
class BoundFunctor;
class InternalForceFunctor;
class Shape : public Serializable, public Indexable { // 0x60 bytes
public:
	shared_ptr<BoundFunctor>         boundFunctor;         // 0x20
	shared_ptr<InternalForceFunctor> internalforcefunctor; // 0x30
	Vector3r                         color = Vector3r(1, 1, 1); // 0x40
	bool                             wire      = false;         // 0x58
	bool                             highlight = false;         // 0x59
	Shape()                                    = default;
	virtual ~Shape();
	YADE_SDK_STOCK_CLASS
#if MCA_YADE_NUMBER >= 20260100
	virtual Real getVolume(); // 12
#endif
	YADE_SDK_STOCK_INDEX_ROOT
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(Shape)
