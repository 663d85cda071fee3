# SPDX-License-Identifier: GPL-2.0-or-later
"""What a scene does not need is not done: shown by counting work (blocks and cells computed, searches, write-backs), and by the same bits with a feature
that is present but does nothing as without it. The cost of what remains is measured by `stress --only ratios`.
"""
import math

import numpy as np
import pytest

D = 1e-3
INFINITE = math.inf


def digest(engine, grid=None):
	"""State as bytes."""
	out = b''
	if engine is not None:
		out += b''.join(engine.field(k).tobytes() for k in ('x', 'y', 'vx', 'vy', 'omega', 'pressure', 'volumeRatio', 'equivalentStress', 'plasticStrain', 'stressZZ'))
	for b in range(len(grid.blocks) if grid is not None else 0):
		out += b''.join(grid.view(b, k).tobytes() for k in ('x', 'y', 'vx', 'vy', 'pressure', 'sxx', 'syy', 'sxy', 'plasticStrain'))
	return out


def bar(length, material=None, pulse=50., **engine):
	"""McaEngine with a bar along x of `length` spacings whose left eight spacings move, on the way to the right."""
	from yade import O
	from yade_mca import materials, packings
	from yade.wrapper import McaEngine
	O.reset()
	p = packings.hexagonal(D, packings.Rectangle((0.5 * length * D, 5 * D), (length * D, 8 * D)), rim='full')  # y > 0: one strip of the engine's order
	v = np.zeros_like(p.positions)
	v[p.positions[:, 0] < 8 * D, 0] = pulse
	e = McaEngine(adaptive=False, **engine)
	packings.addBodies(p, material or materials.mcaMat('4340', yieldModel='perfect'), velocity=v)
	O.engines, O.dt = [e], 3e-8
	return e


def gridBar(length, material=None, pulse=50., block=None, **engine):
	from yade import O
	from yade_mca import materials
	from yade.wrapper import McaGridEngine
	O.reset()
	g = McaGridEngine(adaptive=False, **engine)
	xs = np.arange(length + 1) * D
	g.addRectangle(material or materials.mcaMat('4340', yieldModel='perfect'), xs.tolist(), (np.arange(9) * D).tolist(), **(block or {}))
	v = np.zeros((9, length + 1, 2))
	v[:, xs < 8 * D, 0] = pulse
	g.setVelocity(0, v)
	O.engines, O.dt = [g], 3e-8
	return g


def test_automataComputedAreThoseThatMove(plugin):
	"""A pulse in bars of 100, 200 and 400 spacings: the same blocks are computed, however long the rest is; with sleeping off all of them."""
	from yade import O
	work, all_ = [], []
	for length in (100, 200, 400):
		for sleeping, to in ((True, work), (False, all_)):
			e = bar(length, sleeping=sleeping)
			O.run(100, True)
			c = e.counters()
			to.append(c['blockSteps'])
		assert c['blockSteps'] == c['blocks'] * c['steps'] == c['blocks'] * 100
	assert max(work) - min(work) <= 0.1 * min(work), work  # blocks of 64 do not fall on the same places
	assert work[2] < 0.4 * all_[2]


def test_idleEngineComputesNothing(plugin):
	from yade import O
	e = bar(100, pulse=0.)
	O.run(200, True)
	c = e.counters()
	assert c['steps'] == 200 and c['blockSteps'] == 0 and c['awake'] == 0 and c['searches'] == 1


def test_cellsComputedAreThoseThatMove(plugin):
	from yade import O
	awake = []
	for length in (100, 200, 400):
		g = gridBar(length)
		O.run(100, True)
		awake.append(g.awakeFraction * g.count)
	assert awake[0] == awake[1] == awake[2] < 100 * 8
	g = gridBar(100, pulse=0.)
	O.run(10, True)
	assert g.awakeFraction == 0
	g = gridBar(100, sleeping=False)
	O.run(1, True)
	assert g.awakeFraction == 1


def test_coupledPlateSleepsOnBothSides(plugin):
	"""A block flies towards a plate: as long as it has not touched, neither the plate's automata nor its grid are computed."""
	from yade import O
	from yade_mca import packings, scenes
	s = scenes.tiedPlate('4340', 10e-3, 1e-3, automataWidth=20e-3, plateWidth=60e-3)
	s.add('block', packings.hexagonal(D, packings.Rectangle((0, 13e-3), (8e-3, 6e-3))), '4340', velocity=(0., -300.), mask=1)
	O.run(30, True)
	c = s.automata.counters()
	assert s.grid.awakeFraction == 0 and 0 < c['awake'] < 0.5 * c['blocks'] and c['blockSteps'] == c['awake'] * c['steps']
	O.run(900, True)
	assert s.grid.awakeFraction > 0.3


def test_intactBodySearchesOnceAndHasNoContacts(plugin):
	"""Vibration, plastic flow and waves are no reason to look for contacts; only a rim that has moved by part of the search range is."""
	from yade import O
	e = bar(60)
	O.run(500, True)
	c = e.counters()
	assert c['searches'] == 1 and c['contacts'] == 0 and c['brokenLinks'] == 0 and e.field('plasticStrain').max() > 0
	e = bar(60, contacts=False)
	O.run(500, True)
	assert e.counters()['searches'] == 0


