# SPDX-License-Identifier: GPL-2.0-or-later
"""A flat rough punch is pressed into a perfectly plastic block of automata.

Purpose: driven automata, reading reaction forces, a quasi-static answer from explicit dynamics.
The rows under the punch are driven down slowly; the block is held at its bottom and sides.
Expected number: the mean pressure under the punch, L. Prandtl (1920): (2 + pi) k = 2.97 Y with k = Y/sqrt(3) in plane strain (von Mises). A packing with few automata under the punch
is stiffer.
Sweep: pyscripts/yade-mca-batch punch.table punch.py (spacing)
"""
import math

import numpy as np
from yade import O, utils
from yade_mca import McaEngine, materials, packings
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.5e-3, speed=4., depth=0.06, tolerance=0.2)
from yade.params.table import depth, spacing, speed, tolerance

width, Y = 8e-3, 300e6  # of the punch [m], yield stress [Pa]
block = packings.hexagonal(spacing, packings.Rectangle((0, -1.5 * width), (6 * width, 3 * width)))
m = materials.mcaMat('4340', yieldModel='perfect', yieldStress=Y, eos='linear', viscosityLinear=0.5)
ids = np.array(packings.addBodies(block, m))
x, y = block.positions.T
under = (y > y.max() - 0.1 * spacing) & (abs(x) < 0.5 * width)
held = (y < y.min() + 0.1 * spacing) | (abs(x) > 3 * width - spacing)
for i in ids[under].tolist():
	O.bodies[i].state.vel, O.bodies[i].state.blockedDOFs = (0, -speed, 0), 'xyzXYZ'
for i in ids[held].tolist():
	O.bodies[i].state.blockedDOFs = 'xyzXYZ'

engine = McaEngine(contacts=False)
O.engines = [engine]
contact = under.sum() * spacing  # width that the driven automata stand for [m]
O.run(1, True)
time, pressure = [], []
while O.time * speed < depth * width:
	O.run(20, True)
	time.append(O.time)
	pressure.append(engine.field('fy')[under].sum() / contact)
time, pressure = np.array(time), np.array(pressure)
late = pressure[time * speed > 0.5 * depth * width]
print('pressure %.3g +- %.2g Pa over the second half, %d automata under the punch' % (late.mean(), late.std(), under.sum()))
expect('pressure over yield stress', late.mean() / Y, (2 + math.pi) / math.sqrt(3), tolerance)
