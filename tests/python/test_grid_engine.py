# SPDX-License-Identifier: GPL-2.0-or-later
"""McaGridEngine as a script sees it: blocks, boundaries, views, gauges, time step, refusals."""
import gc

import numpy as np
import pytest


@pytest.fixture
def bar(plugin):
	"""An engine with a steel bar of 40 x 4 cells, driven from the left, on rollers."""
	from yade import O
	from yade.wrapper import McaGridEngine
	from yade_mca import materials
	e = McaGridEngine()
	e.addRectangle(materials.mcaMat('4340', yieldModel='perfect'), np.linspace(0, 0.04, 41), np.linspace(0, 0.004, 5), name='bar')
	e.symmetry(0, 'bottom')
	e.symmetry(0, 'top')
	e.prescribe(0, 'left', x=50.)
	O.engines = [e]
	return e


def test_waveRunsAndBalances(bar):
	from yade import O
	O.run(100, True)
	e = bar.energies()
	assert bar.steps == 100 and bar.time > 0
	assert e['internal'] > 0
	assert abs(e['total']) < 1e-12 * e['workConstraints']
	assert abs(e['momentumX'] - e['impulseX']) < 1e-12 * e['impulseX']
	v = bar.view(0, 'vx')
	assert v.shape == (5, 41) and np.allclose(v[:, 0], 50)
	assert np.allclose(v, v[2], atol=1e-9)  # a plane wave


def test_viewsShareMemoryAndOutliveTheEngine(bar):
	from yade import O
	x, s = bar.view(0, 'x'), bar.view(0, 'sxx')
	before = x.copy()
	O.run(20, True)
	assert not np.array_equal(x, before) and abs(s).max() > 0
	assert np.shares_memory(x, bar.view(0, 'x'))
	with pytest.raises(ValueError):
		x[0, 0] = 1.
	p = bar.view(0, 'pressure')
	old = p.copy()
	O.run(20, True)
	assert np.array_equal(p, old)  # computed when asked for ...
	bar.view(0, 'pressure')
	assert not np.array_equal(p, old)  # ... and refreshed in place
	kept = x.copy()
	O.reset()
	del bar
	gc.collect()
	assert np.array_equal(x, kept)


def test_timeStep(bar):
	from yade import O
	limit = bar.criticalTimeStep
	O.step()
	assert O.dt == pytest.approx(bar.dtFactor * limit)
	assert "block 'bar', cell (" in bar.criticalCell()
	bar.adaptive = False
	O.dt = 2 * limit
	with pytest.raises(RuntimeError, match="too large.*largest allowed value.*block 'bar', cell"):
		O.step()
	assert bar.steps == 1
	O.dt = 0.5 * limit
	O.step()
	assert bar.steps == 2


def test_gaugesAndProbes(bar):
	from yade import O
	k = bar.addGauge((0.01, 0.002), 2)
	O.run(60, True)
	h = bar.gauge(k)
	assert h.shape == (30, 10)
	assert np.all(np.diff(h[:, 0]) > 0) and h[-1, 3] > 20 > abs(h[0, 3])
	line = bar.probeLine((0.001, 0.002), (0.039, 0.002), 11)
	assert len(line['vx']) == 11 and line['vx'][0] > line['vx'][-1] and line['pressure'][0] > 0


def test_bodiesAtRestAreLeftOut(bar):
	from yade import O
	O.run(5, True)
	assert 0 < bar.awakeFraction < 1


def test_tablesNodesAndForces(plugin):
	from yade import O
	from yade.wrapper import McaGridEngine
	from yade_mca import materials
	e = McaGridEngine()
	x, y = np.meshgrid(np.linspace(0, 1, 6), np.linspace(0, 1, 6))
	e.addBlock(materials.mcaMat('4340', yieldModel='elastic'), x, y)
	e.openInteriorNode(0, 2, 3)
	assert e.openNode(0, 2, 3) >= 0 and e.openNode(0, 3, 3) == -1
	assert e.sideNodes(0, 'top', 1, 2) == [e.openNode(0, 1, 5), e.openNode(0, 2, 5)]
	e.force(e.openNode(0, 2, 3), x=([0, 1e-5, 2e-5], [0, 1e6, 0]))
	e.fix(0, 'left')
	e.prescribeNodes(e.openNode(0, 5, 5), (1, 1), 3.)
	e.setVelocity(0, np.zeros((6, 6, 2)))
	O.engines = [e]
	O.run(10, True)
	v = np.array([e.view(0, 'vx')[5, 5], e.view(0, 'vy')[5, 5]])
	assert v @ (1, 1) / np.sqrt(2) == pytest.approx(3.)
	assert e.energies()['workLoads'] > 0
	assert e.blocks == [dict(name='block0', cells=(5, 5))] and e.count == 25


@pytest.mark.parametrize('call, words', [
        (lambda e, m: e.addRectangle(m, [0, 1], [1, 0], name='bad'), "block 'bad', cell (0, 0)"),
        (lambda e, m: e.addBlock(m, np.zeros((3, 3)), np.zeros((3, 4))), 'same shape'),
        (lambda e, m: e.addRectangle(None, [0, 1], [0, 1]), 'unknown material'),
        (lambda e, m: e.fix(0, 'north'), "side 'north'"),
        (lambda e, m: e.fix(3, 'left'), 'no block 3'),
        (lambda e, m: e.view(0, 'colour'), "what = 'colour' is unknown"),
        (lambda e, m: e.view(0, 'temperature'), 'does not keep'),
        (lambda e, m: e.pressure(0, 'top', ([0, 1], [1])), '2 times and 1 values'),
        (lambda e, m: e.pressure(0, 'top', float('nan')), 'not finite'),
        (lambda e, m: e.setVelocity(0, np.zeros((2, 2, 2))), 'shape'),
        (lambda e, m: e.setVelocity(0, (float('inf'), 0)), 'must be finite'),
        (lambda e, m: (e.fix(0, 'left'), e.prescribe(0, 'left', x=1.)), 'overlapping'),
        (lambda e, m: e.addGauge((9, 9)), 'outside'),
        (lambda e, m: e.gauge(4), 'there are 0 gauges'),
])
def test_refusals(plugin, call, words):
	from yade.wrapper import McaGridEngine
	from yade_mca import materials
	e, m = McaGridEngine(), materials.mcaMat('4340', yieldModel='elastic')
	e.addRectangle(m, np.linspace(0, 1, 4), np.linspace(0, 1, 3))
	with pytest.raises(RuntimeError) as refusal:
		call(e, m)
	assert words in str(refusal.value)
