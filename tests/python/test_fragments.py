# SPDX-License-Identifier: GPL-2.0-or-later
"""Fragments: connected by links; mass, place, velocity, shape; distributions; pictures and ParaView files."""
import math

import engine_scene
import numpy as np
import pytest
from engine_scene import D
from yade_mca import cracks, materials, measure, packings, plots


def test_byHand():
	"""A row of four, a pair and a single one, in an order of ids that is not sorted."""
	ids = np.array([7, 3, 10, 2, 5, 11, 4])
	x = np.array([(0, 0), (1, 0), (2, 0), (3, 0), (10, 1), (10, 2), (20, 5.)])
	v = np.array([(1, 0), (1, 0), (1, 0), (5, 0), (0, 2), (0, 4), (7, 7.)])
	m = np.array([1, 1, 1, 1, 3, 1, 0.5])
	f = measure.fragments(ids, [(7, 3), (3, 10), (10, 2), (5, 11)], m, x, v, np.full(7, math.pi / 4))
	assert f.label.tolist() == [0, 0, 0, 0, 1, 1, 2] and f.count.tolist() == [4, 2, 1] and f.mass.tolist() == [4, 4, 0.5]
	assert f.position == pytest.approx(np.array([(1.5, 0), (10, 1.25), (20, 5)])) and f.velocity == pytest.approx(np.array([(2, 0), (0, 2.5), (7, 7)]))
	assert f.size == pytest.approx((2, math.sqrt(2), 1))  # discs of the same area
	assert f.elongation[0] == pytest.approx(math.sqrt((1.25 + 1 / 16) * 16)) and f.elongation[2] == pytest.approx(1)
	shuffled = np.random.default_rng(1).permutation(7)
	g = measure.fragments(ids[shuffled], [(3, 7), (10, 3), (2, 10), (11, 5)], m[shuffled], x[shuffled], v[shuffled], np.full(7, math.pi / 4))
	assert sorted(g.mass.tolist()) == sorted(f.mass.tolist()) and g.position[g.label] == pytest.approx(f.position[f.label][shuffled])


def test_chainsConnectOnlyWhereAsked():
	"""Two rhombs of four, and a chain of one automaton between them."""
	x = np.array([(0, 0), (1, 0), (0.5, 0.9), (1.5, 0.9), (2.5, 0.9), (3.5, 0.9), (4.5, 0.9), (4, 0), (5, 0)])
	links = [(0, 1), (0, 2), (1, 2), (1, 3), (2, 3), (3, 4), (4, 5), (5, 6), (5, 7), (6, 7), (6, 8), (7, 8)]
	good = dict(ids=np.arange(9), links=links, mass=np.ones(9), positions=x, velocity=0 * x, volume=np.ones(9))
	assert measure.fragments(**good).count.tolist() == [9]
	apart = measure.fragments(**good, chains=False)
	assert apart.count.tolist() == [3, 3, 1, 1, 1] and {tuple(sorted(np.flatnonzero(apart.label == k))) for k in (0, 1)} == {(1, 2, 3), (5, 6, 7)}
	with pytest.raises(ValueError, match='chains must be True or False'):
		measure.fragments(**good, chains=1)


def test_refusals():
	x = np.zeros((2, 2))
	good = dict(ids=[0, 1], links=[(0, 1)], mass=[1, 1], positions=x, velocity=x, volume=[1, 1])
	assert measure.fragments(**good).count.tolist() == [2]
	for bad, word in ((dict(links=[(0, 5)]), 'not in ids'), (dict(ids=[1, 1]), 'different'), (dict(mass=[1, 0]), 'above 0'), (dict(volume=[1]), 'volume'), (dict(velocity=np.zeros((2, 3))), 'velocity')):
		with pytest.raises(ValueError, match=word):
			measure.fragments(**dict(good, **bad))


@pytest.mark.parametrize('dimension', (2, 3))
def test_ofAnEngine(plugin, tmp_path, dimension):
	"""A block cut in two unequal parts, and a ball apart: three fragments, whose masses and momenta are those of the bodies; two for who flies in the same way."""
	from yade import O
	O.reset()
	m = materials.mcaMat('4340', **engine_scene.STEEL)
	if dimension == 2:
		block, ball = packings.hexagonal(D, packings.Rectangle((0, 0), (12 * D, 6 * D)), rim='full'), packings.hexagonal(D, packings.disc((0, 20 * D), 2.2 * D))
		where = ((2.2 * D, -9 * D), (2.2 * D, 9 * D))
	else:
		block, ball = packings.fcc(D, packings.Box((-6 * D, 0, 0), (6 * D, 4 * D, 4 * D))), packings.fcc(D, packings.Ball((0, 20 * D, 0), 2.2 * D))
		where = [(2.2 * D, y, z) for y, z in ((-9 * D, -9 * D), (9 * D, -9 * D), (9 * D, 9 * D), (-9 * D, 9 * D))]
	packings.addBodies(block, m)
	packings.addBodies(ball, m, velocity=(3, -100) if dimension == 2 else (3, -100, 5), mask=2)
	e = engine_scene.engine(1e-9)
	cracks.cut(e, where)
	O.run(2, True)
	f = measure.fragmentsOf(e)
	assert len(f.mass) == 3 and f.count.sum() == e.count and f.mass.sum() == pytest.approx(sum(b.state.mass for b in O.bodies))
	assert f.velocity[abs(f.velocity[:, 1]) > 50] == pytest.approx(np.array([(3, -100, 5)[:dimension]]))
	volume = f.size**2 * math.pi / 4 if dimension == 2 else f.size**3 * math.pi / 6
	assert volume == pytest.approx(f.mass / m.density, rel=1e-9)
	assert f.elongation[np.argmin(abs(f.position[:, 1] - 20 * D))] < 1.1 < f.elongation[0]
	plots.fragmentMasses(str(tmp_path / 'f.png'), {'this': f}, skip=0)
	assert (tmp_path / 'f.png').stat().st_size > 5000
	with pytest.raises(ValueError, match='leaves no fragment'):
		plots.fragmentMasses(str(tmp_path / 'f.png'), f, skip=3)


def test_distributions():
	mass, number = measure.cumulative([3., 1, 2])
	assert mass.tolist() == [1, 2, 3] and number.tolist() == [3, 2, 1]
	m = np.linspace(0, 300, 600001)
	for law in measure.mott, measure.gradyKipp:
		n = law(m, 100, 1.5)
		assert n[0] == 100 and (n[:-1] - n[1:]) @ (0.5 * (m[:-1] + m[1:])) / 100 == pytest.approx(1.5, rel=2e-3)  # its mean
