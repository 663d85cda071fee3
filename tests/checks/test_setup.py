# SPDX-License-Identifier: GPL-2.0-or-later
"""Setting up and starting where something is missing or taken: packages, another user's build, a build under way, no HOME, nobody who reads."""
import ast
import fcntl
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get('YADE_MCA_BUILD', ROOT / 'build'))
DONE = 'build plugin/all: phony\nbuild all: phony\n'
TO_DO = 'rule r\n  command = true\nbuild plugin/all: r\nbuild all: r\n'
OTHER = ('setpriv', '--reuid=65534', '--regid=65534', '--clear-groups') if os.getuid() == 0 else ()  # root may write everywhere


@pytest.fixture
def tree():
	"""A tree with nothing but `pyscripts/setup` and a build that says of itself whether it is done; the other user may read it."""
	folder = Path(tempfile.mkdtemp())
	folder.chmod(0o755)
	(folder / 'pyscripts').mkdir()
	shutil.copy(ROOT / 'pyscripts' / 'setup', folder / 'pyscripts')
	build = folder / 'build'
	build.mkdir()
	(build / 'build.ninja').write_text(DONE)
	(build / 'CMakeCache.txt').write_text('MCA_TESTS:BOOL=%s\n' % ('ON' if os.path.exists('/usr/include/gtest/gtest.h') else 'OFF'))
	yield folder
	build.chmod(0o755)
	shutil.rmtree(folder)


