# SPDX-License-Identifier: GPL-2.0-or-later
"""Free bodies in space: vibration, rotation, a spinning top, a collision. Energy, momentum and angular momentum; the same bits on one thread and two."""
import hashlib
import math
import os
import subprocess
import sys

import numpy as np
from scipy.integrate import solve_ivp

from ... import _yade
from ..._yade import scene as omega
from ...packings import Ball, Box, fcc
from .. import trials
from ..trials import D, HARD, elastic, give, material, triples
from .space_elastic import POISSON, randomTurn, rotated

SHARE = 0.4  #: of the largest stable step
AXIS = np.array((0.4, -0.3, 0.866)) / np.linalg.norm((0.4, -0.3, 0.866))  #: of rotation: in no direction of a packing
SPIN = 0.01  #: of rotating bodies, in c0/d


class Ellipsoid:
	"""Shape with half axes [m] along x, y, z about the origin."""

	def __init__(self, *half):
		self.half = np.array(half)

	def aabb(self):
		return -self.half, self.half

	def inside(self, points):
		return ((np.asarray(points) / self.half)**2).sum(axis=1) < 1


def momenta(run):
	"""Momentum and angular momentum now, (3,) each [kg m/s, kg m2/s]."""
	e = run.automata.energies()
	return tuple(np.array([e[name + c] for c in 'XYZ']) for name in ('momentum', 'angularMomentum'))


def stored(run):
	"""Kinetic and elastic energy at the time of the stresses [J]."""
	e = run.automata.energies()
	return e['kinetic'] + e['halfStep'] + e['volumetric'] + e['deviatoric']


def free(shape, mat, velocity, spin=None, seed=11):
	"""Run of a free body with rough faces in a random orientation, about its centre of mass; velocity(x) -> (N, 3) [m/s], its mean is taken off; spin (3,) [1/s]."""
	run = trials.automata(contacts=False, account=True)
	p = fcc(D, shape, orientation=randomTurn(np.random.default_rng(seed)))
	p = p.translated(-p.positions.mean(axis=0))
	v = velocity(p.positions)
	ids = run.add('body', p, mat, velocity=v - v.mean(axis=0))
	if spin is not None: give(ids, spin=spin)
	trials.fixedStep(run, 1e-12)
	omega().step()
	trials.fixedStep(run, SHARE * run.automata.criticalTimeStep)
	return run


