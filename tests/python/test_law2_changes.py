# SPDX-License-Identifier: GPL-2.0-or-later
"""The law in YADE's loop when the script changes bodies, materials and engines between runs: the same as McaEngine does, to round-off."""
import numpy as np
import pytest

import law2_scene as scene

D = 1e-3
RULES = ['affine', 'inversePower', 'meanDistance']


def links(road):
	from yade import O
	return sorted((scene.density() if road == 'law2' else O.engines[0]).links())


def both(build, change, before, after, rule='affine', dt=2e-8):
	"""Runs, changes, runs on both roads; change(ids) returns the ids to look at. Compares states and links; returns states of the law's road."""
	from yade import O
	found = {}
	for road in 'engine', 'law2':
		O.reset()
		ids = build()
		scene.engines(road, dt, rule=rule)
		O.run(before, True)
		if road == 'engine': O.engines[0].sync()
		ids = change(ids)
		O.run(after, True)
		found[road] = scene.state(ids), links(road)
	a, b = found['engine'][0], found['law2'][0]
	assert found['engine'][1] == found['law2'][1]
	scale = np.maximum(abs(a).max(axis=0), [D, D, 1, 1, 1 / D, 1e9, 1, 1])  # what is at rest has the round-off of what could move
	scale[:2] = D
	assert (abs(a - b).max(axis=0) <= 1e-9 * scale).all(), abs(a - b).max(axis=0) / scale
	return b


def block(nx=10, ny=10, at=(0., 0.), velocity=(0., 0.), mask=1, **steel):
	from yade_mca import materials, packings
	m = materials.mcaMat('4340', **dict(dict(yieldModel='elastic'), **steel))
	return packings.addBodies(packings.hexagonal(D, packings.Rectangle(at, (nx * D, ny * D))), m, velocity=velocity, mask=mask)


def near(ids, point, n=1):
	"""The n bodies next to a point [m]."""
	from yade import O
	x = np.array([O.bodies[i].state.pos for i in ids])[:, :2] - point
	return [ids[k] for k in np.argsort(np.hypot(*x.T), kind='stable')[:n]]


def erasing(*points, n=1):
	def change(ids):
		from yade import O
		gone = {i for p in points for i in near(ids, p, n)}
		for i in sorted(gone):
			O.bodies.erase(i)
		return [i for i in ids if i not in gone]

	return change


@pytest.mark.parametrize('rule', RULES)
@pytest.mark.parametrize('point', [(0, 0), (0, 5 * D), (5 * D, -5 * D)], ids=['inner', 'rim', 'corner'])
def test_erasedFromABodyAtRest(plugin, rule, point):
	"""Nothing moves: who loses links keeps its volume."""
	s = both(block, erasing(point), 5, 50, rule)
	assert abs(s[:, 2:4]).max() < 1e-9 and s[:, 7].min() >= 1


@pytest.mark.parametrize('rule', RULES)
def test_erasedFromALoadedBody(plugin, rule):
	"""In the middle of an impact, under pressure, yielding and breaking: inner ones, rim ones, one of the flyer."""
	s = both(scene.impact, erasing((-3 * D, 0), (-4.6 * D, 1.5 * D), (2 * D, 2 * D), (-8 * D, D), n=2), 250, 250, rule)
	assert s[:, 6].max() > 0.05 and abs(s[:, 5]).max() > 1e9


def test_allAroundOneErased(plugin):
	"""It is left without links and has its volume from contacts alone."""
	from yade import O

	def change(ids):
		ring = near(ids, tuple(O.bodies[near(ids, (0, 0))[0]].state.pos)[:2], 7)
		for i in ring[1:]:
			O.bodies.erase(i)
		return [i for i in ids if i not in ring[1:]]

	s = both(lambda: block(velocity=(3., 0.)), change, 20, 60)
	assert (s[:, 7] == 0).sum() == 1


def test_aBodyAddedFarAwayIsLinked(plugin):

	def change(ids):
		return ids + block(4, 4, at=(40 * D, 0), velocity=(0., 10.))

	s = both(lambda: block(6, 6), change, 10, 50)
	assert s[:, 7].min() >= 2 and abs(s[-1, 3]) > 5


