# SPDX-License-Identifier: GPL-2.0-or-later
"""Single cases of ordinary scripting, each as a user typed it: the result is right, or the step is refused with the reason."""
import numpy as np
import pytest

import engine_scene as scene

DT = 1e-8


def block(velocity=(0., 0.), at=(0., 0.), mask=1, **constants):
	"""The body of the cases: 10 by 6 mm of spacing 1 mm, drifting as a whole. Ids."""
	from yade_mca import materials, packings
	p = packings.hexagonal(1e-3, packings.Rectangle(at, (10e-3, 6e-3)))
	return packings.addBodies(p, materials.mcaMat('4340', **constants), velocity=velocity, mask=mask)


def x(ids):
	return scene.states(ids)[:, 0]


def engine(**options):
	"""A McaEngine with a fixed step as the only engine."""
	return scene.engine(DT, **options)


def rightOrRefused(do, right):
	"""do() ends with an error that says something, or right() holds afterwards."""
	try:
		do()
	except RuntimeError as e:
		assert len(str(e)) > 40, str(e)
		return 'refused'
	right()
	return 'right'


def run(n=10):
	"""n steps; an error that YADE loses is one, too."""
	from yade import O
	start = O.iter
	O.run(n, True)
	assert O.iter == start + n, 'no error, but %d of %d steps' % (O.iter - start, n)


# the settled state is loaded, now it is hit
def hit(ids):
	from yade import O
	for i in ids: O.bodies[i].state.vel = (7., 0, 0)
	yield
	assert [O.bodies[i].state.vel[0] for i in ids] == pytest.approx([7.] * len(ids))


def erase(ids):
	from yade import O
	O.bodies.erase(ids[25])
	yield
	assert O.engines[0].count == len(ids) - 1


def add(ids):
	from yade import O
	new = block((3., 0.), (50e-3, 0.))
	before = x(new)
	yield
	assert O.engines[0].count == len(ids) + len(new) and x(new) == pytest.approx(before + 3. * 10 * DT, abs=1e-14)


def hold(ids):
	from yade import O
	for i in ids: O.bodies[i].state.blockedDOFs, O.bodies[i].state.vel = 'xyzXYZ', (-2., 0, 0)
	yield
	assert [O.bodies[i].state.vel[0] for i in ids] == [-2.] * len(ids)


@pytest.mark.parametrize('change', [hit, erase, add, hold])
def test_changeAfterLoadTmp(plugin, change):
	from yade import O
	from yade_mca import McaEngine
	ids = block()
	O.dt = DT
	O.engines = [McaEngine(adaptive=False)]
	run(10)
	O.saveTmp()
	O.loadTmp()
	c = change(ids)
	next(c)
	rightOrRefused(run, lambda: next(c, None))


# a run that is ended in another way than by its number of steps
def byTime():
	from yade import O
	O.stopAtTime = 19.5 * DT
	O.run()
	O.wait()
	O.stopAtTime = 0


def byPrompt():
	from yade import O
	O.run()
	while O.iter < 5: pass
	O.pause()


def byRunner():
	from yade import O
	from yade.wrapper import PyRunner
	O.engines = O.engines + [PyRunner(command='O.pause()', iterPeriod=20)]
	O.run()
	O.wait()


def byError():
	from yade import O
	from yade.wrapper import PyRunner
	O.engines = [PyRunner(command='1/0', iterPeriod=20)] + O.engines
	O.run()
	try:
		O.wait()
	except RuntimeError:  # of the PyRunner, when YADE does not lose it
		pass


@pytest.mark.parametrize('end', [byTime, byPrompt, byRunner, byError])
def test_endOfARun(plugin, tmp_path, end):
	from yade import O
	ids = block((100., 0.))
	start = x(ids)
	engine()
	end()
	n = O.iter
	assert x(ids) == pytest.approx(start + 100. * n * DT, abs=1e-13), 'bodies are behind'
	O.save(str(tmp_path / 'a.yade.gz'))
	O.engines = O.engines[:1] if end is not byError else O.engines[1:]
	for i in ids: O.bodies[i].state.vel = (-40., 0, 0)
	run(10)
	assert x(ids) == pytest.approx(start + (100. * n - 40. * 10) * DT, abs=1e-13), 'the change is lost'
	O.load(str(tmp_path / 'a.yade.gz'))
	assert x(ids) == pytest.approx(start + 100. * n * DT, abs=1e-13), 'the file is behind'


# a PyRunner that changes things
@pytest.mark.parametrize('first', [True, False])
@pytest.mark.parametrize('reload', [True, False])
def test_changesInAPyRunner(plugin, first, reload):
	"""In the first run and in a later one, with reload() and without."""
	import builtins
	from yade import O
	from yade.wrapper import PyRunner
	ids, far = block((100., 0.)), block((0., 0.), (0., 40e-3))
	start, gone = x(ids), far[20]
	e = engine()
	new = []

	def act():
		if new: return
		for i in ids: O.bodies[i].state.pos += (1e-3, 0, 0)
		O.bodies.erase(gone)
		new.extend(block((3., 0.), (0., 80e-3)))
		if reload: e.reload()

	builtins.act = act
	if not first: run(10)
	O.engines = [e, PyRunner(command='act()', iterPeriod=5, initRun=False)]
	before = O.iter
	O.run(20, True)
	n = O.iter
	assert n == before + 20 and new
	assert x(ids) == pytest.approx(start + 1e-3 + 100. * n * DT, abs=1e-13)
	assert e.count == len(ids) + len(far) - 1 + len(new)
	assert [O.bodies[i].state.vel[0] for i in new] == pytest.approx([3.] * len(new)) and x(new).max() > 4.5e-3


