# SPDX-License-Identifier: GPL-2.0-or-later
"""The definitions of the penetration study on rods whose answer is known."""
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from yade_mca import measure
from yade_mca.measure import craterDepth, geometricLength, meanAround, momentumSettled, rearClearance, rodMeasure


def rod(n=1000, speed=1520.):
	return np.full(n, 2.), np.tile((0., -speed), (n, 1)), np.zeros(n)


def test_untouched_rod_has_lost_nothing():
	r = rodMeasure(*rod(), 1520.)
	assert (r.lengthLoss, r.velocityLossTail, r.velocityLossAll, r.tailMass, r.intactMass) == pytest.approx((0, 0, 0, 1, 1), abs=1e-12)


def test_known_rod():
	m, v, e = rod()
	v[:, 1] = -1520 * 0.96  # the tail has lost 4 %
	e[700:800], v[700:800, 1] = 0.2, -1520 * 0.96 * 0.9  # bent, still with the rod: intact but not tail
	e[800:900], v[800:900, 1] = 0.2, -1520 * 0.96 * 0.8  # too slow
	e[900:], v[900:, 1] = 1.5, 0.  # debris at rest
	r = rodMeasure(m, v, e, 1520.)
	assert r.velocityLossTail == pytest.approx(0.04) and r.lengthLoss == pytest.approx(0.2) and r.tailMass == pytest.approx(0.7)
	assert r.velocityLossAll == pytest.approx(1 - 0.96 * (0.7 + 0.09 + 0.08))


@given(turn=st.floats(0, 6.3), seed=st.integers(0, 1000), factor=st.floats(0.1, 10))
def test_losses_do_not_depend_on_direction_order_or_unit_of_mass(turn, seed, factor):
	rng = np.random.default_rng(seed)
	m, e, v = rng.random(200) + 0.1, rng.exponential(0.3, 200), rng.normal((0, -1400), 200, (200, 2))
	e[:5] = 0
	a = rodMeasure(m, v, e, 1520.).asDict()
	c, s = math.cos(turn), math.sin(turn)
	turned, order = v @ np.array([(c, s), (-s, c)]), rng.permutation(200)
	b = rodMeasure(factor * m[order], turned[order], e[order], 1520., direction=(3 * s, -3 * c)).asDict()
	assert b == pytest.approx(a, rel=1e-9, abs=1e-9)
	assert 0 <= a['lengthLoss'] <= 1 and a['intactMass'] == pytest.approx(1 - a['lengthLoss'])


def test_no_undeformed_material():
	m, v, e = rod(10)
	r = rodMeasure(m, v, e + 0.5, 1520.)
	assert r.lengthLoss == 1 and math.isnan(r.velocityLossTail) and r.velocityLossAll == pytest.approx(0)


@pytest.mark.parametrize('change', [lambda m, v, e: (m[:-1], v, e), lambda m, v, e: (m, v * np.nan, e), lambda m, v, e: (m[:0], v[:0], e[:0]), lambda m, v, e: (0 * m, v, e)])
def test_wrong_input(change):
	with pytest.raises(ValueError, match='one entry|finite'):
		rodMeasure(*change(*rod(10)), 1520.)


def test_exit():
	y = np.linspace(0.1, 0, 1001)
	p, e = np.stack((0 * y, y), axis=1), np.zeros(1001)
	assert rearClearance(p, e, (0, -0.025)) == pytest.approx(-0.03, abs=1e-4)
	assert rearClearance(p - (0, 0.08), e, (0, -0.025)) == pytest.approx(0.05, abs=1e-4)
	e[y < 0.05] = 2.  # the front half is debris
	assert rearClearance(p - (0, 0.08), e, (0, -0.025)) == pytest.approx(0.0025, abs=3e-4)


@given(obliquity=st.floats(-1.2, 1.2), beyond=st.floats(-0.01, 0.05))
def test_exit_is_measured_normal_to_the_face(obliquity, beyond):
	"""A thin oblique rod: 95 % of it is behind the point whose distance from the face is asked for, wherever on the face it comes through."""
	n = np.array((np.sin(obliquity), -np.cos(obliquity)))
	s = np.linspace(-0.1, 0, 1001)[:, None]
	p = np.array((0.013, -0.025 - beyond)) + s * n  # the foremost point is `beyond` the face
	assert rearClearance(p, np.zeros(1001), (0, -0.025)) == pytest.approx(beyond - 0.005 * np.cos(obliquity), abs=1e-9)


def grains(length=0.1, radius=5e-3, d=0.5e-3):
	y, x = np.meshgrid(np.arange(0, length + d / 2, d), np.arange(-radius, radius + d / 2, d), indexing='ij')
	return np.stack((x.ravel(), y.ravel()), axis=1)  # head at y = 0


