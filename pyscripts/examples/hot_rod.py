# SPDX-License-Identifier: GPL-2.0-or-later
"""A cold rod and one of 600 K, stretched alike: how much softer the hot one is.

Purpose: temperatures given to automata (McaEngine.prescribeTemperature), velocities as tables of time (prescribe).
Expected number: the ratio of the Mises stresses is that of the Johnson-Cook law at the plastic strains, rates and temperatures that the rods have.
Sweep: pyscripts/yade-mca-batch hot_rod.table hot_rod.py (spacing, temperature)
"""
import numpy as np
from yade import O, utils
from yade_mca import McaEngine, materials, packings
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.5e-3, temperature=600.)
from yade.params.table import spacing, temperature

length, height, speed = 20e-3, 5e-3, 20.  # [m], [m/s]
metal = materials.mcaMat('4340', yieldModel='johnsonCook', eos='linear', viscosityLinear=1.)
rod = packings.hexagonal(spacing, packings.Rectangle((0, 0), (length, height)))
found = {}
for T in 298., temperature:
	O.reset()
	ids = packings.addBodies(rod, metal)
	x = rod.positions[:, 0]
	engine = McaEngine()
	O.engines = [engine]
	engine.prescribeTemperature(ids, T)
	for side, v in (x < x.min() + 0.6 * spacing, -speed), (x > x.max() - 0.6 * spacing, speed):
		engine.prescribe(np.array(ids)[side].tolist(), x=((0, 5e-6), (0, v)), y=0)
	while O.time < 28e-6: O.run(50, True)
	middle = np.searchsorted(engine.ids, np.array(ids)[abs(x) < 0.25 * length])
	before, start = engine.field('plasticStrain')[middle], O.time
	O.run(50, True)
	strain = engine.field('plasticStrain')[middle]
	rate = ((strain - before) / (O.time - start)).mean()
	found[T] = engine.field('equivalentStress')[middle].mean(), metal.flowStress(strain.mean(), rate, T)
	print('%.0f K: plastic strain %.4f at %.0f /s, Mises stress %.1f MPa, law %.1f MPa' % (T, strain.mean(), rate, *(1e-6 * s for s in found[T])))
cold, hot = found[298.], found[temperature]
expect('Mises stress of the hot rod over that of the cold one, over the same of the law', hot[0] / cold[0] / (hot[1] / cold[1]), 1, 0.01)
expect('Mises stress over that of the law, hot', hot[0] / hot[1], 1, 0.01)
