# SPDX-License-Identifier: GPL-2.0-or-later
"""The recipe of doc/extending.rst, followed to the letter in a copy of the sources: the law that the page writes is built into the solvers and gives what its equation says."""
import os
import re
import shutil
import subprocess
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / 'plugin' / 'doc' / 'extending.rst'

#: pure shear of a grid and of automata: Mises stress and plastic strain in the middle lie on the curve of the page's law
CHECK = r'''
#include "unit/automata_scene.hpp"
#include "grid/grid.hpp"
using namespace automatatest;

namespace {
Material voce()
{
	Material m = steel();
	Yield&   y = m.yield;
	y.kind = YieldKind::voce, y.yieldStress = 0.5e9, y.saturationStress = 0.7e9, y.saturationStrain = 0.1;
	m.viscosity = { 0., 0. };
	return m;
}
double curve(double ep) { return 0.7e9 - 0.2e9 * std::exp(-ep / 0.1); }
constexpr double shear = 2e4, dt = 5e-9;
constexpr int    steps = 500;
}

TEST(Voce, OfCells)
{
	grid::Grid          g;
	std::vector<double> x;
	for (int k = -30; k <= 30; k++)
		x.push_back(k * 1e-3);
	g.addRectangle(voce(), x, x);
	g.setVelocity(0, [](double a, double b) { return std::array<double, 2> { shear * a, -shear * b }; });
	g.build();
	for (int k = 0; k < steps; k++)
		g.step(dt);
	const grid::Block& b = g.block(0);
	const size_t       c = b.cell(30, 30);
	const double       s = std::sqrt(3 * (sqr(b.sxx[c]) + sqr(b.syy[c]) + b.sxx[c] * b.syy[c] + sqr(b.sxy[c])));
	EXPECT_GT(b.eqps[c], 0.04);
	EXPECT_NEAR(s / curve(b.eqps[c]), 1., 1e-4);
}

TEST(Voce, OfAutomata)
{
	const Material m    = voce();
	auto           list = packing(1e-3, 41, 47, m, { -20e-3, -20e-3, 0 });
	for (auto& a : list)
		a.velocity = { shear * a.position[0], -shear * a.position[1] };
	Solver s;
	s.build(list, { m }, {});
	for (int k = 0; k < steps / 2; k++)
		s.computeForces(), s.integrate(dt);
	s.computeForces();
	size_t middle = 0;
	for (size_t i = 0; i < s.store.size(); i++)
		if (s.store.id[i] >= 0 && plainSquare(s.store.position.at(i)) < plainSquare(s.store.position.at(middle))) middle = i;
	EXPECT_GT(s.store.eqps[middle], 0.015);
	EXPECT_NEAR(s.equivalentStress(middle) / curve(s.store.eqps[middle]), 1., 1e-4);
}
'''


def blocks():
	"""{caption: text} of the page's C++."""
	out = {}
	for caption, body in re.findall(r'\.\. code-block:: cpp\n +:caption: (\S+)\n\n((?: {6}.*\n|\n)+)', PAGE.read_text()):
		out[caption] = textwrap.dedent(body)
	return out


def run(command, **options):
	done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=900, **options)
	assert done.returncode == 0, '%s\n%s' % (done.stdout[-3000:], done.stderr[-6000:])
	return done.stdout


def test_theLawOfThePageWorks(tmp_path):
	page = blocks()
	assert set(page) == {'plugin/kernels/laws/flow/voce.hpp', 'plugin/kernels/laws/list.hpp', 'tests/unit/laws.cpp'}
	tree = tmp_path / 'tree'
	for part in ('plugin', 'tests', 'pyscripts/yade_mca/data'):
		shutil.copytree(ROOT / part, tree / part, ignore=shutil.ignore_patterns('__pycache__', 'results'))
	shutil.copy(ROOT / 'CMakeLists.txt', tree)
	# step 1 and 2
	(tree / 'plugin/kernels/laws/flow/voce.hpp').write_text(page['plugin/kernels/laws/flow/voce.hpp'])
	include, row = page['plugin/kernels/laws/list.hpp'].rstrip('\n').split('\n')
	path = tree / 'plugin/kernels/laws/list.hpp'
	head, flows, rest = re.match(r'(.*?\n)(#define MCA_FLOW_LAWS\(L\) \\\n(?:[^\n]*\\\n)*[^\n]*\n)(.*)', path.read_text(), re.S).groups()
	path.write_text(head.replace('#include <cstdint>', include + '\n#include <cstdint>') + flows.rstrip('\n') + ' \\\n' + row + '\n' + rest)
	# step 3
	with open(tree / 'tests/unit/laws.cpp', 'a') as f:
		f.write('\n' + page['tests/unit/laws.cpp'])
	(tree / 'tests/voce.cpp').write_text(CHECK)
	# the solvers with little optimisation, which is most of the compiler's work; the paths of the copy must not spoil the cache
	environment = dict(os.environ, CCACHE_BASEDIR=str(tmp_path), CCACHE_NOHASHDIR='1')
	launcher = ['-DCMAKE_CXX_COMPILER_LAUNCHER=ccache'] if shutil.which('ccache') else []
	run(['cmake', '-S', tree, '-B', tmp_path / 'b', '-DMCA_YADE=OFF', '-DMCA_TESTS=OFF', '-DMCA_HWCAPS=OFF', '-DMCA_OPTIMISATION=-O0', *launcher], env=environment)
	run(['cmake', '--build', tmp_path / 'b', '--parallel', os.environ.get('YADE_MCA_JOBS', '2')], env=environment)
	assert '"voce"' in (tree / 'pyscripts/yade_mca/data/laws.json').read_text()  # Python knows it by now
	programs = [('laws', tree / 'tests/unit/laws.cpp'), ('voce', tree / 'tests/voce.cpp')]
	lib = tmp_path / 'b/yade_mca_lib'
	for name, source in programs:
		run(['g++', '-std=c++17', '-O0', '-fopenmp', '-Wno-psabi', '-I', tree / 'plugin', '-I', tree / 'tests', source, '-o', tmp_path / name, '-L', lib, '-Wl,-rpath,%s' % lib,
		     '-lmcasolver', '-lgtest', '-lgtest_main'])
		out = run([tmp_path / name])
		assert 'VoceIsItsEquation' in out or 'Voce.OfAutomata' in out


def test_aLawThatIsLeftOutOfASwitchIsAnError():
	"""No switch over kinds outside the list has a way out for those it does not name."""
	for source in (ROOT / 'plugin').rglob('*pp'):
		if 'sdk' in source.parts: continue
		text = source.read_text()
		assert not re.search(r'^\s*default\s*:', text, re.M), source
		assert source.name in ('list.hpp', 'material.hpp') or not re.search(r'(YieldKind|EosKind)::(?!elastic\b|shockAdiabat\b)\w+', text), '%s asks for a law by name' % source
	flags = [(ROOT / 'plugin/cmake' / f).read_text() for f in ('SolverLibrary.cmake', 'YadeExtension.cmake')]
	assert all('-Werror=switch' in f for f in flags)
