# SPDX-License-Identifier: GPL-2.0-or-later
"""Loads the fixture classes (tests/abi/fixture) and runs scripts in processes of their own."""
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get('YADE_MCA_BUILD', ROOT / 'build'))
PYTHON = '/usr/bin/python3'
YADE_PY = '/usr/lib/x86_64-linux-gnu/yade-double/py'

HEAD = """
import sys
sys.path[:0] = [%r, %r]
sys.path.append(%r)
""" % (str(ROOT / 'pyscripts'), str(Path(__file__).resolve().parent), YADE_PY)


def loadFixture():
	"""The plugin and, beside it, the classes Sdk* of the fixture."""
	sys.path.insert(0, str(ROOT / 'pyscripts'))
	import yade_mca
	from yade_mca import _loader
	if '_yade_sdk_fixture' not in sys.modules:
		module = _loader.openExtension('_yade_sdk_fixture', BUILD / 'tests' / 'fixture' / '_yade_sdk_fixture.so')
		_loader.publish(list(module.classes), {})
	return yade_mca


def runPython(text, *, env=None, timeout=120, interpreter=(PYTHON,)):
	"""Run a text in a new process of YADE's interpreter (or `yade -n -x`), on one thread: sums of forces in YADE depend on the number of threads in the
	last digit. Returns the finished process; its text is in stdout."""
	import tempfile
	with tempfile.TemporaryDirectory() as folder:
		script = Path(folder) / 'script.py'
		script.write_text(HEAD + text)
		environment = {**os.environ, 'OMP_NUM_THREADS': '1', 'YADE_MCA_LIB': str(BUILD / 'yade_mca_lib'), **(env or {})}
		return subprocess.run(
		        list(interpreter) + [str(script)], env=environment, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
		        timeout=timeout
		)


ATTEMPT = """
try:
	import yade_mca
	print('LOADED')
except ImportError as e:
	print('REFUSED:', e)
"""
LIVING = """
import yade
from yade import O
import yade.utils
O.bodies.append(yade.utils.sphere((0, 0, 0), 1))
O.engines = [yade.wrapper.ForceResetter(), yade.wrapper.NewtonIntegrator()]
O.run(3, True)
print('ALIVE', O.iter)
"""


def refused(done, *words, alive=True):
	"""The process refused the plugin with all these words and a remedy, and lived on."""
	assert done.returncode == 0, (done.returncode, done.stdout)
	text = done.stdout
	assert 'REFUSED:' in text and 'LOADED' not in text, text
	for word in words + ('What to do:',):
		assert re.search(word, text), (word, text)
	if alive: assert 'ALIVE 3' in text, text
