# SPDX-License-Identifier: GPL-2.0-or-later
"""Outlines of bodies in the x-y plane: polygons with holes, rectangles, discs, and yade.pack predicates, with one interface.

Every outline has
    bounds()                (xmin, ymin, xmax, ymax) [m]
    classify(points, r)     for points (N, 2) two bool (N,): inside (the outline itself counts), and cut: the disc of radius r [m] about the
                            point may meet the outline
    seesOutside             False where classify() cannot tell for points outside which of them are cut
    overlap(cells)          area [m2] of each convex cell (M, k, 2) that lies inside the outline, shape (M,)
    area                    [m2], or None when it is not known exactly
"""
import math

import numpy as np

from ._arguments import array, number, whole

__all__ = ['OutlineError', 'Polygon', 'Rectangle', 'Predicate', 'disc', 'asOutline']


class OutlineError(ValueError):
	"""An outline that encloses nothing or cannot be understood; the message says why."""


def ringArea(ring):
	"""Signed area of a closed ring (n, 2), or of each of several (m, n, 2), positive when it runs counter-clockwise [m2]."""
	x, y = ring[..., 0], ring[..., 1]
	return 0.5 * np.sum(x * np.roll(y, -1, axis=-1) - np.roll(x, -1, axis=-1) * y, axis=-1)


def _cutOff(rings, a, b):
	"""The parts of `rings` (m, n, 2) to the left of the line through their a and b, both (m, 2): (which of them, rings) for each number of corners that comes out."""
	ax, ay, bx, by = (v[:, None] for v in (*a.T, *b.T))
	side = (bx - ax) * (rings[..., 1] - ay) - (by - ay) * (rings[..., 0] - ax)
	nextRing, nextSide = np.roll(rings, -1, axis=1), np.roll(side, -1, axis=1)
	keep = side >= 0
	crosses = keep != (nextSide >= 0)
	t = np.divide(side, side - nextSide, out=np.zeros_like(side), where=crosses)
	cut = rings + t[..., None] * (nextRing - rings)
	both, stays = np.stack((rings, cut), axis=2).reshape(len(rings), -1, 2), np.stack((keep, crosses), axis=2).reshape(len(rings), -1)
	count = stays.sum(axis=1)
	for n in np.unique(count[count > 0]):
		some = np.flatnonzero(count == n)
		yield some, both[some][stays[some]].reshape(len(some), n, 2)


