// SPDX-License-Identifier: GPL-2.0-or-later
// How an engine of the plugin ends its step with an error.
#pragma once
#include <core/Engine.hpp>

namespace yade {

/// Waits until the thread that has called O.run(n, True) waits for the loop. YADE's wait() looks for the loop's error only when it has seen the loop
/// running; an engine that fails at once can be faster than that, and the error is lost. The caller of O.run holds Python's global lock until it
/// has looked, so whoever gets the lock here comes after that. Called on the way of an error only: it costs a good step nothing.
inline void letPythonSeeTheLoop()
{
	if (!Py_IsInitialized() || PyGILState_Check()) return; // O.step: this thread is Python's
	const PyGILState_STATE state = PyGILState_Ensure();
	PyGILState_Release(state);
}

/// Lets go of bodies and the like, under Python's lock: what a script has made takes a Python object along.
template <class... List> void letGo(List&... lists)
{
	if (!Py_IsInitialized()) return (lists.clear(), ...);
	const PyGILState_STATE state = PyGILState_Ensure();
	(lists.clear(), ...);
	PyGILState_Release(state);
}

/// Runs the step of an engine; what it throws goes on when YADE is ready to see it. Not inside a lock that Python calls take as well.
template <class F> void guarded(F&& step)
{
	try {
		step();
	} catch (...) {
		letPythonSeeTheLoop();
		throw;
	}
}
} // namespace yade
