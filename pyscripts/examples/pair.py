# SPDX-License-Identifier: GPL-2.0-or-later
"""Two linked automata: the smallest scene there is.

Purpose: bodies, material, engine, a field of the solver, without any helper of the package.
Two automata span no volume, so their pressure is zero and the pair law alone acts between them: a spring of stiffness k = 2 G S0/d = 2 G/sqrt(3) per metre of thickness.
Expected number: the period 2 pi sqrt(m/(2 k)) of the motion along their line, from the zeros of the relative velocity; the leapfrog shortens it by (omega dt)^2/24.
Sweep: pyscripts/yade-mca-batch pair.table pair.py (share of the stable time step)
"""
import math

import numpy as np
from yade import O, Body, Sphere, utils
from yade_mca import McaEngine, McaMat
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, dtFactor=0.1, periods=20)
from yade.params.table import dtFactor, periods

d = 1e-3  # spacing = diameter [m]
steel = McaMat(density=7830, bulkSoundSpeed=4578, shearModulus=80e9, viscosityLinear=0, viscosityQuadratic=0)
O.materials.append(steel)
mass = steel.density * math.sqrt(3) / 2 * d**2  # of a whole cell of the hexagonal packing, per metre of thickness [kg/m]
for x, v in ((-0.5 * d, 0.1), (0.5 * d, -0.1)):
	b = Body()
	b.shape, b.material, b.state = Sphere(radius=0.5 * d), steel, steel.newAssocState()
	b.state.pos = b.state.refPos = (x, 0, 0)
	b.state.vel = (v, 0, 0)
	b.state.mass, b.state.inertia = mass, [0.5 * mass * (0.5 * d)**2] * 3  # disc
	b.state.blockedDOFs = 'zXY'  # plane strain
	O.bodies.append(b)

engine = McaEngine(adaptive=False, dtFactor=1)
O.engines = [engine]
O.dt = dtFactor * 0.35355 * d / steel.cS  # see the formulation, (13)

k = 2 * steel.shearModulus / math.sqrt(3)
period = 2 * math.pi * math.sqrt(0.5 * mass / k)
steps = int(periods * period / O.dt)
v = np.empty(steps)
for n in range(steps):
	O.step()
	x = engine.field('vx')
	v[n] = x[1] - x[0]

zero = np.flatnonzero(v[:-1] * v[1:] < 0)
times = (zero + v[zero] / (v[zero] - v[zero + 1])) * O.dt
measured = 2 * (times[-1] - times[0]) / (len(times) - 1)
omega = 2 * math.pi / period
expect('period', measured, period * (1 - (omega * O.dt)**2 / 24), 1e-3, 's')
