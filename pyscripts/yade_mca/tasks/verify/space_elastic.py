# SPDX-License-Identifier: GPL-2.0-or-later
"""Uniform fields, rotation, phase speeds, stable step of automata in space, and a bar in tension."""
import math

import numpy as np

from ... import exact
from ...packings import Ball, Box, fcc
from .. import trials
from ..trials import D, elastic, give, triples

POISSON = 0.3
#: directions (h, k, l) of the packing along x and y
DIRECTIONS = {'100': ((1, 0, 0), (0, 1, 1)), '110': ((1, 1, 0), (0, 0, 1)), '111': ((1, 1, 1), (1, -1, 0)), '123': ((1, 2, 3), (2, -1, 0))}
STAR = Ball((0, 0, 0), 1.1 * D)  #: an automaton and its twelve neighbours
SMALL = 1e-10  #: step in which a motion is given [s]


def randomTurn(r):
	"""A rotation (3, 3) of random direction."""
	q, t = np.linalg.qr(r.normal(size=(3, 3)))
	q *= np.sign(np.diag(t))
	return q if np.linalg.det(q) > 0 else -q


def axial(H):
	"""Vector (3,) of the antisymmetric part of a velocity gradient: the spin."""
	return 0.5 * np.array((H[2, 1] - H[1, 2], H[0, 2] - H[2, 0], H[1, 0] - H[0, 1]))


# ---- uniform fields


def deformed(H, turn, mat):
	"""(P, Mises, largest force over d^2) of the automaton in the middle after one step x -> (1 + H) x; the packing turned by `turn`."""
	run = trials.automata(contacts=False)
	p = fcc(D, Ball((0, 0, 0), 2.1 * D), orientation=turn)
	ids = run.add('ball', p, mat, fixed=True)
	give(ids, p.positions @ H.T / SMALL, axial(H) / SMALL)
	trials.steps(run, 2, SMALL)
	centre = int(np.argmin(np.linalg.norm(p.positions, axis=1)))
	return np.array((*(run.field('ball', f)[centre] for f in ('pressure', 'equivalentStress')), abs(triples(run, 'f')[centre]).max() / D**2))


def slope(at):
	"""Derivative at zero of (P, Mises)(h) by Richardson's scheme, and the largest force; Mises is even in h to first order."""
	table, force = [], 0.
	for k in range(4):
		h = 8e-3 / 2**k
		plus, minus = at(h), at(-h)
		table.append(np.array((plus[0] - minus[0], plus[1] + minus[1])) / (2 * h))
		force = max(force, plus[2] / h, minus[2] / h)
	for m in range(1, 4):
		for k in range(3, m - 1, -1):
			table[k] = table[k] + (table[k] - table[k - 1]) / (4**m - 1)
	return table[3], force


def uniform(report, want, quick):
	"""Hooke's law and Mises' yield limit in random strains with rotation, in random orientations of the packing; errors over K + 2G and over Y."""
	m, r, n = elastic(poisson=POISSON), np.random.default_rng(1), 20 if quick else 100
	K, G = m.density * m.bulkSoundSpeed**2, m.shearModulus
	fields = [(randomTurn(r), r.uniform(-1, 1, (3, 3))) for _ in range(n)]
	if want('space/uniform/hooke'):
		worst, force = 0., 0.
		for turn, H in fields:
			e = 0.5 * (H + H.T)
			dev = e - np.trace(e) / 3 * np.eye(3)
			found, f = slope(lambda h: deformed(h * H, turn, elastic(poisson=POISSON)))
			worst = max(worst, abs(found - (-K * np.trace(e), 2 * G * math.sqrt(1.5 * (dev**2).sum()))).max() / (K + 2 * G))
			force = max(force, f / (K + 2 * G))
		report.add('space/uniform/hooke', worst, 0., limit=1e-12, unit='%d orientations' % n)
		report.add('space/uniform/force', force, 0., limit=1e-12, unit='d2 (K + 2G), %d orientations' % n)
	if want('space/uniform/mises'):
		hard = lambda: elastic(poisson=POISSON, yieldModel='perfect', yieldStress=1e9)
		found = [deformed(0.03 * H, turn, hard())[1] / 1e9 for turn, H in fields]
		report.add('space/uniform/mises', abs(np.array(found) - 1).max(), 0., limit=1e-12, unit='%d orientations' % n)


# ---- rotation


def rotated(axis, angle):
	"""Rotation (3, 3) about the unit vector `axis` by `angle` [rad]."""
	across = np.cross(np.eye(3), np.asarray(axis))
	return np.eye(3) + math.sin(angle) * across + (1 - math.cos(angle)) * across @ across


