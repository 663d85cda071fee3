# SPDX-License-Identifier: GPL-2.0-or-later
"""McaGridCoupler with automata that Law2 and NewtonIntegrator move: the same waves on both sides as with McaEngine, momentum kept."""
import math

import numpy as np
import pytest

import law2_scene as scene

PITCH = 0.5 * math.sqrt(3)


def halves(road, steps, dt=4e-8, **steel):
	"""Automata left, grid right; a pulse starts among the automata. Returns automata (N, 8), grid velocities, momentum before and after, moved row."""
	from yade import O
	from yade_mca.tasks import trials
	s = trials.halves(trials.elastic(**steel), left=10 * PITCH, right=8, height=6, velocity=lambda x, y: (40. * np.exp(-((x + 4e-3) / 2e-3)**2), 0 * x))
	O.dt = dt
	s.facts['stepper'].active = False
	s.automata.adaptive = s.grid.adaptive = False
	if road == 'law2':
		scene.engines('law2', dt)
		e = O.engines
		O.engines = e[:-1] + [s.grid, *s.couplers] + e[-1:]
	O.run(steps, True)
	ids = [int(i) for i in s.ids['half']]
	return scene.state(ids), np.stack([s.grid.view(0, 'vx'), s.grid.view(0, 'vy')]), s


@pytest.mark.parametrize('steel', [{}, dict(yieldModel='perfect', yieldStress=2e8, viscosityLinear=0.25, viscosityQuadratic=1.2)])
def test_sameAsWithTheEngine(plugin, steel):
	a, ga, _ = halves('engine', 150, **steel)
	b, gb, s = halves('law2', 150, **steel)
	assert abs(ga).max() > 5 and len(s.couplers[0].rowIds) == 7  # the wave has crossed the line
	assert abs(ga - gb).max() < 1e-9 * abs(ga).max()
	assert abs(a[:, 2:4] - b[:, 2:4]).max() < 1e-9 * 40
	assert abs(a[:, :2] - b[:, :2]).max() < 1e-12 * 1e-2


def test_momentumIsKept(plugin):
	from yade import O

	def momentum(s):
		row = set(s.couplers[0].rowIds)  # their mass is on the nodes
		p = sum(O.bodies[int(i)].state.mass * np.array(O.bodies[int(i)].state.vel)[:2] for i in s.ids['half'] if int(i) not in row)
		g = s.grid.energies()
		return p + (g['momentumX'], g['momentumY'])

	_, _, s = halves('law2', 1)
	start = momentum(s)
	O.run(300, True)
	assert abs(momentum(s) - start).max() < 1e-11 * np.linalg.norm(start)
