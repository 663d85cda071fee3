# SPDX-License-Identifier: GPL-2.0-or-later
"""The law of the automata in YADE's own loop: a bar falls on facets under gravity.

Purpose: an ordinary YADE scene (ForceResetter, collider, InteractionLoop, NewtonIntegrator) in which automata meet facets and spheres. Slower than McaEngine, for scenes that need
YADE's other bodies. Gravity is strong, as in a centrifuge, so that it counts in a short time.
Expected numbers: the speed before the bar touches, v0 + g t; the impulse of the floor, which is what the momentum of the bar and gravity make it; the bar leaves with
nearly the speed it came with, the rest goes into its oscillation.
Sweep: pyscripts/yade-mca-batch walls.table walls.py (spacing)
"""
from yade import O, utils
from yade.wrapper import (Bo1_Facet_Aabb, Bo1_Sphere_Aabb, ForceResetter, FrictMat, Ig2_Facet_Sphere_ScGeom, Ig2_Sphere_Sphere_ScGeom, InsertionSortCollider, InteractionLoop,
                          NewtonIntegrator)
from yade_mca import (Ip2_FrictMat_McaMat_McaPhys, Ip2_McaMat_McaMat_McaPhys, Law2_ScGeom_McaPhys_Mca, McaLaw, McaForces, McaTimeStepper, materials, packings)
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.5e-3, tolerance=0.15)
from yade.params.table import spacing, tolerance

g, v0, gap, size = 1e5, 2., 20e-6, 8e-3  # [m/s2], [m/s], [m], [m]
steel = materials.mcaMat('4340', yieldModel='elastic', viscosityLinear=0, viscosityQuadratic=0)
block = packings.hexagonal(spacing, packings.Rectangle((0, 0.5 * size), (0.25 * size, size)))
block = block.translated((0, gap + 0.5 * spacing - block.positions[:, 1].min()))
ids = packings.addBodies(block, steel, velocity=(0, -v0))
floor = FrictMat(density=7800, young=200e9, poisson=0.3, frictionAngle=0)
O.materials.append(floor)
w = 3 * size
facets = O.bodies.append([utils.facet(t, material=floor) for t in (((-w, 0, -w), (w, 0, -w), (w, 0, w)), ((-w, 0, -w), (w, 0, w), (-w, 0, w)))])

O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.4), Bo1_Facet_Aabb()]),
        McaTimeStepper(factor=0.3),
        McaLaw(),
        InteractionLoop(
                [Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=1.4), Ig2_Facet_Sphere_ScGeom()], [Ip2_McaMat_McaMat_McaPhys(), Ip2_FrictMat_McaMat_McaPhys()],
                [Law2_ScGeom_McaPhys_Mca()]
        ),
        McaForces(),
        NewtonIntegrator(damping=0, gravity=(0, -g, 0)),
]
O.trackEnergy = True
mass = sum(O.bodies[i].state.mass for i in ids)
momentum = lambda: sum(O.bodies[i].state.mass * O.bodies[i].state.vel[1] for i in ids)

kicks, impulse, force, last, before, start = 0., 0., 0., 0., None, momentum()
while impulse == 0 or force > 0 or momentum() < 0:  # until it has left the floor
	O.step()
	kick = 0.5 * (last + O.dt) if last else O.dt  # NewtonIntegrator's kick: half of the step before and half of this one
	force = -sum(O.forces.f(i)[1] for i in facets)
	if force == 0 and impulse == 0:
		before = (O.time, momentum() / mass)
	impulse += force * O.dt
	kicks += O.dt
	last = O.dt
after = momentum() / mass
print('touched at %.2f us with %.4f m/s, leaves with %.4f m/s' % (1e6 * before[0], -before[1], after))
expect('speed before it touches', -before[1], v0 + g * before[0], 1e-3, 'm/s')
expect('impulse of the floor', impulse, momentum() - start + mass * g * kicks, 1e-2, 'N s/m')
expect('speed after over before', after / -before[1], 1, tolerance)