def turnedStar(turns, part):
	"""Mises stress that is left over G, and relative error of the pressure, of a star that is strained, turned `turns` times in steps of 1/part, and set back."""
	run, mat = trials.automata(contacts=False), elastic(poisson=POISSON)
	r = np.random.default_rng(5)
	p = fcc(D, STAR, orientation=randomTurn(r))
	axis, H = np.array((0.4, -0.3, 0.866)) / np.linalg.norm((0.4, -0.3, 0.866)), 1e-3 * r.uniform(-1, 1, (3, 3))
	H = 0.5 * (H + H.T)
	ids, x0 = run.add('star', p, mat, fixed=True), p.positions
	centre = int(np.argmin(np.linalg.norm(x0, axis=1)))
	read = lambda: np.array([run.field('star', f)[centre] for f in ('pressure', 'equivalentStress')])

	def moveTo(x, spin):
		give(ids, (x - triples(run, 'x')) / SMALL, spin)
		trials.steps(run, 1, SMALL)

	strained = x0 @ (np.eye(3) + H).T
	moveTo(strained, (0, 0, 0))
	moveTo(strained, (0, 0, 0))
	start, a = read(), 2 * math.pi / part
	for k in range(1, turns * part + 1):
		moveTo(strained @ rotated(axis, k % part * a).T, axis * a / SMALL)
	moveTo(strained, (0, 0, 0))
	turned = read()
	moveTo(x0, (0, 0, 0))
	moveTo(x0, (0, 0, 0))
	return read()[1] / mat.shearModulus, abs(turned[0] / start[0] - 1)


def rotation(report, want, quick):
	"""Thirteen automata under stress, turned about a general axis: pressure, and directions of the tractions, after ten turns."""
	if not want('space/rotation'): return
	turns, left = 2 if quick else 10, []
	for part, limit in ((63, 3e-7), (126, 5e-9)):
		rest, pressure = turnedStar(turns, part)
		left.append(rest)
		name = 'space/rotation/%dturns/%dsteps' % (turns, part)
		report.add(name + '/stress', rest, 0., limit=limit, order=trials.order(left) if len(left) > 1 else None, unit='G')
		report.add(name + '/pressure', pressure, 0., limit=1e-10, unit='of the pressure')


# ---- waves and step


def phaseSpeeds(report, want, quick):
	"""Plane waves of the packing in four directions against its exact dispersion (Bloch analysis, linear)."""
	for name, (along, across) in DIRECTIONS.items():
		for cells in (6, 10) if quick else (6, 10, 20):
			for kind, (ref, u, turn) in zip(('P', 'S1', 'S2'), exact.fccModes(float(cells), POISSON, along)):
				case = 'space/phaseSpeed/%s/%s/%dd' % (name, kind, cells)
				if want(case): report.add(case, phaseSpeed(along, across, cells, kind, ref, u, turn), ref, limit=1e-3, unit='c')


def phaseSpeed(along, across, cells, kind, ref, u, turn):
	"""Speed over the continuum's of the wave of amplitudes u, turn (in the cube), for a quarter of its period: what the edges disturb does not reach the middle."""
	m = elastic(poisson=POISSON)
	wave, c = cells * D, m.cP if kind == 'P' else m.cS
	duration = 0.25 * wave / (c * ref)
	run = trials.automata(contacts=False, sleeping=False)
	p = fcc(D, Ball((0, 0, 0), m.cP * duration + 6 * D), orientation=(along, across))
	phase = np.exp(2j * math.pi / wave * p.positions[:, 0])[:, None]
	v, spin = 1e-3 * (phase * (u @ p.orientation)).real, 1e-3 / D * (phase * (turn @ p.orientation)).real
	ids = run.add('body', p, m, velocity=v)
	give(ids, spin=spin)
	inside = np.linalg.norm(p.positions, axis=1) < 1.6 * D
	samples = 16
	each = math.ceil(duration / samples / (0.15 * D / m.cS))
	dt, a = duration / samples / each, []
	for _ in range(samples):
		trials.steps(run, each, dt)
		a.append((triples(run, 'v')[inside] * v[inside]).sum())
	a, lag = np.array(a), samples // 4  # a(t) = cos(w (t - dt/2)): a(t+T) + a(t-T) = 2 cos(w T) a(t)
	cosine = (a[lag:-lag] * (a[2 * lag:] + a[:-2 * lag])).sum() / (2 * (a[lag:-lag]**2).sum())
	frequency = 2 / dt * math.sin(0.5 * math.acos(cosine) / (lag * each * dt) * dt)  # leapfrog runs a little fast
	return frequency * wave / (2 * math.pi) / c


