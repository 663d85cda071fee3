# SPDX-License-Identifier: GPL-2.0-or-later
"""Scene builders: geometry, masses, boundaries, tied rows on grid nodes, refusals; and that the scenes run."""
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yade_mca import scenes
from yade_mca.packings import Rectangle, hexagonal
from yade_mca.scenes import SceneError, gradedLines


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
	s = scenes.taylorBar('4340', 12e-3, 4e-3, 1e-3, 150.)
	O.run(100, True)
	assert s.field('bar', 'plasticStrain').max() > 0.01 and s.field('anvil', 'vy') == pytest.approx(0, abs=0)


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


@pytest.mark.parametrize('options, word', [
        (dict(thickness=-1.), 'thickness must be above 0'),
        (dict(spacing=20e-3), 'above half'),
        (dict(spacing=0.7e-3), 'whole number of spacings'),
        (dict(mode='grid'), 'coupled, mca'),
        (dict(ends='glued'), 'fixed, viscous, free'),
        (dict(speed=float('nan')), 'speed must be above 0'),
        (dict(mode='coupled', plateWidth=70e-3), 'no room'),
])
def test_refusals(plugin, options, word):
	with pytest.raises(SceneError, match=word):
		scenes.penetration(**options)
