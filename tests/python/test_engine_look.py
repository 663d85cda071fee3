# SPDX-License-Identifier: GPL-2.0-or-later
"""McaEngine: when the bodies are up to date, the order in which they were made, what O.energy holds."""
import numpy as np
import pytest

import engine_scene as scene


def behind(e, ids):
	"""The bodies are not where the solver has them."""
	return not np.array_equal(scene.states(ids)[:, 0], scene.pick(e, ids, 'x'))


def test_bodiesAreWrittenAtTheEndOfARun(plugin):
	from yade import O
	ids = scene.block(6, 6, velocity=(5., 1.))
	e = scene.engine(1e-8)
	O.run(7, True)
	assert not behind(e, ids) and e.lastWritten == 6
	s = O.bodies[int(ids[0])].state
	assert s.pos[0] == scene.pick(e, ids[:1], 'x')[0] and s.vel[0] == scene.pick(e, ids[:1], 'vx')[0] and s.links > 0


def look(n, **attributes):
	"""(step, bodies behind) as a PyRunner sees it that runs in every step, behind McaEngine and in front of it."""
	from yade import O, PyRunner
	import builtins
	ids = scene.block(6, 6, velocity=(5., 1.))
	e = scene.engine(1e-8, **attributes)
	seen = {True: [], False: []}
	builtins.look = lambda after: seen[after].append((O.iter, behind(e, ids), e.lastWritten))
	O.engines = [PyRunner(command='look(False)', iterPeriod=1), e, PyRunner(command='look(True)', iterPeriod=1)]
	O.run(n, True)
	return seen[False], seen[True]


def test_aRunnerSeesThePresentStateWhereverItStands(plugin):
	before, after = look(6)
	assert [late for _, late, _ in before + after] == [False] * len(before + after) and len(after) >= 5
	assert all(written == step for step, _, written in after) and all(written == step - 1 for step, _, written in before)


def test_nobodyLooksNothingIsWritten(plugin):
	"""Runners that are not due cost no writing; writePeriod writes for those who look from outside."""
	from yade import O, PyRunner
	scene.block(6, 6, velocity=(5., 1.))
	e = scene.engine(1e-8)
	O.engines = [e, PyRunner(command='written.append(engine.lastWritten)', iterPeriod=7)]
	import builtins
	builtins.written, builtins.engine = [], e
	O.run(30, True)
	assert e.lastWritten == 29 and all((b - a) % 7 == 0 for a, b in zip(builtins.written, builtins.written[1:]))
	O.engines = [e]
	O.run(20)
	while O.running: pass
	assert e.lastWritten == 49
	e.writePeriod = 5
	O.stopAtIter = 0
	O.run()
	start = O.iter
	while O.iter < start + 20: pass
	seen = e.lastWritten
	O.pause()
	assert (seen + 1) % 5 == 0 and e.lastWritten == O.iter - 1


def test_whatIsWrittenBetweenTwoStepsIsTheEndOfTheLast(plugin):
	"""The next one is counted by then."""
	from yade import O
	ids = scene.block(6, 6, velocity=(5., 1.))
	e = scene.engine(1e-8)
	O.run(7, True)
	O.bodies[int(ids[0])].state.vel[0] += 1.
	e.sync()
	assert e.lastWritten == 6
	O.run(3, True)
	assert e.lastWritten == 9


def test_singleStepsShowOnTheBodies(plugin):
	"""O.step() is a run of one step: whoever looks afterwards sees it."""
	from yade import O
	ids = scene.block(6, 6, velocity=(5., 1.))
	e = scene.engine(1e-8)
	for _ in range(3):
		O.step()
		assert not behind(e, ids)


def test_lookingChangesNoBit(plugin):
	from yade import O
	digests = set()
	for period in (0, 1, 7):
		O.reset()
		scene.impact()
		e = scene.engine(writePeriod=period)
		O.run(250, True)
		digests.add(scene.digest(e))
	O.reset()
	scene.impact()
	e = scene.engine()
	for _ in range(10):
		O.run(25, True)
		e.sync(), e.energies(), e.field('pressure')
	digests.add(scene.digest(e))
	assert len(digests) == 1


ORDERS = (None, lambda n: np.random.default_rng(5).permutation(n), lambda n: np.arange(n)[::-1])


def inAllOrders(build, steps, **attributes):
	"""Fields after a run, body by body, for bodies made row by row, in random and in reverse order."""
	from yade import O
	found = []
	for order in ORDERS:
		O.reset()
		ids = np.concatenate(build(order))
		e = scene.engine(**attributes)
		O.run(steps, True)
		assert np.array_equal(e.ids, np.sort(ids)) and e.field('plasticStrain').max() > 0.02
		found.append(np.stack([scene.pick(e, ids, k) for k in ('x', 'y', 'vx', 'vy', 'pressure', 'plasticStrain', 'links')]))
	return found


