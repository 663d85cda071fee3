# SPDX-License-Identifier: GPL-2.0-or-later
"""The law of the automata in YADE's InteractionLoop: the same trajectory as McaEngine, walls, threads, energies, time step, refusals."""
import os
import math
import subprocess
import sys

import numpy as np
import pytest

import law2_scene as scene


def trajectory(road, steps, rule='affine', dt=2e-8, **build):
	from yade import O
	O.reset()
	ids = scene.impact(**build)
	scene.engines(road, dt, rule=rule)
	O.run(steps, True)
	return scene.state(ids)


def broken():
	return scene.density().counters()['brokenLinks']


JOHNSON_COOK = dict(yieldModel='johnsonCook', yieldStress=0.79e9, hardeningModulus=0.51e9, hardeningExponent=0.26, rateCoefficient=0.014, thermalSoftening=1.03,
                    meltTemperature=1793., heatCapacity=477., eos='mieGruneisen', gruneisen=1.7)


DAMAGE = dict(JOHNSON_COOK, fractureStrain=float('inf'), damageModel='johnsonCook', damageD1=0.02, damageD2=0.12, damageD3=-1.5, damageD4=0.002, damageD5=0.6)

RULES = [('affine', {}), ('inversePower', {}), ('meanDistance', {}), ('affine', JOHNSON_COOK), ('affine', DAMAGE),
         ('affine', dict(spallStrength=float('inf'), pairStrength=1.5e9, viscosityLinear=0., viscosityQuadratic=0.))]


COHESION = dict(fractureEnergy=2e4, spallStrength=1.5e9)  # broken pairs hold together; their sums are added up in another order, so not in RULES: the last bit differs


@pytest.mark.parametrize('rule, build', RULES + [('affine', dict(rim='triangles')), ('affine', dict(JOHNSON_COOK, rim='triangles')), ('affine', COHESION), ('inversePower', COHESION),
                                                 ('affine', dict(COHESION, rim='triangles', spallStrength=math.inf, pairStrength=1e9))])
def test_sameTrajectoryAsTheEngine(plugin, rule, build):
	"""Impact of two bodies with plastic flow, fracture and contact: 1000 steps, 1e-10 relative."""
	a = trajectory('engine', 1000, rule, **build)
	b = trajectory('law2', 1000, rule, **build)
	assert broken() > 50 and b[:, 6].max() > 0.05  # links broke and material flowed
	scale = abs(a).max(axis=0)
	scale[:2] = 1e-3  # positions against the spacing
	assert (abs(a - b).max(axis=0) <= 1e-10 * scale).all()
	assert (a[:, 7] == b[:, 7]).all()


BITS = """
import sys; sys.path[:0] = %r
import yade_mca
import law2_scene as scene
from test_law2 import RULES
from yade import O
print('LEVEL', yade_mca.McaInfo().isa)
for rule, build in RULES:
	both = []
	for road in 'engine', 'law2':
		O.reset()
		ids = scene.impact(exactMass=True, **build)
		scene.engines(road, 2e-8, rule=rule)
		O.run(1000, True)
		both.append(scene.state(ids))
	links = int(both[0][:, 7].sum())
	print('RESULT', rule, int((both[0] != both[1]).sum()), links, float(both[0][:, 6].max()))
"""


def test_sameBitsAsTheEngine():
	"""Both loops call the same kernels: with the library for the oldest processors, whose arithmetic is that of the classes, not a bit differs after 1000 steps of flow, fracture and contact."""
	done = subprocess.run(['/usr/bin/python3', '-c', BITS % sys.path], capture_output=True, text=True,
	                      env=dict(os.environ, GLIBC_TUNABLES='glibc.cpu.hwcaps=-AVX512F,-AVX2', MPLBACKEND='Agg'))
	assert done.returncode == 0, done.stderr
	assert 'LEVEL x86-64\n' in done.stdout
	results = [line.split() for line in done.stdout.splitlines() if line.startswith('RESULT')]
	assert len(results) == len(RULES)
	for _, rule, different, links, strain in results:
		assert int(different) == 0, (rule, different)
		assert float(strain) > 0.05 and int(links) > 0


def test_brokenPairsStayBrokenAndLinksAreMadeOnce(plugin):
	from yade import O
	trajectory('law2', 400)
	before = set(scene.density().links())
	O.run(400, True)
	assert set(scene.density().links()) <= before and broken() > 50


