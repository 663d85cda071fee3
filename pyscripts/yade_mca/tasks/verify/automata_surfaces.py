# SPDX-License-Identifier: GPL-2.0-or-later
"""Free surfaces of automata in packings of triangles: tension, bending, a hole, waves along a surface, a collapsing ring."""
import math

import numpy as np
from scipy.optimize import minimize_scalar

from ... import exact, measure
from ..._yade import scene as omega
from ...packings import Polygon, Rectangle, hexagonal
from .. import trials
from ..trials import D, PITCH, elastic, material, order
from . import grid_lamb, grid_shell

POISSON = 0.29
ANGLES = {'along': 0., 'across': math.pi / 2, '15deg': math.radians(15)}
STRAIN = 1e-4  #: of the static cases: linear
NEAR = 2.3  #: radius of means beside a hole in spacings: the neighbours, theirs, and no place on its rim


# ---- equilibrium


def equilibrium(packing, displacement, held, steps):
	"""The body in equilibrium when the automata `held` (bool) are displaced by displacement(x, y) -> (N, 2) [m], from which the others start.

	The elastic body has no viscosity; from time to time, at random lest it fall in with a vibration, all its velocities are made smaller.
	"""
	m = elastic(poisson=POISSON)
	run = trials.automata(contacts=False, sleeping=False)
	u = displacement(*packing.positions.T)
	ids = run.add('body', packing, m)
	for i, fixed in zip(ids.tolist(), held.tolist()):
		if fixed: omega().bodies[i].state.blockedDOFs = 'xyzXYZ'
	dt = 0.3 * D / (math.sqrt(8) * m.cS)
	trials.move(ids, u[:, 0] / dt, u[:, 1] / dt, 0.5 * rotation(displacement, packing) / dt)
	trials.steps(run, 1, dt)
	trials.move(ids, 0., 0., 0.)
	random, done = np.random.default_rng(1), 0
	while done < steps:
		n = int(random.integers(8, 24))
		trials.steps(run, n)
		done += n
		vx, vy, spin = (0.85 * run.automata.field(name) for name in ('vx', 'vy', 'omega'))
		trials.move(ids, vx, vy, spin)
	trials.steps(run, 1)
	return run, m


def rotation(displacement, packing, h=1e-3):
	"""dv/dx - du/dy of a displacement at the automata [-]."""
	x, y = packing.positions.T
	d = h * D
	return (displacement(x + d, y)[:, 1] - displacement(x - d, y)[:, 1] - displacement(x, y + d)[:, 0] + displacement(x, y - d)[:, 0]) / (2 * d)


def tension(angle, strain, steps):
	"""Modulus over that of the continuum, and the largest errors of pressure and Mises stress among the automata in the middle, of a strip in plain tension."""
	nu = POISSON
	p = hexagonal(D, Rectangle((0, 0), (48 * D, 12 * D)), angle=angle, rim='triangles')
	x, y = p.positions.T
	held = abs(x) > 0.5 * np.ptp(x) - 3 * D
	run, m = equilibrium(p, lambda x, y: strain * np.stack((x, -nu / (1 - nu) * y), axis=1), held, steps)
	stress = 2 * m.shearModulus / (1 - nu) * strain
	force = -run.automata.field('fx')[held & (x > 0)].sum()
	free = abs(x) < 12 * D
	P = run.automata.field('pressure')[free] / (-stress * (1 + nu) / 3)
	mises = run.automata.field('equivalentStress')[free] / (abs(stress) * math.sqrt(1 - nu + nu * nu))
	height = 12 * D if angle else np.ptp(y)
	return np.concatenate(((force / height / stress, ), P, mises))


def strip(report, want, quick):
	"""A strip in plain tension: modulus over the area of the triangles, pressure and Mises stress of the automata at its free surfaces and inside.

	Along the rows the uniform field is the solution. Across them (5f) is not zero in it where a star has two or four triangles: of the linear law itself the
	modulus is 1 - 3.02e-5, each surface as soft as if it lay 1.48e-4 d deeper (2.4e-5 of this strip), the rest is of the ends that are held.
	"""
	for name, angle, steps, limits in (('along', 0., 0, (1e-10, 1e-10)), ('across', math.pi / 2, 6000, (1e-4, 0.04))):
		if not want('surface/strip/' + name): continue
		mean = lambda strain: 0.5 * (tension(angle, strain, steps) + tension(angle, -strain, steps))
		read = (4 * mean(0.5 * STRAIN) - mean(STRAIN)) / 3  # linear elasticity, by Richardson's scheme
		n = (len(read) - 1) // 2
		for quantity, value, limit in (('modulus', read[:1], limits[0]), ('pressure', read[1:1 + n], limits[1]), ('mises', read[1 + n:], limits[1])):
			report.add('surface/strip/%s/%s' % (name, quantity), abs(value - 1).max(), 0., limit=limit)


# ---- bending


