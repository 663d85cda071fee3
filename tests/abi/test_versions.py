# SPDX-License-Identifier: GPL-2.0-or-later
"""The build takes version, Python and Boost from the installed YADE and refuses one it does not know; `abi` sees what a YADE has other than declared."""
import json
import os
import re
import subprocess
import sys

import pytest
from abi_support import BUILD, ROOT, YADE_PY

sys.path.insert(0, str(ROOT / 'plugin' / 'sdk'))
import abi
import facts

LIBRARIES = os.path.dirname(YADE_PY)


def test_numbersOfVersionsAreInOrder():
	versions = ['2022.01a', '2023.02a', '2023.02b', '2025.2.0', '2025.2.1', '2025.12.0', '2026.1.0']
	numbers = [facts.number(v) for v in versions]
	assert numbers == sorted(set(numbers)) and numbers[1] == 20230200 and numbers[3] == 20250200
	for bad in ('', 'git-abc', '2023', '1.20.0'):
		with pytest.raises(ValueError, match='version of YADE'):
			facts.number(bad)


def test_factsAreThoseOfTheInstalledYade():
	found = facts.read(LIBRARIES)
	manifest = json.loads((BUILD / 'yade_mca_lib' / 'manifest.json').read_text())
	assert manifest['yade'] == found['VERSION'] and manifest['python'] == found['PYTHON'] == '%d.%d' % sys.version_info[:2]
	assert found['STANDING'] in ('supported', 'tried')
	assert os.path.exists('/usr/lib/x86_64-linux-gnu/libboost_python%s.so.%s' % (found['PYTHON'].replace('.', ''), found['BOOST']))


def test_neededLibraries():
	for name in facts.LIBRARIES:
		path = os.path.join(LIBRARIES, name)
		assert facts.elfModule().needed(path) == re.findall(r'NEEDED.*\[(.*?)\]', subprocess.run(['readelf', '-dW', path], capture_output=True, text=True).stdout)


@pytest.fixture
def otherYade(tmp_path):
	"""The installed YADE under another version."""
	folder = tmp_path / 'yade-double'
	(folder / 'py' / 'yade').mkdir(parents=True)
	for name in facts.LIBRARIES:
		os.symlink(os.path.join(LIBRARIES, name), folder / name)
	(folder / 'py' / 'yade' / 'config.py').write_text("features=' OPENMP MPI QT5 SPH'.split(' ')\nversion='2031.3.0'\n")
	return folder


def configure(folder, *options):
	command = ['cmake', '-S', ROOT, '-B', folder, '-G', 'Ninja', '-DMCA_TESTS=OFF', *options]
	return subprocess.run([str(c) for c in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)


def test_anUnknownVersionIsRefusedAtBuild(otherYade, tmp_path):
	done = configure(tmp_path / 'build', '-DMCA_YADE_LIBDIR=%s' % otherYade)
	assert done.returncode and 'do not know YADE 2031.3.0' in done.stdout and 'pyscripts/run abi' in done.stdout, done.stdout
	# built all the same when told so; without optimisation the extension could not be linked
	done = configure(tmp_path / 'build', '-DMCA_YADE_UNKNOWN=ON', '-DCMAKE_BUILD_TYPE=Debug')
	assert done.returncode == 0, done.stdout
	commands = [c['command'] for c in json.loads((tmp_path / 'build' / 'compile_commands.json').read_text())]
	assert any('MCA_YADE_NUMBER=20310300' in c for c in commands) and all('-O1' in c and '-O0' not in c for c in commands)


def test_noYadeIsRefusedAtBuild(tmp_path):
	(tmp_path / 'libyade.so').write_text('')
	done = configure(tmp_path / 'build', '-DMCA_YADE_LIBDIR=%s' % tmp_path)
	assert done.returncode and 'config.py' in done.stdout and 'Traceback' not in done.stdout, done.stdout


def test_abiSeesWhatDiffers(monkeypatch, otherYade):
	sizes, tables = abi.declared(facts.number(facts.read(LIBRARIES)['VERSION']))
	assert len(sizes) > 40 and len(tables) > 35
	some = ('Sphere', 'FrictPhys', 'Scene')  # these are enough to see it work
	monkeypatch.setattr(abi, 'declared', lambda number: ({c: sizes[c] for c in some}, {c: tables[c] for c in some}))
	same = abi.compare(LIBRARIES)
	assert not same['differences'] and set(same['sizes']) == set(some) and same['tables'] == 3 and same['symbols'] > 300
	shorter = dict(sizes, FrictPhys=sizes['FrictPhys'] - 8)
	inserted = dict(tables, Sphere=tables['Sphere'][:12] + ['Sphere::getSurface'] + tables['Sphere'][12:], Scene=tables['Scene'][:-1])
	monkeypatch.setattr(abi, 'declared', lambda number: ({c: shorter[c] for c in some}, {c: inserted[c] for c in some}))
	found = abi.compare(str(otherYade))
	text = '\n'.join(found['differences'])
	assert 'size of FrictPhys: %d bytes in the library, %d declared' % (sizes['FrictPhys'], shorter['FrictPhys']) in text, text
	assert 'virtual table of Sphere: slot 12 holds' in text and 'declared is Sphere::getSurface' in text
	assert 'virtual table of Scene: %d slots in the library' % len(tables['Scene']) in text
	assert 'built without FEMLIKE' in text and 'built with SPH' in text and found['facts']['STANDING'] == 'unknown'


def test_abiOfNothing(tmp_path):
	done = subprocess.run([str(ROOT / 'pyscripts' / 'run'), 'abi', '--yade', str(tmp_path)], capture_output=True, text=True)
	assert done.returncode == 2 and done.stderr.startswith('abi: ') and done.stderr.count('\n') == 1
