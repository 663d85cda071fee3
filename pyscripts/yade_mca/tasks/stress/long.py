# SPDX-License-Identifier: GPL-2.0-or-later
"""Long runs of free elastic bodies (drift of energy), and the shortest waves of the pressure field behind a shock (even-odd noise).

Even-odd noise, the measure: amplitude of the shortest waves a lattice can hold in the pressure field, over its mean. In automata these are the six corners
and the middles of the six sides of the Brillouin zone (three rows or three sublattices alternate), in cells columns, rows and checkerboard. The amplitude
is |sum w (p - line) exp(-i phase)| / sum w (twice that for complex waves), w a Hann window along x over the plateau, `line` the straight line through p(x).
"""
import math

import numpy as np

from ... import scenes
from ..._yade import scene as omega
from ...packings import addBodies, disc, hexagonal
from .. import trials
from ..trials import D, PITCH, elastic, material
from .judge import LEAPFROG, StressCase
from .watch import Watch, advance, jittered, watchedAutomata, watchedGrid

DRIFT = 1e-4  #: largest change of the mean energy over a long run [-]
SINGLE = 0.1  #: bound on single samples of the energy sum in those runs: leapfrog's own error of the waves near the limit of the step
NOISE = 0.01  #: of the lattices behind whose shocks the shortest waves are measured: without it symmetry would hide them
#: linear viscosity of long runs, a hundredth of the default: what the account books of it is tried, too; those without any are called noViscosity
DAMPED = dict(viscosityLinear=0.0025)
SPEED = 0.1  #: of the piston over the bulk sound speed


def meanEnergy(t, samples=400):
	"""Independent energy sum averaged over some oscillations: velocities are half a step away from the positions."""
	total = []
	for _ in range(samples):
		advance(11)
		before = t.balance()
		omega().step()
		b = t.balance()
		omega().step()
		after = t.balance()
		total.append(b['kinetic'] + b['level'] + 0.5 * (before['late'] + b['late'] + b['early'] + after['early']))
	return float(np.mean(total))


def viscousEnergy(t):
	return t.automata.energies()['viscous'] if t.automata is not None else 0.


