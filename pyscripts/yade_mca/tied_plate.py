# SPDX-License-Identifier: GPL-2.0-or-later
"""A plate whose middle is automata and whose rest is grid, with a packing at any angle; graded grid lines.

The interface runs along a close-packed row. In a turned packing the row nearest to the plate's normal leans by at most 30 degrees, and so does the
interface; the outer ends of the grid stay upright.
"""
import math

import numpy as np

from ._bodies import material as asMaterial
from ._yade import scene as omega
from ._yade import yadeClass
from .packings import Polygon, Rectangle, hexagonal
from .scene import PITCH, PLATE, Scene, SceneError, affordable, oneOf, positive, start, within

__all__ = ['gradedLines', 'leaning', 'tiedPlate']

NARROWEST = 0.5  #: width of the grid beside a leaning interface where it is narrowest, over that in the middle
LINES = 10000  #: grid lines at most


def gradedLines(start, end, first, growth=1.1, largest=None):
	"""Grid lines from `start` to `end` (either sense): the first cell `first` long, each next at most `growth` times longer, none above `largest`.

	Returns an array from start to end [m]. The growth is lowered a little so that the last line falls on `end`; where that cannot be (a
	distance of few cells), the distance is divided evenly. Raises SceneError for numbers that are not finite or give more than LINES lines.
	"""
	for name, v in (('start', start), ('end', end)):
		within(name, v, -1e9, 1e9, 'm')
	positive(first=first, growth=growth)
	if largest is not None: within('largest', largest, 0., math.inf, 'm', openLow=True)
	distance, largest = abs(end - start), math.inf if largest is None else float(largest)
	if not (1 <= growth <= 2 and largest >= first):
		raise SceneError('growth must be from 1 to 2 and largest at least first; got %r, %r, %r' % (growth, largest, first))
	cells = lambda n, q: np.minimum(first * q**np.minimum(np.arange(n), 1000), largest)
	n = 1
	while n <= LINES and cells(n, growth).sum() < distance * (1 - 1e-9):
		n += 1
	if n > LINES or distance > LINES * largest:
		raise SceneError('a grid from %g to %g m with cells of %g m, at most %g m, has more than %d lines: take larger cells or a shorter distance' %
		                 (start, end, first, largest, LINES))
	if cells(n, 1 / growth).sum() > distance:
		lengths = np.full(max(round(distance / first), 1), 1.)
	else:
		low, high = 1 / growth, growth
		for _ in range(100):
			mid = 0.5 * (low + high)
			low, high = (mid, high) if cells(n, mid).sum() < distance else (low, mid)
		lengths = cells(n, high)
	lengths *= distance / lengths.sum()
	lines = start + math.copysign(1, end - start) * np.concatenate(((0.,), np.cumsum(lengths)))
	lines[-1] = end
	return lines


def leaning(angle):
	"""Angle [rad] from the plate's normal of the close-packed row nearest to it when the packing is turned by `angle`: from -30 to 30 degrees."""
	lean = math.remainder(angle, math.pi / 3)
	return 0. if abs(lean) < 1e-9 else lean


def plateGeometry(thickness, spacing, automataWidth, plateWidth, mode, angle):
	"""(lean [rad], half width of the automata [m]) of tiedPlate(); raises SceneError for what cannot be built."""
	positive(thickness=thickness, spacing=spacing, automataWidth=automataWidth, plateWidth=plateWidth)
	within('angle', angle, -2 * math.pi, 2 * math.pi, 'rad')
	oneOf('mode', mode, ('coupled', 'mca'))
	if thickness < 2 * spacing or automataWidth < 4 * spacing:
		raise SceneError('spacing %g m is above half the thickness %g m or a quarter of automataWidth %g m' % (spacing, thickness, automataWidth))
	if abs(thickness / spacing - round(thickness / spacing)) > 1e-6:
		raise SceneError('thickness %g m is not a whole number of spacings %g m: take spacing %g m' %
		                 (thickness, spacing, thickness / math.ceil(thickness / spacing)))
	affordable(spacing, (thickness, automataWidth))
	lean = leaning(angle)
	half = round(0.5 * automataWidth * math.cos(lean) / (PITCH * spacing)) * PITCH * spacing / math.cos(lean)
	grid = 0.5 * plateWidth - half  # width of the grid on one side, in the middle of the thickness
	if mode == 'coupled' and (grid < spacing or grid * (1 - NARROWEST) < 0.5 * thickness * abs(math.tan(lean))):
		least = 2 * half + thickness * abs(math.tan(lean)) / (1 - NARROWEST)
		more = ' whose rows lean by %.3g degrees: take at least %.3g m' % (math.degrees(lean), least) if lean else ''
		raise SceneError('plateWidth %g m leaves no room for a grid beside %g m of automata%s' % (plateWidth, 2 * half, more))
	return lean, half


