# SPDX-License-Identifier: GPL-2.0-or-later
"""Balances of the automata: action and reaction, momenta, energy over a long run and with everything that dissipates."""
import math

import numpy as np

from ..._yade import scene as omega
from ...packings import disc, hexagonal
from .. import trials
from ..trials import D, elastic, impactBlocks, order

SPIN, VIBRATION = 1e-3, 1e-4  #: speeds in the long run, of the rim and of the random motion, over the shear wave speed [-]


def reaction(report, want, quick):
	"""400 pairs far from each other, half of them linked, half in contact, moving at random: the two forces of each are opposite to the last bit."""
	for rule in ('affine', 'inversePower', 'meanDistance'):
		name = 'reaction/' + rule
		if not want(name): continue
		run = trials.automata(volumeRule=rule)
		rng = np.random.default_rng(4)
		m = elastic(poisson=0.3, yieldModel='perfect', yieldStress=0.5e9, viscosity=(0.25, 1.2), frictionAngle=0.3)
		one = hexagonal(D, disc((0, 0), 0.6 * D), rim='full')
		ids = []
		for k in range(400):
			at, angle = np.array((10 * D * (k % 20), 10 * D * (k // 20))), rng.uniform(0, 2 * math.pi)
			away = at + D * rng.uniform(0.9, 1.1 if k % 2 else 0.99) * np.array((math.cos(angle), math.sin(angle)))
			for place, mask in ((at, 1), (away, 1 if k % 2 else 2)):
				ids.append(run.add('pair', one.translated(place), m, velocity=rng.normal(0, 100, 2), angularVelocity=rng.normal(0, 1e5), mask=mask)[0])
		order = np.searchsorted(np.sort(ids), ids)
		unequal, acted = 0, np.zeros(400, bool)
		for _ in range(5 if quick else 25):
			trials.steps(run, 1, 1e-8)
			for f in (run.automata.field(c)[order].reshape(-1, 2) for c in ('fx', 'fy')):
				unequal += int((f[:, 0] != -f[:, 1]).sum())
				acted |= f[:, 0] != 0
		report.add(name + '/unequalForces', unequal, 0, limit=0.)
		report.add(name + '/pairsThatAct', int(acted.sum()), passed=acted.sum() > 200)  # some part at once


def impactBalance(report, want, quick):
	"""A block strikes another one: plastic flow, heat, fracture, friction. Momenta, and both sums of the energy at the default step; the independent one at a half and a quarter of it."""
	if not want('impactBalance'): return
	drift = []
	for factor in (0.4, 0.2, 0.1):
		run = trials.automata(account=True, dtFactor=factor)
		ids = impactBlocks()
		trials.steps(run, 1)
		end = run.automata.energies()
		start, E = end, end['kineticStart']
		mass, x, v = run.automata.field('mass'), *(np.stack([run.automata.field(a), run.automata.field(b)]) for a, b in (('x', 'y'), ('vx', 'vy')))
		p, L = (mass * np.hypot(*v)).sum(), (mass * np.hypot(*x) * np.hypot(*v)).sum()
		worst = np.zeros(4)
		while omega().time < 1.2e-5:
			trials.steps(run, 20)
			end = run.automata.energies()
			off = (math.hypot(end['momentumX'] - start['momentumX'], end['momentumY'] - start['momentumY']) / p, abs(end['angularMomentum'] - start['angularMomentum']) / L,
			       abs(end['bookedError']) / E, abs(end['total'] - E) / E)
			worst = np.maximum(worst, off)
		drift.append(worst[3])
		if factor == 0.4:
			report.add('impactBalance/momentum', worst[0], 0., limit=1e-13, unit='of the momentum')
			report.add('impactBalance/angularMomentum', worst[1], 0., limit=1e-12, unit='of its terms')
			report.add('impactBalance/bookedEnergy', worst[2], 0., limit=1e-10, unit='of the kinetic energy')
			report.add('impactBalance/energySum', worst[3], 0., limit=1e-3, unit='of the kinetic energy')
			for what in ('plastic', 'viscous', 'friction', 'fracture'):
				report.add('impactBalance/share/' + what, end[what] / E, unit='of the kinetic energy')
			report.add('impactBalance/brokenLinks', run.automata.counters()['brokenLinks'], passed=run.automata.counters()['brokenLinks'] > 10)
	report.add('impactBalance/energySumAtHalfTheStep', drift[1], 0., order=order(drift[:2]), unit='of the kinetic energy', passed=drift[1] < drift[0])
	report.add('impactBalance/energySumAtAQuarter', drift[2], 0., order=order(drift[::2], 4.), unit='of the kinetic energy', passed=drift[2] < drift[1])


def longRun(report, want, quick):
	"""A spinning, vibrating elastic disc: total energy and momenta over a million steps."""
	if not want('longRun'): return
	run = trials.automata(contacts=False)
	p = hexagonal(D, disc((0, 0), 3.3 * D), rim='full')
	rng = np.random.default_rng(2)
	m = elastic(poisson=0.3)
	spin = SPIN * m.cS / (3 * D)
	v = spin * np.stack((-p.positions[:, 1], p.positions[:, 0]), axis=1) + VIBRATION * m.cS * rng.standard_normal((len(p), 2))
	v -= v.mean(axis=0)
	run.add('body', p, m, velocity=v, angularVelocity=spin)
	trials.steps(run, 1, 0.4 * 0.5 * D / m.cP)
	n, samples = 100000 if quick else 1000000, 100
	start = run.automata.energies()
	scale = math.sqrt(2 * start['kinetic'] * run.automata.field('mass').sum())

	def mean():
		"""Energy averaged over some oscillations: velocities are half a step behind the positions."""
		total = []
		for _ in range(samples):
			trials.steps(run, 37)
			e = run.automata.energies()
			total.append(e['kinetic'] + e['volumetric'] + e['deviatoric'])
		return np.mean(total)

	energy = [mean()]
	trials.steps(run, n - omega().iter)
	energy.append(mean())
	end = run.automata.energies()
	unit = 'over %g steps' % n
	report.add('longRun/energyDrift', energy[-1] / energy[0] - 1, 0., limit=1e-4, unit=unit)
	report.add('longRun/momentum', math.hypot(end['momentumX'] - start['momentumX'], end['momentumY'] - start['momentumY']) / scale, 0., limit=1e-13, unit=unit)
	report.add('longRun/angularMomentum', end['angularMomentum'] / start['angularMomentum'] - 1, 0., limit=1e-12, unit=unit)
	report.extra.setdefault('automata', {})['longRunTurns'] = float(abs(run.automata.field('angle')).mean() / (2 * math.pi))


CASES = [reaction, impactBalance, longRun]
