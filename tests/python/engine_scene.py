# SPDX-License-Identifier: GPL-2.0-or-later
"""Small scenes with one McaEngine for its tests. Spacing 1 mm, SI units, per 1 m of thickness."""
import hashlib

import numpy as np

D = 1e-3
STEEL = dict(yieldModel='elastic', eos='linear', viscosityLinear=0., viscosityQuadratic=0.)
#: plastic flow, scattered fracture, friction: all features at once
HARD = dict(yieldModel='linearHardening', yieldStress=0.8e9, hardeningModulus=0.5e9, fractureStrain=0.12, spallStrength=2.5e9, strengthSpread=0.1, frictionAngle=0.2)
FIELDS = ('x', 'y', 'vx', 'vy', 'omega', 'angle', 'pressure', 'plasticStrain', 'stressZZ', 'volumeRatio', 'links', 'fx', 'fy')


def engine(dt=None, **attributes):
	"""The only engine of the scene; dt [s]: fixed time step."""
	from yade import O
	from yade_mca import McaEngine
	if dt is not None:
		attributes['adaptive'] = False
		O.dt = dt
	e = McaEngine(**attributes)
	O.engines = [e]
	return e


def block(nx=8, ny=8, at=(0., 0.), angle=0., constants=STEEL, rim='cells', order=None, **options):
	"""A block of nx by ny spacings; order: permutation in which the bodies are made. Returns the ids by place in the packing."""
	from yade_mca import materials, packings
	p = packings.hexagonal(D, packings.Rectangle(at, (nx * D, ny * D)), angle=angle, rim=rim)
	m = materials.mcaMat('4340', **constants)
	if order is None:
		return np.array(packings.addBodies(p, m, **options))
	order = np.asarray(order(len(p)))
	ids = np.empty(len(p), int)
	ids[order] = packings.addBodies(p.select(order), m, **options)
	return ids


def impact(speed=400., n=10, order=None, constants=HARD):
	"""A block flies obliquely into another one: contact between bodies, plastic flow, fracture. Returns the ids by place, one array per body."""
	a = block(n, n, constants=constants, order=order)
	b = block(0.5 * n, 0.6 * n, at=(-0.82 * n * D, 0.1 * n * D), angle=0.5 * np.pi, constants=constants, order=order, velocity=(speed, 0.2 * speed), mask=3)
	return a, b


def pick(e, ids, name):
	"""Field `name` of the bodies `ids`, in their order."""
	return e.field(name)[np.searchsorted(e.ids, ids)]


def states(ids):
	"""Position, velocity and spin that the bodies hold, (N, 5)."""
	from yade import O
	rows = []
	for i in np.asarray(ids).tolist():
		s = O.bodies[i].state
		rows.append((s.pos[0], s.pos[1], s.vel[0], s.vel[1], s.angVel[2]))
	return np.array(rows)


def blocked(ids, dofs):
	from yade import O
	for i in np.asarray(ids).tolist():
		O.bodies[i].state.blockedDOFs = dofs


def digest(e):
	"""All bits of the state."""
	from yade import O
	h = hashlib.sha1()
	for name in FIELDS:
		h.update(e.field(name).tobytes())
	h.update(repr((O.dt, O.iter, e.links(), e.counters()['brokenLinks'], e.counters()['contacts'])).encode())
	return h.hexdigest()
