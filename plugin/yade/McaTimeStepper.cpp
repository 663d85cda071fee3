// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaTimeStepper.hpp"
#include <kernels/automaton/limit.hpp>
#include "McaMat.hpp"
#include "McaSolverEngine.hpp"
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>

namespace yade {
YADE_PLUGIN((McaTimeStepper));

bool McaTimeStepper::isActivated()
{
	guarded([&] {
		if (timeStepUpdateInterval < 1 || timeStepUpdateInterval > 2147483647u)
			throw mca::Error(
				"McaTimeStepper: timeStepUpdateInterval = " + std::to_string(int(timeStepUpdateInterval)) + " must be 1 or more steps.");
	});
	return TimeStepper::isActivated();
}

void McaTimeStepper::computeTimeStep(Scene* scene)
{
	guarded([&] {
		try {
			choose(scene);
		} catch (...) {
			McaSolverEngine::settle(scene);
			throw;
		}
	});
}

void McaTimeStepper::choose(Scene* scene)
{
	const auto need = [](const char* name, Real v, bool ok, const char* range) {
		if (!ok) throw mca::Error(string("McaTimeStepper: ") + name + " = " + std::to_string(v) + " must be " + range + ".");
	};
	need("factor", factor, factor > 0 && factor <= 1, "above 0 and at most 1");
	need("growth", growth, growth > 1, "above 1");
	need("largest", largest, largest > 0, "above 0");
	Real   found = std::numeric_limits<Real>::infinity();
	string who;
	bool   automata = false;
	for (const auto& e : scene->engines) {
		auto* s = dynamic_cast<McaSolverEngine*>(e.get());
		if (!s || s->dead) continue;
		s->prepare(scene);
		s->stepIsSet();
		automata |= s->movesAutomata();
		const Real t = s->safeCriticalTimeStep();
		if (t < found) found = t, who = s->getClassName() + (s->label.empty() ? "" : " " + s->label);
	}
	if (!automata) // automata that no engine of ours has taken yet
		for (const auto& b : scene->bodies->body) {
			const auto* m = b ? dynamic_cast<const McaMat*>(b->material.get()) : nullptr;
			const auto* r = m ? dynamic_cast<const Sphere*>(b->shape.get()) : nullptr;
			const auto* s = r ? dynamic_cast<const McaState*>(b->state.get()) : nullptr;
			if (!s) continue;
			const Real t = mca::stepLimitAtRest(m->toMaterial(), 2. * r->radius, s->volumeRatio);
			if (t < found) found = t, who = "body " + std::to_string(b->id);
		}
	if (!std::isfinite(found)) return; // nothing of ours in the scene
	limit = found, limitedBy = who;
	const Real dt = std::min({ factor * limit, largest, previous > 0 ? growth * previous : largest });
	scene->dt = previous = dt;
}

void McaTimeStepper::shorten(Scene* scene, Real found, const string& who)
{
	limit = found, limitedBy = who;
	scene->dt = previous = std::min(factor * limit, previous);
}
} // namespace yade
