# SPDX-License-Identifier: GPL-2.0-or-later
"""Uniform fields, rotation, phase speeds and stable step of the automata."""
import math

import numpy as np

from ... import exact
from ..._yade import scene as omega
from ...exact.lattice import _dynamicalMatrix
from ...packings import Rectangle, disc, hexagonal
from .. import trials
from ..trials import D, elastic

POISSON = 0.3
RULES = ('affine', 'inversePower', 'meanDistance')
ANGLES = {'0': 0., '17deg': math.radians(17), '30deg': math.pi / 6, '90deg': math.pi / 2}
#: phase speeds of the hexagonal packing over those of the continuum for POISSON, waves along close-packed rows; to be met within 0.1 %
TABLE = {'P': {6: 0.926, 10: 0.972, 20: 0.993, 40: 0.998}, 'S': {6: 0.983, 10: 0.994, 20: 0.9985, 40: 0.9996}}
MODES = {'dilatation': ((1, 0), (0, 1)), 'shear': ((1, 0), (0, -1)), 'shear45': ((0, 1), (1, 0)), 'uniaxialX': ((1, 0), (0, 0)), 'general': ((0.4, -0.7), (0.2, 0.9))}


def deformed(H, angle, rule, mat):
	"""(P, Mises, s_zz) of an interior automaton of a block after one step x -> (1 + H) x."""
	run = trials.automata(volumeRule=rule, contacts=False)
	p = hexagonal(D, Rectangle((0, 0), (10 * D, 10 * D)), angle=angle, rim='full')
	ids = run.add('block', p, mat, fixed=True)
	dt = 1e-10
	v = p.positions @ np.asarray(H, float).T / dt
	trials.move(ids, v[:, 0], v[:, 1], 0.5 * (H[1][0] - H[0][1]) / dt)
	trials.steps(run, 2, dt)
	centre = int(np.argmin(np.hypot(*p.positions.T)))
	return np.array([run.field('block', f)[centre] for f in ('pressure', 'equivalentStress', 'stressZZ')])


def slope(at):
	"""Derivative at zero of (P, Mises, s_zz)(h) by Richardson's scheme; Mises is even in h to first order, the others odd."""
	table = []
	for k in range(4):
		h = 8e-3 / 2**k
		plus, minus = at(h), at(-h)
		table.append(np.array((plus[0] - minus[0], plus[1] + minus[1], plus[2] - minus[2])) / (2 * h))
	for m in range(1, 4):
		for k in range(3, m - 1, -1):
			table[k] = table[k] + (table[k] - table[k - 1]) / (4**m - 1)
	return table[3]


def uniform(report, want, quick):
	"""Hooke's law and Mises' yield limit in homogeneous fields; errors over K + 2G and over Y."""
	m = elastic(poisson=POISSON)
	K, G = m.density * m.bulkSoundSpeed**2, m.shearModulus
	for rule in RULES[:1] if quick else RULES:
		for name, angle in ANGLES.items():
			if not want('uniform/hooke/%s/%s' % (rule, name)): continue
			worst, isotropy = 0., []
			for mode in MODES.values():
				H = np.array(mode, float)
				e = 0.5 * (H + H.T)
				dev = np.diag((e[0, 0], e[1, 1], 0.)) - np.trace(e) / 3 * np.eye(3)
				dev[0, 1] = dev[1, 0] = e[0, 1]
				reference = np.array((-K * np.trace(e), 2 * G * math.sqrt(1.5 * (dev**2).sum()), 2 * G * dev[2, 2]))
				found = slope(lambda h: deformed(h * H, angle, rule, elastic(poisson=POISSON)))
				worst = max(worst, abs(found - reference).max() / (K + 2 * G))
			report.add('uniform/hooke/%s/%s' % (rule, name), worst, 0., limit=1e-12)
	if not want('uniform/mises'): return
	worst = 0.
	for name, angle in ANGLES.items():
		for mode in MODES.values():
			hard = elastic(poisson=POISSON, yieldModel='perfect', yieldStress=1e9)
			worst = max(worst, abs(deformed(0.03 * np.array(mode, float), angle, 'affine', hard)[1] / 1e9 - 1))
	report.add('uniform/mises', worst, 0., limit=1e-12)


def rotation(report, want, quick):
	"""A hexagon of 7 automata, turned rigidly in steps of half a degree."""
	if not want('rotation'): return
	turns, part = 2 if quick else 15, 720
	run = trials.automata(contacts=False)
	p = hexagonal(D, disc((0, 0), 1.2 * D), rim='full')
	ids = run.add('body', p, elastic(poisson=POISSON), fixed=True)
	bodies = [omega().bodies[int(i)].state for i in ids]
	a, dt = 2 * math.pi / part, 1e-10
	x0 = p.positions
	run.automata.adaptive, omega().dt = False, dt
	x, stress = x0.copy(), 0.
	for k in range(1, turns * part + 1):
		c, s = math.cos(k % part * a), math.sin(k % part * a)
		v = (x0 @ np.array(((c, s), (-s, c))) - x) / dt
		spin = (0., 0., a / dt)
		for b, (vx, vy) in zip(bodies, v.tolist()):
			b.vel, b.angVel = (vx, vy, 0.), spin
		run.automata.reload()
		omega().step()
		run.automata.sync()
		x = np.array([(b.pos[0], b.pos[1]) for b in bodies])
		if k % part == 0 or k == 1:
			stress = max(stress, abs(run.automata.field('pressure')).max(), run.automata.field('equivalentStress').max())
	report.add('rotation/%dturns/stress' % turns, stress / elastic(poisson=POISSON).shearModulus, 0., limit=1e-11, unit='G')
	turned = abs(run.automata.field('angle')).min() / (2 * math.pi)
	report.add('rotation/%dturns/angle' % turns, turned, turns, limit=1e-9, unit='turns')


