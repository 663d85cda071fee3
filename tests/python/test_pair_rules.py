# SPDX-License-Identifier: GPL-2.0-or-later
"""What holds between two materials (setPair), links across masks, on both roads; clumps of automata beside McaEngine."""
import math

import engine_scene
import law2_scene
import numpy as np
import pytest
from engine_scene import D
from yade_mca import cracks, materials, packings

ROADS = ('engine', 'law2')
SOFT = dict(engine_scene.STEEL, spallStrength=3e9)


def halves(dimension=2, n=6, constants=SOFT, masks=(1, 1), **other):
	"""A bar along x whose right half has a material of its own; ids of both and the two materials."""
	from yade import O
	O.reset()
	a, b = materials.mcaMat('4340', **dict(constants, label='left')), materials.mcaMat('4340', **dict(constants, label='right', **other))
	if dimension == 2: p = packings.hexagonal(D, packings.Rectangle((n * D, 0.5 * n * D), (2 * n * D, n * D)), rim='full')
	else: p = packings.fcc(D, packings.Box((0, 0, 0), (2 * n * D, n * D, n * D)))
	ids = packings.addBodies(p, a, mask=masks[0])
	for i in ids:
		if O.bodies[i].state.pos[0] > n * D: O.bodies[i].mat, O.bodies[i].mask = b, masks[1]
	return [i for i in ids if O.bodies[i].state.pos[0] <= n * D], [i for i in ids if O.bodies[i].state.pos[0] > n * D], a, b


def mover(road, dt=1e-8, **attributes):
	"""The engine of a road in O.engines."""
	from yade import O
	law2_scene.engines(road, dt)
	e = O.engines[0] if road == 'engine' else law2_scene.density()
	for name, value in attributes.items():
		setattr(e, name, value)
	return e


def pull(left, right, speed=60.):
	from yade import O
	for ids, v in (left, -speed), (right, speed):
		for i in ids: O.bodies[i].state.vel = (v, 0, 0)


@pytest.mark.parametrize('dimension', (2, 3))
@pytest.mark.parametrize('rule', (dict(strength=0.05), dict(pairStrength=0.1e9)), ids=('strength', 'pairStrength'))
def test_aWeakInterfaceBreaksAndNothingElse(plugin, rule, dimension):
	"""Both halves fly apart: without the rule the bar holds; with it all links between the materials break, and no other."""
	from yade import O
	for weak in False, True:
		left, right, a, b = halves(dimension)
		e = engine_scene.engine(1e-8)
		if weak: e.setPair(a, b, **rule)
		across = [p for p in e.links() if (p[0] in left) != (p[1] in left)]
		pull(left, right)
		O.run(150, True)
		h = cracks.history(e)
		broken = sorted(zip(h['id1'].tolist(), h['id2'].tolist()))
		assert broken == (sorted(across) if weak else [])
	assert set(h['cause']) == {'pairStrength' if 'pairStrength' in rule else 'spallStrength'}


def test_glueBreaksAtItsStress(plugin):
	"""A bar pulled slowly at its ends: the glue in its middle parts when the stress there is what was given."""
	from yade import O
	left, right, a, b = halves(n=4, constants=engine_scene.STEEL)  # no criterion of its own
	e = engine_scene.engine(2e-8)
	given = 0.2e9
	e.setPair(a, b, pairStrength=given)
	x = np.array([O.bodies[i].state.pos[0] for i in left + right])
	ends = [np.array(left + right)[m].tolist() for m in (x < x.min() + 0.6 * D, x > x.max() - 0.6 * D)]
	e.prescribe(ends[0], x=-1., y=0)
	e.prescribe(ends[1], x=1., y=0)
	middle = [i for i in left if O.bodies[i].state.pos[0] > 2.2 * D and abs(O.bodies[i].state.pos[1] - 2 * D) < 1.2 * D]
	before = 0
	while not e.counters().get('brokenLinks') and O.iter < 20000:
		force = -engine_scene.pick(e, ends[1], 'fx').sum()  # the bar pulls its end back
		before = -force
		O.run(4, True)
	area = (x.size / len(set(np.round(x, 9)))) * D * 0.866 * 2  # rows times their distance
	assert O.iter < 20000
	stress = abs(before) / (4 * D)
	assert stress == pytest.approx(given, rel=0.15)  # mean over the section; corners of the section see more