def test_searchesFollowTheWayOfBodiesAgainstEachOther(plugin):
	"""A body in free flight needs none after the first; two that slide past each other need one whenever an unlisted pair may have come nearer by the search
	range, and two that are far apart one every three diameters."""
	from yade import O
	from yade_mca import packings
	for skin in (0.2, 0.4, 0.8):
		e = bar(8, pulse=400., skin=skin)
		O.run(1000, True)
		assert e.counters()['searches'] == 1
		e = bar(8, pulse=400., skin=skin)
		packings.addBodies(packings.hexagonal(D, packings.Rectangle((-50 * D, 0), (8 * D, 6 * D))), O.materials[0], velocity=(-200., 0.))
		O.run(1000, True)
		way = 1000 * O.dt * 600.
		assert abs(e.counters()['searches'] - way / (3 * D)) < 0.05 * way / (3 * D) + 2
		e = bar(8, pulse=400., skin=skin)
		top = max(b.state.pos[1] for b in O.bodies)
		packings.addBodies(packings.hexagonal(D, packings.Rectangle((4 * D, top + 5.5 * D), (8 * D, 6 * D))), O.materials[0], velocity=(-200., 0.))
		O.run(300, True)
		way = 300 * O.dt * 600.
		assert way > 4 * D and abs(e.counters()['searches'] - way / (skin * D)) < 0.1 * way / (skin * D) + 2


def test_writingBackAndTimingChangeNoBit(plugin):
	from yade import O
	found = set()
	for options, timing in ((dict(), False), (dict(writePeriod=1), False), (dict(), True), (dict(account=True), False), (dict(account=True, sleeping=False), True)):
		e = bar(30, **options)
		O.timingEnabled = timing
		O.run(150, True)
		O.timingEnabled = False
		found.add(digest(e))
	assert len(found) == 1


STEEL = dict(yieldModel='perfect', yieldStress=1e9)
COOK = dict(yieldModel='johnsonCook', yieldStress=1e9, rateCoefficient=0., heatCapacity=0.)
#: (present but without effect, absent); of automata and cells alike
SAME = {
        'infinite yield stress, perfect': (dict(yieldModel='perfect', yieldStress=INFINITE), dict(yieldModel='elastic')),
        'infinite yield stress, hardening': (dict(yieldModel='linearHardening', yieldStress=INFINITE, hardeningModulus=1e9), dict(yieldModel='elastic')),
        'yield stress that is never reached': (dict(yieldModel='perfect', yieldStress=1e15), dict(yieldModel='elastic')),
        'thermal softening without heat': (dict(COOK, thermalSoftening=2., taylorQuinney=0.5), COOK),
        'hardening of zero': (dict(yieldModel='linearHardening', yieldStress=1e9, hardeningModulus=0.), STEEL),
        'tensile strength that is never reached': (dict(STEEL, spallStrength=1e15), STEEL),
        'Grueneisen parameter without its equation': (dict(STEEL, gruneisen=3.), dict(STEEL, gruneisen=0.)),
        'heat capacity without Johnson-Cook': (dict(STEEL, heatCapacity=400.), dict(STEEL, heatCapacity=0.)),
        'slope of the shock adiabat in the linear law': (dict(STEEL, eos='linear', hugoniotSlope=3.), dict(STEEL, eos='linear', hugoniotSlope=0.)),
        'slope of zero': (dict(STEEL, eos='shockAdiabat', hugoniotSlope=0.), dict(STEEL, eos='linear')),
}
AUTOMATA = {
        'fracture strain that is never reached': (dict(STEEL, fractureStrain=1e9), STEEL),
        'pair strength that is never reached': (dict(STEEL, pairStrength=1e18), STEEL),
        'Mises strength that is never reached': (dict(STEEL, fractureStress=1e18, strengthRatio=3.), STEEL),
        'scatter of strengths that do not exist': (dict(STEEL, strengthSpread=0.2), STEEL),
        'friction without contacts': (dict(STEEL, frictionAngle=0.5), dict(STEEL, frictionAngle=0.)),
}


def bits(make, constants, steps=150, **options):
	from yade import O
	from yade_mca import materials
	e = make(30, materials.mcaMat('4340', **constants), **options)
	O.run(steps, True)
	moved = e.field('equivalentStress').max() if make is bar else abs(e.view(0, 'sxx')).max()
	assert moved > 1e8
	return digest(e) if make is bar else digest(None, e)


@pytest.mark.parametrize('name', [*SAME, *AUTOMATA])
def test_automataWithAFeatureThatDoesNothing(plugin, name):
	present, absent = {**SAME, **AUTOMATA}[name]
	assert bits(bar, present) == bits(bar, absent)


@pytest.mark.parametrize('name', SAME)
def test_cellsWithAFeatureThatDoesNothing(plugin, name):
	present, absent = SAME[name]
	assert bits(gridBar, present) == bits(gridBar, absent)


@pytest.mark.parametrize('options', [dict(readForces=True), dict(contacts=False), dict(seed=7), dict(skin=0.9), dict(sleeping=False), dict(account=True)], ids=str)
def test_engineOptionsThatFindNothingToDo(plugin, options):
	assert bits(bar, STEEL, **options) == bits(bar, STEEL)


def test_gaugesAndAccountChangeNothingInTheGrid(plugin):
	from yade import O
	plain = bits(gridBar, STEEL)
	assert bits(gridBar, STEEL, account=False) == plain == bits(gridBar, STEEL, sleeping=False)
	from yade_mca import materials
	g = gridBar(30, materials.mcaMat('4340', **STEEL))
	g.addGauge((5e-3, 2e-3), 1)
	O.run(150, True)
	assert digest(None, g) == plain and len(g.gauge(0)) == 150


def test_aFeatureThatActsChangesBits(plugin):
	"""The comparisons above can fail."""
	plain = bits(bar, STEEL)
	for change in (dict(yieldStress=0.9e9), dict(spallStrength=1e8), dict(eos='mieGruneisen'), dict(viscosityLinear=0.)):
		assert bits(bar, dict(STEEL, **change)) != plain, change
	assert bits(gridBar, dict(STEEL, eos='mieGruneisen')) != bits(gridBar, STEEL)
