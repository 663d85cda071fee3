# SPDX-License-Identifier: GPL-2.0-or-later
"""Stored numbers against what the program computes now; the tool that changes them; speed by a ratio within this process."""
import json
import math
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent / 'pyscripts'), str(TESTS / 'baselines')]
for p in Path('/usr/lib').glob('*/yade-double/py'):
	sys.path.append(str(p))
import cases
import store


@pytest.mark.parametrize('group', cases.GROUPS)
def test_numbersAreThoseStored(group):
	import yade_mca  # noqa: F401  loads the classes
	rows = store.compare(group, cases.GROUPS[group]())
	assert rows and all(r[4] for r in rows), 'if the change is meant: tests/baseline update %s --why TEXT\n%s' % (group, rows)


def test_everyFileIsWholeAndHasItsGroup():
	assert {p.stem for p in store.FOLDER.glob('*.json')} == set(cases.GROUPS)
	for group in cases.GROUPS:
		for name, e in store.load(group).items():
			assert len(e['why']) > 20 and len(e['commit'].rstrip('+')) == 40, (group, name)


def test_storeComparesAndRefuses(tmp_path, monkeypatch):
	monkeypatch.setattr(store, 'FOLDER', tmp_path)
	with pytest.raises(store.BaselineError, match='only with its reason'):
		store.changed('toy', dict(x=1.), None, ' ', 0.1, 'c')
	with pytest.raises(store.BaselineError, match='is new: give --tolerance'):
		store.changed('toy', dict(x=1.), None, 'because', None, 'c')
	with pytest.raises(store.BaselineError, match='finite'):
		store.changed('toy', dict(x=math.nan), None, 'because', 0.1, 'c')
	with pytest.raises(store.BaselineError, match="no number 'y'"):
		store.changed('toy', dict(x=1.), 'y', 'because', 0.1, 'c')
	old, new = store.changed('toy', dict(x=1., z=3.), 'x', 'because', 0.1, 'c')
	assert old == {} and new == dict(x=dict(value=1., tolerance=0.1, why='because', commit='c'))
	store.save('toy', new)
	assert [r[4] for r in store.compare('toy', dict(x=1.05))] == [True] and [r[4] for r in store.compare('toy', dict(x=1.2))] == [False]
	assert [r[4] for r in store.compare('toy', dict(x=math.nan))] == [False]
	assert [(r[0], r[4]) for r in store.compare('toy', dict(y=1.))] == [('toy/x', False), ('toy/y', False)]
	_, later = store.changed('toy', dict(x=2.), None, 'the law has changed', None, 'd')
	assert later['x'] == dict(value=2., tolerance=0.1, why='the law has changed', commit='d')
	(tmp_path / 'toy.json').write_text(json.dumps(dict(x=dict(value=1., tolerance=0., why='', commit='c'))))
	with pytest.raises(store.BaselineError, match='needs a finite value'):
		store.load('toy')
	(tmp_path / 'toy.json').write_text('{')
	with pytest.raises(store.BaselineError, match='not JSON'):
		store.load('toy')


@pytest.mark.parametrize('words, said', [
        (['update', 'taylor'], 'only with its reason'),
        (['update', 'nothing', '--why', 'because'], "no baselines called 'nothing'"),
        (['show', 'nothing'], 'groups are'),
        (['change', 'taylor'], 'invalid choice'),
        ([], 'required'),
])
def test_toolRefusesInOneLine(words, said):
	done = subprocess.run([str(TESTS / 'baseline'), *words], capture_output=True, text=True)
	assert done.returncode == 2 and said in done.stderr and done.stderr.count('\n') == 1 and not done.stdout, done.stderr


def test_engineIsSeveralTimesAsFastAsTheLawInYadesLoop():
	"""Both in turn in this process, the best of their turns: whatever the load of the machine is, it meets both. (Quiet machines show 15 and more.)"""
	import yade_mca  # noqa: F401  loads the classes
	sys.path.insert(0, str(TESTS / 'python'))
	import law2_scene
	from yade import O
	from yade_mca import materials, packings
	numbers, best = {}, {}
	O.reset()
	for road in 'engine', 'law2':
		if numbers: O.switchToScene(O.addScene())
		numbers[road] = O.thisScene
		packings.addBodies(packings.hexagonal(1e-3, packings.Rectangle((0, 0), (40e-3, 40e-3))), materials.mcaMat('4340', yieldModel='perfect'), velocity=(3., 0.))
		law2_scene.engines(road, 1e-8)
		O.run(10, True)
	O.timingEnabled = True
	for _ in range(5):
		for road, number in numbers.items():
			O.switchToScene(number)
			before = sum(e.execTime for e in O.engines)
			O.run(20, True)
			best[road] = min(best.get(road, math.inf), sum(e.execTime for e in O.engines) - before)
	O.timingEnabled = False
	O.switchToScene(0)
	O.reset()
	assert best['law2'] >= 4 * best['engine'], best
