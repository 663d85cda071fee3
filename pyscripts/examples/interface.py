# SPDX-License-Identifier: GPL-2.0-or-later
"""A longitudinal pulse runs from automata into the grid.

Purpose: a row of automata tied to a side of a block; the common time step; gauges; the account of the whole.
Automata x < 0, grid x > 0 with cells of h spacings. The initial velocity is a Gaussian pulse, which parts into two halves; one runs into the grid.
Expected numbers: the amplitude in the grid is half of the initial one; what comes back is the packing's exact reflection (yade_mca.exact.tiedRowReflection), below 1 % at h = d;
the energy of both together stays.
Sweep: pyscripts/yade-mca-batch interface.table interface.py (h): cells of 4 spacings send back what is shorter than 12 spacings.
"""
import numpy as np
from yade import O, utils
from yade_mca import McaEngine, McaGridCoupler, McaGridEngine, McaTimeStepper, materials, packings
from yade_mca.expected import expect
from yade_mca.scenes import PITCH

utils.readParamsFromTable(noTableOk=True, h=1, width=8, tolerance=0.01)
from yade.params.table import h, tolerance, width

d, start, gauge = 1e-3, -32, 24  # spacing [m]; centre of the pulse and distance of the gauges from the interface, in spacings
left, height = 4 * 36, 160  # free surfaces are so far away that nothing from them arrives in time
m = materials.mcaMat('4340', eos='linear', yieldModel='elastic', viscosityLinear=0, viscosityQuadratic=0)
pulse = lambda x: 1e-4 * m.cP * np.exp(-((x / d - start) / width)**2)

# close-packed columns along y, one of them on x = 0
body = packings.hexagonal(d, packings.Rectangle((-0.5 * left * PITCH * d, 0.5 * height * d), (left * PITCH * d, height * d)), angle=0.5 * np.pi, origin=(0, 0))
v = np.stack((pulse(body.positions[:, 0]), 0 * body.positions[:, 0]), axis=1)
ids = packings.addBodies(body, m, velocity=v)
place = lambda x: int(np.argmin(np.hypot(body.positions[:, 0] - x * d, body.positions[:, 1] - 0.5 * height * d)))

grid = McaGridEngine()
xs, ys = np.arange(0, 160 + h, h) * d, np.arange(0, height + h, h) * d
grid.addRectangle(m, xs.tolist(), ys.tolist())
gx = np.array(grid.view(0, 'x'))
grid.setVelocity(0, np.stack((pulse(gx), 0 * gx), axis=-1))
inGrid = grid.addGauge((gauge * d, 0.5 * height * d * (1 + 1e-9)))

automata = McaEngine(account=True)
coupler = McaGridCoupler(side='left')
O.engines = [McaTimeStepper(factor=0.4), automata, grid, coupler]
O.run(1, True)
before = coupler.energies()['total']

back, at = [], place(-gauge)
while O.time * m.cP / d < gauge - start + 3 * width:
	O.run(4, True)
	if O.time * m.cP / d > 2 * width - start:  # the pulse has passed the interface
		back.append(automata.field('vx')[at])
peak, sent = 0.5e-4 * m.cP, abs(np.array(back)).max()
print('comes back: %.4f of the pulse' % (sent / peak))
expect('amplitude in the grid', grid.gauge(inGrid)[:, 3].max(), peak, tolerance, 'm/s')
expect('amplitude that comes back', sent / peak, 0, tolerance)
expect('energy, last over first', coupler.energies()['total'] / before, 1, 2e-3)
