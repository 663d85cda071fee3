# SPDX-License-Identifier: GPL-2.0-or-later
"""Declarations that differ from the library are refused: headers are altered on purpose, the guard is compiled with them and loaded."""
import re
import shutil
import subprocess

import pytest
from abi_support import BUILD, LIVING, ROOT, refused, runPython

#: what is altered: (header, its text, the text instead, words that the refusal must name)
ALTERED = {
        'extra member in State': ('core/State.hpp', 'Real         mass; ', 'Real extra_; Real         mass; ', ['State']),
        'extra member in Scene': ('core/Scene.hpp', 'bool                                  isPeriodic; ', 'Real extra_; bool isPeriodic; ', ['Scene']),
        'extra member in Engine': ('core/Engine.hpp', 'bool                     dead; ', 'long extra_; bool dead; ', ['Engine', 'size of']),
        'swapped members of State': ('core/State.hpp', 'Vector3r     vel;            // 0x90, m/s', 'Vector3r     angVel;', ['State.vel', 'State.angVel']),
        'swapped members of PeriodicEngine': ('pkg/common/PeriodicEngines.hpp', 'Real virtPeriod   = 0;          // 0x68, s\n\tReal realPeriod   = 0; ', 'Real realPeriod = 0;\n\tReal virtPeriod = 0; ', ['virtPeriod', 'realPeriod']),
        'swapped pointers in Body': ('core/Body.hpp', 'shared_ptr<Material> material;  // 0x28\n\tshared_ptr<State>    state;     // 0x38', 'shared_ptr<State> state;\n\tshared_ptr<Material> material;', ['Body.material', 'Body.state']),
        'swapped pointers in Scene': ('core/Scene.hpp', 'shared_ptr<BodyContainer>             bodies;                       // 0x258\n\tshared_ptr<InteractionContainer>      interactions; ', 'shared_ptr<InteractionContainer> interactions;\n\tshared_ptr<BodyContainer> bodies; ', ['Scene.bodies', 'Scene.interactions']),
        'swapped virtual functions of Engine': ('core/Engine.hpp', 'virtual bool isActivated(); // slot 12\n\tvirtual void action();      // 13', 'virtual void action();\n\tvirtual bool isActivated();', ['virtual function', 'isActivated']),
        'extra virtual function in Material': ('core/Material.hpp', 'virtual shared_ptr<State> newAssocState() const; ', 'virtual void extra_() {}\n\tvirtual shared_ptr<State> newAssocState() const; ', ['virtual function', 'newAssocState']),
        'swapped members of TimeStepper': ('core/TimeStepper.hpp', 'bool         active                 = true; // 0x68\n\tunsigned int timeStepUpdateInterval = 1;    // 0x6c', 'unsigned int timeStepUpdateInterval = 1;\n\tbool active = true;', ['TimeStepper']),
        'timing laid out otherwise': ('core/Timing.hpp', 'long        nExec = 0;\n\tdelta       nsec  = 0;', 'delta nsec = 0;\n\tlong nExec = 0;', ['timingInfo']),
        'energy tracker laid out otherwise': ('core/EnergyTracker.hpp', 'vector<T*> chunks; ', 'size_t extra_; vector<T*> chunks; ', ['EnergyTracker']),
}
EXTRA = {'swapped members of State': ('core/State.hpp', 'Vector3r     angVel;         // 0xb0, rad/s', 'Vector3r     vel;')}


@pytest.fixture(scope='module')
def precompiled(tmp_path_factory):
	"""Boost, Python and Eigen, which are most of the work of the compiler, once for all."""
	header = tmp_path_factory.mktemp('precompiled') / 'foreign.hpp'
	names = set()
	for path in sorted((ROOT / 'plugin' / 'sdk').rglob('*.[hc]pp')):
		names |= {m[1] for m in re.finditer(r'^#include <((?:boost|Eigen)/[^>]+|[a-z_]+(?:\.h)?)>', path.read_text(), re.M)}
	first = 'boost/python.hpp'
	header.write_text('#define EIGEN_DONT_PARALLELIZE\n' + ''.join('#include <%s>\n' % n for n in [first] + sorted(names - {first})))
	subprocess.run(arguments() + ['-x', 'c++-header', str(header), '-o', str(header) + '.gch'], check=True)
	return header


