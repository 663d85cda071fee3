# SPDX-License-Identifier: GPL-2.0-or-later
"""cut() and the history of broken links: both roads, save and load, places and causes, the crack in tension, refusals."""
import csv
import math

import engine_scene
import law2_scene
import numpy as np
import pytest
from yade_mca import cracks, materials, packings
from yade_mca.cracks import CrackError

D = 1e-3


def strip(nx=12, ny=12, **constants):
	from yade import O
	O.reset()
	return engine_scene.block(nx, ny, constants=dict(engine_scene.STEEL, **constants))


def test_aSegmentCutsWhatCrossesIt(plugin):
	from yade import O
	ids = strip()
	e = engine_scene.engine(1e-8)
	before = e.links()
	x = np.array([O.bodies[int(i)].state.pos for i in ids])
	place = dict(zip(ids.tolist(), x))
	where = ((-2.3 * D, 0.31 * D), (2.4 * D, 0.31 * D))
	n = cracks.cut(e, where)
	assert n > 5 and len(e.links()) == len(before)  # from the next step on
	O.run(1, True)
	gone = sorted(set(before) - set(e.links()))
	assert len(gone) == n == e.counters()['brokenLinks']
	for i, j in before:
		(ax, ay), (bx, by) = place[i][:2], place[j][:2]
		y = 0.31 * D
		at = ax + (bx - ax) * (y - ay) / (by - ay) if (ay - y) * (by - y) < 0 else math.inf
		assert ((i, j) in gone) == (-2.3 * D < at < 2.4 * D)
	h = cracks.history(e)
	assert (h['cause'] == 'cut').all() and sorted(zip(h['id1'].tolist(), h['id2'].tolist())) == gone
	assert h['y'] == pytest.approx(np.array([0.5 * (place[i][1] + place[j][1]) for i, j in zip(h['id1'].tolist(), h['id2'].tolist())]), abs=1e-15)
	assert np.hypot(h['nx'], h['ny']) == pytest.approx(1., abs=1e-12) and (h['nz'] == 0).all()
	assert cracks.cut(e, where) == 0


def test_aBodyAtRestStaysAtRest(plugin):
	from yade import O
	ids = strip()
	e = engine_scene.engine(1e-8, account=True)
	cracks.cut(e, ((-1, 0.31 * D), (1, 0.31 * D)))
	O.run(200, True)
	assert abs(engine_scene.states(ids)[:, 2:]).max() < 1e-9 and abs(e.energies()['total']) < 1e-20


def test_bothRoads(plugin):
	"""Cut in the middle of an impact: the same trajectory."""
	from yade import O
	found = []
	for road in 'engine', 'law2':
		O.reset()
		ids = law2_scene.impact()
		law2_scene.engines(road, 2e-8)
		O.run(203, True)  # not a step in which links are tested
		e = O.engines[0] if road == 'engine' else law2_scene.density()
		n = cracks.cut(e, lambda a, b: (a[:, 0] > 4 * D) != (b[:, 0] > 4 * D))
		O.run(300, True)
		found.append((n, law2_scene.state(ids)))
	assert found[0][0] == found[1][0] > 5
	a, b = found[0][1], found[1][1]
	scale = abs(a).max(axis=0)
	scale[:2] = D
	assert (abs(a - b).max(axis=0) <= 1e-10 * scale).all() and (a[:, 7] == b[:, 7]).all()


def test_inSpace(plugin):
	from yade import O
	O.reset()
	p = packings.fcc(D, packings.Box((-3 * D, -3 * D, -3 * D), (3 * D, 3 * D, 3 * D)))
	packings.addBodies(p, materials.mcaMat('4340', yieldModel='elastic'))
	e = engine_scene.engine(1e-8)
	h, y = 4 * D, 0.2 * D
	part = cracks.cut(e, [(-h, y, -h), (h, y, -h), (h, y, 0.1 * D), (-h, y, 0.1 * D)])
	x = p.positions
	place = {i: x[k] for k, i in enumerate(e.ids.tolist())}
	whole = sum((place[i][1] > y) != (place[j][1] > y) for i, j in e.links())
	assert 0.4 * whole < part < 0.7 * whole
	O.run(1, True)
	assert part + cracks.cut(e, lambda a, b: (a[:, 1] > y) != (b[:, 1] > y)) == whole
	O.run(1, True)
	n = e.brokenLinks()
	assert len(n['time']) == whole and (abs(n['ny']) > 0.5).all()


