# SPDX-License-Identifier: GPL-2.0-or-later
"""A rigid projectile from an STL file hits an aluminium plate of automata, in space.

Purpose: rigid bodies beside McaEngine. Facets of yade.ymport.stl in a clump that NewtonIntegrator moves; what automata do to it goes through O.forces.
Expected numbers: the momentum that the plate has gained is what the projectile has lost, and the work of the projectile on the automata ('external') is the
kinetic energy that it has lost. Both hold whatever the steps.
Sweep: pyscripts/yade-mca-batch projectile.table projectile.py (spacing, speed)
"""
import os
import tempfile

import numpy as np
from yade import O, utils, ymport
from yade.wrapper import ForceResetter, FrictMat, NewtonIntegrator
from yade_mca import McaEngine, materials, packings
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=1e-3, speed=300.)
from yade.params.table import speed, spacing

radius, mass, thickness, halfWidth = 3e-3, 5e-3, 5e-3, 12e-3  # [m], [kg]


def coneNosed(path, r, sides=12):
	"""Writes a cylinder of radius and height r with a cone of the same height below, as STL."""
	turn = 2 * np.pi * np.arange(sides + 1) / sides
	ring = np.stack((r * np.cos(turn), 0 * turn, r * np.sin(turn)), axis=1)
	top, tip, middle = ring + (0, r, 0), np.array((0, -r, 0)), np.array((0, r, 0))
	faces = [f for k in range(sides) for f in ((tip, ring[k], ring[k + 1]), (ring[k], top[k], top[k + 1]), (ring[k], top[k + 1], ring[k + 1]), (top[k], middle, top[k + 1]))]
	with open(path, 'w') as f:
		f.write('solid projectile\n')
		for corners in faces:
			f.write('facet normal 0 0 0\nouter loop\n%sendloop\nendfacet\n' % ''.join('vertex %.9g %.9g %.9g\n' % tuple(c) for c in corners))
		f.write('endsolid projectile\n')


plate = packings.fcc(spacing, packings.Box((-halfWidth, -thickness, -halfWidth), (halfWidth, 0, halfWidth)))
ids = packings.addBodies(plate, materials.mcaMat('Al6061_T6', fractureStrain=1., spallStrength=1.2e9, strengthSpread=0.05))
O.materials.append(FrictMat(density=7800, frictionAngle=0, label='tool'))
with tempfile.TemporaryDirectory() as folder:
	file = os.path.join(folder, 'projectile.stl')
	coneNosed(file, radius)
	facets = ymport.stl(file, material='tool')
for f in facets:  # YADE makes the mass of a clump from its members'; a facet has none of its own
	f.mask, f.state.mass, f.state.inertia = 2, mass / len(facets), (1e-9, ) * 3
	f.state.pos = f.state.pos + utils.Vector3(0, plate.positions[:, 1].max() + 0.52 * spacing + radius, 0)
clump, members = O.bodies.appendClumped(facets)
body = O.bodies[clump]
body.mask = 2
body.state.mass, body.state.inertia, body.state.vel = mass, (0.4 * mass * radius**2, ) * 3, (0, -speed, 0)

engine = McaEngine(account=True)
O.engines = [ForceResetter(), engine, NewtonIntegrator(damping=0, mask=2)]
weights = np.array([O.bodies[i].state.mass for i in ids])
for _ in range(6):
	O.run(100, True)
	print('%6.2f us: %.2f m/s, %d links broken' % (1e6 * O.time, -body.state.vel[1], engine.counters()['brokenLinks']))
gained = weights @ engine.field('vy')
lost = 0.5 * mass * (speed**2 - body.state.vel.squaredNorm()) - 0.5 * 0.4 * mass * radius**2 * body.state.angVel.squaredNorm()
expect('momentum of the plate over what the projectile lost', gained / (mass * (-speed - body.state.vel[1])), 1, 1e-9)
expect('work on the automata over the energy that the projectile lost', engine.energies()['external'] / lost, 1, 0.02)