def size(packing, asked):
	"""Length and height [m] of the body that the triangles make of a rectangle of size `asked`: sides along the rows are straight, others have their middle."""
	flat = [np.ptp(packing.positions[:, c]) for c in range(2)]
	if packing.angle == 0: return packing.area / flat[1], flat[1]
	if abs(packing.angle - math.pi / 2) < 1e-9: return flat[0], packing.area / flat[0]
	# stepped all around: what is over the outline lies there as a layer, of the same thickness beside long sides and short ones
	mean, area = 0.5 * sum(asked), asked[0] * asked[1]
	layer = math.sqrt(mean**2 + packing.area - area) - mean
	return asked[0] + layer, asked[1] + layer


def bendingMode(x, length):
	"""Deflection and slope of the first mode of the slender free beam at x from its middle."""
	k = exact.beam.SLENDER / length
	a = 0.5 * exact.beam.SLENDER
	b = -math.sin(a) / math.sinh(a)
	return np.cos(k * x) + b * np.cosh(k * x), k * (b * np.sinh(k * x) - np.sin(k * x))


def bendingFrequency(rows, angle, ratio=10):
	"""First frequency of a free beam `rows` spacings high over that of Timoshenko."""
	m = elastic(poisson=POISSON)
	asked = (ratio * rows * D, rows * D)
	p = hexagonal(D, Rectangle((0, 0), asked), angle=angle, rim='triangles')
	length, height = size(p, asked)
	young = 2 * m.shearModulus * (1 + POISSON)
	reference = exact.freeBeam(length, height, m.density, young, POISSON)
	x, y = p.positions.T
	deflection, slope = bendingMode(x, length)
	mode = 1e-4 * np.stack((-y * slope, deflection), axis=1)
	run = trials.automata(contacts=False, sleeping=False)
	ids = run.add('beam', p, m, velocity=mode)
	trials.move(ids, spin=1e-4 * slope)
	samples = 48
	each = math.ceil(2 * math.pi / reference / samples / (0.3 * D / (math.sqrt(8) * m.cS)))
	dt = 2 * math.pi / reference / samples / each
	found = []
	for _ in range(int(1.6 * samples)):
		trials.steps(run, each, dt)
		found.append(float((p.weight * (mode[:, 0] * run.automata.field('vx') + mode[:, 1] * run.automata.field('vy'))).sum()))
	found, t = np.array(found), np.arange(1, 1 + int(1.6 * samples)) * each * dt
	return bestFrequency(t, found, reference) / reference


def bestFrequency(t, signal, near):
	"""Of a cosine and a sine that come nearest to the signal [rad/s]."""

	def missed(w):
		waves = np.stack((np.cos(w * t), np.sin(w * t)), axis=1)
		return float(((waves @ np.linalg.lstsq(waves, signal, rcond=None)[0] - signal)**2).sum())

	tried = np.linspace(0.7, 1.2, 201) * near
	k = int(np.argmin([missed(w) for w in tried]))
	return minimize_scalar(missed, bracket=(tried[k - 1], tried[k], tried[k + 1]), tol=1e-10).x


def bending(report, want, quick):
	for name, angle in ANGLES.items():
		errors = []
		for rows, limit in ((5, None), (10, 0.005)):
			case = 'surface/bending/%s/%dd' % (name, rows)
			if not want(case) or (quick and rows > 5): continue
			value = bendingFrequency(rows, angle)
			errors.append(abs(value - 1))
			rate = order(errors) if len(errors) > 1 else None
			report.add(case, value, 1., limit=limit, order=rate, unit='Timoshenko')


# ---- a hole


def hole(report, want, quick):
	"""A round hole of ten spacings' radius in tension, held at the exact displacement far away: errors of the stresses, rms over the largest there is, at the hole.

	edge: of the automata at the hole as they are, at their centres. Steps scatter them, the less regular the outline the more, whatever the spacing.
	nearEdge: their means with the material around by measure.meanAround(), at the places of the means. nextToIt: of automata one spacing further in.
	"""
	for name, angle in (('along', 0.), ('across', math.pi / 2)):
		if not want('surface/hole/' + name): continue
		a, half = 10 * D, 30 * D
		turns = 2 * math.pi * np.arange(240) / 240
		outline = Polygon(half * np.array(((-1, -1), (1, -1), (1, 1), (-1, 1))), [a * np.stack((np.cos(turns), np.sin(turns)), axis=1)])
		p = hexagonal(D, outline, angle=angle, origin=(0., 0.), rim='triangles')
		x, y = p.positions.T
		m = elastic(poisson=POISSON)
		strain = 1e-6
		displacement = lambda x, y: strain * exact.kirsch(x, y, a, POISSON)[0]
		run, m = equilibrium(p, displacement, np.maximum(abs(x), abs(y)) > half - 2.5 * D, 1500 if quick else 3000)
		exactly = lambda at: np.stack(exact.kirsch(*at.T, a, POISSON)[1:], axis=1)
		read = np.stack((-run.automata.field('pressure'), run.automata.field('equivalentStress')), axis=1) / (2 * m.shearModulus * strain)
		r = np.hypot(x, y)
		edge, inside, peak = (r < 1.5 * a) & (p.weight < 0.999), (r > 1.1 * a) & (r < 1.2 * a), exactly(np.array(((0., a), )))[0]
		means, places = measure.meanAround(p.positions[edge], p.positions, p.weight, read, NEAR * D)
		for part, found, at, limit in (('edge', read[edge], p.positions[edge], None), ('nearEdge', means, places, 0.06), ('nextToIt', read[inside], p.positions[inside], 0.06)):
			for quantity, value in zip(('pressure', 'mises'), np.sqrt(((found - exactly(at))**2).mean(axis=0)) / peak):
				report.add('surface/hole/%s/%s/%s' % (name, part, quantity), float(value), 0., limit=limit, unit='of the peak')


