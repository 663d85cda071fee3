# SPDX-License-Identifier: GPL-2.0-or-later
"""A new class has all that a class of YADE has: attributes of every type, hooks, dispatch, timing, energy, arrays."""
import copy
import math
import pickle

import pytest
from abi_support import loadFixture

loadFixture()
from yade import O, Matrix3, Quaternion, Vector2, Vector3, Vector6
from yade import utils
from yade.wrapper import *

ALL = dict(
        real=-0.1, integer=-7, longInteger=2**62 + 1, boolean=False, text='Grüße "x" <&>', vector2i=(3, 4), vector3i=(5, 6, 7), vector2r=Vector2(.1, .2),
        vector3r=Vector3(.1, -.2, 1e-300), vector6r=Vector6(1, 2, 3, 4, 5, .1), matrix3r=Matrix3(1, 2, 3, 4, 5, 6, 7, 8, .1), quaternionr=Quaternion((0, 1, 0), .5), reals=[.1, 1e308],
        integers=[1, -2], texts=['a', ''], vectors2r=[Vector2(.3, .4)], vectors3r=[Vector3(.3, .4, .5), Vector3(1, 2, 3)]
)


@pytest.fixture(autouse=True)
def emptyScene():
	O.reset()
	yield
	O.reset()


@pytest.mark.parametrize('name', sorted(ALL))
def test_attributeSetAndRead(name):
	value = ALL[name]
	assert getattr(SdkEngine(**{name: value}), name) == type(getattr(SdkEngine(), name))(value)
	engine = SdkEngine()
	setattr(engine, name, value)
	assert engine.dict()[name] == getattr(engine, name) == getattr(SdkEngine(**{name: value}), name)


def test_vectorsAreReferred():
	engine = SdkEngine()
	engine.vector3r[2] = 9
	engine.matrix3r[0, 1] = 8
	assert engine.vector3r == Vector3(1, 2, 9) and engine.matrix3r[0, 1] == 8


def test_flags():
	engine = SdkEngine()
	with pytest.raises(AttributeError):
		engine.fixed = 1
	assert not hasattr(engine, 'hiddenNumber') and 'hiddenNumber' not in engine.dict()
	before = engine.nPostLoad
	engine.trigger = 5
	assert engine.nPostLoad == before + 1 and engine.trigger == 5


def test_wrongArgumentsAreErrors():
	with pytest.raises(AttributeError, match='nothingOfThatName'):
		SdkEngine(nothingOfThatName=1)
	with pytest.raises(RuntimeError, match='keyword'):
		SdkEngine(3)
	with pytest.raises(TypeError):
		SdkEngine(real='many')
	with pytest.raises(TypeError):
		SdkEngine(vectors3r=['x'])


def test_pointers():
	engine = SdkEngine(part=SdkSpecialPart(length=7), parts=[SdkPart(name='a'), SdkSpecialPart(name='b', extra=9)])
	assert engine.part.length == 7 and [p.name for p in engine.parts] == ['a', 'b'] and engine.parts[1].extra == 9
	engine.part.length = 8
	assert engine.part.length == 8
	engine.part = None
	assert engine.part is None


def test_knownEverywhere():
	import builtins
	import yade
	import yade.system
	assert builtins.SdkEngine is yade.wrapper.SdkEngine is yade.utils.SdkEngine
	assert 'SdkEngine' in yade.system.childClasses('GlobalEngine') and 'SdkMat' in yade.system.childClasses('Material')
	assert O.isChildClassOf('SdkPhysDerived', 'NormShearPhys') and 'SdkEngine' in O.plugins()
	doc = SdkEngine.real.__doc__
	assert 'a number [Pa]' in doc and ':ydefault:`2.5`' in doc and ':yattrtype:`Real`' in doc and ':yattrflags:`0`' in doc


def test_pickleAndDeepcopy():
	engine = SdkEngine(**ALL)
	for twin in (pickle.loads(pickle.dumps(engine)), copy.deepcopy(engine)):
		assert all(getattr(twin, name) == getattr(engine, name) for name in ALL)


