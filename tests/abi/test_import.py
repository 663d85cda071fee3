# SPDX-License-Identifier: GPL-2.0-or-later
"""When the package loads YADE and the plugin: at once by `import yade_mca`, on first use by an import of its modules, never by what only computes."""
import os
import re
import subprocess

import pytest
from abi_support import BUILD, PYTHON, ROOT

LAUNCHER = str(ROOT / 'pyscripts' / 'yade-mca')
HEAD = 'import sys\n'
FORBID = """
class Forbid:
	def find_spec(self, name, path=None, target=None):
		if name.split('.')[0] in ('yade', '_yade_mca'): raise AssertionError('import of ' + name)
sys.meta_path.insert(0, Forbid())
"""
COMPUTING = """
import yade_mca.measure
assert yade_mca.measure.rodMeasure([1., 1.], [[0., -900.], [0., -700.]], [0., 2.], 1000.).lengthLoss == 0.5
from yade_mca import materials, exact
assert materials.get('4340').density == 7830 and 'WHA_JC' in materials.names()
assert 0.9 < exact.rayleighSpeed(5900., 3200.) / 3200. < 1
from yade_mca.outlines import Rectangle, disc
assert abs(disc((0, 0), 1.).area - 3.14159) < 0.01
import importlib
packings = importlib.import_module('yade_mca.packings')
assert len(packings.hexagonal(1e-3, Rectangle((0, 0), (1e-2, 1e-2)))) > 100
from yade_mca import plots
assert plots.paretoFront([1., 2., 3.], [3., 1., 2.]).tolist() == [0, 1]
print('COMPUTED')
"""
EVERYWHERE = """
import builtins, yade, yade.utils, yade.wrapper, yade_mca
for name in yade_mca.classes:
	found = {id(getattr(m, name)) for m in (yade_mca, yade, yade.utils, yade.wrapper, builtins)}
	assert len(found) == 1, name
assert yade_mca.version and yade.__spec__.origin and yade.__spec__.submodule_search_locations
print('EVERYWHERE', len(yade_mca.classes), yade_mca.guardChecks)
"""


def run(text, tmp_path, interpreter=(PYTHON, ), lib=None):
	"""Text of a process that runs `text` as a script, with nothing of YADE on the path but what the interpreter puts there."""
	script = tmp_path / 'script.py'
	script.write_text(text)
	environment = {**os.environ, 'OMP_NUM_THREADS': '1', 'YADE_MCA_LIB': str(lib or BUILD / 'yade_mca_lib'), 'PYTHONPATH': str(ROOT / 'pyscripts')}
	files = dict(stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
	return subprocess.run([*interpreter, str(script)], env=environment, cwd=tmp_path, text=True, timeout=120, **files).stdout


def test_whatComputesNeedsNoYade(tmp_path):
	"""Neither YADE nor the compiled part is there."""
	assert 'COMPUTED' in run(HEAD + FORBID + COMPUTING, tmp_path, lib=tmp_path)


def test_noModuleLoadsYadeWhenImported(tmp_path):
	done = run(HEAD + FORBID + """
import pkgutil, importlib, yade_mca.measure
names = [m.name for m in pkgutil.walk_packages(yade_mca.__path__, 'yade_mca.') if not m.name.endswith('__main__')]
for name in names: importlib.import_module(name)
print('IMPORTED', len(names))
""", tmp_path)
	assert int(re.search(r'IMPORTED (\d+)', done)[1]) > 40, done


@pytest.mark.parametrize('statement', [
        'import os, yade_mca as y', 'from yade_mca import *', "import importlib; importlib.import_module('yade_mca')", 'def f():\n\timport yade_mca\nf()'
])
def test_thePackageLoadsAtOnce(statement, tmp_path):
	done = run(HEAD + statement + "\nassert 'yade' in sys.modules\nprint(McaMat, O)\n" + EVERYWHERE, tmp_path)
	assert 'EVERYWHERE' in done, done


@pytest.mark.parametrize('statement,use', [
        ('import yade_mca.measure', 'from yade import O'), ('from yade_mca import measure, packings', 'from yade.wrapper import McaEngine'),
        ('from yade_mca.exact import Hugoniot', 'import yade.utils'), ('from yade_mca import scenes', 'from yade_mca import McaEngine'),
        ("import importlib; importlib.import_module('yade_mca.outlines')", 'import yade_mca; yade_mca.McaMat'),
        ("__import__('yade_mca.materials')", "from yade_mca import materials; materials.mcaMat('4340')"),
        ('import yade_mca.exact.shock as s', 'import yade_mca; yade_mca.version')
])
def test_aModuleLoadsOnFirstUse(statement, use, tmp_path):
	notYet = "\nassert 'yade' not in sys.modules and '_yade_mca' not in sys.modules\n"
	done = run(HEAD + statement + notYet + use + '\nO.reset(); McaMat()\n' + EVERYWHERE, tmp_path)
	assert 'EVERYWHERE' in done, done


@pytest.mark.parametrize('interpreter', [('yade', '-n', '-x'), (LAUNCHER, '-n', '-x')], ids=['yade', 'launcher'])
@pytest.mark.parametrize('statement', ['import yade_mca', 'from yade_mca import measure'])
def test_insideYadeEveryImportLoads(interpreter, statement, tmp_path):
	done = run(statement + '\nprint(McaMat())\n' + EVERYWHERE, tmp_path, interpreter)
	assert 'EVERYWHERE' in done, done


@pytest.mark.parametrize('statements', [
        ('import yade_mca', ), ('from yade_mca import *', ), ('from yade_mca import McaMat', ), ('from yade_mca import measure', 'from yade import O'),
        ('from yade_mca import materials', "materials.mcaMat('4340')"), ('import yade_mca.measure', 'yade_mca.guardChecks')
])
def test_allRoadsEndInTheSameError(statements, tmp_path):
	script = ["try: exec(%r)\nexcept ImportError as e: print('REFUSED %d:', e)" % (s, k) for k, s in enumerate(statements)]
	done = run('\n'.join(script), tmp_path, lib=tmp_path)
	assert re.findall(r'REFUSED (\d): yade_mca: the compiled part is not built .* What to do: run pyscripts/setup', done) == [str(len(statements) - 1)], done


def test_wrongNames(tmp_path):
	script = "import yade_mca.measure\nfor s in ('yade_mca.measures', 'yade_mca.McaMatt'):\n\ttry: eval(s)\n\texcept AttributeError as e: print(e)\n"
	done = run(script, tmp_path)
	assert done.splitlines() == ["module 'yade_mca' has no attribute 'measures'", "module 'yade_mca' has no attribute 'McaMatt'"], done


@pytest.mark.parametrize('interpreter', [(PYTHON, ), ('yade', '-n', '-x'), (LAUNCHER, '-n', '-x')], ids=['python', 'yade', 'launcher'])
def test_theScriptOfTheReadme(interpreter, tmp_path):
	script = re.search(r'```python\n(.*?)```', (ROOT / 'README.md').read_text(), re.S)[1]
	done = run(script.replace('O.run(2000', 'O.run(200'), tmp_path, interpreter)
	assert 'mean velocity of the ball: -' in done, done