def test_aBodyAddedInTheHoleOfAnErasedOne(plugin):
	"""Later, and at once: it gets the six links of its place."""
	from yade import O
	from yade_mca import packings

	def fill(ids, wait):
		which = near(ids, (0.2 * D, 0))[0]
		x, m = O.bodies[which].state.pos, O.bodies[which].material
		O.bodies.erase(which)
		if wait: O.run(wait, True)
		p = packings.hexagonal(D, packings.Rectangle((0, 0), (10 * D, 10 * D)), rim='full')
		new = packings.addBodies(p.select([int(np.argmin(np.hypot(*(p.positions - (x[0], x[1])).T)))]), m)
		return [i for i in ids if i != which] + new

	for wait in 0, 7:
		s = both(block, lambda ids: fill(ids, wait), 5, 40)
		assert s[-1, 7] == 6 and abs(s[:, 2:4]).max() < 1e-6


def test_aBodyAddedInFlightMeetsTheOther(plugin):

	def change(ids):
		# not head-on: in a symmetric meeting round-off decides which contact opens first when they part
		return ids + block(4, 4, at=(-8 * D, 0), velocity=(200., 7.), mask=3)

	s = both(lambda: block(8, 8), change, 20, 700)
	assert s[:, 2].min() < 150 and s[:20, 2].max() > 1


def test_theOrderOfGrainsAndAutomataDoesNotMatter(plugin):
	"""A sphere of FrictMat made before the automata or after them takes the same push."""
	from yade import O, utils
	from yade.wrapper import FrictMat
	found = []
	for first in True, False:
		O.reset()

		def grain():
			O.materials.append(FrictMat(young=1e11, frictionAngle=0.3, density=7800.))
			return O.bodies.append(utils.sphere((-3.78 * D, 0.7 * D, 0), 0.5 * D, material=O.materials[-1], fixed=True))

		g = grain() if first else None
		ids = block(6, 6, velocity=(-40., 0.))
		g = grain() if g is None else g
		scene.engines('law2', 3e-8)
		pushed = []
		for _ in range(10):
			O.run(20, True)
			pushed.append(O.forces.f(g)[0])
		found.append((np.array(pushed), scene.state(ids)))
	assert found[0][0].min() < -1
	assert np.allclose(found[0][0], found[1][0], rtol=1e-9) and np.allclose(found[0][1][:, :5], found[1][1][:, :5], rtol=1e-9, atol=1e-9)


def test_aChangedMaterialCountsFromTheNextStep(plugin):
	"""Constants of links, contacts and walls, and of the automata; also when one body gets another material."""
	from yade import O, utils
	from yade_mca import materials
	ids = scene.impact()
	m = O.bodies[ids[0]].material
	wall = O.bodies.append(utils.wall(5.3e-3, axis=0, material=m))
	scene.engines('law2', 2e-8)
	O.run(250, True)
	pairs = lambda: [I.phys for I in O.interactions if I.isReal and (I.phys.linked or I.phys.active) and I.iterMadeReal < O.iter - 2]
	walls = lambda: [I.phys for I in O.interactions if I.isReal and I.phys.wall]
	assert len(pairs()) > 300 and any(p.active for p in pairs()) and walls()
	m.shearModulus, m.viscosityLinear, m.frictionAngle, m.yieldStress = 0.9 * m.shearModulus, 0.3, 0.4, 2e8
	kn = walls()[0].kn
	strain = scene.state(ids)[:, 6].max()
	O.run(1, True)
	assert all(p.twoG == pytest.approx(2 * m.shearModulus, rel=1e-12) for p in pairs())
	assert all(p.viscLinear == pytest.approx(0.3 * m.density * m.bulkSoundSpeed, rel=1e-12) for p in pairs())
	assert all(p.friction == pytest.approx(np.tan(0.4)) for p in pairs()) and walls()[0].kn < kn
	assert scene.state(ids)[:, 6].max() > strain
	i = next(I for I in O.interactions if I.isReal and I.phys.linked)
	O.bodies[i.id1].material = materials.mcaMat('4340', shearModulus=0.5 * m.shearModulus)
	O.run(1, True)
	assert i.phys.twoG == pytest.approx(2 / (0.5 / (0.5 * m.shearModulus) + 0.5 / m.shearModulus))


