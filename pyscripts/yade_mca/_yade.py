# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the modules of the package reach for YADE: when one of these is called, not when a module is imported. The first call loads YADE and the plugin."""
import math
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


LATE = 5e-4  #: [s] by which the end of a run is seen
pace = 0.  # seconds per step of the last steps()


def steps(n):
	"""n steps of the scene. True when all were made; False when someone has paused it. Raises what an engine raised.

	O.run(n, True) looks only every 40 ms whether the run has ended; this looks every half millisecond, from when most of the steps can have been made:
	each look takes a processor from the solver for a moment.
	"""
	global pace
	o, start = scene(), time.perf_counter()
	end = o.iter + n
	o.run(n, False)
	time.sleep(max(LATE, 0.9 * n * pace))
	while o.running:
		time.sleep(LATE)
	if o.iter < end:  # an engine refused the step or someone paused: once more, now with the error in this thread
		o.run(end - o.iter, True)
	if n: pace = min(pace or math.inf, (time.perf_counter() - start) / n)
	return o.iter >= end
