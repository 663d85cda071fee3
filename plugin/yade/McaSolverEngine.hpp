// SPDX-License-Identifier: GPL-2.0-or-later
// What the time stepper and the coupler need of an engine that integrates its own unknowns.
#pragma once
#include <core/GlobalEngine.hpp>
#include <core/Scene.hpp>

namespace yade {
class McaSolverEngine : public GlobalEngine {
public:
	/// Largest stable step at the present state [s]; infinity when it has none.
	virtual Real criticalTimeStep() const { return std::numeric_limits<Real>::infinity(); }
	/// Makes criticalTimeStep() known before the first step.
	virtual void prepare(Scene*) { }
	/// Whether a coupler of the scene drives this engine, into `coupled`; couplers tie their rows here, before anything moves.
	void findCoupler(Scene* scene);
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(McaSolverEngine, GlobalEngine, "Base of engines that integrate unknowns of their own (:yref:`McaEngine`, :yref:`McaGridEngine`).",
		((bool, coupled, false, Attr::readonly, "a coupler or time stepper drives this engine: it computes forces only and leaves O.dt alone"))
		, ,
		.add_property("criticalTimeStep", &McaSolverEngine::criticalTimeStep, "Largest stable time step at the present state [s].")
	)
	// clang-format on
};
REGISTER_SERIALIZABLE(McaSolverEngine);
} // namespace yade
