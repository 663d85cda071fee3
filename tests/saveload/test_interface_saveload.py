# SPDX-License-Identifier: GPL-2.0-or-later
"""A coupled run saved by one process goes on in another exactly as it would have without the pause."""
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCENE = """
import sys
sys.path.insert(0, %r)
import math, yade_mca
from yade import O
from yade_mca import materials, scenes
def build():
	s = scenes.tiedPlate(materials.mcaMat('4340'), 8e-3, 1e-3, automataWidth=16e-3, plateWidth=50e-3, ends='viscous')
	s.automata.account = True
	for b in O.bodies: b.state.vel = (300 * math.cos(200 * b.state.pos[0]), -150, 0)
def digest():
	a, g, c = O.engines[1], O.engines[2], O.engines[3]
	out = [a.field(k).tobytes() for k in ('x', 'y', 'vx', 'vy', 'omega', 'plasticStrain', 'pressure', 'fx')]
	out += [g.view(b, w).tobytes() for b in (0, 1) for w in ('x', 'y', 'vx', 'vy', 'sxx', 'energy')]
	return repr((out, sorted(c.energies().items()), list(c.rowIds), O.dt, O.iter))
""" % str(ROOT / 'pyscripts')


def process(code, cwd):
	r = subprocess.run(['/usr/bin/python3', '-c', SCENE + code], cwd=cwd, capture_output=True, text=True, env=dict(os.environ, MPLBACKEND='Agg'))
	assert r.returncode == 0, r.stderr


@pytest.mark.parametrize('form', ['yade', 'xml.gz'])
@pytest.mark.parametrize('first', [0, 60])
def test_continuesBitIdentically(tmp_path, form, first):
	process("build(); %s; O.save('half.%s'); O.run(120, True); open('whole', 'w').write(digest())" % ('O.run(%d, True)' % first if first else '0', form), tmp_path)
	# blocks of the grid are saved as well before the first step
	process("O.load('half.%s'); O.run(120, True); open('parts', 'w').write(digest())" % form, tmp_path)
	assert (tmp_path / 'whole').read_text() == (tmp_path / 'parts').read_text()