def test_whatIsCutGoesThroughAFile(plugin, tmp_path):
	from yade import O
	ids = strip()
	e = engine_scene.engine(1e-8)
	O.run(3, True)
	n = cracks.cut(e, ((-1, 0.31 * D), (1, 0.31 * D)))
	O.save(str(tmp_path / 'cut.yade'))
	O.run(5, True)
	one, h = engine_scene.states(ids), e.brokenLinks()
	O.load(str(tmp_path / 'cut.yade'))
	O.run(5, True)
	assert np.array_equal(engine_scene.states(ids), one) and O.engines[0].counters()['brokenLinks'] == n > 5
	for k, v in O.engines[0].brokenLinks().items(): assert np.array_equal(v, h[k])


@pytest.mark.parametrize('cause, constants', [('fractureStrain', dict(fractureStrain=0.02)), ('spallStrength', dict(spallStrength=1.5e9)), ('fractureStress', dict(fractureStress=1.5e9)),
                                              ('pairStrength', dict(pairStrength=3e9)), ('damage', dict(damageModel='johnsonCook', damageD1=0.02, damageD2=0.))])
def test_causes(plugin, cause, constants):
	from yade import O
	from yade_mca import scenes
	metal = materials.mcaMat('4340', yieldModel='perfect', yieldStress=0.8e9 if cause in ('fractureStrain', 'damage') else 9e9, **constants)
	s = scenes.bar(metal, 20 * D, 10 * D, D, velocity=(0, 0))
	for i in s.ids['bar']:
		b = O.bodies[int(i)].state
		b.vel = (3e3 * b.pos[0] / (10 * D) * 0.1, 0, 0)
	O.run(1500, True)
	h = cracks.history(s.automata)
	assert len(h['time']) > 3 and (h['cause'][:3] == cause).all() and (np.diff(h['time']) >= 0).all()


def test_filesAndRose(plugin, tmp_path):
	from yade import O
	strip()
	e = engine_scene.engine(1e-8)
	with pytest.raises(ValueError, match='no link has broken'): cracks.writeVtk(str(tmp_path / 'none.vtp'), e)
	n = cracks.cut(e, ((-1, 0.31 * D), (1, 0.31 * D)))
	O.run(1, True)
	cracks.writeCsv(str(tmp_path / 'cracks.csv'), e)
	with open(tmp_path / 'cracks.csv', newline='') as f: rows = list(csv.DictReader(f))
	h = e.brokenLinks()
	assert len(rows) == n and float(rows[3]['x']) == h['x'][3] and rows[3]['cause'] == 'cut' and int(rows[3]['id2']) == h['id2'][3]
	cracks.writeVtk(str(tmp_path / 'cracks.vtp'), e)
	assert (tmp_path / 'cracks.vtp').stat().st_size > 500
	edges, counts = cracks.rose(e, 6)  # links of a packing with rows along x cross a horizontal line at 60 and 120 degrees: cracks at 150 and 30
	assert counts.sum() == n and counts[[0, 1, 4, 5]].sum() == n and edges[-1] == pytest.approx(math.pi)
	assert cracks.rose(e, 6, since=1.)[1].sum() == 0


