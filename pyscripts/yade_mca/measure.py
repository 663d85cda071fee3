# SPDX-License-Identifier: GPL-2.0-or-later
"""What the penetration study reports, defined once. numpy arrays in, numbers out; no YADE needed.

Rod material is everything that belonged to the rod at the start, broken or not; v is the velocity along the impact direction, eps_p the
plastic strain, m the mass:

    tail        material with eps_p < 0.1;  V_tail = sum m v / sum m over it
    all         all rod material;           V_all  = sum m v / sum m
    intact      material with eps_p < 0.3 and |v - V_tail| <= 0.15 |V_tail|
    unbroken    material with eps_p < 1
    front       1 % of the unbroken material within the rod's radius of its axis is ahead of it; L = distance from the rear of the tail to it
    velocityLossTail = 1 - V_tail/U0        velocityLossAll = 1 - V_all/U0
    lengthLoss = 1 - m_intact/m_rod         lengthLossUnbroken = 1 - m_unbroken/m_rod
    lengthLossGeometric = 1 - L/L0

U0 is the impact speed, L0 the L of the undeformed rod. dU/U0 of the study is velocityLossTail; velocityLossAll counts what the rod as a whole has
given to the plate. dl/l0 by mass is lengthLoss (the rod erodes from its head, so mass counts length); lengthLossUnbroken counts the mushroomed
head, too, as rod. dl/l0 as a length is lengthLossGeometric, read when the head leaves the plate: what a radiograph shows. A source that does not
say what it calls length means one of these. The definitions by mass hold for the two independent codes of data/penetration_peers.csv, too.
"""
import math
from dataclasses import asdict, dataclass

import numpy as np

from ._arguments import array, number, numbersOfAnyShape

__all__ = ['Fragments', 'RodMeasure', 'craterDepth', 'cumulative', 'fragments', 'fragmentsOf', 'geometricLength', 'gradyKipp', 'meanAround', 'momentumSettled', 'mott', 'rearClearance', 'rodMeasure', 'speedAlong']

TAIL_STRAIN = 0.1  #: material with less plastic strain is the undeformed tail [-]
INTACT_STRAIN = 0.3  #: material with less plastic strain may count as intact rod [-]
BROKEN_STRAIN = 1.  #: material with at least this plastic strain is debris [-]
SPEED_BAND = 0.15  #: ... when its velocity is within this share of the tail's [-]


@dataclass(frozen=True)
class RodMeasure:
	"""Losses and the velocities and masses they come from."""
	lengthLoss: float  #: dl/l0 [-]
	velocityLossTail: float  #: dU/U0 of the tail [-]; nan when no material is undeformed
	velocityLossAll: float  #: dU/U0 of all rod material [-]
	tailVelocity: float  #: [m/s]
	allVelocity: float  #: [m/s]
	tailMass: float  #: share of the rod's mass [-]
	intactMass: float  #: share of the rod's mass [-]
	lengthLossUnbroken: float  #: dl/l0 with the mushroomed head counted as rod [-]

	def asDict(self):
		return asdict(self)


def speedAlong(velocity, direction):
	"""Component (N,) of velocity (N, 2 or 3) [m/s] along `direction` (2 or 3 numbers, any length above 0). Raises ValueError."""
	velocity = array('velocity', velocity, ValueError, ((None, 2), (None, 3)), empty=True)
	given = array('direction', direction, ValueError, ((2, ), (3, )))
	n = np.zeros(3)
	n[:len(given)] = given
	length = math.sqrt(float((n * n).sum()))
	if not 0 < length < math.inf or n[velocity.shape[1]:].any():
		raise ValueError('direction (or normal) must not be zero, and in the plane for velocities in the plane; got %r' % (direction, ))
	return sum(velocity[:, c] * (n[c] / length) for c in range(velocity.shape[1]))  # no product of matrices: its threads would take processors from the solver


