# SPDX-License-Identifier: GPL-2.0-or-later
"""McaEngine: bodies moved, added and erased by the script between steps."""
import numpy as np
import pytest

import engine_scene as scene
from engine_scene import D


def stretched(e, ids, h=1e-4):
	"""Moves all bodies to (1 + h) x at once, before the first step of a new run."""
	from yade import O
	for i in np.asarray(ids).tolist():
		s = O.bodies[i].state
		s.pos = ((1 + h) * s.pos[0], s.pos[1], 0)


def test_aMovedBodyIsTakenOverWithoutStrainOfThePair(plugin):
	"""Positions count for the volume, which is a state function; the deviator grows by motion alone, so that a body may be put elsewhere."""
	from yade import O
	ids = scene.block(10, 10, rim='full')
	m = O.bodies[int(ids[0])].material
	K = m.density * m.bulkSoundSpeed**2
	e = scene.engine(1e-12)
	O.run(2, True)
	stretched(e, ids)
	O.run(1, True)
	p = e.field('pressure')
	inside = e.field('links') == 6
	assert p[inside] == pytest.approx(-K * 1e-4, rel=1e-6) and e.field('equivalentStress').max() < 1e-3 * abs(p).max()


def test_changesAreSeenAfterARunOrAtOnceByReload(plugin):
	from yade import O
	ids = scene.block(6, 6)
	e = scene.engine(1e-8)
	O.run(3, True)
	for i in ids.tolist():
		O.bodies[i].state.vel = (7., 0, 0)
	O.run(2, True)
	assert e.field('vx') == pytest.approx(7., abs=1e-9)
	O.step()
	for i in ids.tolist():
		O.bodies[i].state.angVel = (0, 0, 5.)
	e.reload()
	O.step()
	e.sync()
	assert e.field('omega').max() > 4


def test_wholeBodyMovedElsewhereMeetsAnotherThere(plugin):
	"""A block is put next to another one and flies into it: contacts are searched anew, momentum is kept."""
	from yade import O
	a = scene.block(6, 6)
	b = scene.block(6, 6, at=(40e-3, 0), mask=3)
	e = scene.engine(account=True)
	O.run(5, True)
	for i in b.tolist():
		s = O.bodies[i].state
		s.pos, s.vel = (s.pos[0] - 33.2e-3, s.pos[1], 0), (-80., 0, 0)
	O.run(1, True)
	start = e.energies()
	O.run(400, True)
	now = e.energies()
	assert e.counters()['contacts'] > 0 and scene.pick(e, a, 'vx').mean() < -10
	assert abs(now['momentumX'] - start['momentumX']) < 1e-12 * abs(start['momentumX'])


def test_erasedBodiesLeaveTheOthersGoingOn(plugin):
	from yade import O
	ids = scene.block(10, 10, constants=scene.HARD, velocity=(5., 0.))
	for i in ids[::3].tolist():
		O.bodies[i].state.vel = (60., 30., 0)
	e = scene.engine(2e-8, account=True)
	O.run(60, True)
	x, y = scene.pick(e, ids, 'x'), scene.pick(e, ids, 'y')
	gone = np.zeros(len(ids), bool)
	gone[np.hypot(x, y) < 1.7 * D] = True
	rest = ids[~gone]
	before = {k: scene.pick(e, rest, k) for k in ('x', 'vx', 'plasticStrain', 'strength')}
	links = {l for l in e.links() if not set(l) & set(ids[gone].tolist())}
	for i in ids[gone].tolist():
		O.bodies.erase(i)
	e.reload()
	O.step()
	e.sync()
	assert e.count == len(rest) and np.array_equal(e.ids, np.sort(rest))
	assert np.array_equal(scene.pick(e, rest, 'strength'), before['strength'])
	assert scene.pick(e, rest, 'x') == pytest.approx(before['x'], abs=1e-3 * D)
	assert scene.pick(e, rest, 'vx') == pytest.approx(before['vx'], abs=20)
	assert (scene.pick(e, rest, 'plasticStrain') >= before['plasticStrain']).all()
	assert set(e.links()) <= links  # a new surface links nothing
	start = e.energies()
	O.run(100, True)
	now = e.energies()
	scale = abs(start['momentumX'])
	assert abs(now['momentumX'] - start['momentumX']) < 1e-12 * scale and np.isfinite(e.field('x')).all()


def test_erasedAndAddedAgainLinksInItsPlace(plugin):
	from yade import O
	from yade_mca import materials, packings
	p = packings.hexagonal(D, packings.Rectangle((0, 0), (8 * D, 8 * D)), rim='full')
	m = materials.mcaMat('4340', **scene.STEEL)
	ids = np.array(packings.addBodies(p, m))
	e = scene.engine(1e-8)
	O.run(5, True)
	all = len(e.links())
	k = int(np.argmin(np.hypot(*p.positions.T)))
	O.bodies.erase(int(ids[k]))
	O.run(5, True)
	assert len(e.links()) == all - 6 and (scene.pick(e, np.delete(ids, k), 'pressure') == 0).all()
	which = np.zeros(len(p), bool)
	which[k] = True
	new = packings.addBodies(p.select(which), m)
	O.run(5, True)
	assert len(e.links()) == all and scene.pick(e, new, 'links')[0] == 6
	assert abs(e.field('pressure')).max() < 1 and abs(e.field('vx')).max() < 1e-9


def test_anotherBodyAddedInFlight(plugin):
	from yade import O
	a = scene.block(8, 8)
	e = scene.engine(account=True)
	O.run(20, True)
	b = scene.block(4, 4, at=(-6.6e-3, 0), mask=2, velocity=(100., 0.))
	O.run(1, True)
	start = e.energies()
	O.run(300, True)
	now = e.energies()
	assert e.count == len(a) + len(b) and e.counters()['contacts'] > 0
	assert start['momentumX'] == pytest.approx(100 * scene.pick(e, b, 'mass').sum(), rel=1e-9)
	assert abs(now['momentumX'] - start['momentumX']) < 1e-12 * start['momentumX'] and scene.pick(e, a, 'vx').mean() > 5


def test_viscousBoundarySurvivesErasingAndLoading(plugin):
	"""The boundary belongs to the bodies: neither a saved file nor a body erased elsewhere loses it."""
	from yade import O
	ids = scene.block(20, 6, velocity=(10., 0.))
	x = scene.states(ids)[:, 0]
	e = scene.engine(account=True)
	e.setViscous(ids[x > x.max() - 0.6 * D].tolist(), (1, 0))
	O.run(20, True)
	O.saveTmp()
	O.loadTmp()
	e = O.engines[0]
	O.run(5, True)
	before = e.energies()['boundary']
	O.bodies.erase(int(ids[np.argmin(x)]))
	O.run(20, True)
	assert e.energies()['boundary'] > before > 0


def test_everythingErased(plugin):
	from yade import O
	ids = scene.block(4, 4)
	e = scene.engine(1e-8)
	O.run(5, True)
	for i in ids.tolist():
		O.bodies.erase(i)
	O.run(5, True)
	assert e.count == 0 and e.energies()['kinetic'] == 0
	scene.block(4, 4, velocity=(1., 0))
	O.run(5, True)
	assert e.count == len(ids) and e.field('vx') == pytest.approx(1.)
