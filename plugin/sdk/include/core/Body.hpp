// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Bound.hpp>
#include <core/Interaction.hpp>
#include <core/Material.hpp>
#include <core/Shape.hpp>
#include <core/State.hpp>

namespace yade {
class Body : public Serializable { // 0xb0 bytes
public:
	using id_t        = int;
	using mask_t      = int;
	using MapId2IntrT = std::map<id_t, shared_ptr<Interaction>>;
	enum { FLAG_BOUNDED = 1, FLAG_ASPHERICAL = 2, FLAG_SUBDOMAIN = 4, FLAG_FLUIDDOMAINBBOX = 8 };
	static constexpr id_t ID_NONE = -1;

	id_t                 id;        // 0x18
	mask_t               groupMask; // 0x1c
	int                  flags;     // 0x20
	int                  subdomain; // 0x24, build with MPI
	shared_ptr<Material> material;  // 0x28
	shared_ptr<State>    state;     // 0x38
	shared_ptr<Shape>    shape;     // 0x48
	shared_ptr<Bound>    bound;     // 0x58
	MapId2IntrT          intrs;     // 0x68
	id_t                 clumpId;   // 0x98
	long                 iterBorn;  // 0xa0
	Real                 timeBorn;  // 0xa8
	Body();
	virtual ~Body();
	YADE_SDK_STOCK_CLASS
	virtual void                   userForcedDisplacementRedrawHook(); // slot 12
	static const shared_ptr<Body>& byId(id_t, Scene* = nullptr);
	id_t                           getId() const { return id; }
	bool                           isStandalone() const { return clumpId == ID_NONE; }
	bool                           isClump() const { return clumpId != ID_NONE && id == clumpId; }
	bool                           isClumpMember() const { return clumpId != ID_NONE && id != clumpId; }
	bool                           isDynamic() const { return state->blockedDOFs != State::DOF_ALL; }
	bool                           isBounded() const { return flags & FLAG_BOUNDED; }
	bool                           maskOk(int mask) const;
	bool                           maskCompatible(int mask) const;
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(Body)
