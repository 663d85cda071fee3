# SPDX-License-Identifier: GPL-2.0-or-later
"""Taylor's test in space: a round copper bar, 23.47 x 7.62 mm, on a smooth rigid anvil at 210 m/s; a quarter with planes of symmetry.

Purpose: bodies in space, against an experiment. Nothing is fitted: Johnson-Cook copper of the library.
Expected number: final length over the first, 0.630, of M. L. Wilkins and M. W. Guinan (1973), J. Appl. Phys. 44, 1200, as digitised by Zelepugin et al. (2023), Materials 16, 5452.
Sweep: pyscripts/yade-mca-batch round_bar.table round_bar.py (spacing)
"""
import numpy as np
from yade import O, utils
from yade_mca import scenes
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.95e-3, tolerance=0.03)
from yade.params.table import spacing, tolerance

length, diameter, speed = 23.47e-3, 7.62e-3, 210.
s = scenes.roundBar('OFHC_Cu', length, diameter, spacing, speed, engineOptions=dict(account=True))
O.run(1, True)
first = s.automata.energies()
y0 = s.packings['bar'].positions[:, 1]
top = y0 > y0.max() - 0.1 * spacing
while s.field('bar', 'vy')[top].mean() < 0:  # until the rear end stops
	O.run(50, True)
last, f = s.automata.energies(), s.fields('bar', ('x', 'y', 'z', 'plasticStrain'))
measured = 1 + (f['y'] - y0)[top].mean() / length
print('L/L0 = %.4f after %.1f us, %d automata, plastic strain up to %.2f, foot %.2f of the diameter' % (
        measured, 1e6 * O.time, len(y0), f['plasticStrain'].max(), 2 * np.hypot(f['x'], f['z']).max() / diameter))
expect('length', measured, 0.630, tolerance)
expect('energy', last['total'] / first['total'], 1, 1e-3)
