# SPDX-License-Identifier: GPL-2.0-or-later
"""What the cases of `verify interface` share: automata for x < 0, grid for x > 0 (or automata on both sides, as the reference), and running them."""
import math

import numpy as np

from dataclasses import replace

from .. import materials, packings
from .._yade import yadeClass

PITCH = 0.5 * math.sqrt(3)  #: distance of close-packed rows over the spacing
D = 1e-3  #: spacing of the automata [m]


def steel(**overrides):
	"""Elastic steel without viscosity; keywords override."""
	values = dict(eos='linear', yieldModel='elastic', viscosityLinear=0., viscosityQuadratic=0.)
	return materials.mcaMat('4340', **dict(values, **overrides))


def lines(start, end, cell):
	return np.linspace(start, end, round((end - start) / cell) + 1)


class Halves:
	"""Automata in -left < x < 0, 0 < y < height; beyond them a grid to x = right with cells of h spacings (`coupled`), or automata.

	xs, ys    grid lines, instead of the regular ones; rotate: angle of the whole scene about the origin [rad]; all lengths in spacings
	velocity  function (x, y) -> (vx, vy) of the unrotated scene, lengths in [m]
	"""

	def __init__(self, material, left, right, height, h=1., coupled=True, xs=None, ys=None, velocity=None, rotate=0., factor=0.4, account=False, **engine):
		from yade import O
		O.reset()
		self.O, self.material, self.rotate, self.coupled = O, material, rotate, coupled
		O.materials.append(material)
		turn = np.array([[math.cos(rotate), -math.sin(rotate)], [math.sin(rotate), math.cos(rotate)]]) if rotate else np.eye(2)
		reach = (0. if coupled else right) * D
		outline = packings.Rectangle((0.5 * (reach - left * D), 0.5 * height * D), (left * D + reach, height * D))
		self.packing = packings.hexagonal(D, outline, angle=0.5 * math.pi, origin=(0., 0.))
		p = self.packing.positions
		v = np.stack(np.broadcast_arrays(*velocity(p[:, 0], p[:, 1])), axis=1) if velocity else np.zeros_like(p)
		moved = replace(self.packing, positions=p @ turn.T, angle=self.packing.angle + rotate)
		self.ids = np.array(packings.addBodies(moved, material, velocity=v @ turn.T))
		self.automata = yadeClass('McaEngine')(account=account, **engine)
		self.stepper = yadeClass('McaTimeStepper')(factor=factor)
		O.engines = [self.stepper, self.automata]
		if not coupled: return
		self.grid = yadeClass('McaGridEngine')()
		x = np.asarray(xs) * D if xs is not None else lines(0, right, h) * D
		y = np.asarray(ys) * D if ys is not None else lines(0, height, h) * D
		gx, gy = np.meshgrid(x, y)
		nodes = np.stack((gx, gy), axis=-1)
		placed = nodes @ turn.T
		self.grid.addBlock(material, np.ascontiguousarray(placed[..., 0]), np.ascontiguousarray(placed[..., 1]), name='grid')
		if velocity:
			self.grid.setVelocity(0, np.stack(np.broadcast_arrays(*velocity(gx, gy)), axis=-1) @ turn.T)
		self.coupler = yadeClass('McaGridCoupler')(side='left')
		O.engines = [self.stepper, self.automata, self.grid, self.coupler]

	def at(self, x, y):
		"""Index (in field()) of the automaton nearest to (x, y) spacings."""
		return int(np.argmin(np.hypot(*(self.packing.positions - np.array((x, y)) * D).T)))

	def fix(self, dt):
		"""The same step everywhere, set by hand."""
		self.stepper.active = False
		self.automata.adaptive = False
		self.O.dt = dt

	def record(self, points, component, steps, every):
		"""Histories (samples, points) of a velocity component of automata, every `every` steps."""
		out = []
		for _ in range(steps // every):
			self.O.run(every, True)
			out.append(self.automata.field(component)[points])
		return np.array(out)


def relative(a, b, scale):
	return float(np.abs(np.asarray(a) - np.asarray(b)).max() / scale)
