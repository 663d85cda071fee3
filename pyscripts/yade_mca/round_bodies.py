# SPDX-License-Identifier: GPL-2.0-or-later
"""Round bodies in space: a bar on a rigid anvil, rod and plate of a penetration; used through scenes. The axis of flight is y, as in plane strain.

Spacings are adjusted by up to a few per cent so that lengths and thicknesses are whole numbers of layers.
"""
import math

import numpy as np

from ._bodies import material as asMaterial
from .packings import Box, Cylinder, fcc
from .scene import MOST, PLATE, ROD, SceneError, oneOf, positive, start, subsonic

__all__ = ['roundBar']

LAYER = math.sqrt(0.5)  #: distance of the layers {100} over the spacing


def fitted(spacing, length):
	"""(spacing, number of layers across `length`): the nearest spacing of which `length` is a whole number of layers, full cells from face to face."""
	layers = max(round(length / (LAYER * spacing)), 1)
	return length / (LAYER * layers), layers


def affordable(spacing, *volumes):
	"""`volumes` [m3] of what is filled with automata."""
	number = sum(volumes) / (LAYER * spacing**3)
	if not number <= MOST:
		raise SceneError('spacing %g m gives some %.2g automata; at most %g are made: take a spacing of at least %.2g m, or smaller bodies' %
		                 (spacing, number, MOST, spacing * (number / MOST)**(1 / 3)))


def cylinder(spacing, length, diameter, low, quarter):
	"""SpacePacking of a round bar along y from y = low on, its axis x = z = 0; quarter: that of x, z >= 0."""
	d, _ = fitted(spacing, length)
	first = low + 0.5 * LAYER * d
	return fcc(d, Cylinder((0, low, 0), (0, low + length, 0), 0.5 * diameter), origin=(0, first, 0), mirror='xz' if quarter else '')


def plate(spacing, thickness, width, quarter):
	"""SpacePacking of a square plate, top face y = 0, rear face y = -thickness; quarter: that of x, z >= 0."""
	d, _ = fitted(spacing, thickness)
	half = 0.5 * width
	return fcc(d, Box((-half, -thickness, -half), (half, 0, half)), origin=(0, -0.5 * LAYER * d, 0), mirror='xz' if quarter else '')


def touchDown(upper, lower):
	"""SpacePacking `upper` moved along y until its foremost automata just touch those of `lower`. Raises SceneError."""
	reach = upper.radius + lower.radius
	a, b = upper.positions, lower.positions
	a, b = a[a[:, 1] < a[:, 1].min() + reach], b[b[:, 1] > b[:, 1].max() - reach]
	size = abs(a[:, [0, 2]]).max() + reach
	b = b[(abs(b[:, [0, 2]]) < size).all(axis=1)]
	across2 = ((a[:, None, [0, 2]] - b[None][:, :, [0, 2]])**2).sum(axis=-1)
	over = across2 < reach**2
	if not over.any(): raise SceneError('the bodies do not meet: no automaton of one lies above the other')
	need = b[None, :, 1] + np.sqrt(np.maximum(reach**2 - across2, 0)) - a[:, None, 1]
	return upper.translated((0, need[over].max() + 1e-9 * reach, 0))


def viscousEnds(s, packing, ids, quarter):
	"""Transmitting boundaries on the four sides of a plate, or on the two of a quarter."""
	x = packing.positions
	for c, sign in ((0, 1), (2, 1)) if quarter else ((0, 1), (0, -1), (2, 1), (2, -1)):
		end = ids[sign * x[:, c] > (sign * x[:, c]).max() - 0.1 * packing.spacing]
		normal = [0., 0., 0.]
		normal[c] = float(sign)
		s.automata.setViscous(end.tolist(), tuple(normal))


def fixedEnds(s, packing, ids, quarter):
	x = packing.positions
	outer = np.zeros(len(x), bool)
	for c in (0, 2): outer |= abs(x[:, c]) > abs(x[:, c]).max() - 0.1 * packing.spacing
	s.block(ids[outer], 'xyzXYZ')


def rodAndPlate(s, rodMat, plateMat, spacing, thickness, width, length, diameter, speed, ends, quarter):
	"""Adds parts 'plate' and 'rod' of a penetration to a Scene; the rod just touches."""
	positive(spacing=spacing, thickness=thickness, plateWidth=width, rodLength=length, rodDiameter=diameter)
	oneOf('ends', ends, ('fixed', 'viscous', 'free'))
	share = 0.25 if quarter else 1.
	affordable(spacing, share * width**2 * thickness, share * 0.25 * math.pi * diameter**2 * length)
	target = plate(spacing, thickness, width, quarter)
	body = touchDown(cylinder(spacing, length, diameter, 0., quarter), target)
	ids = s.add('plate', target, plateMat, mask=PLATE)
	if ends == 'viscous': viscousEnds(s, target, ids, quarter)
	elif ends == 'fixed': fixedEnds(s, target, ids, quarter)
	s.add('rod', body, rodMat, velocity=(0., -speed, 0.), mask=ROD, color=(0.8, 0.5, 0.2))
	return body


def roundBar(material, length, diameter, spacing, speed, quarter=True, engineOptions=None):
	"""Taylor's test in space: a round bar along y meets a rigid smooth anvil at y = 0 with its lower end. Part 'bar'.

	material          McaMat, name or record
	length, diameter  of the bar [m]; spacing [m], adjusted so that the length is a whole number of layers; speed [m/s] towards -y
	quarter           the quarter x, z >= 0 with planes of symmetry; False: the whole bar. The anvil is a plane of symmetry, too, at y = 0: the bar cannot lift off
	engineOptions     attributes of McaEngine, dict
	s.facts: speed, length, diameter, spacing (adjusted), parts (4 for a quarter: what masses and energies are to be multiplied with). Raises SceneError.
	"""
	positive(length=length, diameter=diameter, spacing=spacing, speed=speed)
	if not isinstance(quarter, bool): raise SceneError('quarter must be True or False; got %r' % (quarter, ))
	if spacing > 0.5 * min(length, diameter):
		raise SceneError('spacing %g m is above half the length or diameter of the bar (%g, %g m)' % (spacing, length, diameter))
	affordable(spacing, (0.25 if quarter else 1.) * 0.25 * math.pi * diameter**2 * length)
	subsonic('speed', speed, material)
	layers = max(round(length / (LAYER * spacing) - 0.5), 1)
	d = length / (LAYER * (layers + 0.5))  # half of the lowest layer is below the anvil, in the image
	body = fcc(d, Cylinder((0, 0, 0), (0, length, 0), 0.5 * diameter), origin=(0, 0, 0), mirror='xyz' if quarter else 'y')
	s = start(engineOptions)
	s.add('bar', body, asMaterial(material), velocity=(0., -speed, 0.), mask=ROD)
	s.facts.update(speed=speed, length=length, diameter=diameter, spacing=d, dimension=3, parts=4 if quarter else 1)
	return s
