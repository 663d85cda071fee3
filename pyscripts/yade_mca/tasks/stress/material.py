# SPDX-License-Identifier: GPL-2.0-or-later
"""Constants of the materials from end to end of their ranges, in automata and cells, and beyond them."""
import math

import numpy as np

from ..trials import material
from .judge import REFUSED, StressCase, energyBound
from .watch import transit, twoBlocks, watchedGrid

SLOPES = (0., 0.5, 1., 1.5, 2., 2.5, 3.)
POISSON = (0., 0.1, 0.2, 0.3, 0.4, 0.45, 0.49, 0.5)
YIELDS = (0., 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e12, math.inf)
DENSITIES = (1, 2, 5, 10, 20, 50, 100)
SPEED = 600.  #: of the flyer [m/s]
UNLIKE = 0.1  #: bound on the energy sum where a light body hits a heavy one and flows: it has little energy of its own


def automata(a, b=None, speed=SPEED, **options):
	b = b or a
	t = twoBlocks(a, b, speed, sizes=((10, 14), (14, 20)), **options)
	return t.run(until=transit(a, b, length=20e-3, times=3.)).measures()


def grid(a, b=None, speed=SPEED):
	b = b or a
	t = watchedGrid([(a, 10, 14), (b, 14, 14)], lambda k, x, y: (np.where(k == 0, speed, 0.) + 0 * x, 0 * y))
	return t.run(until=transit(a, b, length=20e-3, times=1.5)).measures()


BREAKS = dict(yieldModel='perfect', fractureStrain=1., spallStrength=3e9)


def light(ratio):
	"""Steel and a material of the same modulus with 1/ratio of its density."""
	a = material('4340', **BREAKS)
	b = material('4340', **BREAKS, label='light', density=a.density / ratio, bulkSoundSpeed=a.bulkSoundSpeed * math.sqrt(ratio))
	return a, b


def soft(ratio):
	"""Steel and a material of the same sound speeds with 1/ratio of its density."""
	a = material('4340', **BREAKS)
	return a, material('4340', **BREAKS, label='soft', density=a.density / ratio, shearModulus=a.shearModulus / ratio, yieldStress=a.yieldStress / ratio)



def joinedStep(factor, quick):
	"""Two linked elastic materials, one a hundred times as light and soft, without viscosity: the step is limited by what the stiff one does to the light one."""
	none = dict(yieldModel='elastic', viscosityLinear=0., viscosityQuadratic=0.)
	a = material('4340', **none)
	b = material('4340', label='soft', density=0.01 * a.density, shearModulus=0.01 * a.shearModulus, **none)
	t = twoBlocks(b, a, 6., sizes=((10, 14), (14, 20)), joined=True, dtFactor=factor)
	return t.run(until=transit(a, length=20e-3, times=2. if quick else 6.)).measures()


def cases(quick, seed):
	found = []

	def both(name, make, expect='held', **options):
		found.append(StressCase('material/%s/automata' % name, lambda: automata(make(), **options), expect))
		found.append(StressCase('material/%s/grid' % name, lambda: grid(make(), **options), expect))

	for b in SLOPES:
		both('b%g' % b, lambda b=b: material('4340', hugoniotSlope=b))
	for nu in POISSON:
		both('nu%g' % nu, lambda nu=nu: material('4340', yieldModel='elastic', poisson=nu))
		both('nu%g/plastic' % nu, lambda nu=nu: material('4340', poisson=nu))
	for y in YIELDS:
		def make(y=y):
			m = material('4340', yieldModel='perfect')
			m.yieldStress = y
			return m
		both('yield%g' % y, make)
	for name, overrides in (('b-0.1', dict(hugoniotSlope=-0.1)), ('yield-1', dict(yieldStress=-1.)), ('density0', dict(density=0.)), ('c0nan', dict(bulkSoundSpeed=math.nan)), ('c0inf', dict(bulkSoundSpeed=math.inf)),
	                        ('G-1', dict(shearModulus=-1.)), ('viscosity-1', dict(viscosityLinear=-1.)), ('viscosityInf', dict(viscosityLinear=math.inf)), ('spall0', dict(spallStrength=0.)), ('frictionNan', dict(frictionAngle=math.nan))):
		def wrong(overrides=overrides):
			m = material('4340')
			for k, v in overrides.items():
				setattr(m, k, v)
			return m
		both('wrong/' + name, wrong, REFUSED)
	for ratio in (1, 10, 100) if quick else DENSITIES:
		bound = energyBound() if ratio < 5 else UNLIKE
		for kind, make in (('sameModulus', light), ('sameSpeed', soft)):
			for name, run in (('automata', automata), ('joined', lambda a, b: automata(a, b, joined=True)), ('grid', grid)):
				found.append(StressCase('material/density%d/%s/heavyOnLight/%s' % (ratio, kind, name), lambda m=make, r=ratio, run=run: run(*m(r)), energy=bound))
				if not quick:
					found.append(StressCase('material/density%d/%s/lightOnHeavy/%s' % (ratio, kind, name), lambda m=make, r=ratio, run=run: run(*m(r)[::-1]), energy=bound))
	for factor in (0.4, 1.):
		found.append(StressCase('material/density100/elastic/joined/dtFactor%g' % factor, lambda f=factor: joinedStep(f, quick), energy=energyBound(factor)))
	for factor in (0., 0.1, 1., 3., 10.):
		both('viscosity%g' % factor, lambda f=factor: material('4340', viscosityLinear=0.25 * f, viscosityQuadratic=1.2 * f))
	return found
