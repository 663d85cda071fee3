// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Dispatching.hpp>
#include <core/GlobalEngine.hpp>

namespace yade {
class InteractionLoop : public GlobalEngine { // only the static member is used
public:
	InteractionLoop() = delete;
	static shared_ptr<Interaction> createExplicitInteraction(Body::id_t, Body::id_t, bool force, bool virtualI);
};
} // namespace yade
