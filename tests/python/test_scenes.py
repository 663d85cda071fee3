# SPDX-License-Identifier: GPL-2.0-or-later
"""Scene builders: geometry, masses, boundaries, tied rows on grid nodes, refusals; and that the scenes run."""
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yade_mca import scenes
from yade_mca.materials import mcaMat
from yade_mca.packings import Rectangle, hexagonal
from yade_mca.scenes import gradedLines
from yade_mca.tasks.verify.automata_shocks import IMPACTS, matched


@settings(max_examples=100)
@given(distance=st.floats(3, 300), growth=st.floats(1.02, 1.3), largest=st.floats(1, 8), sign=st.sampled_from([-1, 1]))
def test_graded_lines_end_where_they_should_and_grow_slowly(distance, growth, largest, sign):
	lines = gradedLines(5., 5. + sign * distance, 1., growth, largest)
	cells = sign * np.diff(lines)
	assert lines[0] == 5 and lines[-1] == 5 + sign * distance and (cells > 0).all()
	ratio = cells[1:] / cells[:-1]
	assert ratio.max() <= growth * (1 + 1e-9) and ratio.min() >= 1 / growth * (1 - 1e-9)
	assert cells.max() <= max(largest, 1.25) * (1 + 1e-9) and cells[0] == pytest.approx(1, abs=0.26)


def test_grading_keeps_the_first_cell_over_long_distances():
	cells = np.diff(gradedLines(40e-3, 200e-3, 1e-3, 1.1, 4e-3))
	assert cells[0] == pytest.approx(1e-3, rel=1e-6) and cells[-1] == pytest.approx(4e-3, rel=1e-2)


@pytest.mark.parametrize('x', [0., 0.3, 0.7])
def test_bodies_that_touch_down_just_touch(x):
	lower = hexagonal(1., Rectangle((0, -5), (30, 10)), angle=math.pi / 2)
	upper = scenes.touchDown(hexagonal(1., Rectangle((x, 50), (8, 20))), lower)
	gap = np.hypot(*(upper.positions[:, None] - lower.positions[None]).transpose(2, 0, 1)).min()
	assert 1 <= gap < 1 + 1e-8


@pytest.mark.parametrize('thickness, spacing', [(15e-3, 1e-3), (25e-3, 0.5e-3)])
def test_penetration_scene(plugin, thickness, spacing):
	from yade import O
	s = scenes.penetration(thickness=thickness, spacing=spacing, mode='mca', ends='fixed')
	rod, plate = s.packings['rod'], s.packings['plate']
	mass = lambda part: sum(O.bodies[int(i)].state.mass for i in s.ids[part])
	assert mass('rod') == pytest.approx(17600 * 0.1 * 0.01, rel=1e-9)
	assert mass('plate') == pytest.approx(7830 * thickness * s.facts['automataWidth'], rel=1e-9) and abs(s.facts['automataWidth'] - 80e-3) < spacing
	# mirror symmetric about the axis, with a column on it
	for p in (rod, plate):
		left, right = ({(round(sign * x / spacing * 1e3), round(y / spacing * 1e3)): w for (x, y), w in zip(p.positions, p.weight)} for sign in (-1, 1))
		assert left.keys() == right.keys() and max(abs(left[k] - right[k]) for k in left) < 1e-9
	# the tied column stands on the nodes of a grid of the plate's thickness
	column = plate.onLine((0.5 * s.facts['automataWidth'], 0), (0, 1))
	assert plate.positions[column, 1] == pytest.approx(np.linspace(-thickness, 0, round(thickness / spacing) + 1), abs=1e-12)
	assert plate.weight[column[1:-1]] == pytest.approx(0.5, abs=1e-9)
	assert all(not O.bodies[int(s.ids['plate'][i])].dynamic for i in column)
	assert sum(not b.dynamic for b in O.bodies) == 2 * len(column)
	assert O.materials[0].fractureStrain == 1.0 and {m.label for m in O.materials} == {'WHA_JC', '4340'}


