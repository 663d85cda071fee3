# SPDX-License-Identifier: GPL-2.0-or-later
"""Velocities and forces as tables of time on sets of automata: motion, work, save and load, refusals; a wall that a servo of YADE presses."""
import math

import engine_scene as scene
import numpy as np
import pytest
from engine_scene import D
from yade_mca import materials, packings

DT = 1e-8


def lone():
	from yade_mca import materials, packings
	return packings.addBodies(packings.hexagonal(D, packings.disc((0, 0), 0.6 * D), rim='full'), materials.mcaMat('4340', **scene.STEEL))[0]


def test_aTableOfVelocityIsTravelledExactly(plugin):
	"""Its integral, where its corners fall on steps."""
	from yade import O
	i = lone()
	e = scene.engine(DT)
	times, values = np.array((0., 20., 30., 60.)) * DT, np.array((0., 10., -5., -5.))
	e.prescribe([i], x=(times, values))
	start = scene.states([i])[0]
	for n in 20, 30, 45:
		O.run(n - O.iter, True)
		t = np.linspace(0, n * DT, 20 * n + 1)
		assert scene.states([i])[0, 0] - start[0] == pytest.approx(np.trapezoid(np.interp(t, times, values), t) if hasattr(np, 'trapezoid') else np.trapz(np.interp(t, times, values), t), rel=1e-12, abs=1e-20)
	assert scene.states([i])[0, 1] == start[1] and O.bodies[i].state.blockedDOFs == 'xzXY'


def test_aNumberIsWhatABlockedVelocityIs(plugin):
	from yade import O
	found = []
	for road in 'prescribe', 'hand':
		O.reset()
		ids = scene.block(8, 8)
		e = scene.engine(DT)
		left = ids[scene.states(ids)[:, 0] < -3 * D].tolist()
		if road == 'prescribe': e.prescribe(left, x=30., y=0)
		for i in left if road == 'hand' else ():
			O.bodies[i].state.blockedDOFs, O.bodies[i].state.vel = 'xyzXY', (30, 0, 0)
		O.run(100, True)
		found.append(scene.states(ids))
	assert np.array_equal(*found) and found[0][:, 2].max() > 30


def test_workAndImpulseAreBooked(plugin):
	from yade import O
	ids = scene.block(8, 8)
	e = scene.engine(DT, account=True)
	x = scene.states(ids)[:, 0]
	e.prescribe(ids[x < -3 * D].tolist(), x=((0, 1e-6), (0, 40.)))
	e.push(ids[x > 3 * D].tolist(), x=((0, 5e-7, 1e-6), (0, 2e6, 0)), y=1e5)
	O.run(300, True)
	energy = e.energies()
	assert energy['external'] > 0 and abs(energy['bookedError']) < 1e-12 * energy['kinetic']
	assert abs(energy['total']) < 0.01 * energy['external']  # minus the work of the outside: nothing, as at the start


def test_aTableOfForceByNewtonsLaw(plugin):
	from yade import O
	i = lone()
	m = O.bodies[i].state.mass
	e = scene.engine(DT)
	e.push([i], x=((0, 50 * DT), (0, 1e5)), y=-2e4)
	e.push([i], y=1e4)
	O.run(40, True)
	t = np.arange(40) * DT
	assert scene.states([i])[0, 2:4] == pytest.approx((np.interp(t, (0, 50 * DT), (0, 1e5)).sum() * DT / m, -1e4 * 40 * DT / m), rel=1e-12)
	e.clearLoads()
	v = scene.states([i])[0, 2:4]
	O.run(10, True)
	assert np.array_equal(scene.states([i])[0, 2:4], v)


def test_inSpace(plugin):
	from yade import O
	O.reset()
	ids = packings.addBodies(packings.fcc(D, packings.Ball((0, 0, 0), 2 * D)), materials.mcaMat('4340', yieldModel='elastic'))
	e = scene.engine(DT)
	e.prescribe(ids, z=((0, 10 * DT), (0, 20.)), y=3.)
	O.run(30, True)
	v = np.array([O.bodies[i].state.vel for i in ids])
	assert (v[:, 2] == 20.).all() and (v[:, 1] == 3.).all() and abs(v[:, 0]).max() < 1e-9


