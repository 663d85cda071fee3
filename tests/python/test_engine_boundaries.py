# SPDX-License-Identifier: GPL-2.0-or-later
"""McaEngine: fixed, driven and viscous boundaries, single blocked degrees of freedom, and what the account says of them."""
import numpy as np
import pytest

import engine_scene as scene
from engine_scene import D


def ends(ids):
	"""Left and right column of a block whose rows run along x."""
	x = scene.states(ids)[:, 0]
	return ids[x < x.min() + 0.6 * D], ids[x > x.max() - 0.6 * D]


def test_fixedBodiesStayAndTheirReactionIsBooked(plugin):
	from yade import O
	ids = scene.block(20, 6, velocity=(-20., 0.))
	left, _ = ends(ids)
	scene.blocked(left, 'xyzXYZ')
	for i in left.tolist():
		O.bodies[i].state.vel = (0, 0, 0)
	e = scene.engine(account=True)
	O.run(1, True)
	start, place = e.energies(), scene.states(left)
	O.run(600, True)
	now = e.energies()
	assert np.array_equal(scene.states(left), place)  # not a bit
	assert now['external'] == 0  # what stands still does no work
	assert now['impulseX'] > 0.2 * abs(start['momentumX'])
	assert now['momentumX'] - start['momentumX'] == pytest.approx(now['impulseX'] - start['impulseX'], rel=1e-12)
	assert abs(now['bookedError']) < 1e-12 * now['kineticStart']


def test_drivenBodiesKeepTheirVelocityAndTheirWorkIsBooked(plugin):
	from yade import O
	ids = scene.block(30, 6, constants=dict(scene.STEEL, viscosityLinear=0.25, viscosityQuadratic=1.2))
	left, right = ends(ids)
	scene.blocked(left, 'xyzXYZ')
	for i in left.tolist():
		O.bodies[i].state.vel = (50., 0, 0)
	x0 = scene.states(left)[:, 0]
	e = scene.engine(account=True)
	O.run(400, True)
	now = e.energies()
	assert np.array_equal(scene.states(left)[:, 2:], np.broadcast_to((50., 0., 0.), (len(left), 3)))
	assert scene.states(left)[:, 0] == pytest.approx(x0 + 50. * O.time, abs=1e-12 * D)
	assert scene.pick(e, right, 'vx').mean() > 20  # the wave has arrived
	assert now['external'] > 0.9 * (now['kinetic'] - now['kineticStart'])
	assert abs(now['bookedError']) < 1e-12 * now['kinetic']
	assert now['total'] == pytest.approx(now['kineticStart'], abs=5e-3 * now['kinetic'])


@pytest.mark.parametrize('dofs, held', [('x', [2]), ('y', [3]), ('Z', [4]), ('xy', [2, 3]), ('xyZ', [2, 3, 4]), ('', [])])
def test_eachBlockedDegreeOfFreedomAlone(plugin, dofs, held):
	"""One body inside a shaken block: what is blocked keeps its velocity to the bit, the rest moves."""
	from yade import O
	ids = scene.block(8, 8)
	rng = np.random.default_rng(3)
	for i in ids.tolist():
		O.bodies[i].state.vel = (*rng.normal(0, 5., 2), 0)
		O.bodies[i].state.angVel = (0, 0, rng.normal(0, 5e3))
	one = ids[len(ids) // 2]
	scene.blocked([one], 'zXY' + dofs)
	before = scene.states([one])[0]
	scene.engine()
	O.run(60, True)
	after = scene.states([one])[0]
	same = after == before
	assert same[held].all() and not same[[k for k in (2, 3, 4) if k not in held]].any()


def test_degreesOfFreedomCanBeBlockedAndFreedBetweenRuns(plugin):
	from yade import O
	ids = scene.block(8, 8, velocity=(3., 0.))
	scene.engine()
	O.run(10, True)
	scene.blocked(ids[:5], 'xyzXYZ')
	held = scene.states(ids[:5])[:, 2:]
	O.run(50, True)
	assert np.array_equal(scene.states(ids[:5])[:, 2:], held)
	for i in ids[5:].tolist():
		O.bodies[i].state.vel = (-3., 0, 0)
	scene.blocked(ids[:5], 'zXY')
	O.run(50, True)
	assert (abs(scene.states(ids[:5])[:, 2] - held[:, 0]) > 0.1).all()


def pulse(prepare):
	"""A P pulse runs along a bar in uniaxial strain towards its right end; energies when what came back would be on its way."""
	from yade import O
	O.reset()
	n = 80
	ids = scene.block(n, 6, rim='full')
	s = scene.states(ids)
	x, y = s[:, 0], s[:, 1]
	m = O.bodies[int(ids[0])].material
	scene.blocked(ids, 'yzXYZ')  # uniaxial strain
	v = 1e-2 * np.exp(-((x / D) / 6)**2)
	e = scene.engine(account=True, contacts=False)
	for i, vx, xi in zip(ids.tolist(), v, x):
		O.bodies[i].state.vel = (vx, 0, 0)
	prepare(e, ids[x > x.max() - 0.6 * D], ids[x < x.min() + 0.6 * D])
	O.run(1, True)
	start = e.energies()
	while O.time < 1.05 * n * D / m.cP:  # both halves of the pulse have reached an end and would be back in the middle
		O.run(20, True)
	now = e.energies()
	stored = lambda q: q['kinetic'] + q['volumetric'] + q['deviatoric']
	return stored(now) / stored(start), now


def test_viscousBoundaryLetsAWaveOut(plugin):
	"""Lysmer and Kuhlemeyer's boundary takes a P wave at normal incidence; free ends keep all of it."""

	def both(e, right, left):
		e.setViscous(right.tolist(), (1, 0))
		e.setViscous(left.tolist(), (-1, 0))

	left, now = pulse(both)
	kept, _ = pulse(lambda *a: None)
	assert kept > 0.99 and left < 0.01, (kept, left)
	assert now['boundary'] == pytest.approx(now['kineticStart'], rel=0.02)
	assert abs(now['bookedError']) < 1e-11 * now['kineticStart']
	half, _ = pulse(lambda e, right, left: e.setViscous(right.tolist(), (1, 0)))
	assert half == pytest.approx(0.5, abs=0.03)


@pytest.mark.parametrize('ids, normal, words', [([0, 1], (1, 1), ['setViscous', 'normal', '(1,0)']), ([0, 9999], (1, 0), ['no body 9999']), ([-1], (1, 0), ['no body -1'])])
def test_viscousBoundaryRefusals(plugin, ids, normal, words):
	scene.block(4, 4)
	e = scene.engine()
	with pytest.raises(RuntimeError) as error:
		e.setViscous(ids, normal)
	for w in words:
		assert w in str(error.value)


def test_viscousBoundaryNeedsAutomata(plugin):
	from yade import O, utils
	scene.block(4, 4)
	O.materials.append(utils.FrictMat())
	other = O.bodies.append(utils.sphere((1, 1, 0), D, material=O.materials[-1]))
	with pytest.raises(RuntimeError, match='body %d is no automaton' % other):
		scene.engine().setViscous([other], (1, 0))
