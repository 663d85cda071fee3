# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases of `bench` with an exact solution: a plane elastic wave and a piston that drives an elastic precursor and a plastic shock.

Each case is a function of a job (see plan.py) that builds, runs and returns the parts of a record.
"""
import math
import time

import numpy as np

from ... import exact, scenes
from ..._yade import scene as omega
from ...packings import Rectangle, hexagonal
from ...scenes import law2Engines
from .. import trials
from ..trials import D, elastic, material
from ..verify.grid_shocks import PISTONS
from . import law
from .meter import Meter

AMPLITUDE = 1e-2  #: particle speed of the small wave [m/s]
TRAVEL = 6  #: how far each half of the pulse runs, in widths of the pulse
HALF, HEIGHT = 11, 13  #: half length and height of the body in widths: nothing that starts at an edge reaches the row that is read
ROWS, SPEED = 16, 200.  #: of the shock: automata or cells across the bar, speed of the piston [m/s]


def energyError(start, end, scale=None):
	"""Change of the independent energy sum over the energy in play; both are what energies() of an engine or coupler gives."""
	return abs(end['total'] - start['total']) / (scale or max(start['kinetic'], end['kinetic']))


def profile(x, w):
	return np.where(abs(x) < 4.5 * w, np.exp(-(x / w)**2), 0.)


def elasticWave(job):
	"""A plane P pulse of Gaussian shape, width w = n spacings, splits and runs both ways; relative L2 error of the velocities on the middle rows."""
	n, m, begin = job['n'], elastic(), time.perf_counter()
	w, c = n * D, m.cP
	length, height = 2 * HALF * n, HEIGHT * n + HEIGHT * n % 2
	middle = 0.5 * height * D
	start = -3 * w if job['solver'] == 'coupled' else 0.
	v0 = lambda x: AMPLITUDE * profile(x - start, w)
	if job['solver'] == 'coupled':
		s = trials.halves(m, (HALF + 2) * n, (HALF - 2) * n, height, velocity=lambda x, y: (v0(x), 0. * y), factor=job['factor'], account=job['account'],
		                  volumeRule=job['rule'], sleeping=job['sleeping'])
		meter = Meter(s.automata, s.grid, s.couplers)
		energies = s.couplers[0].energies
	elif job['solver'] == 'grid':
		s = trials.grid(dtFactor=job['factor'], account=job['account'], sleeping=job['sleeping'])
		x, y = np.arange(-HALF * n, HALF * n + 1) * D, np.arange(height + 1) * D
		s.grid.addRectangle(m, x, y)
		s.grid.setVelocity(0, np.stack(np.broadcast_arrays(v0(x)[None, :], 0 * y[:, None]), axis=-1))
		meter, energies = Meter(grid=s.grid), s.grid.energies
	else:
		s = trials.automata(volumeRule=job['rule'], dtFactor=job['factor'], sleeping=job['sleeping'], account=job['account'])
		p = hexagonal(D, Rectangle((0, middle), (length * D, height * D)), angle=0.5 * math.pi, origin=(0., 0.))
		v = np.stack((v0(p.positions[:, 0]), np.zeros(len(p))), axis=1)
		if job['solver'] in law.PEERS:
			c = law.elastic(job['solver'], p, v, m, job['factor'])
			meter, energies = Meter(), None
		else:
			s.add('body', p, m, velocity=v)
			if job['solver'] == 'Law2': omega().engines = law2Engines(job['rule'], job['factor'])
			meter = Meter(s.automata if job['solver'] == 'automata' else None)
			energies = s.automata.energies if job['solver'] == 'automata' else None
	built = time.perf_counter() - begin
	meter.steps(1)
	first = energies() if energies else None
	meter.until(TRAVEL * w / c)
	cost = meter.record()
	x, v = [], []
	if job['solver'] == 'grid':
		x, v = s.grid.view(0, 'x')[height // 2], s.grid.view(0, 'vx')[height // 2]
	else:
		positions = s.packings['half'].positions if job['solver'] == 'coupled' else p.positions
		rows = abs(positions[:, 1] - middle) < 0.9 * D
		x = positions[rows, 0]
		v = s.automata.field('vx')[rows] if job['solver'] in ('coupled', 'automata') else np.array([b.state.vel[0] for b in omega().bodies])[rows]
		if job['solver'] == 'coupled':
			x, v = np.append(x, s.grid.view(0, 'x')[height // 2, 1:]), np.append(v, s.grid.view(0, 'vx')[height // 2, 1:])
	t = omega().time - 0.5 * omega().dt
	there = 0.5 * (v0(x - c * t) + v0(x + c * t))
	return dict(cost, built=built, error=math.sqrt(((v - there)**2).sum() / (there**2).sum()), energyError=energyError(first, energies()) if energies and job['account'] else None)


def plasticShock(job):
	"""A piston drives steel in uniaxial strain, n automata or cells long: precursor and plastic shock; L1 error of the velocity profile over the area below it."""
	n, begin = job['n'], time.perf_counter()
	_, name, constants, _ = next(p for p in PISTONS if p[1] == '4340')
	values = dict(constants, eos='mieGruneisen', yieldModel='perfect')
	m = material(name, **values)
	ref = exact.piston(m.density, m.bulkSoundSpeed, m.hugoniotSlope, m.shearModulus, m.yieldStress, SPEED, gruneisen=m.gruneisen)
	end = 0.75 * n * D / ref['precursorD']
	if job['solver'] == 'automata':
		s = trials.bar(m, n * D, rows=ROWS, volumeRule=job['rule'], dtFactor=job['factor'], sleeping=job['sleeping'], account=job['account'],
		               contacts=False)
		driven = scenes.driveEnd(s, 'bar', SPEED)
		face = max(omega().bodies[int(i)].state.refPos[0] for i in driven)
		meter, energies = Meter(s.automata), s.automata.energies
	else:
		s = trials.grid(dtFactor=job['factor'], account=job['account'], sleeping=job['sleeping'])
		s.grid.addRectangle(m, np.arange(n + 1) * D, np.arange(ROWS + 1) * D)
		for side in 'bottom', 'top':
			s.grid.symmetry(0, side)
		s.grid.prescribe(0, 'left', x=SPEED)
		face, meter, energies = 0., Meter(grid=s.grid), s.grid.energies
	built = time.perf_counter() - begin
	meter.steps(1)
	first = energies()
	meter.until(end)
	cost, last = meter.record(), energies()
	x, v = scenes.profile(s, 'bar', 'vx') if job['solver'] == 'automata' else (s.grid.view(0, 'x')[ROWS // 2], s.grid.view(0, 'vx')[ROWS // 2])
	t = omega().time - 0.5 * omega().dt  # of the velocities; the positions belong half a step later
	x = x - face - 0.5 * omega().dt * v
	there = np.where(x < ref['D'] * t, SPEED, np.where(x < ref['precursorD'] * t, ref['precursorU'], 0.))
	keep = x > SPEED * t
	return dict(cost, built=built, error=abs(v - there)[keep].sum() / there[keep].sum(), energyError=energyError(first, last, last['kinetic']) if job['account'] else None)


CASES = dict(elasticWave=elasticWave, plasticShock=plasticShock)