def drift(t, steps, factor):
	"""A long run is judged by its drift: single samples of a vibration at half the limit are off by some 1e-3.

	Leapfrog conserves an energy that differs from the sum of the state by (omega dt)^2/4 of each wave; what viscosity takes from a wave, it takes with that
	difference. So a run that decays may drift by this share of what it has lost. (Measured: a quarter at half the step, and the same for both volume rules.)
	"""
	t.run(100)
	first, before = meanEnergy(t), viscousEnergy(t)
	t.run(steps, every=max(1000, steps // 20))
	last, lost = meanEnergy(t), (viscousEnergy(t) - before) / first
	bound = DRIFT + LEAPFROG * factor**2 * lost
	return t.measures(value=abs(last / first - 1), atMost=bound, unit='drift of the mean energy over %g steps, %.2g of it dissipated' % (steps, lost))


def freeAutomata(factor, steps, rule='affine', rim='full', angle=0., **changes):
	t = watchedAutomata(contacts=False, dtFactor=factor, volumeRule=rule)
	m = elastic(**dict(DAMPED, **changes))
	p = hexagonal(D, disc((0, 0), 7.4 * D), rim=rim, angle=angle)
	x, y = p.positions.T
	v = 1e-4 * m.cS * np.stack((np.sin(200 * x) * np.cos(150 * y), np.cos(180 * x + 100 * y)), axis=1) + 1e-6 * m.cS * np.random.default_rng(2).standard_normal((len(p), 2))
	addBodies(p, m, velocity=v - v.mean(axis=0), angularVelocity=1e-4 * m.cS / (7 * D))
	return drift(t, steps, factor)


def freeGrid(factor, steps):
	m = elastic()
	r = np.random.default_rng(2)

	def velocity(k, x, y):
		return 1e-5 * m.cS * np.array((np.cos(300 * x) * np.sin(200 * y), np.sin(250 * x + 200 * y))) + 1e-7 * m.cS * r.standard_normal((2, *x.shape))

	return drift(watchedGrid([(m, 14, 14)], velocity, dtFactor=factor, hourglass=0.), steps, factor)


def freeCoupled(factor, steps):
	m = elastic(**DAMPED)
	velocity = lambda x, y: (1e-4 * m.cS * np.sin(180 * x), 1e-4 * m.cS * np.cos(300 * y))
	s = trials.halves(m, 10 * PITCH, 8, 10, velocity=velocity, rotate=0.4, factor=factor, account=True)
	return drift(Watch(s, [(0, m)]), steps, factor)


def shortestWave(p, x, waves):
	"""Largest amplitude of the complex arrays `waves` in p over the mean of p; see the head of this module."""
	w = np.sin(math.pi * (x - x.min()) / np.ptp(x))**2
	rest = p - np.polyval(np.polyfit(x, p, 1), x)
	size = [(1. if np.isrealobj(e) else 2.) * abs(np.sum(w * rest * np.conj(e))) / w.sum() for e in waves]
	return float(max(size) / np.sum(w * p) * w.sum())


def metal(**changes):
	m = material('OFHC_Cu', eos='shockAdiabat', yieldModel='perfect', **changes)
	m.yieldStress = 0.01 * m.density * m.bulkSoundSpeed**2
	return m


def automataNoise(angle, **options):
	"""A piston drives a shock into a bar of noisy packing, in uniaxial strain."""
	viscosity = options.pop('viscosity', {})
	m = metal(**viscosity)
	bar = trials.bar(m, 120 * D, angle=angle, rows=24, account=True, contacts=False, **options)
	p = bar.packings['bar']
	noisy = jittered(p, NOISE, 4).positions
	for i, (x, y) in zip(bar.ids['bar'].tolist(), noisy.tolist()):
		omega().bodies[i].state.pos = (x, y, 0)
	scenes.driveEnd(bar, 'bar', SPEED * m.bulkSoundSpeed)
	t = Watch(bar)
	speed = m.bulkSoundSpeed * (1 + m.hugoniotSlope * SPEED)
	t.run(until=80 * D / speed)
	n1, n2 = p.lattice[:, 0] - p.lattice[:, 1] // 2, p.lattice[:, 1]
	x, P = bar.field('bar', 'x'), bar.field('bar', 'pressure')
	front = 80 * D
	keep = scenes.middle(p) & (x > 0.35 * front) & (x < 0.8 * front)
	waves = [(-1.)**n for n in (n1, n2, n1 + n2)] + [np.exp(2j * math.pi * (n1 - n2) / 3)]
	return t.measures(value=shortestWave(P[keep], x[keep], [w[keep] for w in waves]), unit='shortest wave over the mean pressure')


def gridNoise(viscosity=None, **block):
	m = metal(**(viscosity or {}))
	s = trials.grid()
	g = s.grid
	x, y = np.meshgrid(np.arange(121) * D, np.arange(17) * D)
	r = np.random.default_rng(4).uniform(-NOISE, NOISE, (2, 17, 121)) * D
	r[:, :, (0, -1)] = 0
	r[1][(0, -1), :] = 0
	g.addBlock(m, x + r[0], y + r[1], **block)
	g.symmetry(0, 'bottom')
	g.symmetry(0, 'top')
	g.prescribe(0, 'left', x=SPEED * m.bulkSoundSpeed)
	t = Watch(s, [(0, m)])
	speed = m.bulkSoundSpeed * (1 + m.hugoniotSlope * SPEED)
	t.run(until=80 * D / speed)
	P, xs = g.view(0, 'pressure'), g.view(0, 'x')
	centre = 0.25 * (xs[1:, 1:] + xs[1:, :-1] + xs[:-1, 1:] + xs[:-1, :-1])
	front = 80 * D
	keep = (centre > 0.35 * front) & (centre < 0.8 * front)
	j, i = np.indices(P.shape)
	waves = [(-1.)**n for n in (i, j, i + j)]
	return t.measures(value=shortestWave(P[keep], centre[keep], [w[keep] for w in waves]), unit='shortest wave over the mean pressure')


def cases(quick, seed):
	steps = 100000 if quick else 1000000
	found = [StressCase('drift/automata/dtFactor0.4', lambda: freeAutomata(0.4, steps), energy=SINGLE), StressCase('drift/coupled/factor0.4', lambda: freeCoupled(0.4, steps), energy=SINGLE),
	         StressCase('drift/grid/dtFactor0.3', lambda: freeGrid(0.3, steps), energy=SINGLE)]
	undamped = dict(viscosityLinear=0.)
	found.append(StressCase('drift/automata/noViscosity', lambda: freeAutomata(0.4, steps, **undamped), energy=SINGLE))
	for name, angle in (('', 0.), ('/turned', 0.35)):
		found.append(StressCase('drift/automata/noViscosity/triangles' + name, lambda a=angle: freeAutomata(0.4, steps, rim='triangles', angle=a, **undamped), energy=SINGLE))
	found.append(StressCase('drift/automata/noViscosity/inversePower', lambda: freeAutomata(0.4, steps, 'inversePower', **undamped), energy=SINGLE))
	if not quick:
		found += [StressCase('drift/automata/dtFactor0.9', lambda: freeAutomata(0.9, steps), energy=SINGLE), StressCase('drift/automata/shockAdiabat', lambda: freeAutomata(0.4, steps, eos='shockAdiabat'), energy=SINGLE)]
	none = dict(viscosityLinear=0., viscosityQuadratic=0.)
	for name, angle in (('along', 0.), ('across', 0.5 * math.pi)):
		found.append(StressCase('evenOdd/automata/%s' % name, lambda a=angle: automataNoise(a)))
		found.append(StressCase('evenOdd/automata/%s/noViscosity' % name, lambda a=angle: automataNoise(a, viscosity=none)))
		if not quick:
			for rule in 'inversePower', 'meanDistance':
				found.append(StressCase('evenOdd/automata/%s/%s' % (name, rule), lambda a=angle, r=rule: automataNoise(a, volumeRule=r), 'either'))
	for name, block in (('', {}), ('/hourglass0', dict(hourglass=0.)), ('/hourglass0.1', dict(hourglass=0.1)), ('/edgeViscosity', dict(edgeViscosity=True)), ('/noViscosity', dict(viscosity=none))):
		found.append(StressCase('evenOdd/grid' + name, lambda b=block: gridNoise(**b), 'either' if name == '/hourglass0' else 'held'))
	return found
