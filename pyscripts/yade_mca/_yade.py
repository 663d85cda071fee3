# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the modules of the package reach for YADE: when one of these is called, not when a module is imported. The first call loads YADE and the plugin."""
import sys
import time


def yadeClass(name):
	"""The class `name` of YADE or of the plugin. Raises ImportError, with the remedy, when YADE or the plugin cannot be loaded."""
	_load()
	return getattr(sys.modules['yade.wrapper'], name)


def scene():
	"""YADE's Omega singleton, known as O in scripts. Raises ImportError as yadeClass()."""
	_load()
	return sys.modules['yade'].O


def _load():
	import yade_mca
	yade_mca.classes  # asking for them loads them


def steps(n):
	"""n steps of the scene. True when all were made; False when someone has paused it. Raises what an engine raised.

	O.run(n, True) looks only every 40 ms whether the run has ended; this looks every half millisecond at first and later at every hundredth of the time that
	has gone by, up to 10 ms: each look takes a processor from the solver for a moment.
	"""
	o, start = scene(), time.perf_counter()
	end = o.iter + n
	o.run(n, False)
	while o.running:
		time.sleep(min(max(5e-4, 0.01 * (time.perf_counter() - start)), 1e-2))
	if o.iter < end:  # an engine refused the step or someone paused: once more, now with the error in this thread
		o.run(end - o.iter, True)
	return o.iter >= end
