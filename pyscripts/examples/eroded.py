# SPDX-License-Identifier: GPL-2.0-or-later
"""Debris of an impact leaves the scene while it runs; its mass, momentum and energy stay in the account.

Purpose: erosion with book-keeping (yade_mca.erosion) from a PyRunner.
Expected numbers: momentum of what is there and what has left is that of the start, mass as well, and the work booked closes.
Sweep: pyscripts/yade-mca-batch eroded.table eroded.py (spacing, speed)
"""
from yade import O, utils
from yade.wrapper import PyRunner
from yade_mca import McaEngine, erosion, materials, packings
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.25e-3, speed=1500.)
from yade.params.table import spacing, speed

metal = materials.mcaMat('4340', fractureStrain=0.6, spallStrength=4e9, strengthSpread=0.05)
packings.addBodies(packings.hexagonal(spacing, packings.Rectangle((0, 0), (20e-3, 4e-3))), metal, mask=1)
packings.addBodies(packings.hexagonal(spacing, packings.disc((0, 4e-3 + spacing), 2e-3)), metal, velocity=(0.1 * speed, -speed), mask=2)
engine = McaEngine(account=True)
gone = []
O.engines = [engine, PyRunner(command='gone.extend(erode())', iterPeriod=50)]


def erode():
	"""Loose automata that are farther than 6 mm from the middle of the plate along y."""
	return erosion.erode(engine, lambda a: (a['links'] == 0) & (abs(a['y']) > 3.2e-3))


mass = sum(b.state.mass for b in O.bodies)
start = engine.energies()
while O.time < 12e-6: O.run(100, True)
now = engine.energies()
print('%d of %d automata have left with %.4f kg/m, %.3g J/m kinetic; %d links broken' %
      (len(gone), len(gone) + engine.count, now['leftMass'], now['leftKinetic'], engine.counters()['brokenLinks']))
expect('automata that have left (1: some)', float(len(gone) > 0), 1, 0)
expect('mass that is there and that has left over that of the start', (sum(b.state.mass for b in O.bodies) + now['leftMass']) / mass, 1, 1e-12)
expect('momentum y that is there and that has left over that of the start', (now['momentumY'] + now['leftMomentumY']) / start['momentumY'], 1, 1e-10)
expect('booked work that is missing over the kinetic energy', now['bookedError'] / start['kinetic'], 0, 1e-10)
