# SPDX-License-Identifier: GPL-2.0-or-later
"""Cracks that spend a fracture energy (11f): toughness and speed in a strip, at three spacings."""
import math

import numpy as np

from ... import cracks
from ..._yade import scene as omega
from ..._yade import yadeClass
from ...packings import Rectangle, hexagonal
from .. import trials

TOUGHNESS, STRENGTH = 50e6, 1e9  #: [Pa m^0.5], of pairs [Pa]
LENGTH, HEIGHT = 60e-3, 20e-3  #: of the strip [m]
RISE, START = 300e-6, 20e-6  #: in which G comes to G_f, in which the clamps get their speed [s]


def metal():
	"""Elastic steel of this toughness."""
	m = trials.elastic(pairStrength=STRENGTH, spallStrength=math.inf, fractureStrain=math.inf, viscosityLinear=0.25)
	m.fractureEnergy = TOUGHNESS**2 * (1 - m.poisson**2) / m.young
	return m


def strip(d, angle=0.):
	"""A strip whose upper and lower edges are driven apart, cut from the left end to 0.4 of its length, in which G = M u^2/h whatever the length of the crack.

	M = K + 4G/3, h half the height between the clamps, u the way of each. Returns the Scene; facts: level of the cut, halfHeight, speed of the clamps, material.
	"""
	m = metal()
	s = trials.automata(account=True, damping=0.02)
	omega().engines = [yadeClass('McaTimeStepper')(factor=0.4), s.automata]
	p = hexagonal(d, Rectangle((0, 0), (LENGTH, HEIGHT)), angle=angle, rim='triangles')
	ids = s.add('strip', p, m)
	y = p.positions[:, 1]
	rows = np.unique(np.round(y, 9))
	level = 0.5 * (rows[rows <= 1e-9].max() + rows[rows > 1e-9].min()) if angle == 0 else 0.
	cracks.cut(s.automata, ((-LENGTH, level), (-0.1 * LENGTH, level)))
	h, modulus = 0.5 * np.ptp(y), m.density * m.cP**2
	speed = math.sqrt(m.fractureEnergy * h / modulus) / (RISE - 0.5 * START)
	for side, sign in (y < y.min() + 0.6 * d, -1), (y > y.max() - 0.6 * d, 1):
		s.automata.prescribe(ids[side].tolist(), x=0., y=((0., START), (0., sign * speed)))
	s.facts.update(material=m, level=level, halfHeight=h, speed=speed, modulus=modulus)
	return s


def tipOf(s):
	"""Foremost link that has parted [m]."""
	e = s.automata
	broken, holding = e.brokenLinks(), e.cohesivePairs()
	open_ = set(zip(holding['id1'].tolist(), holding['id2'].tolist()))
	parted = np.array([(a, b) not in open_ and (b, a) not in open_ for a, b in zip(broken['id1'].tolist(), broken['id2'].tolist())], bool)
	x = broken['x'][parted]
	return x[x < 0.4 * LENGTH].max(initial=-0.1 * LENGTH)  # not the corners of the clamps


def grown(d):
	"""(G over G_f when the crack has grown by 1.5 mm, fastest speed of the crack [m/s], error of the energy sum over the work of the clamps)."""
	s = strip(d)
	f, m = s.facts, s.facts['material']
	found, tips = None, []
	while omega().time < 1.5 * RISE:
		trials.steps(s, 40)
		t, tip = omega().time, tipOf(s) + 0.1 * LENGTH
		tips.append((t, tip))
		if found is None and tip > 1.5e-3: found = f['modulus'] * (f['speed'] * (t - 0.5 * START))**2 / f['halfHeight'] / m.fractureEnergy
		if tip > 0.35 * LENGTH: break
	t, x = np.array(tips).T
	speed = max((x[k] - x[j]) / (t[k] - t[j]) for k in range(len(t)) for j in [np.searchsorted(x, x[k] - 5e-3)] if x[k] > 6e-3 and j < k)
	e = s.automata.energies()
	return found, speed, e['total'] / e['external']


def toughness(report, want, quick):
	"""A crack grows where G = G_f, in a strip that gives G exactly; it stays below the speed of Rayleigh's waves."""
	if not want('toughness'): return
	from ... import materials
	limit = materials.get('4340').cR
	for d in (1e-3, 0.5e-3) if quick else (1e-3, 0.5e-3, 0.25e-3):
		G, speed, off = grown(d)
		name = 'toughness/d%gum' % (1e6 * d)
		report.add(name + '/K_Ic', math.sqrt(G) * 1e-6 * TOUGHNESS, 1e-6 * TOUGHNESS, limit=0.05, unit='MPa m^0.5, at the start of growth')
		report.add(name + '/speed', speed / limit, unit='of the Rayleigh speed, on the way', passed=speed < limit)
		report.add(name + '/energySum', off, 0., limit=0.005, unit='of the work of the clamps')


CASES = [toughness]
