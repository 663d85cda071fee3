# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of automata that run by McaEngine or by the law in YADE's own loop, for the tests of the latter."""
import math

import numpy as np


def engines(road, dt, rule='affine', **newton):
	"""O.engines for the road 'engine' or 'law2' with a fixed time step [s]."""
	from yade import O
	from yade.wrapper import McaEngine
	from yade_mca.scenes import law2Engines
	O.dt = dt
	if road == 'engine': O.engines = [McaEngine(adaptive=False, volumeRule=rule)]
	else: O.engines = law2Engines(rule, **newton)


def density():
	from yade import O
	return next(e for e in O.engines if type(e).__name__ == 'McaLaw')


def impact(speed=400., n=10, exactMass=False, rim='cells', **steel):
	"""A block flies obliquely into another one: contact between bodies, plastic flow, fracture. Spacing 1 mm; returns the ids.

	exactMass: mass and inertia are powers of two, so that dividing by them (NewtonIntegrator) and multiplying with their inverses (McaEngine) round alike.
	"""
	from yade import O
	from yade_mca import materials, packings
	steel = dict(dict(yieldModel='linearHardening', yieldStress=0.8e9, hardeningModulus=0.5e9, fractureStrain=0.12, spallStrength=2.5e9, strengthSpread=0.1, frictionAngle=0.2), **steel)
	m = materials.mcaMat('4340', **steel)
	d = 1e-3
	whole = packings.hexagonal(d, packings.Rectangle((0, 0), (n * d, n * d)), rim=rim)
	apart = 0.9 if rim == 'triangles' else 0.  # two outlines through centres touch at a spacing
	flyer = packings.Rectangle((-0.82 * n * d - apart * d, 0.1 * n * d), (0.5 * n * d, 0.6 * n * d))
	flyer = packings.hexagonal(d, flyer, angle=np.pi / 2, rim=rim)
	a = packings.addBodies(whole, m)
	b = packings.addBodies(flyer, m, velocity=(speed, 0.2 * speed), mask=3)
	for i in (a + b) if exactMass else ():
		s = O.bodies[i].state
		s.mass, s.inertia = 2.**math.ceil(math.log2(s.mass)), (0, 0, 2.**math.ceil(math.log2(s.inertia[2])))
	return a + b


def state(ids):
	"""Position, velocity, spin, pressure, plastic strain, links of the bodies, (N, 8)."""
	from yade import O
	for e in O.engines:
		if type(e).__name__ == 'McaEngine':
			e.sync()
	rows = []
	for i in ids:
		s = O.bodies[i].state
		rows.append((s.pos[0], s.pos[1], s.vel[0], s.vel[1], s.angVel[2], s.pressure, s.plasticStrain, s.links))
	return np.array(rows)