# ---- waves along a surface


def lambWave(h):
	"""Error of the displacement of the surface, relative L2, at spacing h [m]: rows along the surface."""
	end, x0 = grid_lamb.END, grid_lamb.GAUGES[-1]
	m = elastic()
	reach = m.cP * end
	width, depth = (math.ceil(v / h) * h for v in (0.5 * (reach + x0) + 0.002, 0.5 * math.sqrt(reach**2 - x0**2) + 0.002))
	run = trials.automata(contacts=False)
	pitch = PITCH * h
	rows = round(depth / pitch)
	p = hexagonal(h, Rectangle((0, -0.5 * rows * pitch), (2 * width, rows * pitch)), origin=(0., 0.), rim='triangles')
	ids = run.add('half-plane', p, m)
	at = lambda x: int(ids[np.argmin(np.hypot(p.positions[:, 0] - x, p.positions[:, 1]))])
	steps = math.ceil(end / (0.3 * h / (math.sqrt(8) * m.cS)) / 10) * 10
	dt, source, gauge = end / steps, at(0.), omega().bodies[at(x0)].state
	o = omega()
	run.automata.readForces = True
	trials.fixedStep(run, dt)
	t, u = [], []
	for k in range(steps):
		o.forces.setPermF(source, (0, -grid_lamb.FORCE * float(exact.ricker(k * dt, grid_lamb.FREQUENCY, grid_lamb.DELAY)), 0))
		o.step()
		if k % 10 == 9:
			run.automata.sync()
			t.append((k + 1) * dt)
			u.append(gauge.displ())
	u = np.array(u) / grid_lamb.FORCE
	rz, rx = exact.lambSurface(np.array(t), x0, m.density, m.cP, m.cS, grid_lamb.FREQUENCY, grid_lamb.DELAY)
	return math.sqrt(np.sum((u[:, 0] - rx)**2 + (-u[:, 1] - rz)**2) / np.sum(rx**2 + rz**2))


def lamb(report, want, quick):
	errors = []
	for h, limit in ((1e-3, None), (0.5e-3, 0.07)):
		case = 'surface/lamb/h%gmm' % (1e3 * h)
		if not want(case) or (quick and h < 1e-3): continue
		errors.append(lambWave(h))
		report.add(case, errors[-1], 0., limit=limit, order=order(errors) if len(errors) > 1 else None, unit='relative L2')


# ---- a ring


def ring(across, stop):
	"""Inner radius [m] at which a ring of automata comes to rest, by the area inside the layers next to its hole."""
	inner, outer = grid_shell.INNER, grid_shell.OUTER
	d = (outer - inner) / across
	m = material('Be_S200', density=grid_shell.DENSITY, yieldModel='perfect', yieldStress=grid_shell.YIELD)
	turns = 2 * math.pi * np.arange(720) / 720
	circle = np.stack((np.cos(turns), np.sin(turns)), axis=1)
	p = hexagonal(d, Polygon(outer * circle, [inner * circle]), origin=(0., 0.), rim='triangles')
	r2 = (p.positions**2).sum(axis=1)
	speed = exact.shellVelocity(grid_shell.DENSITY, grid_shell.YIELD, inner, outer, stop)
	run = trials.automata()
	run.add('ring', p, m, velocity=-speed * inner * p.positions / r2[:, None])
	near, least = r2 < (inner + 3 * d)**2, inner
	end = 2.5 * (inner - stop) / speed
	for k in range(60):
		trials.until(run, end * (0.4 + 0.6 * (k + 1) / 60))
		now = run.automata.field('x')[near]**2 + run.automata.field('y')[near]**2
		least = min(least, math.sqrt(inner**2 - float((r2[near] - now).mean())))
	return least


def rings(report, want, quick):
	for stop in 0.06, 0.05:
		case = 'surface/ring/stop%g/20d' % (stop * 1e3)
		if not want(case) or (quick and stop < 0.06): continue
		report.add(case, ring(20, stop) / stop, 1., limit=0.006, unit='exact')


CASES = [strip, bending, hole, lamb, rings]
