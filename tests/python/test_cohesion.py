# SPDX-License-Identifier: GPL-2.0-or-later
"""fractureEnergy: broken pairs that hold together until the energy of their crack is spent, (11f) to (11h). Both roads, plane and space, files, changes, refusals."""
import math

import engine_scene
import law2_scene
import numpy as np
import pytest
from yade_mca import cracks, materials, packings

D, DT = 1e-3, 2e-8
ENERGY = 5e3  # [J/m2]
AREA = D / math.sqrt(3)  # of a pair in the plane [m]
FACETS = 2 / math.sqrt(3)
CUT = cracks.CAUSES.index('cut')


def metal(**constants):
	return materials.mcaMat('4340', **dict(dict(yieldModel='elastic', eos='linear', pairStrength=6e8, fractureEnergy=ENERGY, viscosityLinear=0.5), **constants))


def halves(speed=20., n=8, **constants):
	"""A block whose halves fly apart, faster on the right. Returns the ids by place in the packing."""
	from yade import O
	p = packings.hexagonal(D, packings.Rectangle((0, 0), (n * D, n * D)))
	ids = packings.addBodies(p, metal(**constants))
	for i, (x, y) in zip(ids, p.positions):
		O.bodies[i].state.vel = (0.05 * speed * math.sin(3e3 * x), math.copysign(speed * (1 + 0.15 * x / D), y - 0.1 * D), 0)
	return ids


def opened(road='engine', steps=120, dt=3e-8, **constants):
	"""halves() by one of both roads, with pairs that hold together."""
	from yade import O
	O.reset()
	ids = halves(**constants)
	law2_scene.engines(road, dt)
	if road == 'engine': O.engines[0].account = True
	O.run(steps, True)
	return ids


def pairs(table):
	return list(zip(np.minimum(table['id1'], table['id2']).tolist(), np.maximum(table['id1'], table['id2']).tolist()))


def bonds():
	"""Interactions of YADE that hold together."""
	from yade import O
	return {(min(i.id1, i.id2), max(i.id1, i.id2)): i.phys for i in O.interactions if getattr(i.phys, 'bondLast', 0) > 0}


def test_aCrackGrowsAtTheFractureEnergy(plugin):
	"""A strip with a cut along the rows is opened slowly. Its energy release rate, M u^2/h with the opening 2u and the height 2h, is the fracture energy when the crack starts to grow."""
	from yade import O
	from yade_mca import McaEngine, McaTimeStepper
	toughness, time = 20e6, 100e-6
	m0 = materials.get('4340')
	energy = toughness**2 * (1 - m0.poisson**2) / m0.young
	modulus = m0.bulkModulus + 4 / 3 * m0.shearModulus
	L, H = 40 * D, 12 * D
	p = packings.hexagonal(D, packings.Rectangle((0, 0), (L, H)), rim='triangles')
	ids = np.array(packings.addBodies(p, metal(pairStrength=4e8, fractureEnergy=energy, viscosityLinear=0.25)))
	y = p.positions[:, 1]
	e = McaEngine(account=True, damping=0.05)
	O.engines = [McaTimeStepper(factor=0.4), e]
	rows = np.unique(np.round(y, 9))
	line, h = 0.5 * (rows[rows <= 1e-9].max() + rows[rows > 1e-9].min()), 0.5 * np.ptp(y)
	cracks.cut(e, ((-L, line), (-0.1 * L, line)))
	speed = 1.3 * math.sqrt(energy * h / modulus) / time
	for side, sign in (y < y.min() + 0.6 * D, -1), (y > y.max() - 0.6 * D, 1): e.prescribe(ids[side].tolist(), x=0., y=((0, 20e-6), (0, sign * speed)))
	parted = []
	while not parted and O.time < 1.5 * time:
		O.run(60, True)
		b, open_ = e.brokenLinks(), set(pairs(e.cohesivePairs()))
		parted = [q for q, cause in zip(pairs(b), b['cause']) if cause != CUT and q not in open_]
	assert len(open_) > 3  # the zone ahead of the tip
	rate = modulus * (speed * (O.time - 10e-6))**2 / h
	assert rate == pytest.approx(energy, rel=0.08)
	spent = len(parted) + e.cohesivePairs()['spent'].sum()
	# what pairs held of their pull at the break is not taken from the volumes, which keep it
	assert 0.7 < e.energies()['fracture'] / (spent * energy * AREA / FACETS) < 1.02
	assert abs(b['y'][[q in parted for q in pairs(b)]] - line).max() < 0.6 * D


