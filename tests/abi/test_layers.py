# SPDX-License-Identifier: GPL-2.0-or-later
"""Dependencies point down: pyscripts -> plugin/yade -> {automata, grid, interface} -> kernels; plugin/yade -> sdk; only sdk knows the binary interface."""
import re
from pathlib import Path

import pytest

PLUGIN = Path(__file__).resolve().parents[2] / 'plugin'
FOREIGN = r'^(boost|Eigen|core|lib|pkg|sdk|py|Python\.h|numpy|vtk|CGAL)\b'

#: folder -> folders whose headers it may include besides its own
ALLOWED = {
        'kernels': set(),
        'automata': {'kernels'},
        'grid': {'kernels'},
        'interface': {'kernels', 'automata', 'grid'},
        'yade': {'kernels', 'automata', 'grid', 'interface', 'sdk', 'stock'},
        'sdk': {'sdk', 'stock'}
}
FOLDERS = sorted(f for f in ALLOWED if (PLUGIN / f).is_dir())


def sources(folder):
	return sorted(p for p in (PLUGIN / folder).rglob('*') if p.suffix in ('.hpp', '.cpp', '.h', '.ipp'))


def includes(path):
	"""(text of the include, whether in quotes)"""
	return [(m[2], m[1] == '"') for m in re.finditer(r'^\s*#\s*include\s*(["<])([^">]+)[">]', path.read_text(), re.M)]


def layerOf(path, text, quoted):
	"""Folder an include leads to; 'stock' for YADE's, Boost's and Python's headers, None for the standard library."""
	if quoted:
		for base in (path.parent, PLUGIN):
			target = (base / text).resolve()
			if target.exists() and PLUGIN in target.parents:
				top = target.relative_to(PLUGIN).parts[0]
				return top if (PLUGIN / top).is_dir() else 'plugin'
	first = text.split('/')[0]
	if first in ALLOWED and (PLUGIN / text).exists(): return first
	if (PLUGIN / text).exists(): return 'plugin'
	if first == 'sdk': return 'sdk'
	if re.match(FOREIGN, text): return 'stock'
	return None


@pytest.mark.parametrize('folder', FOLDERS)
def test_includesPointDown(folder):
	wrong = []
	for path in sources(folder):
		for text, quoted in includes(path):
			layer = layerOf(path, text, quoted)
			if layer in (None, folder): continue
			if layer == 'plugin' and folder in ('automata', 'grid', 'interface', 'yade'): continue  # isa.hpp
			if layer not in ALLOWED[folder]: wrong.append('%s includes %s (%s)' % (path.relative_to(PLUGIN), text, layer))
	assert not wrong, '\n'.join(wrong)


def test_noCircleAmongTheClasses():
	"""plugin/yade: a class (X.hpp and its X*.cpp) knows only classes below it; what they are to each other stands in McaRoles."""
	names = sorted((p.stem for p in (PLUGIN / 'yade').glob('*.hpp')), key=len, reverse=True)
	room = lambda stem: next(n for n in [*names, stem] if stem.startswith(n))
	knows = {}
	for p in sources('yade'):
		mine = knows.setdefault(room(p.stem), set())
		mine |= {room(Path(text).stem) for text, quoted in includes(p) if quoted and (p.parent / text).exists()} - {room(p.stem)}
	knows.setdefault('McaLaw', set()).update(knows.pop('McaForces', set()) - {'McaLaw'})  # the second half of its step
	floors = []
	while knows:
		ground = {n for n, below in knows.items() if not below & set(knows)}
		assert ground, 'a circle among ' + ', '.join(sorted(knows))
		floors.append(ground)
		for n in ground:
			del knows[n]
	assert len(floors) > 3


def test_theTestSeesWrongIncludes():
	here = PLUGIN / 'kernels' / 'eos.hpp'
	assert layerOf(here, 'boost/python.hpp', False) == layerOf(here, 'core/Scene.hpp', False) == layerOf(here, 'Eigen/Core', False) == 'stock'
	assert layerOf(here, 'Python.h', False) == 'stock' and layerOf(here, 'cmath', False) is None and layerOf(here, 'omp.h', False) is None
	assert layerOf(here, '../yade/McaInfo.hpp', True) == 'yade' and layerOf(here, 'sdk/Blob.hpp', False) == 'sdk'


