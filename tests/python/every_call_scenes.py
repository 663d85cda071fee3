# SPDX-License-Identifier: GPL-2.0-or-later
"""Small scenes in which test_every_call.py tries an object of each class, and the moments at which it does.

A class that is not in HOLDERS is put into O.engines after a McaEngine when it is an engine, and stands alone otherwise.
"""
import time

D = 1e-3


def metal(**overrides):
	"""All laws at once, so that each constant counts."""
	from yade_mca import materials
	strength = dict(fractureStrain=0.5, spallStrength=3e9, pairStrength=9e9, fractureStress=9e9, strengthRatio=1.2, strengthSpread=0.05)
	return materials.mcaMat('4340', **dict(dict(strength, eos='mieGruneisen', strengthDistribution='weibull', frictionAngle=0.2), **overrides))


def twoBlocks():
	from yade_mca import packings
	m = metal()
	at = lambda x, y, w, h: packings.hexagonal(D, packings.Rectangle((x * D, y * D), (w * D, h * D)), rim='full')
	packings.addBodies(at(0, 0, 4, 3), m, velocity=(0, 0), mask=1)
	packings.addBodies(at(0, 2.6, 2, 1), m, velocity=(3, -40), mask=3)


def engineScene(reuse=None):
	from yade import O
	from yade.wrapper import McaEngine
	twoBlocks()
	O.engines = [reuse or McaEngine(account=True)]


def law2Scene(reuse=None):
	from yade import O, utils
	from yade_mca.scenes import law2Engines
	twoBlocks()
	O.materials.append(utils.FrictMat(young=2e11, poisson=0.3, density=7800, frictionAngle=0.2, label='wall'))
	O.bodies.append(utils.wall(min(b.state.pos[1] for b in O.bodies) - 0.45 * D, axis=1, material='wall'))
	O.engines = law2Engines(stepFactor=0.4)
	if reuse is not None: O.engines = [reuse if type(e) is type(reuse) else e for e in O.engines]


def blocksScene(reuse=None):
	"""A grid as it is after its first block: all else may still be added."""
	from yade import O
	from yade.wrapper import McaGridEngine
	e = reuse or McaGridEngine()
	O.engines = [e]
	if reuse is None:
		m = metal()
		O.materials.append(m)
		e.addRectangle(m, [k * D for k in range(5)], [k * D for k in range(4)], name='plate')


def gridScene(reuse=None):
	from yade import O
	blocksScene(reuse)
	if reuse is not None: return
	e = O.engines[0]
	e.fix(0, 'left')
	e.setVelocity(0, (-5., 1.))
	e.addGauge((2 * D, 1.5 * D))


def coupledScene(reuse=None):
	from yade import O
	from yade_mca.tasks import trials
	trials.halves(metal(), 4 * trials.PITCH, 3, 3, velocity=lambda x, y: (5 + 0 * x, 2 + 0 * x), account=True)
	if reuse is not None: O.engines = [reuse if type(e) is type(reuse) else e for e in O.engines]


def engineOf(name):
	from yade import O
	return lambda: next(e for e in O.engines if type(e).__name__ == name)


def body(k, part):
	from yade import O
	return lambda: getattr(O.bodies[k], part)


def functorOf(name):
	from yade import O

	def find():
		loop = next(e for e in O.engines if type(e).__name__ == 'InteractionLoop')
		return next(f for d in (loop.physDispatcher, loop.lawDispatcher) for f in d.functors if type(f).__name__ == name)

	return find


def wallContact():
	from yade import O
	if O.interactions.countReal() == 0: O.step()  # contacts are made in the first step
	return next(i.phys for i in O.interactions if i.isReal and i.phys.wall)


def holders():
	"""Class -> list of (name of the scene, builds it, finds the object in it)."""
	road = lambda name: [('engine', engineScene, body(5, name)), ('law2', law2Scene, body(5, name))]
	out = {
	        'McaEngine': [('engine', engineScene, engineOf('McaEngine'))],
	        'McaGridEngine': [('blocks', blocksScene, engineOf('McaGridEngine')), ('grid', gridScene, engineOf('McaGridEngine'))],
	        'McaGridCoupler': [('coupled', coupledScene, engineOf('McaGridCoupler'))], 'McaMat': road('material'), 'McaState': road('state'),
	        'McaTimeStepper': [('coupled', coupledScene, engineOf('McaTimeStepper'))], 'McaPhys': [('law2', law2Scene, wallContact)]
	}
	for name in 'McaLaw', 'McaForces': out[name] = [('law2', law2Scene, engineOf(name))]
	for name in 'Ip2_McaMat_McaMat_McaPhys', 'Ip2_FrictMat_McaMat_McaPhys', 'Law2_ScGeom_McaPhys_Mca': out[name] = [('law2', law2Scene, functorOf(name))]
	return out


