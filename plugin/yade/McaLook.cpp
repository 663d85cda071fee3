// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaLook.hpp"
#include "McaRoles.hpp"
#include "McaSolverEngine.hpp"
#include <core/Omega.hpp>
#include <core/PartialEngine.hpp>
#include <pkg/common/PeriodicEngines.hpp>

namespace yade {

bool runEndsHere(const Scene& s)
{
	if (!Omega::instance().isRunning()) return true; // paused, or a step of O.step(), which is a run of its own
	if (s.stopAtIter > 0 && s.iter + 1 == s.stopAtIter) return true;
	// YADE stops at the first time at or after stopAtTime; O.dt may still change in this step
	return s.stopAtTime > 0 && s.time + 1.5 * s.dt >= s.stopAtTime && s.time - s.dt < s.stopAtTime;
}

namespace look {
	Habit habitOf(const Engine& e)
	{
		if (dynamic_cast<const McaSolverEngine*>(&e) || dynamic_cast<const McaDriver*>(&e) || dynamic_cast<const McaStepGiver*>(&e))
			return Habit::never;
		if (dynamic_cast<const PeriodicEngine*>(&e)) return Habit::whenDue;
		if (dynamic_cast<const PartialEngine*>(&e)) return Habit::givenIds;
		// NewtonIntegrator moves bodies of its mask; McaEngine refuses one that would move automata
		const string name = e.getClassName();
		return name == "ForceResetter" || name == "NewtonIntegrator" ? Habit::never : Habit::always;
	}

	// As PeriodicEngine::isActivated decides, without its side effects; too often rather than too seldom.
	bool due(const Scene& s, const Engine& e, bool later)
	{
		const auto& p    = static_cast<const PeriodicEngine&>(e);
		const long  iter = s.iter + !later;
		const Real  time = s.time + (later ? 0. : 1.5 * s.dt);
		if (iter < p.iterLast || p.nDone == 0 || (p.firstIterRun > 0 && iter == p.firstIterRun)) return true; // first run, or O.resetTime
		if (p.nDo >= 0 && p.nDone >= p.nDo) return false;
		if (p.virtPeriod > 0 && time - p.virtLast >= p.virtPeriod * (1. - 1e-12)) return true;
		if (p.iterPeriod > 0 && iter - p.iterLast >= p.iterPeriod) return true;
		return p.realPeriod > 0 && PeriodicEngine::getClock() - p.realLast >= p.realPeriod - 0.02; // it looks at the clock a little later
	}

	const vector<int>& idsOf(const Engine& e) { return static_cast<const PartialEngine&>(e).ids; }
}
} // namespace yade
