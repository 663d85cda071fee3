# SPDX-License-Identifier: GPL-2.0-or-later
"""Patch test, rigid motion, balances over a long run, a shock, and the cost of the coupler."""
import math
import time

import numpy as np

from ... import materials, scenes
from ..._yade import scene as omega
from .. import trials
from ..trials import D, PITCH, elastic


def _patch(gradient, strain, steps=60):
	"""Deviation of the velocities from the linear field they start with, over its size, when the outline keeps to it: (automata, tied row, grid) in order."""
	left, right, height = 10 * PITCH, 8, 12
	g = np.asarray(gradient, float)
	m = elastic()
	dt = 0.14 * D / m.cS
	rate = strain / (steps * dt)
	field = lambda x, y: (rate * (g[0, 0] * x + g[0, 1] * (y - 0.5 * height * D)), rate * (g[1, 0] * x + g[1, 1] * (y - 0.5 * height * D)))
	s = trials.halves(m, left, right, height, velocity=field, account=True)
	p = s.packings['half'].positions
	rim = (p[:, 0] < -left * D + 2 * D) | (p[:, 1] < 2 * D) | (p[:, 1] > (height - 2) * D)
	spin = 0.5 * rate * (g[1, 0] - g[0, 1])
	for i, held in zip(s.ids['half'].tolist(), rim.tolist()):
		st = omega().bodies[i].state
		st.angVel = (0, 0, spin)
		if held: st.blockedDOFs = 'xyzXYZ'
	for j in range(height + 1):
		for i in range(right + 1):
			n = s.grid.openNode(0, i, j)
			if n < 0 or (i == 0 and 2 < j < height - 2): continue
			v = field(i * D, j * D)
			s.grid.prescribeNodes(n, (1, 0), v[0])
			s.grid.prescribeNodes(n, (0, 1), v[1])
	trials.fixedStep(s, dt)
	omega().run(steps, True)
	scale = abs(rate) * abs(g).max() * max(left, height) * D
	u = np.stack((s.automata.field('vx'), s.automata.field('vy')), axis=1) - np.stack(np.broadcast_arrays(*field(p[:, 0], p[:, 1])), axis=1)
	gx, gy = np.meshgrid(np.arange(right + 1) * D, np.arange(height + 1) * D)
	w = np.stack((s.grid.view(0, 'vx'), s.grid.view(0, 'vy')), axis=-1) - np.stack(np.broadcast_arrays(*field(gx, gy)), axis=-1)
	return u / scale, w / scale


def patch(report, want, quick):
	for name, g in (('tension', [[1, 0], [0, 0]]), ('compression', [[-1, 0], [0, -1]]), ('tensionAlong', [[0, 0], [0, 1]]), ('shear', [[0, 1], [0, 0]]), ('shearAlong', [[0, 0], [1, 0]])):
		if not want('patch/' + name): continue
		# the two sides agree to first order in the strain: runs at +-e and +-2e remove second and third order, and what is left is linear
		strain = 1e-4
		odd = lambda e: [0.5 * (x - y) for x, y in zip(_patch(g, e), _patch(g, -e))]
		report.add('patch/' + name, max(abs((4 * x - y) / 3).max() for x, y in zip(odd(strain), odd(2 * strain))), 0., limit=1e-10, unit='of the largest speed')


def rigid(report, want, quick):
	if want('rigid/translation'):
		s = trials.halves(elastic(), 10 * PITCH, 8, 10, velocity=lambda x, y: (70. + 0. * x, -40. + 0. * y))
		omega().run(2000, True)
		m = s.facts['material']
		stress = max(abs(s.automata.field('pressure')).max(), s.automata.field('equivalentStress').max(), *(abs(s.grid.view(0, k)).max() for k in ('pressure', 'sxx', 'syy', 'sxy')))
		report.add('rigid/translation', stress / (m.density * m.cP**2), 0., limit=1e-11, unit='rho cP^2')
	if want('rigid/rotation'):
		speed, half = 60., 10 * PITCH * D
		rate = speed / half
		s = trials.halves(elastic(), 10 * PITCH, 8, 10, velocity=lambda x, y: (-rate * (y - 5 * D), rate * x), account=True)
		for i in s.ids['half'].tolist():
			omega().bodies[i].state.angVel = (0, 0, rate)
		omega().run(1, True)
		e0 = s.couplers[0].energies()
		worst, t = 0., 0.
		while t < 2 * math.pi / rate:
			omega().run(500, True)
			t += 500 * omega().dt
			worst = max(worst, s.automata.field('equivalentStress').max(), *(abs(s.grid.view(0, k)).max() for k in ('sxx', 'syy', 'sxy')))
		e = s.couplers[0].energies()
		report.add('rigid/rotation/stress', worst / (s.facts['material'].density * speed**2), limit=3., unit='rho (omega R)^2')
		report.add('rigid/rotation/angularMomentum', e['angularMomentum'], e0['angularMomentum'], limit=1e-10, unit='N s')


