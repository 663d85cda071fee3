# SPDX-License-Identifier: GPL-2.0-or-later
"""What the law in YADE's loop does not compute ends the run with one error that says what, where and what to do, before anything moves."""
import math

import numpy as np
import pytest

import law2_scene as scene

NAN, INF = float('nan'), float('inf')


def start(run=0):
	"""A small block that moves; returns its ids and runs some steps."""
	from yade import O
	from yade_mca import materials, packings
	m = materials.mcaMat('4340')
	ids = packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((0, 0), (6e-3, 6e-3))), m, velocity=(10., 0.))
	scene.engines('law2', 1e-8)
	if run: O.run(run, True)
	return ids


def refused(*words):
	"""O.run(5, True) raises and moves nothing."""
	from yade import O
	where = [tuple(b.state.pos) for b in O.bodies if b and b.state]
	at = O.iter
	with pytest.raises(RuntimeError) as e:
		O.run(5, True)
	for w in words:
		assert w in str(e.value), str(e.value)
	assert O.iter == at and repr(where) == repr([tuple(b.state.pos) for b in O.bodies if b and b.state])


def engine(name):
	from yade import O
	return next(e for e in O.engines if type(e).__name__ == name)


@pytest.mark.parametrize('run', [0, 5])
@pytest.mark.parametrize('name, value', [('volumeFilter', NAN), ('volumeFilter', -1.), ('volumeFilter', 5.), ('linkFactor', NAN), ('linkFactor', 1.), ('linkFactor', 3.), ('volumeRule', 'nonsense')])
def test_attributesOfMcaLaw(plugin, run, name, value):
	from yade import O
	start(run)
	d = scene.density()
	good = getattr(d, name)
	setattr(d, name, value)
	refused('McaLaw', name, str(value) if isinstance(value, str) else '%g' % value)
	setattr(d, name, good)
	O.run(5, True)


def test_ruleAndLinkFactorAreChosenOnce(plugin):
	start(5)
	d = scene.density()
	d.volumeRule = 'inversePower'
	refused('volumeRule', 'inversePower', 'affine', 'before the first step')
	d.volumeRule, d.linkFactor = 'affine', 1.3
	refused('linkFactor', '1.3', '1.2', 'before the first step')


@pytest.mark.parametrize('value', [NAN, -1., 0.5, INF])
def test_rangeOfTheLaw(plugin, value):
	from yade import O
	start()
	law = engine('InteractionLoop').lawDispatcher.functors[0]
	law.range = value
	refused('range', '%f' % value if math.isfinite(value) else str(value), '1.1')
	law.range = 1.45
	O.run(5, True)


@pytest.mark.parametrize('dt', [0., NAN, INF, 1e-3])  # YADE itself refuses a negative one
def test_timeStep(plugin, dt):
	from yade import O
	start(5)
	O.dt = dt
	refused('O.dt', 'largest stable step')


@pytest.mark.parametrize('run', [0, 5])
@pytest.mark.parametrize('what', ['stateNone', 'plainState', 'materialNone', 'shapeNone', 'box'])
def test_bodiesThatAreNoAutomataAnyMore(plugin, run, what):
	from yade import O
	from yade.wrapper import Box, State
	ids = start(run)
	b = O.bodies[ids[10]]
	if what == 'stateNone': b.state = None
	if what == 'plainState': b.state = State()
	if what == 'materialNone': b.material = None
	if what == 'shapeNone': b.shape = None
	if what == 'box': b.shape = Box(extents=(1e-3, 1e-3, 1e-3))
	if what == 'box' and run == 0: return  # a wall
	if 'tate' in what and run == 0:  # YADE's own check, which O.run may lose
		with pytest.raises(RuntimeError, match='#10.*Body::state'):
			O.step()
		return
	refused('body 10', dict(stateNone='state is None', plainState='McaState', materialNone='material' if run == 0 else 'McaMat', shapeNone='shape', box='Sphere')[what])


@pytest.mark.parametrize('name, value, words', [
        ('pos', (NAN, 0, 0), ['position']), ('vel', (0, INF, 0), ['velocity']), ('angVel', (0, 0, NAN), ['angular velocity']), ('mass', NAN, ['mass']), ('mass', 0., ['mass']), ('mass', 1e-6, ['mass', 'stable']),
        ('inertia', (0, 0, 0), ['inertia']), ('strength', NAN, ['strength']), ('strength', -1., ['strength']), ('plasticStrain', -1., ['plasticStrain']), ('temperature', NAN, ['temperature']),
        ('volumeRatio', NAN, ['volumeRatio']), ('radius', 0.6e-3, ['radius', '0.0006'])
])
def test_statesChangedBetweenRuns(plugin, name, value, words):
	from yade import O
	ids = start(5)
	b = O.bodies[ids[10]]
	setattr(b.shape if name == 'radius' else b.state, name, value)
	refused('body 10', *words)


