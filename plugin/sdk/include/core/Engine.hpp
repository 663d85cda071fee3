// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Omega.hpp>
#include <core/Timing.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {
class Scene;
class Engine : public Serializable { // 0x68 bytes
public:
	Scene*                   scene;        // 0x18
	TimingInfo               timingInfo;   // 0x20
	shared_ptr<TimingDeltas> timingDeltas; // 0x30
	bool                     dead;         // 0x40
	int                      ompThreads;   // 0x44
	string                   label;        // 0x48
	Engine();
	virtual ~Engine();
	YADE_SDK_STOCK_CLASS
	virtual bool isActivated(); // slot 12
	virtual void action();      // 13
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(Engine)
