# SPDX-License-Identifier: GPL-2.0-or-later
"""McaEngine: each bad input and broken run ends in one message with body, value and remedy; the scene can be saved and goes on when it is mended."""
import numpy as np
import pytest

import engine_scene as scene
from engine_scene import D


def refused(n=1):
	"""Message of the error that n steps end with. By O.step(): O.run(n, True) of YADE loses an error that comes before it begins to wait."""
	from yade import O
	with pytest.raises(RuntimeError) as e:
		for _ in range(n):
			O.step()
	return str(e.value)


def state(k):
	from yade import O
	return O.bodies[int(k)].state


def material(k):
	from yade import O
	return O.bodies[int(k)].material


NAN, INF = float('nan'), float('inf')
#: what spoils body k, what mends it, words of the message ('{k}' is the body)
INPUT = {
        'position not finite': (lambda k: setattr(state(k), 'pos', (NAN, 0, 0)), lambda k: setattr(state(k), 'pos', state(k).refPos), ['{k}', 'finite']),
        'velocity not finite': (lambda k: setattr(state(k), 'vel', (0, INF, 0)), lambda k: setattr(state(k), 'vel', (0, 0, 0)), ['{k}', 'finite']),
        'spin not finite': (lambda k: setattr(state(k), 'angVel', (0, 0, NAN)), lambda k: setattr(state(k), 'angVel', (0, 0, 0)), ['{k}', 'finite']),
        'zero mass': (lambda k: setattr(state(k), 'mass', 0.), lambda k: setattr(state(k), 'mass', state(k + 1).mass), ['automaton {k}', 'mass 0', 'above zero']),
        'negative mass': (lambda k: setattr(state(k), 'mass', -1.), lambda k: setattr(state(k), 'mass', state(k + 1).mass), ['automaton {k}', 'mass -1', 'above zero']),
        'mass of a sphere': (lambda k: setattr(state(k), 'mass', 4e-6), lambda k: setattr(state(k), 'mass', state(k + 1).mass), ['body {k}', 'full cell', 'addBodies']),
        'no inertia': (lambda k: setattr(state(k), 'inertia', (0, 0, 0)), lambda k: setattr(state(k), 'inertia', state(k + 1).inertia), ['automaton {k}', 'inertia 0', 'block the rotation']),
        'negative plastic strain': (lambda k: setattr(state(k), 'plasticStrain', -0.1), lambda k: setattr(state(k), 'plasticStrain', 0.), ['body {k}', '-0.1', 'from 0']),
        'coincident bodies': (lambda k: setattr(state(k), 'pos', state(k + 1).pos), lambda k: setattr(state(k), 'pos', state(k).refPos), ['automata', '{k} at', '{k+1} at', '0 rest distances', 'Remedy']),
        'negative slope': (lambda k: setattr(material(k), 'hugoniotSlope', -0.5), lambda k: setattr(material(k), 'hugoniotSlope', 1.3), ["material '4340'", 'hugoniotSlope', '-0.5', 'not negative']),
        'negative yield stress': (lambda k: setattr(material(k), 'yieldStress', -1e6), lambda k: setattr(material(k), 'yieldStress', 1e9), ["material '4340'", 'yieldStress', '-1e+06', 'not negative']),
        'unknown yield model': (lambda k: setattr(material(k), 'yieldModel', 'soft'), lambda k: setattr(material(k), 'yieldModel', 'elastic'), ["material '4340'", "'soft'", 'one of']),
        'unknown equation of state': (lambda k: setattr(material(k), 'eos', 'gas'), lambda k: setattr(material(k), 'eos', 'linear'), ["material '4340'", "'gas'", 'one of']),
        'no density': (lambda k: setattr(material(k), 'density', 0.), lambda k: setattr(material(k), 'density', 7830.), ['4340', 'density', 'above zero']),
}


@pytest.mark.parametrize('name', sorted(INPUT))
def test_badInputIsRefusedAndCanBeMended(plugin, tmp_path, name):
	from yade import O
	spoil, mend, words = INPUT[name]
	ids = scene.block(6, 6, constants=dict(scene.STEEL, eos='shockAdiabat'))
	scene.engine(1e-9)
	k = int(ids[14])
	spoil(k)
	text = refused()
	for w in words:
		assert w.replace('{k+1}', str(k + 1)).replace('{k}', str(k)) in text, text
	assert O.iter == 0
	O.save(str(tmp_path / 'after.yade'))
	mend(k)
	O.run(3, True)
	assert O.iter == 3 and abs(scene.states(ids)[:, 2:]).max() == 0


def test_materialWithoutConstants(plugin):
	"""McaMat as it comes has no constants; a name that the library does not hold is refused before there is a body."""
	from yade import O
	from yade_mca import McaMat, materials, packings
	p = packings.hexagonal(D, packings.Rectangle((0, 0), (5 * D, 5 * D)))
	with pytest.raises(materials.MaterialError, match="unknown material '4350'.*4340"):
		packings.addBodies(p, '4350')
	assert len(O.bodies) == 0
	packings.addBodies(p, McaMat(density=7800., label='bare'))
	scene.engine(1e-9)
	text = refused()
	assert "material 'bare'" in text and 'bulkSoundSpeed' in text and 'above zero' in text


def test_coincidentBodiesAreNamed(plugin):
	from yade import O
	a, b = scene.block(1, 1)[0], scene.block(1, 1)[0]
	scene.engine(1e-9)
	text = refused()
	assert '%d at' % a in text and '%d at' % b in text and '0 rest distances apart' in text and 'Remedy' in text
	O.bodies.erase(int(b))
	O.run(3, True)
	assert O.iter == 3


