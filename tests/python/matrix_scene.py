# SPDX-License-Identifier: GPL-2.0-or-later
"""The scene of the matrix of ordinary scripting: a few small bodies far from each other, so that most answers are exact physics or an undisturbed run.

Groups of automata, spacing 1 mm:
	S        a block in plastic vibration that drifts (roads 'engine' and 'law2'), or one tied to a grid (road 'coupled')
	R        an elastic hexagon of seven at rest
	F        three single ones in free flight
	C1, C2   two plastic hexagons; C1 meets C2 after `gap` steps, so what is changed before that acts as if it had been so from the start
	Q        another elastic hexagon, which only a script adds
"""
import functools
import math

import numpy as np

D, DT, SPEED = 1e-3, 2e-8, 400.
PITCH = 0.5 * math.sqrt(3)
COLUMNS = ('x', 'y', 'vx', 'vy', 'omega', 'pressure', 'plasticStrain', 'temperature', 'links')
#: least scales with which differences are compared, and the tolerance; links must be equal
SCALES = np.array([D, D, 1., 1., 1e3, 1e8, 1e-2, 298., 1e-9])
TOLERANCE = 1e-8
ELASTIC = dict(eos='linear', yieldModel='elastic', viscosityLinear=0., viscosityQuadratic=0.)
HARD = dict(yieldModel='linearHardening', yieldStress=0.4e9, hardeningModulus=0.5e9, strengthSpread=0.1, frictionAngle=0.2)
#: Johnson-Cook with n = m = 1, no rate and no heating: initial strain and temperature act as other constants A and B would
SOFT = dict(yieldModel='johnsonCook', yieldStress=0.8e9, hardeningModulus=0.5e9, hardeningExponent=1., rateCoefficient=0., thermalSoftening=1.,
            meltTemperature=1793., heatCapacity=0., fractureStress=1.6e9, frictionAngle=0.2)
HIT = np.array([(8, -3), (-5, 6), (2, 9), (-7, -4), (6, 1), (-1, -8), (-3, -1)], float)  #: velocities of the seven of a hexagon [m/s], sum zero
FLYERS = np.array([(-60e-3, 50e-3, 5., 1.), (-60e-3, 60e-3, -3., 2.), (-60e-3, 70e-3, 0., -4.)])
AT = dict(S=(-40e-3, 0.), R=(-40e-3, 60e-3), C1=(-40e-3, 120e-3), Q=(-40e-3, 160e-3))
PINNED, OTHER = 6, 3  #: automata of C2: held from the start; held by the script


@functools.lru_cache(None)
def packing(outline, *numbers, **options):
	"""A hexagonal packing in an outline of yade_mca.packings, made once."""
	from yade_mca import packings
	return packings.hexagonal(D, getattr(packings, outline)(*numbers), **options)


def hexagon(at):
	return packing('disc', (0., 0.), 1.05 * D, origin=(0., 0.), rim='full').translated(at)


