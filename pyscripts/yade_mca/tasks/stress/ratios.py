# SPDX-License-Identifier: GPL-2.0-or-later
"""What features cost that a scene does not need, as ratios within one process: scenes stand side by side and take turns, the best of their turns counts.

A machine's load drifts by tens of percent within seconds; alternating and taking the minimum of the engine's own timer leaves about a percent when it is quiet.
What is left is measured, as the difference between copies of the same scene, and added to the limit. `stress --only ratios` shows the table.
"""
import math

import numpy as np

from ... import materials, packings
from ..._yade import scene as omega
from ..._yade import yadeClass
from .watch import advance

D = 1e-3
OVERHEAD = 0.02  #: largest cost of a feature that is present but has nothing to do, over the scene without it


def steel(**changes):
	return materials.mcaMat('4340', **dict(dict(yieldModel='perfect', yieldStress=0.8e9), **changes))


def automata(count=4000, shake=30., material=None, width=None, **engine):
	"""Function that fills the scene with a block of `count` automata in random motion; width of the moving part in spacings (None: all)."""

	def make():
		side = math.sqrt(count * 0.5 * math.sqrt(3)) * D
		p = packings.hexagonal(D, packings.Rectangle((0.5 * side, 0.5 * side), (side, side)), rim='full')
		v = np.random.default_rng(1).uniform(-shake, shake, (len(p), 2))
		if width is not None:
			v[p.positions[:, 0] > width * D] = 0
		packings.addBodies(p, (material or steel)(), velocity=v)
		omega().engines = [yadeClass('McaEngine')(adaptive=False, **engine)]
	return make


def cells(n=64, shake=30., material=None, gauges=0, block=None, **engine):
	"""The same for a grid of n x n cells."""

	def make():
		g = yadeClass('McaGridEngine')(adaptive=False, **engine)
		x = (np.arange(n + 1) * D).tolist()
		g.addRectangle((material or steel)(), x, x, **(block or {}))
		g.setVelocity(0, np.random.default_rng(1).uniform(-shake, shake, (n + 1, n + 1, 2)))
		for k in range(gauges):
			g.addGauge(((k + 0.5) * D, 0.5 * D), 1000)
		omega().engines = [g]
	return make


def inside():
	"""Nanoseconds spent in the scene's solvers so far: without the write-back to bodies that ends each run of McaEngine."""
	return sum(sum(e.phases().values()) if type(e).__name__ == 'McaEngine' else e.execTime for e in omega().engines)


def whole():
	"""Nanoseconds spent in the scene's engines so far."""
	return sum(e.execTime for e in omega().engines)


class Turns:
	"""Scenes that take turns. `best[name]`: seconds per step of all engines of the scene, the best turn so far.

	copies: of each scene, made in turn, since where its arrays happen to lie in memory changes the time by some percent.
	"""

	def __init__(self, makers, dt=1e-8, warm=20, copies=3):
		self.scenes, self.best, self.each = [], {}, {}
		o = omega()
		o.reset()
		for k in range(copies):
			for name in list(makers)[::-1 if k % 2 else 1]:
				if self.scenes:
					o.switchToScene(o.addScene())
				self.scenes.append((name, o.thisScene))
				makers[name]()
				o.dt = dt
				advance(warm)

	def run(self, steps, turns, spent=inside):
		o = omega()
		o.timingEnabled = True
		try:
			for turn in range(turns):
				for name, number in self.scenes[::1 if turn % 2 else -1]:  # back and forth: no scene always follows the same other one
					o.switchToScene(number)
					before = spent()
					advance(steps)
					seconds = (spent() - before) * 1e-9 / steps
					self.best[name] = min(self.best.get(name, math.inf), seconds)
					self.each[number] = min(self.each.get(number, math.inf), seconds)
		finally:
			o.timingEnabled = False
		return self.best

	def noise(self):
		"""What the machine leaves uncertain [-]: largest difference between the two best copies of the same scene, over the best."""
		worst = 0.
		for name in self.best:
			a, b = sorted(self.each[number] for n, number in self.scenes if n == name)[:2]
			worst = max(worst, b / a - 1)
		return worst

	def close(self):
		omega().switchToScene(0)
		omega().reset()


