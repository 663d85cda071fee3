# SPDX-License-Identifier: GPL-2.0-or-later
"""Reads all that an engine shows while O.run() runs in the background; test_every_call.py starts it as a process of its own.

    python3 tests/python/every_call_readers.py engine|law2|grid|coupled [SECONDS]     # ends with the number of reads, or crashes

What is read is found by looking at the class: properties and methods without arguments, and a few with arguments that are known.
"""
import sys
import time

import every_call_classes as classes
import every_call_scenes as scenes

LEAST = 100  #: reads
#: methods that change something or are no reading
NOT_READ = ('__call__', 'reload')
D = 1e-3
#: arguments of reading methods that have some
WITH = {
        'McaEngine.field': [(name, ) for name in ('x', 'vx', 'pressure', 'plasticStrain', 'links', 'brokenLinks', 'equivalentStress', 'material')],
        'McaEngine.fields': [(['ids', 'x', 'pressure', 'links'], )],
        'McaGridEngine.view': [(0, name) for name in ('x', 'vx', 'sxx', 'pressure', 'energy', 'plasticStrain')],
        'McaGridEngine.probeLine': [((0., 1.1 * D), (3 * D, 1.2 * D), 20)],
        'McaGridEngine.gauge': [(0, )],
}


def impact():
	"""A block flies into another: contacts grow, links break."""
	from yade_mca import packings
	m = scenes.metal(fractureStrain=0.05, strengthSpread=0.1)
	at = lambda x, y, w, h: packings.hexagonal(D, packings.Rectangle((x * D, y * D), (w * D, h * D)), rim='full')
	packings.addBodies(at(0, 0, 14, 10), m, mask=1)
	packings.addBodies(at(1, 9.6, 7, 8), m, velocity=(60., -500.), mask=3)


def build(road):
	from yade import O
	from yade.wrapper import McaEngine
	if road == 'grid': return scenes.gridScene()
	if road == 'coupled': return scenes.coupledScene()
	impact()
	if road == 'engine': O.engines = [McaEngine(account=True)]
	else:
		from yade_mca.scenes import law2Engines
		O.engines = law2Engines(stepFactor=0.4)
		O.trackEnergy = True


def readings(engine):
	"""Functions without arguments, one for each thing that can be read."""
	out = []
	for owner, name, thing in classes.members(type(engine)):
		if name in NOT_READ: continue
		if isinstance(thing, property): out.append(lambda n=name: getattr(engine, n))
		elif not classes.arguments(thing): out.append(getattr(engine, name))
		else: out += [lambda n=name, a=a: getattr(engine, n)(*a) for a in WITH.get('%s.%s' % (owner.__name__, name), ())]
	return out


def main(road, seconds):
	import yade_mca
	from yade import O
	end, reads, refused = time.time() + seconds, 0, set()
	while time.time() < end or reads <= LEAST and time.time() < end + 200:  # a busy machine takes longer
		O.reset()
		build(road)
		O.step()
		read = [f for e in O.engines if type(e).__name__ in yade_mca.classes for f in readings(e)]
		O.run(10**9, False)
		stop = time.time() + 0.4
		while time.time() < stop and O.running:
			for f in read:
				try:
					f()
				except RuntimeError as e:
					refused.add(str(e)[:200])
				reads += 1
		scenes.stop()
	print('%d reads, %d kinds of refusals %s' % (reads, len(refused), sorted(refused)))


if __name__ == '__main__':
	main(sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 2.)
	sys.stdout.flush()
	import os
	os._exit(0)
