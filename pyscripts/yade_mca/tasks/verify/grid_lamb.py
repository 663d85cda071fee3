# SPDX-License-Identifier: GPL-2.0-or-later
"""Lamb's problem: a line force on the free surface of a half-plane; P, S and Rayleigh wave at once."""
import math

import numpy as np

from ... import exact
from .. import trials
from ..trials import delay, material, order

FREQUENCY, DELAY, FORCE, END = 200e3, 6e-6, 1e4, 30e-6  #: Ricker wavelet [Hz], [s], line force [N/m], end [s]
GAUGES = (0.03, 0.05)  #: distances from the force along the surface [m]; the solution is compared at the last


def scene(h):
	"""Half of the half-plane, x >= 0, y <= 0, large enough that no reflection returns to the gauges before END."""
	m = material('4340', eos='linear', yieldModel='elastic', viscosity=(0., 0.))
	reach = m.cP * END
	size = lambda length: math.ceil(length / h)
	nx, ny = size(0.5 * (reach + GAUGES[-1]) + 0.002), size(0.5 * math.sqrt(reach**2 - GAUGES[-1]**2) + 0.002)
	run = trials.grid()
	e = run.grid
	e.addRectangle(m, np.arange(nx + 1) * h, np.arange(-ny, 1) * h)
	e.symmetry(0, 'left')
	e.viscous(0, 'right')
	e.viscous(0, 'bottom')
	t = np.linspace(0, END, 6001)
	e.force(e.openNode(0, 0, ny), y=(list(t), list(-0.5 * FORCE * exact.ricker(t, FREQUENCY, DELAY))))
	for x in GAUGES:
		e.addGauge((x, -1e-9 * h))
	return m, run


def solve(h):
	"""(material, run, [(t, ux, uz) per gauge]) with uz into the solid, for unit force."""
	m, run = scene(h)
	trials.exactly(run, END, 0.6)
	out = []
	for k, x in enumerate(GAUGES):
		g = run.grid.gauge(k)
		out.append((g[:, 0], (g[:, 1] - x) / FORCE, -(g[:, 2] + 1e-9 * h) / FORCE))
	return m, run, out


def lamb(report, want, quick):
	if not (want('lamb') or want('speed/Rayleigh')): return
	errors = []
	levels = (1e-3, 0.5e-3) if quick else (1e-3, 0.5e-3, 0.25e-3)
	for h in levels:
		m, run, gauges = solve(h)
		t, ux, uz = gauges[-1]
		rz, rx = exact.lambSurface(t, GAUGES[-1], m.density, m.cP, m.cS, FREQUENCY, DELAY)
		errors.append(math.sqrt(np.sum((ux - rx)**2 + (uz - rz)**2) / np.sum(rx**2 + rz**2)))
		name = 'lamb/h%gmm' % (h * 1e3)
		if want('lamb'):
			falling = len(errors) == 1 or errors[-1] < errors[-2]
			limit = 0.1 if h <= 0.5e-3 else None
			report.add(name, errors[-1], 0., limit=limit, order=order(errors) if len(errors) > 1 else None, unit='relative L2',
			           passed=falling and (limit is None or errors[-1] <= limit))
			trials.addBalance(report, run, name)
	if want('speed/Rayleigh'):
		# between the gauges the displacement into the solid is mostly Rayleigh's wave; the reference is treated in the same way, so what
		# remains of the other waves cancels: the ratio of delays is the ratio of speeds
		(t1, _, z1), (t2, _, z2) = gauges
		e1, e2 = (exact.lambSurface(t, x, m.density, m.cP, m.cS, FREQUENCY, DELAY)[0] for t, x in zip((t1, t2), GAUGES))
		speed = exact.rayleighSpeed(m.cP, m.cS) * delay(t1, e1, t2, e2) / delay(t1, z1, t2, z2)
		report.add('speed/Rayleigh', speed, exact.rayleighSpeed(m.cP, m.cS), limit=2e-3, unit='m/s')


CASES = [lamb]
