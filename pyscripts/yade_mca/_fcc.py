# SPDX-License-Identifier: GPL-2.0-or-later
"""Face-centred cubic packings of automata in space; used through packings.fcc()."""
import math
from dataclasses import dataclass, replace

import numpy as np

from ._arguments import array, number


def _error():
	from .packings import PackingError
	return PackingError


def _point(name, value):
	return array(name, value, _error(), (3, ))


def _points(value):
	return array('points', value, _error(), (None, 3))


@dataclass(frozen=True)
class SpacePacking:
	"""Automata of one body in space. Arrays have one entry per automaton."""
	positions: np.ndarray  #: (N, 3) [m]
	weight: np.ndarray  #: (N,) volume that the automaton stands for / volume of a full cell [-]
	spacing: float  #: d [m]
	orientation: np.ndarray  #: (3, 3) rows: the axes of the cubic cell in x, y, z
	lattice: np.ndarray  #: (N, 3) int: place in half edges of the cubic cell, with an even sum

	def __len__(self):
		return len(self.positions)

	@property
	def radius(self):
		return 0.5 * self.spacing

	@property
	def cellVolume(self):
		"""Volume of a full cell [m3]."""
		return self.spacing**3 / math.sqrt(2)

	@property
	def volume(self):
		"""Volume that all automata stand for [m3]."""
		return float(self.weight.sum()) * self.cellVolume

	def translated(self, by):
		"""The packing moved by (dx, dy, dz) [m]. Raises PackingError."""
		return replace(self, positions=self.positions + _point('by', by))

	def masses(self, density):
		"""Mass of each automaton [kg], shape (N,); density [kg/m3]. Raises PackingError."""
		return number('density', density, _error(), above=0, unit=' kg/m3') * self.cellVolume * self.weight

	def inertias(self, density):
		"""Moment of inertia of each automaton [kg m2], shape (N,), that of the sphere of a full cell; density [kg/m3]. Raises PackingError."""
		return 0.4 * self.masses(density) * (3 * self.cellVolume / (4 * math.pi))**(2 / 3)

	def pairs(self):
		"""Neighbours of the perfect lattice, each pair once: int (M, 2) with first < second."""
		place = {tuple(p): i for i, p in enumerate(self.lattice.tolist())}
		steps = ((1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1))
		found = [(i, place.get((x + a, y + b, z + c))) for i, (x, y, z) in enumerate(self.lattice.tolist()) for a, b, c in steps]
		p = np.array([sorted(q) for q in found if q[1] is not None], dtype=int).reshape(-1, 2)
		return p[np.lexsort((p[:, 1], p[:, 0]))]


def axesOf(orientation, error):
	"""Rows: the axes of the cubic cell in x, y, z. orientation: None, a rotation (3, 3) with these rows, or two directions of the packing along x and y."""
	if orientation is None: return np.eye(3)
	a = array('orientation', orientation, error, ((3, 3), (2, 3)))
	if a.shape == (3, 3):
		if abs(a @ a.T - np.eye(3)).max() > 1e-9 or np.linalg.det(a) < 0: raise error('orientation must be a rotation: three orthonormal rows, right-handed; got %s' % a.tolist())
		return a
	lengths = np.linalg.norm(a, axis=1)
	if not lengths.all() or abs(a[0] @ a[1]) > 1e-9 * lengths.prod():
		raise error('orientation: the directions along x and y, (h, k, l) each, must be at right angles and not zero; got %s' % a.tolist())
	x, y = a / lengths[:, None]
	return np.stack((x, y, np.cross(x, y))).T  # their rows are x, y, z in the cube; rows of the result: the axes of the cube


def boundsOf(shape, error):
	"""Corners (2, 3) of the box that holds a predicate of yade.pack."""
	try:
		corners = np.array([[float(c) for c in corner] for corner in shape.aabb()])
	except (TypeError, ValueError):
		corners = np.empty(0)
	if corners.shape != (2, 3) or not np.isfinite(corners).all() or not (corners[1] > corners[0]).all():
		raise error('the predicate must be bounded: its aabb() is %s' % corners.tolist())
	return corners


