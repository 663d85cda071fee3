# SPDX-License-Identifier: GPL-2.0-or-later
"""Initial stress, plastic strain and temperature of the cells of a grid."""
import numpy as np
import pytest
from yade_mca import materials

H = 1e-3


def grid(n=8, held=(), **constants):
	"""A block of 2 n by n cells; held: sides."""
	from yade import O
	from yade.wrapper import McaGridEngine, McaTimeStepper
	O.reset()
	m = materials.mcaMat('4340', **dict(dict(yieldModel='elastic', eos='linear'), **constants))
	g = McaGridEngine(account=True)
	g.addRectangle(m, np.arange(2 * n + 1) * H, np.arange(n + 1) * H)
	for side in held:
		g.fix(0, side)
	O.engines = [McaTimeStepper(), g]
	return g, m


def fastest(g):
	return max(abs(g.view(0, v)).max() for v in ('vx', 'vy'))


def test_aPrestressedBlockWithHeldEndsStaysAtRest(plugin):
	from yade import O
	g, m = grid(held=('left', 'right'))
	sigma = 0.5e9
	g.setCells(0, stress=(sigma, 0, 0))
	O.run(300, True)
	assert fastest(g) < 1e-9 * sigma / (m.density * m.cP)
	s = g.view(0, 'sxx') - g.view(0, 'pressure')
	assert s == pytest.approx(sigma, rel=1e-9)
	e = g.energies()
	assert abs(e['total'] - e['internal']) < 1e-9 * sigma * H**2


def test_aPressureBalancedByItsLoad(plugin):
	from yade import O
	g, m = grid()
	p = 0.4e9
	g.setCells(0, stress=(-p, -p, 0, -p))
	for side in 'left', 'right', 'bottom', 'top':
		g.pressure(0, side, p)
	O.run(300, True)
	assert fastest(g) < 1e-9 * p / (m.density * m.cP)
	assert g.view(0, 'pressure') == pytest.approx(p, rel=1e-9)


def test_releasedItSpringsBackByHookesLaw(plugin):
	"""Free ends: the mean of the free vibration is the stress-free length."""
	g, m = grid(n=4)
	sigma = 0.1e9
	g.setCells(0, stress=(sigma, 0, 0))
	x = []
	from yade_mca._yade import steps  # looks oftener whether a run has ended than O.run(n, True)
	for _ in range(300):
		steps(6)
		x.append(g.view(0, 'x')[:, -1].mean() - g.view(0, 'x')[:, 0].mean())
	K, G = m.density * m.bulkSoundSpeed**2, m.shearModulus
	modulus = 4 * G * (3 * K + G) / (3 * K + 4 * G)
	assert 1 - np.mean(x) / (8 * H) == pytest.approx(sigma / modulus, rel=0.03)


def test_plasticStrainAndTemperatureCount(plugin, tmp_path):
	"""Hardened and hot cells flow at the law's own stress; a saved scene goes on with the same bits."""
	from yade import O
	g, m = grid(held=('left', ), yieldModel='johnsonCook', taylorQuinney=0.)
	T = np.full((8, 16), 298.)
	T[:, :8] = 600.
	g.setCells(0, plasticStrain=0.05, temperature=T)
	assert (g.view(0, 'plasticStrain') == 0.05).all() and (g.view(0, 'temperature') == T).all()
	with pytest.raises(RuntimeError, match='flows at'):
		g.setCells(0, stress=(3e9, 0, 0))
	g.prescribe(0, 'right', x=-300.)
	O.run(100, True)
	O.save(str(tmp_path / 'g.xml.gz'))
	found = []
	for again in False, True:
		if again: O.load(str(tmp_path / 'g.xml.gz'))
		g = O.engines[1]
		O.run(50, True)
		found.append(np.array(g.view(0, 'sxx')))
	assert np.array_equal(*found) and g.view(0, 'plasticStrain').max() > 0.05
	with pytest.raises(RuntimeError, match='before the first step'):
		g.setCells(0, plasticStrain=0.)


def test_refusals(plugin):
	g, m = grid()
	for bad, word in ((dict(stress=(1, 2)), 'xx, yy, xy'), (dict(stress=np.zeros((8, 15, 3))), 'shape \\(8, 16'), (dict(stress=(float('nan'), 0, 0)), 'finite'),
	                  (dict(plasticStrain=-1.), 'from 0'), (dict(plasticStrain=np.zeros(5)), 'shape'), (dict(temperature=300.), 'does not depend on temperature'),
	                  (dict(), 'at least one'), (dict(stress=(-1e14, -1e14, 0, -1e14)), 'no pressure')):
		with pytest.raises(RuntimeError, match=word):
			g.setCells(0, **bad)
	g, m = grid(spallStrength=1e9)
	with pytest.raises(RuntimeError, match='spallStrength'):
		g.setCells(0, stress=(2e9, 2e9, 0, 2e9))
	g, m = grid(yieldModel='johnsonCook', taylorQuinney=0.)
	g.setCells(0, stress=(0.7e9, 0, 0))
	with pytest.raises(RuntimeError, match='flows at'):
		g.setCells(0, temperature=1500.)
	g, m = grid(eos='mieGruneisen', gruneisen=1.7, hugoniotSlope=1.3)
	with pytest.raises(RuntimeError, match='mieGruneisen'):
		g.setCells(0, stress=(1e6, 0, 0))
