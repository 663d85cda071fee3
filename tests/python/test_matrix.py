# SPDX-License-Identifier: GPL-2.0-or-later
"""The matrix of ordinary scripting: {how a script comes to look} x {what it does then} x {road}. Each cell is right, or refused with a reason and goes on
when mended. Right is what exact physics says or an undisturbed run by another road (matrix_scene.reference). Each road runs in a process of its own, so
that a crash costs one cell.

    /usr/bin/python3 tests/python/test_matrix.py [-v] [ROAD]...    the table with its counts; -v: what is wrong
"""
import json
import os
import queue
import subprocess
import sys
import tempfile
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from matrix_actions import ACTIONS, CONSTANTS, D, HIT, OBJECT, OTHER
from matrix_cells import GAP, AFTER, ROADS, STOPS, cells, doesNotApply
from matrix_scene import difference, reference

HERE = Path(__file__).resolve().parent
PATIENCE = 120.  #: for one cell [s]; a bound for hangs, not a measure
VERDICTS = ('right', 'refused', 'wrong', 'crash', 'hang')
_done, _pool = {}, ThreadPoolExecutor(len(ROADS))


def _start(road, wanted):
	path = os.pathsep.join(sys.path + [str(HERE), str(HERE.parents[1] / 'pyscripts')])
	env = dict(os.environ, PYTHONPATH=path, MPLBACKEND='Agg', OMP_NUM_THREADS='1')
	said, lines = tempfile.TemporaryFile('w+'), queue.Queue()
	command = ['/usr/bin/python3', str(HERE / 'matrix_cells.py'), road]
	p = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=said, text=True, env=env)

	def read():
		for line in p.stdout:
			if line.startswith('['): lines.put(json.loads(line))
		lines.put(None)

	threading.Thread(target=read, daemon=True).start()
	p.stdin.write(''.join('%s/%s\n' % c for c in wanted))
	p.stdin.close()
	return p, lines, said


def tail(file):
	file.seek(0)
	return file.read()[-2000:]


def results(road):
	"""{(stop, action): (verdict, words)} of all cells of the road. The first call starts all roads: they wait for YADE's loop more than they compute."""
	if not _done: _done.update({r: _pool.submit(_results, r) for r in ROADS})
	return _done[road].result()


def _results(road):
	"""The process is started again after a crash."""
	found, left = {}, cells(road)
	while left:
		p, lines, said = _start(road, left)
		while left:
			try:
				line = lines.get(timeout=PATIENCE)
			except queue.Empty:
				p.kill()
				found[left.pop(0)] = ('hang', 'no answer')
				break
			if line is None:
				if p.wait() >= 0: raise RuntimeError('matrix_cells.py ended by itself: ' + tail(said))
				found[left.pop(0)] = ('crash', 'signal %d' % -p.returncode)
				break
			assert tuple(line[:2]) == left[0], line
			found[left.pop(0)] = tuple(line[2:])
		p.wait()
	return found


def counts(found):
	return {v: sum(1 for w, _ in found.values() if w == v) for v in VERDICTS}


def words(road, found):
	c = counts(found)
	return '%-8s %3d cells: %3d right, %3d refused, %3d wrong (%d of them crashes, %d hangs)' % (
	        road, len(found), c['right'], c['refused'], c['wrong'] + c['crash'] + c['hang'], c['crash'], c['hang'])


@pytest.mark.parametrize('road, stop, action', [pytest.param(r, s, a, id='%s-%s-%s' % (r, s, a)) for r in ROADS for s, a in cells(r)])
def test_cell(plugin, road, stop, action):
	verdict, why = results(road)[stop, action]
	assert verdict in ('right', 'refused'), why


def test_counts(plugin, capsys):
	with capsys.disabled():
		print()
		for road in ROADS: print(words(road, results(road)))


CHANGES = {
        'shift': dict(shift=(0., 0.4 * D)),
        'pinned': dict(pinned=OTHER),
        'constants': dict(constants=CONSTANTS),
        **{'constants: ' + k: dict(constants={k: v}) for k, v in CONSTANTS.items()},
        'object': dict(object=OBJECT),
        'target': dict(target=False),
        'temperature': dict(constants=ACTIONS['temperature'].constants),
        'plastic strain': dict(constants=ACTIONS['plastic strain'].constants),
        'strength': dict(constants=ACTIONS['strength'].constants),
        'hit': dict(hit=HIT),
}


@pytest.mark.parametrize('change', sorted(CHANGES))
@pytest.mark.parametrize('road', ROADS)
def test_everyChangeShows(plugin, road, change):
	"""A cell could not fail if what the script does made no difference."""
	a, b = (reference(road, GAP, GAP + AFTER, **c) for c in ({}, CHANGES[change]))
	off = max(difference(a[g], b[g])[0] for g in ('C1', 'R'))
	assert off > 1e5
	assert difference(a['S'], b['S'])[0] < 1  # and the others do not see it


def test_theRoadsAgree(plugin):
	"""What is right does not hang on one road's code."""
	for steps in GAP, GAP + AFTER:
		a, b = reference('engine', GAP, steps), reference('law2', GAP, steps)
		for group in a:
			off, what = difference(a[group], b[group])
			assert off < 1, (group, what)


def table(road, found):
	rows = [' ' * 28 + ' '.join('%-9s' % a[:9] for a in ACTIONS)]
	for s in STOPS:
		rows.append('%-28s' % s + ' '.join('%-9s' % (found[s, a][0] if (s, a) in found else '-') for a in ACTIONS))
	reasons = {doesNotApply(road, s, a) for s in STOPS for a in ACTIONS} - {None}
	return '\n'.join(rows + ['-: ' + r for r in sorted(reasons)])


if __name__ == '__main__':
	asked = [a for a in sys.argv[1:] if a in ROADS] or ROADS
	for road in asked:
		found = results(road)
		print(words(road, found), table(road, found), sep='\n', end='\n\n', flush=True)
		if '-v' in sys.argv:
			for (stop, action), (verdict, why) in found.items():
				if verdict != 'right': print('%s, %s, %s: %s: %s' % (road, stop, action, verdict, why))
			print()
	sys.exit(sum(counts(results(r))[v] for r in asked for v in VERDICTS[2:]) > 0)