#: name -> (present but without effect, absent)
AUTOMATA = {
        'infinite yield stress': (dict(material=lambda: steel(yieldStress=math.inf)), dict(material=lambda: steel(yieldModel='elastic', yieldStress=math.inf))),
        'scatter without strengths': (dict(material=lambda: steel(strengthSpread=0.2)), {}),
        'Grueneisen parameter without its equation': (dict(material=lambda: steel(gruneisen=3.)), dict(material=lambda: steel(gruneisen=0.))),
        'friction without contacts': (dict(material=lambda: steel(frictionAngle=0.5)), dict(material=lambda: steel(frictionAngle=0.))),
        'viscosity of zero': (dict(material=lambda: steel(viscosityLinear=0., viscosityQuadratic=0.)), {}),
        'contact search in an intact body': (dict(contacts=True), dict(contacts=False)),
        'sleeping where everything moves': (dict(sleeping=True), dict(sleeping=False)),
        'account off': (dict(account=False), {}),
        'strength that is never reached': (dict(material=lambda: steel(spallStrength=1e15)), {}),
}
CELLS = {
        'infinite yield stress': (dict(material=lambda: steel(yieldStress=math.inf)), dict(material=lambda: steel(yieldModel='elastic', yieldStress=math.inf))),
        'Grueneisen parameter without its equation': (dict(material=lambda: steel(gruneisen=3.)), dict(material=lambda: steel(gruneisen=0.))),
        'sleeping where everything moves': (dict(sleeping=True), dict(sleeping=False)),
        'gauges between their periods': (dict(gauges=4), {}),
}
#: no tight limit: the feature acts (a test of strength is a pass of its own, the absence of viscosity saves one)
LOOSE = ('strength that is never reached', 'viscosity of zero')


def presentButOff(quick):
	"""Cost of each feature that does nothing, over the scene without it, minus one."""
	records, turns = [], 12 if quick else 60
	for part, table, make, steps in (('automata', AUTOMATA, automata, 10), ('grid', CELLS, cells, 20)):
		for name, (present, absent) in table.items():
			t = Turns({'present': make(**present), 'absent': make(**absent)})
			best = t.run(steps, turns)
			noise = t.noise()
			t.close()
			over, limit = best['present'] / best['absent'] - 1, None if name in LOOSE else OVERHEAD + noise
			records.append(dict(name='ratios/%s/%s' % (part, name), value=over, limit=limit, passed=limit is None or over <= limit, unit='of the step without it (noise %.1f %%)' % (100 * noise)))
	return records


def idle(quick):
	"""Engines with nothing to do: time per step [ns]."""
	t = Turns({'automata': automata(10000, 0.), 'grid': cells(100, 0.)}, copies=1)
	best = dict(t.run(1000 if quick else 3000, 2, whole))
	t.close()
	t = Turns({'automata, moving': automata(10000), 'grid, moving': cells(100)}, copies=1)
	best.update(t.run(50, 3, whole))
	t.close()
	records = []
	for part in 'automata', 'grid':
		records.append(dict(name='ratios/idle/%s' % part, value=best[part] * 1e9, unit='ns per step'))
		records.append(dict(name='ratios/idle/%s/overMoving' % part, value=best[part] / best[part + ', moving'], limit=0.02, passed=best[part] <= 0.02 * best[part + ', moving'], unit='of the step when all moves'))
	return records


def proportional(quick):
	"""A block of which a fifth moves, against all of it: time over the share of blocks that are computed. Few steps: what moves spreads by two links a step."""
	t = Turns({'all': automata(40000), 'part': automata(40000, width=40)}, warm=2, copies=1)
	best = t.run(2, 4)
	share = {}
	for name, number in t.scenes:
		omega().switchToScene(number)
		c = omega().engines[0].counters()
		share[name] = c['awake'] / c['blocks']
	t.close()
	per = best['part'] / best['all'] / (share['part'] / share['all'])
	return [dict(name='ratios/sleeping/computedShare', value=share['part'], unit='of the blocks'), dict(name='ratios/sleeping/timeShare', value=best['part'] / best['all'], unit='of the step'),
	        dict(name='ratios/sleeping/timeOverWork', value=per, limit=1.25, passed=per <= 1.25, unit='-')]


def writing(quick):
	"""Write-back period and energy account against neither."""
	t = Turns({'none': automata(), 'every 10': automata(writePeriod=10), 'every step': automata(writePeriod=1), 'account': automata(account=True)})
	best = t.run(40, 4 if quick else 15, whole)
	t.close()
	return [dict(name='ratios/writeBack/%s' % k.replace(' ', ''), value=best[k] / best['none'] - 1, unit='of the step without it') for k in ('every 10', 'every step')] + [
	        dict(name='ratios/account/on', value=best['account'] / best['none'] - 1, unit='of the step without it')]


def measure(quick):
	"""Records for Report.add: dicts with name, value, unit, and where something is asserted limit and passed."""
	return [*presentButOff(quick), *idle(quick), *proportional(quick), *writing(quick)]
