# SPDX-License-Identifier: GPL-2.0-or-later
"""O.pause(), O.reset() and loads at once after O.run(), on one core beside a process that spins: YADE's loop may not even have begun then, and
stock YADE takes its record away from the thread, which crashes or hangs."""
import os
import subprocess
import sys

import pytest

SCRIPT = """
import sys, os, random, subprocess, time
sys.path[:0] = %r
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
subprocess.Popen([sys.executable, '-c', 'import os\\nparent = os.getppid()\\nwhile os.getppid() == parent: pass'])
import yade_mca
from yade import O
from yade.wrapper import McaEngine
from yade_mca import packings, scenes
random.seed(1)
for k in range(%d):
	packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((0, 0), (3e-3, 3e-3))), '4340')
	O.engines = [McaEngine()] if %r == 'engine' else scenes.law2Engines(stepFactor=0.4)
	O.saveTmp('start', quiet=True)
	O.run(10**9, False)
	pause = random.choice([0, 0, 1e-4, 1e-3])
	if pause: time.sleep(pause)
	%s
	assert not O.running
	O.reset()
print('survived', flush=True)
os._exit(0)
"""
ENDS = {'pause': 'O.pause()', 'reset': 'O.reset()', 'load': "O.loadTmp('start', quiet=True)", 'pause, run, pause': 'O.pause(); O.run(); O.pause()'}


@pytest.mark.parametrize('end', ENDS)
@pytest.mark.parametrize('road', ['engine', 'law2'])
def test_theLoopMayBeTakenAwayAtAnyMoment(plugin, road, end):
	r = subprocess.run([sys.executable, '-c', SCRIPT % (sys.path, 250, road, ENDS[end])], capture_output=True, text=True, timeout=600, env=dict(os.environ, OMP_NUM_THREADS='1'))
	assert r.returncode == 0 and 'survived' in r.stdout, (r.returncode, r.stdout[-200:], r.stderr[-500:])


def test_aRunnerThatPausesInTheFirstStepDoesNotWaitForItself(plugin):
	"""It runs in the thread that O.pause() would wait for, before any engine of the plugin has."""
	code = """
import sys, time
sys.path[:0] = %r
import yade_mca
from yade import O, PyRunner
from yade.wrapper import McaEngine
from yade_mca import packings
packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((0, 0), (3e-3, 3e-3))), '4340')
took = []
def stop():
	begin = time.monotonic()
	O.pause()
	took.append(time.monotonic() - begin)
import builtins
builtins.stop = stop
O.engines = [PyRunner(command='stop()', iterPeriod=1, initRun=True), McaEngine()]
O.run(10, False)
while O.running: time.sleep(1e-3)
O.pause()
print('paused at', O.iter, len(took), 'waited' if took[0] > 1.5 else 'at once')
"""
	r = subprocess.run([sys.executable, '-c', code % (sys.path, )], capture_output=True, text=True, timeout=300)
	assert 'paused at 1 1 at once' in r.stdout, (r.stdout[-300:], r.stderr[-500:])