@pytest.mark.parametrize('end', ['.yade', '.xml'])
def test_saveAndLoad(plugin, tmp_path, end):
	from yade import O
	ids = scene.block(6, 6)
	e = scene.engine(DT)
	e.prescribe(ids[:4].tolist(), x=((0, 1e-6), (0, 50.)))
	e.push(ids[-4:].tolist(), y=((0, 1e-6), (0, 1e6)))
	O.run(40, True)
	file = str(tmp_path / ('loads' + end))
	O.save(file)
	O.run(40, True)
	one = scene.states(ids)
	O.load(file)
	O.run(40, True)
	assert np.array_equal(scene.states(ids), one)


def test_loadsGoWithTheirBodies(plugin):
	from yade import O
	ids = scene.block(6, 6).tolist()
	e = scene.engine(DT)
	e.prescribe(ids[:3], x=10.)
	e.push(ids[:3], y=1e4)
	O.run(5, True)
	O.bodies.erase(ids[0])
	O.run(5, True)
	assert scene.states(ids[1:3])[:, 2] == pytest.approx(10.)
	O.reset()
	ids = scene.block(6, 6)
	O.dt, O.engines = DT, [e]
	O.run(5, True)
	assert (scene.states(ids)[:, 2:] == 0).all()


def test_aServoPressesAWall(plugin):
	"""ServoPIDController of YADE, target force on the upper of two walls: at the end the stress of the block is the target over its width, by Hooke's law in plane strain."""
	from yade import ForceResetter, NewtonIntegrator, O, utils
	from yade.wrapper import FrictMat, ServoPIDController
	O.reset()
	n = 10
	m = materials.mcaMat('4340', yieldModel='elastic', viscosityLinear=2.)
	p = packings.hexagonal(D, packings.Rectangle((0, 0), (n * D, n * D)))
	ids = packings.addBodies(p, m)
	y = p.positions[:, 1]
	O.materials.append(FrictMat(frictionAngle=0))
	low = O.bodies.append(utils.wall(y.min() - 0.5 * D, axis=1, material=O.materials[-1], mask=2))
	top = O.bodies.append(utils.wall(y.max() + 0.5 * D, axis=1, material=O.materials[-1], mask=2))
	target = 2e6  # 0.2 GPa
	servo = ServoPIDController(ids=[top], axis=(0, 1, 0), maxVelocity=3., iterPeriod=1, kP=2e-6, target=target, translationAxis=(0, 1, 0), velocity=0)
	from yade_mca import McaEngine
	O.dt = 2.5e-8
	O.engines = [ForceResetter(), McaEngine(adaptive=False), servo, NewtonIntegrator(damping=0, mask=2)]
	forces = []
	for _ in range(100):
		O.run(40, True)
		forces.append((O.forces.f(top)[1], -O.forces.f(low)[1]))
	up, down = np.mean(forces[60:], axis=0)
	assert up == pytest.approx(target, rel=0.03) and down == pytest.approx(target, rel=0.03)
	rows = np.abs(y) < 2 * D
	s = np.array([O.bodies[i].state.pressure for i in ids])[rows]
	assert s.mean() == pytest.approx(target / (n * D) * (1 + m.poisson) / 3, rel=0.15)  # held along z alone: (s_y + nu s_y)/3


def test_refusals(plugin):
	from yade import O
	ids = scene.block(6, 6).tolist()
	e = scene.engine(DT)
	for call in e.prescribe, e.push:
		for given, words in (dict(x=((0, 1), (2., ))), 'x'), (dict(y=((1, 0), (2., 3.))), 'y'), (dict(x='fast'), 'x'), (dict(x=math.nan), 'x'), (dict(z=1.), 'z must be None'):
			with pytest.raises(RuntimeError, match=words): call(ids[:2], **given)
		with pytest.raises(RuntimeError, match='there is no body 99999'): call([99999], x=1.)
		with pytest.raises(RuntimeError, match='names a body twice'): call([ids[0], ids[0]], x=1.)
		with pytest.raises(RuntimeError, match='names no body'): call([], x=1.)
	e.prescribe(ids[:2], x=1.)
	O.run(1, True)
	O.bodies[ids[0]].state.blockedDOFs = 'zXY'
	with pytest.raises(RuntimeError, match='automaton %d has a prescribed velocity and is free' % ids[0]): O.run(1, True)


