// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "McaRoles.hpp"
#include <core/TimeStepper.hpp>

namespace yade {
class McaTimeStepper : public TimeStepper, public McaStepGiver {
public:
	bool isActivated() override; ///< throws when the interval is zero, by which YADE would divide
	void computeTimeStep(Scene* scene) override;
	bool gives() const override { return active; }
	/// A smaller stable step has shown up in this step, before anything has moved.
	void shorten(Scene* scene, Real found, const string& who) override;

private:
	void choose(Scene* scene);

public:
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(McaTimeStepper, TimeStepper,
		"Sets O.dt to the smallest of all stable steps times a factor, growing at most by a factor from step to step: those of :yref:`McaEngine`, "
		":yref:`McaLaw` and :yref:`McaGridEngine`, and of the bodies of "
		":yref:`McaMat` when none of them has them. Tied nodes need no smaller one: their mass is at least that of both sides together. "
		"Where the stable step of automata falls by more than the factor within one step (links break, bodies meet), O.dt is shortened before "
		"anything moves. "
		"Put it first in O.engines. It switches the engines' own `adaptive` off.",
		((Real, factor, 0.4, , "share of the largest stable time step [-], above 0 and at most 1; read in every step (every timeStepUpdateInterval)"))
		((Real, growth, 1.1, , "largest ratio of a step to the one before [-], above 1; read in every step (every timeStepUpdateInterval)"))
		((Real, largest, std::numeric_limits<Real>::infinity(), , "upper bound of O.dt [s]; read in every step (every timeStepUpdateInterval)"))
		((Real, limit, 0, Attr::readonly, "largest stable step found [s]"))
		((string, limitedBy, "", Attr::readonly, "what has set `limit`: class and label of an engine, or a body"))
		((Real, previous, 0, Attr::hidden, "step set last [s]"))
	)
	// clang-format on
};
REGISTER_SERIALIZABLE(McaTimeStepper);
} // namespace yade
