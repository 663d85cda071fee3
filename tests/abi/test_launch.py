# SPDX-License-Identifier: GPL-2.0-or-later
"""All roads of loading: yade script, plain python, launcher, batch; instruction levels; what loading costs."""
import os
import re
import subprocess

import pytest
from abi_support import BUILD, PYTHON, ROOT, runPython

LAUNCHER = str(ROOT / 'pyscripts' / 'yade-mca')
LIB = BUILD / 'yade_mca_lib'


def launch(arguments, folder, **env):
	environment = {**os.environ, 'YADE_MCA_LIB': str(LIB), **env}
	for name in ('OMP_NUM_THREADS', 'PYTHONPATH'):
		environment.pop(name, None) if name not in env else None
	return subprocess.run(
	        [LAUNCHER] + arguments, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120
	)


@pytest.mark.parametrize('interpreter', [(PYTHON,), ('yade', '-n', '-x'), (LAUNCHER, '-n', '-x')], ids=['python', 'yade', 'launcher'])
def test_importByEachRoad(interpreter):
	done = runPython("import yade_mca\nfrom yade_mca import McaInfo\nprint('CLASSES', yade_mca.classes, yade_mca.guardChecks, McaInfo().isa)\n", interpreter=interpreter)
	assert done.returncode == 0 and "'McaInfo'" in done.stdout, done.stdout


def test_importTwiceIsOnce():
	done = runPython("import yade_mca, importlib\na = yade_mca.classes\nimport yade_mca\nassert yade_mca.classes is a\nprint('ONCE')\n")
	assert 'ONCE' in done.stdout, done.stdout


def test_launcherPassesArgumentsAndStatus(tmp_path):
	script = tmp_path / 'script with space.py'
	script.write_text("import sys\nprint('ARGUMENTS', sys.argv[1:], O.numThreads, McaInfo().isa, __name__)\nsys.exit(int(sys.argv[1]))\n")
	for status in (0, 7):
		done = launch(['-j2', '-n', '-x', str(script), str(status), '-j', '9', '--flag'], tmp_path)
		assert done.returncode == status, done.stdout
		assert "ARGUMENTS ['%d', '-j', '9', '--flag'] 2 " % status in done.stdout and '__main__' in done.stdout, done.stdout
	done = launch(['-n', '-x', str(script), '0'], tmp_path)
	assert re.search(r"\['0'\] 1 ", done.stdout), done.stdout  # yade's own default: one thread


def test_launcherFailsAsYadeDoes(tmp_path):
	script = tmp_path / 'bad.py'
	script.write_text("raise RuntimeError('on purpose')\n")
	done = launch(['-n', '-x', str(script)], tmp_path)
	assert done.returncode == 1 and 'on purpose' in done.stdout
	assert launch(['--version'], tmp_path).returncode == 0
	assert launch(['--no-such-option'], tmp_path).returncode == 2


def test_launcherNamesTheTasksWhenAWordIsNone(tmp_path):
	"""YADE itself would say nothing and open its prompt."""
	done = launch(['benhc', '--quick'], tmp_path)
	assert done.returncode == 2 and done.stdout.startswith("yade-mca: 'benhc' is neither a file nor a task; tasks here are info, check, bench"), done.stdout


def test_launcherSetsTheWaitPolicyUnlessGiven(tmp_path):
	script = tmp_path / 'policy.py'
	script.write_text("import os; print('POLICY', os.environ['OMP_WAIT_POLICY'])\n")
	assert 'POLICY passive' in launch(['-n', '-x', str(script)], tmp_path, OMP_WAIT_POLICY='passive').stdout
	assert 'POLICY active' in launch(['-n', '-x', str(script)], tmp_path, OMP_WAIT_POLICY='active').stdout


def test_launcherWithoutBuiltLibrary(tmp_path):
	done = launch(['-n', '-x', 'nothing.py'], tmp_path, YADE_MCA_LIB=str(tmp_path))
	assert done.returncode == 1 and 'not built' in done.stdout and 'Traceback' not in done.stdout, done.stdout


def test_launcherOpensASavedSimulation(tmp_path):
	saved = tmp_path / 'info.yade'
	done = runPython("import yade_mca\nfrom yade import O\nO.miscParams = [yade_mca.McaInfo()]\nO.step()\nO.save(%r)\nprint('SAVED')\n" % str(saved))
	assert 'SAVED' in done.stdout, done.stdout
	script = tmp_path / 'open.py'
	script.write_text("O.load(%r)\nprint('OPENED', O.miscParams[0].isa, O.iter)\n" % str(saved))
	done = launch(['-n', '-x', str(script)], tmp_path)
	assert re.search(r'OPENED x86-64\S* 1', done.stdout), done.stdout


def test_nothingStaysBehindInTheTemporaryFolder():
	done = runPython("import yade_mca\nfrom yade import O\nimport os\nprint('FOLDER', os.path.dirname(O.tmpFilename()))\n")
	folder = re.search(r'FOLDER (\S+)', done.stdout).group(1)
	assert not os.path.exists(folder), folder