def test_aVelocitySetWherePrescribeDrivesIsRefused(plugin):
	from yade import O
	ids = scene.block(6, 6).tolist()
	e = scene.engine(DT)
	e.prescribe(ids[:4], x=5.)
	O.run(5, True)
	O.bodies[ids[1]].state.vel = (5, 7, 0)  # along y nothing is prescribed
	O.run(5, True)
	O.bodies[ids[0]].state.vel = (9, 0, 0)
	with pytest.raises(RuntimeError, match='vel along x was set to 9'):
		O.run(1, True)
	O.bodies[ids[0]].state.vel = (5, 0, 0)
	O.run(1, True)
	e.clearLoads()
	O.bodies[ids[0]].state.vel = (9, 0, 0)
	O.run(1, True)
	assert O.bodies[ids[0]].state.vel[0] == 9


def test_materialsChangeFromStageToStage(plugin):
	"""Squeezed beyond 0.8 GPa: elastic in the first stage, soft in the second, by constants changed in place and by another material for some bodies."""
	from yade import O
	ids = scene.block(8, 8, constants=dict(scene.STEEL, yieldModel='perfect', yieldStress=5e9)).tolist()
	e = scene.engine(DT)
	e.damping = 0.3
	x = scene.states(np.array(ids))[:, 0]
	e.prescribe(np.array(ids)[x < x.min() + 0.6 * D].tolist(), x=((0, 1e-6), (0, 30.)))
	e.prescribe(np.array(ids)[x > x.max() - 0.6 * D].tolist(), x=((0, 1e-6), (0, -30.)))
	O.run(200, True)
	assert e.field('plasticStrain').max() == 0 and e.field('equivalentStress').max() > 0.5e9
	O.bodies[ids[0]].mat.yieldStress = 0.3e9
	O.run(50, True)
	assert e.field('plasticStrain').max() > 0 and e.field('equivalentStress').max() < 0.3e9 * 1.0001
	weak = materials.mcaMat('4340', **dict(scene.STEEL, yieldModel='perfect', yieldStress=0.1e9))
	for i in ids[:20]: O.bodies[i].mat = weak
	O.run(50, True)
	sigma = e.field('equivalentStress')
	assert sigma[:20].max() < 0.1e9 * 1.0001 and sigma.max() > 0.2e9


def test_loadsGivenBeforeTheFirstStepAreSaved(plugin, tmp_path):
	from yade import O
	found = []
	for again in False, True:
		O.reset()
		ids = scene.block(6, 6).tolist()
		e = scene.engine(DT)
		e.prescribe(ids[:4], x=5.)
		e.press(ids, 1e8)
		e.push(ids[-3:], y=1e5)
		if again: O.save(str(tmp_path / 's.yade.gz')), O.load(str(tmp_path / 's.yade.gz'))
		O.run(30, True)
		O.bodies.erase(ids[-1])
		O.engines[0].push(ids[-2:-1], x=1e5)
		O.run(30, True)
		found.append(scene.states(ids[:-1]))
	assert np.array_equal(*found) and found[0][0, 2] == 5


def test_bodiesThatJoinInAPauseKeepWhatTheyGet(plugin):
	from yade import O
	ids = scene.block(6, 6).tolist()
	e = scene.engine(DT)
	O.run(5, True)
	new = scene.block(3, 3, at=(0, 9 * D), mask=2).tolist()
	e.prescribe(new, x=7., y=0)
	O.run(5, True)
	assert (scene.states(new)[:, 2] == 7).all()


def test_pressNeedsTheAffineRule(plugin):
	ids = scene.block(6, 6).tolist()
	with pytest.raises(RuntimeError, match="needs volumeRule 'affine'"):
		scene.engine(DT, volumeRule='inversePower').press(ids, 1e8)
