# SPDX-License-Identifier: GPL-2.0-or-later
"""Collapse of a beryllium shell (Howell & Ball 2002): kinetic energy into plastic work, large rotation-free strain."""
import math

import numpy as np

from ... import exact
from .. import trials
from ..trials import material, order

DENSITY, YIELD, INNER, OUTER = 1845., 330e6, 0.08, 0.1  #: [kg/m3], [Pa], [m], [m]


def collapse(cells, stop):
	"""Radius [m] of the inner surface at rest, with `cells` through the thickness of a quarter; and the run."""
	m = material('Be_S200', density=DENSITY, yieldModel='perfect', yieldStress=YIELD)
	run = trials.grid()
	e = run.grid
	r = np.linspace(INNER, OUTER, cells + 1)
	n = round(0.5 * math.pi * 0.5 * (INNER + OUTER) / ((OUTER - INNER) / cells))
	a = np.linspace(0, 0.5 * math.pi, n + 1)
	rr, aa = np.meshgrid(r, a)
	x, y = rr * np.cos(aa), rr * np.sin(aa)
	x[-1], y[0] = 0., 0.  # exactly on the axes
	e.addBlock(m, x, y)
	e.symmetry(0, 'bottom')
	e.symmetry(0, 'top')
	speed = exact.shellVelocity(DENSITY, YIELD, INNER, OUTER, stop)
	e.setVelocity(0, -speed * INNER / np.hypot(x, y)[..., None]**2 * np.stack([x, y], axis=-1))
	points = [e.addGauge((INNER * math.cos(t), INNER * math.sin(t) * (1 - 1e-12)), 5) for t in (0., a[n // 3], a[n // 2], 0.5 * math.pi)]
	trials.until(run, 2.5 * (INNER - stop) / speed)  # it stops at about 1.7 of this unit and then rings elastically
	history = [e.gauge(k) for k in points]
	return float(np.mean([np.hypot(h[:, 1], h[:, 2]).min() for h in history])), run


def shell(report, want, quick):
	for stop in 0.06, 0.05:
		if not want('shell/stop%g' % (stop * 1e3)): continue
		errors = []
		for cells, limit in ((20, 0.01), ) if quick else ((20, 0.01), (40, 0.004)):
			radius, run = collapse(cells, stop)
			errors.append(abs(radius / stop - 1))
			name = 'shell/stop%g/N%d' % (stop * 1e3, cells)
			report.add(name, radius, stop, limit=limit, unit='m', order=order(errors) if len(errors) > 1 else None)
			trials.addBalance(report, run, name)


CASES = [shell]
