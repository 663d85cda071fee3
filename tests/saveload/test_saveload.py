# SPDX-License-Identifier: GPL-2.0-or-later
"""A simulation with plugin classes saved by one process is loaded by another, by every road; without the plugin YADE refuses it cleanly."""
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'abi'))
from abi_support import PYTHON, ROOT, runPython

FORMATS = ['xml', 'yade', 'xml.bz2', 'xml.gz', 'yade.gz']

SCENE = """
import abi_support
abi_support.loadFixture()
from yade import *
from yade import utils, Vector3
from yade.wrapper import *
O.materials.append(SdkMat(young=1e5, strength=3.25, label='m'))
for i in range(4): O.bodies.append(utils.sphere((1.9 * i, 0, 0), 1, material='m'))
O.bodies[1].state.damage = .1
O.bodies[1].state.traction = (1, 2, 1e-300)
O.bodies.append(Body(shape=SdkBall(r=.3), state=SdkState(), groupMask=8))
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()]),
	InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_SdkMat_SdkMat_SdkPhys(derived=True)], [Law2_ScGeom_SdkPhys_Spring()]),
	SdkEngine(label='sdk', part=SdkSpecialPart(name='one', extra=5), parts=[SdkPart(length=.1), SdkSpecialPart(extra=6)], vector3r=(.1, .2, .3), vectors3r=[(1, 2, 3)], texts=['<a>', 'b c'], passing=9),
	NewtonIntegrator(damping=0), SdkPeriodic(iterPeriod=7), SdkTimeStepper(active=False, step=.5), SdkIdle(dead=True)]
O.dt = 1e-4
O.engines[3].resize(1000)
O.run(20, True)
O.engines[3].view[5] = float('inf')
O.engines[3].view[6] = float('nan')
for i in O.interactions: i.phys.history = [1, .1]
"""

STATE = """
def state():
	import struct
	e = O.engines[3]
	exact = lambda *v: struct.pack('%dd' % len(v), *v)
	out = [exact(*b.state.pos, *b.state.vel) for b in O.bodies]
	out += [exact(*e.copy()), exact(*e.reals, e.real), e.part.extra, e.part.name, [type(p).__name__ for p in e.parts], e.parts[1].extra, list(e.texts), list(e.vectors3r), e.vector3r]
	out += [[(type(i.phys).__name__, i.phys.calls, exact(i.phys.kn, *i.phys.normalForce, *i.phys.history)) for i in O.interactions if i.isReal]]
	out += [type(O.materials[0]).__name__, O.materials[0].strength, O.bodies[0].mat.strength, O.bodies[1].state.damage, O.bodies[1].state.traction, O.bodies[4].shape.r, O.bodies[4].mask]
	out += [O.iter, list(O.engines[5].runs), O.engines[6].active, O.engines[6].step, O.engines[7].dead, e.label]
	return repr(out)
"""


@pytest.fixture(scope='module')
def saved(tmp_path_factory):
	"""Files of one simulation in every format, its state when saved, and its state 30 steps later."""
	folder = tmp_path_factory.mktemp('saved')
	done = runPython(
	        SCENE + STATE + """
for f in %r: O.save(%r + '/s.' + f)
open(%r + '/now', 'w').write(state())
assert O.engines[3].nPreSave == %d
O.run(30, True)
open(%r + '/later', 'w').write(state())
""" % (FORMATS, str(folder), str(folder), len(FORMATS), str(folder))
	)
	assert done.returncode == 0, done.stdout
	return folder


LOAD = """
O.load(%r)
assert state() == open(%r + '/now').read(), state()
assert O.engines[3].passing == 5.5 and O.engines[3].nPostLoad > 0
O.run(30, True)
assert state() == open(%r + '/later').read(), state()
print('loaded and continued')
"""

ROADS = {
        'plain python': ([PYTHON], 'import abi_support; abi_support.loadFixture()\nfrom yade import *\n'),
        'yade script': (['yade', '-n', '-x'], 'import abi_support; abi_support.loadFixture()\n'),
        'launcher': ([str(ROOT / 'pyscripts' / 'yade-mca'), '-n', '-x'], 'import abi_support; abi_support.loadFixture()\n'),
}


@pytest.mark.parametrize('kind', FORMATS)
@pytest.mark.parametrize('road', sorted(ROADS))
def test_loadsInANewProcessAndContinuesTheSameWay(saved, road, kind):
	interpreter, head = ROADS[road]
	done = runPython(head + STATE + LOAD % (str(saved / ('s.' + kind)), str(saved), str(saved)), interpreter=interpreter)
	assert done.returncode == 0 and 'loaded and continued' in done.stdout, done.stdout


def test_saveTmpAndStringsRoundTrip():
	done = runPython(
	        SCENE + STATE + """
before = state()
O.saveTmp('a'); text = O.sceneToString()
O.run(10, True)
after = state()
for back in (lambda: O.loadTmp('a'), lambda: O.stringToScene(text)):
	back(); assert state() == before
	O.run(10, True); assert state() == after
print('round')
"""
	)
	assert 'round' in done.stdout, done.stdout


@pytest.mark.parametrize('kind', ['xml', 'yade'])
def test_withoutThePluginYadeSaysSo(saved, kind):
	done = runPython(
	        """
import yade
from yade import O
try:
	O.load(%r)
except RuntimeError as e:
	print('refused:', e)
O.reset(); O.step(); print('alive', O.iter)
""" % str(saved / ('s.' + kind))
	)
	assert done.returncode == 0 and 'refused:' in done.stdout and 'alive 1' in done.stdout, done.stdout
	assert 'unregistered class' in done.stdout


def test_damagedFileIsAnErrorAndTheInterpreterLives(saved, tmp_path):
	data = (saved / 's.yade').read_bytes()
	cut = tmp_path / 'cut.yade'
	cut.write_bytes(data[:len(data) // 2])
	done = runPython("""
import abi_support; abi_support.loadFixture()
from yade import O
try:
	O.load(%r)
except (RuntimeError, MemoryError) as e:
	print('refused:', type(e).__name__)
print('alive')
""" % str(cut))
	assert done.returncode == 0 and 'refused:' in done.stdout and 'alive' in done.stdout, done.stdout