@pytest.mark.parametrize('rim', ['cells', 'triangles'])
def test_momentumIsKept(plugin, rim):
	"""Action and reaction are the same number."""
	from yade import O
	ids = scene.impact(rim=rim)
	scene.engines('law2', 2e-8)
	start = sum(np.array(O.bodies[i].state.vel) * O.bodies[i].state.mass for i in ids)
	O.run(300, True)
	end = sum(np.array(O.bodies[i].state.vel) * O.bodies[i].state.mass for i in ids)
	assert abs(end - start).max() < 1e-12 * np.linalg.norm(start)
	assert end[2] == 0


@pytest.mark.parametrize('rim, build', [('cells', {}), ('triangles', {}), ('cells', COHESION), ('triangles', COHESION)])
def test_energyAccountIsThatOfTheEngine(plugin, rim, build):
	"""Every item, and the sum of all against the kinetic energy at the start."""
	from yade import O
	items = {}
	for road in 'engine', 'law2':
		O.reset()
		ids = scene.impact(speed=200., rim=rim, **build)
		O.trackEnergy = True
		start = sum(0.5 * O.bodies[i].state.mass * np.dot(O.bodies[i].state.vel, O.bodies[i].state.vel) for i in ids)
		scene.engines(road, 1e-8)
		O.run(800, True)
		items[road] = (O.engines[0] if road == 'engine' else scene.density()).energies()
	e = items['law2']
	assert e['plastic'] > 0.1 * start and min(e[k] for k in ('viscous', 'friction', 'fracture')) > 0
	for k in 'kinetic', 'volumetric', 'deviatoric', 'plastic', 'viscous', 'friction', 'fracture', 'coupling', 'total':
		assert abs(e[k] - items['engine'][k]) < 1e-9 * start, k
	assert abs(e['total'] - start) < 5e-3 * start
	for name in 'Volumetric', 'Deviatoric', 'Plastic', 'Viscous', 'Friction', 'Fracture', 'Coupling':
		assert O.energy['mca' + name] == e[name.lower()]


def block(speed=(0., 0.), mask=1, at=(0., 0.), n=6, **steel):
	from yade_mca import materials, packings
	m = materials.mcaMat('4340', **dict(dict(yieldModel='elastic'), **steel))
	return packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle(at, (n * 1e-3, n * 1e-3))), m, velocity=speed, mask=mask)


@pytest.mark.parametrize('kind', ['wall', 'facet', 'box', 'mcaWall'])
def test_blockBouncesOffAWall(plugin, kind):
	from yade import O, utils
	from yade.wrapper import FrictMat
	ids = block(speed=(0., -30.), frictionAngle=0.3)
	low = min(O.bodies[i].state.pos[1] for i in ids) - 0.55e-3
	if kind == 'mcaWall':
		material = O.bodies[ids[0]].material
	else:
		O.materials.append(FrictMat(young=1e11, frictionAngle=0.3, density=7800.))
		material = O.materials[-1]
	if kind in ('wall', 'mcaWall'):
		wall = O.bodies.append(utils.wall(low, axis=1, material=material))
	elif kind == 'facet':
		wall = O.bodies.append(utils.facet([(-0.02, low, -0.02), (0.02, low, -0.02), (0., low, 0.04)], material=material))
	else:
		wall = O.bodies.append(utils.box((0, low - 1e-3, 0), (0.02, 1e-3, 0.02), fixed=True, material=material))
	scene.engines('law2', 3e-8)
	pushed = 0.
	for _ in range(30):
		O.run(20, True)
		pushed = max(pushed, -O.forces.f(wall)[1])
	v = np.mean([O.bodies[i].state.vel[1] for i in ids])
	assert pushed > 0 and 10 < v < 30  # comes back, with some energy left in vibration
	assert min(O.bodies[i].state.pos[1] for i in ids) > low
	assert O.bodies[wall].state.vel.norm() == 0


def test_gravity(plugin):
	from yade import O
	ids = block(at=(0., 0.1))
	scene.engines('law2', 1e-7, gravity=(0, -9.81, 0))
	O.run(100, True)
	v = np.array([O.bodies[i].state.vel for i in ids])
	assert np.allclose(v[:, 1], -9.81 * 1e-5, rtol=1e-6) and abs(v[:, 0]).max() < 1e-9


def test_resultsDoNotDependOnTheOrderOfInteractions(plugin):
	"""Loading puts O.interactions in another order: the next steps are the same to the last bit all the same (see also tests/saveload)."""
	from yade import O
	ids = scene.impact()
	scene.engines('law2', 2e-8)
	O.run(300, True)
	O.saveTmp()
	O.run(50, True)
	a = scene.state(ids)
	O.loadTmp()
	O.run(50, True)
	assert np.array_equal(a, scene.state(ids))


