# SPDX-License-Identifier: GPL-2.0-or-later
"""What all ready scenes share: the object that a builder returns, and the checks of its arguments. The builders: scenes."""
import math
from dataclasses import dataclass, field

import numpy as np

from ._yade import scene as omega
from ._yade import yadeClass
from ._arguments import LARGEST
from .packings import addBodies

__all__ = ['Scene', 'SceneError']

PITCH = 0.5 * math.sqrt(3)  #: distance of close-packed rows over the spacing
ROD, PLATE = 1, 2  #: Body.mask of the two bodies of an impact: bodies of different mask do not link
MOST = 1e7  #: automata that a builder makes at most: a body of YADE takes some 2 kB
MACH = 10.  #: largest speed a builder takes, over the sound speed of the material; the laws hold up to about one


class SceneError(ValueError):
	"""A scene that cannot be built; the message names the value and what is allowed."""


@dataclass
class Scene:
	"""What a builder made. `ids`: name of a part -> body ids (numpy int), `packings`: the same names -> Packing."""
	automata: object = None  #: McaEngine
	grid: object = None  #: McaGridEngine or None
	couplers: list = field(default_factory=list)
	ids: dict = field(default_factory=dict)
	packings: dict = field(default_factory=dict)
	blocks: dict = field(default_factory=dict)  #: name -> number of the grid block
	facts: dict = field(default_factory=dict)  #: sizes, speed, materials as used

	def field(self, part, name):
		"""Quantity `name` of McaEngine.field() for the automata of `part`, in the order of ids[part]."""
		return self.fields(part, (name, ))[name]

	def fields(self, part, names):
		"""Quantities `names` of McaEngine.field() for the automata of `part`, in the order of ids[part]: dict. One look at the bodies for all."""
		ids = self.idsOf(part)
		found = self.automata.fields(('ids', *names))
		at = np.searchsorted(found['ids'], ids)
		return {name: found[name][at] for name in names}

	def idsOf(self, part):
		"""Body ids of `part`. Raises SceneError when there is no such part."""
		if not isinstance(part, str) or part not in self.ids: raise SceneError('part must be one of %s; got %r' % (', '.join(map(repr, self.ids)), part))
		return self.ids[part]

	def vectors(self, part, x, y):
		"""Two quantities as columns, e.g. vectors('rod', 'vx', 'vy')."""
		found = self.fields(part, (x, y))
		return np.stack((found[x], found[y]), axis=1)

	def add(self, part, packing, material, **options):
		"""Adds bodies under the name `part` (text); see packings.addBodies."""
		if not isinstance(part, str) or not part: raise SceneError('part must be a name that is not empty; got %r' % (part, ))
		self.ids[part], self.packings[part] = np.array(addBodies(packing, material, **options)), packing
		return self.ids[part]

	def block(self, ids, dofs):
		"""Blocks degrees of freedom ('x', 'y', 'Z', in space also 'z', 'X', 'Y') of bodies for good, beside those that are blocked already."""
		for i in np.asarray(ids).tolist():
			state = omega().bodies[i].state
			state.blockedDOFs = ''.join(sorted(set(state.blockedDOFs + dofs)))


def start(engineOptions=None):
	"""An empty Scene whose McaEngine, with these attributes, is the only engine of O."""
	if engineOptions is not None and not isinstance(engineOptions, dict): raise SceneError("engineOptions must be None or a dict of McaEngine's attributes; got %r" % (engineOptions, ))
	s = Scene(automata=yadeClass('McaEngine')(**(engineOptions or {})))
	omega().engines = [s.automata]
	return s


# ---- checks: each raises SceneError


def _isNumber(v):
	return isinstance(v, (int, float, np.floating, np.integer)) and not isinstance(v, bool)


def positive(**values):
	for name, v in values.items():
		if not (_isNumber(v) and 0 < v <= LARGEST):
			raise SceneError('%s must be above 0 and finite; got %r' % (name, v))


def within(name, value, low, high, unit='', openLow=False):
	"""low <= value <= high (low < value with openLow); `high` may be inf, which then is allowed."""
	if not (_isNumber(value) and (low < value or value == low and not openLow) and value <= high):
		top = '' if high == math.inf else (' and at most %g' if openLow else ' to %g') % high
		raise SceneError('%s must be %s %g%s%s; got %r' % (name, 'above' if openLow else 'from', low, top, unit and ' ' + unit, value))


def oneOf(name, value, allowed):
	if value not in allowed:
		raise SceneError("%s '%s' is not one of %s" % (name, value, ', '.join(allowed)))


def affordable(spacing, *sizes):
	"""`sizes`: (width, height) [m] of what is filled with automata."""
	number = sum(a * b for a, b in sizes) / (PITCH * spacing**2)
	if not number <= MOST:
		raise SceneError('spacing %g m gives some %.2g automata; at most %g are made: take a spacing of at least %.2g m, or smaller bodies' %
		                 (spacing, number, MOST, spacing * math.sqrt(number / MOST)))


def subsonic(name, speed, *materials):
	"""`speed` [m/s] is at most MACH times the sound speed of the fastest of these materials (McaMat, name or record)."""
	from .materials import Material, get
	records = [get(m) if isinstance(m, (str, Material)) else m for m in materials]
	fastest = max(records, key=lambda m: m.bulkSoundSpeed)
	if not abs(speed) <= MACH * fastest.bulkSoundSpeed:
		raise SceneError("%s must be at most %g m/s, %g times the sound speed of '%s'; got %r" %
		                 (name, MACH * fastest.bulkSoundSpeed, MACH, getattr(fastest, 'name', None) or fastest.label, speed))
