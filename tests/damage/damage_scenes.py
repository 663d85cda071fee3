# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes whose files are damaged: small, with everything that is saved. make(name, folder) writes one of them in every format."""
import gzip
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / 'python'))

SCENES = ('automata', 'grid', 'coupled', 'law2')
FORMATS = ('yade', 'yade.gz', 'xml', 'checkpoint')


def _automata():
	import engine_scene as scene
	a, _ = scene.impact(n=6, constants=dict(scene.HARD, eos='mieGruneisen', gruneisen=1.7, heatCapacity=477.))
	e = scene.engine(account=True, seed=7)
	x = scene.states(a)[:, 0]
	e.setViscous(a[x > x.max() - 6e-4].tolist(), (1, 0))
	return 120


def _grid():
	import numpy as np
	from yade import O
	from yade.wrapper import McaGridEngine
	from yade_mca import materials
	e = McaGridEngine()
	x = np.linspace(0, 0.01, 21)
	e.addRectangle(materials.mcaMat('4340', yieldModel='johnsonCook', eos='mieGruneisen'), x, x[:12])
	e.addRectangle(materials.mcaMat('WHA_JC', yieldModel='linearHardening'), x + 0.01, x[:12], edgeViscosity=True)
	e.openInteriorNode(0, 4, 4)
	e.setVelocity(0, (300., 20.))
	e.symmetry(0, 'bottom')
	e.viscous(1, 'right')
	e.pressure(0, 'top', ([0, 1e-6], [0, 1e9]))
	e.force([e.openNode(0, 4, 4)], 1e3)
	e.addGauge((0.005, 0.0025), 3)
	O.engines = [e]
	return 20


def _coupled():
	import math
	from yade import O
	from yade_mca import materials, scenes
	s = scenes.tiedPlate(materials.mcaMat('4340'), 4e-3, 1e-3, automataWidth=8e-3, plateWidth=20e-3, ends='viscous')
	s.automata.account = True
	for b in O.bodies:
		b.state.vel = (300 * math.cos(200 * b.state.pos[0]), -150, 0)
	return 30


def _law2():
	import law2_scene as scene
	from yade import O
	scene.impact(n=5)
	scene.engines('law2', 2e-8)
	O.trackEnergy = True
	return 150


def make(name, folder):
	"""Runs the scene for some steps and writes NAME.yade, .yade.gz, .xml and .checkpoint into folder; a fresh process each time."""
	import yade_mca  # noqa: F401
	from yade import O
	from yade_mca import checkpoint
	steps = globals()['_' + name]()
	O.run(steps, True)
	folder = Path(folder)
	for form in ('yade', 'xml'):
		O.save(str(folder / ('%s.%s' % (name, form))))
	(folder / (name + '.yade.gz')).write_bytes(gzip.compress((folder / (name + '.yade')).read_bytes(), 6, mtime=0))
	checkpoint.write(str(folder / (name + '.checkpoint')), dict(steps=steps), {})


if __name__ == '__main__':
	make(sys.argv[1], sys.argv[2])
