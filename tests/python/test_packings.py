# SPDX-License-Identifier: GPL-2.0-or-later
"""Packings: the area is the outline's, neighbours are six, weights are those of the cells, wrong names are refused."""
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from yade_mca import packings
from yade_mca.outlines import OutlineError, Polygon, Predicate, Rectangle, clippedAreas, disc
from yade_mca.packings import PackingError, cellGeometry, hexagonal


@pytest.mark.parametrize('name', ['hexagonal', 'square', 'sc', 'fcc', 'hcp'])
def test_identity_of_volume_contact_and_neighbours(name):
	c = cellGeometry(name, 1.7e-3)
	assert c.volume == pytest.approx(c.neighbours * c.contact * 1.7e-3 / (2 * c.dim), rel=1e-14)


@settings(max_examples=40, deadline=None)
@given(w=st.floats(5, 40), h=st.floats(5, 40), turn=st.floats(0, 3.2), lattice=st.floats(-3.2, 3.2), ox=st.floats(0, 1), oy=st.floats(0, 1))
def test_area_is_the_outlines_for_any_rectangle_orientation_and_origin(w, h, turn, lattice, ox, oy):
	p = hexagonal(1., Rectangle((3, -2), (w, h), turn), angle=lattice, origin=(ox, oy))
	assert p.area == pytest.approx(w * h, rel=1e-10)
	assert p.weight.min() >= 0.2 and p.weight.max() < 2.5
	interior = p.weight[np.bincount(p.pairs().ravel(), minlength=len(p)) == 6]
	assert len(p) < 60 or np.median(interior) == 1


@settings(max_examples=25, deadline=None)
@given(st.integers(3, 9), st.integers(0, 10**6))
def test_area_is_the_outlines_for_any_star_shaped_polygon_with_a_hole(n, seed):
	rng = np.random.default_rng(seed)
	a = np.sort(rng.uniform(0, 2 * np.pi, n))
	while np.diff(np.append(a, a[0] + 2 * np.pi)).max() > 2.8:  # keep the middle inside
		a = np.sort(rng.uniform(0, 2 * np.pi, n))
	ring = rng.uniform(12, 30, n)[:, None] * np.stack((np.cos(a), np.sin(a)), axis=1)
	hole = 0.8 * np.array([(1, 0), (0, 1), (-1, 0), (0, -1.)])
	outline = Polygon(ring, [hole])
	p = hexagonal(1., outline, angle=rng.uniform(0, 1))
	assert p.area == pytest.approx(outline.area, rel=1e-10)


def test_rectangle_is_filled_evenly():
	for angle in (0, math.pi / 2, math.pi / 3, 0.3):
		p = hexagonal(1e-3, Rectangle((0, 0), (80e-3, 25e-3)), angle=angle)
		assert p.area == pytest.approx(80e-3 * 25e-3, rel=1e-12)
		if angle in (0, math.pi / 2):
			assert 0.5 <= p.weight.min() and p.weight.max() <= 1.51
			assert np.allclose(p.positions.max(axis=0) + p.positions.min(axis=0), 0, atol=1e-12)  # as much on the left as on the right


def test_automata_on_the_outline_count_half():
	pitch = 0.5 * math.sqrt(3)
	p = hexagonal(1., Rectangle((0, 0), (20 * pitch, 20)), angle=math.pi / 2, origin=(10 * pitch, 10))
	row = p.onLine((10 * pitch, 0), (0, 1))
	assert len(row) == 21 and np.allclose(p.positions[row, 1], np.arange(-10, 11))
	assert np.allclose(p.weight[row[1:-1]], 0.5, atol=1e-12) and np.allclose(p.weight[row[[0, -1]]], 0.25, atol=1e-12)


def test_full_rim_is_the_union_of_cells():
	p, q = (hexagonal(1., Rectangle((0, 0), (30, 20)), rim=r) for r in ('full', 'cells'))
	assert np.array_equal(p.positions, q.positions) and (p.weight == 1).all()
	assert p.area == pytest.approx(600, rel=0.05)


@pytest.mark.parametrize('angle', [0., math.pi / 2, 0.3])
def test_triangles_are_the_body(angle):
	"""The weights are those of the triangles that the automata make, their area that of the outline within the rim; straight sides are on the outline."""
	pitch = 0.5 * math.sqrt(3)
	size = np.array((30., 24 * pitch)) if angle == 0 else np.array((24 * pitch, 30.))
	p = hexagonal(1., Rectangle((3, -2), size), angle=angle, rim='triangles')
	assert np.allclose(p.weight * 6, np.round(p.weight * 6), atol=1e-12) and set(np.round(p.weight * 6)) <= {1, 2, 3, 4, 5, 6}
	assert p.area == pytest.approx(size.prod(), rel=1e-12 if angle in (0., math.pi / 2) else 0.03)
	centre = (p.weight[:, None] * p.positions).sum(axis=0) / p.weight.sum()
	if angle == 0.3: return
	assert np.allclose(centre, (3, -2), atol=1e-12)
	straight = 1 if angle == 0 else 0
	assert np.ptp(p.positions[:, straight]) == pytest.approx(size[straight], rel=1e-12)
	assert p.positions[:, straight].min() == pytest.approx((3, -2)[straight] - 0.5 * size[straight], abs=1e-12)


