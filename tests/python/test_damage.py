# SPDX-License-Identifier: GPL-2.0-or-later
"""Damage by plastic flow (11e): against the integral over the history of an automaton, breaking, save and load, refusals. Both roads: test_law2, test_law2_space."""
import math

import law2_scene
import law2_space_scene
import numpy as np
import pytest
from yade_mca import materials, packings, scenes
from yade_mca.materials import MaterialError

D, DT = 1e-3, 1.5e-8
METAL = dict(damageModel='johnsonCook', strengthSpread=0)


def fields(dimension):
	return packings.hexagonal(D, packings.Rectangle((0, 0), (10 * D, 10 * D))) if dimension == 2 else packings.fcc(D, packings.Box((0, 0, 0), (6 * D, 6 * D, 6 * D)))


def driven(dimension, rate, road='engine', **metal):
	"""A block that is driven along y at a constant rate of strain [1/s], held across; returns the body in its middle."""
	from yade import O
	O.reset()
	p = fields(dimension)
	m = materials.mcaMat('4340', **dict(METAL, **metal))
	ids = packings.addBodies(p, m)
	for i in ids:
		s = O.bodies[i].state
		s.vel = (0, rate * s.pos[1], 0)
		s.blockedDOFs = 'xyzXYZ'
	if dimension == 2: law2_scene.engines(road, DT)
	else: law2_space_scene.engines(road, DT)
	x = np.array([O.bodies[i].state.pos for i in ids])
	return O.bodies[ids[int(np.argmin(((x - x.mean(axis=0))**2).sum(axis=1)))]]


@pytest.mark.parametrize('road', ['engine', 'law2'])
@pytest.mark.parametrize('rate', [-2e5, 2e4])
@pytest.mark.parametrize('dimension', [2, 3])
def test_damageIsTheIntegralOverTheHistory(plugin, dimension, rate, road):
	"""Compression and tension: the sum over the steps by materials.johnsonCookFractureStrain(), the library's own function of the same law."""
	from yade import O
	b, metal = driven(dimension, rate, road), materials.get('4340')
	total, before, seen = 0., 0., 0
	for _ in range(120):
		O.step()
		s = b.state
		flow, before = s.plasticStrain - before, s.plasticStrain
		if flow > 0:
			total += flow / metal.johnsonCookFractureStrain(-s.pressure / s.equivalentStress, flow / DT, s.temperature)
			seen += 1
		assert s.damage == pytest.approx(total, rel=1e-9, abs=1e-15)
	assert seen > 50 and 1e-6 < total
	if road == 'engine': assert O.engines[0].field('damage').max() >= b.state.damage > 0


def test_pressureDefersFracture(plugin):
	"""The same plastic strain by compression damages by a small part of what tension does."""
	from yade import O
	found = []
	for rate in -2e5, 2e5:
		b = driven(3, rate, shearModulus=20e9)
		while b.state.plasticStrain < 0.02: O.run(5, True)
		found.append(b.state.damage / b.state.plasticStrain)
	assert found[0] < 0.1 * found[1]


@pytest.mark.parametrize('dimension', [2, 3])
def test_linksBreakAtOne(plugin, dimension):
	from yade import O
	b = driven(dimension, 2e5)
	e = O.engines[0]
	for _ in range(2000):
		damage = e.field('damage').max()
		O.run(4, True)
		if e.counters()['brokenLinks']: break
		assert damage < 1 + 0.1
	assert e.counters()['brokenLinks'] and e.field('damage').max() >= 1


def test_damageFromBeforeCountsAndCanBeSet(plugin):
	from yade import O
	b = driven(2, 1e3)
	b.state.damage = 0.4
	O.run(3, True)
	assert b.state.damage == 0.4 and (O.engines[0].field('damage') > 0).sum() == 1  # nothing flows yet
	for other in O.bodies: other.state.damage = 1.5
	O.run(8, True)
	assert O.engines[0].counters()['brokenLinks'] > 100


def test_saveAndLoadGoOnWithTheSameBits(plugin, tmp_path):
	from yade import O
	driven(2, 1e5)
	O.run(100, True)
	file = str(tmp_path / 'damaged.yade')
	O.save(file)
	O.run(100, True)
	one = O.engines[0].field('damage')
	O.load(file)
	assert O.bodies[3].state.damage > 0
	O.run(100, True)
	assert one.max() > 0 and (O.engines[0].field('damage') == one).all()


def test_erasingOthersKeepsDamage(plugin):
	from yade import O
	b = driven(2, 1e5)
	O.run(100, True)
	damage = b.state.damage
	O.bodies.erase(0)
	O.engines[0].dt = O.dt
	O.run(1, True)
	assert b.state.damage >= damage > 0


def test_whatMeansNothingIsRefused(plugin):
	from yade import O
	b = driven(2, 1e3, damageModel='none')
	O.run(1, True)
	assert (O.engines[0].field('damage') == 0).all()
	b.state.damage = 0.1
	with pytest.raises(RuntimeError, match="body %d: state.damage = 0.1 has no meaning: the damageModel of its material is 'none'" % b.id):
		O.run(1, True)
	b.state.damage = 0
	O.run(1, True)
	for bad in -0.1, math.nan, math.inf:
		b = driven(2, 1e3)
		b.state.damage = bad
		with pytest.raises(RuntimeError, match='body %d: state.damage = .* must be from 0 to 1e' % b.id): O.run(1, True)
	b = driven(2, 1e3)
	b.material.damageModel = 'johnson'
	with pytest.raises(RuntimeError, match="damageModel = 'johnson' is unknown; it must be one of 'none', 'johnsonCook'"): O.run(1, True)
	for name, value in (('damageD2', -1.), ('damageD4', -0.5), ('damageD5', -1.), ('damageD1', math.nan), ('damageD1', -10.)):
		b = driven(2, 1e3)
		setattr(b.material, name, value)
		with pytest.raises(RuntimeError, match=name): O.run(1, True)


def test_libraryAndScenes(plugin):
	with pytest.raises(MaterialError, match="'Ta' has no constants of damageModel 'johnsonCook' in the library; give damageD1"):
		materials.get('Ta', yieldModel='perfect', damageModel='johnsonCook')
	with pytest.raises(MaterialError, match="damageModel = 'JC' must be one of none, johnsonCook"): materials.get('4340', damageModel='JC')
	with pytest.raises(scenes.SceneError, match="damageModel 'JC' is not one of none, johnsonCook"): scenes.penetration(damageModel='JC')
	m = materials.get('Al6061_T6')
	assert m.damageModel == 'none' and m.damageD1 == -0.77
	assert m.johnsonCookFractureStrain(3.) == 1e-6  # the constants give less than nothing there