def test_scenes_run_and_keep_momentum(plugin):
	from yade import O
	s = scenes.penetration(thickness=4e-3, spacing=1e-3, rodLength=10e-3, rodDiameter=4e-3, automataWidth=20e-3, mode='mca', ends='free')
	before = sum((O.bodies[int(i)].state.mass * np.array(O.bodies[int(i)].state.vel) for i in s.ids['rod']))
	O.run(60, True)
	assert np.array(s.automata.momentum) == pytest.approx(before[:2], abs=1e-9 * abs(before[1]))
	r = scenes.rodMeasure(s)
	assert 0 < r.velocityLossAll < 0.5 and s.field('plate', 'vy').min() < -10
	O.reset()
	s = scenes.bar('4340', 20e-3, 5e-3, 1e-3, velocity=(3., 0.))
	O.run(20, True)
	assert s.field('bar', 'vx') == pytest.approx(3., abs=1e-9) and s.field('bar', 'equivalentStress').max() < 0.1  # round-off: G times 1e-16 of the distance to the origin over the spacing [Pa]
	O.reset()
	s = scenes.taylorBar('4340', 12e-3, 4e-3, 1e-3, 150., anvil='rough')
	O.run(100, True)
	assert s.field('bar', 'plasticStrain').max() > 0.01 and s.field('anvil', 'vy') == pytest.approx(0, abs=0)


def test_no_automaton_of_a_strip_hangs_on_two_links_and_its_edges_count_half(plugin):
	from yade import O
	s = scenes.plateImpact('WHA_JC', '4340', 6e-3, 9e-3, 7e-3, 0.5e-3, 1520.)
	for part, density, columns in (('flyer', 17600, 12), ('target', 7830, 18)):
		p = s.packings[part]
		edge = abs(p.positions[:, 1]) > np.abs(p.positions[:, 1]).max() - 1e-9
		assert np.bincount(p.pairs().ravel()).min() >= 3 and (p.weight == np.where(edge, 0.5, 1.)).all() and 0 < edge.sum() < len(p)
		full = density * math.sqrt(0.75) * 0.5e-3**2
		mass = np.array([O.bodies[int(i)].state.mass for i in s.ids[part]])
		assert mass == pytest.approx(full * p.weight) and mass.sum() == pytest.approx(columns * 16 * full, rel=0.02)
	both = np.concatenate([s.packings[k].positions for k in ('flyer', 'target')])  # one lattice: six neighbours also across the contact
	gaps = np.sort(np.hypot(*(both[:, None] - both[None]).transpose(2, 0, 1)), axis=1)
	inside = (abs(both[:, 0]) < 1e-3) & (abs(both[:, 1]) < 2e-3)
	assert inside.sum() > 10 and gaps[inside, 1:7] == pytest.approx(0.5e-3, rel=1e-9)


@pytest.mark.parametrize('flyer, target, speed', IMPACTS)
def test_plate_impact_as_it_comes_reaches_the_exact_end_state(plugin, flyer, target, speed):
	"""The library's materials, unchanged but that links may break. Reference: impedance match of perfectly plastic materials; hardening is within the tolerance."""
	from yade import O
	m = [mcaMat(k, label='%s%d' % (k, n), fractureStrain=1.) for n, k in enumerate((flyer, target))]
	d, length = 0.25e-3, 30e-3
	s = scenes.plateImpact(*m, length, length, 8 * scenes.PITCH * d, d, speed)
	u, there, here = matched([mcaMat(k, yieldModel='perfect') for k in (flyer, target)], speed)
	O.run(1, True)
	while O.time < 0.75 * length / max(there['D'], there['precursorD'], here['D']):
		O.run(20, True)
	x, v, p = scenes.profile(s, 'target', 'vx', 'pressure')
	xf, pf = scenes.profile(s, 'flyer', 'pressure')
	face = 0.5 * (x[0] + xf[-1])  # the younger half of what the shocks have passed, without the fronts
	share = lambda at, front: (abs(at - face) > 0.6 * abs(front - face)) & (abs(at - face) < 0.85 * abs(front - face))
	there_, here_ = share(x, O.time * there['D']), share(xf, O.time * (speed - here['D']))
	assert v[there_].mean() == pytest.approx(u, rel=0.01)
	assert p[there_].mean() == pytest.approx(there['P'], rel=0.02) and pf[here_].mean() == pytest.approx(here['P'], rel=0.02)
	far = [s.field(k, 'brokenLinks')[abs(s.packings[k].positions[:, 0]) > 5 * d].sum() for k in ('flyer', 'target')]
	assert far == [0, 0] and s.automata.counters()['deepest'] > 0.5


