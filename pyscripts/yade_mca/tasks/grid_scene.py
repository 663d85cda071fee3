# SPDX-License-Identifier: GPL-2.0-or-later
"""What the cases of `verify grid` share: a scene with one McaGridEngine, running it, and its energy and momentum."""
import math

import numpy as np

from .. import materials
from .._yade import yadeClass

BALANCE = 1e-12  #: largest relative error of energy and momentum


def material(name, **overrides):
	"""McaMat of the library; `viscosity` sets both coefficients at once as a pair."""
	if 'viscosity' in overrides:
		overrides['viscosityLinear'], overrides['viscosityQuadratic'] = overrides.pop('viscosity')
	return materials.mcaMat(name, **overrides)


class GridRun:
	"""An empty scene with one grid engine. `fixedStep` [s] switches the automatic time step off."""

	def __init__(self, **attributes):
		from yade import O
		O.reset()
		self.O = O
		self.engine = yadeClass('McaGridEngine')(**attributes)
		O.engines = [self.engine]
		self.start = None

	def steps(self, n, dt=None):
		"""n steps, of dt [s] each if given."""
		if self.start is None:
			self.start = self.engine.energies()
		if dt is not None:
			self.engine.adaptive = False
			self.O.dt = dt
		self.O.run(n, True)

	def until(self, time):
		"""Runs to the first step that reaches `time` [s]."""
		if self.start is None:
			self.steps(1)
		while self.engine.time < time:
			self.steps(max(1, int((time - self.engine.time) / self.O.dt / 1.02)))

	def exactly(self, time, courant):
		"""Runs to exactly `time` [s] with equal steps of at most `courant` times the largest stable one; returns dt."""
		n = math.ceil((time - self.engine.time) / (courant * self.engine.criticalTimeStep))
		dt = (time - self.engine.time) / n
		self.steps(n, dt)
		return dt

	def view(self, block, what):
		return self.engine.view(block, what)

	def centres(self, block):
		"""x, y [m] of the cells, each (rows, cells)."""
		mean = lambda f: 0.25 * (f[:-1, :-1] + f[:-1, 1:] + f[1:, :-1] + f[1:, 1:])
		return mean(self.view(block, 'x')), mean(self.view(block, 'y'))

	def density(self, block):
		"""rho/rho0 of the cells [-]."""
		x, y = self.view(block, 'x'), self.view(block, 'y')
		area = 0.5 * ((x[1:, 1:] - x[:-1, :-1]) * (y[1:, :-1] - y[:-1, 1:]) - (x[1:, :-1] - x[:-1, 1:]) * (y[1:, 1:] - y[:-1, :-1]))
		return self.view(block, 'restArea') / area

	def balance(self):
		"""Relative errors of energy and momentum since the start."""
		a, b = self.start, self.engine.energies()
		energy = max(b['kinetic'], a['kinetic']) + abs(b['internal']) + sum(abs(b[k]) for k in b if k.startswith('work'))
		# momenta are measured by |impulses| and by the largest the kinetic energy could hold
		momentum = abs(b['impulseX']) + abs(b['impulseY']) + math.sqrt(2 * self.mass() * max(b['kinetic'], a['kinetic']))
		off = math.hypot(b['momentumX'] - a['momentumX'] - b['impulseX'], b['momentumY'] - a['momentumY'] - b['impulseY'])
		return abs(b['total'] - a['total']) / energy, off / momentum

	def mass(self):
		"""Mass of the grid [kg/m], of the order of magnitude that a scale needs: that of its blocks at 1000 kg/m3 or more."""
		return sum(float(np.sum(self.view(k, 'restArea'))) for k in range(len(self.engine.blocks))) * 1e3

	def report(self, report, name):
		"""Adds the balance of this run."""
		energy, momentum = self.balance()
		report.add(name + '/energyError', energy, 0., limit=BALANCE)
		report.add(name + '/momentumError', momentum, 0., limit=BALANCE)


def crossing(x, f, level):
	"""Position of the last point, from the left, where the falling profile f(x) crosses `level`, linearly interpolated."""
	k = np.nonzero((f[:-1] >= level) & (f[1:] < level))[0][-1]
	return x[k] + (x[k + 1] - x[k]) * (f[k] - level) / (f[k] - f[k + 1])


def order(errors, ratio=2.):
	"""Order of convergence from the last two errors."""
	return math.log(errors[-2] / errors[-1]) / math.log(ratio)


def delay(t1, f1, t2, f2):
	"""Time [s] by which signal 2 trails signal 1: maximum of the cross-correlation, parabola through its top."""
	dt = min(np.median(np.diff(t1)), np.median(np.diff(t2)))
	t = np.arange(0., max(t1[-1], t2[-1]), dt)
	a, b = np.interp(t, t1, f1, 0, 0), np.interp(t, t2, f2, 0, 0)
	n = 2 * len(t)
	c = np.fft.irfft(np.fft.rfft(b, n) * np.conj(np.fft.rfft(a, n)), n)[:len(t)]
	k = int(np.argmax(c))
	y0, y1, y2 = c[k - 1], c[k], c[k + 1]
	return dt * (k + 0.5 * (y0 - y2) / (y0 - 2 * y1 + y2))
