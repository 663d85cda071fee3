# SPDX-License-Identifier: GPL-2.0-or-later
"""Saved in one release of Debian, loaded in another: `yade-mca -n -x clean_exchange.py save SUITE FOLDER`, then `... load SUITE FILE` over there.

What is expected stands in plugin/doc/guide.rst: files with our engines load in the newer release and go on with the same numbers; binary files do not load in the older one, and no
file with YADE's own NewtonIntegrator loads across, for its members differ. One line `EXCHANGE ...` says what happened; status 0 when it is what was expected or more.
"""
import json
import os
import sys

import numpy as np
import yade_mca
from yade import O
from yade_mca import packings, scenes

ORDER = ('bookworm', 'trixie', 'forky')
FORMS = ('xml', 'yade.gz')
STEPS = 200


def block():
	ids = packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((0, 0), (12e-3, 6e-3))), '4340')
	ids += packings.addBodies(packings.hexagonal(1e-3, packings.disc((6e-3, 8.2e-3), 2e-3)), '4340', velocity=(0, -300), mask=3)
	return ids


def engine():
	block()
	O.engines = [yade_mca.McaEngine()]


def law2():
	block()
	O.engines = scenes.law2Engines()
	O.dt = 2e-8


def coupled():
	scenes.penetration(thickness=10e-3, spacing=2e-3, rodLength=20e-3, rodDiameter=8e-3, automataWidth=30e-3, plateWidth=50e-3)


SCENES = dict(engine=engine, law2=law2, coupled=coupled)


def numbers():
	for e in O.engines:
		if type(e).__name__ == 'McaEngine': e.sync()
	return [O.time] + [x for b in O.bodies for x in (*b.state.pos, *b.state.vel)]


def save(suite, folder):
	for kind, build in SCENES.items():
		O.reset()
		build()
		O.run(STEPS, True)
		name = os.path.join(folder, '%s-%s' % (suite, kind))
		for form in FORMS:
			O.save('%s.%s' % (name, form))
		O.run(STEPS, True)
		with open(name + '.json', 'w') as file:
			json.dump(numbers(), file)


def load(suite, path):
	origin, kind = os.path.basename(path).split('.')[0].split('-')
	older = ORDER.index(suite) < ORDER.index(origin)
	expected = kind != 'law2' and not (older and path.endswith('.gz'))
	try:
		O.load(path)
	except Exception as e:
		print('EXCHANGE does not load, %s (%s)' % ('which is known' if not expected else 'BUT SHOULD', ' '.join(str(e).split())[:80]))
		return not expected
	O.run(STEPS, True)
	with open(os.path.join(os.path.dirname(path), '%s-%s.json' % (origin, kind))) as file:
		reference = np.array(json.load(file))
	off = abs(np.array(numbers()) - reference).max() / abs(reference).max()
	print('EXCHANGE %s, goes on, off by %.1e' % ('loads' if expected else 'loads, which is more than the guide promises', off))
	return off < 1e-9


if __name__ == '__main__':
	task, suite, where = sys.argv[1:4]
	if task == 'save': save(suite, where)
	elif not load(suite, where): sys.exit(1)
