# SPDX-License-Identifier: GPL-2.0-or-later
"""The law in YADE's own loop in space: the trajectory of McaEngine, walls and gravity, save and load, refusals."""
import math
import os
import subprocess
import sys

import law2_scene
import law2_space_scene as scene
import numpy as np
import pytest
from yade_mca import materials, packings

JOHNSON_COOK = dict(yieldModel='johnsonCook', yieldStress=0.79e9, hardeningModulus=0.51e9, hardeningExponent=0.26, rateCoefficient=0.014, thermalSoftening=1.03,
                    meltTemperature=1793., heatCapacity=477., eos='mieGruneisen', gruneisen=1.7)
DAMAGE = dict(JOHNSON_COOK, fractureStrain=float('inf'), damageModel='johnsonCook', damageD1=0.02, damageD2=0.12, damageD3=-1.5, damageD4=0.002, damageD5=0.6)
BUILDS = [{}, dict(rim='faces'), JOHNSON_COOK, DAMAGE, dict(fractureEnergy=2e4, spallStrength=1.5e9)]


def run(road, steps, **build):
	"""(state, energies, broken links) after so many steps of 2e-8 s."""
	from yade import O
	O.reset()
	ids = scene.impact(**build)
	scene.engines(road, 2e-8)
	e = O.engines[0] if road == 'engine' else law2_scene.density()
	if road == 'engine': e.account = True
	else: O.trackEnergy = True
	O.run(steps, True)
	return scene.state(ids), e.energies(), e.counters()['brokenLinks']


@pytest.mark.parametrize('build', BUILDS)
def test_sameTrajectoryAndEnergiesAsTheEngine(plugin, build):
	"""Oblique impact of a ball on a block with plastic flow, fracture and contact: 500 steps, 1e-10 relative."""
	a, engine, broken = run('engine', 500, **build)
	b, law, brokenToo = run('law2', 500, **build)
	assert broken == brokenToo > 50 and b[:, 10].max() > 0.05
	scale = abs(a).max(axis=0)
	scale[:3] = scene.D
	assert (abs(a - b).max(axis=0) <= 1e-10 * scale).all()
	assert (a[:, 11] == b[:, 11]).all()
	for name in ('kinetic', 'volumetric', 'deviatoric', 'plastic', 'viscous', 'friction', 'fracture', 'coupling', 'total'):
		assert law[name] == pytest.approx(engine[name], abs=1e-9 * engine['kineticStart']), name
	assert law['total'] == pytest.approx(engine['kineticStart'], rel=3e-3)


BITS = """
import sys; sys.path[:0] = %r
import yade_mca
import law2_space_scene as scene
from yade import O
print('LEVEL', yade_mca.McaInfo().isa)
both = []
for road in 'engine', 'law2':
	O.reset()
	ids = scene.impact(exactMass=True)
	scene.engines(road, 2e-8)
	O.run(300, True)
	both.append(scene.state(ids))
print('RESULT', float((abs(both[0] - both[1]).max(axis=0) / abs(both[0]).max(axis=0)).max()), float(both[0][:, 10].max()))
"""


def test_roundOffAloneWithoutFusedOperations():
	"""Both loops call the same kernels: with the library for the oldest processors they differ by the order of sums alone."""
	done = subprocess.run(['/usr/bin/python3', '-c', BITS % sys.path], capture_output=True, text=True,
	                      env=dict(os.environ, GLIBC_TUNABLES='glibc.cpu.hwcaps=-AVX512F,-AVX2', MPLBACKEND='Agg'))
	assert done.returncode == 0, done.stderr
	assert 'LEVEL x86-64\n' in done.stdout
	different, strain = map(float, done.stdout.split('RESULT')[1].split())
	assert different < 1e-11 and strain > 0.05


def block(speed=0.):
	from yade import O
	O.reset()
	h = 1.01 * math.sqrt(2) * scene.D
	p = packings.fcc(scene.D, packings.Box((-h, 0, -h), (h, 2 * h, h)))
	return packings.addBodies(p, materials.mcaMat('4340', yieldModel='elastic'), velocity=(0, -speed, 0))


