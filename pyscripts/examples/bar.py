# SPDX-License-Identifier: GPL-2.0-or-later
"""A free elastic bar swinging along its axis.

Purpose: a body from an outline, an initial velocity field, the energy account, yade.plot.
Expected number: the period 2 L/c of the first longitudinal mode, c = sqrt(E/(1 - nu^2)/rho) in plane strain; the lateral motion of a bar of finite height h lengthens it by about
(pi nu' h/L)^2/24, nu' = nu/(1 - nu) (Rayleigh's correction). The bar ends at outlines through the centres of its outermost automata (rim='triangles' of packings.hexagonal).
Sweep: pyscripts/yade-mca-batch bar.table bar.py (spacing): the error falls with its square, to that of the correction.
"""
import math

import numpy as np
from yade import O, PyRunner, plot, utils
from yade_mca import materials, scenes
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.5e-3, periods=3, tolerance=0.0004)
from yade.params.table import periods, spacing, tolerance

length, height = 40e-3, 4e-3
steel = materials.mcaMat('4340', yieldModel='elastic', eos='linear', viscosityLinear=0, viscosityQuadratic=0)
s = scenes.bar(steel, length, height, spacing, engineOptions=dict(account=True))
ids = s.ids['bar']
for i in ids.tolist():
	x = O.bodies[i].state.pos[0]
	O.bodies[i].state.vel = (1e-3 * steel.cP * math.sin(math.pi * x / length), 0, 0)

record = materials.get('4340')
c = math.sqrt(record.young / (1 - record.poisson**2) / record.density)
period = 2 * length / c * (1 + (math.pi * record.poisson / (1 - record.poisson) * height / length)**2 / 24)


def addPoint():
	mode = np.sin(math.pi * s.packings['bar'].positions[:, 0] / length)
	e = s.automata.energies()
	plot.addData(t=O.time, amplitude=float(mode @ s.field('bar', 'vx')), total=e['total'], kinetic=e['kinetic'])


O.engines = O.engines + [PyRunner(command='addPoint()', iterPeriod=5, initRun=True)]
plot.plots = {'t': ('amplitude', ), 't ': ('total', 'kinetic')}
O.run(2, True)
while O.time < periods * period:
	O.run(100, True)

t, a = np.array(plot.data['t']), np.array(plot.data['amplitude'])
zero = np.flatnonzero(a[:-1] * a[1:] < 0)
times = t[zero] + (t[zero + 1] - t[zero]) * a[zero] / (a[zero] - a[zero + 1])
expect('period', 2 * (times[-1] - times[0]) / (len(times) - 1), period, tolerance, 's')
expect('energy, last over first', plot.data['total'][-1] / plot.data['total'][0], 1, 0.01)
