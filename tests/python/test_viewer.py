# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE's graphical interface on a virtual screen: a picture of automata and grid by the viewer, and the inspector's editors."""
import os
import subprocess
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PICTURE = """
import os, time, traceback
from yade import O, qt
from yade_mca import scenes, viewer
from PyQt5.QtWidgets import QApplication
def wait(until, seconds=60):
	end = time.time() + seconds
	while time.time() < end and not until():
		QApplication.processEvents()
		time.sleep(0.02)
try:
	s = scenes.penetration(thickness=10e-3, spacing=2e-3, rodLength=20e-3, rodDiameter=8e-3, automataWidth=30e-3, plateWidth=50e-3)
	O.run(66, True)
	picture = viewer.Picture(s.automata, 'pressure', s.grid)
	v = qt.View()
	v.screenSize = (600, 450)
	v.viewDir, v.upVector = (0, 0, -1), (0, 1, 0)
	v.center(True)
	O.engines = O.engines + [qt.SnapshotEngine(fileBase='shot-', iterPeriod=1, format='PNG')]
	O.run(2, False)
	wait(lambda: os.path.exists('shot-00001.png'))
	wait(lambda: False, 0.3)
	print('DONE')
except BaseException:
	traceback.print_exc()
import sys
sys.stdout.flush()
os._exit(0)
"""
EDITORS = """
import importlib, os, traceback, sys
try:
	import yade_mca
	from yade import qt
	editors = importlib.import_module('yade.qt.SerializableEditor')
	SerializableEditor = editors.SerializableEditor
	# since 2025 a number has an editor of its own
	numbers = tuple(getattr(editors, n) for n in ('AttrEditor_Float', 'AttrEditor_Mpmath') if hasattr(editors, n))
	for name in yade_mca.classes:
		thing = getattr(yade_mca, name)()
		editor = SerializableEditor(thing)
		shown = {e.name: e for e in editor.entries}
		own = [k for k, p in type(thing).__dict__.items() if isinstance(p, property) and ':yattrtype:' in (p.__doc__ or '') and k in thing.dict()]
		without = [k for k in own if k not in shown or shown[k].widget is None]
		print('CLASS', name, len(own), without)
		for entry in editor.entries:
			# typing a number and leaving the field sets the attribute
			w = entry.widget
			if isinstance(w, numbers) and not entry.flags & 2 and entry.name not in ('young', 'poisson'):  # these follow from the others
				old = getattr(thing, entry.name)
				w.setText('0.75'); w.isHot(); w.update()
				assert getattr(thing, entry.name) == 0.75, entry.name
				print('SET', name, entry.name)
	print('DONE')
except BaseException:
	traceback.print_exc()
sys.stdout.flush()
os._exit(0)
"""


def onAScreen(text, folder):
	"""Runs a script in YADE with its graphical interface on a virtual screen."""
	(folder / 'script.py').write_text(text)
	environment = dict(os.environ, LIBGL_ALWAYS_SOFTWARE='1', XDG_RUNTIME_DIR=str(folder))
	environment.pop('YADE_BATCH', None)
	command = ['xvfb-run', '-a', '-s', '-screen 0 1280x1024x24', str(ROOT / 'pyscripts' / 'yade-mca'), 'script.py']
	return subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=240).stdout


def test_viewerDrawsAutomataAndGrid(plugin, tmp_path):
	from matplotlib.image import imread
	out = onAScreen(PICTURE, tmp_path)
	assert 'DONE' in out and 'Traceback' not in out, out
	pixels = imread(tmp_path / 'shot-00001.png')[..., :3]
	assert pixels.shape[0] > 100
	red = (pixels[..., 0] > 0.5) & (pixels[..., 0] > 1.6 * pixels[..., 2])
	blue = (pixels[..., 2] > 0.3) & (pixels[..., 2] > 1.3 * pixels[..., 0])
	assert red.sum() > 50 and blue.sum() > 1000, (red.sum(), blue.sum())
	# the cells at the ends of the plate are flat areas of one colour, which spheres are not
	flat = sum((abs(np.diff(pixels[row], axis=0)).sum(axis=1) == 0)[blue[row, 1:]].sum() for row in range(pixels.shape[0]))
	assert flat > 500, flat


def test_inspectorHasAnEditorForEachAttribute(plugin, tmp_path):
	out = onAScreen(EDITORS, tmp_path)
	assert 'DONE' in out, out
	lines = [line.split(' ', 3) for line in out.splitlines() if line.startswith('CLASS')]
	assert {line[1] for line in lines} == set(plugin.classes)
	lacking = {line[1]: line[3] for line in lines if line[3] != '[]'}
	# a reference to another engine is shown by its name; there is nothing to type
	assert not {k: v for k, v in lacking.items() if k != 'McaGridCoupler'}, lacking
	assert out.count('SET') > 30


def test_colours():
	from yade_mca.viewer import colours
	c = colours([0., 1., 2., np.nan][:3])
	assert c[0, 2] > c[0, 0] and c[2, 0] > c[2, 2] and (c[1] > 0.9).all()
	assert (colours([1., 1.]) >= 0).all()