def vibration(report, want, quick):
	"""A free block, half automata, half grid, vibrates with large amplitude; rotated, so that nothing is aligned with the axes."""
	if not want('vibration'): return
	length = 10 * PITCH + 8
	mode = lambda x, y: (20 * np.sin(math.pi * (x / D + 10 * PITCH) / length), 15 * np.cos(2 * math.pi * y / (10 * D)))
	m = materials.mcaMat('4340', yieldModel='elastic', viscosityLinear=0., viscosityQuadratic=0.)
	s = trials.halves(m, 10 * PITCH, 8, 10, velocity=mode, rotate=0.4, account=True)
	omega().run(1, True)
	start, steps, rows = s.couplers[0].energies(), 10000 if quick else 100000, []
	scale = math.sqrt(2 * start['kinetic'] * sum(omega().bodies[i].state.mass for i in s.ids['half'].tolist()))
	for _ in range(10):
		omega().run(steps // 10, True)
		e = s.couplers[0].energies()
		rows.append((abs(e['booked'] - start['booked']) / start['kinetic'], math.hypot(*(e['momentum' + k] - e['impulse' + k] - start['momentum' + k] + start['impulse' + k] for k in 'XY')) / scale,
		             e['total'] / start['total'] - 1, e['angularMomentum']))
	rows = np.array(rows)
	report.add('vibration/energy', rows[:, 0].max(), 0., limit=1e-10, unit='of the kinetic energy')
	report.add('vibration/momentum', rows[:, 1].max(), 0., limit=1e-12, unit='of sqrt(2 m E)')
	report.add('vibration/angularMomentum', abs(rows[:, 3] - start['angularMomentum']).max() / (scale * 10 * D), 0., limit=1e-10, unit='of sqrt(2 m E) L')
	report.add('vibration/totalFromState', abs(rows[:, 2]).max(), 0., limit=0.02, unit='relative')
	nodes, shares, ids = s.couplers[0].rowNodes, s.couplers[0].rowShares, s.couplers[0].rowIds
	x = s.automata.field('x')[np.searchsorted(s.automata.ids, ids)]
	open_ = {s.grid.openNode(0, 0, j): s.grid.view(0, 'x')[j, 0] for j in range(11)}
	off = max(abs(xi - (a * open_[n[0]] + b * open_[n[1]])) for xi, n, (a, b) in zip(x, nodes, shares))
	report.add('vibration/rowOffEdge', off / D, 0., limit=1e-12, unit='spacings')


def shock(report, want, quick):
	"""A 20 GPa shock, elastic-plastic steel with viscosity, uniaxial strain: plateau behind it on both sides of the line against a run without line."""
	if not want('shock'): return
	u, height, left, right = 485., 40, 150 * PITCH, 100
	found = []
	for coupled in False, True:
		s = trials.halves(materials.mcaMat('4340'), left, right, height, 1., coupled, velocity=lambda x, y: (np.where(x < -40 * D, 2 * u, 0.), 0. * y))
		for i in s.ids['half'].tolist():
			omega().bodies[i].state.blockedDOFs = 'yzXYZ'
		if coupled:
			s.grid.fix(0, 'bottom', x=False)
			s.grid.fix(0, 'top', x=False)
		shockSpeed = s.facts['material'].bulkSoundSpeed + s.facts['material'].hugoniotSlope * u
		omega().run(1, True)
		while omega().time < (40 + 60) * D / shockSpeed:
			omega().run(20, True)
		p, x0 = s.automata.field('pressure'), s.packings['half'].positions[:, 0] / D
		middle = abs(s.packings['half'].positions[:, 1] / D - 0.5 * height) < 6  # the corners at the ends of the line disturb their surroundings
		p, x0, end = p[middle], x0[middle], omega().time
		line = p[abs(x0) < 1e-6].mean()
		found.append((np.median(p[(x0 > -25) & (x0 < -5)]), np.median(s.grid.view(0, 'pressure')[14:26, 5:30]) if coupled else np.median(p[(x0 > 5) & (x0 < 30)]), line))
	alone = trials.grid()  # the same impact in a grid without line: beyond the line, that is the medium the shock runs in
	x = np.arange(-130, 101) * D
	alone.grid.addRectangle(materials.mcaMat('4340'), x, np.arange(5) * D)
	for side in 'bottom', 'top':
		alone.grid.fix(0, side, x=False)
	v = np.zeros((5, len(x), 2))
	v[:, x < -40 * D, 0] = 2 * u
	alone.grid.setVelocity(0, v)
	trials.until(alone, end)
	grid = np.median(alone.grid.view(0, 'pressure')[:, 135:160])
	(a, b, c), (d, e, f) = found
	report.add('shock/automataSide', d, a, limit=0.005, unit='Pa')
	report.add('shock/gridSide', e, grid, limit=0.005, unit='Pa')
	report.add('shock/gridAgainstAutomata', grid, b, unit='Pa')  # the two media without any line
	report.add('shock/tiedRow', f, c, unit='Pa')  # one row only: rows next to the line alternate


def cost(report, want, quick):
	"""Share of the coupler in the step of the penetration scene."""
	if not want('cost'): return
	from yade import O
	O.reset()
	s = scenes.penetration(mode='coupled', spacing=1e-3)
	O.run(150, True)
	O.timingEnabled = True
	start = time.perf_counter()
	O.run(150 if quick else 500, True)
	wall = time.perf_counter() - start
	O.timingEnabled = False
	own = sum(ns for c in s.couplers for label, ns, n in c.timingDeltas.data if label.startswith(('forces', 'motion'))) * 1e-9
	report.add('cost/coupler', own / wall, limit=0.02, unit='of the step')


CASES = [patch, rigid, vibration, shock, cost]
