# SPDX-License-Identifier: GPL-2.0-or-later
"""Bodies whose outline runs through the centres of their outermost automata, by the user's road: load, pause, hit, and scripts that take them apart."""
import numpy as np
import pytest

D = 1e-3
ROADS = ['engine', 'law2']


def material(**changes):
	from yade_mca import materials
	hard = dict(yieldModel='linearHardening', yieldStress=0.8e9, hardeningModulus=0.5e9, fractureStrain=0.12, spallStrength=2.5e9)
	return materials.mcaMat('4340', **dict(hard, **changes))


def plate(nx=20, ny=8):
	from yade_mca import packings
	return packings.hexagonal(D, packings.Rectangle((0, 0), (nx * D, ny * D)), rim='triangles')


def bodies(velocity=(20., -200.)):
	"""A disc falls on a plate; ids of both."""
	from yade_mca import packings
	m = material()
	shot = packings.hexagonal(D, packings.disc((0, 8.2 * D), 3 * D), rim='triangles')
	return packings.addBodies(plate(), m), packings.addBodies(shot, m, velocity=velocity, mask=3)


def engines(road, dt=1.5e-8):
	from yade import O
	from yade.wrapper import McaEngine
	from yade_mca import scenes
	O.engines = [McaEngine(adaptive=False)] if road == 'engine' else scenes.law2Engines()
	O.dt = dt


def state(ids):
	from yade import O
	for e in O.engines:
		if type(e).__name__ == 'McaEngine': e.sync()
	return np.array([(*tuple(O.bodies[i].state.pos)[:2], *tuple(O.bodies[i].state.vel)[:2], O.bodies[i].state.pressure, O.bodies[i].state.links) for i in ids])


def refused(road):
	"""What the first step says."""
	from yade import O
	engines(road)
	with pytest.raises(RuntimeError) as e:
		O.run(1, True)
	return str(e.value)


@pytest.mark.parametrize('road', ROADS)
def test_loadAndPauseChangeNothing(plugin, road, tmp_path):
	from yade import O
	both = sum(bodies(), [])
	engines(road)
	O.run(300, True)
	O.save(str(tmp_path / 'half.yade.gz'))
	for _ in range(300): O.step()
	whole = state(both)
	O.load(str(tmp_path / 'half.yade.gz'))
	O.run(300, True)
	assert np.array_equal(state(both), whole)


@pytest.mark.parametrize('road', ROADS)
def test_hitAfterAWhileIsAHit(plugin, road):
	from yade import O
	plateIds, shot = bodies(velocity=(0., 0.))
	engines(road)
	O.run(20, True)
	for i in shot: O.bodies[i].state.vel = (20, -200, 0)
	O.run(700, True)
	v = state(plateIds)[:, 3].mean()
	assert v < -1 and state(shot)[:, 3].mean() > -200


def test_bodiesKnowTheirTriangles(plugin):
	from yade import O
	from yade_mca import packings
	p = plate()
	ids = packings.addBodies(p, material())
	assert [O.bodies[i].state.triangles for i in ids] == np.round(6 * p.weight).astype(int).tolist()
	packings.resetStates(ids)
	assert not any(O.bodies[i].state.triangles for i in ids)
	other = packings.addBodies(packings.hexagonal(D, packings.Rectangle((0, 1), (5 * D, 5 * D))), material())
	assert not any(O.bodies[i].state.triangles for i in other)


@pytest.mark.parametrize('road', ROADS)
def test_aPartOfAPackingIsRefused(plugin, road):
	from yade_mca import packings
	p = plate()
	packings.addBodies(p.select(p.positions[:, 1] > 0), material())
	said = refused(road)
	assert 'its neighbours make' in said and 'Take packings whole' in said


@pytest.mark.parametrize('road', ROADS)
def test_twoPartsThatAreLinkedAreOneBody(plugin, road):
	"""Of two materials."""
	from yade import O
	from yade_mca import packings
	p = plate()
	for which in (p.positions[:, 1] > 0, p.positions[:, 1] <= 0): packings.addBodies(p.select(which), material())
	engines(road)
	O.run(5, True)


@pytest.mark.parametrize('road', ROADS)
def test_twoBodiesThatAreLinkedByMistakeAreRefused(plugin, road):
	"""A spacing apart, with one mask."""
	from yade_mca import packings
	p = plate()
	height = np.ptp(p.positions[:, 1])
	packings.addBodies(p, material())
	packings.addBodies(p.translated((0., height + 0.866 * D)), material())
	assert 'give each body a mask of its own' in refused(road)


@pytest.mark.parametrize('road', ROADS)
def test_anotherDensityIsRefused(plugin, road):
	from yade import O
	from yade_mca import packings
	ids = packings.addBodies(plate(), material())
	O.bodies[ids[0]].material.density *= 1.01
	assert 'density' in refused(road)


@pytest.mark.parametrize('road', ROADS)
def test_trianglesAreReadOnce(plugin, road):
	from yade import O
	from yade_mca import packings
	ids = packings.addBodies(plate(), material())
	engines(road)
	O.run(2, True)
	was = O.bodies[ids[0]].state.triangles
	O.bodies[ids[0]].state.triangles = 4
	with pytest.raises(RuntimeError, match='state.triangles = 4 was changed'):
		O.run(1, True)
	O.bodies[ids[0]].state.triangles = was
	O.run(1, True)


@pytest.mark.parametrize('road', ROADS)
def test_erasedBodyLeavesAnOrdinarySurface(plugin, road):
	"""And comes back: momentum of the rest is kept, nothing is strained."""
	from yade import O
	from yade_mca import packings
	p = plate()
	ids = packings.addBodies(p, material())
	engines(road)
	O.run(2, True)
	i = int(np.argmin(np.hypot(*(p.positions - (0, p.positions[:, 1].min())).T)))
	O.bodies.erase(ids[i])
	O.run(2, True)
	packings.addBodies(p.select([i]), material())
	O.run(2, True)
	now = state(j for k, j in enumerate(ids) if k != i)
	assert abs(now[:, 4]).max() < 1e-3 and abs(now[:, 2:4]).max() < 1e-9
