# SPDX-License-Identifier: GPL-2.0-or-later
"""Taylor bar and spall of the automata."""
import math

import numpy as np

from .. import scenes
from .automata_scene import Bar, material, order


def taylor(report, want, quick):
	"""Copper bar on a rigid anvil in plane strain: length and width converge with the spacing."""
	if not want('taylor'): return
	length, width, speed, strain = 25.4e-3, 7.62e-3, 190., 1.
	levels = (8, 12) if quick else (8, 12, 18, 27)
	found = []
	for n in levels:
		from yade import O
		O.reset()
		s = scenes.taylorBar(material('OFHC_Cu', eos='shockAdiabat', yieldModel='johnsonCook', fractureStrain=strain), length, width, width / n, speed, engineOptions=dict(account=True))
		O.run(2, True)
		while O.time < 70e-6:
			O.run(100, True)
		x, y, w = s.field('bar', 'x'), s.field('bar', 'y'), s.field('bar', 'weight')
		d = width / n
		foot = np.ptp(x[y < y.min() + 3 * d]) + d
		e = s.automata.energies()
		found.append((np.ptp(y) + d, foot, (s.field('bar', 'plasticStrain') * w).sum() / w.sum(), e['total'] / e['kineticStart'] - 1))
	found = np.array(found)
	for k, n in enumerate(levels):
		for c, what in enumerate(('length', 'footWidth', 'meanPlasticStrain')):
			scale = (length, width, 1.)[c]
			last = abs(found[k, c] - found[-1, c]) / abs(found[-1, c])
			report.add('taylor/%s/N%d' % (what, n), found[k, c] / scale, found[-1, c] / scale, error=last, unit='of the original' if c < 2 else '-',
			           passed=k in (0, len(levels) - 1) or last < 1.05 * abs(found[k - 1, c] - found[-1, c]) / abs(found[-1, c]))
	report.add('taylor/lengthChangeOfLastRefinement', found[-1, 0] / found[-2, 0] - 1, 0., limit=0.01)
	report.add('taylor/footChangeOfLastRefinement', found[-1, 1] / found[-2, 1] - 1, 0., limit=0.03)
	report.add('taylor/energy', found[-1, 3], 0., limit=5e-3, unit='of the kinetic energy')


def spall(report, want, quick):
	"""Pull-back of the free surface when the target opens: du = 2 sigma/(rho c)."""
	for name, flow in (('elastic', math.inf), ('plastic', 5e7)):
		if not want('spall/' + name): continue
		strength, d = 1.5e9, 0.25e-3
		m = material('OFHC_Cu', eos='linear', yieldModel='perfect', yieldStress=flow, spallStrength=strength, viscosity=(0.1, 0.5))
		K, G = m.density * m.bulkSoundSpeed**2, m.shearModulus
		c = m.cP if name == 'elastic' else m.bulkSoundSpeed
		# the criterion is the mean stress; in elastic uniaxial strain the axial one is (K + 4G/3)/K times it
		sigma = strength * (K + 4 / 3 * G) / K if name == 'elastic' else strength + 2 / 3 * flow
		up = 1.6 * 2 * sigma / (m.density * c)  # the flyer's speed: tension would reach 1.6 times the strength
		bar = Bar(d, 0., 16)
		flyer, target = 60, 120
		bar.body('flyer', m, -flyer * d, flyer * d, velocity=(up, 0.), mask=1)
		bar.body('target', m, 0., target * d, mask=2)
		record = []
		end = (target + 2.6 * flyer) * d / c
		while bar.O.time < end:
			bar.steps(4)
			x, v = bar.profile('target', 'vx')
			record.append((bar.O.time, v[-2:].mean()))
		t, v = np.array(record).T
		top = int(np.argmax(v))
		low = top + int(np.argmin(v[top:top + max(3, int(1.2 * flyer * d / c / (t[1] - t[0])))]))
		report.add('spall/%s/pullBack' % name, v[top] - v[low], 2 * sigma / (m.density * c), limit=0.05, unit='m/s')
		report.add('spall/%s/brokenLinks' % name, bar.engine.counters()['brokenLinks'], passed=bar.engine.counters()['brokenLinks'] > 0)


CASES = [taylor, spall]
