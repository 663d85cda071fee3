# SPDX-License-Identifier: GPL-2.0-or-later
"""Save a running simulation and go on from the file.

Purpose: O.save and O.load with automata, grid and coupler: the continued run has the same bits as one that was never interrupted.
A rod falls on a plate, automata in the middle and grid at both ends.
Expected number: 0, the largest difference of positions and velocities between both runs.
"""
import os
import tempfile

import numpy as np
from yade import O, utils
from yade_mca import scenes
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=1e-3, steps=300)
from yade.params.table import spacing, steps

scenes.penetration(thickness=10e-3, spacing=spacing, rodLength=30e-3, rodDiameter=6e-3, automataWidth=30e-3, plateWidth=50e-3)
O.run(steps, True)
file = os.path.join(tempfile.gettempdir(), 'restart-%d.yade.gz' % os.getpid())
O.save(file)


def state():
	"""Everything that moves, after `steps` more steps."""
	O.run(steps, True)
	automata, grid = O.engines[1], O.engines[2]
	parts = [automata.field(name) for name in ('x', 'y', 'vx', 'vy', 'omega', 'plasticStrain', 'temperature', 'links')]
	parts += [np.ravel(grid.view(block, name)) for block in (0, 1) for name in ('x', 'y', 'vx', 'vy')]
	return np.concatenate(parts)


onward = state()
O.load(file)
print('saved %d automata and %d cells in %.1f MB at %.2f us' % (O.engines[1].count, O.engines[2].count, 1e-6 * os.path.getsize(file), 1e6 * O.time))
again = state()
os.unlink(file)
expect('largest difference', abs(again - onward).max(), 0, 0)
