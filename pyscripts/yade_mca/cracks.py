# SPDX-License-Identifier: GPL-2.0-or-later
"""Pre-cracks, notches and weak planes in automata, and the links that have broken: where, when, why.

    >>> cracks.cut(engine, ((0, -1e-3), (0, 1e-3)))            # a straight crack in the plane: links that cross the segment
    12
    >>> cracks.cut(engine, square)                              # in space: links that cross a flat convex polygon, (k, 3)
    >>> cracks.cut(engine, lambda a, b: (a[:, 1] > 0) != (b[:, 1] > 0))   # links with one end above y = 0
    >>> h = cracks.history(engine); h['time'], h['cause']       # once it has run
"""
import csv

import numpy as np

from ._arguments import array
from .tasks.report import writeAtomically

__all__ = ['CAUSES', 'CrackError', 'crossing', 'cut', 'history', 'writeCsv', 'writeVtk', 'rose']

#: why a link broke, by the number in McaEngine.brokenLinks()['cause']; 'collapsed': it was sheared to less than 0.4 of its length
CAUSES = ('fractureStrain', 'spallStrength', 'fractureStress', 'damage', 'pairStrength', 'collapsed', 'cut')


class CrackError(ValueError):
	"""What the functions here cannot take; the message says what is allowed."""


def crossing(where, a, b):
	"""Whether links from a to b, (N, 2) or (N, 3) [m], cross `where`; bool (N,).

	where: a segment (2, 2) in the plane; a flat convex polygon (k, 3), k >= 3, in space; or f(a, b) that returns truth values (N,).
	Raises CrackError for anything else.
	"""
	a, b = array('a', a, CrackError, ((None, 2), (None, 3))), array('b', b, CrackError, ((None, 2), (None, 3)))
	if a.shape != b.shape: raise CrackError('a and b must have the same shape; got %s and %s' % (a.shape, b.shape))
	if callable(where):
		found = np.asarray(where(a, b))
		if found.shape != (len(a), ) or found.dtype != bool:
			raise CrackError('where(a, b) must return %d truth values (numpy bool); it gave %s of shape %s' % (len(a), found.dtype, found.shape))
		return found
	if a.shape[1] == 2:
		p, q = array('where, in the plane,', where, CrackError, (2, 2))
		if (p == q).all(): raise CrackError('where: both ends of the segment are (%g, %g)' % tuple(p))
		return _sides(p, q, a, b) & _sides(a, b, p, q)
	corners = array('where, in space,', where, CrackError, (None, 3))
	return _crossesPolygon(corners, a, b)


def _cross2(u, v):
	return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def _sides(p, q, a, b):
	"""Whether a and b lie on different sides of the line p q, elementwise; a point on it counts as left."""
	return (_cross2(q - p, a - p) >= 0) != (_cross2(q - p, b - p) >= 0)


def _crossesPolygon(corners, a, b):
	if len(corners) < 3: raise CrackError('where: a polygon needs three corners or more; got %d' % len(corners))
	normal = sum(np.cross(corners[k] - corners[0], corners[k + 1] - corners[0]) for k in range(1, len(corners) - 1))
	size = np.linalg.norm(normal)
	if not size > 0: raise CrackError('where: the corners of the polygon lie on a line')
	normal = normal / size
	if abs((corners - corners[0]) @ normal).max() > 1e-6 * np.sqrt(size): raise CrackError('where: the corners of the polygon do not lie in a plane')
	ha, hb = (a - corners[0]) @ normal, (b - corners[0]) @ normal
	across = (ha >= 0) != (hb >= 0)
	foot = a + (b - a) * np.where(across, ha / np.where(across, ha - hb, 1.), 0.)[:, None]
	for p, q in zip(corners, np.roll(corners, -1, axis=0)):
		across &= np.cross(q - p, foot - p) @ normal >= 0
	return across


