# SPDX-License-Identifier: GPL-2.0-or-later
"""The limit of stability itself, past the check: twice the reciprocal of the highest eigenfrequency of the engines' own forces, against the step they allow.

One step from the state with the velocities +w and -w, no matter how short, gives the accelerations' derivative along w. Arnoldi's method finds from such
products the eigenvalue of largest size; leapfrog is stable to dt = 2/omega. Elastic, without viscosity.
"""
import math

import numpy as np
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigs

from ..._yade import scene as omega
from ...packings import Rectangle, addBodies, disc, hexagonal
from .. import trials
from ..trials import D, elastic
from .judge import StressCase
from .watch import jittered, watchedAutomata

TINY = 1e-11  #: step of the products [s]


def largest(product, n):
	"""Largest |eigenvalue| of the linear map product(w) of n unknowns."""
	start = np.random.default_rng(7).standard_normal(n)
	try:
		return float(abs(eigs(LinearOperator((n, n), matvec=product, dtype=float), k=1, which='LM', v0=start, ncv=20, tol=1e-4, maxiter=60, return_eigenvectors=False)[0]))
	except ArpackNoConvergence as e:
		return float(abs(e.eigenvalues[0])) if len(e.eigenvalues) else math.nan


def automataLimit(packing, mat, stretch=(1., 1.), **options):
	"""(measured, predicted) largest stable step [s] of a free body whose lattice is stretched."""
	n = len(packing)
	mid = packing.positions - packing.positions.mean(axis=0)
	offset = mid * (np.asarray(stretch, float) - 1)
	dt = TINY
	limit = None

	def accelerations(w):
		"""After one step with the velocities w (3n: x, y, R spin)."""
		nonlocal limit
		t = watchedAutomata(contacts=False, adaptive=False, account=False, sleeping=False, **options)
		o = omega()
		o.dt = dt
		first = np.concatenate((offset / dt, np.zeros((n, 1))), axis=1) if offset.any() else w.reshape(n, 3)
		ids = addBodies(packing, mat, velocity=first[:, :2])
		states = [o.bodies[i].state for i in ids]

		def give(v):
			for s, (vx, vy, spin) in zip(states, v.tolist()):
				s.vel, s.angVel = (vx, vy, 0.), (0., 0., spin / (0.5 * D))

		if offset.any():
			o.step()
			t.automata.sync()
		give(w.reshape(n, 3))
		t.automata.reload()
		o.step()
		before = velocities(t)
		o.step()
		limit = t.automata.criticalTimeStep
		return (velocities(t) - before).ravel() / dt

	def velocities(t):
		return np.stack((t.automata.field('vx'), t.automata.field('vy'), 0.5 * D * t.automata.field('omega')), axis=1)

	def product(w):
		size = 1e-3 / max(abs(w).max(), 1e-300)
		return (accelerations(-size * w) - accelerations(size * w)) / (2 * size * dt)

	top = largest(product, 3 * n)
	return 2 / math.sqrt(top), limit


def gridLimit(shape, mat, distortion=0., stretch=(1., 1.), **options):
	"""(measured, predicted) largest stable step [s] of a free block of cells; distortion: of inner nodes, in cells; stretch: of the cells (their rest shape)."""
	nx, ny = shape
	gx, gy = np.meshgrid(np.arange(nx + 1) * D * stretch[0], np.arange(ny + 1) * D * stretch[1])
	r = np.random.default_rng(5).uniform(-distortion, distortion, (2, ny + 1, nx + 1)) * D
	r[:, (0, -1), :] = r[:, :, (0, -1)] = 0
	limit = None

	def accelerations(w):
		nonlocal limit
		o, g = omega(), trials.grid(adaptive=False, account=False, sleeping=False).grid
		g.addBlock(mat, gx + r[0], gy + r[1], **options)
		g.setVelocity(0, w.reshape(ny + 1, nx + 1, 2))
		o.dt = TINY
		limit = g.criticalTimeStep
		o.step()
		before = np.stack((g.view(0, 'vx'), g.view(0, 'vy')), axis=-1)
		o.step()
		return (np.stack((g.view(0, 'vx'), g.view(0, 'vy')), axis=-1) - before).ravel() / TINY

	def product(w):
		size = 1e-3 / max(abs(w).max(), 1e-300)
		return (accelerations(-size * w) - accelerations(size * w)) / (2 * size * TINY)

	top = largest(product, 2 * (nx + 1) * (ny + 1))
	return 2 / math.sqrt(top), limit


def verdict(found):
	"""The real limit must not lie below the predicted one."""
	measured, predicted = found
	return dict(value=measured / predicted, atLeast=1., unit='measured / predicted limit')


def cases(quick, seed):
	body = lambda angle, rim='full': hexagonal(D, Rectangle((0, 0), (10 * D, 10 * D)), angle=angle, rim=rim)
	found = []
	add = lambda name, run: found.append(StressCase('limit/' + name, lambda: verdict(run())))
	for nu in (0., 0.3, 0.49):
		add('automata/nu%g' % nu, lambda nu=nu: automataLimit(body(0.), elastic(poisson=nu)))
	for degrees in (0, 17):
		add('automata/weightedRim/%ddeg' % degrees, lambda a=math.radians(degrees): automataLimit(body(a, 'cells'), elastic()))
	add('automata/weightedRim/disc', lambda: automataLimit(hexagonal(D, disc((0, 0), 4.3 * D), angle=0.3), elastic()))
	add('automata/noise10%', lambda: automataLimit(jittered(body(0.3), 0.1, seed), elastic()))
	for name, stretch in (('compressed20%', (0.8, 1.)), ('compressedBoth20%', (0.9, 0.9)), ('stretched10%', (1.1, 1.))):
		add('automata/' + name, lambda s=stretch: automataLimit(body(0.), elastic(eos='shockAdiabat'), s))
	if not quick:
		for rule in 'inversePower', 'meanDistance':
			add('automata/' + rule, lambda r=rule: automataLimit(body(0.), elastic(), volumeRule=r))
	for nu in (0., 0.3, 0.49):
		add('grid/nu%g' % nu, lambda nu=nu: gridLimit((12, 12), elastic(poisson=nu)))
	add('grid/distorted25%', lambda: gridLimit((12, 12), elastic(), 0.25))
	add('grid/cells1to4', lambda: gridLimit((12, 12), elastic(), 0., (1., 4.)))
	add('grid/hourglass4', lambda: gridLimit((12, 12), elastic(), hourglass=4.))
	add('grid/hourglass0', lambda: gridLimit((12, 12), elastic(), hourglass=0.))
	return found
