# SPDX-License-Identifier: GPL-2.0-or-later
"""A run of the grid saved by one process goes on in another exactly as it would have without the pause."""
import os
import subprocess

import pytest

SCENE = """
import sys, numpy as np, yade_mca
from yade import O
from yade.wrapper import McaGridEngine
from yade_mca import materials
def build():
	e = McaGridEngine()
	x = np.linspace(0, 0.03, 61)
	e.addRectangle(materials.mcaMat('4340', yieldModel='johnsonCook', eos='mieGruneisen'), x, x[:31])
	e.addRectangle(materials.mcaMat('WHA_JC', yieldModel='linearHardening'), x + 0.03, x[:31], edgeViscosity=True)
	e.setVelocity(0, (300., 20.))
	e.symmetry(0, 'bottom')
	e.viscous(1, 'right')
	e.pressure(0, 'top', ([0, 1e-6], [0, 1e9]))
	e.addGauge((0.02, 0.005), 3)
	O.engines = [e]
def digest():
	e = O.engines[0]
	out = [e.view(b, w).tobytes() for b in (0, 1) for w in ('x', 'y', 'vx', 'vy', 'sxx', 'syy', 'sxy', 'plasticStrain', 'energy', 'pressure')]
	return repr((out, e.view(0, 'temperature').tobytes(), e.gauge(0).tobytes(), sorted(e.energies().items()), O.dt, e.time, e.steps, O.iter))
"""


def process(code, cwd):
	r = subprocess.run(['/usr/bin/python3', '-c', SCENE + code], cwd=cwd, capture_output=True, text=True, env=dict(os.environ, MPLBACKEND='Agg'))
	assert r.returncode == 0, r.stderr


@pytest.mark.parametrize('form', ['yade', 'xml.bz2'])
def test_continuesBitIdentically(tmp_path, form):
	process("build(); O.run(40, True); O.save('half.%s'); O.run(40, True); open('whole', 'w').write(digest())" % form, tmp_path)
	process("O.load('half.%s'); O.run(40, True); open('parts', 'w').write(digest())" % form, tmp_path)
	assert (tmp_path / 'whole').read_text() == (tmp_path / 'parts').read_text()


def test_savingAfterAnErrorKeepsTheState(tmp_path):
	process("""
build(); O.run(5, True)
e = O.engines[0]
e.adaptive = False
dt, O.dt = O.dt, 1.
try: O.step()
except RuntimeError as error: assert 'too large' in str(error)
else: raise SystemExit('no error')
O.save('s.yade'); O.load('s.yade')
e = O.engines[0]
assert e.steps == 5
O.dt = dt
O.run(3, True)
assert e.steps == 8
""", tmp_path)
