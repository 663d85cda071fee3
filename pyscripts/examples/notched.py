# SPDX-License-Identifier: GPL-2.0-or-later
"""A plate with a crack in its middle under tension: how far the crack opens, and the stress intensity that follows.

Purpose: a pre-crack (yade_mca.cracks.cut), a load at rest (equilibrium.relax).
Expected number: K_I from the opening, fitted along the crack by 4 s/E' sqrt(a^2 - x^2), over that of a long plate of finite width, s sqrt(pi a / cos(pi a/W))
(Feddersen). This plate is square, where K_I under even tension is some 4 % higher: finer spacings come to rest there, so 6 % are allowed.
Sweep: pyscripts/yade-mca-batch notched.table notched.py (spacing, crack)
"""
import numpy as np
from yade import O, utils
from yade_mca import McaEngine, cracks, equilibrium, materials, packings
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.5e-3, crack=10e-3)
from yade.params.table import crack, spacing

width, height, stress = 40e-3, 40e-3, 50e6  # [m], [Pa]
metal = materials.mcaMat('4340', yieldModel='elastic', eos='linear', fractureStrain=1.)
plate = packings.hexagonal(spacing, packings.Rectangle((0, 0), (width, height)), rim='triangles')
ids = np.array(packings.addBodies(plate, metal))
x, y = plate.positions.T
engine = McaEngine()
O.engines = [engine]
rows = np.unique(np.round(y, 9))
line = 0.5 * (rows[rows <= 1e-9].max() + rows[rows > 1e-9].min())  # between the two rows in the middle
cut = cracks.cut(engine, ((-0.5 * crack, line), (0.5 * crack, line)))
for side, sign in (y < y.min() + 0.1 * spacing, -1), (y > y.max() - 0.1 * spacing, 1):
	w = np.array([O.bodies[i].state.mass for i in ids[side].tolist()])
	for i, share in zip(ids[side].tolist(), w / w.sum()):
		engine.push([i], y=sign * stress * np.ptp(x) * share)
steps = equilibrium.relax(engine, tolerance=1e-9)
v = engine.field('y')[np.searchsorted(engine.ids, ids)] - y
below, above = (abs(y - at) < 1e-9 for at in (rows[rows < line].max(), rows[rows > line].min()))
K, G = metal.density * metal.bulkSoundSpeed**2, metal.shearModulus
modulus = 4 * G * (3 * K + G) / (3 * K + 4 * G)  # E/(1 - nu^2)
at = x[above]
opening = v[above] - np.interp(at, x[below], v[below]) - stress / modulus * (rows[1] - rows[0])
inside = abs(at) < 0.35 * crack  # away from the tips, where a link is no continuum
slope, top = np.polyfit(at[inside]**2, opening[inside]**2, 1)
a = np.sqrt(-top / slope)
found, exact = 0.25 * modulus * np.sqrt(-slope) * np.sqrt(np.pi * a), stress * np.sqrt(np.pi * a / np.cos(np.pi * a / width))
print('%d links cut, %d steps to rest; half length by the opening %.3f mm (%.3f cut), K_I %.2f MPa m^0.5 (theory %.2f)' %
      (cut, steps, 1e3 * a, 500 * crack, 1e-6 * found, 1e-6 * exact))
expect('K_I over that of a long plate', found / exact, 1, 0.06)