@pytest.mark.parametrize('dimension', (2, ))
def test_bothRoadsAgree(plugin, dimension):
	"""Strength, friction and viscosity of the pair in an oblique collision that breaks the glue: the same trajectory."""
	from yade import O
	found = []
	for road in ROADS:
		left, right, a, b = halves(constants=dict(engine_scene.HARD, viscosityLinear=0.5), yieldStress=0.5e9)
		more = packings.addBodies(packings.hexagonal(D, packings.Rectangle((6 * D, 9.1 * D), (8 * D, 4 * D))), b, velocity=(150, -600), mask=3)
		e = mover(road)
		e.setPair(a, b, strength=0.3, frictionAngle=0.9, viscosity=0.2)
		O.run(1, True)
		start = len(e.links())
		O.run(259, True)
		found.append((law2_scene.state(left + right + more), sorted(e.links())))
	(s, links), (t, others) = found
	assert links == others and len(links) < start - 10
	assert s == pytest.approx(t, rel=1e-9, abs=1e-10 * abs(s).max())
	apart = []
	for rule in None, dict(frictionAngle=0.9), dict(viscosity=0.2), dict(strength=0.3):  # each of the three matters
		left, right, a, b = halves(constants=dict(engine_scene.HARD, viscosityLinear=0.5), yieldStress=0.5e9)
		packings.addBodies(packings.hexagonal(D, packings.Rectangle((6 * D, 9.1 * D), (8 * D, 4 * D))), b, velocity=(150, -600), mask=3)
		e = mover('engine')
		if rule: e.setPair(a, b, **rule)
		O.run(260, True)
		apart.append(e.field('x'))
	assert len({a.tobytes() for a in apart}) == 4


@pytest.mark.parametrize('road', ROADS)
def test_aRuleCountsFromTheNextStepAndIsSaved(plugin, tmp_path, road):
	from yade import O
	left, right, a, b = halves()
	e = mover(road)
	pull(left, right)
	O.run(20, True)
	e.setPair(a, b, strength=0.02)
	e.setPair(b, a, strength=0.05)  # replaces it
	O.save(str(tmp_path / 's.xml.gz'))
	found = []
	for again in False, True:
		if again: O.load(str(tmp_path / 's.xml.gz'))
		O.run(120, True)
		found.append(law2_scene.state(left + right))
	assert np.array_equal(*found)
	assert (found[0][:, 7] < 6).any()
	e = O.engines[0] if road == 'engine' else law2_scene.density()
	assert not [p for p in e.links() if (p[0] in left) != (p[1] in left)]


@pytest.mark.parametrize('road', ROADS)
def test_refusals(plugin, road):
	from yade import O
	left, right, a, b = halves()
	e = mover(road)
	for args, options, word in (((a, a), {}, 'same object'), ((a, None), {}, 'material2 must be a McaMat'), ((3, b), {}, 'material1 must be a McaMat'), ((a, b), dict(strength=0), 'strength'),
	                            ((a, b), dict(pairStrength=-1.), 'pairStrength'), ((a, b), dict(viscosity=2.), 'viscosity'), ((a, b), dict(frictionAngle=2), 'frictionAngle'),
	                            ((a, b), dict(frictionAngle='x'), 'frictionAngle'), ((a, b), dict(strength=math.nan), 'strength')):
		with pytest.raises(RuntimeError, match=word):
			e.setPair(*args, **options)
	O.run(5, True)
	left, right, a, b = halves(constants=engine_scene.STEEL)  # no criterion
	e = mover(road)
	with pytest.raises(RuntimeError, match='neither material has one'):
		e.setPair(a, b, strength=0.5)
	e.setPair(a, b, pairStrength=1e9)


@pytest.mark.parametrize('dimension', (2, 3))
@pytest.mark.parametrize('road', ROADS)
def test_linksAcrossMasksAreLikeAnyOthers(plugin, dimension, road):
	"""A bar whose halves have two masks, and one whose halves have one: the same bits; without the option two bodies."""
	from yade import O
	found = []
	for masks, across in ((1, 1), False), ((1, 3), True), ((1, 3), False):
		left, right, a, b = halves(dimension, n=4, masks=masks)
		e = mover(road, linkAcrossMasks=across)
		for i in left + right: O.bodies[i].state.vel = (20 if i in left else -10, 5, 0)
		O.run(60, True)
		found.append((np.array([tuple(O.bodies[i].state.pos) + tuple(O.bodies[i].state.vel) for i in left + right]), sorted(e.links())))
	assert np.array_equal(found[0][0], found[1][0]) and found[0][1] == found[1][1]
	assert len(found[2][1]) < len(found[0][1])


def test_acrossMasksIsReadOnce(plugin):
	from yade import O
	halves(masks=(1, 3))
	e = mover('engine', linkAcrossMasks=True)
	O.run(3, True)
	O.bodies[0].mask = 5  # one group all the same
	O.run(3, True)
	e.linkAcrossMasks = False
	with pytest.raises(RuntimeError, match='linkAcrossMasks was changed'):
		O.run(1, True)


