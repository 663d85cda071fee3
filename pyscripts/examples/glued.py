# SPDX-License-Identifier: GPL-2.0-or-later
"""Two halves of one metal, glued: the bar is pulled until the glue parts.

Purpose: what holds between two materials (McaEngine.setPair), the history of broken links (yade_mca.cracks), damping.
Expected numbers: the pull over the section is the glue's strength when the first link breaks, and all links that break are those of the glue.
Sweep: pyscripts/yade-mca-batch glued.table glued.py (spacing, strength)
"""
import numpy as np
from yade import O, utils
from yade_mca import McaEngine, cracks, materials, packings
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, spacing=0.5e-3, strength=100e6)
from yade.params.table import spacing, strength

length, height = 20e-3, 6e-3  # [m]
left, right = (materials.mcaMat('4340', yieldModel='elastic', eos='linear', viscosityLinear=1., label=name) for name in ('left', 'right'))
bar = packings.hexagonal(spacing, packings.Rectangle((0, 0), (length, height)), rim='triangles')
ids = np.array(packings.addBodies(bar, left))
x = bar.positions[:, 0]
for i in ids[x > 0].tolist():
	O.bodies[i].mat = right
engine = McaEngine(account=True, damping=0.1)
O.engines = [engine]
engine.setPair(left, right, pairStrength=strength)
ends = [ids[side].tolist() for side in (x < x.min() + 0.6 * spacing, x > x.max() - 0.6 * spacing)]
section = np.ptp(bar.positions[:, 1])
rise = 120e-6  # [s]: slow against the time of sound along the bar
for side, sign in zip(ends, (-1, 1)):
	w = np.array([O.bodies[i].state.mass for i in side])
	for i, share in zip(side, w / w.sum()):
		engine.push([i], x=((0, rise), (0, sign * 2 * strength * section * share)))
glue = {p for p in engine.links() if (x[np.searchsorted(ids, p[0])] > 0) != (x[np.searchsorted(ids, p[1])] > 0)}
while len(engine.brokenLinks()['time']) < len(glue) and O.time < rise: O.run(200, True)
broken = cracks.history(engine)
pull = 2 * strength * broken['time'][0] / rise
print('first break at %.1f us under %.1f MPa; %d of %d links of the glue broken, causes %s' %
      (1e6 * broken['time'][0], 1e-6 * pull, len(broken['time']), len(glue), set(broken['cause'])))
expect('pull at the first break over the strength of the glue', pull / strength, 1, 0.06)
expect('links broken outside of the glue', len(set(zip(broken['id1'].tolist(), broken['id2'].tolist())) - glue), 0, 0)
expect('broken links of the glue over all of them', len(broken['time']) / len(glue), 1, 0)
