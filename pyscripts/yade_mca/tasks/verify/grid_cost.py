# SPDX-License-Identifier: GPL-2.0-or-later
"""Cost of the grid as a user runs it, beside what the machine can do at that moment. Nothing is asserted: machines and their load drift."""
import numpy as np

from ..._yade import yadeClass
from .. import environment, trials
from ..trials import material

REPEATS = 5  #: the best of so many counts

#: name -> (changes to the material, options of the engine, options of the block)
FEATURES = {
        'elasticBare': (dict(yieldModel='elastic', viscosity=(0., 0.)), dict(account=False), dict(hourglass=0.)),
        'plastic': (dict(yieldModel='linearHardening'), dict(account=False), {}),
        'plasticAccount': (dict(yieldModel='linearHardening'), dict(account=True), {}),
        'johnsonCook': (dict(yieldModel='johnsonCook'), dict(account=False), {}),
        'mieGruneisen': (dict(yieldModel='perfect', eos='mieGruneisen'), {}, {}),
        'edgeViscosity': (dict(yieldModel='linearHardening'), dict(account=False), dict(edgeViscosity=True)),
}


def nanoseconds(feature, n, threads):
	"""Time per cell and step [ns] inside the engine's step, everything awake, flowing plastically in part of the block."""
	from yade import O
	constants, options, block = FEATURES[feature]
	run = trials.grid(sleeping=False, **options)
	e = run.grid
	e.ompThreads = threads
	x = np.linspace(0, 1e-3 * n, n + 1)
	e.addRectangle(material('4340', **constants), x, x, **block)
	xx, yy = np.meshgrid(x, x)
	random = np.random.default_rng(1).uniform(-20, 20, (n + 1, n + 1, 2))
	e.setVelocity(0, random + np.stack([200 * np.sin(40 * xx), 200 * np.cos(30 * yy)], axis=-1))
	e.dtFactor = 0.3
	trials.steps(run, 3)
	steps, best = max(5, int(4e6 / n**2)), np.inf
	O.timingEnabled = True
	try:
		for _ in range(REPEATS):
			before = e.execTime
			O.run(steps, True)
			best = min(best, (e.execTime - before) / steps / n**2)
	finally:
		O.timingEnabled = False
	return best


def cost(report, want, quick):
	if not want('cost'): return
	info, counts = yadeClass('McaInfo')(), sorted({1, min(2, environment.cores())})
	for t in counts:
		report.add('cost/triad/threads%d' % t, info.triad(t) * 1e-9, unit='GB/s')
		report.add('cost/flops/threads%d' % t, info.flops(t) * 1e-9, unit='GF/s')
	sizes = (64, 256) if quick else (64, 128, 256, 512, 1024)
	for feature in FEATURES:
		for n in sizes if feature.startswith('plastic') else (256, ):
			if not want('cost/%s' % feature): continue
			times = [nanoseconds(feature, n, t) for t in counts]
			for t, ns in zip(counts, times):
				report.add('cost/%s/%dx%d/threads%d' % (feature, n, n, t), ns, unit='ns per cell and step')
			if len(times) > 1: report.add('cost/%s/%dx%d/speedUp' % (feature, n, n), times[0] / times[1], unit='1 to 2 threads')


CASES = [cost]