def test_reloadWithoutSyncDoesNotSetBodiesBack(plugin):
	import builtins
	from yade import O
	from yade.wrapper import PyRunner
	ids = block((100., 0.))
	start = x(ids)
	e = engine()
	run(10)
	builtins.act = e.reload
	O.engines = [e, PyRunner(command='act()', iterPeriod=5)]
	run(20)
	assert x(ids) == pytest.approx(start + 100. * 30 * DT, abs=1e-13)


# engines that do not go together
def test_anotherEngineInTheMiddleOfASimulation(plugin):
	"""Links stay broken and the stress stays, or the new engine is refused and the old one goes on."""
	from yade import O
	from yade_mca import McaEngine
	results = []
	for again in (False, True):
		O.reset()
		ids = np.concatenate(scene.impact())
		e = scene.engine(2e-8)
		run(400)
		assert e.counters()['brokenLinks'] > 30
		if again:
			O.engines = [McaEngine(adaptive=False)]
			try:
				run(100)
			except RuntimeError as error:
				assert len(str(error)) > 40
				O.engines = [e]
				run(100)
		else:
			run(100)
		results.append((scene.states(ids), set(O.engines[0].links())))
	assert results[1][1] == results[0][1]
	assert abs(results[1][0] - results[0][0]).max(axis=0) == pytest.approx(0, abs=1e-6)


def same():
	from yade import O
	e = engine()
	O.engines = [e, e]


def two():
	from yade import O
	from yade_mca import McaEngine
	O.engines = [engine(), McaEngine(adaptive=False)]


def newton(**options):
	from yade import O
	from yade.wrapper import NewtonIntegrator
	O.engines = [engine(), NewtonIntegrator(damping=0, **options)]


@pytest.mark.parametrize('engines', [same, two, newton, lambda: newton(gravity=(0, -1e6, 0))], ids=['same twice', 'two', 'NewtonIntegrator', 'its gravity'])
@pytest.mark.parametrize('split', [1, 2, 20])
def test_enginesThatMoveTheSameBodies(plugin, engines, split):
	from yade import O
	ids = block((100., 0.))
	start = scene.states(ids)
	O.dt = DT
	engines()
	g = getattr(O.engines[-1], 'gravity', (0, 0))[1] if type(O.engines[-1]).__name__ == 'NewtonIntegrator' else 0.

	def right():
		t = 20 * DT
		assert O.time == pytest.approx(t)
		now = scene.states(ids)
		assert now[:, 0] == pytest.approx(start[:, 0] + 100. * t, abs=1e-13)
		assert now[:, 3] == pytest.approx(g * t, abs=1e-9)

	rightOrRefused(lambda: [run(20 // split) for _ in range(split)], right)


# nothing to compute
def test_emptyScene(plugin):
	from yade import O
	from yade_mca import McaEngine
	O.engines = [McaEngine()]
	O.dt = DT

	def right():
		assert O.dt < 1 and O.time < 3

	rightOrRefused(lambda: run(2), right)
	right()
	ids = block((100., 0.))
	O.dt = DT
	O.engines = [McaEngine()]
	run(5)
	assert 0 < O.dt < 1e-6 and x(ids).max() > 4.5e-3


# a step that is refused once
@pytest.mark.parametrize('dt', [0., float('nan')])
@pytest.mark.parametrize('kind', ['McaEngine', 'McaGridEngine'])
def test_adaptiveStepRecovers(plugin, kind, dt):
	from yade import O
	from yade_mca import McaEngine, McaGridEngine, materials
	if kind == 'McaEngine':
		block((100., 0.))
		e = McaEngine()
	else:
		e = McaGridEngine()
		e.addRectangle(materials.mcaMat('4340'), np.arange(5) * 1e-3, np.arange(5) * 1e-3)
	O.engines = [e]
	run(5)
	good = O.dt
	O.dt = dt
	try:
		run(5)
	except RuntimeError as error:
		assert 'time step' in str(error) or 'O.dt' in str(error)
		run(5)
	assert 0 < O.dt <= 1.5 * good


# energy that leaves with erased bodies
def test_energyOfErasedBodiesIsBooked(plugin):
	from yade import O
	a, b = scene.impact(speed=300., n=20, constants=dict(scene.HARD, fractureStrain=np.inf, spallStrength=np.inf, strengthSpread=0.))
	e = engine(account=True)
	run(700)
	before = e.energies()
	assert before['total'] == pytest.approx(before['kineticStart'], rel=5e-3)
	middle = a[np.argsort(np.hypot(x(a) - x(a).min(), scene.states(a)[:, 1]))][:101]
	for i in middle.tolist(): O.bodies.erase(i)

	def right():
		now = e.energies()
		assert e.count == len(a) + len(b) - 101
		assert now['total'] / now['kineticStart'] == pytest.approx(before['total'] / before['kineticStart'], abs=2e-3)

	rightOrRefused(lambda: run(1), right)
