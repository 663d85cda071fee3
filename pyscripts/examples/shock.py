# SPDX-License-Identifier: GPL-2.0-or-later
"""A plastic shock driven by a piston into automata, with each volume rule.

Purpose: what the choice of the volume rule costs under strong compression; boundary automata that are driven.
Steel, perfectly plastic (Y = 0.01 K), piston speed U.
Expected number: the speed of the plastic shock, from the jump conditions across precursor and shock (yade_mca.exact.piston).
Sweep: pyscripts/yade-mca-batch shock.table shock.py (rule and piston speed). The published rule 'meanDistance' is off by more, and at higher speed its packing buckles.
"""
import numpy as np
from yade import O, utils
from yade_mca import exact, materials, packings, scenes
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, rule='affine', speed=0.1, rows=300, tolerance=0.01)
from yade.params.table import rows, rule, speed, tolerance

d = 1e-3
record = materials.get('4340')
m = materials.mcaMat('4340', eos='shockAdiabat', yieldModel='perfect', yieldStress=0.01 * record.bulkModulus)
U = speed * record.bulkSoundSpeed
s = scenes._start(dict(volumeRule=rule, contacts=False))
pitch = scenes.PITCH * d
height = 24 * d  # rows run along y; the shock along x, across them
body = packings.hexagonal(d, packings.Rectangle((0.5 * rows * pitch, 0), (rows * pitch, height)), angle=0.5 * np.pi, rim='full')
s.add('bar', body, m)
x = body.positions[:, 0]
edge = abs(body.positions[:, 1]) > 0.5 * height - 2.5 * d
for i, first, side in zip(s.ids['bar'].tolist(), x < x.min() + 1.5 * pitch, edge):
	state = O.bodies[i].state
	if first:
		state.vel, state.blockedDOFs = (U, 0, 0), 'xyzXYZ'
	elif side:
		state.blockedDOFs = 'yzXYZ'  # uniaxial strain at the upper and lower edge

ref = exact.piston(m.density, m.bulkSoundSpeed, m.hugoniotSlope, m.shearModulus, m.yieldStress, U)
level = 0.5 * (U + (ref['precursorU'] if ref['waves'] == 'two' else 0))
end = 0.8 * rows * pitch / max(ref['D'], ref['precursorD'])
middle = abs(body.positions[:, 1]) < 0.25 * height
fronts = []
O.run(1, True)
for t in np.linspace(0.4, 1, 9) * end:
	while O.time < t:
		O.run(10, True)
	v, at = s.field('bar', 'vx')[middle], s.field('bar', 'x')[middle]
	# the front: the mean velocity of each column falls through the level
	columns = np.unique(np.round(body.positions[middle, 0] / pitch * 4), return_inverse=True)[1]
	count = np.bincount(columns)
	v, at = np.bincount(columns, v) / count, np.bincount(columns, at) / count
	k = np.flatnonzero((v[:-1] >= level) & (v[1:] < level))[-1]
	fronts.append((O.time, at[k] + (at[k + 1] - at[k]) * (v[k] - level) / (v[k] - v[k + 1])))
D = np.polyfit(*np.array(fronts).T, 1)[0]
print('rule %s, U = %g c0: shock speed off by %+.2f %%, smallest distance of automata %.2f d' % (rule, speed, 100 * (D / ref['D'] - 1), s.automata.counters()['deepest']))
expect('shock speed', D, ref['D'], tolerance, 'm/s')