def test_orderOfTheBodiesChangesNoBit(plugin):
	def build(order):
		from yade import O
		ids = scene.block(20, 12, order=order, constants=dict(scene.HARD, strengthSpread=0., fractureStrain=np.inf))  # strengths are drawn by id
		for i in ids.tolist():
			s = O.bodies[i].state
			s.vel = (80 * np.sin(300 * s.pos[0] + 200 * s.pos[1]), 80 * np.cos(250 * s.pos[1]), 0)
		return [ids]

	a, b, c = inAllOrders(build, 300, contacts=False)  # forces of contacts are added up by id: the next test
	assert np.array_equal(a, b) and np.array_equal(a, c)


def test_orderOfTheBodiesAndContacts(plugin):
	"""Forces of contacts are added up by id, so with them the order counts in the last bit, and no more before the motion becomes chaotic."""
	found = inAllOrders(lambda order: scene.impact(order=order, constants=dict(scene.HARD, strengthSpread=0.)), 130)
	scale = abs(found[0]).max(axis=1)[:, None]
	assert (abs(found[1] - found[0]) < 1e-10 * scale).all() and (abs(found[2] - found[0]) < 1e-10 * scale).all()


def test_idsNeedNotBeConsecutive(plugin):
	from yade import O, utils
	other = utils.FrictMat()
	O.materials.append(other)
	O.bodies.append([utils.sphere((k, 5, 5), 0.1, material=other) for k in range(3)])
	a = scene.block(5, 5, velocity=(1., 0.))
	O.bodies.append([utils.sphere((k, 6, 6), 0.1, material=other) for k in range(3)])
	b = scene.block(5, 5, at=(50e-3, 0), velocity=(2., 0.))
	e = scene.engine(1e-8)
	O.run(5, True)
	assert e.count == len(a) + len(b)
	assert scene.pick(e, a, 'vx') == pytest.approx(1.) and scene.pick(e, b, 'vx') == pytest.approx(2.)
	assert O.bodies[0].state.pos == O.bodies[0].state.refPos  # others are left alone


def test_everyFieldHasOneNumberPerBody(plugin):
	ids = scene.block(5, 5)
	e = scene.engine(1e-8)
	for name in ('x', 'y', 'vx', 'vy', 'omega', 'angle', 'mass', 'pressure', 'volumeRatio', 'equivalentStress', 'plasticStrain', 'temperature', 'stressZZ', 'fx', 'fy', 'links', 'brokenLinks', 'strength', 'diameter', 'weight', 'material'):
		f = e.field(name)
		assert f.shape == (len(ids), ) and np.isfinite(f).all(), name
	with pytest.raises(RuntimeError, match="name = 'speed' is unknown; it must be one of x, y"):
		e.field('speed')


def test_severalFieldsAreThoseOfOneLook(plugin):
	ids = scene.impact()
	e = scene.engine()
	from yade import O
	O.run(60, True)
	names = ['pressure', 'x', 'links', 'equivalentStress', 'material']
	found = e.fields(['ids', *names])
	assert list(found) == ['ids', *names] and found['ids'].dtype.kind == 'i' and np.array_equal(found['ids'], np.sort(np.concatenate(ids)))
	for name in names: assert np.array_equal(found[name], e.field(name)), name
	assert e.fields([]) == {} and list(e.fields(('x', 'x'))) == ['x']
	with pytest.raises(RuntimeError, match="McaEngine.fields: names: name = 'speed' is unknown; it must be one of x, y"):
		e.fields(['x', 'speed'])
	for wrong in ('x', None, 5, [5], ['x', None], {'x': 1}):
		with pytest.raises(TypeError, match='McaEngine.fields: names must be a list or tuple of texts'):
			e.fields(wrong)


READS = {'field': lambda e: e.field('vx'), 'fields': lambda e: e.fields(['vx'])['vx'], 'momentum': lambda e: e.momentum[0], 'energies': lambda e: e.energies()['momentumX']}


@pytest.mark.parametrize('read', sorted(READS))
def test_aChangeByAHandleThatWasKeptIsRead(plugin, read):
	"""Nothing tells the engine that a state has changed: each look compares all bodies. Before the first step, after steps, twice."""
	from yade import O
	ids = scene.block(6, 6)
	e = scene.engine(1e-9)
	states = [O.bodies[int(i)].state for i in ids]
	mass = states[7].mass
	for speed in 3., -2., 5.:
		states[7].vel = (speed, 0, 0)
		now = READS[read](e)
		assert (now == pytest.approx(mass * speed) if np.isscalar(now) else (now[7] == speed and abs(now).max() == abs(speed)))
		states[7].vel = (0, 0, 0)
		assert not np.any(READS[read](e))
		O.run(2, True)