def test_timeStepper(plugin):
	from yade import O
	from yade.wrapper import McaTimeStepper
	ids = scene.impact()
	scene.engines('law2', 1e-9)
	O.engines = [McaTimeStepper(factor=0.4)] + O.engines
	O.run(60, True)
	d = next(e for e in O.engines if type(e).__name__ == 'McaLaw')
	assert 0 < O.dt <= 0.4 * O.engines[0].limit * (1 + 1e-12)
	assert 0.3 < O.dt / d.criticalTimeStep < 0.45
	assert len(ids) and O.engines[0].limitedBy.startswith('McaLaw')


def test_aSuddenFallOfTheStableStepShortensTheStepInsteadOfEndingTheRun(plugin):
	"""As with McaEngine: links break within a step, and the step chosen before is then too long. Every step is at most the share of the limit that was asked for."""
	from yade import O
	from yade.wrapper import McaTimeStepper
	scene.impact()
	scene.engines('law2', 1e-9)
	O.engines = [McaTimeStepper(factor=1.)] + O.engines
	O.step()
	d, stepper = scene.density(), O.engines[0]
	shortened, before = 0, O.dt
	for _ in range(600):
		chosen = min(d.criticalTimeStep, 1.1 * before)
		O.step()
		shortened += 0 < O.dt < chosen * (1 - 1e-12)
		assert O.dt <= d.dtLimit and stepper.limitedBy == 'McaLaw'
		before = O.dt
	assert d.brokenLinks > 10 and shortened > 0


def refused(words):
	from yade import O
	with pytest.raises(RuntimeError) as e:
		for _ in range(100):
			O.step()  # O.run(100, True) of YADE loses an error that comes before it begins to wait
	for w in words:
		assert w in str(e.value), str(e.value)


def test_refusesWhatWouldGoWrong(plugin, tmp_path):
	from yade import O
	ids = block()
	scene.engines('law2', 1e-4)
	refused(['O.dt', 'above the largest stable step', 'of body', 'McaTimeStepper'])
	O.save(str(tmp_path / 'after.yade.gz'))  # nothing is lost
	O.dt = 1e-8
	O.run(5, True)
	O.bodies[ids[3]].state.vel = (float('nan'), 0, 0)
	refused(['body', 'force', 'not finite', 'step 5'])
	O.save(str(tmp_path / 'nan.yade.gz'))
	assert all(np.isfinite(O.bodies[i].state.pos).all() for i in ids)  # not a finite number less


@pytest.mark.parametrize('spoil, words', [
        (lambda ids: setattr(__import__('yade').O.bodies[ids[2]].state, 'mass', 0.), ['automaton 2', 'mass', 'above zero']),
        (lambda ids: setattr(__import__('yade').O.bodies[ids[2]].state, 'pos', __import__('yade').O.bodies[ids[3]].state.pos), ['automata', 'apart']),
        (lambda ids: setattr(__import__('yade').O.bodies[ids[2]].material, 'hugoniotSlope', -1.), ['hugoniotSlope', '-1']),
        (lambda ids: setattr(__import__('yade').O.bodies[ids[2]].material, 'yieldModel', 'soft'), ['soft', 'one of']),
        (lambda ids: setattr(__import__('yade').O.bodies[ids[2]].state, 'mass', 1.), ['body 2', 'mass', 'full cell']),
        (lambda ids: setattr(scene.density(), 'volumeRule', 'best'), ['volumeRule', 'best']),
        (lambda ids: setattr(__import__('yade').O, 'engines', [e for e in __import__('yade').O.engines if type(e).__name__ != 'McaForces']), ['McaForces', 'missing']),
])
def test_refusesBadInput(plugin, spoil, words):
	ids = block()
	scene.engines('law2', 1e-9)
	spoil(ids)
	refused(words)


def test_deepOverlapIsReported(plugin):
	from yade import O
	ids = block() + block(speed=(-30000., 0), mask=3, at=(8e-3, 0))
	scene.engines('law2', 2e-8)
	scene.density()
	with pytest.raises(RuntimeError) as e:
		for _ in range(200):
			O.dt = min(2e-8, 0.99 * scene.density().criticalTimeStep)
			O.step()
	assert 'rest distances apart' in str(e.value) or 'stable' in str(e.value) or 'volume ratio' in str(e.value)
	assert all(np.isfinite(O.bodies[i].state.pos).all() for i in ids)
