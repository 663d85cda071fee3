# SPDX-License-Identifier: GPL-2.0-or-later
"""The law in YADE's own loop against McaEngine: the same trajectory."""
import numpy as np

from ..._yade import scene as omega
from ...scenes import law2Engines
from .. import trials
from ..trials import impactBlocks

JOHNSON_COOK = dict(yieldModel='johnsonCook', yieldStress=0.79e9, hardeningModulus=0.51e9, hardeningExponent=0.26, rateCoefficient=0.014, thermalSoftening=1.03,
                    meltTemperature=1793., heatCapacity=477., eos='mieGruneisen', gruneisen=1.7)


def trajectory(road, steps, rule, changes, dt=2e-8):
	"""Position, velocity, spin, pressure, plastic strain and links of the bodies after `steps` steps, (N, 8), and the number of broken links."""
	run = trials.automata(volumeRule=rule, adaptive=False)
	ids = impactBlocks(**changes)
	if road == 'law2':
		omega().engines = law2Engines(rule)
	trials.steps(run, steps, dt)
	rows = []
	for i in ids:
		s = omega().bodies[i].state
		rows.append((s.pos[0], s.pos[1], s.vel[0], s.vel[1], s.angVel[2], s.pressure, s.plasticStrain, s.links))
	counters = run.automata.counters() if road == 'engine' else omega().engines[2].counters()
	return np.array(rows), counters['brokenLinks']


def roads(report, want, quick):
	"""A block strikes another one, with plastic flow and fracture, moved by McaEngine and by Law2_ScGeom_McaPhys_Mca with NewtonIntegrator: 1000 steps of 20 ns."""
	for name, rule, changes in (('linearHardening', 'affine', {}), ('johnsonCook', 'affine', JOHNSON_COOK), ('inversePower', 'inversePower', {})):
		name = 'roads/' + name
		if not want(name) or (quick and changes): continue
		a, broken = trajectory('engine', 300 if quick else 1000, rule, changes)
		b, _ = trajectory('law2', 300 if quick else 1000, rule, changes)
		scale = abs(a).max(axis=0)
		scale[:2] = 1e-3  # positions against the spacing
		report.add(name + '/difference', (abs(a - b).max(axis=0) / scale).max(), 0., limit=1e-10, unit='relative')
		report.add(name + '/brokenLinks', broken, passed=broken > 20)
		report.add(name + '/plasticStrain', a[:, 6].max(), passed=a[:, 6].max() > 0.05)


CASES = [roads]
