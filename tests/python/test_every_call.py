# SPDX-License-Identifier: GPL-2.0-or-later
"""No attribute, method or function takes a bad value silently, crashes, hangs, or refuses it in words that do not help. The calls are made by every_call.py.

While the loop runs in the background only crashes and hangs are judged. Which step meets a value is chance there: a state that is set may be written over before any step has read it (told as lost when it is, which
needs another writing), a step may begin between the call and the look at positions, and a loop that is held still, by a PyRunner that waits, is another moment: its bodies are up to date. That moment, changes while the bodies are not, and what is told
of them stand in test_engine_look.py, where the loop has certainly made a step before the change and makes one after it.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import every_call
import every_call_classes as classes
import every_call_judge as judge
import every_call_table as table

HERE = Path(__file__).resolve().parent


def made(folder, *options):
	"""Results of all calls, made by processes of their own."""
	out = folder / 'calls.json'
	environment = dict(os.environ, PYTHONPATH=os.pathsep.join(p for p in sys.path if p), OMP_NUM_THREADS='1', MPLBACKEND='Agg')
	command = ['/usr/bin/python3', str(HERE / 'every_call.py'), '--json', str(out), *options]
	r = subprocess.run(command, capture_output=True, text=True, errors='replace', env=environment)
	assert r.returncode == 0, r.stderr[-2000:]
	return json.loads(out.read_text())


@pytest.fixture(scope='module')
def calls(tmp_path_factory):
	return made(tmp_path_factory.mktemp('calls'))


def found(calls, verdict):
	return ['%s   %s' % (c['name'], c['text']) for c in calls if c['verdict'] == verdict]


def judged(calls, fault):
	"""Without what is chance while the loop runs, see above."""
	return [b for b in found(calls, fault) if fault in ('crash', 'hang') or ', running ' not in b.split('   ')[0] + ' ']


@pytest.mark.parametrize('fault', every_call.FAULTS)
def test_noCall(plugin, calls, fault):
	"""crash, hang; silent: accepted though bad; moved: refused after positions had changed; poor: words; broken: a right call is refused."""
	bad = judged(calls, fault)
	assert not bad, '%d of %d calls:\n%s' % (len(bad), len(calls), '\n'.join(bad[:60]))


@pytest.mark.study
@pytest.mark.parametrize('fault', every_call.FAULTS)
def test_noCallOfTheFullList(plugin, tmp_path_factory, fault, full=[]):
	if not full: full.append(made(tmp_path_factory.mktemp('study'), '--study'))
	bad = judged(full[0], fault)
	assert not bad, '%d of %d calls:\n%s' % (len(bad), len(full[0]), '\n'.join(bad[:200]))


def test_everyClassIsIn(plugin, calls):
	tried = {c['name'].split('.')[0].split(' ')[0] for c in calls}
	assert set(plugin.classes) <= tried
	assert {'packings', 'outlines', 'measure', 'materials', 'scenes'} <= tried
	assert len(calls) > 5000


def test_theTableDeclaresNothingThatIsNotThere(plugin, calls):
	"""An attribute that is renamed must not leave its exceptions behind."""
	known = {c['key'] for c in calls} | {c['name'].split(' = ')[0] for c in calls}
	stale = [key for key in table.ACCEPTED if key not in known and key.split('(')[0] not in known]
	assert not stale, stale
	assert all(len(reason) > 2 for _, reason in table.ACCEPTED.values())


def test_aNewAttributeIsTriedWithoutBeingNamed(plugin):
	"""A class nobody has thought of: its attribute takes anything, and that is found."""

	class Fresh:
		def __init__(self): self._depth = 1.

		depth = property(lambda self: self._depth, lambda self, v: setattr(self, '_depth', v), doc='how deep [m] :yattrtype:`Real`')

	made = classes.Calls(Fresh, ('alone', lambda reuse=None: None, Fresh), 'before', True)
	verdicts = {c.kind: c.run()[0] for c in made.all() if c.key == 'Fresh.depth'}
	assert verdicts['nan'] == verdicts['negative'] == verdicts['text'] == 'silent' and verdicts['read'] == 'accepted', verdicts


@pytest.mark.parametrize('text, lacks', [
        ('bad value', 'what, where, allowed or remedy'),
        ('McaEngine: depth is wrong', 'allowed or remedy'),
        ('depth = -1 must be above 0', 'where'),
        ('McaEngine: depth = -1 must be above 0', ''),
])
def test_messagesAreJudged(text, lacks):
	assert judge.poor(RuntimeError(text), ['depth']) == lacks


def readers(road, seconds):
	environment = dict(os.environ, PYTHONPATH=os.pathsep.join(p for p in sys.path if p), OMP_NUM_THREADS='2', MPLBACKEND='Agg')
	command = ['/usr/bin/python3', str(HERE / 'every_call_readers.py'), road, str(seconds)]
	r = subprocess.run(command, capture_output=True, text=True, errors='replace', env=environment, timeout=300)
	return r.returncode, r.stdout[-300:] + r.stderr[-300:]


@pytest.mark.parametrize('road', ['engine', 'grid', 'coupled'])  # the law in YADE's loop asks for a pause: its numbers are the bodies'
def test_readingWhileTheLoopRuns(plugin, road):
	"""Everything an engine shows, read from the prompt while links break and contacts grow."""
	code, text = readers(road, 2)
	assert code == 0, text
	assert int(text.split(' reads')[0].split()[-1]) > 100, text


@pytest.mark.study
def test_readingWhileTheLoopRunsTenTimes(plugin):
	ends = [readers('engine', 4) for _ in range(10)]
	assert [e for e in ends if e[0] != 0] == []