def test_theOpeningOfACrackInTension(plugin):
	"""A plate in plane strain is stretched, then cut in its middle: the opening in the middle is 4 s a/E', E' = E/(1 - nu^2) (Griffith 1921, Westergaard 1939), here in the mean over
	its free vibration. A plate ten cracks wide is stiffer than an endless one by less than 2 %; the crack of automata is longer by a part of a spacing."""
	from yade import O
	O.reset()
	n, half = 80, 8.5 * D
	m = materials.mcaMat('4340', yieldModel='elastic', viscosityLinear=1.)
	p = packings.hexagonal(D, packings.Rectangle((0, 0), (n * D, n * D)))
	ids = packings.addBodies(p, m)
	x = p.positions
	e = engine_scene.engine(2e-8)
	strain, steps = 1e-3, 500
	for i, at in zip(ids, x):
		s = O.bodies[i].state
		s.vel, s.blockedDOFs = (0, strain * at[1] / (steps * 2e-8), 0), 'xyzXYZ'
	O.run(steps, True)
	edge = abs(x).max(axis=1) > 0.5 * n * D - 1.1 * D
	for i, held in zip(ids, edge):
		O.bodies[i].state.vel = (0, 0, 0)
		if not held: O.bodies[i].state.blockedDOFs = 'zXY'
	O.run(1, True)
	start = engine_scene.states(ids)[:, 1]
	y = 0.5 * (x[x[:, 1] > 1e-9, 1].min() + max(x[x[:, 1] < x[x[:, 1] > 1e-9, 1].min() - 1e-9, 1]))
	assert cracks.cut(e, ((-half, y), (half, y))) > 30
	above, below = ((abs(x[:, 0]) < 2 * D) & (abs(x[:, 1] - y) < 0.5 * D) & (side * (x[:, 1] - y) > 0) for side in (1, -1))
	opening = []
	for _ in range(150):
		O.run(40, True)
		u = engine_scene.states(ids)[:, 1] - start
		opening.append(u[above].mean() - u[below].mean())
	nu, E = m.poisson, m.young
	stress = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * strain  # stretched along y, held along x and z
	theory = 4 * stress * half * (1 - nu**2) / E
	assert np.mean(opening[50:]) == pytest.approx(theory, rel=0.1)


def test_refusals(plugin):
	from yade import O
	strip()
	e = engine_scene.engine(1e-8)
	for bad in 7, [(1, )], [(0, 'x')], 'ab': 
		with pytest.raises(TypeError, match='pairs must be a list of'): e.cut(bad)
	with pytest.raises(RuntimeError, match='body 99999 is no automaton'): e.cut([(0, 99999)])
	assert e.cut([(0, 143)]) == 0  # no link
	for where, words in ((((0, 0), (0, 0)), 'both ends'), ((1, 2, 3), 'shape'), (((0, 0), (0, math.nan)), 'finite'), (lambda a, b: 1, 'truth values')):
		with pytest.raises(CrackError, match=words): cracks.cut(e, where)
	a = np.zeros((2, 3))
	for where, words in (([(0, 0, 0), (1, 0, 0)], 'three corners'), ([(0, 0, 0), (1, 0, 0), (2, 0, 0)], 'on a line'), ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 1)], 'in a plane')):
		with pytest.raises(CrackError, match=words): cracks.crossing(where, a, a)
	for bins in 0, 2.5, True:
		with pytest.raises(CrackError, match='bins'): cracks.rose(e, bins)
	O.reset()
	law2_scene.impact()
	law2_scene.engines('law2', 2e-8)
	with pytest.raises(CrackError, match='no links yet'): cracks.cut(law2_scene.density(), ((-1, 0), (1, 0)))
	O.reset()
	with pytest.raises(CrackError, match='no links yet'): cracks.cut(engine_scene.engine(1e-8), ((-1, 0), (1, 0)))
	engine_scene.block()
	e = engine_scene.engine(1e-8, contacts=False)
	with pytest.raises(RuntimeError, match='contacts=False'): e.cut([(0, 1)])


def test_theHistoryIsDrawn(plugin, tmp_path):
	from yade import O
	from yade_mca import plots
	strip(fractureStrain=0.05)
	e = engine_scene.engine(1e-8)
	cracks.cut(e, ((-2.3 * D, 0.31 * D), (2.4 * D, 0.31 * D)))
	O.run(2, True)
	path = plots.crackHistory(str(tmp_path / 'cracks.png'), cracks.history(e), bins=12)
	assert (tmp_path / 'cracks.png').stat().st_size > 5000 and path
	for bad in 0, 1.5, 400:
		with pytest.raises(ValueError, match='bins'):
			plots.crackHistory(str(tmp_path / 'x.png'), cracks.history(e), bins=bad)
	with pytest.raises(ValueError, match='nothing to draw'):
		plots.crackHistory(str(tmp_path / 'x.png'), dict(time=[], cause=[], nx=[], ny=[]))