def arguments(name='compile'):
	return [a for a in (BUILD / 'tests' / 'fixture' / (name + '.rsp')).read_text().split('\n') if a] + (['-DMCA_SDK_NO_LAYOUT_ASSERT', '-DMCA_MODULE=_altered'] if name == 'compile' else [])


def compileAltered(tmp_path, precompiled, edits, extraSource=''):
	"""The guard as an extension of its own, made with altered declarations and without the compiler's own check of them. Path, or the compiler's text."""
	include = tmp_path / 'include'
	shutil.copytree(ROOT / 'plugin' / 'sdk' / 'include', include)
	for file, old, new in edits:
		text = (include / file).read_text()
		assert text.count(old) == 1, (file, old)
		(include / file).write_text(text.replace(old, new))
	sdk = ROOT / 'plugin' / 'sdk'
	sources = ['guard/Probe.cpp', 'guard/guard.cpp', 'guard/sizes.cpp', 'guard/slots.cpp', 'guard/members.cpp', 'guard/scene.cpp', 'registry.cpp', 'module.cpp']
	one = tmp_path / 'all.cpp'
	one.write_text(''.join('#include "%s"\n' % (sdk / s) for s in sources) + extraSource)
	out = tmp_path / '_altered.so'
	command = arguments() + ['-include', str(precompiled), '-I', str(include), '-I', str(sdk / 'helpers'), '-I', str(ROOT / 'plugin'), str(one), '-o', str(out)] + arguments('link')
	done = subprocess.run(command, capture_output=True, text=True)
	assert done.returncode == 0, done.stderr
	return out


def loadAltered(path):
	return runPython("""
import types
package = types.ModuleType('yade_mca'); package.__path__ = [%r]; sys.modules['yade_mca'] = package  # the loader without what it loads
from yade_mca import _loader
import yade, yade.config, yade.wrapper, yade.system
try:
	module = _loader.openExtension('_altered', %r)
	print('LOADED', module.guardChecks)
except ImportError as e:
	print('REFUSED:', e)
""" % (str(ROOT / 'pyscripts' / 'yade_mca'), str(path)) + LIVING)


def test_unalteredDeclarationsPass(tmp_path, precompiled):
	done = loadAltered(compileAltered(tmp_path, precompiled, []))
	assert 'LOADED' in done.stdout and 'ALIVE 3' in done.stdout, done.stdout
	assert int(re.search(r'LOADED (\d+)', done.stdout)[1]) > 150


@pytest.mark.parametrize('name', sorted(ALTERED))
def test_alteredDeclarationsAreRefused(name, tmp_path, precompiled):
	file, old, new, words = ALTERED[name]
	edits = [(file, old, new)] + ([EXTRA[name]] if name in EXTRA else [])
	refused(loadAltered(compileAltered(tmp_path, precompiled, edits)), 'does not fit', *words)


def test_theCompilerRefusesAlteredDeclarationsFirst(tmp_path):
	include = tmp_path / 'include'
	shutil.copytree(ROOT / 'plugin' / 'sdk' / 'include', include)
	path = include / 'core' / 'State.hpp'
	path.write_text(path.read_text().replace('Real         mass; ', 'Real extra_; Real         mass; '))
	(tmp_path / 'x.cpp').write_text('#include <sdk/layout.hpp>\n')
	done = subprocess.run([a for a in arguments() if 'NO_LAYOUT' not in a] + ['-fsyntax-only', '-I', str(include), '-I', str(ROOT / 'plugin' / 'sdk' / 'helpers'), str(tmp_path / 'x.cpp')], capture_output=True, text=True)
	assert done.returncode != 0 and 'sizeof State' in done.stderr


def test_aFunctionThisLibraryLacks(tmp_path, precompiled):
	"""A symbol of another version of YADE: the dynamic loader refuses, before any code has run."""
	call = """
namespace yade { class BodyContainerOfOtherVersion { public: void updateShortLists(); };
__attribute__((visibility("default"))) void neverCalled(BodyContainerOfOtherVersion& b) { b.updateShortLists(); } }
"""
	refused(loadAltered(compileAltered(tmp_path, precompiled, [], call)), 'lacks a function', 'updateShortLists')