@pytest.mark.parametrize('dimension', (2, 3))
def test_aClumpOfAutomataIsRigidAndItsMomentumExact(plugin, dimension):
	from yade import O
	from yade.wrapper import ForceResetter, NewtonIntegrator
	O.reset()
	m = materials.mcaMat('4340', **engine_scene.STEEL)
	if dimension == 2:
		plate = packings.hexagonal(D, packings.Rectangle((6 * D, 2.5 * D), (12 * D, 5 * D)))
		ball = packings.hexagonal(D, packings.disc((6 * D, 8.2 * D), 2.1 * D), rim='full')
	else:
		plate = packings.fcc(D, packings.Box((0, 0, 0), (8 * D, 4 * D, 8 * D)))
		ball = packings.fcc(D, packings.Ball((4 * D, 6.6 * D, 4 * D), 2.1 * D))
	ids = packings.addBodies(plate, m)
	members = packings.addBodies(ball, m, mask=2)
	weight = sum(O.bodies[i].state.mass for i in members)
	e = engine_scene.engine(5e-9)
	if dimension == 2: # YADE's own mass of a clump is that of spheres, in kg
		whole = [packings.addBodies(packings.hexagonal(D, packings.disc((60 * D, 0), 2.1 * D), rim='full'), m, mask=4)][0]
		bad = O.bodies.clump(whole)
		O.bodies[bad].mask = 4
		with pytest.raises(RuntimeError, match='packings.clump'):
			O.run(1, True)
		O.bodies.erase(bad, True)
		O.reset()
		m = materials.mcaMat('4340', **engine_scene.STEEL)
		ids, members = packings.addBodies(plate, m), packings.addBodies(ball, m, mask=2)
		e = engine_scene.engine(5e-9)
	clump = packings.clump(members)
	body = O.bodies[clump]
	assert body.state.mass == pytest.approx(weight) and body.mask == 2
	body.state.vel = (30, -200, 0)
	O.engines = [ForceResetter(), e, NewtonIntegrator(damping=0, mask=2)]
	places = np.array([O.bodies[i].state.pos for i in members])
	O.run(1400, True)
	moved = np.array([O.bodies[i].state.pos for i in members])
	gap = lambda x: np.linalg.norm(x[:, None] - x[None], axis=2)
	assert gap(moved) == pytest.approx(gap(places), abs=1e-9 * D)  # rigid
	assert len(e.ids) == len(ids) and body.state.vel[1] > -190
	plateMomentum = [sum(O.bodies[i].state.mass * O.bodies[i].state.vel[c] for i in ids) for c in range(dimension)]
	for c, v in enumerate((30, -200, 0)[:dimension]):
		assert plateMomentum[c] + weight * body.state.vel[c] == pytest.approx(weight * v, abs=1e-10 * weight * 200)


def test_clumpRefuses(plugin):
	left, right, a, b = halves(n=3)
	for bad, word in (([left[0]], 'two or more'), ([left[0], left[0]], 'two or more'), ([left[0], 9999], 'body 9999'), (5, 'row of whole numbers')):
		with pytest.raises(packings.PackingError, match=word):
			packings.clump(bad)
	packings.clump(left[:3])
	with pytest.raises(packings.PackingError, match='already'):
		packings.clump(left[2:5])


def test_automataThatFlyBecomeARigidBody(plugin):
	"""A ball is clumped in a pause: it leaves the engine with its mass and momentum, and goes on at its speed."""
	from yade import O
	from yade.wrapper import ForceResetter, NewtonIntegrator
	O.reset()
	m = materials.mcaMat('4340', **engine_scene.STEEL)
	ids = packings.addBodies(packings.hexagonal(D, packings.Rectangle((0, 0), (12 * D, 5 * D))), m)
	ball = packings.addBodies(packings.hexagonal(D, packings.disc((0, 6.5 * D), 2.1 * D), rim='full'), m, velocity=(0, -150), mask=2)
	e = engine_scene.engine(5e-9, account=True)
	O.run(20, True)
	weight = sum(O.bodies[i].state.mass for i in ball)
	body = O.bodies[packings.clump(ball)]
	O.engines = [ForceResetter(), e, NewtonIntegrator(damping=0, mask=2)]
	y = body.state.pos[1]
	for _ in range(20): O.run(1, True)
	assert e.count == len(ids) and e.energies()['leftMass'] == pytest.approx(weight) and e.energies()['leftMomentumY'] == pytest.approx(-150 * weight)
	assert body.state.pos[1] - y == pytest.approx(-150 * 20 * 5e-9, rel=1e-9)
	O.run(3000, True)
	assert body.state.vel[1] > -140


def test_loadingMakesNoSearchOfItsOwn(plugin, tmp_path):
	from yade import O
	ids = law2_scene.impact()
	e = engine_scene.engine()
	O.run(150, True)
	O.save(str(tmp_path / 's.yade.gz'))
	found = []
	for again in False, True:
		if again: O.load(str(tmp_path / 's.yade.gz'))
		O.run(100, True)
		found.append((law2_scene.state(ids), O.engines[0].counters()['searches'], O.time))
	assert np.array_equal(found[0][0], found[1][0]) and found[0][1:] == found[1][1:]


def test_rulesGoWithTheirScene(plugin):
	"""One engine in a sweep: the glue of the first case is not in the second."""
	from yade import O
	broken = []
	e = None
	for glued in True, False:
		left, right, a, b = halves()
		if e is None: e = mover('engine')
		O.engines, O.dt = [e], 1e-8
		if glued: e.setPair(a, b, strength=0.02)
		pull(left, right)
		O.run(100, True)
		broken.append(len(e.brokenLinks()['time']))
	assert broken[0] > 5 and broken[1] == 0