@pytest.mark.parametrize('folder', [f for f in FOLDERS if f != 'sdk'])
def test_onlySdkKnowsTheBinaryInterface(folder):
	"""No offsets, mangled names, symbol look-ups or casts through raw memory of YADE's classes outside sdk."""
	pattern = r'_Z[NTKV][A-Z0-9]|\boffsetof\s*\(|\bdlsym\b|\bdlopen\b|CreatePureCustom|extern\s+template'
	wrong = ['%s:%d' % (p.relative_to(PLUGIN), p.read_text()[:m.start()].count('\n') + 1) for p in sources(folder) for m in re.finditer(pattern, p.read_text())]
	assert not wrong, wrong


@pytest.mark.parametrize('folder', [f for f in FOLDERS if f == 'kernels'])
def test_kernelsHaveValuesInValuesOut(folder):
	"""No printing, no allocation, no threads in the pointwise physics."""
	pattern = r'\bstd::(cout|cerr|vector|map|list|thread|mutex|shared_ptr|unique_ptr|function)\b|\bprintf\s*\(|#\s*pragma\s+omp\s+parallel|\bnew\s+[A-Z]|\bmalloc\s*\('
	wrong = ['%s: %s' % (p.name, m[0]) for p in sources(folder) for m in re.finditer(pattern, re.sub(r'//.*', '', p.read_text()))]
	assert not wrong, wrong


#: functions that a formula of the law would need -> where else they may stand, with the reason
ELSEWHERE = {
        'yade/McaBodies.cpp': 'scattered strengths',
        'yade/McaLawLoop.cpp': 'distances in messages and checks',
        'yade/McaLawFracture.cpp': 'a distance',
        'yade/McaLawRows.hpp': 'a distance',
        'yade/McaPhysPairs.cpp': 'unit normal for YADE',
        'automata/build.cpp': 'distances of the packing',
        'automata/fracture.cpp': 'a distance',
        'automata/step.cpp': 'distances in messages and checks',
        'automata/integrate.cpp': 'leapfrog', 'automata/force_pass.cpp': 'sums over links',
}


@pytest.mark.parametrize('folder', ['yade', 'automata'])
def test_theLawStandsInKernels(folder):
	"""No roots, powers, fused products of material constants, and none of the law's own numbers, outside kernels: loops load, call and store."""
	wrong = []
	for p in sources(folder):
		text = re.sub(r'//.*', '', re.sub(r'"(\\.|[^"])*"', '""', p.read_text()))
		name = '%s/%s' % (folder, p.name)
		pattern = r'\bstoredEnergy\s*\(|\bviscosity\.(linear|quadratic)\s*\*|1\. / 6\.|\b1\.5 \* (?!s\.dt)|0\.866|0\.577|% 6\b|\(k \+ 3\)'
		if name not in ELSEWHERE: pattern += r'|\b(std::)?(sqrt|pow|exp|log|fma)\s*\('
		wrong += ['%s: %s' % (name, m[0]) for m in re.finditer(pattern, text)]
	assert not wrong, wrong


def test_eachSourceNamesItsLicence():
	root = PLUGIN.parent
	files = [p for d in ('plugin', 'pyscripts', 'tests') for p in (root / d).rglob('*') if p.suffix in ('.hpp', '.cpp', '.py', '.cmake') or p.name == 'CMakeLists.txt']
	wrong = [str(p.relative_to(root)) for p in files if '__pycache__' not in p.parts and 'SPDX-License-Identifier: GPL-2.0-or-later' not in p.read_text()[:400]]
	assert not wrong, wrong


def test_noFastMath():
	root = PLUGIN.parent
	files = [root / 'CMakeLists.txt'] + [p for d in ('plugin', 'tests') for p in (root / d).rglob('*') if p.suffix == '.cmake' or p.name == 'CMakeLists.txt']
	code = {p: re.sub(r'#.*', '', p.read_text()) for p in files}
	assert not [str(p) for p, text in code.items() if re.search(r'-ffast-math|-Ofast|-funsafe-math', text)]
