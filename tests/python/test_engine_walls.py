# SPDX-License-Identifier: GPL-2.0-or-later
"""McaEngine beside rigid bodies that YADE moves: walls, boxes, facets, spheres (12b), (12c): the law in YADE's loop, momentum, friction, save and load, refusals."""
import math

import law2_scene
import law2_space_scene
import numpy as np
import pytest
from yade_mca import materials, packings

D = 1e-3
R = D / 2


def block(dimension, velocity=(0., 0., 0.), angle=0., n=6, **constants):
	"""n by n spacings of elastic steel with its lowest automata at y = 0."""
	from yade import O
	O.reset()
	m = materials.mcaMat('4340', **dict(dict(yieldModel='elastic', frictionAngle=math.atan(0.3)), **constants))
	if dimension == 2: p = packings.hexagonal(D, packings.Rectangle((0, 0), (n * D, n * D)), angle=angle)
	else: p = packings.fcc(D, packings.Box((0, 0, 0), (n * D / 2, n * D / 2, n * D / 2)))
	low = p.positions[:, 1].min()
	p = p.translated((0, -low) if dimension == 2 else (0, -low, 0))
	return packings.addBodies(p, m, velocity=velocity[:dimension])


def floor(kind, y, angle=0.3, **options):
	"""A rigid body with its upper face at y."""
	from yade import O, utils
	from yade.wrapper import FrictMat
	m = FrictMat(young=1e11, frictionAngle=angle, density=7800.)
	O.materials.append(m)
	size = 50 * D
	if kind == 'wall': b = utils.wall(y, axis=1, material=m, **options)
	elif kind == 'sided': b = utils.wall(y, axis=1, sense=1, material=m, **options)
	elif kind == 'box': b = utils.box((0, y - 2 * D, 0), (size, 2 * D, size), fixed=True, material=m, **options)
	elif kind == 'turnedBox': b = utils.box((0, y - 2 * D, 0), (2 * D, size, size), orientation=utils.Quaternion((0, 0, 1), math.pi / 2), fixed=True, material=m, **options)
	elif kind == 'facet': b = utils.facet([(-4 * size, y, -4 * size), (4 * size, y, -4 * size), (0, y, 8 * size)], fixed=True, material=m, **options)
	return O.bodies.append(b)


def engine(dt=3e-8, others=(), **options):
	from yade import ForceResetter, O
	from yade_mca import McaEngine
	O.dt = dt
	e = McaEngine(adaptive=False, **options)
	O.engines = [ForceResetter(), e, *others]
	return e


def state(ids):
	from yade import O
	return np.array([(*O.bodies[i].state.pos, *O.bodies[i].state.vel, *O.bodies[i].state.angVel, O.bodies[i].state.pressure) for i in ids])


def run(dimension, kind, steps=250, velocity=(40., -60., 0.), road='engine', moving=0., angle=0.3):
	"""The states after an oblique impact on a floor; moving: along y with the block, so that only the frame differs [m/s]."""
	from yade import NewtonIntegrator, O, TranslationEngine
	ids = block(dimension, (velocity[0], velocity[1] + moving, velocity[2]))
	w = floor(kind, -1.02 * R, angle, mask=2 if moving else 1)
	if road == 'law2': (law2_scene if dimension == 2 else law2_space_scene).engines('law2', 3e-8)
	else: engine(others=[TranslationEngine(ids=[w], translationAxis=(0, 1, 0), velocity=moving), NewtonIntegrator(damping=0, mask=2)] if moving else [])
	O.run(steps, True)
	s = state(ids)
	s[:, 1] -= moving * O.time
	s[:, 4] -= moving
	return s


@pytest.mark.parametrize('dimension', [2, 3])
@pytest.mark.parametrize('kind', ['sided', 'box', 'turnedBox', 'facet'])
def test_wallsOfAnyKindAreTheSame(plugin, dimension, kind):
	a, b = run(dimension, 'wall'), run(dimension, kind)
	assert a[:, 4].mean() > 0 and abs(a[:, 3].mean() - 40.) > 1  # came back, friction has acted
	assert np.allclose(a, b, rtol=0, atol=1e-9 * abs(a).max(axis=0))


@pytest.mark.parametrize('dimension', [2, 3])
def test_aWallThatMovesAlong(plugin, dimension):
	a, b = run(dimension, 'wall'), run(dimension, 'wall', moving=25.)
	assert np.allclose(a, b, rtol=0, atol=1e-8 * abs(a).max(axis=0))


