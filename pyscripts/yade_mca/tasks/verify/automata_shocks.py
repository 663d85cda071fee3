# SPDX-License-Identifier: GPL-2.0-or-later
"""Pistons and plate impacts of automata: Hugoniot with strength, elastic precursor, impedance match."""
import math

import numpy as np
from scipy.optimize import brentq

from ... import exact, scenes
from ..._yade import scene as omega
from ...packings import Rectangle, hexagonal
from .. import trials
from ..trials import D, between, crossing, material, order
from .grid_shocks import PISTONS

DIRECTIONS = {'along': 0., 'across': math.pi / 2}
LIMITS = {'along': 0.006, 'across': 0.006}
RULES = 'affine', 'inversePower', 'meanDistance'


def fronts(bar, read, ref, up, length, shares):
	"""Speeds of precursor and main shock from the positions of both fronts at several times, and the last profile. read(name): profiles of x and of a field."""
	found = []
	for share in shares:
		trials.until(bar, share * length / max(ref['precursorD'], ref['D']))
		x, v = read('vx')
		t = omega().time - 0.5 * omega().dt  # of the velocities; the positions belong half a step later
		pre = ref['precursorU'] if ref['waves'] == 'two' else 0.
		found.append((t, crossing(x, v, 0.5 * pre) if pre else math.nan, crossing(x, v, 0.5 * (up + pre))))
	found = np.array(found)
	fit = lambda k: np.polyfit(found[:, 0], found[:, k], 1)[0] if np.isfinite(found[:, k]).all() else math.nan
	return fit(1), fit(2), found[-1, 1], found[-1, 2]


def drive(mat, up, angle, rule, columns, rows):
	bar = trials.bar(mat, columns * D, angle=angle, rows=rows, volumeRule=rule, contacts=False)
	scenes.driveEnd(bar, 'bar', up)
	return bar


def piston(share):
	"""Copper with Y = 0.01 K, the speed of a piston at share * c0, and the exact solution."""
	m = material('OFHC_Cu', eos='shockAdiabat', yieldModel='perfect')
	m.yieldStress = 0.01 * m.density * m.bulkSoundSpeed**2
	up = share * m.bulkSoundSpeed
	return m, up, exact.piston(m.density, m.bulkSoundSpeed, m.hugoniotSlope, m.shearModulus, m.yieldStress, up)


def shocked(share, angle, rule, columns, rows=16):
	"""Shock speed, pressure behind it and the exact solution, of piston()."""
	m, up, ref = piston(share)
	bar = drive(m, up, angle, rule, columns, rows)
	_, speed, _, front = fronts(bar, lambda name: scenes.profile(bar, 'bar', name), ref, up, columns * D, np.linspace(0.4, 0.75, 6))
	x, P = scenes.profile(bar, 'bar', 'pressure')
	return speed, between(x, P, x[0], front), ref


def hugoniot(report, want, quick):
	"""Piston into copper with strength: shock speed and pressure for three strengths of shock, the volume rules side by side; limits for the default rule."""
	for rule in RULES:
		for direction, angle in DIRECTIONS.items():
			for share in (0.05, 0.1, 0.2):
				name = 'hugoniot/%s/%s/U%.2f' % (rule, direction, share)
				if not want(name) or (quick and (rule != 'affine' or share == 0.1)): continue
				limit = LIMITS[direction] if rule == 'affine' else None
				try:
					speed, P, ref = shocked(share, angle, rule, 250)
				except (RuntimeError, IndexError) as e:  # the packing of the published rule collapses, or no front is found
					if limit is not None: raise
					report.extra.setdefault('automata', {})[name] = str(e)
					continue
				report.add(name + '/speed', speed, ref['D'], limit=limit, unit='m/s')
				report.add(name + '/pressure', P, ref['P'], limit=limit, unit='Pa')


