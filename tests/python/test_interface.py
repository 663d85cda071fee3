# SPDX-License-Identifier: GPL-2.0-or-later
"""McaGridCoupler and McaTimeStepper as a script sees them: errors, several couplers, order of engines, threads, sleeping, changed bodies."""
import math
import os
import subprocess
import sys

import numpy as np
import pytest

from yade_mca._yade import scene as omega
from yade_mca.tasks import trials

D, PITCH = 1e-3, 0.5 * math.sqrt(3)


@pytest.fixture
def halves(plugin):
	def make(material=None, left=6 * PITCH, right=4, height=6, **options):
		return trials.halves(material or trials.elastic(), left, right, height, **options)

	return make


def message(run):
	with pytest.raises(RuntimeError) as e:
		run()
	return str(e.value)


def test_tiesTheRowAndHandsItsMassToTheNodes(halves):
	s = halves()
	before = s.grid.energies()
	omega().run(1, True)
	assert len(s.couplers[0].rowIds) == 7 and before['kinetic'] == 0
	assert np.allclose(np.sum(s.couplers[0].rowShares, axis=1), 1)
	mass = sum(omega().bodies[i].state.mass for i in s.couplers[0].rowIds)
	assert math.isclose(mass, 0.5 * s.facts['material'].density * PITCH * D * 6 * D, rel_tol=1e-12)


def test_errorsNameBodyAndDistanceAndNothingMoves(halves):
	s = halves(velocity=lambda x, y: (5 + 0 * x, 0 * x))
	on = [b.id for b in omega().bodies if abs(b.state.pos[0]) < 1e-9]
	b = omega().bodies[on[3]]
	good = b.state.pos
	b.state.pos = (-3e-5, good[1], 0)
	text = message(lambda: omega().run(1, True))
	assert 'body %d' % b.id in text and '3e-05 m' in text and "'grid'" in text, text
	assert s.grid.steps == 0 and abs(s.grid.view(0, 'x')[0, 0]) == 0
	b.state.pos = good
	s.automata.reload()
	omega().run(3, True)
	assert s.grid.steps == 3


def test_unlikeMaterialsAreRefusedUnlessAllowed(halves):
	s = halves()
	for b in omega().bodies:
		b.material.shearModulus *= 1.05
	text = message(lambda: omega().run(1, True))
	assert 'shearModulus' in text and 'otherMaterials' in text
	s.couplers[0].otherMaterials = True
	omega().run(1, True)


def test_orderOfEnginesIsChecked(halves):
	halves()
	a, b, c, d = omega().engines
	omega().engines = [a, d, b, c]
	assert 'must follow' in message(lambda: omega().run(1, True))


def test_gridEngineMissing(halves):
	s = halves()
	omega().engines = [s.facts['stepper'], s.automata, s.couplers[0]]
	assert 'no McaGridEngine' in message(lambda: omega().run(1, True))


@pytest.mark.parametrize('how', ['dead', 'left out'])
def test_aTiedRowNeedsItsCoupler(halves, how):
	"""Without it the row would keep the velocity it has; the scene goes on when the coupler is back."""
	s = halves(velocity=lambda x, y: (5 + 0 * x, 0 * x))
	omega().run(5, True)
	assert s.automata.coupled and s.grid.coupled
	whole = omega().engines
	if how == 'dead': s.couplers[0].dead = True
	else: omega().engines = [e for e in omega().engines if e != s.couplers[0]]
	assert 'Put the coupler back' in message(lambda: omega().run(5, True)) and s.grid.steps == 5
	s.couplers[0].dead, omega().engines = False, whole
	omega().run(5, True)
	assert s.grid.steps == 10


def test_tiedBodyCannotBeErased(halves):
	s = halves(velocity=lambda x, y: (5 + 0 * x, 0 * x))
	omega().run(3, True)
	omega().bodies.erase(s.couplers[0].rowIds[2])
	assert 'tied to a grid' in message(lambda: omega().run(1, True))


def test_otherBodiesCanBeErasedAndTheTieHolds(halves):
	s = halves(velocity=lambda x, y: (5 * np.cos(300 * x), 0 * x))
	omega().run(3, True)
	row = s.couplers[0].rowIds
	omega().bodies.erase(next(b.id for b in omega().bodies if b.state.pos[0] < -4 * D))
	omega().run(200, True)
	x = s.automata.field('x')[np.searchsorted(s.automata.ids, row)]
	assert abs(x - s.grid.view(0, 'x')[:, 0]).max() == 0


