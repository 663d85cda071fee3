# SPDX-License-Identifier: GPL-2.0-or-later
"""A penetration scene on its way: samples of what the study reports, the end of the run, checkpoints. Files and pictures: impact_output.

    >>> s = scenes.penetration(thickness=25e-3, spacing=1e-3)
    >>> run = Impact(s)
    >>> while not run.finished:
    ...     run.advance()
    >>> run.last['lengthLoss'], run.last['velocityLossTail']

A run ends when the head of the rod is at least half a diameter beyond the plate's original rear face (measure.rearClearance, normal to the face) and the momentum of
all rod material has settled (measure.momentumSettled), or after `longest`; or at a time that was asked for. Time counts from the moment of contact.
"""
import math
import time

import numpy as np

from . import checkpoint, measure, scenes
from ._yade import scene as omega
from ._yade import steps

__all__ = ['Impact', 'ImpactError']

#: what each sample holds, SI units; energies per 1 m of thickness [J/m]
COLUMNS = ('time', 'step', 'dt', 'lengthLoss', 'lengthLossUnbroken', 'lengthLossGeometric', 'velocityLossTail', 'velocityLossAll', 'tailVelocity', 'allVelocity', 'tailMass', 'clearance', 'momentum',
           'kinetic', 'stored', 'plastic', 'viscous', 'friction', 'fracture', 'grid', 'total', 'booked', 'momentumX', 'momentumY', 'deepest', 'clamped',
           'brokenLinks', 'contacts', 'awake')
#: all that the scenes of this module run; a checkpoint with anything else (a PyRunner runs Python) is refused
ENGINES = ('McaTimeStepper', 'McaEngine', 'McaGridEngine', 'McaGridCoupler')


class ImpactError(RuntimeError):
	"""A run that cannot go on; the message says why."""


