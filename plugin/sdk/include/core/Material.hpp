// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/State.hpp>

namespace yade {
class Scene;
class Material : public Serializable, public Indexable { // 0x50 bytes
public:
	int    id      = -1;   // 0x20
	string label;          // 0x28
	Real   density = 1000; // 0x48, kg/m^3
	Material()     = default;
	virtual ~Material();
	YADE_SDK_STOCK_CLASS
	virtual shared_ptr<State> newAssocState() const;     // slot 12
	virtual bool              stateTypeOk(State*) const; // 13
	YADE_SDK_STOCK_INDEX_ROOT
	static const shared_ptr<Material> byId(int id, Scene* = nullptr);
	static const shared_ptr<Material> byLabel(const std::string& label, Scene* = nullptr);
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(Material)