def hugoniotTurned(report, want, quick):
	"""The same with rows at 15 degrees to the shock. Such a packing has no lines of symmetry to be held at: the middle of a block so wide that its edges are not felt there."""
	columns, height, angle = 150, 160, math.radians(15)
	for share in (0.05, 0.1, 0.2):
		name = 'hugoniot/affine/15deg/U%.2f' % share
		if not want(name) or quick: continue
		m, up, ref = piston(share)
		s = trials.automata(contacts=False)
		p = hexagonal(D, Rectangle((0.5 * columns * D, 0.), (columns * D, height * D)), angle=angle, rim='triangles')
		ids, (x, y) = s.add('bar', p, m), p.positions.T
		s.block(ids[abs(y) > abs(y).max() - 2.6 * D], 'yZ')
		pushed = ids[x < x.min() + 2.2 * D]
		s.block(pushed, 'xyZ')
		for i in pushed.tolist():
			omega().bodies[i].state.vel = (up, 0., 0.)
		middle = abs(y) < 12 * D
		column = np.floor((x[middle] - x[middle].min()) / D).astype(int)
		mean = lambda f: np.bincount(column, f[middle]) / np.bincount(column)
		read = lambda *names: [mean(f) for f in (s.fields('bar', ('x', *names))[n] for n in ('x', *names))]
		_, speed, _, front = fronts(s, read, ref, up, columns * D, np.linspace(0.4, 0.75, 6))
		x, P = read('pressure')
		report.add(name + '/speed', speed, ref['D'], limit=0.01, unit='m/s')
		report.add(name + '/pressure', between(x, P, x[0], front), ref['P'], limit=0.01, unit='Pa')


def hugoniotLength(report, want, quick):
	"""The measured speed against the length of the bar: what a bar of 250 columns is off in a weak shock is the time that the front needs to form."""
	if not want('hugoniotLength'): return
	for share in (0.05, 0.1):
		errors = []
		for columns in (125, 250) if quick else (125, 250, 500, 1000):
			speed, _, ref = shocked(share, 0., 'affine', columns, 8)
			errors.append(abs(speed / ref['D'] - 1))
			report.add('hugoniotLength/U%.2f/%dcolumns' % (share, columns), speed, ref['D'], unit='m/s', order=order(errors) if len(errors) > 1 else None)


def precursor(report, want, quick):
	"""Elastic-plastic pistons with the energy in the pressure: precursor and main shock."""
	for name, base, constants, up in PISTONS:
		name = 'precursor/' + name
		if not want(name) or (quick and base != '4340'): continue
		m = material(base, eos='mieGruneisen', yieldModel='perfect', **constants)
		ref = exact.piston(m.density, m.bulkSoundSpeed, m.hugoniotSlope, m.shearModulus, m.yieldStress, up, gruneisen=m.gruneisen)
		columns = 500
		bar = drive(m, up, 0., 'affine', columns, 10)
		pre, speed, elastic, plastic = fronts(bar, lambda name: scenes.profile(bar, 'bar', name), ref, up, columns * D, np.linspace(0.5, 0.9, 6))
		x, P, v, q = scenes.profile(bar, 'bar', 'pressure', 'vx', 'equivalentStress')
		sigma = P + 2 / 3 * q  # axial stress of uniaxial strain
		add = lambda what, value, reference, unit, limit=0.02: report.add(name + '/' + what, value, reference, limit=limit, unit=unit)
		add('precursorSpeed', pre, ref['precursorD'], 'm/s')
		add('precursorParticleSpeed', between(x, v, plastic, elastic), ref['precursorU'], 'm/s')
		add('precursorStress', between(x, sigma, plastic, elastic), ref['HEL'], 'Pa')
		add('plasticSpeed', speed, ref['D'], 'm/s')
		add('stress', between(x, sigma, x[0], plastic), ref['sigma'], 'Pa')


def matched(m, speed):
	"""Impedance match with strength: (u of the interface, axial stress, P) where both materials' exact pistons meet, flyer m[0] at `speed`."""
	at = lambda k, u: exact.piston(k.density, k.bulkSoundSpeed, k.hugoniotSlope, k.shearModulus, k.yieldStress, u)
	u = brentq(lambda u: at(m[1], u)['sigma'] - at(m[0], speed - u)['sigma'], 1e-3 * speed, 0.999 * speed, xtol=1e-9 * speed)
	return u, at(m[1], u), at(m[0], speed - u)