@given(turn=st.floats(0, 6.3), shift=st.floats(-1, 1))
def test_geometric_length(turn, shift):
	"""Known rods, anywhere and in any direction: whole, eroded, with a mushroom and debris around and grains ahead of it."""
	p = grains()
	c, s = math.cos(turn), math.sin(turn)
	length = lambda p, e: geometricLength(p @ np.array([(c, s), (-s, c)]) + shift, e, 5e-3, (s, -c))
	e = np.zeros(len(p))
	whole = length(p, e)
	assert whole == pytest.approx(0.1, abs=1e-3)
	gone = p[:, 1] < 0.03
	assert length(p, np.where(gone, 1.5, e)) == pytest.approx(0.07, abs=1e-3)  # debris where it was
	head = np.where(gone, 0.8, e)
	assert length(p, head) == pytest.approx(whole, abs=1e-3)  # strained, but rod
	aside = p + np.where(gone, 8e-3 * np.sign(p[:, 0]), 0.)[:, None] * (1, 0)
	assert length(aside[p[:, 0] != 0], head[p[:, 0] != 0]) == pytest.approx(0.07, abs=1e-3)  # turned aside beyond the radius
	ahead = np.concatenate((p, [(0., -0.05)] * 3))
	assert length(ahead, np.append(e, [0.9] * 3)) == pytest.approx(whole, rel=1e-2)  # a few grains ahead
	assert length(p, e + 0.5) == 0


def test_momentum_settles():
	t = np.linspace(0, 1e-4, 101)
	p = 100 * np.exp(-t / 1e-5)
	assert not momentumSettled(t[:30], p[:30], 1e-5) and momentumSettled(t, p, 1e-5) and not momentumSettled(t[:5], p[:5], 1e-5)
	assert not momentumSettled(t, 100 - 1e5 * t, 1e-5)


def test_meansStandForTheirPlaces():
	"""Of a linear field, at an edge as inside; one column as several."""
	rng = np.random.default_rng(5)
	x, m = rng.random((400, 2)), rng.random(400)
	f = np.stack((3 + x @ (2., -1.), x[:, 1]), axis=1)
	points = np.array([(0., 0.5), (0.5, 0.5), (1., 1.), (9., 9.)])
	means, places = meanAround(points, x, m, f, 0.2)
	assert np.isnan(means[3]).all() and np.isnan(places[3]).all()
	assert means[:3, 0] == pytest.approx(3 + places[:3] @ (2., -1.)) and means[:3, 1] == pytest.approx(places[:3, 1])
	assert places[0, 0] > 0.05 and np.hypot(*(places[1] - points[1])) < 0.05
	assert meanAround(points[:3], x, m, f[:, 0], 0.2)[0] == pytest.approx(means[:3, 0], abs=0)
	with pytest.raises(ValueError, match='one entry'):
		meanAround(points, x, m[1:], f, 0.2)
	with pytest.raises(ValueError, match='mass must not be negative'):
		meanAround(points, x, -m, f, 0.2)


@pytest.mark.parametrize('n', [1, 2, 3, 20, 21, 1000])
def test_quantileIsNumpys(n):
	rng = np.random.default_rng(n)
	for q in (0., 0.01, 0.3, 0.5, 0.95, 0.99, 1.):
		v = rng.normal(size=n)
		assert measure._quantile(v, q) == np.quantile(v, q)


def block(depth, size=20., step=0.5):
	"""Grid of points in a block below y = 0, a hole of this depth and 10 wide in its middle: positions (N, 3), volume (N,)."""
	a = np.arange(-0.5 * size + 0.5 * step, 0.5 * size, step)
	x, y, z = (c.ravel() for c in np.meshgrid(a, np.arange(-30 + 0.5 * step, 0, step), a))
	keep = (y < -depth) | (np.hypot(x, z) > 5)
	return np.stack((x, y, z), axis=1)[keep], np.full(keep.sum(), step**3)


@pytest.mark.parametrize('depth', [0., 4.5, 7.5, 12., 29.])
def test_depthOfACrater(depth):
	x, v = block(depth)
	assert craterDepth(x, v, 4., 1.) == pytest.approx(depth, abs=0.1)
	quarter = (x[:, 0] > 0) & (x[:, 2] > 0)
	assert craterDepth(x[quarter] + (3, 5, 7), v[quarter], 4., 1., (3, 5, 7), (0, -2, 0), parts=4) == pytest.approx(depth, abs=0.1)
	grains = np.array([(0.5, -2.2, 0.5), (1., -3.1, 0.), (0., 4., 0.)])  # in the crater and above the surface
	assert craterDepth(np.concatenate((x, grains)), np.append(v, (0.125, ) * 3), 4., 1.) == pytest.approx(depth, abs=0.1)
	flat = abs(x[:, 2]) < 0.3
	assert craterDepth(x[flat][:, [1, 0]], v[flat], 4., 1., direction=(-1, 0)) == pytest.approx(depth, abs=0.1)  # two layers, of 0.125 each


def test_depthOfAHole():
	x, v = block(31.)
	assert craterDepth(x, v, 4., 1.) == math.inf
	for wrong in (dict(radius=0.), dict(step=-1.), dict(direction=(0, 0)), dict(volume=v[1:]), dict(volume=-v), dict(parts=0), dict(positions=x * math.nan), dict(step=1e-9)):
		with pytest.raises(ValueError): craterDepth(**dict(dict(positions=x if 'step' not in wrong else block(3.)[0], volume=v if 'step' not in wrong else block(3.)[1],
		                                                        radius=4., step=1.), **wrong))
