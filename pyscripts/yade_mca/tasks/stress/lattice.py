# SPDX-License-Identifier: GPL-2.0-or-later
"""Packings that are not perfect, and grids whose cells do not match the automata at the interface."""
import math

import numpy as np

from .. import trials
from ..trials import D, PITCH, elastic, material
from .judge import REFUSED, StressCase
from .watch import Watch, transit, twoBlocks

NOISE = (0.01, 0.02, 0.05, 0.08, 0.1)
MORE = (0.12, 0.15, 0.2, 0.3)  #: here neighbours can be taken for what they are not: refused, or it runs
EDGES = (0.5, 0.75, 1., 1.5, 2., 3., 4., 4.5)  #: of the grid over the spacing, allowed
WRONG = (0.3, 0.45, 6., 9.)
HEIGHT = 36  #: of the two halves in spacings: a whole number of all these edges


def noisy(noise, seed, angle=0.):
	m = material('4340', fractureStrain=1., spallStrength=3e9)
	return twoBlocks(m, m, 800., angle=angle, noise=noise, seed=seed).run(until=transit(m, times=3.)).measures()


def interface(edge, speed, quick, plastic=True):
	"""Automata on the left fly into the grid on the right, to which they are tied."""
	m = material('4340') if plastic else elastic()
	along = lambda x: 1. if plastic else np.cos(0.5 * math.pi * x / (12 * PITCH * D))
	velocity = lambda x, y: (speed * along(x) * (x < 0), 0.2 * speed * np.sin(300 * y))
	s = trials.halves(m, 12 * PITCH, 18, HEIGHT, edge, velocity=velocity, account=True)
	return Watch(s, [(0, m)]).run(until=transit(m, times=1. if quick else 3.)).measures()


def cases(quick, seed):
	found = []
	for noise in NOISE + MORE:
		for k in range(1 if quick else 3):
			found.append(StressCase('lattice/noise%g%%/%d' % (100 * noise, k + 1), lambda n=noise, s=seed + 10 * k: noisy(n, s, 0.4 * (s % 4)), 'held' if noise <= 0.1 else 'either'))
	for edge in EDGES:
		found.append(StressCase('interface/edge%gd/plastic' % edge, lambda h=edge: interface(h, 300., quick)))
		found.append(StressCase('interface/edge%gd/elastic' % edge, lambda h=edge: interface(h, 10., quick, False)))
	for edge in WRONG:
		found.append(StressCase('interface/edge%gd' % edge, lambda h=edge: interface(h, 300., quick), REFUSED))
	return found
