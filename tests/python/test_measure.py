# SPDX-License-Identifier: GPL-2.0-or-later
"""The definitions of the penetration study on rods whose answer is known."""
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from yade_mca.measure import momentumSettled, rearClearance, rodMeasure


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


def test_momentum_settles():
	t = np.linspace(0, 1e-4, 101)
	p = 100 * np.exp(-t / 1e-5)
	assert not momentumSettled(t[:30], p[:30], 1e-5) and momentumSettled(t, p, 1e-5) and not momentumSettled(t[:5], p[:5], 1e-5)
	assert not momentumSettled(t, 100 - 1e5 * t, 1e-5)