@pytest.mark.parametrize('what', ['wall', 'facet'])
def test_aBlockBouncesOffAWall(plugin, what):
	"""Momentum turns, nothing moves aside beyond round-off, and the wall feels the impulse."""
	from yade import O
	from yade.utils import facet, wall
	ids = block(10.)
	low = min(O.bodies[i].state.pos[1] for i in ids) - 0.5 * scene.D
	w = O.bodies.append(wall(low, axis=1) if what == 'wall' else facet([(-0.1, low, -0.1), (0, low, 0.2), (0.2, low, -0.1)], fixed=True))
	scene.engines('law2', 2e-8)
	mass = sum(O.bodies[i].state.mass for i in ids)
	impulse = 0.
	for _ in range(300):
		O.run(1, True)
		impulse += O.forces.f(w)[1] * O.dt
	v = sum((O.bodies[i].state.vel * O.bodies[i].state.mass for i in ids), start=0 * O.bodies[0].state.vel) / mass
	assert 0 < v[1] < 10 and abs(v[0]) + abs(v[2]) < 1e-9
	assert impulse == pytest.approx(-mass * (v[1] + 10.), rel=1e-9)
	assert law2_scene.density().dimension == 3


def test_gravityAndRest(plugin):
	from yade import O
	ids = block()
	scene.engines('law2', 2e-8, gravity=(0, -9.81, 0))
	O.run(50, True)
	v = np.array([O.bodies[i].state.vel for i in ids])
	assert v[:, 1] == pytest.approx(-9.81 * 50 * 2e-8, rel=1e-6) and abs(v[:, [0, 2]]).max() < 1e-10


def test_saveAndLoad(plugin, tmp_path):
	"""Saved in the middle of an impact, loaded, gone on with: the same numbers but for the order in which YADE sums contacts."""
	from yade import O
	O.reset()
	ids = scene.impact()
	scene.engines('law2', 2e-8)
	O.run(120, True)
	O.save(str(tmp_path / 'law.yade.bz2'))
	O.run(60, True)
	a = scene.state(ids)
	O.load(str(tmp_path / 'law.yade.bz2'))
	O.run(60, True)
	assert (a == scene.state(ids)).all()


def test_refusals(plugin):
	from yade import O
	ids = block()
	scene.engines('law2', 2e-8)
	law2_scene.density().volumeRule = 'meanDistance'
	with pytest.raises(RuntimeError, match='affine'): O.run(1, True)
	O.reset()
	p = packings.fcc(scene.D, packings.Box((-2e-3, 0, -2e-3), (2e-3, 4e-3, 2e-3)), mirror='xz', origin=(0, 0, 0))
	packings.addBodies(p, materials.mcaMat('4340'))
	scene.engines('law2', 2e-8)
	with pytest.raises(RuntimeError, match='mirrors.*McaEngine'): O.run(1, True)
	ids = block()
	scene.engines('law2', 2e-8)
	O.run(1, True)
	O.bodies[ids[0]].state.mass *= 0.3
	with pytest.raises(RuntimeError, match='volume it stands for'): O.run(1, True)
	ids = block()
	scene.engines('law2', 2e-8)
	O.run(1, True)
	O.bodies[ids[0]].state.inertia = (1, 2, 3)
	with pytest.raises(RuntimeError, match='inertia.*about all axes'): O.run(1, True)


def test_aGridIsNotTied(plugin):
	from yade import O
	from yade.wrapper import McaGridCoupler, McaGridEngine
	block()
	scene.engines('law2', 2e-8)
	g = McaGridEngine()
	g.addRectangle(materials.mcaMat('4340'), [k * scene.D for k in range(4)], [k * scene.D for k in (-2, -1, 0)], name='plate')
	O.engines = O.engines + [g, McaGridCoupler(side='top')]
	with pytest.raises(RuntimeError, match='in space.*plane strain'): O.run(1, True)


def test_clearedBodiesTakeTheirContactsAlong(plugin):
	"""Stock YADE leaves the interactions, and its loop would read the memory of the bodies."""
	from yade import O
	from yade.utils import wall
	ids = block(10.)
	O.bodies.append(wall(min(O.bodies[i].state.pos[1] for i in ids) - 0.45 * scene.D, axis=1))
	scene.engines('law2', 2e-8)
	O.run(3, True)
	assert any(i.isReal and i.phys.wall for i in O.interactions)
	O.bodies.clear()
	O.run(2, True)
	assert not list(O.interactions)
