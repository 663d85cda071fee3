# SPDX-License-Identifier: GPL-2.0-or-later
"""The dispatcher, the report and the progress of tasks."""
import io
import json
import math
import os
import re
import sys
import types

import numpy as np
import pytest

from yade_mca.tasks import Report, UsageError, cli, registry
from yade_mca.tasks.progress import Progress
from yade_mca.tasks.report import writeAtomically


@pytest.fixture
def toy(monkeypatch):
	"""A task that adds the cases it is given on the command line."""
	module = types.ModuleType('yade_mca.tasks.toy')
	module.SUMMARY = 'a toy'
	module.addArguments = lambda p: p.add_argument('--size', type=cli.positive(int), default=1)

	def run(args, report, progress):
		if args.size == 13:
			raise RuntimeError('thirteen')
		report.add('toy/size', args.size, reference=4, limit=0.3, unit='m')

	module.run = run
	monkeypatch.setitem(sys.modules, module.__name__, module)
	monkeypatch.setattr(registry, 'load', lambda name: module)
	monkeypatch.setitem(registry.TASKS, 'toy', 'toy')


@pytest.mark.parametrize('size, status', [(4, 0), (5, 0), (9, 1), (13, 1)])
def test_status_and_file(toy, tmp_path, capsys, size, status):
	path = tmp_path / 'r.json'
	assert cli.main(['toy', '--size', str(size), '--json', str(path)]) == status
	d = json.loads(path.read_text())
	assert d['task'] == 'toy' and d['threads'] >= 1 and d['wall'] >= 0 and {'version', 'commit', 'isa'} <= set(d)
	if size == 13:
		assert 'thirteen' in d['error'] and 'thirteen' in capsys.readouterr().err
	else:
		assert d['cases'] == [dict(name='toy/size', value=size, reference=4, error=abs(size - 4) / 4, limit=0.3, unit='m', order=None, passed=status == 0)]
		assert ('FAILED' in capsys.readouterr().out) == bool(status)


@pytest.mark.parametrize('argv, word', [
        ([], 'which task'),
        (['tou'], "did you mean 'toy'"),
        (['toy', '--size', '-3'], 'above 0'),
        (['toy', '--size', 'many'], 'whole number'),
        (['toy', '--siz', '3'], 'unrecognized'),
        (['toy', '--threads', '0'], 'above 0'),
        (['toy', '--json', '/no/such/folder/x.json'], 'does not exist'),
        (['toy', '--json', '/'], 'not a file name'),
        (['toy', '--out', '/proc/self/x'], 'cannot make'),
])
def test_wrong_options_end_in_one_line_and_status_2(toy, capsys, argv, word):
	assert cli.main(argv) == 2
	shown = capsys.readouterr()
	assert word in shown.err and shown.err.count('\n') == 1 and not shown.out


def test_missing_part_is_a_usage_error():
	with pytest.raises(UsageError, match='not part of this installation'):
		registry.load('verify.nothing')


def test_report_decides_by_error_limit_and_finiteness():
	r = Report('t')
	assert r.add('a', 1.01, 1.0, limit=0.02).passed
	assert not r.add('b', 1.03, 1.0, limit=0.02).passed
	assert r.add('zero reference is absolute', 1e-13, 0, limit=1e-12).error == 1e-13
	assert not r.add('no reference: the value itself', 1e-3, limit=1e-4).passed
	assert r.add('nothing asserted', 5.).passed
	assert not r.add('nan', math.nan).passed and not r.add('nan', math.nan, passed=True).passed
	assert not r.add('nan error', 1., 1., error=math.nan, limit=1).passed
	assert r.add('numpy', np.float64(2), np.int64(2), limit=np.float32(0)).passed
	assert r.add('lower bound', 5., limit=4., passed=5. >= 4.).passed
	assert r.exitCode == 1 and len(r.failed) == 5
	text = json.dumps(r.asDict(), allow_nan=False)
	assert json.loads(text)['cases'][5]['value'] is None


def test_what_is_only_measured_does_not_read_ok():
	out = io.StringIO()
	r = Report('t', out)
	r.add('measured', 5.)
	r.add('compared', 5., 4.)
	r.add('held', 5., 4., limit=1.)
	r.add('above', 5., passed=5. > 4.)
	r.add('nan', math.nan)
	r.show()
	last = {line.split()[0]: line.split()[-1] for line in out.getvalue().splitlines()}
	assert (last['measured'], last['compared'], last['held'], last['above'], last['nan']) == ('-', '-', 'ok', 'ok', 'FAILED')
	assert 't: 2 passed, 1 failed, 2 only measured' in out.getvalue()


def test_numbers_are_not_rounded_in_the_file(tmp_path):
	r, x = Report('t'), 0.1 + 0.2
	r.add('x', x)
	r.write(tmp_path / 'x.json')
	assert json.loads((tmp_path / 'x.json').read_text())['cases'][0]['value'] == x


def test_files_are_written_whole_or_not_at_all(tmp_path, monkeypatch):
	path = tmp_path / 'x'
	writeAtomically(path, 'old')
	monkeypatch.setattr(os, 'replace', lambda a, b: (_ for _ in ()).throw(OSError(28, 'No space left on device')))
	with pytest.raises(OSError):
		writeAtomically(path, 'new')
	assert path.read_text() == 'old' and os.listdir(tmp_path) == ['x']


def test_plain_progress_away_from_a_terminal(monkeypatch):
	out = io.StringIO()
	monkeypatch.setattr(Progress, 'INTERVAL', 0.)
	with Progress(200, 'job', 'us', stream=out) as p:
		p.update(50, energyError=1e-12)
		p.update(100, energyError=2e-12)
	lines = out.getvalue().splitlines()
	assert len(lines) == 3 and re.match(r'job:  25 %, 50 of 200 us, \d+ s, \d+ s left, energyError 1e-12', lines[0])
	assert '\r' not in out.getvalue()


def test_progress_grows_with_what_is_to_do(monkeypatch):
	out = io.StringIO()
	monkeypatch.setattr(Progress, 'INTERVAL', 0.)
	with Progress(100, 'job', 'us', stream=out) as p:
		p.grow(200)
		p.update(100)
	assert out.getvalue().startswith('job:  50 %, 100 of 200 us')


def test_info(plugin, tmp_path, capsys):
	assert cli.main(['info', '--json', str(tmp_path / 'i.json')]) == 0
	d = json.loads((tmp_path / 'i.json').read_text())
	assert re.match(r'20\d\d\.\d', d['info']['yade']) and d['isa'] == d['info']['isa'] and d['cases'][0]['value'] > 0
