# SPDX-License-Identifier: GPL-2.0-or-later
"""Time step: runs up to the predicted limit, is refused beyond it."""
import math

import numpy as np

from ..._yade import scene as omega
from ...packings import Rectangle, addBodies, hexagonal
from ..trials import D, elastic, material
from .judge import REFUSED, StressCase, energyBound
from .watch import transit, twoBlocks, watchedAutomata, watchedGrid

BELOW = (0.05, 0.2, 0.5, 0.8, 0.95, 0.999)
ABOVE = (1.001, 1.1, 2., 100., math.inf, math.nan, 0.)  # YADE takes a negative O.dt as a wish for a time stepper
FACTORS = (0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0)
WRONG = (1.01, 2., 0., -0.5, math.nan)
SIZE = 16  #: cells or spacings across the vibrating block


def motion(x, y, speed=1., noise=1e-3):
	"""Velocities of a smooth vibration with a little of every other wave in it, from which an instability would grow."""
	r = np.random.default_rng(3).uniform(-noise, noise, (2, *np.shape(x)))
	k = math.pi / (SIZE * D)
	return speed * (np.sin(k * x) * np.cos(k * y) + r[0]), speed * (0.7 * np.cos(2 * k * x) * np.sin(k * y) + r[1])


def vibratingAutomata(mat, angle=0.2, **options):
	t = watchedAutomata(contacts=False, adaptive=False, **options)
	p = hexagonal(D, Rectangle((0, 0), (SIZE * D, SIZE * D)), angle=angle, rim='full')
	addBodies(p, mat, velocity=np.stack(motion(*p.positions.T), axis=1))
	return t


def vibratingGrid(mat, **options):
	return watchedGrid([(mat, SIZE, SIZE)], lambda k, x, y: motion(x, y), adaptive=False, **options)


def fixedStep(make, factor, steps=2000):
	"""A vibrating block with a step of `factor` times the limit that its engine names."""
	t = make()
	engine, o = t.automata or t.grid, omega()
	o.dt = 1e-12
	t.run(1)  # the limit is known after the first step
	limit = engine.criticalTimeStep
	o.dt = factor * limit
	t.run(steps, every=100)
	return t.measures(limit=limit)


def impact(factor, quick):
	"""Two steel blocks at 1000 m/s, plastic, contact, fracture; adaptive step."""
	m = material('4340', fractureStrain=1., spallStrength=3e9)
	t = twoBlocks(m, m, 1000., dtFactor=factor)
	return t.run(until=transit(m, times=1. if quick else 3.)).measures()


def gridImpact(factor, quick):
	m = material('4340')
	t = watchedGrid([(m, 12, 20), (m, 24, 20)], lambda k, x, y: (np.where(k == 0, 1000., 0.) + 0 * x, 0 * y), dtFactor=factor)
	return t.run(until=transit(m, times=1. if quick else 2.)).measures()


def cases(quick, seed):
	found = []
	kinds = {'automata/elastic': lambda: vibratingAutomata(elastic()), 'automata/viscous': lambda: vibratingAutomata(material('4340', yieldModel='elastic')),
	         'grid/elastic': lambda: vibratingGrid(elastic()), 'grid/viscous': lambda: vibratingGrid(material('4340', yieldModel='elastic'))}
	steps = 1000 if quick else 20000
	for kind, make in kinds.items():
		for f in BELOW:
			found.append(StressCase('step/%s/%g' % (kind, f), lambda make=make, f=f: fixedStep(make, f, steps), energy=energyBound(f)))
		for f in ABOVE:
			found.append(StressCase('step/%s/%g' % (kind, f), lambda make=make, f=f: fixedStep(make, f, steps), REFUSED))
	for kind, run in (('automata', impact), ('grid', gridImpact)):
		for f in FACTORS:
			found.append(StressCase('step/%s/impact/dtFactor%g' % (kind, f), lambda run=run, f=f: run(f, quick), energy=energyBound(f)))
		for f in WRONG:
			found.append(StressCase('step/%s/impact/dtFactor%g' % (kind, f), lambda run=run, f=f: run(f, quick), REFUSED))
	return found