def stableStep(report, want, quick):
	"""The engine's limit and the fastest motion of the packing as the engine has it, against the exact analysis; 0.98 of it stays bounded, 1.04 grows and is refused."""
	if not want('space/stableStep'): return
	m, exactly = elastic(poisson=POISSON), exact.fccStableStep(POISSON)
	unit, p = D / m.cS, fcc(D, Ball((0, 0, 0), 5.2 * D), orientation=randomTurn(np.random.default_rng(3)))
	run = trials.automata(contacts=False)
	run.add('body', p, m, angularVelocity=(1., 0., 0.))
	fastest = trials.fastestTurn(run, 'body', 'omegaX', int(np.argmin(np.linalg.norm(p.positions, axis=1))), 0.05 * unit)
	report.add('space/stableStep/fastestMotion', 2 / fastest / unit, exactly, limit=1e-6, unit='d/cS')
	for share in (0.98, 1.04):
		growth = trials.growthPerStep(fastest * share * exactly * unit)
		report.add('space/stableStep/growthOfFastestMotion/%g' % share, growth, passed=(growth > 1) == (share > 1), unit='per step of %g of the limit' % share)
	run = trials.automata(contacts=False)
	v = 1e-3 * np.random.default_rng(1).standard_normal((len(p), 3))
	ids = run.add('body', p, m, velocity=v)
	give(ids, spin=v / D)
	trials.steps(run, 1, 0.05 * unit)
	limit = run.automata.criticalTimeStep
	report.add('space/stableStep/limit', limit / unit, exactly, limit=1e-3, unit='d/cS')
	before = run.automata.energies()['kinetic']
	trials.steps(run, 1000 if quick else 5000, 0.98 * limit)
	growth = run.automata.energies()['kinetic'] / before
	report.add('space/stableStep/energy/0.98', growth, passed=growth < 2, unit='of that at the start')
	report.add('space/stableStep/refused/1.04', int('largest stable step' in trials.refusalOf(1.04 * limit)), 1, limit=0.)


# ---- tension


def bar(cells, relax):
	"""(modulus over the continuum's, largest error of the Mises stress inside and not on an edge) of a bar of {100} faces, two widths long, in plain tension.

	relax: steps in which the middle comes to rest between ends that are held; 0: in the uniform field, which is the solution but for the bar's edges.
	"""
	size, m = np.array((cells, 2 * cells, cells)) * math.sqrt(2) * D, elastic(poisson=POISSON)
	p, young, strain = fcc(D, Box((0, 0, 0), size), rim='faces'), 2 * m.shearModulus * (1 + POISSON), 1e-6
	run, x = trials.automata(contacts=False, sleeping=False), p.positions - 0.5 * size
	ids, dt = run.add('bar', p, m), 0.15 * D / m.cS
	held = abs(x[:, 1]) > 0.5 * size[1] - 0.8 * D
	give(ids, x * (-POISSON, 1, -POISSON) * strain / dt)
	trials.steps(run, 1, dt)
	give(ids, (0., 0., 0.))
	if relax: run.block(ids[held], 'xyzXYZ')
	random, done = np.random.default_rng(1), 0
	while done < relax:
		n = int(random.integers(8, 24))
		trials.steps(run, n)
		v, spin = triples(run, 'v', 'omega')
		give(ids, 0.85 * v, 0.85 * spin)
		done += n
	trials.steps(run, 1)
	f, mises = triples(run, 'f'), run.field('bar', 'equivalentStress')
	force = -f[(x[:, 1] > 0) & (held | (relax == 0)), 1].sum()
	edge = (np.minimum(p.positions, size - p.positions)[:, [0, 2]] < 0.1 * D).all(axis=1)
	middle = (abs(x[:, 1]) < 0.25 * size[1]) & ~edge
	return force / (young * strain * size[0] * size[2]), abs(mises[middle] / (young * strain) - 1).max()


def tension(report, want, quick):
	"""A bar with rim='faces': its modulus, at once in the uniform field and at rest between ends that are held."""
	for name, relax, limits in (('uniform', 0, (3e-4, 3e-4)), ('atRest', 1000 if quick else 2000, (1e-3, None))):
		if not want('space/tension/' + name): continue
		errors = []
		for cells in (4, ) if quick else (4, 8):
			modulus, mises = bar(cells, relax)
			errors.append(abs(modulus - 1))
			report.add('space/tension/%s/modulus/%d' % (name, cells), modulus, 1., limit=limits[0], order=trials.order(errors) if len(errors) > 1 else None)
			report.add('space/tension/%s/mises/%d' % (name, cells), mises, 0., limit=limits[1])


CASES = [uniform, rotation, phaseSpeeds, stableStep, tension]