@pytest.mark.parametrize('dimension', [2, 3])
@pytest.mark.parametrize('angle, close', [(0., 1e-9), (0.3, 0.01)])
def test_theSameAsTheLawInYadesLoop(plugin, dimension, angle, close):
	"""With friction to a part of the overlap: ScGeom takes the slip at a whole radius from the centre, here it is taken where the force acts."""
	a, b = (run(dimension, 'wall', angle=angle, road=road) for road in ('engine', 'law2'))
	assert np.allclose(a, b, rtol=0, atol=close * abs(a).max(axis=0))


@pytest.mark.parametrize('dimension', [2, 3])
def test_whatTheWallGetsIsWhatTheBodyGives(plugin, dimension):
	"""Impulse and work: O.forces of the wall against momentum, the account against the energies."""
	from yade import O
	ids = block(dimension, (40., -60., 0.))
	w = floor('wall', -1.02 * R)
	e = engine(account=True)
	mass = np.array([O.bodies[i].state.mass for i in ids])
	start = mass @ state(ids)[:, 3:6]
	impulse = np.zeros(3)
	for _ in range(250):
		O.run(1, True)
		impulse += np.array(O.forces.f(w)) * O.dt
	gained = mass @ state(ids)[:, 3:6] - start
	assert gained[1] > 0.5 * abs(start[1])
	assert gained[:dimension] == pytest.approx(-impulse[:dimension], abs=1e-10 * abs(start[1]))
	energy = e.energies()
	assert abs(energy['bookedError']) < 1e-12 * energy['kineticStart']
	assert energy['total'] == pytest.approx(energy['kineticStart'], rel=1e-3)


def test_aSphereAndAutomataConserveMomentum(plugin):
	"""A free sphere of FrictMat flies into a block; NewtonIntegrator moves it. In plane strain its mass counts per 1 m."""
	from yade import NewtonIntegrator, O, utils
	from yade.wrapper import FrictMat
	for dimension in 2, 3:
		ids = block(dimension)
		O.materials.append(FrictMat(density=7800., frictionAngle=0.2))
		x = state(ids)
		at = np.array((x[:, 0].mean() + 0.4 * D, x[:, 1].max() + R + 3 * D + 0.02 * D, x[:, 2].mean()))
		ball = O.bodies.append(utils.sphere(at, 3 * D, material=O.materials[-1], mask=2))
		mass = np.array([O.bodies[i].state.mass for i in ids])
		O.bodies[ball].state.mass = 0.5 * mass.sum()
		O.bodies[ball].state.inertia = (1e-3 * D, ) * 3
		O.bodies[ball].state.vel = (5., -50., 0.)
		if dimension == 2: O.bodies[ball].state.blockedDOFs = 'zXY'
		e = engine(2e-8, [NewtonIntegrator(damping=0, mask=2)], account=True)
		e.adaptive = True  # steps that change from one to the next
		before = mass @ state(ids)[:, 3:6] + O.bodies[ball].state.mass * np.array(O.bodies[ball].state.vel)
		O.run(300, True)
		v = np.array(O.bodies[ball].state.vel)
		after = mass @ state(ids)[:, 3:6] + O.bodies[ball].state.mass * v
		assert v[1] > -40 and O.bodies[ball].state.angVel.norm() > 0
		assert after == pytest.approx(before, abs=1e-10 * abs(before[1]))
		assert abs(e.energies()['bookedError']) < 1e-12 * O.bodies[ball].state.mass * 50.**2


def test_aClumpOfSpheres(plugin):
	from yade import NewtonIntegrator, O, utils
	from yade.wrapper import FrictMat
	ids = block(3)
	O.materials.append(FrictMat(density=7800., frictionAngle=0.2))
	top = state(ids)[:, 1].max() + R
	clump, members = O.bodies.appendClumped([utils.sphere((D, top + 2.02 * D, D), 2 * D, material=O.materials[-1], mask=2), utils.sphere((3 * D, top + 3 * D, D), 2 * D, material=O.materials[-1], mask=2)])
	O.bodies[clump].mask = 2
	O.bodies[clump].state.vel = (0, -50, 0)
	mass = np.array([O.bodies[i].state.mass for i in ids])
	engine(2e-8, [NewtonIntegrator(damping=0, mask=2)])
	total = O.bodies[clump].state.mass * -50.
	O.run(200, True)
	s = O.bodies[clump].state
	assert s.vel[1] > -49 and s.angVel.norm() > 0
	assert (mass @ state(ids)[:, 4] + s.mass * s.vel[1]) == pytest.approx(total, rel=1e-9)


