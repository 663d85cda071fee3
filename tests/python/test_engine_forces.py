# SPDX-License-Identifier: GPL-2.0-or-later
"""McaEngine and forces that other engines of YADE put on the bodies; gravity. NewtonIntegrator takes no part: McaEngine moves the automata."""
import numpy as np
import pytest

import engine_scene as scene
from engine_scene import D


def lone(velocity=(0., 0.)):
	"""One automaton; id, mass, inertia."""
	from yade import O
	from yade_mca import materials, packings
	p = packings.hexagonal(D, packings.disc((0, 0), 0.6 * D), rim='full')
	assert len(p) == 1
	i = packings.addBodies(p, materials.mcaMat('4340', **scene.STEEL), velocity=velocity)[0]
	s = O.bodies[i].state
	return i, s.mass, s.inertia[2]


def engines(*others, dt=1e-8, **attributes):
	"""ForceResetter, engines that put forces, McaEngine that reads them."""
	from yade import O, ForceResetter
	e = scene.engine(dt, **dict(dict(readForces=True), **attributes))
	O.engines = [ForceResetter(), *others, e]
	return e


def test_forceEngineMovesABodyByNewtonsLaw(plugin):
	from yade import O, ForceEngine
	i, mass, _ = lone((1., 0.))
	f, n, dt = np.array((3e4, -2e4)), 50, 1e-8
	engines(ForceEngine(ids=[i], force=(*f, 0)), dt=dt)
	O.run(n, True)
	s = scene.states([i])[0]
	v = np.array((1., 0.)) + f / mass * n * dt  # the first kick lasts a whole step
	x = np.array((1., 0.)) * n * dt + f / mass * dt**2 * n * (n + 1) / 2
	assert s[2:4] == pytest.approx(v, rel=1e-13) and s[:2] == pytest.approx(x, rel=1e-12)


def test_torqueOfAnotherEngine(plugin):
	from yade import O, TorqueEngine
	i, _, inertia = lone()
	engines(TorqueEngine(ids=[i], moment=(0, 0, 2e-3)))
	O.run(20, True)
	assert scene.states([i])[0, 4] == pytest.approx(2e-3 / inertia * 20 * 1e-8, rel=1e-13)


def test_permanentForcesAndPyRunnerCount(plugin):
	from yade import O, PyRunner
	import builtins
	i, mass, _ = lone()
	O.forces.setPermF(i, (1e4, 0, 0))
	builtins.push = lambda: O.forces.addF(i, (0, 5e3, 0))
	engines(PyRunner(command='push()', iterPeriod=1, initRun=True))
	O.run(10, True)
	assert scene.states([i])[0, 2:4] == pytest.approx(np.array((1e4, 5e3)) / mass * 10 * 1e-8, rel=1e-12)


def test_withoutReadForcesTheyAreIgnored(plugin):
	from yade import O, ForceEngine
	i, *_ = lone()
	before = scene.states([i])
	engines(ForceEngine(ids=[i], force=(3e4, 0, 0)), readForces=False)
	O.run(10, True)
	assert np.array_equal(scene.states([i]), before)


def test_blockedDegreesOfFreedomResistForces(plugin):
	from yade import O, ForceEngine
	i, mass, _ = lone()
	scene.blocked([i], 'yzXYZ')
	e = engines(ForceEngine(ids=[i], force=(3e4, 3e4, 0)), account=True)
	O.run(10, True)
	s = scene.states([i])[0]
	assert s[3] == 0 and s[1] == O.bodies[i].state.refPos[1] and s[2] == pytest.approx(3e4 / mass * 1e-7, rel=1e-12)
	assert e.energies()['external'] == pytest.approx(0.5 * mass * s[2]**2, rel=1e-12)


