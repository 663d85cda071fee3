# SPDX-License-Identifier: GPL-2.0-or-later
"""Packings of automata, in plane strain and in space, and the YADE bodies made of them.

    >>> from yade_mca import packings
    >>> plate = packings.hexagonal(1e-3, packings.Rectangle((0, 0), (80e-3, 25e-3)), angle=0.5 * math.pi)
    >>> ids = packings.addBodies(plate, '4340', velocity=(0, 0))

A packing is numbers only (numpy arrays); addBodies() and resetStates() alone need YADE. All lengths in [m]; in plane strain areas, and masses per unit
thickness; in space volumes.
"""
import math
import reprlib
from dataclasses import dataclass, replace

import numpy as np

from ._arguments import array, number, oneOf
from ._bodies import addBodies, clump, resetStates
from ._fcc import Ball, Box, Cylinder, SpacePacking, make
from .outlines import Polygon, Predicate, Rectangle, asOutline, disc

__all__ = ['Packing', 'PackingError', 'CellGeometry', 'cellGeometry', 'hexagonal', 'create', 'addBodies', 'clump', 'resetStates', 'Polygon', 'Predicate', 'Rectangle', 'disc', 'fcc', 'SpacePacking', 'Box',
           'Cylinder', 'Ball']


class PackingError(ValueError):
	"""A packing that cannot be made or would be wrong; the message says why and what to do."""


@dataclass(frozen=True)
class CellGeometry:
	"""One automaton of a perfect packing of spacing d: what the pair forces are multiplied with."""
	name: str
	dim: int  #: 2: plane strain, per unit thickness; 3: space
	neighbours: int  #: N0
	volume: float  #: Omega0 [m2 or m3]
	contact: float  #: S0 [m or m2]


def cellGeometry(name, d):
	"""Omega0, S0, N0 and dimension of the packing `name` at spacing d [m]. In each, Omega0 = N0 S0 d / (2 dim). Raises PackingError."""
	d = number('spacing d', d, PackingError, above=0, unit=' m')
	r2, r3 = math.sqrt(2), math.sqrt(3)
	table = {
	        'hexagonal': (2, 6, r3 / 2 * d**2, d / r3),
	        'square': (2, 4, d**2, d),
	        'sc': (3, 6, d**3, d**2),
	        'fcc': (3, 12, d**3 / r2, d**2 / (2 * r2)),
	        'hcp': (3, 12, d**3 / r2, d**2 / (2 * r2)),
	}
	return CellGeometry(oneOf('name of a packing', name, table, PackingError), *table[name])


@dataclass(frozen=True)
class Packing:
	"""Automata of one body. Arrays have one entry per automaton, row by row."""
	positions: np.ndarray  #: (N, 2) [m]
	weight: np.ndarray  #: (N,) area that the automaton stands for / area of a full cell [-]
	spacing: float  #: d [m]
	angle: float  #: direction of the close-packed rows against x [rad]
	lattice: np.ndarray  #: (N, 2) int: place in the row, number of the row
	outlineArea: float = None  #: [m2], None when not known exactly
	rim: str = 'cells'  #: what the outermost automata stand for, see hexagonal()

	def __len__(self):
		return len(self.positions)

	@property
	def radius(self):
		return 0.5 * self.spacing

	@property
	def cell(self):
		return cellGeometry('hexagonal', self.spacing)

	@property
	def area(self):
		"""Area that all automata stand for [m2]."""
		return float(self.weight.sum()) * self.cell.volume

	def masses(self, density):
		"""Mass of each automaton per unit thickness [kg/m], shape (N,); density [kg/m3]. Raises PackingError."""
		return number('density', density, PackingError, above=0, unit=' kg/m3') * self.cell.volume * self.weight

	def translated(self, by):
		"""The packing moved by (dx, dy) [m]. Raises PackingError."""
		return replace(self, positions=self.positions + array('by', by, PackingError, (2, )))

	def select(self, which):
		"""The automata `which` (bool (N,), or indices from 0 to N - 1) as a packing of their own, each with the weight it has. Raises PackingError.

		Parts of a packing with rim='triangles' are for bodies that are linked again, by the same mask: engines refuse an automaton whose triangles are not
		all there. For a body that ends at the cut make a packing of its outline.
		"""
		which = self._chosen(which)
		return replace(self, positions=self.positions[which], weight=self.weight[which], lattice=self.lattice[which], outlineArea=None)

	def _chosen(self, which):
		n = len(self)
		try:
			a = np.asarray(which)
		except ValueError:
			a = np.asarray(None)
		if a.ndim == 1 and len(a) and (a.dtype == bool and len(a) == n and a.any() or a.dtype.kind in 'iu' and a.min() >= 0 and a.max() < n): return a
		raise PackingError('which must be %d truth values, one of them true, or indices from 0 to %d; got %s' % (n, n - 1, reprlib.repr(which)))

	def onLine(self, point, direction, tolerance=1e-6):
		"""Indices of the automata on a straight line through point (x, y) [m], sorted along it; tolerance as a share of the spacing. Raises PackingError."""
		t = array('direction', direction, PackingError, (2, ))
		if not 0 < np.hypot(*t) < math.inf:
			raise PackingError('direction must not be zero; got %r' % (direction, ))
		t = t / np.hypot(*t)
		r = self.positions - array('point', point, PackingError, (2, ))
		tolerance = number('tolerance', tolerance, PackingError, low=0)
		at = np.flatnonzero(abs(r[:, 0] * t[1] - r[:, 1] * t[0]) <= tolerance * self.spacing)
		return at[np.argsort(r[at] @ t)]

	def pairs(self):
		"""Neighbours of the perfect lattice, each pair once: int (M, 2) with first < second."""
		table = _Table(self.lattice)
		found = []
		for k in range(3):  # half of the six directions reaches each pair once
			j = table.neighbour(self.lattice, k)
			i = np.flatnonzero(j >= 0)
			found.append(np.sort(np.stack((i, j[i]), axis=1), axis=1))
		p = np.concatenate(found)
		return p[np.lexsort((p[:, 1], p[:, 0]))]

	def hexagons(self, scale=1.):
		"""Corners of the cells, (N, 6, 2) [m], for pictures and areas; scale: of the cells about their centres. Raises PackingError."""
		return self.positions[:, None, :] + number('scale', scale, PackingError, above=0) * _hexagon(self.spacing, self.angle)


