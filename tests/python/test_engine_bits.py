# SPDX-License-Identifier: GPL-2.0-or-later
"""McaEngine: threads, sleeping, account and unused features change no bit."""
import os
import subprocess
import sys

import numpy as np
import pytest

import engine_scene as scene

THREADS = """
import sys; sys.path[:0] = %r
import yade_mca
import engine_scene as scene
from yade import O
scene.impact(speed=700., n=32)
e = scene.engine(account=True)
O.run(250, True)
print('digest', scene.digest(e), e.energies(), e.counters()['brokenLinks'])
"""


def test_sameBitsOnAnyNumberOfThreads(plugin):
	out = set()
	for n in '1', '2':
		r = subprocess.run(['/usr/bin/python3', '-c', THREADS % sys.path], capture_output=True, text=True, env=dict(os.environ, OMP_NUM_THREADS=n, MPLBACKEND='Agg'))
		assert r.returncode == 0, r.stderr
		out.add(r.stdout.split('digest')[1])
	assert len(out) == 1 and not out.pop().strip().endswith(' 0')


@pytest.mark.parametrize('off', [dict(sleeping=False), dict(account=True), dict(skin=0.6)])
def test_switchesChangeNoBit(plugin, off):
	"""A long bar struck at one end: most of it sleeps at first. The range of the search changes how often it is done, not what is found."""
	from yade import O
	digests = []
	for options in ({}, off):
		O.reset()
		scene.block(120, 8, constants=scene.HARD)
		scene.block(6, 8, at=(-63.2e-3, 0), constants=scene.HARD, velocity=(300., 0), mask=2)
		e = scene.engine(**options)
		asleep = []
		for _ in range(4):
			O.run(50, True)
			c = e.counters()
			asleep.append(c['blocks'] - c['awake'])
		digests.append([e.field(k).tobytes() for k in scene.FIELDS] + [e.counters()['brokenLinks']])
		assert (asleep[0] == 0) == (options == dict(sleeping=False))
	assert digests[0] == digests[1]


def test_sleepingBodiesWakeWhenTheScriptMovesThem(plugin):
	from yade import O
	ids = scene.block(100, 6)
	e = scene.engine(1e-8)
	O.run(5, True)
	assert e.counters()['awake'] == 0
	O.bodies[int(ids[0])].state.vel = (10., 0, 0)
	O.run(5, True)
	assert e.counters()['awake'] > 0 and abs(e.field('vx')).max() > 0


def test_runsInPiecesAreTheSameAsOne(plugin):
	from yade import O
	digests = set()
	for pieces in ([300], [1, 99, 200], [7] * 42 + [6]):
		O.reset()
		scene.impact()
		e = scene.engine()
		for n in pieces:
			O.run(n, True)
		digests.add(scene.digest(e))
	assert len(digests) == 1


def test_aMirroredSceneGivesTheMirrorImage(plugin):
	"""To round-off, as the order of sums is not mirrored."""
	from yade import O
	found = []
	for sign in (1, -1):
		O.reset()
		ids = scene.block(10, 10)
		for i in ids.tolist():
			s = O.bodies[i].state
			x, y = s.pos[0], s.pos[1]
			s.pos, s.vel = (x, sign * y, 0), (3 * np.sin(300 * x + 200 * y), sign * 3 * np.cos(250 * y), 0)
		e = scene.engine(2e-8)
		O.run(200, True)
		found.append([scene.pick(e, ids, k) * (sign if k in ('y', 'vy') else 1) for k in ('x', 'y', 'vx', 'vy')])
	for k, (a, b) in enumerate(zip(*found)):
		assert abs(a - b).max() < (1e-12 * scene.D if k < 2 else 1e-9)