def test_stepperTakesTheSmallestAndGrowsSlowly(halves):
	s = halves()
	s.facts['stepper'].factor = 0.5
	omega().run(1, True)
	limits = s.automata.criticalTimeStep, s.grid.criticalTimeStep
	assert math.isclose(s.facts['stepper'].limit, min(limits)) and math.isclose(omega().dt, 0.5 * min(limits))
	s.facts['stepper'].largest = 0.1 * omega().dt
	omega().run(1, True)
	small = omega().dt
	s.facts['stepper'].largest = math.inf
	omega().run(1, True)
	assert math.isclose(omega().dt, 1.1 * small)
	s.facts['stepper'].factor = 1.5
	assert 'factor' in message(lambda: omega().run(1, True))


def test_tooLargeAStepIsRefusedBeforeAnythingMovesAndTheRunGoesOn(halves):
	s = halves(velocity=lambda x, y: (5 * np.cos(300 * x), 0 * x), account=True)
	trials.fixedStep(s, 1e-8)
	omega().run(5, True)
	e = s.couplers[0].energies()
	omega().dt = 1e-6
	for _ in range(2):
		assert 'largest' in message(lambda: omega().run(1, True))
	now = s.couplers[0].energies()
	assert all(now[k] == e[k] for k in e if k != 'total')  # forces are those of the new positions by now
	omega().dt = 1e-8
	omega().run(200, True)
	now = s.couplers[0].energies()
	assert abs(now['booked'] - e['booked']) < 1e-11 * e['kinetic']


def test_stableAtNearlyTheLimitOfBothSides(halves):
	"""The tied nodes need no smaller step than automata and grid alone."""
	for h in (1, 2):
		s = halves(height=8, h=h, velocity=lambda x, y: (np.where(x < 0, np.sin(9e4 * x + 5e4 * y), 0.) * 1e-3, np.cos(7e4 * y) * 1e-3), factor=0.95)
		omega().run(1, True)
		start = s.couplers[0].energies()['kinetic']
		omega().run(3000, True)
		assert s.couplers[0].energies()['kinetic'] < 3 * start


def test_sleepingWakesAcrossTheLineAndChangesNoBit(halves):
	results = []
	for sleeping in (True, False):
		# a pulse from the grid into automata at rest, and one from automata into the grid
		s = halves(left=40 * PITCH, right=60, height=8, velocity=lambda x, y: (np.exp(-((x / D - 40) / 4)**2) + np.exp(-((x / D + 25) / 4)**2), 0 * x), sleeping=sleeping)
		trials.fixedStep(s, 3e-8)
		omega().run(330, True)
		results.append((s.automata.field('vx').tobytes(), s.grid.view(0, 'vx').tobytes()))
		assert abs(s.automata.field('vx')[trials.nearest(s, -5, 4)]) > 1e-3
	assert results[0] == results[1]


def test_severalCouplersAndMomentum(plugin):
	from yade import O
	from yade_mca import materials, scenes
	s = scenes.tiedPlate(materials.mcaMat('4340'), 10e-3, 1e-3, automataWidth=20e-3, plateWidth=50e-3, ends='free')
	s.automata.account = True
	for b in O.bodies:
		b.state.vel = (40 * math.cos(100 * b.state.pos[0]), -60, 0)
	for k in s.blocks.values():
		s.grid.setVelocity(k, (0., -60.))
	O.run(1, True)
	first, left, right = s.couplers[0].energies(), *[c.rowIds for c in s.couplers]
	assert not set(left) & set(right) and len(left) == len(right) == 11
	O.run(1500, True)
	now = s.couplers[0].energies()
	assert abs(now['momentumX'] - first['momentumX']) < 1e-12 * abs(first['momentumY'])
	assert abs(now['momentumY'] - first['momentumY']) < 1e-12 * abs(first['momentumY'])
	assert abs(now['booked'] - first['booked']) < 1e-11 * first['kinetic']


THREADS = """
import sys; sys.path[:0] = %r
import numpy as np, yade_mca
from yade import O
from yade_mca import materials
from yade_mca.tasks.trials import halves
s = halves(materials.mcaMat('4340'), 40, 30, 40, velocity=lambda x, y: (200 * np.sin(90 * x + 50 * y), 100 * np.cos(70 * y)))
O.run(150, True)
import hashlib
print('digest', hashlib.sha1(s.automata.field('x').tobytes() + s.automata.field('plasticStrain').tobytes() + s.grid.view(0, 'x').tobytes() + s.grid.view(0, 'energy').tobytes()).hexdigest())
"""


def test_sameBitsOnAnyNumberOfThreads(plugin):
	out = set()
	for n in '1', '2', '3':
		r = subprocess.run(['/usr/bin/python3', '-c', THREADS % sys.path], capture_output=True, text=True, env=dict(os.environ, OMP_NUM_THREADS=n, MPLBACKEND='Agg'))
		assert r.returncode == 0, r.stderr
		out.add(r.stdout.split('digest')[1].split()[0])
	assert len(out) == 1
