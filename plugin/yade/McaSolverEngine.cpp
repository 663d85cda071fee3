// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaSolverEngine.hpp"
#include "McaRoles.hpp"
#include <chrono>
#include <core/Omega.hpp>

namespace yade {
YADE_PLUGIN((McaSolverEngine));

void McaSolverEngine::action()
{
	lastStep.store(std::this_thread::get_id(), std::memory_order_relaxed);
	guarded([&] {
		try {
			step();
		} catch (...) {
			failures++;
			settle(scene);
			throw;
		}
	});
}

namespace {
	const std::thread::id firstThread = std::this_thread::get_id(); // that imports the plugin
}

bool McaSolverEngine::inLoop()
{
	const auto me = std::this_thread::get_id();
	return lastStep.load(std::memory_order_relaxed) == me && (me != firstThread || !Omega::instance().isRunning());
}

void McaSolverEngine::settle(Scene* scene)
{
	for (const auto& e : scene->engines)
		if (auto* s = dynamic_cast<McaSolverEngine*>(e.get())) s->bringUpToDate();
}

void McaSolverEngine::settleNow()
{
	const shared_ptr<Scene> now = Omega::instance().getScene();
	if (now && (inLoop() || !Omega::instance().isRunning())) settle(now.get());
}

// YADE's pause() returns in the middle of the last step. Scene::subStep is -1 between two steps.
void McaSolverEngine::endStepUnderWay()
{
	const shared_ptr<Scene> now = Omega::instance().getScene();
	const bool first = std::this_thread::get_id() == firstThread;
	if (!now || (!first && inLoop()) || now->subStepping) return; // a PyRunner; a script that makes parts of steps itself
	PyThreadState* state = PyEval_SaveThread();
	const long     before = failures;
	// a step that ends with an error leaves subStep where it was: those of this plugin are counted, those of other engines cost the longest wait
	for (int wait = 0; wait < 20000 && failures == before; wait++) {
		if (const_cast<volatile int&>(now->subStep) < 0 || Omega::instance().isRunning()) break;
		std::this_thread::sleep_for(std::chrono::microseconds(100));
	}
	// the loop's thread has some lines of YADE's to go, which look at the scene: a script may reset it next
	std::this_thread::sleep_for(std::chrono::milliseconds(2));
	PyEval_RestoreThread(state);
	settleNow();
}

void McaSolverEngine::findCoupler(Scene* scene)
{
	coupled         = false;
	int  me         = 0;
	bool stepper    = false;
	const McaSolverEngine* other = nullptr;
	for (const auto& e : scene->engines) {
		me += e.get() == this;
		if (e->dead) continue;
		if (auto* s = dynamic_cast<McaSolverEngine*>(e.get())) {
			if (s != this && s->setsStep()) other = s;
		} else if (dynamic_cast<McaStepGiver*>(e.get())) stepper = true;
		auto* c = dynamic_cast<McaDriver*>(e.get());
		if (!c || !c->drives(this, scene)) continue;
		coupled = true;
		c->prepare(scene);
	}
	if (scene->isPeriodic)
		throw mca::Error(getClassName() + ": O.periodic is on, which this engine does not know; set O.periodic = False and hold or drive the sides.");
	if (me > 1)
		throw mca::Error(
			getClassName() + ": the same engine stands " + std::to_string(me)
			+ " times in O.engines, which would make several steps in one; leave it there once.");
	if (!coupled && carriesRows())
		throw mca::Error(
			getClassName()
			+ ": a McaGridCoupler has tied a row to it and is now dead or not in O.engines; a tied row cannot move alone. Put the coupler back, or "
		          "start from a scene without it.");
	if (!coupled && !stepper && setsStep() && other)
		throw mca::Error(
			getClassName() + " and " + other->getClassName()
			+ ": both set O.dt, so time would not be that of either; put a McaTimeStepper first in O.engines, or set adaptive=False in all but "
		          "one.");
}

// Breaking links and first contacts can halve the stable step at once. Nothing has moved yet, so a time stepper that comes before this engine may
// still choose a shorter one, unless something between the two has already used the longer.
bool McaSolverEngine::shortenStep(Scene* scene, Real limit) const
{
	McaStepGiver* stepper = nullptr;
	for (const auto& e : scene->engines) {
		if (e.get() == this) break;
		if (e->dead) continue;
		const auto* s = dynamic_cast<McaSolverEngine*>(e.get());
		if (auto* t = dynamic_cast<McaStepGiver*>(e.get())) stepper = t->gives() ? t : nullptr;
		else if ((s && s->usesStep()) || e->getClassName() == "NewtonIntegrator") stepper = nullptr;
	}
	if (!stepper) return false;
	stepper->shorten(scene, limit, getClassName() + (label.empty() ? "" : " " + label));
	return true;
}
} // namespace yade