def test_drivenByAForceOnABoundary(plugin):
	"""Traction on one end of a free bar: impulse and work of the force are those of the bar, and it is booked."""
	from yade import O, ForceEngine
	ids = scene.block(30, 6)
	x = scene.states(ids)[:, 0]
	end = ids[x < x.min() + 0.6 * D]
	e = engines(ForceEngine(ids=end.tolist(), force=(1e5, 0, 0)), dt=3e-8, account=True)
	O.run(500, True)
	now = e.energies()
	assert now['momentumX'] == pytest.approx(1e5 * len(end) * 500 * 3e-8, rel=1e-12) and abs(now['momentumY']) < 1e-12 * now['momentumX']
	assert now['impulseX'] == pytest.approx(now['momentumX'], rel=1e-12)
	assert abs(now['bookedError']) < 1e-12 * now['kinetic']
	# a velocity half a step behind the position: the independent sum oscillates by that
	assert now['total'] == pytest.approx(0, abs=5e-3 * now['kinetic'])


@pytest.mark.parametrize('road', ['attribute', 'GravityEngine'])
def test_gravity(plugin, road):
	from yade import O
	from yade.wrapper import GravityEngine
	ids = scene.block(6, 6)
	if road == 'attribute':
		scene.engine(1e-8, gravity=(0, -9.81))
	else:
		engines(GravityEngine(gravity=(0, -9.81, 0)))
	O.run(100, True)
	s = scene.states(ids)
	assert s[:, 3] == pytest.approx(-9.81 * 1e-6, rel=1e-4) and abs(s[:, 2]).max() < 1e-9  # round-off of the positions strains the pairs a little
	mass = np.array([O.bodies[int(i)].state.mass for i in ids])
	assert (mass * s[:, 3]).sum() == pytest.approx(-9.81 * 1e-6 * mass.sum(), rel=1e-12)


def test_otherBodiesHaveTheirOwnIntegrator(plugin):
	"""NewtonIntegrator moves what its mask selects; the automata, which it must leave alone, run as without it."""
	from yade import O, NewtonIntegrator, utils
	digests = []
	for other in (False, True):
		O.reset()
		scene.impact()
		e = engines(dt=2e-8)
		if other:
			O.materials.append(utils.FrictMat())
			ball = utils.sphere((0, 0.1, 0), 1e-3, material=O.materials[-1])
			ball.mask = 4
			ball = O.bodies.append(ball)
			O.engines = O.engines + [NewtonIntegrator(gravity=(0, -9.81, 0), damping=0, mask=4)]
		for _ in range(5):
			O.run(30, True)
		digests.append([e.field(k).tobytes() for k in scene.FIELDS])
	assert digests[0] == digests[1] and O.bodies[ball].state.vel[1] == pytest.approx(-9.81 * 150 * 2e-8, rel=1e-9)


def test_forceThatIsNotFiniteNamesTheBodyAndNothingMoves(plugin, tmp_path):
	from yade import O
	ids = scene.block(6, 6)
	e = engines()
	O.run(5, True)
	before = scene.states(ids)
	O.forces.setPermF(int(ids[7]), (float('nan'), 0, 0))
	with pytest.raises(RuntimeError) as error:
		O.step()
	assert 'body %d' % ids[7] in str(error.value) and 'not finite' in str(error.value)
	assert O.iter == 5 and np.array_equal(np.stack([e.field('x'), e.field('y')], axis=1), before[:, :2])
	O.save(str(tmp_path / 'after.yade'))
	O.forces.setPermF(int(ids[7]), (0, 0, 0))
	O.run(5, True)
	assert np.isfinite(scene.states(ids)).all()


def test_hotDebrisKeepsTheSumOfEnergies(plugin):
	"""Mie-Grueneisen, links break: what contacts had stored goes into the internal energy, and automata without links do the work their contacts do."""
	from yade import O
	from yade_mca import McaEngine
	scene.impact(speed=2500., n=12, constants=dict(scene.HARD, eos='mieGruneisen', viscosityLinear=0.25, viscosityQuadratic=1.5))
	e = McaEngine(account=True, dtFactor=0.2)
	O.engines = [e]
	O.run(1, True)
	first = e.energies()
	O.run(1600, True)
	now = e.energies()
	assert e.counters()['brokenLinks'] > 500
	assert abs(now['total'] - first['total']) < 0.006 * first['kinetic'], now['total'] / first['total'] - 1
