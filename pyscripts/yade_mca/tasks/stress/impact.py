# SPDX-License-Identifier: GPL-2.0-or-later
"""Impact speeds, angles of impact and of the packing: two blocks of automata, automata against a coupled plate."""
import math

from ... import scenes
from ..._yade import scene as omega
from ...packings import Rectangle, addBodies, hexagonal
from ..trials import D, material
from .judge import StressCase
from .watch import Watch, transit, twoBlocks

SPEEDS = (10, 30, 100, 300, 1000, 1520, 2000, 3000, 4000, 5000, 6000)
QUICK = (10, 300, 1520, 4000, 6000)
BREAKS = dict(fractureStrain=1., spallStrength=3e9, strengthSpread=0.05)
#: name -> (flyer, target): full strength with fracture, without fracture, hot
PAIRS = {
        'tungstenOnSteel': (lambda: (material('WHA_JC', **BREAKS), material('4340', **BREAKS))),
        'copperOnCopper': (lambda: (material('OFHC_Cu', yieldModel='perfect'), material('OFHC_Cu', yieldModel='perfect'))),
        'aluminiumHot': (lambda: (material('Al2024_T4', eos='mieGruneisen', **BREAKS), material('Al2024_T4', eos='mieGruneisen', **BREAKS))),
        'elasticSteel': (lambda: (material('4340', yieldModel='elastic'), material('4340', yieldModel='elastic'))),
}

UNBROKEN = ('copperOnCopper', 'elasticSteel')


def automata(pair, speed, **options):
	a, b = PAIRS[pair]()
	t = twoBlocks(a, b, float(speed), **options)
	return t.run(until=transit(a, b)).measures()


def watchedPlate(body, flyer, plate, speed, slant=0., thickness=16, dtFactor=0.4, **options):
	"""Watch: the packing `body` falls on a plate whose middle 24 spacings are automata and whose rest is grid."""
	omega().reset()
	s = scenes.tiedPlate(plate, thickness * D, D, automataWidth=24 * D, plateWidth=64 * D, ends='viscous', dtFactor=dtFactor, engineOptions=dict(dict(account=True), **options))
	middle = 0.5 * (body.positions[:, 0].max() + body.positions[:, 0].min())
	v = (speed * math.sin(slant), -speed * math.cos(slant))
	addBodies(body.translated((-middle, D - body.positions[:, 1].min())), flyer, velocity=v, mask=scenes.ROD)
	return Watch(s, [(k, plate) for k in s.blocks.values()])


def coupled(pair, speed):
	a, b = PAIRS[pair]()
	return watchedPlate(hexagonal(D, Rectangle((0, 0), (10 * D, 14 * D))), a, b, float(speed)).run(until=transit(a, b, times=3.)).measures()


def cases(quick, seed):
	found = []
	for pair in PAIRS:
		for speed in QUICK if quick else SPEEDS:
			# what cannot break flows until its packing collapses, and is refused then
			expect = 'held' if speed <= (300 if pair in UNBROKEN else 1520) else 'either'
			found.append(StressCase('impact/automata/%s/%dm/s' % (pair, speed), lambda p=pair, v=speed: automata(p, v), expect))
			found.append(StressCase('impact/coupled/%s/%dm/s' % (pair, speed), lambda p=pair, v=speed: coupled(p, v), expect))
	for degrees in range(0, 60 if quick else 90, 15 if quick else 5):
		a = math.radians(degrees)
		found.append(StressCase('impact/orientation/%ddeg' % degrees, lambda a=a: automata('tungstenOnSteel', 1000, angle=a)))
		if not quick:
			found.append(StressCase('impact/orientation/target%ddeg' % degrees, lambda a=a: automata('tungstenOnSteel', 1000, angle=0.3, targetAngle=a)))
	for degrees in (15, 45, 75) if quick else range(10, 90, 10):
		for name, friction in (('', 0.1), ('/friction1', 0.785)):
			a = math.radians(degrees)

			def oblique(a=a, friction=friction):
				m = material('4340', frictionAngle=friction, **BREAKS)
				return twoBlocks(m, m, 1000., slant=a).run(until=transit(m)).measures()

			found.append(StressCase('impact/oblique/%ddeg%s' % (degrees, name), oblique))
	return found