@dataclass(frozen=True)
class Box:
	"""A box from corner `low` to corner `high`, (x, y, z) [m] each; its faces belong to it. Raises PackingError."""
	low: tuple
	high: tuple

	def __post_init__(self):
		low, high = _point('low', self.low), _point('high', self.high)
		if not (high > low).all(): raise _error()('high must be above low in x, y and z; got %s and %s' % (low.tolist(), high.tolist()))

	def aabb(self):
		return self.low, self.high

	def inside(self, points):
		"""bool (N,) of points (N, 3): within. Raises PackingError."""
		low, high = _point('low', self.low), _point('high', self.high)
		points, tiny = _points(points), 1e-9 * (high - low).max()
		return np.all((points > low - tiny) & (points < high + tiny), axis=1)


@dataclass(frozen=True)
class Cylinder:
	"""A cylinder from the centre of one end to that of the other, (x, y, z) [m] each, and its radius [m]. Raises PackingError."""
	start: tuple
	end: tuple
	radius: float

	def __post_init__(self):
		number('radius', self.radius, _error(), above=0, unit=' m')
		if not np.linalg.norm(_point('end', self.end) - _point('start', self.start)) > 0: raise _error()('start and end of a cylinder must be apart')

	def aabb(self):
		a, b = _point('start', self.start), _point('end', self.end)
		t = (b - a) / np.linalg.norm(b - a)
		reach = self.radius * np.sqrt(np.maximum(1 - t**2, 0))
		return np.minimum(a, b) - reach, np.maximum(a, b) + reach

	def inside(self, points):
		"""bool (N,) of points (N, 3): within. Raises PackingError."""
		points, a, b = _points(points), _point('start', self.start), _point('end', self.end)
		length = np.linalg.norm(b - a)
		along = (points - a) @ ((b - a) / length)
		across2 = ((points - a)**2).sum(axis=1) - along**2
		tiny = 1e-9 * max(length, self.radius)
		return (along > -tiny) & (along < length + tiny) & (across2 < (self.radius + tiny)**2)


@dataclass(frozen=True)
class Ball:
	"""A sphere: centre (x, y, z) and radius [m]. Raises PackingError."""
	centre: tuple
	radius: float

	def __post_init__(self):
		_point('centre', self.centre), number('radius', self.radius, _error(), above=0, unit=' m')

	def aabb(self):
		c = _point('centre', self.centre)
		return c - self.radius, c + self.radius

	def inside(self, points):
		"""bool (N,) of points (N, 3): within. Raises PackingError."""
		return ((_points(points) - _point('centre', self.centre))**2).sum(axis=1) < (self.radius * (1 + 1e-9))**2


def isInside(shape, points):
	if hasattr(shape, 'inside'): return np.asarray(shape.inside(points), bool)
	return np.array([bool(shape(tuple(p), 0.)) for p in points.tolist()], bool)


def make(spacing, shape, orientation, origin, error):
	d = number('spacing', spacing, error, above=0, unit=' m')
	if not (hasattr(shape, 'aabb') and (hasattr(shape, 'inside') or callable(shape))):
		raise error('shape must be packings.Box, Cylinder, Ball or a predicate of yade.pack; got %r' % (shape, ))
	axes, corners = axesOf(orientation, error), boundsOf(shape, error)
	at = corners.mean(axis=0) if origin is None else array('origin', origin, error, (3, ))
	edge = d / math.sqrt(2)  # half of the cubic cell's
	all8 = np.array([(x, y, z) for x in corners[:, 0] for y in corners[:, 1] for z in corners[:, 2]])
	local = (all8 - at) @ axes.T / edge
	low, high = np.floor(local.min(axis=0)).astype(int) - 1, np.ceil(local.max(axis=0)).astype(int) + 1
	if abs(local).max() > 1e8 or np.prod((high - low + 1.)) > 3e8:
		raise error('spacing %g m gives more than 3e8 places in the box from %s to %s m; is the unit right?' % (d, *corners.tolist()))
	places = np.stack(np.meshgrid(*(np.arange(a, b + 1) for a, b in zip(low, high)), indexing='ij'), axis=-1).reshape(-1, 3)
	places = places[places.sum(axis=1) % 2 == 0]
	positions = at + edge * places @ axes
	keep = isInside(shape, positions)
	if not keep.any(): raise error('no automaton of spacing %g m fits the shape from %s to %s m: take a smaller spacing' % (d, *corners.tolist()))
	return SpacePacking(positions[keep], np.ones(int(keep.sum())), d, axes, places[keep])