def watched(run, steps, every, look=None):
	"""Runs so many steps; mean energy of the first and the last tenth [J], and look(run) after each `every` steps."""
	energy, seen = [], []
	for _ in range(steps // every):
		_yade.steps(every)
		energy.append(stored(run))
		if look: seen.append(look(run))
	tenth = max(len(energy) // 10, 1)
	return np.mean(energy[:tenth]), np.mean(energy[-tenth:]), seen


def addMomenta(report, name, before, after, scale, reach, unit):
	"""Changes of momentum and angular momentum; scale: sqrt(2 m E) [kg m/s], reach [m]: what makes an angular momentum of it."""
	report.add(name + '/momentum', np.linalg.norm(after[0] - before[0]) / scale, 0., limit=1e-13, unit=unit)
	report.add(name + '/angularMomentum', np.linalg.norm(after[1] - before[1]) / (scale * reach), 0., limit=1e-13, unit=unit)


# ---- vibration


def vibration(report, want, quick):
	"""A rough ellipsoid without viscosity vibrates in long waves and short ones: energy of the last tenth over that of the first."""
	if not want('space/vibration'): return
	steps, m, r = 20000 if quick else 100000, elastic(poisson=POISSON), np.random.default_rng(12)
	size = 1e-4 * m.bulkSoundSpeed

	def velocity(x):
		q = x / D
		return size * (np.stack((2 * np.sin(0.5 * q[:, 0]), q[:, 2] / 3, -np.sin(0.4 * q[:, 0])), axis=1) + r.uniform(-1, 1, q.shape))

	run = free(Ellipsoid(6.4 * D, 4.4 * D, 3.1 * D), m, velocity)
	before, mass = momenta(run), run.automata.field('mass').sum()
	first, last, _ = watched(run, steps, 50)
	unit = '%d automata, %g steps' % (run.automata.count, steps)
	report.add('space/vibration/energy', last / first - 1, 0., limit=3e-4, unit=unit)
	addMomenta(report, 'space/vibration', before, momenta(run), math.sqrt(2 * first * mass), 6.4 * D, unit)


# ---- rotation


def turning(report, want, quick):
	"""A brick turns freely about a general axis, its corners at 0.05 c0."""
	if not want('space/turning'): return
	m, turns = elastic(poisson=POISSON), 2 if quick else 10
	w = SPIN * m.bulkSoundSpeed / D * AXIS
	run = free(Box((-4.1 * D, -2.6 * D, -2.1 * D), (4.1 * D, 2.6 * D, 2.1 * D)), m, lambda x: np.cross(w, x), w, seed=13)
	before, mass = momenta(run), run.automata.field('mass').sum()
	first, last, _ = watched(run, round(turns * 2 * math.pi / np.linalg.norm(w) / omega().dt), 25)
	unit = '%d automata, %d turns' % (run.automata.count, turns)
	report.add('space/turning/energy', last / first - 1, 0., limit=1e-5, unit=unit)
	addMomenta(report, 'space/turning', before, momenta(run), math.sqrt(2 * first * mass), 4.1 * D, unit)


# ---- a top


def attitude(x0, x):
	"""Rotation (3, 3) that takes the places x0 nearest to x, both (N, 3)."""
	u, _, vt = np.linalg.svd((x - x.mean(axis=0)).T @ (x0 - x0.mean(axis=0)))
	return u @ np.diag((1, 1, np.linalg.det(u @ vt))) @ vt


def rigid(inertia, w, times):
	"""Attitudes (3, 3) at `times` [s] of a rigid free body of this tensor of inertia (3, 3) that starts with the spin w (3,) [1/s]; Euler's equations."""
	inverse = np.linalg.inv(inertia)

	def rate(t, y):
		R, spin = y[:9].reshape(3, 3), y[9:]  # spin: in the body
		return np.append((R @ np.cross(np.eye(3), spin)).ravel(), inverse @ np.cross(inertia @ spin, spin))

	found = solve_ivp(rate, (0, times[-1]), np.append(np.eye(3).ravel(), w), method='DOP853', rtol=1e-11, atol=1e-11, t_eval=times)
	return found.y[:9].T.reshape(-1, 3, 3)


def spun(share, turns):
	"""A top spun near its middle axis at `share` c0/d; (run, energies, momenta before, largest part of a half turn that it has tumbled, attitude error in rad at each look)."""
	m, shape = elastic(poisson=POISSON), Ellipsoid(5 * D, 3 * D, 1.6 * D)
	w = share * m.bulkSoundSpeed / D * np.array((0.05, 1., 0.05))
	run = free(shape, m, lambda x: np.cross(w, x), w, seed=17)
	before, dt = momenta(run), omega().dt
	x0, mass = run.packings['body'].positions, run.automata.field('mass')
	own = run.packings['body'].inertias(m.density).sum()
	inertia = (mass[:, None, None] * ((x0**2).sum(axis=1)[:, None, None] * np.eye(3) - x0[:, :, None] * x0[:, None, :])).sum(axis=0) + own * np.eye(3)
	steps = round(turns * 2 * math.pi / np.linalg.norm(w) / dt)
	first, last, turned = watched(run, steps, 50, lambda run: attitude(x0, triples(run, 'x')))
	exactly = rigid(inertia, w, dt * 50 * np.arange(1, len(turned) + 1))
	off = [math.acos(max(-1., min(1., 0.5 * (np.trace(R.T @ Q) - 1)))) for R, Q in zip(turned, exactly)]
	tumbled = max(math.acos(max(-1., min(1., Q[1] @ w / np.linalg.norm(w)))) for Q in np.transpose(turned, (0, 2, 1))) / math.pi
	return run, (first, last), before, tumbled, off


def top(report, want, quick):
	"""A top with three different moments of inertia spins about its middle axis and tumbles, as a rigid one does but for what it stretches, which goes with the square of its speed."""
	if not want('space/top'): return
	turns, errors = 3 if quick else 12, []
	for share in (SPIN, 0.5 * SPIN):
		run, (first, last), before, tumbled, off = spun(share, turns)
		name, unit = 'space/top/%gc0' % share, '%d automata, %d turns' % (run.automata.count, turns)
		report.add(name + '/energy', last / first - 1, 0., limit=1e-5, unit=unit)
		addMomenta(report, name, before, momenta(run), math.sqrt(2 * first * run.automata.field('mass').sum()), 5 * D, unit)
		report.add(name + '/tumbled', tumbled, passed=tumbled > 0.5, unit='of a half turn of the middle axis')
		errors.append(max(off))
		rate = trials.order(errors) if len(errors) > 1 else None
		report.add(name + '/attitude', errors[-1], 0., order=rate, unit='rad, largest, against Euler', passed=None if rate is None else 1.7 < rate < 2.3)


# ---- collision


def balls(radius=3.2, speed=200., offset=0.8, changes=(), **options):
	"""Two balls of hard steel, with `changes`, fly at each other, not head on, and spin; radius in spacings, speed of each [m/s], offset of their lines in radii."""
	run, m, r = trials.automata(account=True, **options), material('4340', **dict(HARD, **dict(changes))), np.random.default_rng(21)
	for k, side in enumerate((-1, 1)):
		p = fcc(D, Ball((0, 0, 0), radius * D), orientation=randomTurn(r))
		spin = side * 0.2 * speed / (radius * D) * rotated(AXIS, 0.7) @ (0.6, 0., 0.8)
		at = np.array((side * (radius + 0.6) * D, side * 0.5 * offset * radius * D, 0.1 * radius * D * side))
		v = np.array((-side * speed, 0., 0.)) + np.cross(spin, p.positions)
		ids = run.add('ball%d' % k, p.translated(at), m, velocity=v, mask=1 + k)
		give(ids, spin=spin)
	return run


def collided(factor, changes):
	"""Run of two balls to the end of their collision, momenta at the start and the largest errors of the booked energy and of the independent sum."""
	run = balls(dtFactor=factor, changes=changes)
	omega().step()
	before, E, worst = momenta(run), run.automata.energies()['kineticStart'], np.zeros(2)
	while omega().time < 3e-5:
		trials.steps(run, 20)
		e = run.automata.energies()
		worst = np.maximum(worst, (abs(e['bookedError']) / E, abs(e['total'] / E - 1)))
	return run, before, worst


def collision(report, want, quick):
	"""Two balls collide with plastic flow and friction, whole and breaking, and part again: momenta, both sums of the energy, and what they dissipate."""
	kinds = {'whole': (dict(fractureStrain=1e9, spallStrength=1e15), ('plastic', 'viscous', 'friction')), 'breaking': ({}, ('plastic', 'viscous', 'friction', 'fracture'))}
	fine  = 0.05
	for kind, (changes, losses) in kinds.items():
		name = 'space/collision/' + kind
		if not want(name): continue
		run, before, worst = collided(SHARE, changes)
		e, mass, broken = run.automata.energies(), run.automata.field('mass').sum(), run.automata.counters()['brokenLinks']
		E = e['kineticStart']
		addMomenta(report, name, before, momenta(run), math.sqrt(2 * E * mass), 3.2 * D, 'of sqrt(2 m E)')
		report.add(name + '/bookedEnergy', worst[0], 0., limit=1e-12, unit='of the kinetic energy')
		report.add(name + '/energySum', worst[1], 0., limit=1e-3, unit='of the kinetic energy')
		for what in losses:
			report.add('%s/share/%s' % (name, what), e[what] / E, unit='of the kinetic energy', passed=e[what] > 1e-3 * E)
		report.add(name + '/brokenLinks', broken, passed=(broken > 20) == (kind == 'breaking'))
		_, _, better = collided(fine, changes)
		report.add('%s/energySum/dtFactor%g' % (name, fine), better[1], 0., order=trials.order([worst[1], better[1]], SHARE / fine), unit='of the kinetic energy',
		           passed=better[1] < 0.5 * worst[1])


def bits(steps):
	"""Fingerprint of the state of two large balls after a collision of `steps` steps, and the broken links."""
	run = balls(radius=7.2)
	_yade.steps(steps)
	found = run.automata.fields(['x', 'y', 'z', 'vx', 'vy', 'vz', 'omegaX', 'omegaY', 'omegaZ', 'pressure', 'equivalentStress', 'plasticStrain'])
	return hashlib.sha256(b''.join(np.ascontiguousarray(found[k]).tobytes() for k in sorted(found))).hexdigest(), run.automata.counters()['brokenLinks']


def threads(report, want, quick):
	"""The same collision on one thread and on two, in processes of their own."""
	if not want('space/threads'): return
	found = []
	for n in '1', '2':
		code = 'from yade_mca.tasks.verify.space_balance import bits; print(*bits(%d))' % (300 if quick else 600)
		r = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, stdin=subprocess.DEVNULL,
		                   env=dict(os.environ, OMP_NUM_THREADS=n, PYTHONPATH=os.pathsep.join(filter(None, sys.path))))
		if r.returncode: raise RuntimeError('the run on %s threads ended: %s' % (n, ' '.join(r.stderr.split())[-300:]))
		found.append(r.stdout.split()[-2:])
	report.add('space/threads/sameBits', int(found[0][0] == found[1][0]), 1, limit=0., unit='1 and 2 threads')
	report.add('space/threads/brokenLinks', int(found[0][1]), passed=int(found[0][1]) > 20)


CASES = [vibration, turning, top, collision, threads]