@pytest.mark.parametrize('outline, angle', [(disc((0, 0), 7.4), 0.), (disc((0, 0), 10.), 0.35), (Rectangle((0, 0), (30, 12)), 0.26),
                                            (Polygon(20 * np.array(((-1, -1), (1, -1), (1, 1), (-1, 1))), [10 * np.array(((-1, 0), (0, -1), (1, 0), (0, 1)))]), 0.1)])
def test_weights_are_the_triangles_of_the_neighbours(outline, angle):
	"""As the engines count them: three automata that are neighbours of each other make a triangle."""
	p = hexagonal(1., outline, angle=angle, rim='triangles')
	near = np.hypot(*(p.positions[:, None] - p.positions[None]).transpose(2, 0, 1)) < 1.1
	np.fill_diagonal(near, False)
	triangles = np.diag(near.astype(int) @ near @ near) // 2
	assert np.array_equal(triangles, np.round(6 * p.weight).astype(int))


def test_triangles_of_other_outlines():
	ring = Polygon(20 * np.array(((-1, -1), (1, -1), (1, 1), (-1, 1))), [8 * np.array(((-1, -1), (1, -1), (1, 1), (-1, 1)))])
	for outline, area in ((ring, 1600 - 256), (disc((0, 0), 15.), math.pi * 225)):
		p = hexagonal(1., outline, rim='triangles')
		assert p.area == pytest.approx(area, rel=0.025)
	with pytest.raises(PackingError, match='no triangle of spacing'):
		hexagonal(1., Rectangle((0, 0.1), (0.2, 0.2)), origin=(0, 0), rim='triangles')


@given(angle=st.floats(-7, 7))
@settings(max_examples=20, deadline=None)
def test_pairs_are_all_neighbours_at_one_spacing(angle):
	p = hexagonal(2., Rectangle((0, 0), (24, 21)), angle=angle)
	pairs = p.pairs()
	assert np.allclose(np.hypot(*(p.positions[pairs[:, 0]] - p.positions[pairs[:, 1]]).T), 2., rtol=1e-12)
	separation = np.hypot(*(p.positions[:, None] - p.positions[None]).transpose(2, 0, 1))
	assert len(pairs) == np.sum(np.triu(separation < 2.1, 1)) and len(np.unique(pairs, axis=0)) == len(pairs)


class Ball:
	"""A predicate as those of yade.pack: a sphere in space."""

	def __init__(self, r):
		self.r = r

	def __call__(self, p, pad=0.):
		return p[0]**2 + p[1]**2 + p[2]**2 <= (self.r - pad)**2

	def aabb(self):
		return (-self.r,) * 3, (self.r,) * 3


def test_predicate_by_sampling_agrees_with_the_polygon():
	a, b = (hexagonal(1., o, origin=(0.1, 0.2)) for o in (Ball(15.), disc((0, 0), 15.)))
	assert a.area == pytest.approx(math.pi * 225, rel=2e-3) and b.area == pytest.approx(math.pi * 225, rel=1e-10)
	wa, wb = ({tuple(k): w for k, w in zip(p.lattice.tolist(), p.weight)} for p in (a, b))
	assert len(wa.keys() ^ wb.keys()) <= 4  # centres within rounding of the circle
	assert np.quantile([abs(wa[k] - wb[k]) for k in wa.keys() & wb.keys()], 0.99) < 0.05


def test_clipping_a_polygon_that_is_not_convex():
	comb = np.array([(0, 0), (10, 0), (10, 5), (8, 5), (8, 1), (6, 1), (6, 5), (4, 5), (4, 1), (2, 1), (2, 5), (0, 5)], float)
	square = np.array([(-1, 2), (11, 2), (11, 4), (-1, 4)], float)
	assert clippedAreas(comb, square[None]) == pytest.approx(3 * 2 * 2)


@pytest.mark.parametrize('name, word', [('square', 'gear'), ('cube', 'gear'), ('sc', 'gear'), ('fcc', 'space'), ('hcp', 'space'), ('random', 'unknown')])
def test_other_packings_are_refused_with_the_reason(name, word):
	with pytest.raises(PackingError, match=word):
		packings.create(name, 1., Rectangle((0, 0), (5, 5)))


@pytest.mark.parametrize('make, word', [
        (lambda: hexagonal(0., Rectangle((0, 0), (1, 1))), 'above 0'),
        (lambda: hexagonal(float('nan'), Rectangle((0, 0), (1, 1))), 'above 0'),
        (lambda: hexagonal(1., Rectangle((0, 0), (.1, .1)), origin=(.5, .5)), 'smaller spacing'),
        (lambda: hexagonal(1e-9, Rectangle((0, 0), (1, 1))), 'unit'),
        (lambda: hexagonal(1., Rectangle((0, 0), (9, 9)), rim='half'), 'one of'),
        (lambda: Rectangle((0, 0), (-1, 1)), 'above 0'),
        (lambda: Polygon([(0, 0), (1, 1), (2, 2)]), 'no area'),
        (lambda: hexagonal(1., 5), 'outline'),
        (lambda: Predicate(lambda p, pad: True), 'aabb'),
])
def test_errors(make, word):
	with pytest.raises((PackingError, OutlineError), match=word):
		make()