def test_taylor_bar_stands_as_on_the_grid(plugin):
	"""OFHC copper at 250 m/s, 16 automata across: shortening within 1 %, width of the mushroom within 5 %."""
	from yade_mca.tasks.verify import automata_impact
	copper = lambda: mcaMat('OFHC_Cu')
	end = 50e-6
	length, widths = automata_impact.barOfCells(16, copper(), 250., end)
	found = automata_impact.barOfAutomata(16, copper(), 250., end)
	assert 1 - found[0] == pytest.approx(1 - length, rel=0.01) and 1 - length > 0.3
	assert found[1][:3] == pytest.approx(widths[:3], rel=0.05) and widths[:3].min() > 3


def test_plate_impact_reaches_the_exact_plateau(plugin):
	from yade import O

	from yade_mca.exact import piston
	from yade_mca.materials import get
	m = get('4340', yieldModel='perfect')
	s = scenes.plateImpact(m, m, 6e-3, 12e-3, 8e-3, 0.25e-3, 400.)
	while O.time < 0.8e-6:
		O.run(20, True)
	x, y, p, v = (np.concatenate([s.field(k, q) for k in ('flyer', 'target')]) for q in ('x', 'y', 'pressure', 'vx'))
	# between the contact, where the impact has left its mark on the few rows next to it, and the shocks
	distance = abs(x - 200. * O.time)
	middle = (abs(y) < s.facts['middle']) & (distance > 1.75e-3) & (distance < 3e-3)
	exact = piston(m.density, m.bulkSoundSpeed, m.hugoniotSlope, m.shearModulus, m.yieldStress, 200.)
	assert v[middle].mean() == pytest.approx(200, rel=0.01) and p[middle].mean() == pytest.approx(exact['P'], rel=0.01)


SMALL = dict(thickness=8e-3, spacing=1e-3, rodLength=20e-3, rodDiameter=5e-3, automataWidth=40e-3, plateWidth=70e-3)


@pytest.mark.parametrize('mode', ['mca', 'coupled'])
@pytest.mark.parametrize('angle, obliquity', [(0, 0), (10, 0), (-25, 0), (30, 0), (60, 0), (0, 30), (0, -60), (17, 20)])
def test_turned_packings_and_oblique_rods(plugin, mode, angle, obliquity):
	from yade import O
	s = scenes.penetration(**SMALL, mode=mode, angle=math.radians(angle), obliquity=math.radians(obliquity))
	mass = lambda part: sum(O.bodies[int(i)].state.mass for i in s.ids[part])
	assert mass('rod') == pytest.approx(17600 * 0.02 * 0.005, rel=1e-9) and mass('plate') == pytest.approx(7830 * 8e-3 * s.facts['automataWidth'], rel=1e-9)
	n = np.array((math.sin(math.radians(obliquity)), -math.cos(math.radians(obliquity))))
	assert s.facts['direction'] == pytest.approx(n) and np.array(O.bodies[int(s.ids['rod'][0])].state.vel)[:2] == pytest.approx(1520 * n)
	rod, plate = s.packings['rod'].positions, s.packings['plate'].positions
	gap = np.hypot(*(rod[:, None] - plate[None]).transpose(2, 0, 1))
	assert 1e-3 <= gap.min() < 1e-3 * (1 + 1e-6)
	across = (rod - (0, -4e-3)) @ (-n[1], n[0])  # from the line through the middle of the plate along the flight
	assert abs(across).max() < 2.6e-3 and abs(across.mean()) < 0.2e-3
	if obliquity == 0:  # the head goes on with the plate's lattice: all of it touches at once
		assert ((gap < 1e-3 * (1 + 1e-6)).any(axis=0)).sum() >= 4
	lattice = np.sort(np.hypot(*(plate[:, None] - plate[None]).transpose(2, 0, 1)), axis=1)[:, 1]
	assert lattice == pytest.approx(1e-3, rel=1e-9)
	before = sum(O.bodies[int(i)].state.mass * np.array(O.bodies[int(i)].state.vel)[:2] for i in s.ids['rod'])
	O.run(1, True)
	e0 = s.couplers[0].energies() if mode == 'coupled' else s.automata.energies()
	O.run(150, True)
	e = s.couplers[0].energies() if mode == 'coupled' else s.automata.energies()
	assert [e['momentum' + k] - e['impulse' + k] for k in 'XY'] == pytest.approx(before, abs=1e-9 * np.abs(before).max())
	assert e['total'] == pytest.approx(e0['total'], rel=2e-3) and scenes.rodMeasure(s).velocityLossAll > 0.005
	if mode == 'coupled':
		rows = [len(c.rowIds) for c in s.couplers]
		assert abs(rows[0] - rows[1]) <= 1 and 8 <= min(rows) and max(rows) <= 10


