# SPDX-License-Identifier: GPL-2.0-or-later
"""Face-centred cubic packings: neighbours, mass, orientation, shapes, refusals."""
import math

import numpy as np
import pytest

from yade_mca import packings
from yade_mca.packings import Ball, Box, Cylinder, PackingError

D = 1e-3
ORIENTATIONS = (None, ((1, 1, 0), (0, 0, 1)), ((1, 1, 1), (1, -1, 0)), ((1, 2, 3), (2, -1, 0)))


def distances(p, k=13):
	from scipy.spatial import cKDTree
	return cKDTree(p.positions).query(p.positions, k=k)[0]


@pytest.mark.parametrize('orientation', ORIENTATIONS)
def test_insideHasTwelveNeighboursAtTheSpacing(orientation):
	p = packings.fcc(D, Ball((1e-3, 2e-3, -3e-3), 5 * D), orientation=orientation)
	r = distances(p, 14)
	whole = np.linalg.norm(p.positions - (1e-3, 2e-3, -3e-3), axis=1) < 3.9 * D
	assert whole.sum() > 100
	assert abs(r[whole, 1:13] / D - 1).max() < 1e-12 and r[whole, 13].min() > 1.41 * D
	assert len(p.pairs()) == (abs(r[:, 1:13] - D) < 1e-9).sum() // 2
	assert abs(p.volume / (4 / 3 * math.pi * (5 * D)**3) - 1) < 0.05


@pytest.mark.parametrize('orientation', ORIENTATIONS[1:])
def test_directionsOfThePackingPointAlongTheAxes(orientation):
	p = packings.fcc(D, Box((0, 0, 0), (8 * D, 8 * D, 8 * D)), orientation=orientation)
	for axis, hkl in enumerate(orientation):
		assert abs(np.array(hkl) / np.linalg.norm(hkl) @ p.orientation - np.eye(3)[axis]).max() < 1e-12
	edges = (p.positions - p.positions[0]) @ np.linalg.inv(p.orientation) / (D / math.sqrt(2))
	assert abs(edges - np.round(edges)).max() < 1e-9 and (np.round(edges).sum(axis=1) % 2 == 0).all()


def test_aBoxOfWholeCellsHasTheFacesOfTheCube():
	a = math.sqrt(2) * D
	p = packings.fcc(D, Box((0, 0, 0), (3 * a, 2 * a, 2 * a)), origin=(0, 0, 0))
	n = (7, 5, 5)  # planes of each direction
	assert len(p) == (np.prod(n) + 1) // 2
	assert np.allclose(p.positions.min(axis=0), 0, atol=1e-15) and np.allclose(p.positions.max(axis=0), (3 * a, 2 * a, 2 * a))


def test_aCylinderIsRound():
	p = packings.fcc(D, Cylinder((0, 0, 0), (0, 0, 20 * D), 5 * D), orientation=((1, 1, 1), (1, -1, 0)))
	assert np.hypot(*p.positions.T[:2]).max() <= 5 * D * (1 + 1e-8) and -1e-9 < p.positions[:, 2].min() and p.positions[:, 2].max() < 20 * D + 1e-9
	assert abs(p.volume / (math.pi * 25 * 20 * D**3) - 1) < 0.05


def test_massAndInertiaAreThoseOfItsCells():
	p = packings.fcc(D, Ball((0, 0, 0), 3 * D))
	assert np.allclose(p.masses(7800.), 7800. * D**3 / math.sqrt(2))
	assert np.allclose(p.inertias(7800.) / p.masses(7800.) / D**2, 0.12217741154217143)
	assert packings.cellGeometry('fcc', D).volume == pytest.approx(p.cellVolume)


def test_predicatesOfYadeAreShapes():
	pack = pytest.importorskip('yade.pack')
	ball = packings.fcc(D, pack.inSphere((0, 0, 0), 3 * D))
	assert len(ball) == len(packings.fcc(D, Ball((0, 0, 0), 3 * D)))
	rest = packings.fcc(D, pack.inAlignedBox((-3 * D, ) * 3, (3 * D, ) * 3) - pack.inSphere((0, 0, 0), 2 * D))
	assert np.linalg.norm(rest.positions, axis=1).min() > 1.99 * D


@pytest.mark.parametrize('arguments, says', [
        (dict(spacing=0.), 'spacing'), (dict(shape='box'), 'shape'), (dict(orientation=((1, 0, 0), (1, 1, 0))), 'right angles'),
        (dict(orientation=((0, 0, 0), (1, 1, 0))), 'not zero'), (dict(orientation=np.diag((1, 1, -1.))), 'right-handed'),
        (dict(orientation=2 * np.eye(3)), 'orthonormal'), (dict(origin=(0, 0)), 'origin'), (dict(spacing=1e-9), 'unit'),
        (dict(shape=Ball((0.4 * D, 0, 0), 0.1 * D), origin=(0, 0, 0)), 'smaller spacing')
])
def test_refuses(arguments, says):
	with pytest.raises(PackingError, match=says):
		packings.fcc(**{**dict(spacing=D, shape=Ball((0, 0, 0), 3 * D)), **arguments})


def test_shapesRefuseWhatTheyCannotBe():
	for wrong in (lambda: Box((0, 0, 0), (1, 1, 0)), lambda: Cylinder((0, 0, 0), (0, 0, 0), 1.), lambda: Ball((0, 0, 0), -1.), lambda: Ball((0, 0), 1.)):
		with pytest.raises(PackingError):
			wrong()