def test_a_hundred_thousand_automata_touch_only_the_rim():
	"""Work, not time: cells that are clipped grow with the perimeter only."""
	clipped = []

	class Counting(Rectangle):

		def overlap(self, cells):
			clipped.append(len(cells))
			return super().overlap(cells)

	p = hexagonal(1., Counting((0, 0), (316, 316 * 0.866)))
	assert 0.98e5 < len(p) < 1.02e5 and sum(clipped) < 6000


def test_bodies_have_the_mass_inertia_and_freedom_of_discs(plugin):
	from yade import O
	from yade.wrapper import FrictMat
	p = hexagonal(2e-3, Rectangle((0, 0), (20e-3, 15e-3)))
	velocity = np.stack((np.arange(len(p)), -np.arange(len(p))), axis=1)
	ids = packings.addBodies(p, FrictMat(density=7800.), velocity=velocity, mask=4)
	held = packings.addBodies(p.translated((0, 1)), O.materials[0], fixed=True)
	assert list(ids) == list(range(len(p))) and len(O.materials) == 1
	assert sum(O.bodies[i].state.mass for i in ids) == pytest.approx(7800 * 20e-3 * 15e-3, rel=1e-10)
	b = O.bodies[ids[7]]
	assert b.state.inertia[2] == pytest.approx(0.5 * b.state.mass * 1e-3**2) and b.shape.radius == pytest.approx(1e-3)
	assert sorted(b.state.blockedDOFs) == sorted('zXY') and b.mask == 4 and tuple(b.state.vel) == (7, -7, 0)
	assert np.allclose(b.state.pos, (*p.positions[7], 0)) and np.allclose(b.state.refPos, b.state.pos)
	assert not O.bodies[held[0]].dynamic
	with pytest.raises(PackingError, match='velocity'):
		packings.addBodies(p, O.materials[0], velocity=(1, 2, 3))


def rest(road):
	"""Bodies that an engine has moved and pressed."""
	import engine_scene, law2_scene
	from yade import O
	from yade.wrapper import McaEngine
	if road == 'engine':
		ids = np.concatenate(engine_scene.impact(speed=100.))
		O.engines = [McaEngine()]
	else:
		ids = np.array(law2_scene.impact(speed=100.))
		law2_scene.engines('law2', 2e-8)
	while max(O.bodies[int(i)].state.pressure for i in ids) < 1e8:
		O.run(20, True)
	return ids


@pytest.mark.parametrize('road', ['engine', 'law2'])
def test_resetStatesLetsANewEngineGoOn(plugin, road):
	"""Refused before, accepted after; motion stays, results go."""
	from yade import O
	from yade.wrapper import McaEngine
	ids = rest(road)
	kept = lambda: [(tuple(b.state.pos), tuple(b.state.vel), tuple(b.state.angVel), tuple(b.state.ori), b.state.mass, b.state.blockedDOFs, b.state.strength) for b in O.bodies]
	O.bodies[int(ids[0])].state.blockedDOFs = 'xyzXYZ'
	before = kept()
	O.engines, O.dt = [McaEngine(adaptive=False)], 1e-9
	with pytest.raises(RuntimeError, match='resetStates' if road == 'engine' else 'McaLaw has moved it'):
		O.run(1, True)
	packings.resetStates(ids.tolist())
	assert kept() == before
	s = O.bodies[int(ids[3])].state
	assert (s.pressure, s.volumeRatio, s.plasticStrain, s.brokenLinks, s.dissipated, s.temperature) == (0, 1, 0, 0, 0, O.bodies[int(ids[3])].material.referenceTemperature)
	O.engines = [McaEngine(adaptive=False)]
	O.run(20, True)
	assert O.iter > 20 and all(np.isfinite(b.state.pos).all() for b in O.bodies)


def test_resetStatesOfTheEngineThatMovedThemIsRefused(plugin):
	from yade import O
	ids = rest('engine')
	packings.resetStates(ids)
	with pytest.raises(RuntimeError, match='it is a result of the law and cannot be prescribed'):
		O.run(1, True)


@pytest.mark.parametrize('wrong', [None, 5, 'ab', [0.5], [-1], [10**6], [[1]], [[1], [2, 3]], ['x'], [True], {1: 2}])
def test_resetStatesRefusesWhatIsNoAutomaton(plugin, wrong):
	from yade import O
	ids = packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((0, 0), (3e-3, 3e-3))), '4340')
	states = [O.bodies[i].state for i in ids]
	with pytest.raises(packings.PackingError, match='ids'):
		packings.resetStates(ids + wrong if wrong in ([-1], [10**6]) else wrong)
	assert all(O.bodies[i].state is s or O.bodies[i].state == s for i, s in zip(ids, states))
