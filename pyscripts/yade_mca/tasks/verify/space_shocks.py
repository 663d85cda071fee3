# SPDX-License-Identifier: GPL-2.0-or-later
"""Plastic shocks before a piston in space, in four directions of the packing, against the exact solution of the jump conditions.

The column is periodic across: around the automata inside is a skin of their images, so that whoever is inside has all its neighbours. Forces from outside
(O.forces) keep an image where the automaton is whose image it is: they give it the acceleration which that one is about to have, by the two steps before, less
what it has by itself, and take away in one step what it is off. All are free in all directions. The volume filter, which reaches further than the skin, is off.
"""
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from ..._yade import scene as omega
from ...packings import Box, fcc
from .. import trials
from ..trials import D, triples
from .automata_shocks import piston
from .space_elastic import DIRECTIONS

#: periods across, along y and z, of the packing that stands as DIRECTIONS says [d]
PERIODS = {'100': (1., 1.), '110': (2**0.5, 1.), '111': (1., 3**0.5), '123': (10**0.5, 35**0.5)}
LENGTH, SKIN, DRIVEN = 175., 2.05, 3.2  #: of the column, of the images around it, and of the piston [d]
NOISE = 1e-3  #: largest displacement at the start [d]: without it symmetry would hide what scatters
STEP = 0.2  #: share of the largest stable step: from 0.25 on the forces on the images are too coarse and may run away
READS = 6  #: positions of the front through which a straight line is laid
VISCOSITY = (0.5, 2.)  #: linear and quadratic, of a scalar viscosity in space


#: direction and speed of the piston over c0: in a short run, and what a common one has besides
QUICK, SOME = (('100', 0.1), ), (('110', 0.05), ('111', 0.2), ('123', 0.1))


def only(packing, which):
	"""The automata `which` (bool (N,)) of a SpacePacking."""
	return replace(packing, **{name: getattr(packing, name)[which] for name in ('positions', 'weight', 'lattice', 'mirrors')})


class Column:
	"""A column of copper along x, periodic across, whose left end is driven at `share` of c0: see automata_shocks.piston()."""

	def __init__(self, direction, share, length=LENGTH):
		m, self.speed, self.reference = piston(share)
		m.viscosityLinear, m.viscosityQuadratic = VISCOSITY
		self.length, period, off = length * D, np.array(PERIODS[direction]) * D, 1e-3 * D  # off: nobody stands on a border
		half = 0.5 * period + SKIN * D
		p = fcc(D, Box((0, *(off - half)), (self.length, *(off + half))), orientation=DIRECTIONS[direction], origin=(0, 0, 0))
		p = only(p, np.linalg.norm(np.maximum(abs(p.positions[:, 1:] - off) - 0.5 * period, 0), axis=1) < SKIN * D)
		shift = np.round((p.positions - (0, off, off)) / (1., *period)) * (0., *period)
		inside = (shift == 0).all(axis=1)
		far, of = cKDTree(p.positions[inside]).query(p.positions - shift)
		if far.max() > 1e-6 * D: raise RuntimeError('the periods of [%s] are not those of the packing' % direction)
		twin, self.at, pushed = np.flatnonzero(inside)[of], p.positions[:, 0], p.positions[:, 0] < DRIVEN * D
		noise = NOISE * D * np.random.default_rng(1).uniform(-1, 1, (len(p), 3)) * ~pushed[:, None]
		self.run = trials.automata(contacts=False, readForces=True, dtFactor=STEP, volumeFilter=0.)
		self.ids = self.run.add('column', replace(p, positions=p.positions + noise[twin]), m, velocity=np.where(pushed[:, None], (self.speed, 0., 0.), 0.))
		self.run.block(self.ids[pushed], 'xyzXYZ')
		self.middle = np.flatnonzero(inside)[np.argsort(self.at[inside], kind='stable')]
		self.images = np.flatnonzero(~inside & ~pushed)
		self.twin, self.shift = twin[self.images], shift[self.images]
		self.mass, self.inertia = p.masses(m.density)[0], p.inertias(m.density)[0]
		self.before = np.zeros((2, len(p), 6))  # velocities and spins of the step before, accelerations of it
		self.before[0, pushed, 0] = self.speed
		self.pull = np.zeros((len(self.images), 6))  # accelerations that the images get from outside
		omega().step()
		self.dt = omega().dt
		self.before[0] = np.concatenate(triples(self.run, 'v', 'omega'), axis=1)

	def step(self):
		"""A step, and the forces on the images for the next one."""
		omega().step()
		dt = omega().dt
		x, *motion = triples(self.run, 'x', 'v', 'omega')
		v = np.concatenate(motion, axis=1)
		a, k, t = (v - self.before[0]) / (0.5 * (dt + self.dt)), self.images, self.twin
		own = a[k] - self.pull
		off = (v[t] - v[k]) / dt
		off[:, :3] += (x[t] + self.shift - x[k]) / dt**2
		self.pull = 2 * a[t] - self.before[1][t] - own + off
		self.dt, self.before = dt, np.stack((v, a))
		forces, moving = omega().forces, np.flatnonzero((v[t] != 0).any(axis=1))
		rows = zip(self.ids[k[moving]].tolist(), (self.mass * self.pull[moving, :3]).tolist(), (self.inertia * self.pull[moving, 3:]).tolist())
		for i, force, torque in rows:
			forces.setPermF(i, force)
			forces.setPermT(i, torque)

	def off(self):
		"""Largest distance of an image from where it should be [d]."""
		x = triples(self.run, 'x')
		return abs(x[self.twin] + self.shift - x[self.images]).max() / D

	def profile(self, name):
		"""Place at the start and values of a field in the middle of the column, sorted along it."""
		return self.at[self.middle], self.run.automata.field(name)[self.middle]

	def front(self, level):
		"""Place in the material where the mean velocity over three spacings has come to `level`, from the right."""
		x, v = self.profile('vx')
		z = np.arange(self.length / D - 4, DRIVEN, -0.25) * D
		sums = np.concatenate(((0., ), np.cumsum(v)))
		low, high = np.searchsorted(x, z - 1.5 * D), np.searchsorted(x, z + 1.5 * D)
		mean = (sums[high] - sums[low]) / np.maximum(high - low, 1)
		k = int(np.argmax(mean > level))
		return z[k] + (z[k - 1] - z[k]) * (mean[k] - level) / (mean[k] - mean[k - 1])