@pytest.mark.parametrize('columns', [21, 22, 23, 24])
def test_a_fast_rod_does_not_depend_on_how_columns_line_up(plugin, columns):
	from yade import O
	s = scenes.penetration(**dict(SMALL, automataWidth=2 * columns * scenes.PITCH * 1e-3, mode='mca', speed=5000.))
	touching = np.hypot(*(s.packings['rod'].positions[:, None] - s.packings['plate'].positions[None]).transpose(2, 0, 1)) < 1e-3 * (1 + 1e-6)
	assert touching.any(axis=1).sum() == 5 or touching.any(axis=1).sum() == 6  # every column of the rod
	O.run(1, True)
	while O.time < 3e-6:
		O.run(20, True)
	assert s.automata.counters()['deepest'] > 0.2


def test_the_length_of_the_rod(plugin):
	from yade import O
	s = scenes.penetration(**SMALL, obliquity=0.5)
	O.run(1, True)
	assert scenes.rodLength(s) == pytest.approx(s.facts['restLength'], rel=1e-3) and s.facts['restLength'] == pytest.approx(20e-3, abs=0.5e-3)
	while O.time < 4e-6:
		O.run(20, True)
	lost = 1 - scenes.rodLength(s) / s.facts['restLength']
	assert 0.03 < lost < scenes.rodMeasure(s).lengthLoss


@pytest.mark.parametrize('options, word', [
        (dict(thickness=-1.), 'thickness must be above 0'),
        (dict(spacing=20e-3), 'above half'),
        (dict(spacing=0.7e-3), 'whole number of spacings'),
        (dict(mode='grid'), 'coupled, mca'),
        (dict(ends='glued'), 'fixed, viscous, free'),
        (dict(speed=float('nan')), 'speed must be above 0'),
        (dict(mode='coupled', plateWidth=70e-3), 'no room'),
        (dict(mode='coupled', plateWidth=90e-3, angle=0.5), 'lean by 28.6 degrees: take at least'),
        (dict(speed=1e9), 'at most 45780 m/s, 10 times the sound speed'),
        (dict(speed='fast'), 'speed must be above 0'),
        (dict(spacing=1e-8), 'take a spacing of at least'),
        (dict(rodLength=1e9), 'take a spacing of at least'),
        (dict(rodLength=1e-3), 'below two spacings'),
        (dict(plateWidth=1e9), 'more than 10000 lines'),
        (dict(automataWidth=float('inf')), 'automataWidth must be above 0 and finite'),
        (dict(automataWidth=8e-3), 'too narrow'),
        (dict(obliquity=1.2, automataWidth=70e-3), 'too narrow: at an obliquity of 68.8 degrees'),
        (dict(obliquity=1.5), 'obliquity must be from -1.309 to 1.309 rad'),
        (dict(angle=float('nan')), 'angle must be from'),
        (dict(friction=float('inf')), 'friction must be from 0 to 10'),
        (dict(friction=-0.1), 'friction must be from 0 to 10'),
        (dict(viscosity=float('nan')), 'viscosity must be'),
        (dict(strengthSpread=2.), 'strengthSpread must be from 0 to 1'),
        (dict(fractureStrain=0.), 'fractureStrain must be above 0'),
        (dict(spallStrength=3e9), 'spallStrength must be two numbers'),
        (dict(spallStrength=(3e9, float('nan'))), 'spallStrength must be above 0'),
        (dict(seed=-1), 'seed must be'),
        (dict(dtFactor=1.5), 'dtFactor must be above 0 and at most 1'),
        (dict(rod='unobtainium'), 'unknown material'),
        (dict(eos='nonsense'), 'eos'),
])
def test_refusals(plugin, options, word):
	from yade import O
	with pytest.raises(ValueError, match=word):
		scenes.penetration(**options)
	assert len(O.bodies) == 0


