# SPDX-License-Identifier: GPL-2.0-or-later
"""For YADE's viewer: automata coloured by a field, cells of the grid as facets. Both are refreshed by calling update() of the returned object, or by a PyRunner.

    >>> from yade_mca import viewer
    >>> picture = viewer.Picture(s.automata, 'pressure', grid=s.grid)
    >>> O.engines = O.engines + [PyRunner(command='picture.update()', iterPeriod=100)]

Facets are bodies of their own without material contact; the solvers do not see them. Only for looking: leave it out of runs that need no viewer.
"""
import numpy as np

from ._yade import scene

__all__ = ['Picture', 'colours']


def colours(values, low=None, high=None):
	"""(N, 3) red, green, blue in 0 ... 1 of values (N,) from `low` (blue) over white to `high` (red); limits default to the data's."""
	v = np.asarray(values, float)
	low = np.nanmin(v) if low is None else low
	high = np.nanmax(v) if high is None else high
	t = np.clip((v - low) / (high - low if high > low else 1.), 0, 1)[:, None]
	blue, white, red = (np.array(c) for c in ((0.15, 0.3, 0.9), (0.95, 0.95, 0.95), (0.85, 0.1, 0.1)))
	return np.where(t < 0.5, blue + 2 * t * (white - blue), white + (2 * t - 1) * (red - white))


class Picture:
	"""What the viewer shows of one McaEngine (or None) and one McaGridEngine (or None)."""

	def __init__(self, automata, name='pressure', grid=None, low=None, high=None, wire=False):
		"""name: a quantity of McaEngine.field(); grid cells show 'pressure' or 'plasticStrain' when that is the name, else grey. low, high: colour range."""
		self.automata, self.name, self.grid, self.low, self.high = automata, name, grid, low, high
		self.facets = {}
		for block in range(len(grid.blocks)) if grid is not None else ():
			self.facets[block] = self._addFacets(block, wire)
		self.update()

	def _corners(self, block):
		"""(cells, 4, 3) corners of the cells, counter-clockwise [m]."""
		x, y = self.grid.view(block, 'x'), self.grid.view(block, 'y')
		p = np.stack((x, y, 0 * x), axis=-1)
		return np.stack((p[:-1, :-1], p[:-1, 1:], p[1:, 1:], p[1:, :-1]), axis=2).reshape(-1, 4, 3)

	def _addFacets(self, block, wire):
		"""Two triangles per cell; returns their ids (cells, 2)."""
		from yade import utils
		if not len(scene().materials):
			raise ValueError('no material in O.materials: add the bodies or blocks first')
		ids = []
		for a, b, c, d in self._corners(block).tolist():
			ids.append(scene().bodies.append([utils.facet(t, wire=wire, material=scene().materials[0], mask=0) for t in ((a, b, c), (a, c, d))]))
		return np.array(ids)

	def update(self):
		"""Positions and colours as they are now."""
		if self.automata is not None and self.automata.count:
			self.automata.sync()
			now = self.automata.fields(['ids', self.name])
			for i, c in zip(now['ids'].tolist(), colours(now[self.name], self.low, self.high).tolist()):
				scene().bodies[i].shape.color = c
		for block, ids in self.facets.items():
			corners = self._corners(block)
			if self.name in ('pressure', 'plasticStrain'):
				rgb = colours(np.ravel(self.grid.view(block, self.name)), self.low, self.high)
			else:
				rgb = np.full((len(ids), 3), 0.7)
			for pair, (a, b, c, d), colour in zip(ids.tolist(), corners, rgb.tolist()):
				for i, triangle in zip(pair, ((a, b, c), (a, c, d))):
					middle = np.mean(triangle, axis=0)
					body = scene().bodies[i]
					body.state.pos, body.shape.vertices, body.shape.color = middle, [tuple(p - middle) for p in triangle], colour
