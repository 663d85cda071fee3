# SPDX-License-Identifier: GPL-2.0-or-later
"""A plastic shock driven by a piston into automata, with each volume rule.

Purpose: what the choice of the volume rule costs under strong compression; boundary automata that are driven.
Steel, perfectly plastic (Y = 0.01 K), piston speed U.
Expected number: the speed of the plastic shock, from the jump conditions across precursor and shock (yade_mca.exact.piston).
Sweep: pyscripts/yade-mca-batch shock.table shock.py (rule and piston speed). The published rule 'meanDistance' is off by more, and at higher speed its packing buckles.
"""
import numpy as np
from yade import O, utils
from yade_mca import exact, materials, scenes
from yade_mca.expected import expect

utils.readParamsFromTable(noTableOk=True, rule='affine', speed=0.1, rows=300, tolerance=0.01)
from yade.params.table import rows, rule, speed, tolerance

d = 1e-3
record = materials.get('4340')
m = materials.mcaMat('4340', eos='shockAdiabat', yieldModel='perfect', yieldStress=0.01 * record.bulkModulus)
U = speed * record.bulkSoundSpeed
s = scenes.start(dict(volumeRule=rule, contacts=False))
length = rows * scenes.PITCH * d
# rows run along y; the shock along x, across them, in uniaxial strain
scenes.addStrip(s, 'bar', scenes.strip(d, 0., length, 24, angle=0.5 * np.pi), m)
scenes.driveEnd(s, 'bar', U)

ref = exact.piston(m.density, m.bulkSoundSpeed, m.hugoniotSlope, m.shearModulus, m.yieldStress, U)
level = 0.5 * (U + (ref['precursorU'] if ref['waves'] == 'two' else 0))
end = 0.8 * length / max(ref['D'], ref['precursorD'])
fronts = []
O.run(1, True)
for t in np.linspace(0.4, 1, 9) * end:
	while O.time < t:
		O.run(10, True)
	at, v = scenes.profile(s, 'bar', 'vx')  # means of the columns; the front: where v falls through the level
	k = np.flatnonzero((v[:-1] >= level) & (v[1:] < level))[-1]
	fronts.append((O.time, at[k] + (at[k + 1] - at[k]) * (v[k] - level) / (v[k] - v[k + 1])))
D = np.polyfit(*np.array(fronts).T, 1)[0]
print('rule %s, U = %g c0: shock speed off by %+.2f %%, smallest distance of automata %.2f d' % (rule, speed, 100 * (D / ref['D'] - 1), s.automata.counters()['deepest']))
expect('shock speed', D, ref['D'], tolerance, 'm/s')