def clippedAreas(ring, cells):
	"""Signed areas (M,) [m2] of the parts of `ring` (n, 2) inside the convex counter-clockwise `cells` (M, k, 2), by Sutherland & Hodgman (1974).

	A ring that is not convex may come out with edges run through twice; they enclose nothing, so the signed areas are exact. Cells whose part has as many
	corners are clipped together.
	"""
	areas, most = np.zeros(len(cells)), max(1, 200000 // len(ring))
	for first in range(0, len(cells), most):
		number = np.arange(first, min(first + most, len(cells)))
		groups = [(number, np.broadcast_to(ring, (len(number), *ring.shape)))]
		for e in range(cells.shape[1]):
			found = {}
			for at, rings in groups:
				for some, parts in _cutOff(rings, cells[at, e], cells[at, (e + 1) % cells.shape[1]]):
					found.setdefault(parts.shape[1], []).append((at[some], parts))
			groups = [tuple(map(np.concatenate, zip(*g))) for g in found.values()]
		for at, rings in groups:
			areas[at] = ringArea(rings)
	return areas


class Polygon:
	"""A simple polygon, convex or not, with holes. Its cells are clipped exactly."""
	seesOutside = True

	def __init__(self, points, holes=()):
		"""points (n, 2) and each hole (m, 2) in [m], in either sense of rotation, not closed. Raises OutlineError."""
		rings = []
		if not isinstance(holes, (list, tuple, np.ndarray)):
			raise OutlineError('holes must be a sequence of rings, each an array of at least 3 points (x, y) [m]; got %r' % (holes, ))
		for k, r in enumerate([points, *holes]):
			r = array('holes[%d]' % (k - 1) if k else 'points of a polygon', r, OutlineError, (None, 2))
			if len(r) < 3:
				raise OutlineError('each ring of points and holes must have at least 3 finite points (x, y); ring %d has %d' % (k, len(r)))
			r = r[np.any(r != np.roll(r, 1, axis=0), axis=1)]
			if abs(r).max(initial=0) > 1e8 * np.ptp(r, axis=0).max(initial=0):
				raise OutlineError('ring %d of the outline is too far out: its center must be within 1e8 of its sizes from (0, 0), or its points lose their digits' % k)
			a = float(ringArea(r)) if len(r) > 2 else 0.
			if abs(a) <= 1e-14 * np.ptp(r, axis=0).max()**2:
				raise OutlineError('ring %d of the polygon encloses no area' % k)
			rings.append(r if (a > 0) == (k == 0) else r[::-1])  # outline counter-clockwise, holes clockwise
		self.rings = rings
		self.area = float(sum(ringArea(r) for r in rings))
		if self.area <= 0:
			raise OutlineError('the holes of the polygon are larger than the polygon')

	def bounds(self):
		r = self.rings[0]
		return (*r.min(axis=0), *r.max(axis=0))

	def _edges(self):
		for r in self.rings:
			yield from zip(r, np.roll(r, -1, axis=0))

	def edgeDistance(self, points):
		"""Distance of each point (N, 2) from the nearest edge [m], shape (N,)."""
		points = array('points', points, OutlineError, (None, 2), empty=True)
		best = np.full(len(points), np.inf)
		for a, b in self._edges():
			e = b - a
			t = np.clip((points - a) @ e / (e @ e), 0, 1)
			best = np.minimum(best, np.hypot(*(points - a - t[:, None] * e).T))
		return best

	def classify(self, points, radius):
		points, radius = array('points', points, OutlineError, (None, 2), empty=True), number('radius', radius, OutlineError, low=0, unit=' m')
		x, y = points.T
		odd = np.zeros(len(points), bool)
		for (ax, ay), (bx, by) in self._edges():  # crossings of the ray towards +x
			if ay != by:
				odd ^= ((ay <= y) != (by <= y)) & (x < ax + (y - ay) * (bx - ax) / (by - ay))
		distance = self.edgeDistance(points)
		return odd | (distance <= 1e-10 * np.ptp(self.rings[0], axis=0).max()), distance < radius

	def overlap(self, cells):
		cells = array('cells', cells, OutlineError, (None, None, 2), empty=True)
		return sum(clippedAreas(r, cells) for r in self.rings)


class Rectangle(Polygon):
	"""A rectangle of `size` (width, height) [m] about `center` [m], turned by `angle` [rad] against the x axis."""

	def __init__(self, center, size, angle=0.):
		self.center, self.size = array('center', center, OutlineError, (2, )), array('size', size, OutlineError, (2, ))
		self.angle = number('angle', angle, OutlineError, low=-1e6, high=1e6, unit=' rad')
		if not (self.size > 0).all():
			raise OutlineError('size of a rectangle (width, height) must be above 0; got %s' % (size, ))
		c, s = math.cos(self.angle), math.sin(self.angle)
		corners = 0.5 * self.size * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
		super().__init__(self.center + corners @ np.array([(c, s), (-s, c)]))


def disc(center, radius, segments=180):
	"""A disc as a regular polygon of equal area with `segments` sides; center (x, y) and radius in [m]."""
	center, radius = array('center', center, OutlineError, (2, )), number('radius', radius, OutlineError, above=0, high=1e100, unit=' m')
	segments = whole('segments', segments, OutlineError, 3, 10**6)
	a = 2 * math.pi * (np.arange(segments) + 0.5) / segments
	r = radius * math.sqrt(2 * math.pi / segments / math.sin(2 * math.pi / segments))
	return Polygon(center + r * np.stack((np.cos(a), np.sin(a)), axis=1))


class Predicate:
	"""Anything that answers like a yade.pack predicate: called with (point, pad) and having aabb(); cut in the plane z.

	Cells are measured by sampling on a regular set of points, so areas are good to about 1 % of a cell.
	"""
	area = None
	seesOutside = False
	SIDE = 12  # samples along the side of a cell's bounding square

	def __init__(self, predicate, z=None):
		self.predicate = predicate
		try:
			lo, hi = predicate.aabb()
			lo, hi = [float(v) for v in lo], [float(v) for v in hi]
		except AttributeError:
			raise OutlineError('predicate must have a method aabb() as in yade.pack; %r has none' % (predicate, )) from None
		if not all(map(math.isfinite, lo[:2] + hi[:2])):
			raise OutlineError('the predicate is unbounded in the x-y plane: %s to %s; intersect it with a box' % (lo, hi))
		mid = 0.5 * (lo[2] + hi[2])
		self.z = number('z', z, OutlineError, unit=' m') if z is not None else mid if math.isfinite(mid) else 0.
		self._bounds = (lo[0], lo[1], hi[0], hi[1])

	def bounds(self):
		return self._bounds

	def inside(self, points, pad=0.):
		p, z = self.predicate, self.z
		points, pad = array('points', points, OutlineError, (None, 2), empty=True), number('pad', pad, OutlineError, unit=' m')
		return np.fromiter((p((x, y, z), pad) for x, y in points.tolist()), bool, len(points))

	def classify(self, points, radius):
		points, radius = array('points', points, OutlineError, (None, 2), empty=True), number('radius', radius, OutlineError, low=0, unit=' m')
		inside = self.inside(points)
		cut = inside.copy()
		cut[inside] = ~self.inside(points[inside], radius)
		return inside, cut

	def overlap(self, cells):
		cells = array('cells', cells, OutlineError, (None, None, 2), empty=True)
		return np.array([self._overlap(c) for c in cells]).reshape(len(cells))

	def _overlap(self, cell):
		lo, hi = cell.min(axis=0), cell.max(axis=0)
		u = (np.arange(self.SIDE) + 0.5) / self.SIDE
		p = lo + np.stack(np.meshgrid(u, u), axis=-1).reshape(-1, 2) * (hi - lo)
		a, b = cell, np.roll(cell, -1, axis=0)
		within = np.all((b - a)[:, 0] * (p[:, 1:] - a[:, 1]) - (b - a)[:, 1] * (p[:, :1] - a[:, 0]) >= 0, axis=1)
		return abs(ringArea(cell)) * self.inside(p[within]).mean()


def asOutline(shape):
	"""`shape` as an outline: an outline as it is, an array of points (n, 2) as Polygon, anything callable as Predicate."""
	if all(hasattr(shape, k) for k in ('classify', 'overlap', 'bounds')):
		return shape
	if callable(shape):
		return Predicate(shape)
	try:
		return Polygon(shape)
	except OutlineError as e:
		raise OutlineError('the shape of an outline must be a Polygon, a Rectangle, an array of points (n, 2) or a yade.pack predicate; got %r: %s' % (shape, e)) from None