class _Table:
	"""Which automaton sits at a lattice place. Odd rows are shifted by +d/2."""
	EVEN = ((1, 0), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1))
	ODD = ((1, 0), (1, 1), (0, 1), (-1, 0), (0, -1), (1, -1))

	def __init__(self, lattice):
		self.low = lattice.min(axis=0) - 2
		shape = lattice.max(axis=0) + 3 - self.low
		self.number = np.full(shape, -1)
		self.number[tuple((lattice - self.low).T)] = np.arange(len(lattice))

	def neighbour(self, lattice, k):
		"""Number of the k-th neighbour (0 ... 5, counter-clockwise from +x) of each place, -1 where there is none."""
		step = np.where((lattice[:, 1] % 2)[:, None] == 1, self.ODD[k], self.EVEN[k])
		return self.number[tuple((lattice + step - self.low).T)]


def _rotation(angle):
	"""Rows are the lattice's axes in x, y. Multiples of 30 degrees come out symmetric to the last bit."""
	c, s = math.cos(angle), math.sin(angle)
	c, s = (0. if abs(v) < 1e-15 else v for v in (c, s))
	return np.array([(c, s), (-s, c)])


def _hexagon(d, angle):
	a = np.pi / 6 + np.pi / 3 * np.arange(6)
	return d / math.sqrt(3) * np.stack((np.cos(a), np.sin(a)), axis=1) @ _rotation(angle)


def _fittedOrigin(outline, d, angle, triangles):
	"""A lattice point such that whole cells, or triangles, fill the outline as evenly as can be: see hexagonal()."""
	lo, hi = np.array(outline.bounds()[:2]), np.array(outline.bounds()[2:])
	center, axes = 0.5 * (lo + hi), _rotation(angle)
	if not isinstance(outline, Rectangle):
		return center
	turn = (angle - outline.angle) / (math.pi / 6)
	if abs(turn - round(turn)) > 1e-9:
		return center
	along = outline.size if round(turn) % 2 == 0 and round(turn) % 6 == 0 else outline.size[::-1] if round(turn) % 6 == 3 else None
	if along is None:  # rows at 30 or 60 degrees to all sides
		return center
	pitch = 0.5 * math.sqrt(3) * d
	count = np.maximum(np.round(along / (d, pitch)), 1)
	if triangles:  # rows lie on the outline, and the ends of the rows by turns a quarter of d inside and outside
		return center - (0.5 * count[0] - 0.25) * d * axes[0] - 0.5 * count[1] * pitch * axes[1]
	return center - (0.5 * (count[0] - 1) * d + (0.25 * d if count[1] > 1 else 0.)) * axes[0] - 0.5 * (count[1] - 1) * pitch * axes[1]


