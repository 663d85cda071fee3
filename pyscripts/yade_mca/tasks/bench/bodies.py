# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases of `bench` without an exact solution: Taylor bar, a plate with a wave, penetration. Errors are against the finest run (results.py).

Each case is a function of a job (see plan.py) that builds, runs and returns the parts of a record; `result` is what errors are made of.
"""
import time

import __main__
import numpy as np

from ... import scenes
from ..._yade import scene as omega
from ..._yade import yadeClass
from ..trials import PITCH, elastic, material
from .meter import Meter
from .waves import energyError

TAYLOR = dict(length=25.4e-3, diameter=7.62e-3, speed=190., until=70e-6)  #: bar of copper [m], [m/s], [s]
THICKNESS, COARSE = 25e-3, 25e-3 / 12  #: of the plate; spacing whose multiples the widths are, so that all spacings fit [m]
SPOT, UNTIL, PERIOD = 8e-3, 60e-6, 0.25e-6  #: radius of the blow [m], end and sampling period [s]
PROBES, REACH = ((0., -12.5e-3), (20e-3, -20e-3), (-28e-3, -5e-3)), 4e-3  #: where the motion is read, over what distance [m]


def engineOptions(job):
	return dict(volumeRule=job['rule'], sleeping=job['sleeping'], account=job['account'])


def taylorBar(job):
	"""Copper bar on a rough rigid anvil, n automata across: final length and width of the foot over the original ones."""
	begin, d = time.perf_counter(), TAYLOR['diameter'] / job['n']
	m = material('OFHC_Cu', eos='shockAdiabat', yieldModel='johnsonCook', fractureStrain=1.)
	s = scenes.taylorBar(m, TAYLOR['length'], TAYLOR['diameter'], d, TAYLOR['speed'], anvil='rough', engineOptions=dict(engineOptions(job), dtFactor=job['factor']))
	meter, built = Meter(s.automata), time.perf_counter() - begin
	meter.until(TAYLOR['until'])
	cost, e = meter.record(), s.automata.energies()
	x, y = s.field('bar', 'x'), s.field('bar', 'y')
	x0, y0 = s.packings['bar'].positions.T  # outlines run through centres, at whole numbers of rows
	result = dict(length=np.ptp(y) / np.ptp(y0), foot=np.ptp(x[y < y.min() + 3 * d]) / np.ptp(x0))
	return dict(cost, built=built, spacing=d, result=result, energyError=abs(e['total'] / e['kineticStart'] - 1) if job['account'] else None)


def fitted(width):
	"""The width [m] nearest to `width` at which columns of all spacings COARSE/2^k end."""
	return 2 * round(0.5 * width / (PITCH * COARSE)) * PITCH * COARSE


def plateWave(job):
	"""A plate held at its ends is hit in the middle; elastic waves run to the ends and back. n: automata over the thickness, width [mm].

	The signal is the velocity around three points among the automata, each a mean over the mass with a Gaussian weight.
	"""
	begin, d, coupled = time.perf_counter(), THICKNESS / job['n'], job['solver'] == 'coupled'
	width = fitted(1e-3 * job['width'])
	automataWidth, mode = (fitted(80e-3), 'coupled') if coupled else (width, 'mca')
	s = scenes.tiedPlate(elastic(), THICKNESS, d, automataWidth, width, mode, 'fixed', dtFactor=job['factor'], engineOptions=engineOptions(job))
	p, mass = s.packings['plate'].positions, s.packings['plate'].weight
	o = omega()
	r2 = (p**2).sum(axis=1)
	for i, v in zip(s.ids['plate'].tolist(), np.where(r2 < (3 * SPOT)**2, np.exp(-r2 / SPOT**2), 0.).tolist()):
		if v and not o.bodies[i].state.blockedDOFs.startswith('xy'): o.bodies[i].state.vel = (0, -v, 0)
	distance = np.array([((p - at)**2).sum(axis=1) for at in PROBES])
	weight = np.where(distance < (2.3 * REACH)**2, np.exp(-distance / REACH**2), 0.) * mass
	weight /= weight.sum(axis=1)[:, None]
	rows = []
	__main__.benchSample = lambda: rows.append((o.time + 0.5 * o.dt, *(weight @ s.field('plate', 'vx')), *(weight @ s.field('plate', 'vy'))))  # at the end of a step, before O.time is moved on
	o.engines = [*o.engines, yadeClass('PyRunner')(command='benchSample()', virtPeriod=PERIOD)]
	meter, built = Meter(s.automata, s.grid, s.couplers), time.perf_counter() - begin
	meter.steps(1)
	energies = s.couplers[0].energies if coupled else s.automata.energies
	first = energies()
	meter.until(UNTIL + 2 * PERIOD)
	return dict(meter.record(), built=built, spacing=d, signal=np.array(rows).T.tolist(), energyError=energyError(first, energies()) if job['account'] else None)


def penetration(job):
	"""The rod through a plate of 25 mm, n automata over its thickness, to a time [us]: losses of the rod."""
	from ...impact import Impact
	begin = time.perf_counter()
	s = scenes.penetration(thickness=THICKNESS, spacing=THICKNESS / job['n'], mode='mca' if job['solver'] == 'automata' else 'coupled', ends='fixed', account=job['account'], dtFactor=job['factor'],
	                       automataWidth=1e-3 * (job['width'] if job['solver'] == 'automata' else 80), plateWidth=1e-3 * job['width'], engineOptions=engineOptions(job))
	run, meter = Impact(s, until=1e-6 * job['until']), Meter(s.automata, s.grid, s.couplers)
	built = time.perf_counter() - begin
	while not run.finished:
		run.advance()
		meter.runs += 1
	at = run.at(1e-6 * job['until'])
	return dict(meter.record(), built=built, spacing=THICKNESS / job['n'], result={k: at[k] for k in ('lengthLoss', 'velocityLossTail', 'velocityLossAll')},
	            energyError=run.sane()['energySum'] if job['account'] else None)


CASES = dict(taylorBar=taylorBar, plateWave=plateWave, penetration=penetration)
