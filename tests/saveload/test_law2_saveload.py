# SPDX-License-Identifier: GPL-2.0-or-later
"""Automata moved by the law in YADE's loop: a run saved by one process goes on in another exactly as without the pause, after fracture, with contacts and a wall; any number of
threads gives the same bits."""
import os
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
SCENE = """
import sys
sys.path.insert(0, %r)
import yade_mca
import law2_scene as scene
from yade import O, utils
def build():
	ids = scene.impact()
	O.bodies.append(utils.wall(5.6e-3, axis=0, material=O.bodies[ids[0]].material))
	scene.engines('law2', 2e-8)
	O.trackEnergy = True
def digest():
	ids = [b.id for b in O.bodies if type(b.shape).__name__ == 'Sphere']
	d = scene.density()
	return repr((scene.state(ids).tobytes(), sorted(d.energies().items()), sorted(d.counters().items()), sorted(d.links()), O.dt, O.iter, d.criticalTimeStep))
""" % str(HERE.parent / 'python')


def process(code, cwd, threads=1):
	r = subprocess.run(['/usr/bin/python3', '-c', SCENE + code], cwd=cwd, capture_output=True, text=True, env=dict(os.environ, MPLBACKEND='Agg', OMP_NUM_THREADS=str(threads)))
	assert r.returncode == 0, r.stderr


@pytest.mark.parametrize('form', ['yade', 'xml.bz2'])
def test_continuesBitIdentically(tmp_path, form):
	process("build(); O.run(300, True); O.save('half.%s'); O.run(300, True); open('whole', 'w').write(digest())" % form, tmp_path)
	process("O.load('half.%s'); O.run(300, True); open('parts', 'w').write(digest())" % form, tmp_path)
	whole = (tmp_path / 'whole').read_text()
	assert whole == (tmp_path / 'parts').read_text()
	assert "('brokenLinks', 0)" not in whole


@pytest.mark.parametrize('form', ['yade.gz', 'xml'])
def test_savedBeforeTheFirstStep(tmp_path, form):
	"""Links are made in the first step, whether the scene was loaded by another process, by the same one, or not at all."""
	process("build(); O.run(200, True); open('whole', 'w').write(digest())", tmp_path)
	process("build(); O.save('new.%s'); O.load('new.%s'); O.run(200, True); open('same', 'w').write(digest())" % (form, form), tmp_path)
	process("O.load('new.%s'); O.run(200, True); open('other', 'w').write(digest())" % form, tmp_path)
	process("build(); O.saveTmp(); O.loadTmp(); O.run(100, True); O.saveTmp(); O.loadTmp(); O.run(100, True); open('tmp', 'w').write(digest())", tmp_path)
	whole = (tmp_path / 'whole').read_text()
	assert [(tmp_path / f).read_text() == whole for f in ('same', 'other', 'tmp')] == [True] * 3


def test_sameBitsOnTwoThreads(tmp_path):
	for n in 1, 2:
		process("build(); O.run(400, True); open('t%d', 'w').write(digest())" % n, tmp_path, threads=n)
	assert (tmp_path / 't1').read_text() == (tmp_path / 't2').read_text()


def test_theOldNameOfTheLawGoesOn(tmp_path):
	"""McaDensity, as McaLaw was called, in scripts and in files written with that name: the same bits."""
	process("""
build(); O.run(50, True); O.save('new.xml'); O.run(50, True); open('whole', 'w').write(digest())
text = open('new.xml').read()
assert text.count('"yade::McaLaw"') == 1
open('old.xml', 'w').write(text.replace('"yade::McaLaw"', '"yade::McaDensity"'))
""", tmp_path)
	process("""
from yade.wrapper import McaDensity, McaLaw
import yade_mca
scene.density = lambda: next(e for e in O.engines if isinstance(e, McaLaw))
O.load('old.xml'); assert type(scene.density()) is McaDensity
O.save('again.yade'); O.load('again.yade'); O.run(50, True); open('parts', 'w').write(digest())
""", tmp_path)
	process("""
from yade_mca import McaDensity
scene.density = lambda: next(e for e in O.engines if type(e) is McaDensity)
build(); O.engines = [McaDensity() if type(e).__name__ == 'McaLaw' else e for e in O.engines]
O.run(100, True); open('script', 'w').write(digest())
""", tmp_path)
	whole = (tmp_path / 'whole').read_text()
	assert whole == (tmp_path / 'parts').read_text() == (tmp_path / 'script').read_text()