def test_batch(tmp_path):
	(tmp_path / 't.table').write_text('x\n1\n2\n')
	(tmp_path / 'b.py').write_text("readParamsFromTable(x=0)\nfrom yade.params import table\nprint('PARAMETER', table.x, McaInfo().isa)\n")
	done = subprocess.run(
	        [str(ROOT / 'pyscripts' / 'yade-mca-batch'), '-j1', 't.table', 'b.py'], cwd=tmp_path, env={**os.environ, 'YADE_MCA_LIB': str(LIB)}, stdin=subprocess.DEVNULL,
	        capture_output=True, text=True, timeout=120
	)
	logs = ''.join(p.read_text() for p in tmp_path.glob('*.log'))
	assert done.returncode == 0 and re.findall(r'PARAMETER (\d)', logs) in (['1', '2'], ['2', '1']), (done.stdout, logs)


# ---- instruction levels


def searchedLevels():
	"""Levels the dynamic loader of this machine searches, best first."""
	text = subprocess.run(['/lib64/ld-linux-x86-64.so.2', '--help'], capture_output=True, text=True).stdout
	return re.findall(r'^\s+(x86-64-v\d) \(supported, searched\)', text, re.M)


@pytest.mark.parametrize('without,left', [('', ['x86-64-v4', 'x86-64-v3']), ('-AVX512F', ['x86-64-v3']), ('-AVX512F,-AVX2', [])])
def test_theDynamicLoaderTakesTheBestLevel(without, left):
	"""One of three builds is taken by what the processor has; features are masked to see the others."""
	levels = [level for level in searchedLevels() if level in left]
	expected = levels[0] if levels else 'x86-64'
	done = runPython(
	        "import yade_mca\nprint('LEVEL', yade_mca.McaInfo().isa)\nprint('FILE', [l.split()[-1] for l in open('/proc/self/maps') if 'libmcasolver' in l][0])\n",
	        env={'GLIBC_TUNABLES': 'glibc.cpu.hwcaps=' + without} if without else {}
	)
	assert 'LEVEL %s\n' % expected in done.stdout, done.stdout
	folder = 'glibc-hwcaps/%s/' % expected if levels else 'yade_mca_lib/'
	assert folder + 'libmcasolver.so' in done.stdout, done.stdout


def test_adaptersUseBaselineInstructionsOnly():
	"""Wide vectors in code that sees YADE's objects would change their layout; no library may switch the process to flush denormals."""
	for name, wide in (('_yade_mca.so', False), ('libmcasolver.so', False), ('glibc-hwcaps/x86-64-v3/libmcasolver.so', True)):
		if not (LIB / name).exists(): continue
		code = subprocess.run(['objdump', '-d', '--no-show-raw-insn', str(LIB / name)], capture_output=True, text=True).stdout
		assert (re.search(r'%[yz]mm\d', code) is not None) == wide, name
		assert 'set_fast_math' not in subprocess.run(['nm', '-a', str(LIB / name)], capture_output=True, text=True).stdout
	done = runPython("import yade_mca\nx = 5e-324\nassert x * 1.0 == 5e-324 and 1e-310 / 2 != 0\nprint('DENORMALS')\n")
	assert 'DENORMALS' in done.stdout, done.stdout


# ---- cost


def test_costOfAnIdleEngine():
	"""An engine that does nothing is one virtual call per step: less than a tenth of YADE's bare step would be noise, more than it a fault."""
	done = runPython(
	        """
import abi_support; abi_support.loadFixture()
from yade import O
from yade.wrapper import SdkIdle
def perStep(n, steps=200000):
	O.reset(); O.engines = [SdkIdle() for _ in range(n)]; O.timingEnabled = False
	import time
	best = 1e9
	for _ in range(5):
		O.stopAtIter = O.iter + steps
		t = time.perf_counter(); O.run(steps, True); best = min(best, time.perf_counter() - t)
	return best / steps * 1e9
one, many = perStep(1), perStep(101)
print('IDLE %.1f ns per step' % ((many - one) / 100), 'bare step %.0f ns' % one)
assert (many - one) / 100 < one
"""
	)
	assert done.returncode == 0 and 'IDLE' in done.stdout, done.stdout
	print(done.stdout)


def test_costOfImport():
	"""The plugin, its checksums and its guard take a small part of what YADE itself takes to start."""
	done = runPython(
	        """
import time
t0 = time.process_time()
import yade, yade.system, yade.utils, yade.wrapper
t1 = time.process_time()
import yade_mca
t2 = time.process_time()
print('IMPORT processor time: yade %.0f ms, yade_mca %.1f ms more, %d guard checks' % (1e3 * (t1 - t0), 1e3 * (t2 - t1), yade_mca.guardChecks))
assert t2 - t1 < t1 - t0
"""
	)
	assert done.returncode == 0 and 'IMPORT' in done.stdout, done.stdout
	print(done.stdout)
