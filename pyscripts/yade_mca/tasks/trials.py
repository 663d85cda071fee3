# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes that verification, bench, stress and tests share, how they are run, and what is read from them.

Each function that makes one empties O, fills it and returns a scenes.Scene.
"""
import math
from dataclasses import replace

import numpy as np

from .. import materials, scenes
from .._yade import scene as omega
from .._yade import yadeClass
from ..packings import Rectangle, addBodies, hexagonal
from ..scenes import Scene

PITCH = scenes.PITCH  #: distance of close-packed rows over the spacing
D = 1e-3  #: spacing of the automata where nothing else is said [m]
BALANCE = 1e-12  #: largest relative error of energy and momentum of a grid
#: plastic flow, scattered fracture and friction at once
HARD = dict(yieldModel='linearHardening', yieldStress=0.8e9, hardeningModulus=0.5e9, fractureStrain=0.12, spallStrength=2.5e9, strengthSpread=0.1,
            frictionAngle=0.2)


# ---- materials


def material(name='4340', **overrides):
	"""McaMat of the library.

	viscosity   both coefficients at once, a pair
	poisson     Poisson's ratio [-], from which and the bulk modulus the shear modulus follows
	"""
	if 'viscosity' in overrides:
		overrides['viscosityLinear'], overrides['viscosityQuadratic'] = overrides.pop('viscosity')
	poisson = overrides.pop('poisson', None)
	m = materials.mcaMat(name, **overrides)
	if poisson is not None:
		m.shearModulus = shearModulus(m, poisson)
	return m


def shearModulus(m, poisson):
	"""G [Pa] of the bulk modulus of `m` at Poisson's ratio [-]; 0.5 gives a fluid."""
	return 1.5 * m.density * m.bulkSoundSpeed**2 * (1 - 2 * poisson) / (1 + poisson)


def elastic(**overrides):
	"""Linear elastic steel without viscosity; keywords as of material()."""
	return material('4340', **dict(dict(eos='linear', yieldModel='elastic', viscosityLinear=0., viscosityQuadratic=0.), **overrides))


# ---- scenes


def automata(**attributes):
	"""No bodies, and a McaEngine with these attributes."""
	omega().reset()
	return scenes.start(attributes)


def grid(**attributes):
	"""A McaGridEngine with these attributes, without blocks."""
	omega().reset()
	s = Scene(grid=yadeClass('McaGridEngine')(**attributes))
	omega().engines = [s.grid]
	return s


def bar(mat, length, spacing=D, angle=0., rows=16, **attributes):
	"""A bar of automata along x from 0 to `length` [m] in uniaxial strain, part 'bar': see scenes.strip() and addStrip(). attributes: of McaEngine."""
	s = automata(**attributes)
	scenes.addStrip(s, 'bar', scenes.strip(spacing, 0., length, rows, angle), mat)
	return s


def impactBlocks(speed=400., n=10, **changes):
	"""A block of n/2 by 0.6 n spacings flies obliquely into another one of n by n, speed [m/s], both of steel HARD with `changes`.

	They are added to the O that is there. Returns the ids.
	"""
	m = material('4340', **dict(HARD, **changes))
	a = addBodies(hexagonal(D, Rectangle((0, 0), (n * D, n * D))), m)
	flyer = hexagonal(D, Rectangle((-0.82 * n * D, 0.1 * n * D), (0.5 * n * D, 0.6 * n * D)), angle=0.5 * math.pi)
	b = addBodies(flyer, m, velocity=(speed, 0.2 * speed), mask=3)
	return a + b