def phaseSpeeds(report, want, quick):
	"""Standing plane waves of the packing against its exact dispersion (Bloch analysis, linear)."""
	m = elastic(poisson=POISSON)
	for kind in 'P', 'S':
		for cells, angle in ((6, 0.), (10, 0.), (20, 0.), (40, 0.), (10, math.pi / 2)):
			name = 'phaseSpeed/%s/%s/%dd' % (kind, 'across' if angle else 'along', cells)
			if not want(name) or (quick and cells > 10): continue
			wave, c = cells * D, m.cP if kind == 'P' else m.cS
			ref = exact.hexagonalSpeeds(float(cells), POISSON, angle)[0 if kind == 'P' else 1]
			period = wave / (c * ref)
			duration = 0.5 * period
			half = m.cP * duration + 6 * D  # what the edges disturb does not reach the middle
			# the mode (u along x, u along y, R spin) of this wave; the packing's x runs along the close-packed rows
			k = 2 * math.pi / cells
			w2, modes = np.linalg.eig(_dynamicalMatrix(k * np.array((math.cos(angle), math.sin(angle))), 1 / 3 * 2 * 1.3 / 0.4, 1.))
			at = np.argmin(abs(np.sqrt(w2.real) - ref * (math.sqrt(2 * 1.3 / (3 * 0.4) + 4 / 3) if kind == 'P' else 1.) * k))
			turn = np.array(((math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle))))
			u = turn @ modes[:2, at]
			u, spin = np.append(u, 0) / u[np.argmax(abs(u))], modes[2, at] / u[np.argmax(abs(u))]
			run = trials.automata(contacts=False, sleeping=False)
			p = hexagonal(D, Rectangle((0, 0), (2 * half + wave, 2 * half)), angle=-angle, rim='full')
			phase = np.exp(1j * k / D * p.positions[:, 0])
			v = [1e-3 * (q * phase).real for q in (u[0], u[1], spin / (0.5 * D))]
			ids = run.add('body', p, m, velocity=np.stack(v[:2], axis=1))
			for i, w in zip(ids.tolist(), v[2].tolist()):
				omega().bodies[i].state.angVel = (0, 0, w)
			inside = (abs(p.positions[:, 0]) < 0.5 * wave - 1e-6 * D) & (abs(p.positions[:, 1]) < 2 * D)
			steps = 16 * max(8, math.ceil(duration / 16 / (0.3 * D / (math.sqrt(8) * m.cS))))
			dt, component = duration / steps, 'vx' if kind == 'P' else 'vy'
			record = []
			for _ in range(16):
				trials.steps(run, steps // 16, dt)
				record.append((run.automata.field(component)[inside] * phase.real[inside]).sum())
			a = np.array(record)  # a(t) = cos(w (t - dt/2)): a(t+T) + a(t-T) = 2 cos(w T) a(t)
			lag = 4
			cosine = (a[lag:-lag] * (a[2 * lag:] + a[:-2 * lag])).sum() / (2 * (a[lag:-lag]**2).sum())
			frequency = 2 / dt * math.sin(0.5 * math.acos(cosine) / (lag * duration / 16) * dt)  # leapfrog runs a little fast
			found = frequency * wave / (2 * math.pi) / c
			if angle == 0: report.add(name, found, TABLE[kind][cells], limit=1e-3, unit='c')
			report.add(name + '/exact', found, ref, limit=1e-3, unit='c')


def stableStep(report, want, quick):
	"""The engine's limit and the fastest mode of the packing as the engine has it, against the exact analysis; a run near the limit stays bounded, above it is refused."""
	if not want('stableStep'): return
	p = hexagonal(D, Rectangle((0, 0), (12 * D, 12 * D)), rim='full')
	m, exactly = elastic(poisson=POISSON), exact.hexagonalStableStep(POISSON)
	unit = 0.5 * D / m.cP
	run = trials.automata(contacts=False)
	run.add('body', p, m, angularVelocity=1.)
	fastest = trials.fastestTurn(run, 'body', 'omega', int(np.argmin(np.hypot(*p.positions.T))), 0.1 * unit)
	report.add('stableStep/fastestMode', 2 / fastest / unit, exactly, limit=1e-6, unit='R/cP')
	for share in (1.2, 1.4):
		growth = trials.growthPerStep(fastest * share * unit)
		report.add('stableStep/growthOfFastestMode/%g' % share, growth, passed=(growth > 1) == (share > exactly), unit='per step of %g R/cP' % share)
	run = trials.automata(contacts=False)
	run.add('body', p, m, velocity=1e-3 * np.random.default_rng(1).standard_normal((len(p), 2)))
	trials.steps(run, 1, 0.1 * unit)
	report.add('stableStep/limit', run.automata.criticalTimeStep / unit, exactly, limit=0.01, unit='R/cP')
	before = run.automata.energies()['kinetic']
	trials.steps(run, 3000, 1.2 * unit)
	growth = run.automata.energies()['kinetic'] / before
	report.add('stableStep/energyAfter3000Steps/1.2', growth, passed=growth < 2, unit='of that at the start')
	report.add('stableStep/refused/1.4', int('largest stable step' in trials.refusalOf(1.4 * unit)), 1, limit=0.)


CASES = [uniform, rotation, phaseSpeeds, stableStep]
