// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaGridCoupler.hpp"
#include <core/Scene.hpp>

namespace yade {
YADE_PLUGIN((McaSolverEngine));

void McaSolverEngine::findCoupler(Scene* scene)
{
	coupled = false;
	for (const auto& e : scene->engines) {
		auto* c = dynamic_cast<McaGridCoupler*>(e.get());
		if (!c || c->dead || !c->drives(this, scene)) continue;
		coupled = true;
		c->prepare(scene);
	}
}
} // namespace yade