def halves(mat, left, right, height, h=1., coupled=True, xs=None, ys=None, velocity=None, rotate=0., factor=0.4, account=False, **attributes):
	"""Automata in -left < x < 0, 0 < y < height, part 'half'; beyond them, to x = right, automata or (`coupled`) a grid, block 'grid', with cells of h spacings.

	xs, ys      grid lines, instead of the regular ones; rotate: angle of the whole scene about the origin [rad]; all lengths in spacings
	velocity    function (x, y) -> (vx, vy) of the unrotated scene, lengths in [m]
	factor      of the McaTimeStepper, facts['stepper']; attributes: of McaEngine
	packings['half'] is the packing before the rotation.
	"""
	s = automata(account=account, **attributes)
	o = omega()
	o.materials.append(mat)
	turn = np.array([[math.cos(rotate), -math.sin(rotate)], [math.sin(rotate), math.cos(rotate)]]) if rotate else np.eye(2)
	reach = (0. if coupled else right) * D
	packing = hexagonal(D, Rectangle((0.5 * (reach - left * D), 0.5 * height * D), (left * D + reach, height * D)), angle=0.5 * math.pi, origin=(0., 0.))
	p = packing.positions
	at = lambda x, y: np.stack(np.broadcast_arrays(*velocity(x, y)), axis=-1) if velocity else np.zeros((*np.shape(x), 2))
	s.add('half', replace(packing, positions=p @ turn.T, angle=packing.angle + rotate), mat, velocity=at(*p.T) @ turn.T)
	s.packings['half'] = packing
	s.facts.update(material=mat, stepper=yadeClass('McaTimeStepper')(factor=factor))
	o.engines = [s.facts['stepper'], s.automata]
	if not coupled: return s
	lines = lambda given, end: (np.linspace(0, end, round(end / h) + 1) if given is None else np.asarray(given)) * D
	gx, gy = np.meshgrid(lines(xs, right), lines(ys, height))
	placed = np.stack((gx, gy), axis=-1) @ turn.T
	s.grid, s.couplers = yadeClass('McaGridEngine')(), [yadeClass('McaGridCoupler')(side='left')]
	s.blocks['grid'] = s.grid.addBlock(mat, np.ascontiguousarray(placed[..., 0]), np.ascontiguousarray(placed[..., 1]), name='grid')
	if velocity: s.grid.setVelocity(0, at(gx, gy) @ turn.T)
	o.engines = [s.facts['stepper'], s.automata, s.grid, *s.couplers]
	return s


# ---- changing and running them


def move(ids, vx=None, vy=None, spin=None):
	"""Sets velocities [m/s] and spins [1/s] of bodies; arrays or numbers."""
	for k, i in enumerate(np.asarray(ids).tolist()):
		b = omega().bodies[i].state
		at = lambda v, old: old if v is None else float(np.broadcast_to(v, len(ids))[k])
		b.vel = (at(vx, b.vel[0]), at(vy, b.vel[1]), 0.)
		if spin is not None:
			b.angVel = (0., 0., at(spin, 0.))


def give(ids, velocity=None, spin=None):
	"""Sets velocities [m/s] and spins [1/s] of bodies in space, arrays (N, 3) or (3,); None leaves them."""
	bodies, of = omega().bodies, lambda v: np.broadcast_to(v, (len(ids), 3)).tolist()
	states = [bodies[i].state for i in np.asarray(ids).tolist()]
	if velocity is not None:
		for s, v in zip(states, of(velocity)):
			s.vel = v
	if spin is not None:
		for s, w in zip(states, of(spin)):
			s.angVel = w


def fastestTurn(s, part, quantity, centre, dt):
	"""Circular frequency [1/s] with which automaton `centre` of a part turns, of which all turn alike: the fastest motion of a packing. By the leapfrog itself
	w(t + dt) - 2 w(t) + w(t - dt) = -(omega dt)^2 w(t)."""
	spin = []
	for _ in range(3):
		steps(s, 1, dt)
		spin.append(s.field(part, quantity)[centre])
	return math.sqrt((2 * spin[1] - spin[0] - spin[2]) / spin[1]) / dt


def growthPerStep(turn):
	"""Factor by which a motion of circular frequency times step `turn` grows in a step of the leapfrog; 1 where it is stable."""
	a = 0.5 * turn**2 - 1
	return a + math.sqrt(a * a - 1) if a > 1 else 1.


def refusalOf(dt):
	"""What the engine says to a step of dt [s]; empty where it does it."""
	omega().dt = dt
	try:
		omega().step()
	except RuntimeError as e:
		return str(e)
	return ''


def fixedStep(s, dt):
	"""The same step [s] everywhere, set by hand."""
	if 'stepper' in s.facts: s.facts['stepper'].active = False
	(s.automata or s.grid).adaptive = False
	omega().dt = dt


def steps(s, n, dt=None):
	"""n steps, of dt [s] each if given."""
	o = omega()
	if s.automata is None and 'energies' not in s.facts: s.facts['energies'] = s.grid.energies()  # what gridBalance() compares with
	if dt is not None: fixedStep(s, dt)
	if s.automata is not None and n * len(o.bodies) < 1e5:  # O.run() looks only every 40 ms whether it has come to its end
		for _ in range(n):
			o.step()
	else:
		o.run(n, True)


def until(s, time):
	"""Runs to the first step that reaches `time` [s]."""
	o, clock = omega(), (lambda: omega().time) if s.automata is not None else (lambda: s.grid.time)
	if o.iter == 0:
		steps(s, 1)
	while clock() < time:
		steps(s, max(1, int((time - clock()) / o.dt / 2)))  # the step may grow on the way


def exactly(s, time, courant):
	"""Runs a grid to exactly `time` [s] with equal steps of at most `courant` times the largest stable one; returns dt."""
	n = math.ceil((time - s.grid.time) / (courant * s.grid.criticalTimeStep))
	dt = (time - s.grid.time) / n
	steps(s, n, dt)
	return dt


