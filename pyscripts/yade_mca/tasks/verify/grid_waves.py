# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic waves, patch test and rigid rotation of the grid."""
import math

import numpy as np

from .. import trials
from ..trials import delay, elastic, order

AMPLITUDE = 1e-2  #: particle speed of the small waves [m/s]


def pulse(t, centre, width):
	return AMPLITUDE * np.exp(-((t - centre) / width)**2)


def table(centre, width):
	t = np.linspace(0., 2 * centre, 4001)
	return (list(t), list(pulse(t, centre, width)))


def strip(cells, length, polarisation, side, drive):
	"""A strip in which a plane P or S wave runs along x, driven at one end."""
	run = trials.grid(sleeping=True)
	e, h = run.grid, length / cells
	e.addRectangle(elastic(), np.linspace(0, length, cells + 1), np.arange(4) * h)
	across = polarisation == 'S'
	for s in ('bottom', 'top'):
		e.fix(0, s, x=across, y=not across)  # S: no motion along x; P: none along y
	e.prescribe(0, side, **{'y' if across else 'x': drive})
	return run


def speeds(report, want, quick):
	for kind in 'P', 'S':
		if not want('speed/' + kind): continue
		m = elastic()
		c, cells, length = (m.cP if kind == 'P' else m.cS), 400, 0.4
		wave = 40 * length / cells  # about the length of the pulse
		width, centre = 0.5 * wave / c, 2 * wave / c
		run = strip(cells, length, kind, 'left', table(centre, width))
		at = (0.1, 0.3)
		for x in at:
			run.grid.addGauge((x, 0.0015))
		trials.exactly(run, 1.15 * length / c, 0.5)  # the reflection is not back yet
		g = [run.grid.gauge(k) for k in (0, 1)]
		column = 3 if kind == 'P' else 4
		travel = delay(g[0][:, 0], g[0][:, column], g[1][:, 0], g[1][:, column])
		report.add('speed/' + kind, (at[1] - at[0]) / travel, c, limit=2e-3, unit='m/s')
		trials.addBalance(report, run, 'speed/' + kind)


def convergence(report, want, quick):
	"""A smooth wave at N, 2N, 4N; the left-going error must equal the right-going one."""
	if not want('convergence'): return
	m, length = elastic(), 0.1
	width, centre = 0.008 / m.cP, 0.03 / m.cP
	levels = (50, 100) if quick else (50, 100, 200, 400)
	errors = {}
	for side in 'left', 'right':
		for cells in levels:
			sign = 1 if side == 'left' else -1
			t, v = table(centre, width)
			run = strip(cells, length, 'P', side, (t, [sign * a for a in v]))
			dt = trials.exactly(run, 0.09 / m.cP, 0.5)
			x = np.linspace(0, length, cells + 1)
			away = x if side == 'left' else length - x
			exact = sign * pulse(run.grid.time - 0.5 * dt - away / m.cP, centre, width)
			errors.setdefault(side, []).append(math.sqrt(np.mean((run.grid.view(0, 'vx')[1] - exact)**2)) / AMPLITUDE)
			if cells == levels[-1]: trials.addBalance(report, run, 'convergence/' + side)
	for k, cells in enumerate(levels):
		for side in errors:
			o = order(errors[side][:k + 1]) if k else None
			last = cells == levels[-1]
			report.add('convergence/%s/N%d' % (side, cells), errors[side][k], 0., order=o, unit='of the amplitude', passed=not last or o > 1.9)
	report.add('convergence/leftMinusRight', errors['left'][-1] / errors['right'][-1] - 1, 0., limit=1e-6)


def skew(n, size, amount=0.2):
	"""Nodes of a square of n x n cells, all moved at random."""
	random = np.random.default_rng(5)
	x, y = np.meshgrid(np.linspace(0, size, n + 1), np.linspace(0, size, n + 1))
	return x + random.uniform(-amount, amount, x.shape) * size / n, y + random.uniform(-amount, amount, x.shape) * size / n


def patch(report, want, quick):
	"""Linear velocity on the outline of a skew mesh: the inside follows to round-off, without hourglass force."""
	if not want('patch'): return
	n, size = 8, 0.08
	x, y = skew(n, size)
	run = trials.grid()
	e = run.grid
	e.addBlock(elastic(), x, y)
	gradient = np.array([[3., -2.], [1.5, 4.]])
	v = np.stack([x, y], axis=-1) @ gradient.T
	e.setVelocity(0, v)
	for j in range(n + 1):
		for i in range(n + 1):
			k = e.openNode(0, i, j)
			if k >= 0:
				e.prescribeNodes(k, (1, 0), v[j, i, 0])
				e.prescribeNodes(k, (0, 1), v[j, i, 1])
	trials.steps(run, 50)
	t = e.time
	moved = max(abs(run.grid.view(0, 'x') - x - t * v[..., 0]).max(), abs(run.grid.view(0, 'y') - y - t * v[..., 1]).max()) / (t * abs(v).max())
	report.add('patch/motion', moved, 0., limit=1e-9)
	for s in 'sxx', 'sxy':
		f = run.grid.view(0, s)
		report.add('patch/' + s, np.ptp(f) / abs(f).max(), 0., limit=1e-9)
	trials.addBalance(report, run, 'patch')


def rotation(report, want, quick):
	"""A cell is sheared, then turned by one revolution in large steps: its stress must turn with it."""
	if not want('rotation'): return
	h, dt, shear, turn = 0.01, 1e-7, 50, 60
	corner = {(i, j): np.array([i * h, j * h]) for i in (0, 1) for j in (0, 1)}
	run = trials.grid(adaptive=False)
	e = run.grid
	e.addRectangle(elastic(), [0, h], [0, h])
	angles = 2 * math.pi * np.arange(turn + 1) / turn
	for (i, j), p in corner.items():
		path = [p + np.array([2e-4 * p[1] - 1e-4 * p[0], 0]) * k / shear for k in range(shear + 1)]
		path += [np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]]) @ path[shear] for a in angles[1:]]
		v, mid = np.diff(np.array(path), axis=0) / dt, (np.arange(shear + turn) + 0.5) * dt
		for d in 0, 1:
			e.prescribeNodes(e.openNode(0, i, j), (1 - d, d), (list(mid), list(v[:, d])))
	stress = lambda: np.array([run.grid.view(0, s)[0, 0] for s in ('sxx', 'syy', 'sxy')])
	trials.steps(run, shear + 1, dt)  # stresses are those of one step ago
	before = stress()
	worst = 0.
	for a in angles[1:]:
		c, s = math.cos(a), math.sin(a)
		trials.steps(run, 1, dt)
		now = stress()
		xx, yy, xy = before
		exact = np.array([c * c * xx + s * s * yy - 2 * c * s * xy, s * s * xx + c * c * yy + 2 * c * s * xy, c * s * (xx - yy) + (c * c - s * s) * xy])
		if a > angles[-1] - 1e-9: break
		worst = max(worst, abs(now - exact).max() / abs(before).max())
	report.add('rotation/stress', worst, 0., limit=1e-9)


CASES = [speeds, convergence, patch, rotation]
