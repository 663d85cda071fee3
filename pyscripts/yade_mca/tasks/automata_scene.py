# SPDX-License-Identifier: GPL-2.0-or-later
"""What the cases of `verify automata` share: running a scene of yade_mca.scenes, bars in uniaxial strain, fronts."""
import math

import numpy as np

from .. import materials, scenes
from ..packings import Rectangle, addBodies, hexagonal


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
	"""A scene of automata that is run: an empty one with a McaEngine of the given attributes, or that of a builder, `scene`."""

	def __init__(self, scene=None, **attributes):
		from yade import O
		self.O = O
		if scene is None:
			O.reset()
			scene = scenes.start(attributes)
		self.scene, self.engine, self.ids = scene, scene.automata, scene.ids
		self.add, self.block = scene.add, scene.block

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
		return self.engine.field(name) if part is None else self.scene.field(part, name)


class Bar(AutomataRun):
	"""Bodies side by side along x in uniaxial strain, scenes.strip(); angle: 0 or pi/2 between the close-packed rows and x; rows: height over the distance of rows, even."""

	def __init__(self, spacing, angle, rows, **attributes):
		super().__init__(**attributes)
		self.spacing, self.angle, self.rows = spacing, angle, rows

	def body(self, part, mat, start, length, **options):
		scenes.addStrip(self.scene, part, scenes.strip(self.spacing, start, length, self.rows, self.angle), mat, **options)
		return self.scene.packings[part]

	def drive(self, part, vx):
		"""The columns within one spacing of the left end of `part` move with vx [m/s]."""
		return scenes.driveEnd(self.scene, part, vx)

	def profile(self, part, *names):
		return scenes.profile(self.scene, part, *names)


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