def test_exceptionReachesTheScriptAndTheSceneGoesOn():
	O.engines = [SdkEngine(mode=1, label='bad')]
	for mode in (1, 2):
		O.engines[0].mode = mode
		with pytest.raises((RuntimeError, MemoryError)):
			O.step()
		O.engines[0].mode = 0
		O.step()
	assert len(O.engines[0].reals) == 2


def sdkScene(functors, material, n=4, steps=200):
	O.reset()
	O.materials.append(material)
	for i in range(n):
		O.bodies.append(utils.sphere((1.9 * i, 0, 0), 1, material=material))
	ip, law = functors
	O.engines = [
	        ForceResetter(),
	        InsertionSortCollider([Bo1_Sphere_Aabb()]),
	        InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [ip], [law]),
	        NewtonIntegrator(damping=0)
	]
	O.dt = 1e-4
	if steps: O.run(steps, True)
	return [b.state.pos[0] for b in O.bodies]


def test_lawInTheInteractionLoopEqualsStockLaw():
	stock = sdkScene((Ip2_FrictMat_FrictMat_FrictPhys(), Law2_ScGeom_FrictPhys_CundallStrack()), FrictMat(young=1e5, poisson=.3))
	stiffness = [i.phys.kn for i in O.interactions if i.isReal][0]
	for derived in (False, True):
		mine = sdkScene((Ip2_SdkMat_SdkMat_SdkPhys(stiffness=stiffness, derived=derived), Law2_ScGeom_SdkPhys_Spring()), SdkMat(young=1e5, poisson=.3))
		assert mine == stock  # same arithmetic: same bits
		contacts = [i.phys for i in O.interactions if i.isReal]
		assert contacts and all(isinstance(p, SdkPhysDerived) == derived and p.calls > 0 for p in contacts)


def test_stateOfTheMaterial():
	# YADE compares states with materials in the first step
	sdkScene((Ip2_SdkMat_SdkMat_SdkPhys(), Law2_ScGeom_SdkPhys_Spring()), SdkMat(young=1e5), steps=0)
	assert isinstance(O.bodies[0].state, SdkState)
	state = State()
	state.mass = 1
	O.bodies[0].state = state
	with pytest.raises(RuntimeError, match="doesn't correspond"):
		O.step()


def test_indicesFollowTheStockOnes():
	for mine, base in ((SdkMat, 'FrictMat'), (SdkState, 'State'), (SdkPhys, 'NormShearPhys'), (SdkPhysDerived, 'SdkPhys'), (SdkBall, 'Shape'), (SdkSphere, 'Sphere')):
		hierarchy = mine().dispHierarchy()
		assert hierarchy[0] == mine.__name__ and (base in hierarchy or base in ('State', 'Shape'))
	indices = [c().dispIndex for c in (SdkBall, SdkSphere, Sphere, Facet, Wall, Box)]
	assert len(set(indices)) == len(indices)


def test_shapeBoundAndGeometryFunctors():
	def run(make, bo, ig):
		O.reset()
		material = O.materials[O.materials.append(SdkMat(young=1e5))]
		for i in range(3):
			b = Body()
			b.shape, b.mat, b.state = make(), material, material.newAssocState()
			b.state.mass, b.state.inertia, b.state.pos = 1, (1, 1, 1), (1.9 * i, 0, 0)
			O.bodies.append(b)
		O.engines = [
		        ForceResetter(),
		        InsertionSortCollider([bo]),
		        InteractionLoop([ig], [Ip2_SdkMat_SdkMat_SdkPhys()], [Law2_ScGeom_SdkPhys_Spring()]),
		        NewtonIntegrator(damping=0)
		]
		O.dt = 1e-4
		O.run(100, True)
		return [tuple(b.state.pos) for b in O.bodies]

	stock = run(lambda: Sphere(radius=1), Bo1_Sphere_Aabb(), Ig2_Sphere_Sphere_ScGeom())
	assert run(lambda: SdkBall(r=1), Bo1_SdkBall_Aabb(), Ig2_SdkBall_SdkBall_ScGeom()) == stock
	assert run(lambda: SdkSphere(radius=1), Bo1_Sphere_Aabb(), Ig2_Sphere_Sphere_ScGeom()) == stock  # by the functors of its base
	assert Gl1_SdkBall().bases == ['SdkBall']


