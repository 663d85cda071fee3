# SPDX-License-Identifier: GPL-2.0-or-later
"""Fragments of a strip that is stretched fast, and spall, with a fracture energy (11f): at three spacings."""
import math

import numpy as np

from ... import measure, scenes
from ..._yade import scene as omega
from ..._yade import yadeClass
from ...packings import Rectangle, hexagonal
from .. import trials

ENERGY, STRENGTH = 1.1e4, 1e9  #: [J/m2], of pairs [Pa]
LENGTH, HEIGHT = 60e-3, 2e-3  #: of the strip [m]
SEEDS = (1, 2, 3)  #: of the strengths; a strip has few fragments, and their number scatters


def stretched(d, rate, seed=1):
	"""Number of fragments of more than a fifth of HEIGHT^2, in which most of a strip ends that is stretched at `rate` [1/s], and the share of its mass in them."""
	m = trials.elastic(pairStrength=STRENGTH, spallStrength=math.inf, fractureStrain=math.inf, strengthSpread=0.1, strengthDistribution='normal', viscosityLinear=0.25, viscosityQuadratic=1.2)
	m.fractureEnergy = ENERGY
	s = trials.automata(account=True, seed=seed)
	omega().engines = [yadeClass('McaTimeStepper')(factor=0.3), s.automata]
	p = hexagonal(d, Rectangle((0, 0), (LENGTH, HEIGHT)), angle=0.5 * math.pi, rim='triangles')
	s.add('strip', p, m, velocity=np.stack((rate * p.positions[:, 0], 0 * p.positions[:, 0]), axis=1))
	while omega().time < 0.006 / rate + 6e-6: trials.steps(s, 100)
	f = measure.fragmentsOf(s.automata, chains=False)
	large = f.mass > 0.2 * m.density * HEIGHT**2
	e = s.automata.energies()
	return int(large.sum()), f.mass[large].sum() / f.mass.sum(), e['total'] / e['kineticStart'] - 1


def fragments(report, want, quick):
	"""The number of fragments hardly depends on the spacing, and grows with the rate: by its power 2/3 where kinetic energy alone makes them (Grady, J. Appl. Phys. 53, 322, 1982)."""
	if not want('fragments'): return
	spacings, numbers = (0.25e-3, 0.18e-3) if quick else (0.25e-3, 0.18e-3, 0.125e-3), {}
	density = trials.elastic().density
	for rate in 1e4, 1e5:
		grady = LENGTH / (24 * ENERGY / (density * rate**2))**(1 / 3)
		for d in spacings:
			n, share, off = np.mean([stretched(d, rate, seed) for seed in SEEDS], axis=0)
			numbers.setdefault(rate, []).append(n)
			name = 'fragments/rate%g/d%gum' % (rate, 1e6 * d)
			report.add(name + '/number', n, unit='Grady: %.1f' % grady)
			report.add(name + '/share', share, unit='of the mass in them')
			report.add(name + '/energySum', off, 0., limit=1e-3, unit='of the kinetic energy')
		report.add('fragments/rate%g/mostOverLeast' % rate, max(numbers[rate]) / min(numbers[rate]), 1., limit=0.5, unit='over the spacings')
	report.add('fragments/exponent', math.log10(numbers[1e5][-1] / numbers[1e4][-1]), unit='of the number against the rate; Grady: 2/3')


def spallOf(d, energy=5e3, strength=1.5e9, depth=6e-3, rise=0.5e-3, peak=1.4):
	"""A long pulse of compression is reflected at the end of an elastic bar of copper, which opens at `depth` [m].

	Returns the pull-back of its surface over 2 sigma/(rho c), the thickness of the zone in which the middle four fifths of the broken links lie [m], and the error of
	the energy sum over the work of the piston.
	"""
	m = trials.material('OFHC_Cu', eos='linear', yieldModel='elastic', spallStrength=strength, fractureEnergy=energy)
	c, sigma = m.cP, strength * m.cP**2 / m.bulkSoundSpeed**2
	up, start, decay = peak * sigma / (m.density * c), rise / c, 2 * peak * depth / c
	columns = round((2.5 * peak * depth + depth + rise) / d)
	bar = trials.bar(m, columns * d, d, rows=6, account=True)
	piston, surface = scenes.driveEnd(bar, 'bar', 0.), []
	while omega().time < (columns * d + 3.2 * depth) / c:
		trials.steps(bar, 10)
		t = omega().time
		trials.move(piston, vx=up * math.sin(0.5 * math.pi * t / start)**2 if t < start else max(0., up * (1 - (t - start) / decay)))
		surface.append((t * c - columns * d, scenes.profile(bar, 'bar', 'vx')[1][-2:].mean()))
	at, v = np.array(surface).T  # travel since the pulse has reached the surface [m]
	top = int(np.argmax(np.where(at < rise + 0.5 * depth, v, 0.)))
	x, e = bar.automata.brokenLinks()['x'], bar.automata.energies()
	return (v[top] - v[top:].min()) * m.density * c / (2 * sigma), np.ptp(np.quantile(x, (0.1, 0.9))), e['total'] / e['external']


def spall(report, want, quick):
	"""Pull-back of the surface, and how thick the zone is that breaks: it does not shrink with the spacing."""
	if not want('spall'): return
	spacings = (100e-6, 50e-6) if quick else (100e-6, 50e-6, 25e-6)
	found = [spallOf(d) for d in spacings]
	for d, (fall, zone, off) in zip(spacings, found):
		name = 'spall/d%gum' % (1e6 * d)
		report.add(name + '/pullBack', fall, 1., limit=0.03 if d == 25e-6 else None, unit='of 2 sigma/(rho c)')
		report.add(name + '/zone', 1e3 * zone, unit='mm')
		report.add(name + '/energySum', off, 0., limit=0.005, unit='of the work of the piston')
	report.add('spall/zone/lastHalving', found[-1][1] / found[-2][1], passed=found[-1][1] > 0.75 * found[-2][1], unit='of that at twice the spacing')


CASES = [fragments, spall]