NAN, INF = float('nan'), float('inf')


@pytest.mark.parametrize('build, word', [
        (lambda: scenes.bar('4340', NAN, 5e-3, 1e-3), 'length must be above 0 and finite'),
        (lambda: scenes.bar('4340', 2e-2, 5e-3, 1e-3, velocity=(1e9, 0.)), 'velocity must be at most'),
        (lambda: scenes.bar('4340', 2e-2, 5e-3, 1e-3, velocity=(NAN, 0.)), 'velocity must be'),
        (lambda: scenes.bar('4340', 2e-2, 5e-3, 1e-3, angle=INF), 'angle must be from'),
        (lambda: scenes.bar('4340', 20., 5., 1e-6), 'take a spacing of at least'),
        (lambda: scenes.plateImpact('4340', '4340', 6e-3, 9e-3, 7e-3, 0.5e-3, 1e9), 'speed must be at most'),
        (lambda: scenes.plateImpact('4340', '4340', 6e-3, INF, 7e-3, 0.5e-3, 100.), 'targetThickness must be above 0'),
        (lambda: scenes.plateImpact('4340', '4340', 6e-3, 9e-3, 7e-3, 5e-3, 100.), 'spacing 0.005 m is above'),
        (lambda: scenes.plateImpact('4340', '4340', 6e-3, 9e-3, 7e-3, 1e-3, 100., lateral='glued'), 'fixed, free'),
        (lambda: scenes.taylorBar('4340', 12e-3, 4e-3, 1e-3, INF), 'speed must be above 0 and finite'),
        (lambda: scenes.taylorBar('4340', 12e-3, 4e-3, 1e-3, 1e9), 'speed must be at most'),
        (lambda: scenes.taylorBar('4340', 12e-3, 4e-3, 1e-3, 100., friction=NAN, anvil='rough'), 'friction must be from'),
        (lambda: scenes.taylorBar('4340', 12e-3, 4e-3, 1e-3, 100., friction=0.1), "take anvil='rough'"),
        (lambda: scenes.taylorBar('4340', 12e-3, 4e-3, 1e-3, 100., anvil='soft'), 'smooth, rough'),
        (lambda: scenes.taylorBar('4340', 12e-3, 4e-3, 1e-3, 100., rim='full'), 'triangles, cells'),
        (lambda: scenes.bar('4340', 2e-2, 5e-3, 1e-3, rim='round'), 'triangles, cells, full'),
        (lambda: scenes.taylorBar('4340', 12e-3, 4e-3, 3e-3, 100.), 'above half the length or diameter'),
        (lambda: scenes.tiedPlate('4340', 8e-3, 1e-3, growth=NAN), 'growth must be from 1'),
        (lambda: scenes.tiedPlate('4340', 8e-3, 1e-3, largest=0.5), 'largest must be from 1'),
        (lambda: scenes.tiedPlate('4340', 8e-3, 1e-3, dtFactor=NAN), 'dtFactor must be above 0'),
        (lambda: gradedLines(0., NAN, 1.), 'end must be'),
        (lambda: gradedLines(0., 1e9, 1e-3, largest=1.), 'more than 10000 lines'),
        (lambda: gradedLines(0., 1., 1e-3, growth=INF), 'growth must be'),
        (lambda: scenes.strip(1e-3, 0., 1e-2, 7), 'even'),
        (lambda: scenes.strip(1e-3, 0., 1e-2, 8, angle=0.3), '0 or pi/2'),
        (lambda: scenes.touchDown(hexagonal(1., Rectangle((50, 50), (8, 20))), hexagonal(1., Rectangle((0, 0), (8, 20)))), 'do not meet'),
])
def test_no_builder_takes_what_is_no_scene(plugin, build, word):
	from yade import O
	with pytest.raises(ValueError, match=word) as e:
		build()
	assert len(O.bodies) == 0 and '\n' not in str(e.value)
