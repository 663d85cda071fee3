# SPDX-License-Identifier: GPL-2.0-or-later
"""Automata moved by McaEngine: a run saved by one process goes on in another exactly as without the pause: before the first step, after fracture, with contacts and boundaries."""
import os
import subprocess
from pathlib import Path

import pytest

SCENE = """
import sys
sys.path.insert(0, %r)
import yade_mca
import engine_scene as scene
from yade import O, ForceEngine, ForceResetter
JOHNSON_COOK = dict(scene.HARD, yieldModel='johnsonCook', yieldStress=0.79e9, hardeningModulus=0.51e9, hardeningExponent=0.26, rateCoefficient=0.014, thermalSoftening=1.03,
                    meltTemperature=1793., heatCapacity=477., eos='mieGruneisen', gruneisen=1.7)
def build(kind):
	a, b = scene.impact(constants=JOHNSON_COOK if kind == 'johnsonCook' else scene.HARD)
	rule = kind if kind in ('inversePower', 'meanDistance') else 'affine'
	e = scene.engine(account=True, volumeRule=rule, readForces=kind == 'boundaries', seed=7)
	if kind == 'boundaries':
		x = scene.states(a)[:, 0]
		e.setViscous(a[x > x.max() - 6e-4].tolist(), (1, 0))
		scene.blocked(a[x < x.min() + 6e-4][:3], 'xyzXYZ')
		O.engines = [ForceResetter(), ForceEngine(ids=a[:4].tolist(), force=(0, 1e5, 0)), e]
def digest():
	e = O.engines[-1]
	return repr((scene.digest(e), sorted(e.energies().items()), sorted(e.counters().items()), O.dt, O.iter, e.criticalTimeStep))
""" % str(Path(__file__).resolve().parents[1] / 'python')


def process(code, cwd):
	r = subprocess.run(['/usr/bin/python3', '-c', SCENE + code], cwd=cwd, capture_output=True, text=True, env=dict(os.environ, MPLBACKEND='Agg'))
	assert r.returncode == 0, r.stderr


@pytest.mark.parametrize('kind, form, first', [('plain', 'yade', 300), ('plain', 'xml.bz2', 300), ('plain', 'yade.gz', 0), ('johnsonCook', 'yade', 300), ('inversePower', 'xml', 120),
                                               ('meanDistance', 'yade', 120), ('boundaries', 'xml.gz', 300)])
def test_continuesBitIdentically(tmp_path, kind, form, first):
	process("build(%r); %s; O.save('half.%s'); O.run(300, True); open('whole', 'w').write(digest())" % (kind, 'O.run(%d, True)' % first if first else '0', form), tmp_path)
	process("O.load('half.%s'); O.run(300, True); open('parts', 'w').write(digest())" % form, tmp_path)
	whole = (tmp_path / 'whole').read_text()
	assert whole == (tmp_path / 'parts').read_text()
	assert "('brokenLinks', 0)" not in whole and "('contacts', 0)" not in whole


def test_savingLeavesNothingBehind(tmp_path):
	"""What was put into the file must not come back when attributes are set later."""
	process("""
build('plain'); O.run(60, True); O.save('s.yade'); O.run(60, True)
e = O.engines[0]
before = digest()
e.updateAttrs(dict(dtFactor=.3))
assert e.counters()['steps'] == 120 and digest() == before
""", tmp_path)