def shocked(direction, share, length=LENGTH):
	"""Speed of the plastic shock over the material, mean pressure behind it, its relative scatter, largest distance of an image from its place, and the exact solution."""
	c = Column(direction, share, length)
	ref, found = c.reference, []
	before = ref['precursorU'] if ref['waves'] == 'two' else 0.
	end, level = 0.8 * c.length / max(ref['precursorD'], ref['D']), 0.5 * (c.speed + before)
	for part in np.linspace(0.5, 1., READS):
		while omega().time < part * end:
			c.step()
		found.append((omega().time - 0.5 * omega().dt, c.front(level)))  # velocities are half a step late
	found = np.array(found)
	x, P = c.profile('pressure')
	start, front = DRIVEN * D, found[-1, 1]
	P = P[(x > start + 0.35 * (front - start)) & (x < start + 0.8 * (front - start))]
	return np.polyfit(found[:, 0], found[:, 1], 1)[0], P.mean(), P.std() / P.mean(), c.off(), ref


def materialSpeed(ref, density):
	"""Speed of the plastic shock over the material at rest [m/s] of a solution of exact.piston(): the mass that it takes in over the density at rest."""
	return (ref['D'] - ref['precursorU']) * ref['precursorRho'] / density


def shock(report, want, direction, share):
	"""One piston into copper with strength: speed over the material, and pressure behind."""
	name = 'space/hugoniot/%s/U%.2f' % (direction, share)
	if not want(name): return
	speed, P, scatter, off, ref = shocked(direction, share)
	report.add(name + '/speed', speed, materialSpeed(ref, piston(share)[0].density), limit=0.01, unit='m/s')
	report.add(name + '/pressure', P, ref['P'], limit=0.005, unit='Pa')
	report.add(name + '/scatter', scatter, 0., unit='rms of the pressure')
	report.add(name + '/images', off, 0., limit=1e-4, unit='d')


def hugoniot(report, want, quick):
	"""Four directions, three strengths of shock between them."""
	for direction, share in QUICK if quick else QUICK + SOME: shock(report, want, direction, share)


def others(report, want, quick):
	"""The other pairs of strength and direction."""
	for direction in PERIODS:
		for share in (0.05, 0.1, 0.2):
			if (direction, share) not in QUICK + SOME: shock(report, want, direction, share)


CASES = [hugoniot]
LONG = [others]
