# SPDX-License-Identifier: GPL-2.0-or-later
"""Face-centred cubic packings of automata in space; used through packings.fcc()."""
import math
from dataclasses import dataclass, replace

import numpy as np

from ._arguments import array, number, oneOf


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
	mirrors: np.ndarray  #: (N,) int: planes of symmetry on which the automaton lies, 1, 2, 4 for one with its normal along x, y, z, summed

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

	def _faces(self, points, tolerance):
		"""Number of its faces within `tolerance` [m] of which each of the points (N, 3) lies, int (N,)."""
		return sum((abs(_points(points) - _point(name, corner)) < tolerance).sum(axis=1) for name, corner in (('low', self.low), ('high', self.high)))

	def _hasFace(self, axis, at, tolerance):
		"""Whether a face lies in the plane across this axis (0, 1, 2) at this coordinate [m]."""
		return bool(min(abs(self.low[axis] - at), abs(self.high[axis] - at)) < tolerance)

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

	def _faces(self, points, tolerance):
		"""Number of its ends within `tolerance` [m] of which each of the points (N, 3) lies, int (N,)."""
		a, b = _point('start', self.start), _point('end', self.end)
		along, length = (_points(points) - a) @ (b - a) / np.linalg.norm(b - a), np.linalg.norm(b - a)
		return (abs(along) < tolerance).astype(int) + (abs(along - length) < tolerance)

	def _hasFace(self, axis, at, tolerance):
		"""Whether an end lies in the plane across this axis (0, 1, 2) at this coordinate [m]."""
		a, b = _point('start', self.start), _point('end', self.end)
		upright = abs(b - a)[axis] > (1 - 1e-9) * np.linalg.norm(b - a)
		return bool(upright and min(abs(a[axis] - at), abs(b[axis] - at)) < tolerance)

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


def _places(d, corners, at, axes, error):
	"""Places of the packing, and their positions, that cover the box."""
	edge = d / math.sqrt(2)  # half of the cubic cell's
	all8 = np.array([(x, y, z) for x in corners[:, 0] for y in corners[:, 1] for z in corners[:, 2]])
	local = (all8 - at) @ axes.T / edge
	low, high = np.floor(local.min(axis=0)).astype(int) - 1, np.ceil(local.max(axis=0)).astype(int) + 1
	if abs(local).max() > 1e8 or np.prod((high - low + 1.)) > 3e8:
		raise error('spacing %g m gives more than 3e8 places in the box from %s to %s m; is the unit right?' % (d, *corners.tolist()))
	places = np.stack(np.meshgrid(*(np.arange(a, b + 1) for a, b in zip(low, high)), indexing='ij'), axis=-1).reshape(-1, 3)
	places = places[places.sum(axis=1) % 2 == 0]
	return places, at + edge * places @ axes


def _checkMirror(mirror, axes, error):
	"""Numbers of the axes. The packing must be its own image there."""
	if not isinstance(mirror, str) or len(set(mirror)) != len(mirror) or not set(mirror) <= set('xyz'):
		raise error("mirror must name axes, as 'x' or 'xz', or be ''; got %r" % (mirror, ))
	found = ['xyz'.index(c) for c in mirror]
	for c in found:
		if not np.allclose(np.sort(abs(axes[:, c])), (0, 0, 1), atol=1e-9):  # normal of the plane in the cubic cell
			raise error("mirror: an edge of the cubic cell must point along %s, else automata on both sides of the plane are linked; turn the packing" % 'xyz'[c])
	return found


def make(spacing, shape, orientation, origin, mirror, rim, error):
	d = number('spacing', spacing, error, above=0, unit=' m')
	if not (hasattr(shape, 'aabb') and (hasattr(shape, 'inside') or callable(shape))):
		raise error('shape must be packings.Box, Cylinder, Ball or a predicate of yade.pack; got %r' % (shape, ))
	axes, corners = axesOf(orientation, error), boundsOf(shape, error)
	planes = _checkMirror(mirror, axes, error)
	if oneOf('rim', rim, ('full', 'faces'), error) == 'faces' and not isinstance(shape, (Box, Cylinder)):
		raise error("rim='faces' needs a Box or a Cylinder, whose faces are known; got %r" % (shape, ))
	if origin is not None: at = array('origin', origin, error, (3, ))
	elif rim == 'full': at = corners.mean(axis=0)
	else: at = _point('low', shape.low) if isinstance(shape, Box) else _point('start', shape.start)
	places, positions = _places(d, corners, at, axes, error)
	keep = isInside(shape, positions)
	for c in planes: keep &= positions[:, c] > at[c] - 1e-6 * d
	if not keep.any(): raise error('no automaton of spacing %g m fits the shape from %s to %s m: take a smaller spacing' % (d, *corners.tolist()))
	positions, places = positions[keep], places[keep]
	weight, mirrors = np.ones(len(positions)), np.zeros(len(positions), int)
	for c in planes:
		on = abs(positions[:, c] - at[c]) < 1e-6 * d
		weight[on] *= 0.5
		mirrors[on] |= 1 << c
	if rim == 'faces':
		twice = sum(mirrors >> c & 1 for c in planes if shape._hasFace(c, at[c], 1e-6 * d))  # the plane of symmetry is a face
		weight *= 0.5**(shape._faces(positions, 1e-6 * d) - twice)
	return SpacePacking(positions, weight, d, axes, places, mirrors)
