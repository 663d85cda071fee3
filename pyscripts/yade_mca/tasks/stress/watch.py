# SPDX-License-Identifier: GPL-2.0-or-later
"""What the cases of `stress` share: running a Scene under watch, the measures by which a run is judged, two blocks that meet."""
import math
import time
from dataclasses import replace

import numpy as np

from ..._yade import scene as omega
from ...packings import Rectangle, addBodies, hexagonal
from .. import trials
from ..trials import D

STEPS = 40000  #: a run that needs more is given up
SPACE = ('x', 'y', 'z', 'vx', 'vy', 'vz', 'omegaX', 'omegaY', 'omegaZ', 'pressure', 'volumeRatio', 'equivalentStress', 'plasticStrain', 'temperature')  #: of automata in space
FIELDS = ('x', 'y', 'vx', 'vy', 'omega', 'pressure', 'volumeRatio', 'equivalentStress', 'plasticStrain', 'temperature')
VIEWS = ('x', 'y', 'vx', 'vy', 'pressure', 'sxx', 'syy', 'sxy', 'plasticStrain')


def fieldsOf(engine):
	"""Names of the fields that must be finite, of a McaEngine."""
	return SPACE if engine.dimension == 3 else FIELDS


class StressError(RuntimeError):
	"""A run that neither ends nor is refused."""


def jittered(packing, noise, seed=1):
	"""The packing with every automaton moved by up to `noise` spacings in x and in y."""
	if not noise:
		return packing
	shift = np.random.default_rng(seed).uniform(-noise, noise, packing.positions.shape)
	return replace(packing, positions=packing.positions + shift * packing.spacing)


def advance(n):
	"""n steps; raises what an engine refused. (O.run(n, True) looks only every 40 ms whether it is done.)"""
	o = omega()
	end = o.iter + n
	o.run(n, False)
	while o.running:
		time.sleep(2e-4)
	if o.iter < end:  # refused: once more in this thread, which gets the error (O.run may miss that of a run that ends at once)
		o.step()
		raise StressError('the run stopped at step %d without an error' % o.iter)


class Watch:
	"""Runs a Scene and keeps the largest errors of its balances.

	grids: list of (block, material) for the energy from the state of a grid alone. That state does not tell what was dissipated, nor the energy in
	hourglass patterns, so that for a grid alone only a surplus counts.
	"""

	def __init__(self, scene, grids=()):
		self.automata, self.grid, self.couplers, self.grids = scene.automata, scene.grid, scene.couplers, list(grids)
		self.first, self.worst, self.count = None, {}, None

	def balance(self):
		"""Energies [J/m] and momenta [N s/m] now.

		kinetic: of the velocities, half a step before the positions; the rest of the independent sum: late (of the present positions), early (of the
		positions one step before), level (of the same moment as the velocities); booked; px, py (impulses from outside taken off); given: work from outside.
		"""
		if self.automata is None:
			e = self.grid.energies()
			works, (volume, shape) = sum(e[k] for k in e if k.startswith('work')), self.stored()
			return dict(kinetic=e['kinetic'], late=volume, early=shape, level=-works, booked=e['total'], px=e['momentumX'] - e['impulseX'], py=e['momentumY'] - e['impulseY'], given=works)
		e = self.automata.energies()
		if self.couplers:
			e = self.couplers[0].energies()
		booked = e['booked' if self.couplers else 'bookedError']
		# the engine takes its sum to the time of the stresses itself
		return dict(kinetic=e['kinetic'], late=0., early=0., level=e['total'] - e['kinetic'], booked=booked, px=e['momentumX'] - e['impulseX'], py=e['momentumY'] - e['impulseY'],
		            pz=e.get('momentumZ', 0.) - e.get('impulseZ', 0.), given=e.get('external', 0.))

	def stored(self):
		"""Elastic energy of the grid from its state [J/m]: volumetric by (4) of the present cells, deviatoric s:s/4G."""
		volume = shape = 0.
		for block, m in self.grids:
			v = {k: self.grid.view(block, k) for k in ('x', 'y', 'sxx', 'syy', 'sxy', 'restArea')}
			x, y = v['x'], v['y']
			area = 0.5 * ((x[1:, 1:] - x[:-1, :-1]) * (y[1:, :-1] - y[:-1, 1:]) - (x[1:, :-1] - x[:-1, 1:]) * (y[1:, 1:] - y[:-1, :-1]))
			volume += float(np.sum(v['restArea'] * storedVolumetric(m, area / v['restArea'] - 1)))
			if m.shearModulus > 0:
				shape += float(np.sum(area * (v['sxx']**2 + v['syy']**2 + (v['sxx'] + v['syy'])**2 + 2 * v['sxy']**2)) / (4 * m.shearModulus))
		return volume, shape

	def start(self):
		"""Takes the reference values; called by the first run."""
		b = self.balance()
		self.first = dict(b, total=sum(b[k] for k in ('kinetic', 'late', 'early', 'level')), scale=max(b['kinetic'], 1e-30), mass=self.mass())
		self.count = len(self.automata.ids) if self.automata is not None else 0
		self.worst = dict(energy=0., booked=0., momentum=0., growth=0.)

	def mass(self):
		total = float(self.automata.field('mass').sum()) if self.automata is not None else 0.
		return total + sum(m.density * float(self.grid.view(b, 'restArea').sum()) for b, m in self.grids)

	def sample(self):
		"""Two more steps, and the largest deviations so far.

		Velocities of the grid belong to half steps: their kinetic energy is added to the mean of the energies of the positions before and after it.
		"""
		three = [self.balance()]
		for _ in range(2):
			omega().step()
			three.append(self.balance())
		b, f, w = three[1], self.first, self.worst
		f['scale'] = max(f['scale'], b['given'])
		total = b['kinetic'] + b['level'] + 0.5 * (three[0]['late'] + b['late'] + b['early'] + three[2]['early'])
		surplus = (total - f['total']) / f['scale']
		now = dict(energy=max(surplus, 0.) if self.automata is None else abs(surplus), booked=abs(b['booked'] - f['booked']) / f['scale'],
		           momentum=math.hypot(*(b[k] - f[k] for k in ('px', 'py', 'pz') if k in b)) / math.sqrt(2 * f['mass'] * f['scale']), growth=b['kinetic'] / f['scale'])
		for k, v in now.items():
			w[k] = max(w[k], v) if v == v else math.nan  # a number that is not one stays

	def run(self, steps=None, until=None, every=50):
		"""So many steps, or to `until` [s]; raises StressError when that takes more than STEPS steps."""
		o = omega()
		if self.first is None:
			self.start()
		begin = o.iter
		while (o.iter - begin < steps) if until is None else (o.time < until):
			if until is not None and o.iter - begin > STEPS:
				raise StressError('%g s of %g s are reached after %d steps; the time step has fallen to %g s' % (o.time, until, STEPS, o.dt))
			advance(max(1, every - 2))
			self.sample()
		return self

	def finite(self):
		"""Every number of the state is one."""
		ok = self.automata is None or all(np.isfinite(self.automata.field(k)).all() for k in fieldsOf(self.automata))
		for b in range(len(self.grid.blocks) if self.grid is not None else 0):
			ok = ok and all(np.isfinite(self.grid.view(b, k)).all() for k in VIEWS)
		return bool(ok)

	def measures(self, **more):
		"""What the run is judged by: see judge.LIMITS. `more` is reported as it is."""
		d = dict(self.worst, finite=self.finite(), steps=omega().iter, time=omega().time, **more)
		if self.automata is not None:
			c = self.automata.counters()
			d.update(lost=self.count - len(self.automata.ids), deepest=c['deepest'], clamped=c['clamped'], brokenLinks=c['brokenLinks'])
		return d