def test_frictionHoldsAndSlides(plugin):
	"""Pressed on a floor by gravity and pulled along it: below the Coulomb limit it stays, above it slides with the difference."""
	from yade import O
	for share in 0.5, 8.:
		ids = block(2, n=2, viscosityLinear=1.)
		floor('wall', -R, angle=math.atan(0.3))
		e = engine(4e-8, gravity=(0.3 * share * 1e8, -1e8))  # the weight is 1e8 m/s2 times the mass
		O.run(300, True)
		v = state(ids)[:, 3:5].mean(axis=0)
		pushed = v[1] + 1e8 * O.time  # impulse of the floor per mass, while the block bounces a little
		if share < 1: assert abs(v[0]) < 0.06 * 0.3e8 * O.time
		else: assert v[0] == pytest.approx(0.3 * share * 1e8 * O.time - 0.3 * pushed, rel=0.02) and pushed > 0


def test_facetsThatGoOnIntoEachOtherAreOneFace(plugin):
	"""A floor of 32 triangles and one of a wall: an edge that two of them share counts once."""
	from yade import O, utils
	found = []
	for kind in 'wall', 'mesh':
		ids = block(3, (0., -60., 0.))
		if kind == 'wall': floor('wall', -1.02 * R)
		else:
			n, h = 4, 2.03 * D
			for i in range(n):
				for j in range(n):
					a, b, y = (i - 1) * h, (j - 1) * h, -1.02 * R
					for corners in ((a, b), (a + h, b), (a + h, b + h)), ((a, b), (a + h, b + h), (a, b + h)):
						O.bodies.append(utils.facet([(x, y, z) for x, z in corners], fixed=True))
		engine()
		O.run(200, True)
		found.append(state(ids))
	assert np.allclose(*found, rtol=0, atol=1e-9 * abs(found[0]).max(axis=0))


@pytest.mark.parametrize('degrees, faces', [(0, 1), (5, 1), (40, 2)])
def test_aShallowValleyIsOneFaceADeepOneTwo(plugin, degrees, faces):
	"""The force on a lone automaton above the edge of two facets that rise to both sides: kn times the overlap with one, or the sum of two."""
	from yade import O, utils
	O.reset()
	m = materials.mcaMat('4340', yieldModel='elastic', frictionAngle=0)
	i = packings.addBodies(packings.hexagonal(D, packings.disc((0, 0), 0.6 * D), rim='full'), m)[0]
	a, overlap = math.radians(degrees), 0.02 * R
	deep = -(R - overlap) / math.cos(a)  # where the valley's bottom is
	for side in -1, 1:
		O.bodies.append(utils.facet([(0, deep, -5 * D), (0, deep, 5 * D), (side * 5 * D, deep + 5 * D * math.tan(a), 0)], fixed=True))
	engine(1e-9)
	O.run(1, True)
	kn = (m.density * m.bulkSoundSpeed**2 + 4 / 3 * m.shearModulus) * D / math.sqrt(3) * 2 / D
	v = np.array(O.bodies[i].state.vel)
	one = kn * overlap * O.dt / O.bodies[i].state.mass
	assert np.linalg.norm(v) == pytest.approx(one if faces == 1 else 2 * math.cos(a) * one, rel=1e-9)


def test_cornersHaveTwoFaces(plugin):
	"""Between a floor and a side wall both act."""
	from yade import O
	ids = block(2, (-60., -60., 0.))
	x = state(ids)[:, 0].min()
	floor('wall', -1.02 * R, angle=0)
	from yade import utils
	O.bodies.append(utils.wall(x - 1.02 * R, axis=0))
	engine()
	O.run(300, True)
	assert (state(ids)[:, 3:5].mean(axis=0) > 5).all()


@pytest.mark.parametrize('dimension', [2, 3])
def test_saveAndLoadInTheMiddleOfAContact(plugin, dimension, tmp_path):
	from yade import O
	ids = block(dimension, (40., -60., 0.))
	w = floor('wall', -1.02 * R)
	engine()
	O.run(60, True)
	assert O.forces.f(w)[0] != 0
	O.save(str(tmp_path / 'touching.yade'))
	O.run(100, True)
	one = state(ids)
	O.load(str(tmp_path / 'touching.yade'))
	O.run(100, True)
	assert np.array_equal(state(ids), one)