@pytest.mark.parametrize('attribute, value, quantity', [('pos', 1e-6, 'x'), ('vel', 1., 'vx'), ('temperature', 301., 'temperature'), ('plasticStrain', 0.01, 'plasticStrain'), ('strength', 1.5, 'strength')])
def test_everyKindOfChangeIsReadAtOnce(plugin, attribute, value, quantity):
	from yade import O
	ids = scene.block(6, 6)
	e = scene.engine(1e-9)
	O.run(2, True)
	state = O.bodies[int(ids[7])].state
	wanted = getattr(state, attribute) + (value, 0, 0) if attribute in ('pos', 'vel') else value
	setattr(state, attribute, wanted)
	assert e.fields([quantity])[quantity][7] == (wanted[0] if attribute in ('pos', 'vel') else wanted)


@pytest.mark.parametrize('attribute, value', [('vel', (7., 0, 0)), ('pos', (1e-6, 0, 0)), ('angVel', (0, 0, 5.)), ('temperature', 333.), ('plasticStrain', 0.02)])
def test_aChangeWhileTheBodiesAreNotUpToDateIsToldAsLost(plugin, attribute, value):
	"""Unless reload() follows it. Which step would have met it is chance, so it is not taken over silently."""
	from yade import O
	ids = scene.block(6, 6, velocity=(5., 1.))
	scene.engine(1e-9)
	state = O.bodies[int(ids[7])].state
	O.run()
	while O.iter < 20: pass
	setattr(state, attribute, value)
	meets = O.iter + 20
	while O.iter < meets: pass
	O.pause()
	with pytest.raises(RuntimeError, match='body %d was changed by a script while the loop ran in the background' % ids[7]):
		O.run(1, True)
	assert abs(np.array(getattr(state, attribute)) - value).max() > 1e-9  # what the engine holds
	O.run(3, True)


def test_aBodyKeepsItsOrientationAndTurns(plugin):
	"""The quaternion is made anew only when the angle has changed."""
	from yade import O
	ids = scene.block(6, 6)
	e = scene.engine(1e-9)
	for i in ids.tolist(): O.bodies[i].state.angVel = (0, 0, 1e4)
	for n in (1, 3, 1):
		O.run(n, True)
		angle = scene.pick(e, ids, 'angle')
		w = np.array([O.bodies[int(i)].state.ori[3] for i in ids])
		assert angle.min() > 0 and w == pytest.approx(np.cos(0.5 * angle), abs=1e-15)


def test_theCouplersSumsCountAChangeByAHandle(plugin):
	from yade import O
	from yade_mca import scenes
	s = scenes.penetration(thickness=10e-3, spacing=2e-3)
	O.run(3, True)
	before, i = s.couplers[0].energies()['momentumX'], int(s.ids['rod'][-1])
	state = O.bodies[i].state
	state.vel = (100., state.vel[1], 0)
	assert s.couplers[0].energies()['momentumX'] - before == pytest.approx(100. * state.mass, rel=1e-6)


def test_energyEntries(plugin):
	"""O.energy holds each item of the account under a name of its own; the sum of all is the kinetic energy at the start."""
	from yade import O
	O.trackEnergy = True
	scene.impact(speed=200.)
	e = scene.engine()
	O.run(300, True)
	own, tracked = e.energies(), dict(O.energy.items())
	for name in 'kinetic', 'volumetric', 'deviatoric', 'plastic', 'viscous', 'friction', 'fracture', 'coupling', 'boundary':
		assert tracked['mca' + name.capitalize()] == own[name], name
	assert tracked['mcaExternal'] == -own['external']
	assert O.energy.total() == pytest.approx(own['total'], rel=1e-12)
	assert abs(own['bookedError']) < 1e-10 * own['kineticStart']
	assert min(own[k] for k in ('plastic', 'viscous', 'friction')) > 0


def test_energySumOfAPlasticBlock(plugin):
	"""The sum from state functions and dissipations is that at the start within 0.1 % at the default step, and nearer with a smaller one."""
	from yade import O
	off = []
	for factor in (0.4, 0.1):
		O.reset()
		ids = scene.block(10, 10, rim='full', constants=dict(scene.HARD, fractureStrain=np.inf, spallStrength=np.inf))
		for i in ids.tolist():
			s = O.bodies[i].state
			s.vel = (60 * np.sin(300 * s.pos[0]) + 60 * np.cos(260 * s.pos[1]), -60 * np.sin(280 * s.pos[1] + 1), 0)
		e = scene.engine(account=True, dtFactor=factor)
		while O.time < 1e-5:
			O.run(20, True)
		now = e.energies()
		assert now['plastic'] > 0.2 * now['kineticStart']
		off.append(abs(now['total'] / now['kineticStart'] - 1))
	assert off[0] < 1e-3 and off[1] < 0.5 * off[0]