def rodMeasure(mass, velocity, plasticStrain, impactSpeed, direction=(0., -1.)):
	"""Losses of the rod, see the head of this module.

	mass (N,) [kg/m], velocity (N, 2 or 3) [m/s], plasticStrain (N,) [-] of all rod material (automata, cells or particles); impactSpeed U0 [m/s];
	direction: of the impact. Raises ValueError for empty, mismatched or non-finite input.
	"""
	m, e = array('mass', mass, ValueError, (None, )), array('plasticStrain', plasticStrain, ValueError, (None, ))
	v = speedAlong(velocity, direction)
	if not len(m) == len(e) == len(v):
		raise ValueError('mass, velocity and plasticStrain must have one entry per piece of rod; got %d, %d, %d' % (len(m), len(v), len(e)))
	if not ((m >= 0).all() and 0 < m.sum() < math.inf): raise ValueError('mass must be finite and not negative, its sum above 0; got %g ... %g' % (m.min(), m.max()))
	if not (e >= 0).all(): raise ValueError('plasticStrain must not be negative; the smallest is %g' % e.min())
	impactSpeed = number('impactSpeed', impactSpeed, ValueError, above=0, unit=' m/s')
	total = m.sum()
	tail = e < TAIL_STRAIN
	everything, broken = float((m * v).sum() / total), float(m[e >= BROKEN_STRAIN].sum() / total)
	if not m[tail].sum() > 0:
		return RodMeasure(1., math.nan, 1 - everything / impactSpeed, math.nan, everything, 0., 0., broken)
	vTail = float((m[tail] * v[tail]).sum() / m[tail].sum())
	intact = (e < INTACT_STRAIN) & (abs(v - vTail) <= SPEED_BAND * abs(vTail))
	share = float(m[intact].sum() / total)
	return RodMeasure(1 - share, 1 - vTail / impactSpeed, 1 - everything / impactSpeed, vTail, everything, float(m[tail].sum() / total), share, broken)


def _quantile(values, q):
	"""numpy.quantile(values (n,), q), n above 0, in a sixth of the time for a few thousand values: a run asks for it at every sample."""
	at = q * (len(values) - 1)
	k = int(at)
	a, b = np.partition(values, (k, min(k + 1, len(values) - 1)))[[k, min(k + 1, len(values) - 1)]]
	t = at - k
	return float(b - (b - a) * (1 - t) if t >= 0.5 else a + (b - a) * t)


def geometricLength(positions, plasticStrain, radius, direction=(0., -1.), quantile=0.01):
	"""Length of the rod from the rear of its tail to the front of its unbroken material near the axis [m]; 0 when no material is undeformed.

	positions (N, 2) [m] and plasticStrain (N,) of all rod material; radius of the rod [m]; direction of the impact, to which the axis is parallel,
	through the middle of the tail. `quantile` of the unbroken material within `radius` of the axis is ahead of the front: single grains do not count.
	Raises ValueError.
	"""
	positions, e = _pieces(positions, plasticStrain)
	n, radius = array('direction', direction, ValueError, (2, )), number('radius', radius, ValueError, above=0, unit=' m')
	quantile = number('quantile', quantile, ValueError, low=0, below=1)
	along, across = speedAlong(positions, n), speedAlong(positions, (-n[1], n[0]))
	tail = e < TAIL_STRAIN
	if not tail.any():
		return 0.
	near = abs(across - across[tail].mean()) <= radius * (1 + 1e-9)
	if not (near & tail).any():
		return 0.
	return (_quantile(along[near & (e < BROKEN_STRAIN)], 1 - quantile) - float(along[near & tail].min())) / (1 - quantile)


def _pieces(positions, plasticStrain):
	"""Both as arrays of the same length, (N, 2) and (N,); N may be 0."""
	x, e = array('positions', positions, ValueError, (None, 2), empty=True), array('plasticStrain', plasticStrain, ValueError, (None, ), empty=True)
	if len(e) != len(x): raise ValueError('positions and plasticStrain must have the same number of entries; got %d and %d' % (len(x), len(e)))
	return x, e


