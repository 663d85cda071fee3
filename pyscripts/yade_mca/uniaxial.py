# SPDX-License-Identifier: GPL-2.0-or-later
"""Uniaxial strain along x: strips of automata between two lines of mirror symmetry, plate impact, profiles over the height.

What lies on a line of symmetry belongs to the strip by half, so it has half the mass; with whole masses a strong shock tears the edge off. An automaton at
a corner that would hang on two links is left out: it spans no volume, so it carries no pressure and is run over.
"""
import math
from dataclasses import replace

import numpy as np

from ._arguments import number
from .packings import Rectangle, hexagonal
from .scene import MOST, PITCH, PLATE, ROD, SceneError, affordable, oneOf, positive, start, subsonic, within

__all__ = ['addStrip', 'driveEnd', 'middle', 'plateImpact', 'profile', 'strip']


def withoutCorners(packing):
	"""The packing without automata that have fewer than three neighbours."""
	while len(packing) and (few := np.bincount(packing.pairs().ravel(), minlength=len(packing)) < 3).any():
		packing = packing.select(~few)
	return packing


def strip(spacing, begin, length, rows, angle=0.):
	"""Packing of a strip from x = begin to begin + length [m], symmetric about y = 0; what lies on its edges has weight 1/2.

	rows   even: height over the distance of rows along x, which is PITCH (angle 0) or 1 (angle pi/2) times the spacing
	angle  0 or pi/2, of the close-packed rows against x
	Strips that follow each other (length a whole number of spacings when angle = 0) have one lattice.
	"""
	positive(spacing=spacing, length=length)
	within('begin', begin, -1e6 * length, 1e6 * length, 'm')
	within('angle', angle, 0., math.pi, 'rad')
	along = angle == 0
	if not (along or abs(angle - 0.5 * math.pi) < 1e-12):
		raise SceneError('angle of a strip must be 0 or pi/2; got %r' % angle)
	within('rows', rows, 2, MOST)
	if rows % 2 != 0:
		raise SceneError('rows of a strip must be even and at least 2; got %r' % rows)
	d, half = spacing, 0.5 * rows * spacing * (PITCH if along else 1.)
	affordable(d, (length, 2 * half))
	outline = Rectangle((begin + 0.5 * length, 0), (length, 2 * half + 1e-6 * d))
	p = hexagonal(d, outline, angle=angle, origin=(begin + (0.25 if along else 0.5) * d, 0.), rim='full')
	p = withoutCorners(p.translated((begin + 0.5 * d - p.positions[:, 0].min() + (0. if along else (PITCH - 1) * 0.5 * d), 0.)))
	if not len(p):
		raise SceneError('no strip of %g by %g m has automata of %g m that hold together: take a smaller spacing' % (length, 2 * half, d))
	return replace(p, weight=np.where(abs(p.positions[:, 1]) > half - 0.1 * d, 0.5, 1.))


def addStrip(s, part, packing, material, **options):
	"""Adds a strip() to the Scene s and holds it at its edges; returns the ids. Keywords as of packings.addBodies.

	The automata next to an edge push along y with fewer links than the mirror image would give them: two rows keep their y.
	"""
	ids = s.add(part, packing, material, **options)
	y = abs(packing.positions[:, 1])
	s.block(ids[y > y.max() - 2.1 * packing.spacing], 'yZ')
	return ids


def driveEnd(s, part, vx):
	"""The columns within one spacing of the left end of `part` move with vx [m/s] from now on, as a piston; returns their ids."""
	from ._yade import scene as omega
	ids = s.idsOf(part)
	vx = number('vx', vx, SceneError, unit=' m/s')
	x = s.packings[part].positions[:, 0]
	ids = ids[x < x.min() + 1.1 * s.packings[part].spacing]
	s.block(ids, 'xyZ')
	for i in ids.tolist():
		omega().bodies[i].state.vel = (vx, 0., 0.)
	return ids


def middle(packing):
	"""Which automata of a strip are in the middle half of its height, where the edges are not felt: bool (N,)."""
	y = abs(packing.positions[:, 1])
	return y < 0.5 * y.max() * (1 - 1e-9)


def profile(s, part, *names):
	"""x [m] and fields of the middle half of a strip, means over the height in columns of one spacing of material, from left to right: list of arrays."""
	s.idsOf(part)  # there is such a part
	p = s.packings[part]
	keep = middle(p)
	x = p.positions[keep, 0]
	column = np.floor((x - x.min()) / (p.spacing * (1. if p.angle == 0 else PITCH)) + 1e-6).astype(int)
	found = s.fields(part, ('x', *names))
	return [np.bincount(column, found[n][keep]) / np.bincount(column) for n in ('x', *names)]


def plateImpact(flyer, target, flyerThickness, targetThickness, height, spacing, speed, lateral='fixed', engineOptions=None):
	"""Flyer on target in uniaxial strain along x. Parts 'flyer', 'target'; profile(s, part, 'pressure', ...) reads them.

	flyer, target: materials; thicknesses along x and height [m], made whole numbers of spacings and of pairs of rows; speed of the flyer towards +x [m/s].
	lateral: 'fixed' blocks all motion along y (uniaxial strain; upper and lower edge are lines of mirror symmetry, of half weight), 'free' leaves the
	edges free and whole. Rows run along x; the bodies touch at x = 0 and share one lattice. facts['middle']: |y| [m] within which the edges are not felt.
	"""
	positive(flyerThickness=flyerThickness, targetThickness=targetThickness, height=height, spacing=spacing, speed=speed)
	oneOf('lateral', lateral, ('fixed', 'free'))
	if spacing > min(flyerThickness, targetThickness, 0.5 * height):
		raise SceneError('spacing %g m is above a thickness or half the height (%g, %g, %g m)' % (spacing, flyerThickness, targetThickness, height))
	affordable(spacing, (flyerThickness + targetThickness, height))
	subsonic('speed', speed, flyer, target)
	columns = [max(round(t / spacing), 1) for t in (flyerThickness, targetThickness)]
	rows = 2 * max(round(0.5 * height / (PITCH * spacing)), 1)
	packings = [strip(spacing, begin, n * spacing, rows) for begin, n in ((-columns[0] * spacing, columns[0]), (0., columns[1]))]
	s = start(engineOptions)
	for name, p, material, v, mask in zip(('flyer', 'target'), packings, (flyer, target), (speed, 0.), (ROD, PLATE)):
		if lateral == 'fixed':
			s.block(s.add(name, p, material, velocity=(v, 0.), mask=mask), 'yZ')
		else:
			s.add(name, replace(p, weight=np.ones(len(p))), material, velocity=(v, 0.), mask=mask)
	s.facts.update(speed=speed, middle=0.25 * rows * PITCH * spacing, flyerThickness=columns[0] * spacing, targetThickness=columns[1] * spacing)
	return s