def _platePacking(spacing, thickness, half, lean, coupled):
	"""Between two close-packed rows, or in an upright rectangle where nothing is tied to it."""
	offset = 0.5 * thickness * math.tan(lean)  # the row through (half, -thickness/2) is at half - offset on top, half + offset below
	if lean and coupled:
		outline = Polygon([(-half + offset, -thickness), (half + offset, -thickness), (half - offset, 0.), (-half - offset, 0.)])
	else:
		outline = Rectangle((0, -0.5 * thickness), (2 * half, thickness))
	return hexagonal(spacing, outline, angle=0.5 * math.pi + lean, origin=(half, -0.5 * thickness if lean else 0.))


def _tie(s, block, side, ids):
	"""Ties the automata `ids` to a side of a grid block by a McaGridCoupler."""
	coupler = yadeClass('McaGridCoupler')(block=block, side=side, ids=[int(i) for i in ids])
	s.couplers.append(coupler)


def _plateEnds(s, material, spacing, thickness, half, lines, lean, ends, dtFactor):
	"""Grid blocks left and right of the automata (on `lines` [m] from the interface outwards), tied to the rows through (+-half, -thickness/2)."""
	s.grid = yadeClass('McaGridEngine')()
	ys = np.linspace(-thickness, 0., round(thickness / spacing) + 1)
	shift = -(ys + 0.5 * thickness) * math.tan(lean)  # of the interface in each row of nodes
	share = (lines[-1] - lines) / (lines[-1] - half)  # of the shift: 1 at the interface, 0 at the end
	for name, sign in (('right', 1), ('left', -1)):  # all blocks come before the first boundary
		if lean:
			x = (sign * lines + shift[:, None] * share)[:, ::sign]
			y = np.broadcast_to(ys[:, None], x.shape)
			s.blocks[name] = s.grid.addBlock(material, np.ascontiguousarray(x), np.ascontiguousarray(y), name=name)
		else:
			s.blocks[name] = s.grid.addRectangle(material, (sign * lines)[::sign].tolist(), ys.tolist(), name=name)
	for name, outer in (('right', 'right'), ('left', 'left')):
		if ends == 'fixed':
			s.grid.fix(s.blocks[name], outer)
		elif ends == 'viscous':
			s.grid.viscous(s.blocks[name], outer)
	for name, inner, sign in (('right', 'left', 1), ('left', 'right', -1)):
		row = s.packings['plate'].onLine((sign * half, -0.5 * thickness), (-math.sin(lean), math.cos(lean)))
		_tie(s, s.blocks[name], inner, s.ids['plate'][row])
	omega().engines = [yadeClass('McaTimeStepper')(factor=dtFactor), s.automata, s.grid, *s.couplers]


def tiedPlate(material, thickness, spacing, automataWidth=80e-3, plateWidth=120e-3, mode='coupled', ends='fixed', growth=1.1, largest=4., mask=PLATE,
              scene=None, dtFactor=0.4, angle=0., engineOptions=None):
	"""A plate (top face y = 0, rear face y = -thickness) whose middle is automata and whose rest is grid. Part 'plate', blocks 'left', 'right'.

	mode      'coupled': grid outside the automata, tied at the columns nearest |x| = automataWidth/2; 'mca': automata only, no grid
	ends      'fixed', 'viscous' (transmitting) or 'free': where the plate ends, |x| = plateWidth/2 ('coupled') or automataWidth/2 ('mca')
	growth    of the cells away from the interface; largest: longest cell in spacings
	dtFactor  share of the largest stable time step
	angle     by which the packing is turned [rad]; at 0 close-packed columns run along y. Turns by 60 degrees give the same packing.
	          Coupled, the interface runs along the close-packed row nearest to the normal and leans by up to 30 degrees.
	thickness must be a whole number of spacings: at angle 0 the tied column then has the nodes of the grid. Raises SceneError.
	"""
	if scene is not None and not isinstance(scene, Scene): raise SceneError('scene must be None or a Scene, as start() makes one; got %r' % (scene, ))
	within('growth', growth, 1., 2.)
	within('largest', largest, 1., 1e6)
	within('dtFactor', dtFactor, 0., 1., openLow=True)
	oneOf('ends', ends, ('fixed', 'viscous', 'free'))
	lean, half = plateGeometry(thickness, spacing, automataWidth, plateWidth, mode, angle)
	coupled = mode == 'coupled'
	lines = gradedLines(half, 0.5 * plateWidth, spacing, growth, largest * spacing) if coupled else None
	plate = _platePacking(spacing, thickness, half, lean, coupled)
	s = start(engineOptions) if scene is None else scene
	s.automata.dtFactor = dtFactor
	m = asMaterial(material)
	s.add('plate', plate, m, mask=mask)
	s.facts.update(thickness=thickness, spacing=spacing, automataWidth=2 * half, mode=mode, ends=ends, plate=m.label, angle=angle)
	if coupled:
		s.facts['plateWidth'] = plateWidth
		_plateEnds(s, m, spacing, thickness, half, lines, lean, ends, dtFactor)
	else:
		x = plate.positions[:, 0]
		for sign in (-1, 1):
			end = s.ids['plate'][sign * x > half - (0.5 * spacing if lean else 1e-6 * spacing)]
			if ends == 'fixed':
				s.block(end, 'xyZ')
			elif ends == 'viscous':
				s.automata.setViscous(end.tolist(), (float(sign), 0.))
	return s
