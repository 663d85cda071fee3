// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>
#include <mutex>

namespace yade {
class State : public Serializable, public Indexable { // 0x140 bytes
public:
	Vector3r&    pos;            // 0x20, refers to se3
	Quaternionr& ori;            // 0x28, refers to se3
	std::mutex   updateMutex;    // 0x30
	Se3r         se3;            // 0x58, m
	Vector3r     vel;            // 0x90, m/s
	Real         mass;           // 0xa8, kg
	Vector3r     angVel;         // 0xb0, rad/s
	Vector3r     angMom;         // 0xc8, kg m^2/s
	Vector3r     inertia;        // 0xe0, kg m^2
	Vector3r     refPos;         // 0xf8, m
	Quaternionr  refOri;         // 0x110
	unsigned     blockedDOFs;    // 0x130
	bool         isDamped;       // 0x134
	Real         densityScaling; // 0x138
	enum { DOF_NONE = 0, DOF_X = 1, DOF_Y = 2, DOF_Z = 4, DOF_RX = 8, DOF_RY = 16, DOF_RZ = 32, DOF_ALL = 63 };
	State();
	virtual ~State();
	YADE_SDK_STOCK_CLASS
	YADE_SDK_STOCK_INDEX_ROOT
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(State)
