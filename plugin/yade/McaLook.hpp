// SPDX-License-Identifier: GPL-2.0-or-later
// Who looks at the bodies, and when: engines that keep automata on flat arrays write to the bodies only then.
#pragma once
#include <core/Scene.hpp>

namespace yade {

/// Whether the loop may end with this step, as far as that is known within it.
bool runEndsHere(const Scene& scene);

/// Whether another engine may read or change a body that isMine(id) before `self` runs again. Periodic engines (PyRunner, recorders) do when they
/// are due; engines of other kinds, in every step, unless they are known to keep away. `self` has just made its part of the step.
template <class IsMine> bool anotherLooks(const Scene& scene, const Engine* self, IsMine&& isMine);

namespace look {
	enum class Habit { never, whenDue, givenIds, always };
	Habit habitOf(const Engine& e);
	/// later: after `self` in the same step; otherwise in the next one.
	bool               due(const Scene& scene, const Engine& e, bool later);
	const vector<int>& idsOf(const Engine& e);
}

template <class IsMine> bool anotherLooks(const Scene& scene, const Engine* self, IsMine&& isMine)
{
	bool later = false;
	for (const auto& e : scene.engines) {
		if (e.get() == self) later = true;
		if (e.get() == self || e->dead) continue;
		switch (look::habitOf(*e)) {
			case look::Habit::never: break;
			case look::Habit::whenDue:
				if (look::due(scene, *e, later)) return true;
				break;
			case look::Habit::givenIds:
				for (int id : look::idsOf(*e))
					if (isMine(id)) return true;
				break;
			case look::Habit::always: return true;
		}
	}
	return false;
}
} // namespace yade
