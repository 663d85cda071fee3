# SPDX-License-Identifier: GPL-2.0-or-later
"""A bar with a residual stress: loaded at its ends it keeps its length, released it springs back by Hooke's law.

Purpose: initial stress (setStress), loads, rest (equilibrium.relax).
Expected numbers: with the loads of that stress on its ends the middle of the bar keeps its length; released, it shortens by stress over modulus (plane strain, E/(1 - nu^2)).
Sweep: pyscripts/yade-mca-batch prestressed.table prestressed.py (spacing, stress)
"""
import numpy as np
from yade import O, utils
from yade_mca import McaEngine, equilibrium, materials, packings
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.5e-3, stress=200e6)
from yade.params.table import spacing, stress

length, height = 20e-3, 6e-3  # [m]
metal = materials.mcaMat('4340', yieldModel='elastic', eos='linear')
bar = packings.hexagonal(spacing, packings.Rectangle((0, 0), (length, height)), rim='triangles')
ids = packings.addBodies(bar, metal)
x = bar.positions[:, 0]
left, right = (np.array(ids)[m].tolist() for m in (x < x.min() + 0.6 * spacing, x > x.max() - 0.6 * spacing))
engine = McaEngine(account=True)
O.engines = [engine]
engine.setStress(ids, (stress, 0, 0))
engine.push(left, x=-stress * np.ptp(bar.positions[:, 1]) / len(left))  # what the rest of a longer bar would do
engine.push(right, x=stress * np.ptp(bar.positions[:, 1]) / len(right))
inside = abs(x) < 0.3 * length


def stretch():
	"""Of the middle of the bar along x [-]."""
	return np.polyfit(x[inside], engine.field('x')[np.searchsorted(engine.ids, ids)][inside], 1)[0]


equilibrium.relax(engine)
held = stretch()
engine.clearLoads()
steps = equilibrium.relax(engine)
free = stretch()
K, G = metal.density * metal.bulkSoundSpeed**2, metal.shearModulus
nu = (3 * K - 2 * G) / (2 * (3 * K + G))
modulus = 2 * G / (1 - nu)
print('stretch of the middle %.8f with the loads at the ends, %.8f without, after %d steps to rest' % (held, free, steps))
expect('stretch while the ends are held, over that by Hooke', (held - 1) * modulus / stress, 0, 0.01)
expect('shortening when they are released, over that by Hooke', (held - free) * modulus / stress, 1, 0.01)
