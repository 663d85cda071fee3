# SPDX-License-Identifier: GPL-2.0-or-later
"""Plate impact: a flyer of half the thickness spalls the target.

Purpose: two bodies that meet as contacts (masks), uniaxial strain, fracture by tension, the velocity of a free surface.
Elastic copper, linear equation of state; links break at a tensile pressure.
Expected numbers: the free surface first moves with the speed of the flyer U (twice the particle speed U/2 of the target); without fracture it stops again. With it the
scab keeps most of its velocity: the two releases meet in the middle plane, each brings half of the tension sigma = P (K + 4/3 G)/K at which it breaks, and the surface falls by
sigma/(rho cP).
Sweep: pyscripts/yade-mca-batch spall.table spall.py (spall strength)
"""
import numpy as np
from yade import O, utils
from yade_mca import materials, scenes
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.1e-3, speed=100., strength=1e9, tolerance=0.2)
from yade.params.table import speed, spacing, strength, tolerance

flyer, target = 2e-3, 4e-3
copper = materials.mcaMat('OFHC_Cu', yieldModel='elastic', eos='linear', spallStrength=strength)
s = scenes.plateImpact(copper, copper, flyer, target, 24 * spacing, spacing, speed)
surface = s.packings['target'].positions
surface = (surface[:, 0] > target - 1.2 * spacing) & (abs(surface[:, 1]) < 6 * spacing)

t, v = [], []
O.run(1, True)
while O.time < 2.6 * target / copper.cP:
	O.run(5, True)
	t.append(O.time * copper.cP / target)
	v.append(s.field('target', 'vx')[surface].mean())
t, v = np.array(t), np.array(v)
plateau = np.median(v[(t > 1.2) & (t < 1.7)])  # the release from the flyer's rear face arrives at t = 2
fall = plateau - v[(t > 2.0) & (t < 2.55)].min()
broken = s.field('target', 'brokenLinks').sum() / 2
K = copper.density * copper.bulkSoundSpeed**2
stress = strength * (K + 4 / 3 * copper.shearModulus) / K
pullBack = min(stress / (copper.density * copper.cP), speed)
print('%d links broken, velocity falls by %.1f of %.1f m/s' % (broken, fall, speed))
expect('free surface', plateau, speed, 0.02, 'm/s')
expect('pull-back', fall, pullBack, tolerance, 'm/s')
