# SPDX-License-Identifier: GPL-2.0-or-later
"""The one place where the package's Python modules reach for YADE, so that all else imports without it."""
import time


def yadeClass(name):
	"""The class `name` of YADE or of the plugin. Raises ImportError, with the remedy, when YADE or the plugin is not loaded."""
	try:
		import yade.wrapper
	except ImportError as e:
		raise ImportError("%s needs YADE: run the script with pyscripts/yade-mca (%s)" % (name, e)) from e
	c = getattr(yade.wrapper, name, None)
	if c is None:
		raise ImportError("YADE runs without the plugin, class %s is missing: put `import yade_mca` first in the script" % name)
	return c


def scene():
	"""YADE's Omega singleton, known as O in scripts. Raises ImportError when YADE is not there."""
	try:
		from yade import O
	except ImportError as e:
		raise ImportError('YADE is not loaded: run the script with pyscripts/yade-mca (%s)' % e) from e
	return O


def steps(n):
	"""n steps of the scene. True when all were made; False when someone has paused it. Raises what an engine raised.

	O.run(n, True) looks only every 40 ms whether the run has ended; this looks every half millisecond.
	"""
	o = scene()
	end = o.iter + n
	o.run(n, False)
	while o.running:
		time.sleep(5e-4)
	if o.iter < end:  # an engine refused the step or someone paused: once more, now with the error in this thread
		o.run(end - o.iter, True)
	return o.iter >= end