@pytest.mark.parametrize('scale, words', [(0.6, ['neighbours within', 'spacing of the packing does not match the diameter']), (0.45, ['rest distances apart', 'least allowed is 0.5'])])
def test_spacingThatDoesNotMatchThePacking(plugin, scale, words):
	from yade import O
	ids = scene.block(8, 8)
	for i in ids.tolist():
		s = O.bodies[i].state
		s.pos = (scale * s.pos[0], scale * s.pos[1], 0)
	scene.engine(1e-9)
	text = refused()
	for w in words:
		assert w in text, text


def test_bodiesOfAnotherOrientationNeedAnotherMask(plugin):
	scene.block(6, 6)
	scene.block(6, 6, at=(6.2e-3, 0), angle=0.5)
	scene.engine(1e-9)
	text = refused()
	assert 'another mask' in text or 'does not match the diameter' in text, text


def test_stepAboveTheLimitNamesBodyAndLimit(plugin, tmp_path):
	from yade import O
	ids = scene.block(8, 8, velocity=(1., 0.))
	e = scene.engine(1e-3)
	text = refused()
	limit = float(text.split('stable step ')[1].split(' s')[0])
	assert 'O.dt = 0.001 s' in text and limit == pytest.approx(e.criticalTimeStep, rel=1e-5) and 'adaptive=True' in text
	assert int(text.split('of body ')[1].split('.')[0]) in ids
	assert O.iter == 0 and (scene.pick(e, ids, 'x') == scene.states(ids)[:, 0]).all()
	O.save(str(tmp_path / 'after.yade.gz'))
	O.dt = 0.99 * limit
	O.run(5, True)
	assert scene.pick(e, ids, 'vx') == pytest.approx(1.)


@pytest.mark.parametrize('dt', [0., NAN])
def test_stepMustBePositive(plugin, dt):
	from yade import O
	scene.block(4, 4)
	e = scene.engine(1e-9)
	O.run(1, True)
	O.dt = dt
	text = refused()
	assert 'time step' in text and 'largest stable one is now' in text
	O.dt = 1e-9
	O.run(2, True)
	assert np.isfinite(e.field('x')).all()


@pytest.mark.parametrize('attribute, value, words', [
        ('volumeRule', 'best', ["volumeRule = 'best'", "'affine', 'inversePower' or 'meanDistance'"]),
        ('linkFactor', 3., ['linkFactor', '1.02', '1.5']),
        ('skin', 0., ['skin', '0.05']),
        ('dtFactor', 1.5, ['dtFactor', '1.5']),
        ('dtFactor', NAN, ['dtFactor', 'nan']),
])
def test_optionsOfTheEngine(plugin, attribute, value, words):
	scene.block(4, 4)
	scene.engine(**{attribute: value})
	text = refused()
	for w in words:
		assert w in text, text


def test_bodyWithoutTheStateOfItsMaterial(plugin):
	from yade import O, utils
	from yade_mca import materials
	m = materials.mcaMat('4340')
	O.materials.append(m)
	b = utils.sphere((0, 0, 0), 0.5 * D, material=m)
	from yade.wrapper import State
	mass = b.state.mass
	b.state = State(mass=mass)
	k = O.bodies.append(b)
	scene.engine(1e-9)
	text = refused()
	assert '#%d' % k in text and 'McaState' in text  # YADE's own check


def test_deepOverlapNamesBothBodiesAndTheStep(plugin, tmp_path):
	"""Two single automata driven into each other."""
	from yade import O
	a = scene.block(1, 1)
	b = scene.block(1, 1, at=(1.2e-3, 0), mask=2)
	for i, v in ((a[0], 100.), (b[0], -100.)):
		scene.blocked([i], 'xyzXYZ')
		state(i).vel = (v, 0, 0)
	e = scene.engine()
	text = refused(10000)
	assert '%d at' % a[0] in text and '%d at' % b[0] in text and 'rest distances apart in step %d' % O.iter in text and 'Remedy' in text, text
	assert np.isfinite(e.field('x')).all()
	O.save(str(tmp_path / 'after.yade'))
	O.load(str(tmp_path / 'after.yade'))
	assert len(O.bodies) == 2


def test_afterAnErrorTheStateIsThatBeforeTheStep(plugin, tmp_path):
	"""Saved after the error and mended, the run goes on as one that never failed."""
	from yade import O
	ends = []
	for fail in (False, True):
		O.reset()
		scene.impact()
		e = scene.engine(2e-8)
		O.run(150, True)
		if fail:
			O.dt = 1e-3
			assert 'largest stable step' in refused()
			O.save(str(tmp_path / 'failed.yade'))
			O.load(str(tmp_path / 'failed.yade'))
			O.dt, e = 2e-8, O.engines[0]
		O.run(100, True)
		ends.append(scene.digest(e))
	assert ends[0] == ends[1]


def test_aSuddenFallOfTheStableStepShortensTheStepInsteadOfEndingTheRun(plugin):
	"""Bodies meet and links break within a step: with 0.95 of the limit the step chosen before is then too long."""
	from yade import O
	from yade.wrapper import McaTimeStepper
	scene.impact()
	e = scene.engine()
	O.engines = [McaTimeStepper(factor=0.95), e]
	shortened = 0
	for _ in range(300):
		chosen = e.criticalTimeStep
		O.step()
		shortened += O.dt < 0.95 * chosen * (1 - 1e-12) and O.engines[0].limitedBy == 'McaEngine' and O.dt > 0
	assert e.counters()['brokenLinks'] > 10 and shortened > 0
	assert np.isfinite(e.field('x')).all()