def test_pullStopClose(plugin):
	"""Opened, held, pressed together: less pull on the way back along a straight line, then the push of a body that has never broken; nothing more is spent."""
	from yade import O
	from yade_mca import McaEngine, McaTimeStepper
	found = {}
	for strength in 6e8, math.inf:
		O.reset()
		p = packings.hexagonal(D, packings.Rectangle((0, 0), (6 * D, 6 * D)), rim='triangles')
		ids = np.array(packings.addBodies(p, metal(pairStrength=strength, viscosityLinear=0.3, frictionAngle=0.2)))
		y = p.positions[:, 1]
		e = McaEngine(account=True, damping=0.1)
		O.engines = [McaTimeStepper(factor=0.4), e]
		top = ids[y > y.max() - 0.6 * D]
		e.prescribe(top.tolist(), x=0., y=((0, 2e-6, 6e-6, 8e-6, 10e-6, 18e-6, 20e-6), (0, 3., 3., 0, -3., -3., 0)))
		e.prescribe(ids[y < y.min() + 0.6 * D].tolist(), x=0., y=0.)
		rows = []
		while O.time < 40e-6:
			O.run(20, True)
			c = e.cohesivePairs()
			rows.append((O.time, engine_scene.pick(e, top, 'fy').sum(), e.energies()['fracture'], c['opening'].max(initial=0.), c['spent'].sum()))
		found[strength] = np.array(rows), len(c['spent'])
	(t, force, fracture, opening, spent), number = found[6e8][0].T, found[6e8][1]
	whole = found[math.inf][0][:, 1]
	held, closed, pressed = (abs(t - when).argmin() for when in (9e-6, 15e-6, 39e-6))
	assert number > 5 and whole[held] < 1.05 * force[held] < 0  # a broken body pulls less
	assert opening[held] > 3e-6 and opening[closed] < 0.1 * opening[held]
	assert abs(force[closed]) < 0.05 * abs(force[held])  # no pull left over
	assert force[pressed] == pytest.approx(whole[pressed], rel=0.05)
	assert fracture[-1] == pytest.approx(fracture[held], rel=1e-6) and spent[-1] == spent[held]
	assert 0 < fracture[-1] < 1.02 * spent[-1] * ENERGY * AREA / FACETS


def test_whatCohesivePairsShow(plugin):
	from yade import O
	ids = opened(steps=60, fractureEnergy=1e3, pairStrength=3e8, speed=8.)
	e = O.engines[0]
	c = e.cohesivePairs()
	assert sorted(c) == ['id1', 'id2', 'opening', 'spent'] and len({len(v) for v in c.values()}) == 1 and len(c['id1']) > 5
	assert c['id1'].dtype.kind == 'i' and c['opening'].dtype.kind == 'f'
	assert (c['opening'] > 0).all() and (c['spent'] >= 0).all() and (c['spent'] < 1).all() and c['spent'].max() > 0.05
	b = pairs(e.brokenLinks())
	assert [q for q in b if q in set(pairs(c))] == pairs(c)  # in the order in which they broke
	assert not set(pairs(c)) & set(e.links())
	place = dict(zip(ids, engine_scene.states(ids)))
	apart = np.array([math.dist(place[i][:2], place[j][:2]) for i, j in pairs(c)])
	assert (c['opening'] < apart - D + 0.1 * D).all()
	before = set(pairs(c))
	O.run(2000, True)
	gone = before - set(pairs(e.cohesivePairs()))
	assert len(gone) > 2 and gone <= set(pairs(e.brokenLinks())) and e.energies()['fracture'] > 0


@pytest.mark.parametrize('name', ('torn.yade', 'torn.yade.gz'))
def test_throughAFile(plugin, tmp_path, name):
	from yade import O
	ids = opened()
	e = O.engines[0]
	c = e.cohesivePairs()
	assert len(c['id1']) > 5
	O.save(str(tmp_path / name))
	O.run(150, True)
	one, later = engine_scene.digest(e), e.cohesivePairs()
	O.load(str(tmp_path / name))
	e = O.engines[0]
	for k, v in e.cohesivePairs().items(): assert np.array_equal(v, c[k]), k
	O.run(150, True)
	assert engine_scene.digest(e) == one and len(ids) == len(e.ids)
	for k, v in e.cohesivePairs().items(): assert np.array_equal(v, later[k]), k