def rearClearance(positions, plasticStrain, rear, normal=(0., -1.), quantile=0.95):
	"""How far the head of the rod is beyond the plate's original rear face, normal to the face [m], negative before it.

	positions (N, 2) [m] and plasticStrain (N,) of rod material, rear: a point on the face; normal: of the face, out of the plate. The head is the front
	`quantile` of the material with eps_p below 1 (what is more strained is debris). The study reads its numbers when this is at least half the rod's
	diameter. Raises ValueError.
	"""
	positions, e = _pieces(positions, plasticStrain)
	normal, quantile = array('normal', normal, ValueError, (2, )), number('quantile', quantile, ValueError, low=0, high=1)
	s = speedAlong(positions - array('rear', rear, ValueError, (2, )), normal)
	s = s[e < BROKEN_STRAIN]
	return _quantile(s, quantile) if len(s) else -math.inf


def craterDepth(positions, volume, radius, step, surface=(0., 0.), direction=(0., -1.), parts=1):
	"""Depth of the bottom of a crater below the original surface [m]; 0 where there is none, infinite where the target is pierced.

	positions (N, 2 or 3) [m] and volume (N,) (in space [m3], in plane strain [m2]; mass over density) of all material of the target, broken or not, but none of
	the projectile. The target within `radius` [m] of the axis through `surface`, a point on the original surface, along `direction`, into the target, is cut
	across the axis into slices of thickness `step` [m], two spacings at least. The first slice that is half full holds the bottom or borders on it; what fills
	it and the one before tells where: grains in the crater hardly count, broken material that fills its bottom does. It is a mean over the circle: the tip of
	a bottom of radius R is deeper by some radius^2/(4 R). parts: 4 where the model is a quarter of the whole about that axis. Raises ValueError.
	"""
	x, v = array('positions', positions, ValueError, ((None, 2), (None, 3))), array('volume', volume, ValueError, (None, ))
	n, at = array('direction', direction, ValueError, ((2, ), (3, ))), array('surface', surface, ValueError, ((2, ), (3, )))
	radius, step = number('radius', radius, ValueError, above=0, unit=' m'), number('step', step, ValueError, above=0, unit=' m')
	parts = number('parts', parts, ValueError, low=1)
	if len(v) != len(x) or not (v >= 0).all(): raise ValueError('volume must be one number per piece, none negative; got %d for %d pieces' % (len(v), len(x)))
	x = x - np.append(at, 0.)[:x.shape[1]]
	depth = speedAlong(x, n)
	near = (np.maximum((x * x).sum(axis=1) - depth**2, 0) <= radius**2 * (1 + 1e-9)) & (depth >= 0)
	if not near.any(): return math.inf
	if not depth[near].max() < 1e7 * step: raise ValueError('step %g m gives more than 1e7 slices' % step)
	whole = (math.pi * radius**2 if x.shape[1] == 3 else 2 * radius) * step / parts
	fill = np.bincount((depth[near] / step).astype(int), v[near]) / whole
	full = np.flatnonzero(fill >= 0.5)
	if not len(full): return math.inf
	k = full[0]
	return float(step * max(k - (fill[k - 1] if k else 0.) + max(1 - fill[k], 0.) * (k > 0), 0.))


def meanAround(points, positions, mass, values, radius):
	"""Means of `values` by mass over the material within `radius` [m] of each of `points`, and the places they stand for: (M,) or (M, k), and (M, 2) [m].

	points (M, 2) [m], positions (N, 2) [m], mass (N,), values (N,) or (N, k): fields of the material, as pressure and equivalentStress. The way to read stresses
	at a free surface that is stepped or curved: its single automata scatter about the field by some 15 % of the largest stress whatever the spacing, means over
	2.3 spacings come nearer to it with the spacing. A mean stands for the middle of its material, half a spacing or more inside the surface, not for the
	surface itself. nan where no material is near. Raises ValueError.
	"""
	points, x = array('points', points, ValueError, (None, 2)), array('positions', positions, ValueError, (None, 2))
	m, v = array('mass', mass, ValueError, (None, )), array('values', values, ValueError, ((None, ), (None, None)))
	radius = number('radius', radius, ValueError, above=0, unit=' m')
	if not len(x) == len(m) == len(v): raise ValueError('positions, mass and values must have one entry per piece; got %d, %d and %d' % (len(x), len(m), len(v)))
	if not (m >= 0).all(): raise ValueError('mass must not be negative; the smallest is %g' % m.min())
	both = np.concatenate((x, v.reshape(len(v), -1)), axis=1)
	means = np.full((len(points), both.shape[1]), math.nan)
	for k, at in enumerate(points):
		near = np.hypot(*(x - at).T) <= radius
		total = m[near].sum()
		if total > 0: means[k] = (m[near, None] * both[near]).sum(axis=0) / total
	return means[:, 2:].reshape(len(points), *v.shape[1:]), means[:, :2]


