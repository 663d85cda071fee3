# SPDX-License-Identifier: GPL-2.0-or-later
"""Automata in space: time step and the limit of stability itself, impacts, materials at their ends, long runs, random scenes."""
import math
from dataclasses import replace

import numpy as np

from ..._yade import scene as omega
from ...packings import Ball, Box, Cylinder, addBodies, fcc
from ..trials import D, elastic, give, material, triples
from .impact import BREAKS, PAIRS, SPEEDS, UNBROKEN
from .judge import REFUSED, StressCase, energyBound
from .limit import TINY, largest, verdict
from .long import SINGLE, drift
from .random import BOUND, matter
from .random import describe as describePlane
from .step import ABOVE, BELOW, fixedStep
from .watch import transit, watchedAutomata


def turn(seed):
	"""A rotation (3, 3) of random direction."""
	q, t = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
	q *= np.sign(np.diag(t))
	return q if np.linalg.det(q) > 0 else -q


def vibrating(mat, noise=1e-3):
	t, p = watchedAutomata(contacts=False, adaptive=False), fcc(D, Ball((0, 0, 0), 5.2 * D), orientation=turn(2))
	x, r = p.positions / (5 * D), np.random.default_rng(3)
	addBodies(p, mat, velocity=np.stack((np.sin(2 * x[:, 0]) * np.cos(x[:, 1]), np.cos(2 * x[:, 2]), 0.7 * np.sin(x[:, 1])), axis=1) + noise * r.uniform(-1, 1, x.shape))
	return t


def limit(mat):
	"""(measured, predicted) largest stable step [s] of a rough ball: see limit.automataLimit()."""
	p, predicted = fcc(D, Ball((0, 0, 0), 3.2 * D), orientation=turn(5)), None
	n, arm = len(p), np.sqrt(p.inertias(1.) / p.masses(1.))[:, None]  # turns times this are displacements

	def accelerations(w):
		nonlocal predicted
		t = watchedAutomata(contacts=False, adaptive=False, account=False, sleeping=False)
		omega().dt = TINY
		w = w.reshape(n, 6)
		ids = addBodies(p, mat, velocity=w[:, :3])
		give(ids, spin=w[:, 3:] / arm)
		state = lambda: np.concatenate((lambda v, s: (v, s * arm))(*triples(t, 'v', 'omega')), axis=1)
		omega().step()
		before = state()
		omega().step()
		predicted = t.automata.criticalTimeStep
		return (state() - before).ravel() / TINY

	def product(w):
		size = 1e-3 / max(abs(w).max(), 1e-300)
		return (accelerations(-size * w) - accelerations(size * w)) / (2 * size * TINY)

	return 2 / math.sqrt(largest(product, 6 * n)), predicted


def collision(a, b, speed, seed=1, slant=0.3, size=3.2, noise=0., **options):
	"""Watch: a ball flies obliquely into a block; size of the ball in spacings, noise: largest displacement at the start, in spacings."""
	t, r = watchedAutomata(**options), np.random.default_rng(seed)
	ball = fcc(D, Ball((0, 0, 0), size * D), orientation=turn(seed))
	block = fcc(D, Box((0, -4.5 * D, -4.5 * D), (5 * D, 4.5 * D, 4.5 * D)), orientation=turn(seed + 1))
	shaken = lambda p: replace(p, positions=p.positions + noise * D * r.uniform(-1, 1, p.positions.shape))
	ball, block = shaken(ball), shaken(block)
	v = speed * np.array((math.cos(slant), math.sin(slant) * math.cos(seed), math.sin(slant) * math.sin(seed)))
	addBodies(ball.translated((-ball.positions[:, 0].max() - 0.5 * D, 0, 0)), a, velocity=v, mask=1)
	addBodies(block.translated((0.5 * D - block.positions[:, 0].min(), 0, 0)), b, mask=2)
	return t


def impact(pair, speed):
	a, b = PAIRS[pair]()
	return collision(a, b, float(speed)).run(until=transit(a, b, length=12 * D)).measures()


def ofMaterial(**changes):
	m = material('4340', **dict(BREAKS, **changes))
	return collision(m, m, 500.).run(until=transit(m, length=12 * D)).measures()


def free(factor, steps):
	"""A rough cylinder that vibrates and turns, without viscosity. (With some, the sum drifts by what viscosity takes from turns near the limit of the step, up to 0.01 of it at 0.4.)"""
	t, m, p = watchedAutomata(contacts=False, dtFactor=factor), elastic(), fcc(D, Cylinder((0, 0, 0), (9 * D, 0, 0), 3 * D), orientation=turn(8))
	x = p.positions / D
	v = 1e-4 * m.cS * np.stack((np.sin(0.3 * x[:, 1]), np.cos(0.3 * x[:, 0]), np.sin(0.2 * x[:, 0] + 0.2 * x[:, 2])), axis=1)
	addBodies(p, m, velocity=v - v.mean(axis=0), angularVelocity=(1e-5 * m.cS / D, ) * 3)
	return drift(t, steps, factor)


def random(seed, k):
	"""The random scene number k of a seed of the plane (materials, speed, slant, noise, step), with a ball and a block in space."""
	d = describePlane(seed, k)
	a, b = matter(d['flyer']), matter(d['target'])
	t = collision(a, b, d['speed'], seed + k, math.radians(d['slant']), 2.2 + 0.1 * min(d['flyer']['size']), d['flyer']['noise'], dtFactor=d['dtFactor'])
	words = '%s %s on %s %s, %g m/s at %g deg, dt %g' % (*(d[p][q] for p in ('flyer', 'target') for q in ('metal', 'yieldModel')), d['speed'], d['slant'], d['dtFactor'])
	return t.run(until=transit(a, b, length=12 * D, times=3.)).measures(scene=words)


def cases(quick, seed):
	found, steps = [], 500 if quick else 5000
	add = lambda name, run, *judged, **more: found.append(StressCase('space/' + name, run, *judged, **more))
	for f in BELOW:
		add('step/%g' % f, lambda f=f: fixedStep(lambda: vibrating(elastic()), f, steps), energy=energyBound(f))
	for f in ABOVE:
		add('step/%g' % f, lambda f=f: fixedStep(lambda: vibrating(elastic()), f, steps), REFUSED)
	for nu in (0., 0.3, 0.45, 0.49):
		add('limit/nu%g' % nu, lambda nu=nu: verdict(limit(elastic(poisson=nu))))
	for pair in PAIRS:
		for speed in (300, 1520, 6000) if quick else SPEEDS:
			add('impact/%s/%dm/s' % (pair, speed), lambda p=pair, v=speed: impact(p, v), 'held' if speed <= (300 if pair in UNBROKEN else 1520) else 'either')
	for name, changes in {'nu0': dict(poisson=0.), 'nu0.45': dict(poisson=0.45), 'nu0.49': dict(poisson=0.49), 'yield1e6': dict(yieldModel='perfect', yieldStress=1e6),
	                      'yield1e12': dict(yieldModel='perfect', yieldStress=1e12), 'b0': dict(hugoniotSlope=0.), 'b3': dict(hugoniotSlope=3.)}.items():
		add('material/' + name, lambda c=changes: ofMaterial(**c), 'either' if name == 'yield1e6' else 'held')
	for factor in (0.4, 0.9):
		add('drift/noViscosity/%g' % factor, lambda f=factor: free(f, 5000 if quick else 50000), energy=SINGLE)
	for k in range(4 if quick else 20):
		add('random/%d' % k, lambda k=k: random(seed, k), 'either', BOUND)
	return found
