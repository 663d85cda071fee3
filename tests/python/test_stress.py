# SPDX-License-Identifier: GPL-2.0-or-later
"""The task stress: its options, how it judges, its random scenes, children that die, and some small cases."""
import json
import math

import signal

import pytest

from yade_mca.tasks import cli
from yade_mca.tasks.stress import children
from yade_mca.tasks.stress.judge import FAILED, HELD, REFUSED, StressCase, clear, judge, violations


@pytest.mark.parametrize('argv, word', [
        (['stress', '--only', 'nothing of this name'], 'no case'),
        (['stress', '--seed', '-1'], '--seed'),
        (['stress', '--seed', 'many'], 'whole number'),
        (['stress', '--quik'], 'unrecognized'),
        (['stress', '--json', '/no/such/folder/x.json'], 'does not exist'),
])
def test_wrongOptionsEndInOneLineAndStatus2(plugin, capsys, argv, word):
	assert cli.main(argv) == 2
	shown = capsys.readouterr()
	assert word in shown.err and shown.err.count('\n') == 1 and not shown.out


GOOD = dict(finite=True, energy=1e-3, booked=1e-15, momentum=1e-16, growth=0.9, lost=0)


@pytest.mark.parametrize('change, word', [
        ({}, None),
        (dict(finite=False), 'not a number'),
        (dict(energy=0.5), 'energy sum'),
        (dict(energy=math.nan), 'energy sum'),
        (dict(booked=1e-9), 'booked'),
        (dict(momentum=1e-11), 'momentum'),
        (dict(growth=1e6), 'grown'),
        (dict(lost=1), 'lost'),
        (dict(value=0.97, atLeast=1.), 'below'),
        (dict(value=math.nan, atLeast=1.), 'below'),
        (dict(value=0.2, atMost=0.1), 'above'),
        (dict(value=math.nan), 'not a number'),
])
def test_whatSpeaksAgainstHeld(change, word):
	found = violations(dict(GOOD, **change))
	assert (not found) if word is None else any(word in f for f in found), found
	outcome = judge(StressCase('x', None), dict(GOOD, **change))
	assert outcome.outcome == (HELD if word is None else FAILED) and bool(outcome.text) == (word is not None)


STEP = RuntimeError('McaEngine: O.dt = 1e-6 s is above the largest stable step 1e-7 s of body 3. Set O.dt below it.')


@pytest.mark.parametrize('expect, error, after, outcome', [
        (REFUSED, STEP, None, REFUSED),
        ('either', STEP, dict(finite=True, saved=True), REFUSED),
        (HELD, STEP, None, FAILED),
        (REFUSED, None, None, FAILED),
        ('either', None, None, HELD),
        (REFUSED, STEP, dict(finite=False, saved=True), FAILED),
        (REFUSED, STEP, dict(finite=True, saved=False), FAILED),
        (REFUSED, IndexError('list index out of range'), None, FAILED),
        (REFUSED, RuntimeError('std::bad_alloc was thrown in step 12 of the run'), None, FAILED),
        (REFUSED, RuntimeError('error'), None, FAILED),
        (REFUSED, TypeError('unsupported operand for 3 and some very long text'), None, FAILED),
])
def test_exceptionsAreRefusalsOnlyWhenAskedForClearAndHarmless(expect, error, after, outcome):
	found = judge(StressCase('x', None, expect), None if error else GOOD, error, after)
	assert found.outcome == outcome, found.text


def test_theProgramsOwnErrorsAreClear(plugin):
	from yade_mca import materials, packings, scenes
	for wrong in (lambda: materials.get('unobtainium'), lambda: packings.hexagonal(-1., packings.Rectangle((0, 0), (1, 1))), lambda: scenes.bar('4340', -1, 1, 1)):
		with pytest.raises(ValueError) as e:
			wrong()
		assert clear(e.value), str(e.value)


def test_randomScenesComeFromTheSeedAlone(plugin):
	from yade_mca.tasks.stress.random import describe
	first = [describe(1, k) for k in range(20)]
	assert first == [describe(1, k) for k in range(20)] and first[7] == describe(1, 7)
	assert first != [describe(2, k) for k in range(20)] and len({json.dumps(d) for d in first}) == 20
	assert any(d['coupled'] for d in first) and not all(d['coupled'] for d in first)
	assert all(10 <= d['speed'] <= 6000 and 0.1 <= d['dtFactor'] <= 0.9 for d in first)


def test_namesAreUniqueAndQuickIsAPart(plugin):
	quick = [c.name for g in children.GROUPS for c in g.cases(True, 1)]
	full = [c.name for g in children.GROUPS for c in g.cases(False, 1)]
	assert len(set(quick)) == len(quick) and len(set(full)) == len(full)
	assert len(full) > len(quick) > 200


def test_smallCasesEndAsTheyShould(plugin, tmp_path, capsys):
	"""One that holds, one that is refused: through a child process, table and JSON."""
	assert cli.main(['stress', '--quick', '--only', 'step/automata/elastic/', '--json', str(tmp_path / 's.json'), '--out', str(tmp_path)]) == 0
	d = json.loads((tmp_path / 's.json').read_text())
	s = d['stress']
	assert s['failed'] == 0 and s['failedCases'] == [] and s['held'] >= 4 and s['refused'] >= 4
	assert len(d['cases']) == len(s['outcomes']) == s['held'] + s['refused']
	refusal = next(o for o in s['outcomes'] if o['name'].endswith('/2'))
	assert refusal['outcome'] == REFUSED and 'largest stable step' in refusal['text']
	assert 'largest stable step' in (tmp_path / 'stress.txt').read_text() and 'held %d' % s['held'] in capsys.readouterr().out


def test_predictedLimitOfAWeightedRimLiesBelowTheMeasuredOne(plugin):
	cases = children.allCases(True, 1)
	for name in ('limit/automata/weightedRim/17deg', 'limit/automata/stretched10%', 'limit/grid/hourglass4'):
		found = cases[name].run()
		assert 1. <= found['value'] < 1.5, name


def test_aDyingChildCostsOneCase(plugin, monkeypatch, tmp_path):
	"""The case in which the process dies is recorded, the others go on in a new process."""
	script = tmp_path / 'child.py'
	script.write_text('import os, sys, json\nfor name in sys.stdin.read().split("\\n"):\n'
	                  '\twith open(sys.argv[1], "a") as f: f.write(json.dumps(dict(started=name)) + "\\n")\n'
	                  '\tif name == "deadly": os.kill(os.getpid(), %d)\n'
	                  '\twith open(sys.argv[1], "a") as f: f.write(json.dumps(dict(name=name, outcome="held", text="", measures={})) + "\\n")\n' % signal.SIGSEGV)
	real = children.subprocess.Popen
	monkeypatch.setattr(children.subprocess, 'Popen', lambda command, **k: real([command[0], str(script)] + command[3:], **k))
	found = list(children.Children(['a', 'deadly', 'b'], True, 1))
	assert [(o.name, o.outcome) for o in found] == [('a', HELD), ('deadly', FAILED), ('b', HELD)]
	assert 'SIGSEGV' in found[1].text