@pytest.mark.parametrize('name, value', [('pressure', 1e9), ('volumeRatio', 0.9), ('stressZZ', 1e8), ('equivalentStress', 1e8)])
def test_resultsCannotBeGivenAtTheStart(plugin, name, value):
	from yade import O
	ids = start()
	setattr(O.bodies[ids[10]].state, name, value)
	refused('body 10', 'state.' + name, '%g' % value)


def test_automataThatMcaEngineHasMoved(plugin):
	from yade import O
	from yade_mca import McaEngine
	from yade_mca.scenes import law2Engines
	start()
	O.engines = [McaEngine(adaptive=False)]
	O.run(5, True)
	O.engines = law2Engines()
	refused('McaEngine has moved it', 'links')


@pytest.mark.parametrize('masks', [(1, 2), (4, 3), (0, 1)])
def test_masksWithoutACommonBit(plugin, masks):
	from yade import O
	from yade_mca import materials, packings
	m = materials.mcaMat('4340')
	one = [packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((x, 0), (4e-3, 4e-3))), m, mask=k) for x, k in zip((0, 5e-3), masks)]
	scene.engines('law2', 1e-8)
	refused('mask %d' % masks[0], 'mask %d' % masks[1] if all(masks) else 'no contact')
	for i in one[0] + one[1]:
		O.bodies[i].mask = 1 if i in one[0] else 3
	O.run(5, True)
	O.bodies[one[0][0]].mask = 4
	refused('(mask 4)', '1 and 3')


def test_aWallThatAutomataPassIsTold(plugin, capfd):
	from yade import O, utils
	ids = start()
	O.bodies.append(utils.wall(4e-3, axis=0, material=O.bodies[ids[0]].material, mask=2))
	O.run(3, True)
	O.run(3, True)
	said = capfd.readouterr().err
	assert said.count('pass through each other') == 1 and 'body %d' % (len(ids)) in said


def engines(change):
	from yade import O
	O.engines = change(list(O.engines))


@pytest.mark.parametrize('run', [0, 5])
@pytest.mark.parametrize('change, words', [
        (lambda e: e[:3] + [e[2]] + e[3:], ['McaLaw twice']),
        (lambda e: e[:3] + [__import__('yade_mca').McaLaw()] + e[3:], ['McaLaw twice']),
        (lambda e: e[:5] + [e[4]] + e[5:], ['McaForces twice']),
        (lambda e: e + [__import__('yade').utils.NewtonIntegrator(damping=0)], ['2 NewtonIntegrators']),
        (lambda e: e[1:], ['ForceResetter']),
        (lambda e: e[1:5] + [e[0]] + e[5:], ['ForceResetter']),
        (lambda e: [e[0]] + e[2:], ['collider']),
        (lambda e: e[:3] + [e[4], e[3], e[5]], ['McaForces', 'misplaced']),
        (lambda e: e + [__import__('yade_mca').McaEngine()], ['McaEngine and McaLaw']),
])
def test_engines(plugin, run, change, words):
	start(run)
	engines(change)
	refused(*words)


@pytest.mark.parametrize('name', ['InteractionLoop', 'McaForces', 'NewtonIntegrator', 'ForceResetter', 'InsertionSortCollider', 'McaLaw'])
def test_deadEngines(plugin, name):
	from yade import O
	start(5)
	engine(name).dead = True
	refused('dead' if name != 'McaLaw' else 'McaLaw')
	engine(name).dead = False
	O.run(5, True)


def test_newtonIntegratorWithDampingOrMask(plugin):
	from yade import O
	ids = start(5)
	n = engine('NewtonIntegrator')
	n.damping = 0.2
	refused('NewtonIntegrator.damping = 0.2', 'damping=0')
	for i in ids:
		O.bodies[i].state.isDamped = False
	O.run(5, True)
	n.mask = 2
	refused('moved by no NewtonIntegrator', 'mask')
	n.mask = 1
	O.run(5, True)
	x = [O.bodies[i].state.pos[0] for i in ids]
	n.mask = 0  # YADE moves all bodies then
	O.run(5, True)
	assert all(O.bodies[i].state.pos[0] > x0 for i, x0 in zip(ids, x))


def test_periodicClumpsAndSubdomains(plugin):
	from yade import O
	ids = start(5)
	O.periodic = True
	refused('O.periodic')
	O.periodic = False
	O.run(5, True)
	O.bodies[ids[3]].subdomain = 1
	refused('yade.mpy')
	O.bodies[ids[3]].subdomain = 0
	O.bodies.clump([ids[10], ids[11]])
	refused('clump')


