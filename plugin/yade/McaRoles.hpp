// SPDX-License-Identifier: GPL-2.0-or-later
// What engines of the plugin are to each other, so that none needs to know the others' classes.
#pragma once
#include <core/Scene.hpp>

namespace yade {
class McaSolverEngine;

/// An engine that drives others: they compute forces, it moves. See McaGridCoupler.
struct McaDriver {
	/// Whether it integrates that engine.
	virtual bool drives(const McaSolverEngine* engine, Scene* scene) = 0;
	/// Finds its engines and ties what it ties, once; throws before anything has moved.
	virtual void prepare(Scene* scene) = 0;
	virtual ~McaDriver() = default;
};

/// An engine that sets O.dt for all. See McaTimeStepper.
struct McaStepGiver {
	/// It does so in this scene.
	virtual bool gives() const = 0;
	/// The stable step has become `limit` [s] since it set O.dt, says `who`.
	virtual void shorten(Scene* scene, Real limit, const string& who) = 0;
	virtual ~McaStepGiver() = default;
};
} // namespace yade
