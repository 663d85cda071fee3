# SPDX-License-Identifier: GPL-2.0-or-later
"""Bodies in space that run by McaEngine or by the law in YADE's own loop, for the tests of the latter."""
import math

import numpy as np

D = 1e-3
COLUMNS = ('x', 'y', 'z', 'vx', 'vy', 'vz', 'wx', 'wy', 'wz', 'pressure', 'plasticStrain', 'links')


def engines(road, dt, **newton):
	"""O.engines for the road 'engine' or 'law2' with a fixed time step [s]."""
	from yade import O
	from yade_mca._yade import yadeClass
	from yade_mca.scenes import law2Engines
	O.dt = dt
	O.engines = [yadeClass('McaEngine')(adaptive=False)] if road == 'engine' else law2Engines('affine', **newton)


def impact(speed=500., rim='full', exactMass=False, orientation=((1, 2, 3), (3, 0, -1)), **steel):
	"""A ball flies obliquely onto a block of another orientation: contact, plastic flow, fracture. Spacing 1 mm; returns the ids.

	exactMass: mass and inertia are powers of two, so that dividing by them (NewtonIntegrator) and multiplying with their inverses (McaEngine) round alike.
	"""
	from yade import O
	from yade_mca import materials, packings
	steel = dict(dict(yieldModel='linearHardening', yieldStress=0.8e9, hardeningModulus=0.5e9, fractureStrain=0.12, spallStrength=2.5e9, strengthSpread=0.1, frictionAngle=0.2), **steel)
	m = materials.mcaMat('4340', **steel)
	edge = math.sqrt(2) * D
	h = 2 * edge
	block = packings.fcc(D, packings.Box((-h, -h, -h), (h, 0, h)), rim=rim)
	ball = packings.fcc(D, packings.Ball((0.3 * D, 2.6 * D, -0.4 * D), 2.2 * D), orientation=orientation)
	top, low = block.positions[:, 1].max(), ball.positions[:, 1].min()
	ball = ball.translated((0, top + 0.9 * D - low, 0))
	ids = packings.addBodies(block, m) + packings.addBodies(ball, m, velocity=(0.2 * speed, -speed, 0.1 * speed), mask=3)
	for i in ids if exactMass else ():
		s = O.bodies[i].state
		s.mass, s.inertia = 2.**math.ceil(math.log2(s.mass)), (2.**math.ceil(math.log2(s.inertia[2])), ) * 3
	return ids


def state(ids):
	"""COLUMNS of the bodies, (N, 12)."""
	from yade import O
	for e in O.engines:
		if type(e).__name__ == 'McaEngine': e.sync()
	rows = []
	for i in ids:
		s = O.bodies[i].state
		rows.append((*s.pos, *s.vel, *s.angVel, s.pressure, s.plasticStrain, s.links))
	return np.array(rows)