def test_whatTheScriptGivesAtTheStartCounts(plugin):
	"""Temperature softens, plastic strain hardens, strength decides what breaks."""
	from yade import O
	hot = dict(yieldModel='johnsonCook', yieldStress=0.79e9, hardeningModulus=0.51e9, hardeningExponent=0.26, rateCoefficient=0.014, thermalSoftening=1.03, meltTemperature=1793., heatCapacity=477.)
	stress = {}
	for T in 298., 900.:
		O.reset()
		ids = scene.impact(**hot, fractureStrain=float('inf'), spallStrength=float('inf'))
		for i in ids:
			O.bodies[i].state.temperature = T
		scene.engines('law2', 2e-8)
		O.run(1, True)
		assert {O.bodies[i].state.temperature for i in ids} == {T}
		O.run(200, True)
		flowing = [O.bodies[i].state.equivalentStress for i in ids if O.bodies[i].state.plasticStrain > 0.01]
		stress[T] = np.mean(flowing)
	assert stress[900.] < 0.8 * stress[298.]
	broken = {}
	for factor in 1., 3.:
		O.reset()
		ids = scene.impact(strengthSpread=0.)
		for i in ids:
			O.bodies[i].state.strength, O.bodies[i].state.plasticStrain = factor, 0.02
		scene.engines('law2', 2e-8)
		O.run(400, True)
		assert min(O.bodies[i].state.plasticStrain for i in ids) == 0.02
		broken[factor] = scene.density().counters()['brokenLinks']
	assert broken[3.] < 0.5 * broken[1.]


def test_aNewEngineGoesOnWithTheOldState(plugin):
	"""O.engines typed anew in the middle of a run."""
	from yade import O
	from yade_mca.scenes import law2Engines
	found = []
	for again in False, True:
		O.reset()
		ids = scene.impact(speed=60., fractureStrain=float('inf'), spallStrength=float('inf'), yieldModel='elastic')
		scene.engines('law2', 2e-8)
		O.run(150, True)
		if again: O.engines = law2Engines()
		O.run(150, True)
		found.append(scene.state(ids))
	assert np.array_equal(found[0], found[1]) and found[0][:, 5].max() > 1e8


def test_theSameEngineInANewSceneStartsFromTheBeginning(plugin):
	from yade import O

	def run():
		ids = scene.impact()
		O.dt = 2e-8
		O.run(200, True)
		return scene.state(ids), scene.density().counters()

	scene.engines('law2', 2e-8)
	first, counters = run()
	O.bodies.clear()
	second, again = run()
	assert np.array_equal(first, second) and counters == again and counters['brokenLinks'] > 0


def test_energyThatLeavesWithErasedBodies(plugin):
	"""`joined` is what the sum of energies owes to bodies that came and went."""
	from yade import O
	ids = scene.impact(speed=200.)
	O.trackEnergy = True
	scene.engines('law2', 1e-8)
	O.run(400, True)
	d = scene.density()
	before = d.energies()
	gone = near(ids, (-2 * D, 0), 4) + ids[-3:]
	kinetic = sum(0.5 * O.bodies[i].state.mass * O.bodies[i].state.vel.squaredNorm() for i in gone)
	for i in gone:
		O.bodies.erase(i)
	O.run(400, True)
	after = d.energies()
	assert after['joined'] < -kinetic and after['joined'] == d.joined
	assert abs(after['total'] - after['joined'] - before['total']) < 5e-3 * before['total']
	new = block(4, 4, at=(60 * D, 0), velocity=(100., 0.))
	O.run(100, True)
	end, brought = d.energies(), sum(0.5 * O.bodies[i].state.mass * 100.**2 for i in new)
	assert end['joined'] - after['joined'] == pytest.approx(brought, rel=1e-3)
	assert O.energy['mcaJoined'] == -d.joined


def test_savedBetweenErasingAndRunning(plugin):
	"""A link whose partner is gone when the file is written."""
	from yade import O
	found = []
	for through in False, True:
		O.reset()
		ids = scene.impact()
		scene.engines('law2', 2e-8)
		O.run(250, True)
		ids = erasing((-3 * D, 0), (2 * D, 2 * D))(ids)
		if through:
			O.saveTmp()
			O.loadTmp()
		O.run(100, True)
		found.append(scene.state(ids))
	assert np.array_equal(found[0], found[1])