#: flyer, target, speed [m/s]: rows of tests/data/impedance_match.csv, two pairs of unlike impedance, and the fastest impact that the documentation names
IMPACTS = [('WHA_JC', '4340', 1520.), ('OFHC_Cu', 'OFHC_Cu', 400.), ('OFHC_Cu', 'OFHC_Cu', 1000.), ('Al2024_T4', 'Al2024_T4', 800.), ('4340', '4340', 1000.),
           ('Al6061_T6', 'OFHC_Cu', 1500.), ('W_pure', '4340', 1520.), ('WHA_JC', '4340', 2000.)]


def impact(report, want, quick):
	"""scenes.plateImpact(): plateau of both plates, away from the contact, and what the contact does to the columns next to it."""
	for flyer, target, speed in IMPACTS:
		for key, changes, limit in (('', dict(yieldModel='perfect'), 0.006), ('/library', dict(fractureStrain=1.), 0.02)):
			name = 'impact/%s-%s-%.0f%s' % (flyer, target, speed, key)
			if want(name) and not (quick and flyer != 'WHA_JC'): plates(report, name, flyer, target, speed, changes, limit)


def plates(report, name, flyer, target, speed, changes, limit):
	"""References are those of perfectly plastic materials; '/library' has the library's hardening, rates and heat, and may break."""
	m = [material(k, label='%s%d' % (k, n), **changes) for n, k in enumerate((flyer, target))]
	u, there, here = matched([material(k, yieldModel='perfect') for k in (flyer, target)], speed)
	plain = exact.impedanceMatch(*[exact.Hugoniot(k.density, k.bulkSoundSpeed, k.hugoniotSlope) for k in m], speed)
	length = 250 * D
	omega().reset()
	s = scenes.plateImpact(*m, length, length, 8 * scenes.PITCH * D, D, speed)
	trials.until(s, 0.75 * length / max(there['D'], there['precursorD'], here['D']))
	x, v, P, q = scenes.profile(s, 'target', 'vx', 'pressure', 'equivalentStress')
	xf, vf, Pf, qf = scenes.profile(s, 'flyer', 'vx', 'pressure', 'equivalentStress')
	face, front, back = 0.5 * (x[0] + xf[-1]), crossing(x, v, 0.5 * (u + there['precursorU'])), crossing(xf, vf, 0.5 * (u + speed))
	ends = {1: (face, front), -1: (-face, -back)}

	def plateau(at, f):
		"""Mean over the younger half of what the shock has passed: what is nearer to the contact was shocked while the front formed."""
		a, b = ends[1 if at is x else -1]
		return between(at, f, 0.5 * (a + b), b, 0.2)

	add = lambda what, value, reference, unit, limit=limit: report.add(name + '/' + what, value, reference, limit=limit, unit=unit)
	add('particleSpeed', plateau(x, v), u, 'm/s')
	add('targetPressure', plateau(x, P), there['P'], 'Pa')
	add('flyerPressure', plateau(-xf, Pf), here['P'], 'Pa')
	add('targetStress', plateau(x, P + 2 / 3 * q), there['sigma'], 'Pa')
	add('deepest', s.automata.counters()['deepest'], None, 'rest distances', None)
	if 'fractureStrain' in changes:
		broken = sum(int((s.field(k, 'brokenLinks') * (abs(s.packings[k].positions[:, 0]) > 5 * D)).sum()) for k in ('flyer', 'target'))
		add('brokenLinks', broken, 0, 'more than 5 columns from the contact', 0)
		return
	# without strength: what strength itself changes is part of this difference
	add('targetPressure/withoutStrength', plateau(x, P), plain['P'], 'Pa', None)
	# columns next to the contact, mean of both sides; the first has part of its pressure from its contacts, which is not in P
	near = 0.5 * (P[1:12] / there['P'] + Pf[::-1][1:12] / here['P'])
	add('contact/largestPressure', near.max(), 1., 'of the exact one, columns 2 to 12', None)
	add('contact/deviator', 0.5 * (q[:12] / m[1].yieldStress + qf[::-1][:12] / m[0].yieldStress).min(), 1., 'Y, least of columns 1 to 12', None)


CASES = [hugoniot, hugoniotTurned, hugoniotLength, precursor, impact]