def momentumSettled(time, momentum, window, tolerance=1e-3):
	"""True when the momentum (n,) changed by less than `tolerance` of its first value over the last `window` [s] of time (n,) [s].

	False as long as the record is shorter than the window. Raises ValueError.
	"""
	t, p = array('time', time, ValueError, (None, ), empty=True), array('momentum', momentum, ValueError, (None, ), empty=True)
	window, tolerance = number('window', window, ValueError, above=0, unit=' s'), number('tolerance', tolerance, ValueError, low=0)
	if len(t) != len(p) or (np.diff(t) < 0).any(): raise ValueError('time must rise, with one entry per momentum; got %d and %d entries' % (len(t), len(p)))
	if len(t) < 2 or t[-1] - t[0] < window:
		return False
	recent = p[t >= t[-1] - window]
	return bool(np.ptp(recent) <= tolerance * abs(p[0]))


@dataclass(frozen=True)
class Fragments:
	"""What holds together, heaviest first; F of them of N automata, in the plane (dim 2) per m of thickness."""
	label: np.ndarray  #: fragment to which each automaton belongs (N,) int
	count: np.ndarray  #: automata of each (F,) int
	mass: np.ndarray  #: (F,) [kg, in the plane kg/m]
	position: np.ndarray  #: of the centre of mass (F, dim) [m]
	velocity: np.ndarray  #: of it (F, dim) [m/s]
	size: np.ndarray  #: diameter of the ball, in the plane of the disc, of the same volume (F,) [m]
	elongation: np.ndarray  #: largest over smallest radius of gyration, each automaton a ball of its own (F,) [-]; 1: round


def fragments(ids, links, mass, positions, velocity, volume, chains=True):
	"""Fragments: automata that are connected by links.

	ids (N,) int; links: pairs of ids, (M, 2) or a list, those that hold; mass (N,) [kg]; positions, velocity (N, dim) [m], [m/s], dim 2 or 3; volume (N,) at rest [m3, in
	the plane m2], above 0. chains=False: automata with fewer than three links connect nothing and are fragments of their own, so that two pieces between which a
	chain of single automata still hangs are two. Raises ValueError for arrays that do not belong together and for a link of an unknown id.
	"""
	x, v, m, V, ids, pairs = _checked(ids, links, mass, positions, velocity, volume)
	n, dim = x.shape
	if not isinstance(chains, bool): raise ValueError('chains must be True or False; got %r' % (chains, ))
	label = _connected(ids, pairs, chains)
	heaviest = np.argsort(-np.bincount(label, m), kind='stable')
	found, rank = len(heaviest), np.empty(len(heaviest), int)
	rank[heaviest] = np.arange(found)
	label = rank[label]

	def sums(values):
		return np.stack([np.bincount(label, values[:, c], found) for c in range(values.shape[1])], axis=1)

	total, whole = np.bincount(label, m, found), np.bincount(label, V, found)
	centre = sums(m[:, None] * x) / total[:, None]
	off = x - centre[label]
	moments = sums((m[:, None, None] * off[:, :, None] * off[:, None, :]).reshape(n, dim * dim)).reshape(found, dim, dim) / total[:, None, None]
	diameter = lambda volume: (4 * volume / math.pi)**0.5 if dim == 2 else (6 * volume / math.pi)**(1 / 3)
	own = np.bincount(label, m * diameter(V)**2, found) / total / (4 * (dim + 2))  # a ball's own second moment along an axis
	spread = np.linalg.eigvalsh(moments + own[:, None, None] * np.eye(dim))
	return Fragments(
		label, np.bincount(label, minlength=found), total, centre, sums(m[:, None] * v) / total[:, None], diameter(whole), np.sqrt(spread[:, -1] / spread[:, 0]))


