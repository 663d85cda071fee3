# SPDX-License-Identifier: GPL-2.0-or-later
"""Python objects of engines that outlive their scene or their bodies, and engines used again: right, or refused. Each in a process of its own."""
import subprocess
import sys

import pytest

CRASHES = """
import sys, os
sys.path[:0] = %r
import yade_mca, builtins
from yade import O
from test_matrix_cases import *
from test_handles import CALLS
ids = block((100., 0.))
e = engine()
run(10)
def refused(f):
	try: f()
	except RuntimeError as error:
		assert len(str(error)) > 40, str(error)
		return True
	return False
"""


def process(code):
	"""Runs code after CRASHES in a process of its own; what it asserts holds and nothing crashes."""
	end = "\nprint('reached the end', flush=True)\nos._exit(0)\n"
	r = subprocess.run(['/usr/bin/python3', '-c', CRASHES % sys.path + code + end], capture_output=True, text=True, timeout=120)
	assert 'reached the end' in r.stdout, 'status %d\n%s' % (r.returncode, r.stderr[-1500:])


CALLS = ['e.sync()', 'e.reload()', "e.field('x')", 'e.energies()', 'e.links()', 'e.momentum', 'e.ids',
         'e.setViscous(ids, (1, 0))', 'e.counters()', 'e.count', 'e.criticalTimeStep']


@pytest.mark.parametrize('end', ['O.reset()', 'O.bodies.clear()'])
def test_handleAfterTheSceneIsGone(plugin, end):
	"""Nothing crashes, neither in the empty scene nor with other bodies in it, and those are left alone."""
	process("""
%s
for call in CALLS:
	print(call, file=sys.stderr, flush=True)
	refused(lambda: eval(call))
ids = block()[:10]
for i in ids[5:]: O.bodies.erase(i)
before = x(ids[:5])
for call in CALLS:
	print(call, 'with bodies', file=sys.stderr, flush=True)
	refused(lambda: eval(call))
	assert (x(ids[:5]) == before).all(), call
""" % end)


def test_syncAfterResetIsRefused(plugin):
	"""And touches no new body."""
	process("O.reset()\nassert refused(e.sync)\nids = block()\nbefore = x(ids)\nrefused(e.sync)\nassert (x(ids) == before).all()")


@pytest.mark.parametrize('end', ['O.reset()', 'O.load(name)', 'O.loadTmp()', 'O.switchToScene(O.addScene())'])
def test_anOldHandleShowsNoNumbers(plugin, end):
	"""They would be those of a scene that is gone, and look like those of the present one."""
	process("""
import tempfile
name = tempfile.mkdtemp() + '/a.yade'
O.save(name)
O.saveTmp()
%s
for call in "e.field('x')", "e.fields(['x'])", 'e.energies()', 'e.links()', 'e.momentum', 'e.ids':
	assert refused(lambda: eval(call)), call
""" % end)


def test_pictureAfterReset(plugin):
	process("""
from yade_mca import viewer
picture = viewer.Picture(e, 'pressure')
O.reset()
refused(picture.update)
ids = block()
before = x(ids)
refused(picture.update)
assert (x(ids) == before).all()
""")


def test_handleOfAnotherScene(plugin):
	process("""
k = O.addScene()
O.switchToScene(k)
other = block((0., 50.), (3e-3, 2e-3))
before = scene.states(other)
refused(e.sync)
assert (scene.states(other) == before).all(), 'scene 0 was put on scene 1'
engine()
run(10)
O.switchToScene(0)
run(10)
""")


def test_handleAfterLoadTmp(plugin):
	process("""
O.saveTmp()
run(10)
O.loadTmp()
before = x(ids)
refused(e.sync)
assert (x(ids) == before).all(), 'the old handle wrote over the loaded bodies'
run(5)
assert abs(x(ids) - before - 100. * 5 * DT).max() < 1e-13
""")


@pytest.mark.parametrize('end', ['O.reset()', 'O.bodies.clear()', 'O.bodies.clear(); O.interactions.clear()'])
def test_sweepWithTheSameEngine(plugin, end):
	process("""
import numpy as np
hard = dict(yieldModel='perfect', yieldStress=0.3e9)
def case():
	ids = block(**hard)
	for k, i in enumerate(ids): O.bodies[i].state.vel = (80 * np.sin(k), 60 * np.cos(2 * k), 0)
	return ids
def result(e, ids):
	O.engines, O.dt = [e], DT
	run(60)
	return scene.states(ids)
O.reset()
e = McaEngine(adaptive=False)
right = result(McaEngine(adaptive=False), case())
O.reset()
ids = case()
e.setViscous(ids[:3], (1, 0))
result(e, ids)
%s
O.stopAtIter = 0
ids = case()
try:
	now = result(e, ids)
	assert abs(now - right).max() <= 1e-9 * abs(right).max(), 'wrong from the second case on: %%g' %% abs(now - right).max()
except RuntimeError as error:
	assert len(str(error)) > 40, str(error)
	now = result(McaEngine(adaptive=False), ids)
	assert abs(now - right).max() <= 1e-9 * abs(right).max()
""".replace('import numpy as np', 'import numpy as np\nfrom yade_mca import McaEngine', 1) % end)