class Impact:
	"""Runs a scene of scenes.penetration() and keeps the record. The engines' account should be on (scenes.penetration(account=True))."""

	def __init__(self, s, until=None, longest=150e-6, window=10e-6, tolerance=1e-3, period=None):
		"""s: Scene. until: end of the run [s], instead of the criterion. longest: end in any case [s].

		window, tolerance: the run has settled when the momentum of all rod material changed by at most `tolerance` of the impact momentum within `window` [s].
		period: steps between samples; default 20 mm/spacing, which is about 0.6 us.
		"""
		self.scene, self.until, self.longest, self.window, self.tolerance = s, until, longest, window, tolerance
		self.period = period or max(1, round(20e-3 / s.facts['spacing']))
		self.record = {k: [] for k in COLUMNS}
		self.stepSeconds = 0.  #: wall-clock time spent in steps since this process started
		self.startStep = omega().iter
		self.count = len(s.automata.ids)
		if until is not None and not 0 < until < math.inf:
			raise ImpactError('until must be above 0 and finite; got %r' % until)

	# ---- running

	def advance(self, samples=1):
		"""`samples` sampling periods of steps, each followed by a sample."""
		for _ in range(samples):
			if not self.record['time']:
				self._sample()
			start = time.perf_counter()
			self._steps(self.period)
			self.stepSeconds += time.perf_counter() - start
			self._sample()

	def _steps(self, n):
		if not steps(n):
			raise ImpactError('the run was stopped at step %d, %.3f us' % (omega().iter, 1e6 * omega().time))

	@property
	def time(self):
		"""Time of the positions [s]."""
		return omega().time

	@property
	def exited(self):
		"""True when the head of the rod is half a diameter beyond the plate's original rear face."""
		return self.last['clearance'] >= 0.5 * self.scene.facts['rodDiameter']

	@property
	def exitTime(self):
		"""Time at which the head was first half a diameter beyond the rear face [s], linear between samples; None before."""
		r = self.arrays()
		beyond = np.flatnonzero(r['clearance'] >= 0.5 * self.scene.facts['rodDiameter'])
		if not len(beyond):
			return None
		i = beyond[0]
		a, b = r['clearance'][i - 1:i + 1] if i else (r['clearance'][0], r['clearance'][0])
		return float(r['time'][i] - (r['time'][i] - r['time'][i - 1]) * (b - 0.5 * self.scene.facts['rodDiameter']) / (b - a)) if b > a else float(r['time'][i])

	@property
	def finished(self):
		if not self.record['time']:
			return False
		if self.until is not None:
			return self.time >= self.until
		return self.time >= self.longest or (self.exited and self.settled)

	@property
	def settled(self):
		r = self.record
		return measure.momentumSettled(r['time'], r['momentum'], self.window, self.tolerance)

	@property
	def reason(self):
		"""Why the run has ended, in words; '' while it goes on."""
		if not self.finished:
			return ''
		if self.until is not None:
			return 'time %g us reached' % (1e6 * self.until)
		return 'the rod has left the plate and keeps its momentum' if self.exited and self.settled else 'longest time %g us reached' % (1e6 * self.longest)

	# ---- what is recorded

	def _sample(self):
		s, o, r = self.scene, omega(), self.record
		f = s.fields('rod', ('mass', 'x', 'y', 'vx', 'vy', 'plasticStrain'))
		v, e, position = np.stack((f['vx'], f['vy']), axis=1), f['plasticStrain'], np.stack((f['x'], f['y']), axis=1)
		if not (np.isfinite(v).all() and np.isfinite(position).all()):
			raise ImpactError('not a number in the state of the rod at step %d' % o.iter)
		m = measure.rodMeasure(f['mass'], v, e, s.facts['speed'], s.facts['direction'])
		row = dict(m.asDict(), time=o.time, step=o.iter, dt=o.dt, clearance=measure.rearClearance(position, e, s.facts['rear'], s.facts['normal']))
		row['lengthLossGeometric'] = 1 - measure.geometricLength(position, e, 0.5 * s.facts['rodDiameter'], s.facts['direction']) / s.facts['restLength']
		row['momentum'] = m.allVelocity * self.rodMass
		a, c = s.automata.energies(), s.automata.counters()
		row.update({k: a[k] for k in ('plastic', 'viscous', 'friction', 'fracture')})
		row.update(kinetic=a['kinetic'], stored=a['volumetric'] + a['deviatoric'], grid=0., total=a['total'], booked=a['bookedError'], momentumX=a['momentumX'] - a['impulseX'],
		           momentumY=a['momentumY'] - a['impulseY'])
		if s.couplers:  # the sums of McaGridCoupler.energies(), without another look at all automata
			g = s.grid.energies()
			row.update(kinetic=a['kinetic'] + g['kinetic'], grid=g['internal'], total=a['total'] + g['total'], booked=a['bookedError'] + g['total'],
			           momentumX=a['momentumX'] + g['momentumX'] - (a['impulseX'] + g['impulseX']), momentumY=a['momentumY'] + g['momentumY'] - (a['impulseY'] + g['impulseY']))
		row.update({k: c.get(k, 0) for k in ('deepest', 'clamped', 'brokenLinks', 'contacts', 'awake')})
		for k in COLUMNS:
			r[k].append(float(row[k]))

	@property
	def rodMass(self):
		"""Mass of the rod [kg/m]."""
		if not hasattr(self, '_rodMass'):
			self._rodMass = float(self.scene.field('rod', 'mass').sum())
		return self._rodMass

	@property
	def impactEnergy(self):
		"""Kinetic energy of the rod before impact [J/m]."""
		return 0.5 * self.rodMass * self.scene.facts['speed']**2

	@property
	def last(self):
		"""The latest sample, dict."""
		return {k: v[-1] for k, v in self.record.items()}

	def arrays(self):
		"""The record as {name: numpy array (samples,)}."""
		return {k: np.array(v) for k, v in self.record.items()}

	def at(self, t):
		"""The quantities at time t [s], linear between samples; dict."""
		r = self.arrays()
		return {k: float(np.interp(t, r['time'], v)) for k, v in r.items()}

	def sane(self):
		"""Balances and counters so far, relative where there is a scale; dict.

		energyBooked    largest change of kinetic energy minus booked work, over the impact energy
		momentumBooked  largest change of momentum minus impulses from outside, over the rod's momentum before impact
		energySum       largest change of the sum of kinetic, stored, dissipated and given-away energy, each computed on its own, over the impact energy
		lost            automata that are gone; clamped: evaluations of the equation of state beyond its clamp; deepest: smallest distance / rest distance
		"""
		r = self.arrays()
		off = lambda v, scale: float(np.abs(v - v[0]).max() / scale) if len(v) else math.nan
		p = self.rodMass * self.scene.facts['speed']
		return dict(energyBooked=off(r['booked'], self.impactEnergy), energySum=off(r['total'], self.impactEnergy), momentumBooked=max(off(r['momentumX'], p), off(r['momentumY'], p)),
		            lost=self.count - len(self.scene.automata.ids), clamped=r['clamped'][-1], deepest=r['deepest'].min())

	# ---- checkpoints

	def save(self, path, extra=None):
		"""Writes a checkpoint from which load() goes on identically. `extra`: dict of the caller. Raises OSError when it cannot; an older file stays."""
		checkpoint.store(path, *self.packed(extra))

	def packed(self, extra=None):
		"""What save() writes, for checkpoint.store()."""
		s = self.scene
		facts = dict(scene=dict(facts=s.facts, blocks=s.blocks), run=dict(until=self.until, longest=self.longest, window=self.window, tolerance=self.tolerance, period=self.period),
		             extra=extra or {})
		arrays = {'record ' + k: v for k, v in self.arrays().items()}
		arrays.update({'ids ' + k: v for k, v in s.ids.items()})
		return checkpoint.pack(facts, arrays)

	@classmethod
	def load(cls, path, until=None):
		"""(Impact, extra) of a checkpoint; O becomes the saved scene. until: another end [s]. Raises checkpoint.CheckpointError, also when the scene holds other engines than ENGINES."""
		facts, arrays = checkpoint.read(path, ENGINES)
		engines = omega().engines
		find = lambda name: [e for e in engines if type(e).__name__ == name]
		s = scenes.Scene(automata=find('McaEngine')[0], grid=(find('McaGridEngine') or [None])[0], couplers=find('McaGridCoupler'),
		                 ids={k[4:]: v for k, v in arrays.items() if k.startswith('ids ')}, blocks=facts['scene']['blocks'], facts=facts['scene']['facts'])
		run = cls(s, **dict(facts['run'], **({} if until is None else dict(until=until))))
		run.record = {k: arrays['record ' + k].tolist() for k in COLUMNS}
		return run, facts['extra']
