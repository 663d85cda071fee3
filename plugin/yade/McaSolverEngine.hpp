// SPDX-License-Identifier: GPL-2.0-or-later
// What all engines with unknowns of their own share: the lock around a step, how a step ends with an error, what the time stepper and the coupler ask.
#pragma once
#include "McaGuarded.hpp"
#include "McaLock.hpp"
#include <atomic>
#include <core/GlobalEngine.hpp>
#include <core/Scene.hpp>
#include <thread>

namespace yade {
class McaSolverEngine : public GlobalEngine {
public:
	/// A step; what it throws goes on when bodies hold the state it has left and YADE is ready to see the error.
	void         action() final;
	virtual void step() { } ///< of this engine, without the lock: locked() inside
	/// Largest stable step at the present state [s]; infinity when it has none.
	virtual Real criticalTimeStep() const { return std::numeric_limits<Real>::infinity(); }
	/// Makes criticalTimeStep() known before the first step.
	virtual void prepare(Scene*) { }
	/// Writes to the bodies what they do not hold yet; does nothing when they are up to date.
	virtual void bringUpToDate() { }
	/// Whether rows of automata have been tied to it.
	virtual bool carriesRows() const { return false; }
	/// Sets O.dt by itself.
	virtual bool setsStep() const { return false; }
	/// Its bodies are automata.
	virtual bool movesAutomata() const { return false; }
	/// It has moved with O.dt when its turn is over: nobody may shorten the step after that.
	virtual bool usesStep() const { return false; }
	/// A time stepper sets O.dt from now on.
	virtual void stepIsSet() { }
	/// Whether a coupler of the scene drives this engine, into `coupled`; couplers tie their rows here, before anything moves.
	/// Throws mca::Error: the engine stands twice in O.engines, several set O.dt, the coupler of its rows is gone, a periodic scene.
	void findCoupler(Scene* scene);
	/// O.dt shortened to this stable step [s] while nothing has used the longer one in this step; false when there is no time stepper that could.
	bool shortenStep(Scene* scene, Real limit) const;
	/// bringUpToDate() of all engines of the scene.
	static void settle(Scene* scene);
	/// settle() of the present scene, from Python.
	static void settleNow();
	/// This thread makes the steps: a PyRunner runs in it. Python's first thread makes them in O.step() only, when no loop runs.
	static bool inLoop();
	static void endStepUnderWay();

	/// f() with nobody else inside this engine: a step and each call from Python exclude each other.
	template <class F> auto locked(F&& f) const { return lock.locked(f); }
	Real safeCriticalTimeStep() const
	{
		return locked([&] { return criticalTimeStep(); });
	}
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(McaSolverEngine, GlobalEngine, "Base of engines that integrate unknowns of their own (:yref:`McaEngine`, "
	    ":yref:`McaGridEngine`).",
		((bool, coupled, false, Attr::readonly, "a coupler or time stepper drives this engine: it computes forces only and leaves O.dt alone; found "
		    "anew in every step"))
		, ,
		.def("settle", &McaSolverEngine::settleNow, "Bring the bodies of the present scene up to date with the engines that move them; does nothing "
		    "while the loop runs elsewhere.").staticmethod("settle")
		.def("endStepUnderWay", &McaSolverEngine::endStepUnderWay, "After O.pause(): wait until the step under way is over, then "
		    "settle().").staticmethod("endStepUnderWay")
		.def("inLoop", &McaSolverEngine::inLoop, "Whether this is the thread that makes the steps (True in a PyRunner).").staticmethod("inLoop")
		.add_property("criticalTimeStep", &McaSolverEngine::safeCriticalTimeStep, "Largest stable time step [s] at the present state; infinity when "
		    "there is nothing to move.")
	)
	// clang-format on

private:
	/// Python's global lock is given up meanwhile by who has it.
	struct GiveUp {
		PyThreadState* state = Py_IsInitialized() && PyGILState_Check() ? PyEval_SaveThread() : nullptr;
		~GiveUp()
		{
			if (state) PyEval_RestoreThread(state);
		}
	};
	McaLock<GiveUp>                            lock;
	static inline std::atomic<std::thread::id> lastStep {};
	static inline std::atomic<long>            failures { 0 }; ///< steps that have ended with an error
};
REGISTER_SERIALIZABLE(McaSolverEngine);
} // namespace yade
