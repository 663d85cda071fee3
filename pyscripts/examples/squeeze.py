# SPDX-License-Identifier: GPL-2.0-or-later
"""A block between two walls that a servo presses to a force: stress and strain against the exact law.

Purpose: rigid walls, YADE's ServoPIDController as target force, and damping (McaEngine.damping) as the way to a state of rest.
Expected numbers: the force on both walls is the target; the strain of the block's middle is that of plane strain between frictionless plates,
(1 - nu^2) stress / E to first order, here by the law itself: linear equation of state, J = det F.
Sweep: pyscripts/yade-mca-batch squeeze.table squeeze.py (spacing, stress)
"""
import numpy as np
from scipy.optimize import fsolve
from yade import O, utils
from yade.wrapper import ForceResetter, FrictMat, NewtonIntegrator, ServoPIDController
from yade_mca import McaEngine, materials, packings
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.5e-3, stress=0.3e9)
from yade.params.table import spacing, stress

width, height = 6e-3, 9e-3  # [m]
metal = materials.mcaMat('4340', yieldModel='elastic', eos='linear', viscosityLinear=1.)
block = packings.hexagonal(spacing, packings.Rectangle((0, 0), (width, height)), rim='triangles')
ids = packings.addBodies(block, metal)
y = block.positions[:, 1]
O.materials.append(FrictMat(frictionAngle=0, label='plates'))
low, top = (O.bodies.append(utils.wall(at, axis=1, material='plates', mask=2)) for at in (y.min() - 0.5 * spacing, y.max() + 0.5 * spacing))
width = sum(O.bodies[i].state.mass for i in ids) / (metal.density * np.ptp(y))  # of the block as the packing fills it
target = stress * width  # [N/m]
engine = McaEngine(adaptive=False, damping=0.3)
K, G = metal.density * metal.bulkSoundSpeed**2, metal.shearModulus
O.dt = 0.2 * spacing / metal.cP
stiffness = 4 * G * (3 * K + G) / (3 * K + 4 * G) * width / height  # of the block [N/m2]
servo = ServoPIDController(ids=[top], axis=(0, 1, 0), maxVelocity=20., iterPeriod=1, kP=0.02 / stiffness / O.dt, target=target, translationAxis=(0, 1, 0), velocity=0)
O.engines = [ForceResetter(), engine, servo, NewtonIntegrator(damping=0, mask=2)]
for _ in range(20):
	O.run(1000, True)
	off = abs(O.forces.f(top)[1] / target - 1)
	print('%6.1f us: %.6f of the target on the upper wall, %.6f on the lower' % (1e6 * O.time, O.forces.f(top)[1] / target, -O.forces.f(low)[1] / target))
	if off < 1e-5 and abs(O.forces.f(low)[1] / target + 1) < 1e-5: break
expect('force on the lower wall over the target', -O.forces.f(low)[1] / target, 1, 1e-3)

now = np.stack([engine.field(c) for c in 'xy'], axis=1)[np.searchsorted(engine.ids, ids)]
inside = (abs(y) < 0.25 * height) & (abs(block.positions[:, 0]) < 0.35 * width)
F = np.linalg.lstsq(np.c_[block.positions[inside], np.ones(inside.sum())], now[inside], rcond=None)[0][:2].T  # homogeneous deformation of the middle


def unbalanced(stretch):
	"""Stresses along x and along y plus the target, of the law: pressure by J, deviator 2G times that of the logarithmic strain."""
	e = np.log(np.abs(stretch))
	mean = e.sum() / 3
	p = -K * (np.exp(e.sum()) - 1)
	return (2 * G * (e[0] - mean) - p) / stress, (2 * G * (e[1] - mean) - p + target / (F[0, 0] * width)) / stress


exact = fsolve(unbalanced, (1., 1.))
print('stretch along y %.6f (exact %.6f), along x %.6f (%.6f)' % (F[1, 1], exact[1], F[0, 0], exact[0]))
expect('shortening over that of the law', (1 - F[1, 1]) / (1 - exact[1]), 1, 0.01)
expect('widening over that of the law', (F[0, 0] - 1) / (exact[0] - 1), 1, 0.01)
