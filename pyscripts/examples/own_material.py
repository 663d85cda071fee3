# SPDX-License-Identifier: GPL-2.0-or-later
"""A material of your own: constants, what the program makes of them, and a wave that shows it.

Purpose: McaMat from scratch, a variant of a library material, the checks of constants, the speed of a wave in a grid and in automata.
Expected number: the speed of a longitudinal wave, sqrt((K + 4/3 G)/rho), from the arrival of a pulse at two gauges of the grid.
"""
import math

import numpy as np
from yade import O, utils
from yade_mca import McaGridEngine, McaMat, materials
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, cells=800, tolerance=2e-3)
from yade.params.table import cells, tolerance

# 1. from scratch: titanium alloy, constants of your own source
mine = McaMat(
        label='mine', density=4430, bulkSoundSpeed=5130, hugoniotSlope=1.028, shearModulus=43e9, yieldModel='johnsonCook', yieldStress=862e6, hardeningModulus=331e6,
        hardeningExponent=0.34, rateCoefficient=0.012, thermalSoftening=0.8, meltTemperature=1878, heatCapacity=580, fractureStrain=0.5, frictionAngle=math.atan(0.1)
)
print('cP %.0f m/s, cS %.0f m/s, yield stress at 10 %% strain and 1000/s: %.3g Pa' % (mine.cP, mine.cS, mine.flowStress(0.1, 1000., 298.)))
J = 0.9
exact = mine.density * mine.bulkSoundSpeed**2 * (1 - J) / (1 - mine.hugoniotSlope * (1 - J))**2
expect('pressure at J = 0.9', mine.pressure(J), exact, 1e-12, 'Pa')

# 2. a variant of a material of the library; wrong values are refused by name
soft = materials.mcaMat('4340', yieldModel='perfect', yieldStress=200e6, label='soft steel')
O.materials.append(soft)
try:
	materials.mcaMat('4340', density=-1.)
except materials.MaterialError as e:
	print('refused: %s' % e)
else:
	raise RuntimeError('a negative density was not refused')

# 3. a small pulse in a bar of it, uniaxial strain
length = 0.05
h = length / cells
grid = McaGridEngine(adaptive=False)
quiet = dict(viscosityLinear=0, viscosityQuadratic=0, yieldModel='elastic', eos='linear')
probe = McaMat(density=mine.density, bulkSoundSpeed=mine.bulkSoundSpeed, shearModulus=mine.shearModulus, **quiet)
grid.addRectangle(probe, np.linspace(0, length, cells + 1).tolist(), [0, h, 2 * h])
grid.symmetry(0, 'bottom')
grid.symmetry(0, 'top')
t = np.linspace(0, 1.5e-6, 200)
grid.prescribe(0, 'left', x=(t.tolist(), (0.1 * np.sin(math.pi * t / 1.5e-6)**2).tolist()))
gauges = [grid.addGauge((f * length, h)) for f in (0.3, 0.7)]
O.engines = [grid]
O.dt = 0.5 * h / probe.cP
O.run(int(0.8 * length / mine.cP / O.dt + 1.5e-6 / O.dt), True)
a, b = (grid.gauge(g) for g in gauges)
arrival = [np.sum(g[:, 0] * g[:, 3]) / np.sum(g[:, 3]) for g in (a, b)]  # centre of the pulse
expect('wave speed', 0.4 * length / (arrival[1] - arrival[0]), mine.cP, tolerance, 'm/s')
