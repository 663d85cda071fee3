# SPDX-License-Identifier: GPL-2.0-or-later
"""What the cases of `verify automata` share: a scene with one McaEngine, bars in uniaxial strain, profiles, fronts."""
import math
from dataclasses import replace

import numpy as np

from .. import materials
from .._yade import yadeClass
from ..packings import Rectangle, addBodies, hexagonal

PITCH = 0.5 * math.sqrt(3)  #: distance of close-packed rows over the spacing


def material(name, **overrides):
	"""McaMat of the library; `viscosity` sets both coefficients at once as a pair."""
	if 'viscosity' in overrides:
		overrides['viscosityLinear'], overrides['viscosityQuadratic'] = overrides.pop('viscosity')
	return materials.mcaMat(name, **overrides)


def steel(**changes):
	"""Linear elastic steel with Poisson's ratio 0.3 and no viscosity."""
	options = dict(eos='linear', yieldModel='elastic', viscosity=(0., 0.))
	options.update(changes)
	m = material('4340', **options)
	m.shearModulus = 3 * m.density * m.bulkSoundSpeed**2 * (1 - 0.6) / (2 * 1.3)
	return m


#: plastic flow, scattered fracture and friction at once
HARD = dict(yieldModel='linearHardening', yieldStress=0.8e9, hardeningModulus=0.5e9, fractureStrain=0.12, spallStrength=2.5e9, strengthSpread=0.1, frictionAngle=0.2)


def impactBlocks(speed=400., n=10, **changes):
	"""A block of n/2 by 0.6 n spacings of 1 mm flies obliquely into another one of n by n, both of steel HARD with `changes`. Returns the ids."""
	d, m = 1e-3, material('4340', **dict(HARD, **changes))
	a = addBodies(hexagonal(d, Rectangle((0, 0), (n * d, n * d))), m)
	b = addBodies(hexagonal(d, Rectangle((-0.82 * n * d, 0.1 * n * d), (0.5 * n * d, 0.6 * n * d)), angle=0.5 * math.pi), m, velocity=(speed, 0.2 * speed), mask=3)
	return a + b


class AutomataRun:
	"""An empty scene with one McaEngine of the given attributes."""

	def __init__(self, **attributes):
		from yade import O
		O.reset()
		self.O = O
		self.engine = yadeClass('McaEngine')(**attributes)
		O.engines = [self.engine]
		self.ids = {}

	def add(self, part, packing, mat, **options):
		self.ids[part] = np.array(addBodies(packing, mat, **options))
		return self.ids[part]

	def block(self, ids, dofs):
		"""Blocks degrees of freedom of bodies for good; those out of the plane are always blocked."""
		for i in np.asarray(ids).tolist():
			self.O.bodies[i].state.blockedDOFs = 'zXY' + dofs

	def move(self, ids, vx=None, vy=None, spin=None):
		"""Sets velocities; arrays or numbers."""
		for k, i in enumerate(np.asarray(ids).tolist()):
			s = self.O.bodies[i].state
			at = lambda v, old: old if v is None else float(np.broadcast_to(v, len(ids))[k])
			s.vel = (at(vx, s.vel[0]), at(vy, s.vel[1]), 0.)
			if spin is not None:
				s.angVel = (0., 0., at(spin, 0.))

	def steps(self, n, dt=None):
		"""n steps, of dt [s] each if given."""
		if dt is not None:
			self.engine.adaptive = False
			self.O.dt = dt
		if n * len(self.O.bodies) < 1e5:  # O.run() looks only every 40 ms whether it has come to its end
			for _ in range(n):
				self.O.step()
		else:
			self.O.run(n, True)

	def until(self, time):
		"""Runs to the first step that reaches `time` [s]."""
		if self.O.iter == 0:
			self.steps(1)
		while self.O.time < time:
			self.steps(max(1, int((time - self.O.time) / self.O.dt / 1.02)))

	def field(self, name, part=None):
		f = self.engine.field(name)
		return f if part is None else f[np.searchsorted(self.engine.ids, self.ids[part])]


class Bar(AutomataRun):
	"""Bodies side by side along x in uniaxial strain between two lines of mirror symmetry: what lies on them counts half and keeps its y.

	angle: 0 or 90 degrees between the close-packed rows and x; rows: height over the spacing, even.
	"""

	def __init__(self, spacing, angle, rows, **attributes):
		super().__init__(**attributes)
		self.spacing, self.angle = spacing, angle
		self.height = rows * spacing * (PITCH if angle == 0 else 1.)
		self.middle, self.columns = {}, {}

	def body(self, part, mat, start, length, **options):
		d, half = self.spacing, 0.5 * self.height
		p = hexagonal(d, Rectangle((start + 0.5 * length, 0), (length, 2 * half + 1e-6 * d)), angle=self.angle, origin=(start + (0.25 if self.angle == 0 else 0.5) * d, 0.), rim='full')
		p = p.translated((start + 0.5 * d - p.positions[:, 0].min() + (0. if self.angle == 0 else (PITCH - 1) * 0.5 * d), 0.))
		# corners: an automaton with two links measures no volume and carries no pressure; a plane wave needs none
		while (few := np.bincount(p.pairs().ravel(), minlength=len(p)) < 3).any():
			p = p.select(~few)
		y = abs(p.positions[:, 1])
		p = replace(p, weight=np.where(y > half - 0.1 * d, 0.5, 1.))
		ids = self.add(part, p, mat, **options)
		# the automata next to a line push along y with fewer links than the mirror image would give them: two rows are held
		self.block(ids[y > half - 2.1 * d], 'yZ')
		self.middle[part] = y < 0.5 * half
		self.end = p.positions[:, 0].max() + 0.5 * d
		return p

	def drive(self, part, p, vx):
		"""The columns within one spacing of the left end of `part` move with vx [m/s]."""
		ids = self.ids[part][p.positions[:, 0] < p.positions[:, 0].min() + 1.1 * self.spacing]
		self.block(ids, 'xyZ')
		self.move(ids, vx=vx)
		return ids

	def profile(self, part, *names):
		"""x and the fields of the middle rows of `part`, mean over the height in columns of one spacing of material, from left to right."""
		keep = self.middle[part]
		column = self._column(part)
		mean = lambda f: np.bincount(column, f[keep]) / np.bincount(column)
		return [mean(self.field(n, part)) for n in ('x', *names)]

	def _column(self, part):
		if part not in self.columns:
			x = np.array([self.O.bodies[int(i)].state.refPos[0] for i in self.ids[part]])[self.middle[part]]
			pitch = self.spacing * (1. if self.angle == 0 else PITCH)
			self.columns[part] = np.floor((x - x.min()) / pitch + 1e-6).astype(int)
		return self.columns[part]


def crossing(x, f, level):
	"""Position of the last point, from the left, where the falling profile f(x) crosses `level`, linearly interpolated."""
	k = np.nonzero((f[:-1] >= level) & (f[1:] < level))[0][-1]
	return x[k] + (x[k + 1] - x[k]) * (f[k] - level) / (f[k] - f[k + 1])


def between(x, f, a, b, margin=0.3):
	"""Mean of f(x) over [a, b] without `margin` of the length at each end."""
	keep = (x > a + margin * (b - a)) & (x < b - margin * (b - a))
	return float(np.mean(f[keep])) if keep.any() else math.nan


def order(errors, ratio=2.):
	"""Order of convergence from the last two errors."""
	return math.log(errors[-2] / errors[-1]) / math.log(ratio)