def test_whatChangesCountsFromTheNextStep(plugin):
	"""A wall is added, moved, given mask=0, erased."""
	from yade import O
	ids = block(2, (0., -60., 0.), n=3)
	e = engine()
	O.run(5, True)
	w = floor('wall', -1.3 * R)
	O.run(10, True)
	assert O.forces.f(w).norm() == 0
	O.bodies[w].state.pos = (0, state(ids)[:, 1].min() - 0.9 * R, 0)
	O.run(1, True)
	assert O.forces.f(w)[1] < 0
	O.bodies[w].mask = 0
	O.run(1, True)
	assert O.forces.f(w)[1] == 0
	O.bodies[w].mask = 1
	O.run(1, True)
	assert O.forces.f(w)[1] < 0
	O.bodies.erase(w)
	mass = np.array([O.bodies[i].state.mass for i in ids])
	before = mass @ state(ids)[:, 4]
	O.run(300, True)
	assert mass @ state(ids)[:, 4] == pytest.approx(before, rel=1e-12)  # flies on


def test_sweepAndSleep(plugin):
	"""A block at rest sleeps until a wall comes; the same engine after O.reset knows nothing of the old walls."""
	from yade import ForceResetter, NewtonIntegrator, O, TranslationEngine
	for _ in range(2):
		ids = block(2)
		w = floor('wall', -4 * R, mask=2)
		e = engine(3e-8, [TranslationEngine(ids=[w], translationAxis=(0, 1, 0), velocity=100.), NewtonIntegrator(damping=0, mask=2)])
		O.run(100, True)
		assert (state(ids)[:, 4] == 0).all() and e.counters()['awake'] == 0
		O.run(800, True)
		assert state(ids)[:, 4].mean() > 50
	ids = block(2)
	w = floor('wall', -20 * R)
	O.engines = [ForceResetter(), e]
	O.run(10, True)
	assert (state(ids)[:, 4] == 0).all() and O.forces.f(w).norm() == 0


def test_theStepKnowsOfContacts(plugin):
	from yade import O
	ids = block(2, (0., -60., 0.))
	floor('wall', -1.02 * R)
	engine(1e-8)
	O.run(1, True)
	from yade_mca import McaTimeStepper
	O.engines = [McaTimeStepper(factor=1.)] + O.engines
	steps = []
	for _ in range(60):
		O.run(1, True)
		steps.append(O.dt)
	assert 0.85 < min(steps) / max(steps) < 0.97


def test_refusals(plugin):
	from yade import O, utils
	from yade_mca import McaEngine
	ids = block(2)
	w = floor('wall', -1.02 * R)
	O.dt = 1e-8
	O.engines = [McaEngine(adaptive=False)]
	O.run(1, True)  # nothing touches it
	O.bodies[w].state.pos = (0, -0.9 * R, 0)
	with pytest.raises(RuntimeError, match='body %d: automata touch it, and its forces would add up from step to step: put a ForceResetter first' % w): O.run(1, True)
	engine()
	O.bodies[w].state.pos = (0, -0.2 * R, 0)
	with pytest.raises(RuntimeError, match='wall %d: the automaton.s centre is .* less than half of the radius' % w): O.run(1, True)
	O.bodies[w].state.pos = (0, float('nan'), 0)
	with pytest.raises(RuntimeError, match='body %d: its position, velocity or orientation is not finite' % w): O.run(1, True)
	O.bodies[w].state.pos = (0, -5 * R, 0)
	O.run(1, True)
	O.bodies[w].state.vel = (1, 0, 0)
	with pytest.raises(RuntimeError, match='body %d: its velocity of 1 m/s has not moved it in the last step' % w): O.run(3, True)
	O.bodies[w].state.vel, O.bodies[w].state.angVel = (0, 0, 0), (0, 0, 5)
	with pytest.raises(RuntimeError, match='body %d: its angVel of 5 rad/s has not turned it in the last step' % w): O.run(3, True)
	O.bodies[w].state.angVel = (0, 0, 0)
	O.bodies[w].material = None
	with pytest.raises(RuntimeError, match='body %d: .* give it a FrictMat' % w): O.run(1, True)
	block(2)
	f = O.bodies.append(utils.facet([(-0.1, -0.8 * R, 0.2 * D), (0.1, -0.8 * R, 0.2 * D), (0., -0.8 * R, 0.4)], fixed=True))
	engine()
	with pytest.raises(RuntimeError, match='wall %d: the surface ends, or is inclined, within the plane' % f): O.run(1, True)