def test_erasedAutomataTakeTheirPairsAlong(plugin):
	from yade import O
	opened()
	e = O.engines[0]
	before = pairs(e.cohesivePairs())
	gone = before[len(before) // 2]
	for i in gone: O.bodies.erase(i)
	O.run(1, True)
	left = pairs(e.cohesivePairs())
	assert left and not {i for q in left for i in q} & set(gone)
	assert set(q for q in before if not set(q) & set(gone)) <= set(left)
	O.run(200, True)
	a = e.energies()
	assert a['total'] == pytest.approx(a['kineticStart'], rel=0.03)


def test_cutLeavesNone(plugin):
	from yade import O
	O.reset()
	halves(speed=1.)
	e = engine_scene.engine(3e-8)
	n = cracks.cut(e, ((-1, 0.31 * D), (1, 0.31 * D)))
	O.run(60, True)
	assert e.counters()['brokenLinks'] == n > 5 and len(e.cohesivePairs()['id1']) == 0


@pytest.mark.parametrize('road', ('engine', 'law2'))
@pytest.mark.parametrize('value, why', [(-1., 'fractureEnergy'), (math.nan, 'fractureEnergy'), (math.inf, 'fractureEnergy'), (100., 'pairStrength = 6e\\+08.*Remedy: a diameter of at most')])
def test_refused(plugin, road, value, why):
	from yade import O
	O.reset()
	ids = halves()
	O.bodies[int(ids[0])].material.fractureEnergy = value
	law2_scene.engines(road, 3e-8)
	with pytest.raises(Exception, match=why): O.run(2, True)


def test_refusedAsWords(plugin):
	m = metal()
	for wrong in 'much', None, (1., 2.):
		with pytest.raises(Exception): m.fractureEnergy = wrong


@pytest.mark.parametrize('road', ('engine', 'law2'))
def test_aChangedMaterialCountsForPairsThatBreakLater(plugin, road):
	from yade import O
	ids = opened(road, steps=40)
	b = bonds() if road == 'law2' else dict.fromkeys(pairs(O.engines[0].cohesivePairs()))
	assert b
	O.bodies[int(ids[0])].material.fractureEnergy = 0.
	O.run(60, True)
	e = O.engines[0] if road == 'engine' else law2_scene.density()
	after = set(bonds()) if road == 'law2' else set(pairs(e.cohesivePairs()))
	assert after and after <= set(b)
	assert e.counters()['brokenLinks'] > len(b)


@pytest.mark.parametrize('orientation, share', [(((1, -1, 0), (1, 1, 1)), 1.), (((1, 0, 0), (0, 1, 0)), 2 / math.sqrt(3))])
def test_inSpace(plugin, orientation, share):
	"""Two halves of a bar in space fly apart along the plane in between: each pair costs its share, and a closest plane G_f per area; one of the cube's faces 15 % more."""
	from yade import O
	O.reset()
	energy = 100.
	p = packings.fcc(D, packings.Box((-2.5 * D, -3 * D, -2.5 * D), (2.5 * D, 3 * D, 2.5 * D)), orientation=orientation)
	y = p.positions[:, 1]
	strong = dict(pairStrength=math.inf, fractureEnergy=energy)
	rows = np.unique(np.round(y, 8))
	line = 0.5 * (rows[rows <= 1e-9].max() + rows[rows > 1e-9].min())
	a, b = metal(label='below', **strong), metal(label='above', **strong)
	ids = packings.addBodies(p, a)
	for i in np.array(ids)[y > line].tolist(): O.bodies[i].material = b
	e = engine_scene.engine(5e-9, account=True)
	e.setPair(a, b, pairStrength=3e7)
	for i in ids: O.bodies[i].state.vel = (0, math.copysign(3., O.bodies[i].state.pos[1] - line), 0)
	across = sum((O.bodies[i].state.pos[1] > line) != (O.bodies[j].state.pos[1] > line) for i, j in e.links())
	O.run(2000, True)
	assert e.counters()['brokenLinks'] == across > 20 and len(e.cohesivePairs()['id1']) == 0
	S = D * D / (2 * math.sqrt(2))
	each = energy * S / math.sqrt(1.5)
	assert e.energies()['fracture'] == pytest.approx(across * each, rel=0.05)
	perAtom, inPlane = (3, math.sqrt(3) / 2 * D * D) if share == 1 else (4, D * D)
	assert perAtom * each / inPlane == pytest.approx(share * energy, rel=1e-12)


def test_inYadesLoop(plugin, tmp_path):
	"""The same pairs with the same openings as McaEngine, and what McaPhys shows of them."""
	from yade import O
	opened()
	c = O.engines[0].cohesivePairs()
	ids = opened('law2')
	b = bonds()
	assert set(b) == set(pairs(c)) and len(b) > 5
	for q, opening, spent in zip(pairs(c), c['opening'], c['spent']):
		p = b[q]
		wide = math.hypot(max(p.opening[0], 0.), p.opening[1])
		assert wide == pytest.approx(opening, rel=1e-8, abs=1e-12) and p.opening[2] == 0
		assert (min(p.bondMost, p.bondLast) - p.bondFirst) / (p.bondLast - p.bondFirst) == pytest.approx(spent, rel=1e-7, abs=1e-9)
		assert p.bondLast > p.bondMost >= p.bondFirst > 0 and 0.9 * D < p.bondRest < 1.1 * D
		assert 0.5 * p.bondStiffness * p.bondFirst * p.bondLast == pytest.approx(ENERGY * AREA / FACETS, rel=1e-9) or p.bondLast == 0.5 * D
		force = p.bondStiffness * p.bondFirst * (p.bondLast - p.bondMost) / (p.bondLast - p.bondFirst) / p.bondMost * wide
		assert np.linalg.norm(p.pull) == pytest.approx(force, rel=1e-6)
		assert not p.linked
	O.save(str(tmp_path / 'torn.yade.gz'))
	O.run(100, True)
	one = law2_scene.state(ids)
	O.load(str(tmp_path / 'torn.yade.gz'))
	again = bonds()
	assert set(again) == set(b)
	O.run(100, True)
	assert np.array_equal(law2_scene.state(ids), one)


def glued(road):
	"""A block of two materials, whose upper half flies away; returns the engine, both materials and the ids."""
	from yade import O
	O.reset()
	constants = dict(yieldModel='elastic', eos='linear', pairStrength=1e9, fractureEnergy=1.1e4)
	lower, upper = (materials.mcaMat('4340', label=name, **constants) for name in ('lower', 'upper'))
	p = packings.hexagonal(D, packings.Rectangle((0, 0), (8 * D, 8 * D)))
	ids = packings.addBodies(p, lower)
	for i, x in zip(ids, p.positions):
		O.bodies[i].state.vel = (0, 20. if x[1] > 0 else -20., 0)
		if x[1] > 0: O.bodies[i].mat = upper
	law2_scene.engines(road, DT)
	return O.engines[0] if road == 'engine' else law2_scene.density(), lower, upper, ids


def refusedTwice(words):
	from yade import O
	for _ in range(2):
		with pytest.raises(RuntimeError, match='fractureEnergy = 11000 .*' + words): O.run(1, True)


@pytest.mark.parametrize('road', ['engine', 'law2'])
def test_whatIsTooStrongIsRefusedEachTimeAndChangesNothing(plugin, road):
	"""A rule before the first step, a material in a pause: at each try, and after setting it back the run is that without."""
	from yade import O
	e, lower, upper, ids = glued(road)
	O.run(60, True)
	plain = law2_scene.state(ids)
	e, lower, upper, ids = glued(road)
	e.setPair(lower, upper, pairStrength=2e10)
	refusedTwice('pairStrength of the pair of materials = 2e.10')
	e.setPair(lower, upper)
	O.run(5, True)
	if road == 'engine':
		with pytest.raises(RuntimeError, match='fractureEnergy = 11000'): e.setPair(lower, upper, pairStrength=2e10)
	O.run(5, True)
	lower.spallStrength = 2e10
	refusedTwice('spallStrength')
	lower.spallStrength = math.inf
	O.run(50, True)
	assert (law2_scene.state(ids) == plain).all()