def storedVolumetric(m, eps):
	"""Energy per rest volume [J/m3] of the pressure of (1) at the volume strain eps (array), linear in tension."""
	K, b = m.density * m.bulkSoundSpeed**2, 0. if m.eos == 'linear' else m.hugoniotSlope
	eps = np.asarray(eps, float)
	if b == 0:
		return 0.5 * K * eps**2
	u = b * np.minimum(eps, 0.)
	return np.where(eps >= 0, 0.5 * K * eps**2, K / b**2 * (np.log1p(u) + 1 / (1 + u) - 1))


def watchedAutomata(**attributes):
	"""Watch of no bodies and a McaEngine that keeps its account."""
	return Watch(trials.automata(**dict(dict(account=True), **attributes)))


def twoBlocks(flyer, target, speed, angle=0., targetAngle=None, slant=0., noise=0., seed=1, sizes=((12, 20), (24, 32)), joined=False, **options):
	"""Watch: a block flies to the right into a larger one at rest; sizes (width, height) in spacings, nearest automata just do not touch.

	flyer, target: materials; speed [m/s]; angle, targetAngle: of the rows [rad]; slant: of the flyer's velocity against x [rad]; noise: see jittered().
	joined: the flyer is bonded to the target by links (one lattice, one mask), speeds as above.
	"""
	t = watchedAutomata(**options)
	(fw, fh), (tw, th) = sizes
	targetAngle = angle if targetAngle is None else targetAngle
	velocity = (speed * math.cos(slant), speed * math.sin(slant))
	if joined:
		whole = jittered(hexagonal(D, Rectangle((0, 0), ((fw + tw) * D, fh * D)), angle=angle, rim='full'), noise, seed)
		left = whole.positions[:, 0] < (fw - 0.5 * (fw + tw)) * D
		for part, m, v in ((left, flyer, velocity), (~left, target, (0., 0.))):
			addBodies(whole.select(part), m, velocity=v)
		return t
	a = jittered(hexagonal(D, Rectangle((0, 0), (fw * D, fh * D)), angle=angle), noise, seed)
	b = jittered(hexagonal(D, Rectangle((0, 0), (tw * D, th * D)), angle=targetAngle), noise, seed + 1)
	addBodies(a.translated((-a.positions[:, 0].max() - 0.5 * D, 0)), flyer, velocity=velocity, mask=1)
	addBodies(b.translated((-b.positions[:, 0].min() + 0.5 * D, 0)), target, mask=2)
	return t


def transit(*mats, length=32 * D, times=4.):
	"""Time [s] in which P waves of the slowest material cross `length` so many times."""
	return times * length / min(m.cP for m in mats)


def watchedGrid(blocks, velocity=None, **options):
	"""Watch of a grid of rectangles side by side; blocks: list of (material, cells across, cells along y) of D; velocity(block, x, y) -> (vx, vy) arrays."""
	block = {k: options.pop(k) for k in ('hourglass', 'edgeViscosity') if k in options}
	s = trials.grid(**options)
	x, made = 0., []
	for m, nx, ny in blocks:
		xs, ys = x + np.arange(nx + 1) * D, np.arange(ny + 1) * D
		made.append((s.grid.addRectangle(m, xs.tolist(), ys.tolist(), **block), m, xs, ys))
		x = xs[-1]
	for k, m, xs, ys in made if velocity else ():
		gx, gy = np.meshgrid(xs, ys)
		s.grid.setVelocity(k, np.ascontiguousarray(np.stack(np.broadcast_arrays(*velocity(k, gx, gy)), axis=-1), float))
	return Watch(s, [(k, m) for k, m, _, _ in made])
