# SPDX-License-Identifier: GPL-2.0-or-later
"""An error of an engine reaches the script every time: O.run(n, True) raises in 200 of 200 tries in one process, on an idle and on a busy core, and
a script ends with status 1."""
import concurrent.futures
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TRIES = 200
#: what fails in the first step, engine by engine
KINDS = {
        'McaEngine': "block(); O.engines = [McaEngine(dtFactor=-1)]",
        'McaEngine without bodies': "O.engines = [McaEngine(dtFactor=-1)]",
        'McaGridEngine': "O.engines = [grid(dtFactor=-1)]",
        'McaTimeStepper': "block(); O.engines = [McaTimeStepper(factor=-1), McaEngine()]",
        'McaLaw': "block(); O.dt = 1e-9; O.engines = scenes.law2Engines(); [e for e in O.engines if type(e).__name__ == 'McaLaw'][0].volumeRule = 'best'",
        'McaForces': "block(); O.dt = 1e-9; O.engines = scenes.law2Engines(); O.bodies[0].state.vel = (float('nan'), 0, 0)",
        'McaGridCoupler': "block(); O.engines = [McaTimeStepper(), McaEngine(), grid(), McaGridCoupler(side='left', tolerance=-1)]",
        'McaEngine, coupled': "block(); O.engines = [McaTimeStepper(), McaEngine(dtFactor=-1), grid(), McaGridCoupler(side='left')]",
}
BUSY = ('McaEngine', 'McaGridEngine', 'McaTimeStepper', 'McaGridCoupler')
SCRIPT = """
import sys, os, json, subprocess
sys.path[:0] = %r
if %r:
	os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
	subprocess.Popen([sys.executable, '-c', 'import os\\nparent = os.getppid()\\nwhile os.getppid() == parent: pass'])
import numpy as np, yade_mca
from yade import O
from yade.wrapper import McaEngine, McaGridEngine, McaGridCoupler, McaTimeStepper
from yade_mca import materials, packings, scenes
def block():
	packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((0, 0), (3e-3, 3e-3))), '4340')
def grid(**options):
	g = McaGridEngine(**options)
	g.addRectangle(materials.mcaMat('4340'), np.arange(4) * 1e-3, np.arange(4) * 1e-3)
	return g
lost = 0
for k in range(%d):
	O.reset()
	%s
	try:
		O.run(1, True)
		lost += 1
	except RuntimeError:
		pass
print('lost', lost, flush=True)
os._exit(0)
"""


def lost(kind, busy):
	code = SCRIPT % (sys.path, busy, TRIES, KINDS[kind])
	r = subprocess.run(['/usr/bin/python3', '-c', code], capture_output=True, text=True, timeout=600)
	assert 'lost' in r.stdout, r.stderr[-1500:]
	return int(r.stdout.split('lost')[1].split()[0])


_pool, _asked = concurrent.futures.ThreadPoolExecutor(4), {}


@pytest.mark.parametrize('kind', sorted(KINDS))
def test_everyErrorIsRaisedOnAnIdleMachine(plugin, kind):
	if not _asked:  # O.run waits most of the time: several at once
		_asked.update({k: _pool.submit(lost, k, False) for k in KINDS})
	n = _asked[kind].result()
	assert n == 0, '%d of %d errors were lost' % (n, TRIES)


@pytest.mark.parametrize('kind', BUSY)
def test_everyErrorIsRaisedBesideAnotherProcess(plugin, kind):
	"""On one core together with a process that spins."""
	n = lost(kind, True)
	assert n == 0, '%d of %d errors were lost' % (n, TRIES)


FAILS = """
from yade_mca import McaEngine, packings
from yade import O
packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((0, 0), (3e-3, 3e-3))), '4340')
O.engines = [McaEngine(dtFactor=-1)]
O.run(100, True)
print('went on', O.iter)
"""


@pytest.mark.parametrize('command', [
        [str(ROOT / 'pyscripts' / 'yade-mca'), '-n', '-x'],
        ['/usr/bin/python3'],
        ['/usr/bin/yade', '-n', '-x'],
], ids=['yade-mca', 'python3', 'yade'])
def test_aScriptEndsWithStatusOne(plugin, tmp_path, command):
	(tmp_path / 'fails.py').write_text(FAILS)
	env = dict(os.environ, PYTHONPATH=os.pathsep.join([str(ROOT / 'pyscripts'), os.environ.get('PYTHONPATH', '')]))

	def run(_):
		return subprocess.run(command + ['fails.py'], cwd=tmp_path, capture_output=True, text=True, stdin=subprocess.DEVNULL, env=env, timeout=300)

	for r in _pool.map(run, range(4)):
		assert 'went on' not in r.stdout and r.returncode == 1, (r.returncode, r.stdout[-300:], r.stderr[-500:])
		assert 'dtFactor' in r.stdout + r.stderr