#: where YADE's own engines do not survive it, or there are no bodies at all
NOT_THERE = {('law2', 'noState'), ('grid', 'noState'), ('blocks', 'noState')}


def momentsOf(scene):
	if scene == 'alone': return ['before']
	if scene == 'blocks': return ['before']
	return [m for m in MOMENTS if (scene, m) not in NOT_THERE and (scene, m) != ('grid', 'before')]


def holdersOf(cls):
	from yade import O
	from yade.wrapper import Engine
	known = holders().get(cls.__name__)
	if known: return known
	made = []

	def alone(reuse=None):
		made[:] = [reuse or cls()]
		if issubclass(cls, Engine):
			engineScene()
			O.engines = O.engines + made

	return [('alone', alone, lambda: made[0])]


# ---- moments: each builds a scene and returns (object, what comes after the call)


def steps(n=2):
	from yade import O
	for _ in range(n): O.step()


def stop():
	"""Ends a run in the background between two steps. Right after O.pause() YADE's thread may still look at the scene, which O.reset() takes away."""
	from yade import O
	O.stopAtIter = O.iter + 300
	while O.running:
		if O.iter > O.stopAtIter: O.stopAtIter = O.iter + 3000  # it had passed before it was set
		time.sleep(1e-3)
	O.stopAtIter = 0
	time.sleep(5e-3)


def before(build, find):
	build()
	return find(), steps


def between(build, find):
	build()
	steps(3)
	return find(), steps


def afterLoad(build, find):
	from yade import O
	build()
	steps(3)
	O.saveTmp(quiet=True)
	O.loadTmp(quiet=True)
	return find(), steps


def stale(build, find):
	"""The handle of before a load: its scene is gone."""
	from yade import O
	build()
	thing = find()
	steps(3)
	O.saveTmp(quiet=True)
	O.loadTmp(quiet=True)
	return thing, lambda: None


def afterReset(build, find):
	"""The handle of before O.reset(), used afterwards in a new scene of the same kind where it is an engine."""
	from yade import O
	from yade.wrapper import Engine
	build()
	steps(3)
	thing = find()
	O.reset()

	def after():
		if isinstance(thing, Engine):
			build(thing)
			steps()

	return thing, after


def erased(build, find):
	from yade import O
	build()
	steps(3)
	left = sorted((b for b in O.bodies if type(b.material).__name__ == 'McaMat'), key=lambda b: b.state.pos[0])
	for b in left[:2]: O.bodies.erase(b.id)
	return find(), steps


def foreign(build, find):
	"""Bodies that are no automata beside them."""
	from yade import O, utils
	build()
	m = utils.FrictMat(young=2e11, poisson=0.3, density=7800)
	O.bodies.append(utils.sphere((0.1, 0.1, 0), 1e-3, material=m))
	O.bodies.append(utils.box((0.2, 0.2, 0), (1e-3, 1e-3, 1e-3), material=m))
	return find(), steps


def halfMade(build, find):
	"""Bodies without shape, material or state."""
	from yade import O, Body
	from yade_mca import materials
	build()
	steps(1)
	O.bodies.append(Body())
	b = Body()
	b.material = materials.mcaMat('4340')
	O.bodies.append(b)
	return find(), steps


def noState(build, find):
	from yade import O
	build()
	steps(1)
	thing = find()
	O.bodies[3].state = None
	return thing, steps


def emptyScene(build, find):
	"""All bodies are gone before the first step."""
	from yade import O
	build()
	thing = find()
	O.bodies.clear()
	return thing, steps


def running(build, find):
	from yade import O
	build()
	thing = find()
	steps(1)
	O.run(10**9, False)

	def after():
		time.sleep(4e-3)
		stop()
		steps(1)

	return thing, after


MOMENTS = {f.__name__: f for f in (before, between, afterLoad, stale, afterReset, erased, foreign, halfMade, noState, emptyScene, running)}