def record(s, points, component, number, every):
	"""Histories (samples, points) of a velocity component of automata, every `every` of `number` steps."""
	out = []
	for _ in range(number // every):
		omega().run(every, True)
		out.append(s.automata.field(component)[points])
	return np.array(out)


# ---- reading them


def triples(s, *kinds):
	"""Quantities of all automata in space with three components, of kinds 'x', 'v', 'f', 'omega': arrays (N, 3) in the order of the ids."""
	names = {'x': ('x', 'y', 'z'), 'v': ('vx', 'vy', 'vz'), 'f': ('fx', 'fy', 'fz'), 'omega': ('omegaX', 'omegaY', 'omegaZ')}
	found = s.automata.fields([n for k in kinds for n in names[k]])
	made = [np.stack([found[n] for n in names[k]], axis=1) for k in kinds]
	return made if len(made) > 1 else made[0]


def nearest(s, x, y, part='half'):
	"""Index in `part` of the automaton nearest to (x, y) spacings at the start."""
	return int(np.argmin(np.hypot(*(s.packings[part].positions - np.array((x, y)) * D).T)))


def centres(s, block):
	"""x, y [m] of the cells of a grid block, each (rows, cells)."""
	mean = lambda f: 0.25 * (f[:-1, :-1] + f[:-1, 1:] + f[1:, :-1] + f[1:, 1:])
	return mean(s.grid.view(block, 'x')), mean(s.grid.view(block, 'y'))


def density(s, block):
	"""rho/rho0 of the cells [-]."""
	x, y = s.grid.view(block, 'x'), s.grid.view(block, 'y')
	area = 0.5 * ((x[1:, 1:] - x[:-1, :-1]) * (y[1:, :-1] - y[:-1, 1:]) - (x[1:, :-1] - x[:-1, 1:]) * (y[1:, 1:] - y[:-1, :-1]))
	return s.grid.view(block, 'restArea') / area


def gridBalance(s):
	"""Relative errors of energy and momentum of a grid since the first steps()."""
	a, b = s.facts['energies'], s.grid.energies()
	energy = max(b['kinetic'], a['kinetic']) + abs(b['internal']) + sum(abs(b[k]) for k in b if k.startswith('work'))
	# of the order of magnitude that a scale needs: blocks at 1000 kg/m3
	mass = sum(float(np.sum(s.grid.view(k, 'restArea'))) for k in range(len(s.grid.blocks))) * 1e3
	# momenta are measured by |impulses| and by the largest the kinetic energy could hold
	momentum = abs(b['impulseX']) + abs(b['impulseY']) + math.sqrt(2 * mass * max(b['kinetic'], a['kinetic']))
	off = math.hypot(b['momentumX'] - a['momentumX'] - b['impulseX'], b['momentumY'] - a['momentumY'] - b['impulseY'])
	return abs(b['total'] - a['total']) / energy, off / momentum


def addBalance(report, s, name):
	"""Adds the balance of a run of a grid to the report."""
	energy, momentum = gridBalance(s)
	report.add(name + '/energyError', energy, 0., limit=BALANCE)
	report.add(name + '/momentumError', momentum, 0., limit=BALANCE)


def crossing(x, f, level):
	"""Position of the last point, from the left, where the falling profile f(x) crosses `level`, linearly interpolated."""
	k = np.nonzero((f[:-1] >= level) & (f[1:] < level))[0][-1]
	return x[k] + (x[k + 1] - x[k]) * (f[k] - level) / (f[k] - f[k + 1])


def between(x, f, a, b, margin=0.3):
	"""Mean of f(x) over [a, b] without `margin` of the length at each end."""
	keep = (x > a + margin * (b - a)) & (x < b - margin * (b - a))
	return float(np.mean(f[keep])) if keep.any() else math.nan


def order(errors, ratio=2.):
	"""Order of convergence from the last two errors."""
	return math.log(errors[-2] / errors[-1]) / math.log(ratio)


def delay(t1, f1, t2, f2):
	"""Time [s] by which signal 2 trails signal 1: maximum of the cross-correlation, parabola through its top."""
	dt = min(np.median(np.diff(t1)), np.median(np.diff(t2)))
	t = np.arange(0., max(t1[-1], t2[-1]), dt)
	a, b = np.interp(t, t1, f1, 0, 0), np.interp(t, t2, f2, 0, 0)
	n = 2 * len(t)
	c = np.fft.irfft(np.fft.rfft(b, n) * np.conj(np.fft.rfft(a, n)), n)[:len(t)]
	k = int(np.argmax(c))
	y0, y1, y2 = c[k - 1], c[k], c[k + 1]
	return dt * (k + 0.5 * (y0 - y2) / (y0 - 2 * y1 + y2))
