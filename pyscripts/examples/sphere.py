# SPDX-License-Identifier: GPL-2.0-or-later
"""An aluminium sphere of 10 mm goes through an aluminium plate of 2 mm at 4 km/s: hole and debris cloud behind it (Whipple's shield); a quarter in space.

Purpose: a shape of one's own in space, planes of symmetry, contacts of fast bodies, fracture, pictures of debris. Pairs break at a plastic strain of 1 or a tension of 1.2 GPa.
Expected numbers: the hole over the sphere, 0.45 V (t/D)^(2/3) + 0.90, V in km/s, of C. J. Maiden and A. R. McMillan (1964), AIAA J. 2, 1992, a fit to such shots
(its constants were not compared with the paper); the spall strength is an assumption;
at 0.5 mm the hole is 8 % wider, at 1 mm 18 %;
the momentum that the sphere brought, and the energy.
Run: pyscripts/yade-mca -n -x sphere.py; sweep: pyscripts/yade-mca-batch sphere.table sphere.py (spacing, speed)
"""
import math

import numpy as np
from yade import O, utils
from yade_mca import McaEngine, materials, packings, plots
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.5e-3, speed=4000., until=12e-6, tolerance=0.2, pictures=True)
from yade.params.table import pictures, spacing, speed, tolerance, until

diameter, thickness, half = 10e-3, 2e-3, 20e-3
step = thickness / round(math.sqrt(2) * thickness / spacing)  # between layers of the plate: whole layers from face to face
d = math.sqrt(2) * step
metal = materials.mcaMat('Al6061_T6', eos='mieGruneisen', fractureStrain=1., spallStrength=1.2e9, strengthSpread=0.05)
plate = packings.fcc(d, packings.Box((-half, -thickness, -half), (half, 0, half)), origin=(0, -0.5 * step, 0), mirror='xz')
ball = packings.fcc(d, packings.Ball((0, 0, 0), 0.5 * diameter), origin=(0, 0, 0), mirror='xz')
ball = ball.translated((0, plate.positions[:, 1].max() + d - ball.positions[:, 1].min(), 0))
target = np.array(packings.addBodies(plate, metal, mask=2))
shot = np.array(packings.addBodies(ball, metal, velocity=(0, -speed, 0), mask=1, color=(0.8, 0.5, 0.2)))
engine = McaEngine(account=True, seed=1, dtFactor=0.5)
O.engines = [engine]
O.run(1, True)
first, momentum = engine.energies(), engine.momentum[1]
while O.time < until: O.run(50, True)

last = engine.energies()
f = engine.fields(['ids', 'x', 'y', 'z', 'vx', 'vy', 'vz', 'plasticStrain', 'links', 'mass'])
x, ofPlate = np.stack((f['x'], f['y'], f['z']), axis=1), np.isin(f['ids'], target)
speeds = np.sqrt(f['vx']**2 + f['vy']**2 + f['vz']**2)
debris = (f['y'] < -2 * thickness) & (f['vy'] < -0.02 * speed)
# the hole is as wide as what of the plate no longer stands in its place: the rest is a disc with as much missing
stays = ofPlate & (abs(f['y'] + 0.5 * thickness) < 2 * thickness) & (speeds < 0.1 * speed) & (f['links'] >= 4)
missing = 4 * (plate.masses(metal.density).sum() - f['mass'][stays].sum()) / metal.density / thickness
hole = math.sqrt(4 * missing / math.pi)
front = np.quantile(-f['vy'][debris], 0.99)
print('%d automata, %.1f us: hole %.1f mm, debris %.2f g, front %.0f m/s, cloud %.1f mm long and %.1f mm wide' % (
        len(x), 1e6 * O.time, 1e3 * hole, 4e3 * f['mass'][debris].sum(), front, -1e3 * np.quantile(f['y'][debris], 0.01), 2e3 * np.quantile(np.hypot(f['x'], f['z'])[debris], 0.99)))
if pictures and not utils.runningInBatch():
	seen = debris | stays
	plots.spacePicture('sphere-debris.png', x[seen], speeds[seen], 'speed', 'm/s', mirror='xz', view=(25., -50.), size=3 * (spacing / 0.5e-3)**2, title='%.0f us' % (1e6 * O.time))
	cut = f['z'] < 0.6 * d
	both, colours = plots.mirrored(x[cut], f['plasticStrain'][cut], 'x')
	plots.automataPicture('sphere-section.png', both, 0.5 * d, colours, 'plastic strain', vmin=0, vmax=2, bounds=(-1.1 * half, both[:, 1].min() - diameter, 1.1 * half, half))
expect('hole over sphere', hole / diameter, 0.45e-3 * speed * (thickness / diameter)**(2 / 3) + 0.90, tolerance)
expect('momentum', engine.momentum[1] / momentum, 1, 1e-9)
expect('energy', last['total'] / first['total'], 1, 0.02)
