// SPDX-License-Identifier: GPL-2.0-or-later
// The lock of an engine: a step and each call from Python exclude each other. Knows nothing of YADE and Python, so that tests can run it under a sanitizer.
#pragma once
#include <mutex>

namespace yade {

/// Outer: made before the lock is asked for and destroyed after it is open again. It gives up the lock of the interpreter where this thread has it:
/// who holds that one must never wait for a step, within which an engine may ask for it.
template <class Outer> class McaLock {
public:
	/// f() with nobody else inside; calls may nest.
	template <class F> auto locked(F&& f) const
	{
		const Outer                                 outer;
		const std::lock_guard<std::recursive_mutex> lock(mutex);
		return f();
	}

private:
	mutable std::recursive_mutex mutex;
};
} // namespace yade
