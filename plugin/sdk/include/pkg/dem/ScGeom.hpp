// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Body.hpp>

namespace yade {
class GenericSpheresContact : public IGeom { // 0x60 bytes
public:
	Vector3r normal;       // 0x20, from body 1 to body 2
	Vector3r contactPoint; // 0x38, m
	Real     refR1 = 0;    // 0x50, m
	Real     refR2 = 0;    // 0x58, m
	GenericSpheresContact() { createIndex(); }
	virtual ~GenericSpheresContact();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX
};
class ScGeom : public GenericSpheresContact { // 0xc0 bytes
public:
	Vector3r twist_axis;       // 0x60, rotation about the normal in this step
	Vector3r orthonormal_axis; // 0x78, rotation of the normal in this step
	Real&    radius1;          // 0x90, refers to refR1
	Real&    radius2;          // 0x98, refers to refR2
	Real     penetrationDepth; // 0xa0, m
	Vector3r shearInc;         // 0xa8, m, shear displacement in this step
	ScGeom();
	virtual ~ScGeom();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX
	void precompute(
	        const State&                   state1,
	        const State&                   state2,
	        const Scene*                   scene,
	        const shared_ptr<Interaction>& interaction,
	        const Vector3r&                currentNormal,
	        bool                           isNew,
	        const Vector3r&                shift2,
	        bool                           avoidGranularRatcheting);
	Vector3r& rotate(Vector3r& tangentVector) const;
	// velocity of body 2 against body 1 at the contact point, m/s
	Vector3r getIncidentVel(
	        const State* state1, const State* state2, Real dt, const Vector3r& shiftVel, const Vector3r& shift2, bool avoidGranularRatcheting) const;
	Vector3r getIncidentVel(const State* state1, const State* state2, Real dt, bool avoidGranularRatcheting) const;
	Vector3r getRelAngVel(const State* state1, const State* state2, Real dt) const;
};
class ScGeom6D : public ScGeom { // 0x140 bytes
public:
	Quaternionr initialOrientation1; // 0xc0
	Quaternionr initialOrientation2; // 0xe0
	Quaternionr twistCreep;          // 0x100
	Real        twist;               // 0x120, rad
	Vector3r    bending;             // 0x128, rad
	ScGeom6D();
	virtual ~ScGeom6D();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX
	void initRotations(const State& state1, const State& state2);
	void precomputeRotations(const State& state1, const State& state2, bool isNew, bool creep = false);
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(GenericSpheresContact)
YADE_SDK_STOCK_ARCHIVE(ScGeom)
YADE_SDK_STOCK_ARCHIVE(ScGeom6D)