def test_periodicEngineAndTimeStepper():
	periodic = SdkPeriodic(iterPeriod=3)
	stepper = SdkTimeStepper(step=1e-6, timeStepUpdateInterval=2)
	O.engines = [stepper, periodic]
	O.run(20, True)
	assert periodic.runs == [3, 6, 9, 12, 15, 18]
	assert stepper.calls == 10 and O.dt == pytest.approx(1e-5)
	stepper.active = False
	O.run(5, True)
	assert stepper.calls == 10


def test_timingOfPhases():
	O.engines = [SdkEngine(label='sdk')]
	O.run(3, True)
	assert O.engines[0].timingDeltas.data == []  # off: nothing is measured
	O.timingEnabled = True
	try:
		O.run(5, True)
		data = O.engines[0].timingDeltas.data
		assert [d[0] for d in data] == ['forces', 'arrays'] and all(d[2] == 5 for d in data)
		assert 0 < sum(d[1] for d in data) <= O.engines[0].execTime
		import yade.timing
		yade.timing.stats()
		yade.timing.reset()
		assert O.engines[0].timingDeltas.data == []
	finally:
		O.timingEnabled = False


def test_energyAndForces():
	mass = sdkScene((Ip2_SdkMat_SdkMat_SdkPhys(), Law2_ScGeom_SdkPhys_Spring()), SdkMat(young=1e5)) and sum(b.state.mass for b in O.bodies)
	O.engines = O.engines[:3] + [SdkEngine(vector3r=(0, 0, .25), label='sdk')] + O.engines[3:]
	O.trackEnergy = True
	O.run(10, True)
	assert O.energy['sdkMass'] == 2 * mass  # set, not summed over steps
	elastic = sum(.5 * i.phys.normalForce.squaredNorm() / i.phys.kn for i in O.interactions if i.isReal)
	assert O.energy['sdkElastic'] == pytest.approx(elastic, rel=1e-14)
	assert O.forces.f(0)[2] == .25


def test_arrayViews():
	import gc

	import numpy
	engine = SdkEngine()
	engine.resize(1000)
	view = engine.view
	view[3] = 7.5
	assert engine.copy()[3] == 7.5 and view.dtype == numpy.float64 and view.shape == (1000,)
	copied = engine.copy()
	copied[3] = 0
	assert view[3] == 7.5
	del engine
	gc.collect()
	assert view[3] == 7.5 and view[999] == .25  # the view keeps the engine alive
	own = SdkEngine().viewOfOwn
	gc.collect()
	assert own.tolist() == [[1, 2, 3], [4, 5, 6]] and not own.flags.writeable
	with pytest.raises(ValueError):
		own[0, 0] = 1
	assert SdkEngine().viewOfOwn.base is not None


def test_arrayViewsDoNotLeak():
	import resource
	engine = SdkEngine()
	engine.resize(1 << 20)  # 8 MiB
	for _ in range(3):
		engine.copy()
	before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
	for _ in range(100):
		engine.copy()
		engine.view
	assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100 * 1024  # kB; a leak would be 800 MiB


def test_threadsInParallelLoop():
	"""The stock loop runs the functors on all threads; sums of forces stay right."""
	sdkScene((Ip2_SdkMat_SdkMat_SdkPhys(), Law2_ScGeom_SdkPhys_Spring()), SdkMat(young=1e5), n=50)
	assert abs(sum(b.state.mass * b.state.vel[0] for b in O.bodies)) < 1e-9 * max(b.state.mass * abs(b.state.vel[0]) for b in O.bodies)
	assert not any(math.isnan(b.state.pos[0]) for b in O.bodies)