def _candidates(outline, d, angle, origin):
	"""Lattice places and positions that cover the outline with one cell to spare."""
	x0, y0, x1, y1 = outline.bounds()
	corners = (np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]) - origin) @ _rotation(angle).T
	pitch = 0.5 * math.sqrt(3) * d
	if abs(corners).max() > 1e9 * d:
		raise PackingError('origin and outline must be within 1e9 spacings of each other; they are %g spacings of %g m apart' % (abs(corners).max() / d, d))
	low = np.floor(corners.min(axis=0) / (d, pitch)).astype(int) - 2
	high = np.ceil(corners.max(axis=0) / (d, pitch)).astype(int) + 2
	if np.prod((high - low + 1.).astype(float)) > 3e8:
		raise PackingError('spacing %g m gives more than 3e8 lattice places in the outline (%g x %g m); is the unit right?' % (d, x1 - x0, y1 - y0))
	j, i = np.meshgrid(np.arange(low[1], high[1] + 1), np.arange(low[0], high[0] + 1), indexing='ij')
	lattice = np.stack((i.ravel(), j.ravel()), axis=1)
	flat = np.stack(((lattice[:, 0] + 0.5 * (lattice[:, 1] % 2)) * d, lattice[:, 1] * pitch), axis=1)
	return lattice, origin + flat @ _rotation(angle)


def hexagonal(spacing, outline, angle=0., origin=None, rim='cells', minWeight=0.2):
	"""Hexagonal packing of `spacing` [m] in `outline`; the close-packed rows run at `angle` [rad] against x.

	outline    Polygon, Rectangle, disc(), an array of points (n, 2), or a yade.pack predicate
	origin     where a lattice point lies (x, y) [m]. Default: the middle of the outline; in a Rectangle whose sides run along or
	           across the rows, the whole numbers of rows and of automata per row that come nearest to its size, centred, so that the outermost
	           weights stay between 0.5 and 1.5 and the pattern is the same on both sides
	rim        'cells': automata whose centre is inside. The weight is the part of the cell inside the outline; cells whose centre is outside
	                    and cells with less than `minWeight` (a light automaton would shorten the time step) are given, in equal shares, to
	                    their neighbours that stay. So weights at a surface lie between minWeight and about 1.6 and the mass is exactly that of
	                    the outline (polygons; with predicates as exact as the sampling). Automata on the outline get 1/2: tied rows.
	           'full':  the same automata, all of weight 1: the body is the union of its cells, stiffness and mass match everywhere, and
	                    its area differs from the outline's by at most the rim
	           'triangles': the body is the triangles of the lattice whose middle is inside, and what lies between them, so that its outline runs
	                    through the centres of its outermost automata. The weight is a sixth for each triangle; the engines see it by that, check it (state.triangles) and give
	                    the surface its stiffness of second order (formulation, (5g)). minWeight is not used. Its area differs from the outline's by at most the rim
	Raises PackingError, or OutlineError, for an argument that is out of range and when no automaton fits.
	"""
	d = number('spacing', spacing, PackingError, above=0, unit=' m')
	angle = number('angle', angle, PackingError, low=-1e6, high=1e6, unit=' rad')
	outline = asOutline(outline)
	x0, y0, x1, y1 = outline.bounds()
	oneOf('rim', rim, ('cells', 'full', 'triangles'), PackingError)
	minWeight = number('minWeight', minWeight, PackingError, low=0, below=0.5)  # tied rows have 1/2
	origin = _fittedOrigin(outline, d, angle, rim == 'triangles') if origin is None else array('origin', origin, PackingError, (2, ))
	lattice, positions = _candidates(outline, d, angle, origin)
	if rim == 'triangles':
		weight = _trianglesInside(outline, lattice, positions) / 6.
		if not weight.any():
			raise PackingError('no triangle of spacing %g m fits the outline (%g x %g m): take a smaller spacing' % (d, x1 - x0, y1 - y0))
		return _packing(positions, weight, d, angle, lattice, weight > 0, outline, rim)
	inside, cut = outline.classify(positions, d / math.sqrt(3))
	cellArea = cellGeometry('hexagonal', d).volume
	if rim == 'full':
		weight = np.ones(len(lattice))
		keep = inside
	else:
		table = _Table(lattice)
		if not outline.seesOutside:  # cells outside that may be cut are the neighbours of those inside
			for k in range(6):
				n = table.neighbour(lattice[inside], k)
				cut[n[n >= 0]] |= ~inside[n[n >= 0]]
		at = np.flatnonzero(cut)
		weight = (inside & ~cut).astype(float)
		weight[at] = np.clip(outline.overlap(positions[at][:, None] + _hexagon(d, angle)) / cellArea, 0, 1)
		weight[weight < 1e-12] = 0
		keep = inside & (weight >= minWeight)
		if keep.any():
			_giveAway(table, lattice, positions, weight, keep)
	if not keep.any():
		raise PackingError('no automaton of spacing %g m fits the outline (%g x %g m): take a smaller spacing' % (d, x1 - x0, y1 - y0))
	return _packing(positions, weight, d, angle, lattice, keep, outline, rim)