def test_contactsFoundTooLate(plugin):
	"""Without the factors 1.4 pairs are found when they overlap already."""
	from yade import O
	from yade_mca import materials, packings
	m = materials.mcaMat('4340')
	packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((0, 0), (6e-3, 6e-3))), m)
	packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((-7e-3, 0), (4e-3, 4e-3))), m, velocity=(300., 0), mask=3)
	scene.engines('law2', 2e-8)
	engine('InteractionLoop').geomDispatcher.functors[0].interactionDetectionFactor = 1.
	with pytest.raises(RuntimeError) as e:
		O.run(1000, True)
	assert 'interactionDetectionFactor=1.4' in str(e.value)


@pytest.mark.parametrize('name, value', [
        ('density', NAN), ('bulkSoundSpeed', NAN), ('hugoniotSlope', NAN), ('gruneisen', NAN), ('shearModulus', NAN), ('shearModulus', INF), ('yieldStress', NAN), ('hardeningModulus', NAN), ('hardeningExponent', NAN),
        ('rateCoefficient', NAN), ('referenceRate', NAN), ('thermalSoftening', NAN), ('meltTemperature', NAN), ('referenceTemperature', NAN), ('referenceTemperature', -1.), ('heatCapacity', NAN), ('heatCapacity', -1.),
        ('heatCapacity', INF), ('taylorQuinney', NAN), ('taylorQuinney', 1.5), ('fractureStrain', NAN), ('spallStrength', NAN), ('pairStrength', NAN), ('fractureStress', NAN), ('strengthRatio', NAN), ('strengthSpread', NAN),
        ('viscosityLinear', NAN), ('viscosityQuadratic', NAN), ('frictionAngle', NAN), ('frictionAngle', 0.5 * math.pi), ('frictionAngle', -0.1)
])
def test_constantsOfAMaterial(plugin, name, value):
	from yade import O
	ids = start(5)
	m = O.bodies[ids[0]].material
	good = getattr(m, name)
	setattr(m, name, value)
	refused(name)
	setattr(m, name, good)
	O.run(5, True)


def test_youngAndPoissonFollow(plugin):
	from yade_mca import McaMat
	K, G = 7800 * 4500.**2, 8e10
	m = McaMat(density=7800., bulkSoundSpeed=4500., shearModulus=G)
	E, nu = 9 * K * G / (3 * K + G), (3 * K - 2 * G) / (2 * (3 * K + G))
	assert m.young == pytest.approx(E, rel=1e-12) and m.poisson == pytest.approx(nu, rel=1e-12)
	for bad in NAN, 2e11, -1.:
		with pytest.raises(ValueError, match='young'):
			m.young = bad
		with pytest.raises(ValueError, match='young'):
			McaMat(density=7800., bulkSoundSpeed=4500., shearModulus=G, young=bad)
		with pytest.raises(ValueError, match='poisson'):
			McaMat(poisson=bad)
	m.density = 3900.
	assert m.young < E
	again = McaMat(**{k: v for k, v in m.dict().items() if k != 'id'})
	assert again.young == m.young and again.dict() == dict(m.dict(), id=again.id)


def test_noErrorIsLost(plugin):
	"""An engine that fails at once, by O.run(n, True)."""
	from yade import O
	start()
	scene.density().volumeFilter = -1
	for _ in range(200):
		with pytest.raises(RuntimeError, match='volumeFilter'):
			O.run(1, True)
	scene.density().volumeFilter = 0.1
	law = engine('InteractionLoop').lawDispatcher.functors[0]
	law.range = -1
	for _ in range(20):
		with pytest.raises(RuntimeError, match='range'):
			O.run(1, True)
	assert O.iter == 0


def test_energiesAreNotReadWhileTheRunGoesOn(plugin):
	import builtins
	import time
	from yade import O
	from yade.wrapper import PyRunner
	start(5)
	d = scene.density()
	builtins.seen = []
	engines = O.engines
	O.engines = engines + [PyRunner(iterPeriod=1, command="seen.append(O.engines[2].energies()['kinetic'])")]  # within a step all stands still
	O.run(5, True)
	assert len(builtins.seen) == 5 and np.isfinite(builtins.seen).all()
	O.engines = engines
	O.run()
	for read in d.energies, d.links:
		with pytest.raises(RuntimeError, match='background'):
			read()
	O.pause()
	O.wait()
	time.sleep(0.3)  # wait() does not wait for the step under way
	assert d.energies()['kinetic'] > 0 and len(d.links()) > 50
