# SPDX-License-Identifier: GPL-2.0-or-later
"""A plugin that does not fit, or is broken, ends in an ImportError that says what differs and what to do; YADE goes on without it."""
import json
import os
import re
import shutil
from pathlib import Path

import pytest
from abi_support import ATTEMPT, BUILD, LIVING, PYTHON, YADE_PY, refused, runPython

LIB = BUILD / 'yade_mca_lib'
VERSION = json.loads((LIB / 'manifest.json').read_text())['yade']


@pytest.fixture
def copied(tmp_path):
	"""A copy of the built libraries that may be spoiled."""
	folder = tmp_path / 'lib'
	shutil.copytree(LIB, folder)
	return folder


def editManifest(folder, **changes):
	path = folder / 'manifest.json'
	path.write_text(json.dumps(dict(json.loads(path.read_text()), **changes)))


def attempt(folder=LIB, before='', after=LIVING, **more):
	return runPython(before + ATTEMPT + after, env={'YADE_MCA_LIB': str(folder)}, **more)


def test_theUnspoiledCopyLoads(copied):
	done = attempt(copied)
	assert 'LOADED' in done.stdout and 'ALIVE 3' in done.stdout, done.stdout


# ---- version, build, interpreter


def test_wrongVersionOfYade():
	refused(attempt(before="import yade.config; yade.config.version = '2024.01a'\n"), 'YADE 2024.01a', 'for ' + re.escape(VERSION), 'apt-get install yade=.* libyade=')


def test_wrongVersionSeenByTheGuardItself():
	done = runPython(
	        "import yade.wrapper, yade.system, yade.config; yade.config.version = '2024.01a'\n" + """
import importlib.machinery, importlib.util, sys, os
sys.setdlopenflags(os.RTLD_NOW | os.RTLD_LOCAL)
path = %r
try:
	importlib.util.module_from_spec(importlib.machinery.ModuleSpec('_yade_mca', importlib.machinery.ExtensionFileLoader('_yade_mca', path), origin=path))
except ImportError as e: print('REFUSED:', e)
""" % str(LIB / '_yade_mca.so') + LIVING
	)
	refused(done, "version is 2024.01a")


@pytest.mark.parametrize('change,word', [("remove('MPI')", 'without MPI'), ("append('MASK_ARBITRARY')", 'with MASK_ARBITRARY'), ("append('SPH')", 'with SPH')])
def test_otherFeatures(change, word):
	refused(attempt(before='import yade.config; yade.config.features.%s\n' % change), word)


def test_notTheDoubleBuild():
	refused(attempt(before="import yade.config; yade.config.libDir = '/usr/lib/x86_64-linux-gnu/yade-longdouble'\n"), 'not the double precision build')


@pytest.mark.skipif(not os.path.exists('/usr/bin/yade-longdouble'), reason='the package brings no yade-longdouble')
def test_theLongDoubleProgramItself():
	refused(attempt(interpreter=('/usr/bin/yade-longdouble', '-n', '-x'), after='from yade import O; O.run(3, True); print("ALIVE", O.iter)'), 'not the double precision build')


def test_wrongPython(copied):
	editManifest(copied, python='3.9')
	refused(attempt(copied), r'this is Python 3\.', 'for 3.9')


def otherPythons():
	"""Interpreters on the PATH that are not YADE's."""
	found = {os.path.realpath(os.path.join(d, n)) for d in os.environ.get('PATH', '').split(':') for n in ('python3', 'python') if os.access(os.path.join(d, n), os.X_OK)}
	return sorted(found - {os.path.realpath(PYTHON)})


@pytest.mark.skipif(not otherPythons(), reason='no other Python on the PATH')
def test_anotherPythonItself():
	for interpreter in otherPythons():
		done = attempt(after='', interpreter=(interpreter,))
		if 'LOADED' not in done.stdout: refused(done, 'yade_mca', '/usr/bin/python3', alive=False)


def test_otherBuildOfYadesLibrary(copied):
	ids = json.loads((copied / 'manifest.json').read_text())['yadeBuildIds']
	editManifest(copied, yadeBuildIds=dict(ids, **{'libpkg_common.so': '00' * 20}))
	refused(attempt(copied), 'libpkg_common.so is another build', 'YADE_MCA_OTHER_BUILD')
	trusted = runPython(ATTEMPT, env={'YADE_MCA_LIB': str(copied), 'YADE_MCA_OTHER_BUILD': '1'})
	assert 'LOADED' in trusted.stdout, trusted.stdout  # the guard still compares the classes


# ---- YADE missing or damaged


def test_yadeNotInstalled(copied, tmp_path):
	editManifest(copied, yadeLibDir=str(tmp_path / 'nothing'))
	refused(attempt(copied, after='print(2 + 2)'), 'YADE is not installed', 'apt-get install yade', alive=False)


def test_yadesPythonPartMissing(copied):
	before = "import sys; sys.modules['yade'] = None\n"
	refused(attempt(copied, before=before, after='print(2 + 2)'), 'YADE cannot be imported', alive=False)


@pytest.mark.parametrize('keep', [0, 100, 5000, 0.5])
def test_yadesLibraryCutShort(copied, tmp_path, keep):
	folder = tmp_path / 'yade-double'
	folder.mkdir()
	for name in json.loads((copied / 'manifest.json').read_text())['yadeBuildIds']:
		os.symlink(os.path.join(os.path.dirname(YADE_PY), name), folder / name)
	data = (folder / 'libyade.so').read_bytes()
	(folder / 'libyade.so').unlink()
	(folder / 'libyade.so').write_bytes(data[:keep if isinstance(keep, int) else int(keep * len(data))])
	editManifest(copied, yadeLibDir=str(folder))
	refused(attempt(copied, after='print(2 + 2)'), "YADE's own library", 'reinstall', alive=False)


# ---- the plugin's files


@pytest.mark.parametrize('name', ['_yade_mca.so', 'libmcasolver.so'])
@pytest.mark.parametrize('keep', [0, 60, 4096, 0.5, 0.999])
def test_cutShort(copied, name, keep):
	data = (copied / name).read_bytes()
	(copied / name).write_bytes(data[:keep if isinstance(keep, int) else int(keep * len(data))])
	refused(attempt(copied), name, 'cut short')


@pytest.mark.parametrize('place', [0, 0.1, 0.5, 0.9])
def test_damaged(copied, place):
	data = bytearray((copied / '_yade_mca.so').read_bytes())
	at = int(place * len(data))
	for i in range(at, at + 64):
		data[i] ^= 0xFF
	(copied / '_yade_mca.so').write_bytes(data)
	refused(attempt(copied), '_yade_mca.so is damaged')


def test_missingFiles(copied):
	(copied / 'libmcasolver.so').unlink()
	refused(attempt(copied), 'libmcasolver.so cannot be read')
	(copied / 'manifest.json').write_text('{')
	refused(attempt(copied), 'manifest.json')
	(copied / 'manifest.json').unlink()
	refused(attempt(copied), 'not built', 'setup')


def test_aNameThatIsTaken():
	done = runPython("""
import yade_mca
from yade_mca import _loader
try:
	_loader.openExtension('_yade_mca', %r)
	print('LOADED')
except ImportError as e:
	print('REFUSED:', e, 'What to do: -')
""" % str(copyOf(LIB / '_yade_mca.so')) + LIVING)
	refused(done, 'loaded already')


def copyOf(path):
	import tempfile
	folder = tempfile.mkdtemp()
	for f in path.parent.glob('*.so'):
		shutil.copy(f, folder)
	return Path(folder) / path.name