def _packing(positions, weight, d, angle, lattice, keep, outline, rim):
	return Packing(positions[keep], weight[keep], d, float(angle), lattice[keep], outline.area, rim)


def _trianglesInside(outline, lattice, positions):
	"""For each lattice place how many of the six triangles around it are in the body: with their middle inside, or with all corners at such triangles."""
	table = _Table(lattice)
	around = np.stack([table.neighbour(lattice, k) for k in range(3)])
	triangles = []
	for a, b in ((around[0], around[1]), (around[1], around[2])):  # above and below: each triangle once
		whole = np.flatnonzero((a >= 0) & (b >= 0))
		triangles.append(np.stack((whole, a[whole], b[whole])))
	corners = np.concatenate(triangles, axis=1)
	inside = outline.classify(positions[corners].mean(axis=0), 0.)[0]
	stays = np.zeros(len(lattice), bool)
	stays[corners[:, inside]] = True
	# three automata that are there make a triangle, as the engines see it
	return np.bincount(corners[:, stays[corners].all(axis=0)].ravel(), minlength=len(lattice)).astype(float)


def _giveAway(table, lattice, positions, weight, keep):
	"""Adds the weight of cells that are not kept to their kept neighbours in equal shares, or to the nearest kept automaton."""
	lost = np.flatnonzero(~keep & (weight > 0))
	if len(lost) == 0:
		return
	around = np.stack([table.neighbour(lattice[lost], k) for k in range(6)], axis=1)
	takes = (around >= 0) & keep[around]
	count = takes.sum(axis=1)
	share = np.where(takes, (weight[lost] / np.maximum(count, 1))[:, None], 0)
	gain = np.zeros(len(weight))
	np.add.at(gain, around[takes], share[takes])
	kept = np.flatnonzero(keep)
	for i in lost[count == 0]:
		gain[kept[np.argmin(np.sum((positions[kept] - positions[i])**2, axis=1))]] += weight[i]
	weight += gain
	weight[lost] = 0


def fcc(spacing, shape, orientation=None, origin=None, mirror='', rim='full'):
	"""Face-centred cubic packing of `spacing` [m]: a SpacePacking of the automata whose centres are in `shape`.

	shape        Box, Cylinder, Ball, or a predicate of yade.pack
	orientation  how the packing stands: None, the edges of the cubic cell along x, y, z; ((h, k, l), (h, k, l)), the directions of the packing that
	             point along x and y, at right angles to each other; or a rotation (3, 3) whose rows are the axes of the cubic cell in x, y, z
	origin       where an automaton stands, or would stand (x, y, z) [m]; default: the middle of the shape, with rim='faces' the lower corner of a Box, the
	             start of a Cylinder
	mirror       planes of symmetry through the origin: 'x' makes only the half above x = origin x, 'xz' the quarter. Automata on the plane stand for half of
	             their cell, and the engine lets the body go on beyond it as its image: a half or quarter gives what the whole would (formulation, (S9)). An
	             edge of the cubic cell must point along the normal
	rim          'full': whole automata, of weight 1. 'faces': those whose centre is on a face of a Box, or on an end of a Cylinder, stand for the part of
	             their cell inside, so that the body ends there at once and a bar has its modulus (S8); give the shape sizes that put them there
	The solver finds the packing whatever its orientation.
	Raises PackingError for an argument that is out of range and when no automaton fits.
	"""
	return make(spacing, shape, orientation, origin, mirror, rim, PackingError)


_REFUSED = {
        ('square', 'cube', 'cubic', 'sc'):
                'a square (cube, sc) arrangement has zero-energy modes: its discs turn like gear wheels without straining any pair, and the '
                'pair law has no bending stiffness to resist',
        ('fcc', 'hcp'):
                'fcc and hcp are arrangements of spheres in space (fcc() makes the former); plane strain needs discs in one layer, each with 6 neighbours',
}


def create(name, spacing, outline, **options):
	"""The packing `name` by hexagonal(); in plane strain all others are refused with the reason (PackingError)."""
	for refused, reason in _REFUSED.items():
		if isinstance(name, str) and name in refused:
			raise PackingError("packing '%s' is refused in plane strain: %s. Use 'hexagonal'." % (name, reason))
	if name != 'hexagonal':
		raise PackingError('unknown packing name %r: in plane strain it must be \'hexagonal\'' % (name, ))
	return hexagonal(spacing, outline, **options)