def _places(engine, pairs):
	"""Positions of the ends of pairs of ids, (N, 2, dimension) [m]."""
	n = 3 if engine.dimension == 3 else 2
	if hasattr(engine, 'fields'):
		f = engine.fields(('ids', 'x', 'y', 'z')[:n + 1])
		return np.stack([f[c] for c in 'xyz'[:n]], axis=1)[np.searchsorted(f['ids'], pairs)]
	from ._yade import scene
	bodies = scene().bodies
	ids, place = np.unique(pairs, return_inverse=True)
	return np.array([bodies[i].state.pos for i in ids.tolist()])[place.reshape(pairs.shape)][:, :, :n]


def cut(engine, where):
	"""Breaks the links of a McaEngine or McaLaw that cross `where` (see crossing()) at the start of the next step; returns how many (int).

	For pre-cracks and notches before the first step of McaEngine (McaLaw links in its first step: cut after one of no motion), or at any time between steps.
	What is cut does not pull any more; pressure and friction pass as between any two surfaces. Raises CrackError for a `where` that is none and before there are
	links, and what engine.cut() raises.
	"""
	pairs = engine.links()
	if not pairs:
		started = engine.steps if hasattr(engine, 'steps') else len(engine.ids)
		if not started: raise CrackError('the engine has no links yet: it needs automata in O.bodies, and McaLaw makes links in its first step; O.run(1, True) before cut()')
		return 0
	ends = _places(engine, np.array(pairs))
	found = crossing(where, ends[:, 0], ends[:, 1])
	return engine.cut([pairs[k] for k in np.flatnonzero(found)])


def history(engine):
	"""engine.brokenLinks() with the names of the causes, (N,) of str, in place of their numbers."""
	h = engine.brokenLinks()
	return dict(h, cause=np.array(CAUSES)[h['cause']])


def writeCsv(path, engine):
	"""The history as a table, one row for each broken link, columns as in McaEngine.brokenLinks(). path: of the file, which appears whole or not at all."""
	h = history(engine)

	def fill(name):
		with open(name, 'w', newline='') as f:
			rows = csv.writer(f)
			rows.writerow(h)
			rows.writerows(zip(*(h[k].tolist() for k in h)))

	writeAtomically(path, fill)


def writeVtk(path, engine):
	"""The history as points for ParaView (.vtp): where links broke, with 'time [s]', 'cause' (number of CAUSES) and 'normal', for glyphs of discs.

	Raises ValueError when nothing has broken, ImportError without VTK.
	"""
	from .vtk_output import writeAutomata
	h = engine.brokenLinks()
	if not len(h['time']): raise ValueError('no link has broken, so there is nothing to write')
	writeAutomata(path, np.stack((h['x'], h['y'], h['z']), axis=1), {'time [s]': h['time'], 'cause': h['cause'], 'normal': np.stack((h['nx'], h['ny'], h['nz']), axis=1)})


def rose(engine, bins=18, since=0., until=np.inf):
	"""Orientation of cracks in the plane of x and y: (edges (bins + 1,), counts (bins,)) over the angle of the crack's line, 0 to pi [rad].

	since, until: times between which links broke [s]. Draw it with matplotlib: plt.subplot(projection='polar').bar(edges[:-1], counts, width=pi/bins, align='edge').
	Raises CrackError for bins that are no whole number from 1 to 3600.
	"""
	if isinstance(bins, bool) or not isinstance(bins, (int, np.integer)) or not 1 <= bins <= 3600:
		raise CrackError('bins must be a whole number from 1 to 3600; got %r' % (bins, ))
	for name, value in (('since', since), ('until', until)):
		if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)) or np.isnan(value):
			raise CrackError('%s must be a time [s]; got %r' % (name, value))
	h = engine.brokenLinks()
	chosen = (h['time'] >= since) & (h['time'] <= until)
	angle = (np.arctan2(h['ny'], h['nx'])[chosen] + 0.5 * np.pi) % np.pi
	counts, edges = np.histogram(angle, bins=bins, range=(0., np.pi))
	return edges, counts