class MatrixScene:
	"""Builds the scene in the empty Omega. road: 'engine', 'law2', 'coupled' or 'law2coupled'; gap: steps until C1 meets C2.

	engine: a McaEngine object to use again; change: dict of what differs from the start, see `reference`.
	"""

	def __init__(self, road, gap, engine=None, **change):
		self.road, self.gap, self.change, self.ids = road, gap, change, {}
		self.bodies()
		self.engines(engine)

	def bodies(self):
		from yade_mca import materials, packings
		c, mca = self.change, materials.mcaMat
		self.elastic = mca('4340', **ELASTIC)
		if self.coupled: self.makeHalf(mca('4340', **ELASTIC))
		else:
			p = packing('Rectangle', AT['S'], (5 * D, 4 * D))
			r = p.positions / D
			self.add('S', p, mca('4340', **HARD), 60. * np.stack((np.sin(0.9 * r[:, 0]) + 0.5, np.cos(0.8 * r[:, 1] + 0.4 * r[:, 0])), axis=1))
		self.add('R', hexagon(AT['R']), self.elastic, c.get('hit', np.zeros((7, 2))))
		one = hexagon((0., 0.)).select([3])
		self.ids['F'] = []
		for x, y, vx, vy in FLYERS.tolist():
			self.ids['F'] += packings.addBodies(one.translated(np.array((x, y)) - one.positions[0]), self.elastic, velocity=(vx, vy))
		soft = dict(SOFT, **c.get('constants', {}))
		m = mca('4340', **soft)
		away = 3 * D + self.gap * SPEED * DT
		self.add('C1', hexagon(AT['C1']), m, (SPEED, 0.))
		if c.get('target', True):
			target = hexagon((AT['C1'][0] + away, AT['C1'][1] + 0.3 * D)).translated(c.get('shift', (0., 0.)))
			self.add('C2', target, mca('4340', **dict(soft, **c['object'])) if 'object' in c else m, (0., 0.), mask=3)
			self.body('C2', c.get('pinned', PINNED)).state.blockedDOFs = 'xyzXYZ'

	@property
	def coupled(self):
		return 'coupled' in self.road

	def add(self, group, packing, material, velocity, **options):
		from yade_mca import packings
		self.ids[group] = packings.addBodies(packing, material, velocity=velocity, **options)

	def makeHalf(self, steel):
		p = packing('Rectangle', (-2 * PITCH * D, 2 * D), (4 * PITCH * D, 4 * D), angle=0.5 * math.pi, origin=(0., 0.))
		self.steel, self.velocity = steel, lambda x, y: np.stack((20. * np.exp(-((x + 2 * D) / D)**2), 8. * np.sin(y / D)), axis=-1)
		self.add('S', p, steel, self.velocity(*p.positions.T))

	def engines(self, engine=None):
		"""Fresh engines; `engine` is used again instead of a new McaEngine."""
		from yade import O
		from yade.wrapper import McaEngine, McaTimeStepper
		from yade_mca.scenes import law2Engines
		O.dt = DT
		if 'law2' in self.road: O.engines = law2Engines()
		elif not self.coupled: O.engines = [engine or McaEngine(adaptive=False)]
		else: O.engines = [McaTimeStepper(factor=0.4, largest=DT), engine or McaEngine()]
		if self.coupled: self.addGrid()

	def addGrid(self):
		from yade import O
		from yade.wrapper import McaGridEngine, McaGridCoupler
		g = McaGridEngine(adaptive=False)
		gx, gy = np.meshgrid(np.arange(5) * D, np.arange(5) * D)
		g.addBlock(self.steel, gx, gy, name='grid')
		g.setVelocity(0, self.velocity(gx, gy))
		e = O.engines
		k = len(e) - 1 if 'law2' in self.road else len(e)
		O.engines = e[:k] + [g, McaGridCoupler(side='left')] + e[k:]

	def body(self, group, k):
		from yade import O
		return O.bodies[self.ids[group][k]]

	def engine(self, name='McaEngine'):
		from yade import O
		return next(e for e in O.engines if type(e).__name__ == name)

	def free(self):
		"""Place in S of an automaton far from the grid."""
		x = [self.body('S', k).state.pos[0] for k in range(len(self.ids['S']))]
		return int(np.argmin(x))

	def look(self):
		"""What the bodies hold, {group: (N, columns)}; 'grid': (nodes, 4)."""
		from yade import O
		out = {}
		for group, ids in self.ids.items():
			rows = []
			for i in ids:
				s = O.bodies[i].state
				rows.append((s.pos[0], s.pos[1], s.vel[0], s.vel[1], s.angVel[2], s.pressure, s.plasticStrain, s.temperature, s.links))
			out[group] = np.array(rows).reshape(len(ids), len(COLUMNS))
		if self.coupled:
			g = self.engine('McaGridEngine')
			out['grid'] = np.stack([np.array(g.view(0, k)).ravel() for k in ('x', 'y', 'vx', 'vy')], axis=1)
		return out

	def momentum(self, group):
		"""Momentum of the bodies of a group (and of the grid it is tied to) [N s/m], (2,)."""
		from yade import O
		tied = set(self.engine('McaGridCoupler').rowIds) if self.coupled and group == 'S' else set()
		p = np.zeros(2)
		for i in self.ids[group]:
			if i in tied or O.bodies[i] is None: continue
			s = O.bodies[i].state
			p += s.mass * np.array((s.vel[0], s.vel[1]))
		if self.coupled and group == 'S':
			e = self.engine('McaGridEngine').energies()
			p += (e['momentumX'], e['momentumY'])
		return p


def difference(now, expected):
	"""Largest difference of one group over its allowed one, with its column: (ratio, words)."""
	if now.shape != expected.shape: return math.inf, '%d bodies instead of %d' % (len(now), len(expected))
	if now.size == 0: return 0., ''
	scale = np.maximum(np.nan_to_num(abs(expected)).max(axis=0), SCALES[:now.shape[1]])
	scale[:2] = D
	if now.shape[1] == len(COLUMNS): scale[8] = 1.
	ratio = np.where(np.isfinite(expected), np.nan_to_num(abs(now - expected), nan=math.inf), 0.) / scale / TOLERANCE
	i, k = np.unravel_index(np.argmax(ratio), ratio.shape)
	return ratio[i, k], '%s of number %d is %.9g instead of %.9g' % (COLUMNS[k], i, now[i, k], expected[i, k])


#: the road that says what is right
REFERENCE = dict(engine='law2', law2='engine', coupled='law2coupled')
_known = {}


def reference(road, gap, steps, **change):
	"""look() after `steps` undisturbed steps of a fresh scene by the other road. change: constants, object (of McaMat), target, shift, pinned, hit."""
	key = repr((road, gap, steps, sorted((k, repr(v)) for k, v in change.items())))
	if key not in _known:
		from yade import O
		O.reset()
		s = MatrixScene(REFERENCE[road], gap, **change)
		if steps: O.run(steps, True)
		assert O.iter == steps
		_known[key] = s.look()
		O.reset()
	return {k: v.copy() for k, v in _known[key].items()}


def flight(steps):
	"""Where the free flyers are after `steps`."""
	out = np.zeros((len(FLYERS), len(COLUMNS)))
	out[:, :2], out[:, 2:4], out[:, 7] = FLYERS[:, :2] + FLYERS[:, 2:] * steps * DT, FLYERS[:, 2:], 298.
	return out