def callSetup(tree, *before):
	environment = {k: v for k, v in os.environ.items() if k != 'YADE_MCA_BUILD'}
	return subprocess.Popen([*before, str(tree / 'pyscripts' / 'setup')], env=environment, cwd='/', stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def ended(process):
	output = process.communicate(timeout=600)[0]
	return process.returncode, output


def makeForeign(tree, ninja):
	(tree / 'build' / 'build.ninja').write_text(ninja)
	(tree / 'build' / '.lock').write_text('')
	(tree / 'build' / '.lock').chmod(0o644 if OTHER else 0o444)
	if not OTHER: (tree / 'build').chmod(0o555)


def test_aBuildOfMyOwn(tree):
	assert ended(callSetup(tree)) == (0, '')
	assert (tree / 'build' / '.lock').read_text().startswith('process ')


def test_anotherUsersBuildIsUsedWhenItIsUpToDate(tree):
	makeForeign(tree, DONE)
	assert ended(callSetup(tree, *OTHER)) == (0, '')


@pytest.mark.parametrize('built', [True, False])
def test_anotherUsersBuildThatIsNotUpToDate(tree, built):
	if built: makeForeign(tree, TO_DO)
	else:
		shutil.rmtree(tree / 'build')
		if not OTHER: tree.chmod(0o555)
	status, output = ended(callSetup(tree, *OTHER))
	tree.chmod(0o755)
	(tree / 'build').mkdir(exist_ok=True)
	assert status == 2 and output.count('\n') == 1 and output.startswith('setup: ') and 'set YADE_MCA_BUILD to a folder of your own' in output, output


def test_aWaitingCallSaysForWhom(tree):
	lock = tree / 'build' / '.lock'
	lock.write_text('process 4711 of anna\n')
	with open(lock) as file:
		fcntl.flock(file, fcntl.LOCK_EX)
		process = callSetup(tree)
		line = process.stdout.readline()
		assert line == 'setup: waiting for another build in %s (process 4711 of anna)\n' % (tree / 'build')
		assert process.poll() is None
		fcntl.flock(file, fcntl.LOCK_UN)
		assert ended(process) == (0, '')


def test_unknownPurpose(tree):
	process = subprocess.run([str(tree / 'pyscripts' / 'setup'), 'tset'], capture_output=True, text=True)
	assert process.returncode == 2 and process.stderr == "setup: 'tset' is none of run, tests, docs\n"


def imported():
	"""{module: a file that imports it} of all that is neither Python's own nor the project's."""
	found = {}
	for path in [*(ROOT / 'pyscripts').rglob('*.py'), *(ROOT / 'plugin').rglob('*.py')]:
		for node in ast.walk(ast.parse(path.read_text())):
			names = [a.name for a in node.names] if isinstance(node, ast.Import) else [node.module] if isinstance(node, ast.ImportFrom) and not node.level else []
			found.update({name.split('.')[0]: path for name in names})
	own = {p.stem for p in (ROOT / 'plugin').rglob('*.py')} | {'yade_mca', 'yade', '__main__'}
	return {name: path for name, path in found.items() if name not in own and name not in sys.stdlib_module_names}


def test_eachImportedPackageIsInstalledForUsers():
	"""Each module lies in a package that `pyscripts/setup run` names, or that YADE itself needs; here all packages of the tests are installed, too, which hides what is missing."""
	named = re.search(r'^packages=\((.*?)\)', (ROOT / 'pyscripts/setup').read_text(), re.S | re.M)[1].split()
	dpkg = lambda *a: subprocess.run(['dpkg-query', *a], capture_output=True, text=True).stdout
	needs = set(re.findall(r'[\w.+-]+', re.sub(r'\(.*?\)', '', dpkg('-W', '-f', '${Depends}, ', 'yade', 'python3-yade'))))
	modules = imported()
	assert {'numpy', 'vtkmodules', 'PIL'} <= set(modules)
	for module, path in modules.items():
		owner = dpkg('-S', importlib.util.find_spec(module).origin).split(':')[0]
		assert owner in named or (owner in needs and module == 'PyQt5'), '%s imports %s of %s, which pyscripts/setup does not install' % (path, module, owner or 'no package')


# ---- starting

TASK = (sys.executable, '-m', 'yade_mca.tasks')
SCRIPT = "from yade_mca import McaInfo\nimport os\nprint('STARTED', McaInfo().isa, os.environ['HOME'])\n"


def environment(**changes):
	env = dict(os.environ, PYTHONPATH=str(ROOT / 'pyscripts'), YADE_MCA_LIB=os.environ.get('YADE_MCA_LIB', str(BUILD / 'yade_mca_lib')))
	return {k: v for k, v in {**env, **changes}.items() if v is not None}


@pytest.mark.parametrize('home', [None, ''])
@pytest.mark.parametrize('command', [(str(ROOT / 'pyscripts/yade-mca'), '-n', '-x'), ('/usr/bin/python3', )], ids=['yade-mca', 'python'])
def test_startsWithoutHome(command, home, tmp_path):
	(tmp_path / 's.py').write_text(SCRIPT)
	done = subprocess.run([*command, 's.py'], cwd=tmp_path, env=environment(HOME=home), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600)
	assert done.returncode == 0 and 'STARTED x86-64' in done.stdout and '/' in done.stdout.split()[-1], done.stdout
	assert os.listdir(tmp_path) == ['s.py']


def test_batchStartsWithoutHome(tmp_path):
	(tmp_path / 's.py').write_text(SCRIPT)
	(tmp_path / 't.table').write_text('x\n1\n')
	done = subprocess.run([str(ROOT / 'pyscripts/yade-mca-batch'), '-j1', 't.table', 's.py'], cwd=tmp_path, env=environment(HOME=None), stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600)
	assert done.returncode == 0 and 'STARTED x86-64' in ''.join(p.read_text() for p in tmp_path.glob('*.log')), done.stderr


def test_taskWithoutHome():
	done = subprocess.run([*TASK, 'info'], env=environment(HOME=None), stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600)
	assert done.returncode == 0 and 'guardChecks' in done.stdout, done.stderr


def test_nobodyReads():
	"""`pyscripts/run info | head -1` ends as usual, without a traceback."""
	process = subprocess.Popen([*TASK, 'info'], env=environment(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
	process.stdout.close()
	error = process.stderr.read()
	assert process.wait(timeout=600) == 0 and not error, error


def test_aBrokenPipeOfSomethingElseIsAnError():
	"""Only the reader of standard output may end a task silently."""
	code = "import sys, yade_mca.tasks.info as t\ndef run(*a): raise BrokenPipeError('a child')\nt.run = run\nfrom yade_mca.tasks.cli import main\nsys.exit(main(['info']))\n"
	done = subprocess.run([sys.executable, '-c', code], env=environment(), stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600)
	assert done.returncode == 1 and 'a child' in done.stderr, done.stderr
