# SPDX-License-Identifier: GPL-2.0-or-later
"""Taylor's test in plane strain: a copper bar on a smooth rigid anvil.

Purpose: large plastic strain, the account of energy. anvil='rough' in scenes.taylorBar takes fixed automata for the anvil.
Expected number: the final length. G. I. Taylor (1948), with the rear part rigid and decelerated by the yield stress alone, and M. L. Wilkins and M. W. Guinan (1973):
L/L0 = exp(-rho U^2/(2 Ys)), Ys = 2 Y/sqrt(3) in plane strain; an estimate of one dimension, which holds to about 10 %.
Sweep: pyscripts/yade-mca-batch taylor.table taylor.py (impact speed and spacing)
"""
import math

import numpy as np
from yade import O, utils
from yade_mca import materials, scenes
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.4e-3, speed=130., tolerance=0.07)
from yade.params.table import spacing, speed, tolerance

length, diameter, Y = 32e-3, 6.4e-3, 400e6
copper = materials.mcaMat('OFHC_Cu', yieldModel='perfect', yieldStress=Y, fractureStrain=3)
s = scenes.taylorBar(copper, length, diameter, spacing, speed, engineOptions=dict(account=True))
O.run(1, True)
first = s.automata.energies()
shorter = math.exp(-copper.density * speed**2 / (2 * 2 * Y / math.sqrt(3)))
y0 = s.packings['bar'].positions[:, 1]
top = y0 > y0.max() - 1.5 * spacing
while s.field('bar', 'vy')[top].mean() < 0:  # until the rear end stops
	O.run(100, True)
e = s.automata.energies()
measured = 1 + (s.field('bar', 'y') - y0)[top].mean() / length
print('L/L0 = %.4f after %.1f us, plastic strain up to %.2f, mushroom %.2f of the diameter' % (
        measured, 1e6 * O.time, s.field('bar', 'plasticStrain').max(), np.ptp(s.field('bar', 'x')) / diameter))
expect('length', measured, shorter, tolerance)
expect('plastic work over kinetic energy', e['plastic'] / first['kinetic'], 1, 0.12)