def _checked(ids, links, mass, positions, velocity, volume):
	"""Arguments of fragments() as arrays."""
	x = array('positions', positions, ValueError, ((None, 2), (None, 3)))
	n = len(x)
	v, m, V = array('velocity', velocity, ValueError, x.shape), array('mass', mass, ValueError, (n, )), array('volume', volume, ValueError, (n, ))
	ids = array('ids', ids, ValueError, (n, ))
	if len(np.unique(ids)) < n or (ids != np.round(ids)).any(): raise ValueError('ids must be %d different whole numbers, one for each position; got %s' % (n, ids))
	for name, values in ('mass', m), ('volume', V):
		if not (values > 0).all(): raise ValueError('%s must be above 0; the smallest is %g' % (name, values.min()))
	return x, v, m, V, ids, array('links', links, ValueError, (None, 2), empty=True)


def _connected(ids, pairs, chains):
	"""A number for each of what is connected by pairs of ids, (N,) int."""
	from scipy.sparse import coo_matrix
	from scipy.sparse.csgraph import connected_components
	n, order = len(ids), np.argsort(ids)
	place = np.searchsorted(ids, pairs, sorter=order)
	if not ((place < n).all() and (ids[order[np.minimum(place, n - 1)]] == pairs).all()): raise ValueError('links name an id that is not in ids')
	a, b = order[place].T
	if not chains:
		held = np.bincount(order[place].ravel(), minlength=n) >= 3
		a, b = (end[held[a] & held[b]] for end in (a, b))
	return connected_components(coo_matrix((np.ones(len(a)), (a, b)), shape=(n, n)), directed=False)[1]


def fragmentsOf(engine, chains=True):
	"""fragments() of the automata of a McaEngine now, in the order of engine.ids; volumes at rest are those of the masses.

	Broken pairs that have not parted (McaEngine.cohesivePairs(), fractureEnergy) connect like links. Raises ValueError for another engine.
	"""
	if not hasattr(engine, 'fields') or not hasattr(engine, 'links'): raise ValueError('engine must be a McaEngine; got %r' % (engine, ))
	dim = engine.dimension
	names = ('ids', 'mass', 'diameter', 'weight') + tuple('xyz'[:dim]) + tuple('v' + c for c in 'xyz'[:dim])
	f = engine.fields(names)
	cell = math.sqrt(0.75) * f['diameter']**2 if dim == 2 else f['diameter']**3 / math.sqrt(2)  # of the packing
	x, v = (np.stack([f[k + c] for c in 'xyz'[:dim]], axis=1) for k in ('', 'v'))
	c = engine.cohesivePairs()
	return fragments(f['ids'], engine.links() + list(zip(c['id1'].tolist(), c['id2'].tolist())), f['mass'], x, v, cell * f['weight'], chains)


def cumulative(mass):
	"""Cumulative distribution of fragments: (mass rising (F,), number of fragments at least as heavy (F,))."""
	m = np.sort(array('mass', mass, ValueError, (None, )))
	if not m[0] > 0: raise ValueError('mass must be above 0; the smallest is %g' % m[0])
	return m, np.arange(len(m), 0, -1)


def mott(mass, number, mean):
	"""Mott's distribution of plates that break into pieces of two dimensions: number exp(-sqrt(2 m/mean)), of mean mass `mean` (N. F. Mott, Proc. R. Soc. A 189, 1947).

	mass: where [kg], any shape; number: of all fragments. Returns how many are heavier than that. Raises ValueError for numbers that are none or below 0.
	"""
	m, n, mean = _distribution(mass, number, mean)
	return n * np.exp(-np.sqrt(2 * m / mean))


def gradyKipp(mass, number, mean):
	"""Distribution of a body that breaks at random: number exp(-m/mean) (D. E. Grady and M. E. Kipp, J. Appl. Phys. 58, 1985). Arguments as mott()."""
	m, n, mean = _distribution(mass, number, mean)
	return n * np.exp(-m / mean)


def _distribution(mass, count, mean):
	"""Checked arguments of a distribution."""
	return numbersOfAnyShape('mass', mass, ValueError, 0.), number('number', count, ValueError, low=0.), number('mean', mean, ValueError, above=0.)
