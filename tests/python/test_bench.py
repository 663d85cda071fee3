# SPDX-License-Identifier: GPL-2.0-or-later
"""Task `bench`: wrong options, the record of a tiny run, errors and ratios of known records, pictures and tables."""
import json
import math

import numpy as np
import pytest

from yade_mca import plots
from yade_mca.tasks import cli
from yade_mca.tasks.bench import google, plan, process, results
from yade_mca.tasks.bench import plots as pictures
from yade_mca.tasks.bench import task as bench
from yade_mca.tasks.report import Report

#: what every record of a run that came to its end holds
RECORD = {
        'case', 'solver', 'n', 'rule', 'factor', 'sleeping', 'account', 'threads', 'name', 'stepping', 'wall', 'built', 'steps', 'automata', 'cells', 'simulated', 'error', 'energyError', 'automataNs',
        'cellNs', 'phases', 'memory', 'load', 'compiler', 'isa', 'processor', 'commit', 'version'
}


@pytest.mark.parametrize('argv, word', [
        (['bench', '--only', 'everything'], 'elasticWave'),
        (['bench', '--quik'], 'unrecognized'),
        (['bench', '--out', '/proc/self/x'], 'cannot make'),
        (['bench', '--json', '/no/such/folder/x.json'], 'does not exist'),
        (['bench', '--doc', '/no/such/folder'], 'no file'),
        (['bench', '--before', '/no/such/bench.json'], 'give --out'),
        (['bench', '--out', '.', '--before', '/no/such/bench.json'], 'is no bench.json'),
        (['bench', '--threads', '2'], 'of each run itself'),
])
def test_wrongOptionsEndInOneLineAndStatus2(capsys, argv, word):
	assert cli.main(argv) == 2
	shown = capsys.readouterr()
	assert word in shown.err and shown.err.count('\n') == 1 and not shown.out


def test_planCoversEveryCaseWithNamesOfItsOwn():
	for isQuick in (True, False):
		jobs = plan.plan(isQuick)
		names = [plan.name(j) for j in jobs]
		assert len(set(names)) == len(names), sorted(n for n in names if names.count(n) > 1)
		assert {j['case'] for j in jobs} == set(plan.CASES) == set(process.MODULES)
		assert {j['rule'] for j in jobs} == {'affine', 'inversePower', 'meanDistance'} and {True, False} == {j['sleeping'] for j in jobs} and {1, 2} == {j['threads'] for j in jobs}
	assert all(j['threads'] == 1 for j in plan.plan(True, cores=1)) and {j['case'] for j in plan.plan(False, ['law'])} == {'law'}
	with pytest.raises(ValueError, match='colour'):
		plan.job('law', 'McaEngine', 10, colour=1)


@pytest.mark.parametrize('case, solver, n, options', [
        ('elasticWave', 'automata', 3, {}),
        ('elasticWave', 'grid', 3, {}),
        ('elasticWave', 'coupled', 3, {}),
        ('plasticShock', 'automata', 40, {}),
        ('taylorBar', 'automata', 4, {}),
        ('plateWave', 'coupled', 12, {}),
        ('penetration', 'coupled', 5, dict(until=5.)),
        ('law', 'McaEngine', 400, dict(short=True)),
        ('law', 'CpmMat', 400, dict(short=True)),
        ('space', 'McaEngine', 500, dict(short=True, kind='johnsonCook')),
])
def test_recordOfATinyRun(plugin, case, solver, n, options):
	r = process.execute(plan.job(case, solver, n, **options))
	assert isinstance(r['processor'], str) and r['processorSeconds'] > 0
	assert RECORD - set(r) <= {'error', 'energyError', 'wall'} and not r.get('ended'), r
	assert r['steps'] > 0 and r['stepping'] > 0 and r['memory'] > 50 and (r['automata'] > 0) == (solver != 'grid') and (r['cells'] > 0) == (solver in ('grid', 'coupled'))
	spent = sum(v for v in r['phasesPerStep'].values()) * r['steps'] * 1e-9
	assert spent == pytest.approx(r['stepping'], rel=1e-9)  # no time is lost between the phases
	# the rest is below zero where the processor time is less than the timers say: other processes had the processor inside a phase
	assert all(math.isfinite(v) and (v > -1 or k == 'rest') for k, v in r['phases'].items()), r['phases']
	if case in ('elasticWave', 'plasticShock'): assert 0 < r['error'] < 0.3 and 0 <= r['energyError'] < 0.05
	if solver in ('automata', 'coupled', 'McaEngine'): assert r['phases']['density'] > 0 and r['phases']['integration'] > 0
	if solver in ('grid', 'coupled'): assert r['phases']['cells'] > 0


def test_halvingTheSpacingQuartersTheErrorOfAWave(plugin):
	for solver in ('automata', 'grid'):
		a, b = (process.execute(plan.job('elasticWave', solver, n))['error'] for n in (3, 6))
		assert 3 < a / b < 5, solver


def test_aRunInItsOwnProcess(plugin):
	r = process.measured(plan.job('elasticWave', 'grid', 3, threads=2))
	assert r['threads'] == 2 and r['wall'] > r['stepping'] and r['name'] == 'elasticWave/grid/N3/2threads' and 'started' not in r


def test_whatEndsARunIsAResultAndWhatBreaksItAFailure(plugin):
	r = process.execute(plan.job('taylorBar', 'automata', 4, rule='nothing'))
	assert 'volumeRule' in r['ended']
	report = Report('t')
	results.add(report, [dict(r, mayEnd=True), dict(r, mayEnd=False), dict(plan.job('law', 'Law2', 9), name='x', failed='killed')])
	assert [c.passed for c in report.cases] == [False, False]


def test_paretoFront():
	cost, error = np.array([1., 2., 3., 4., 2.5, 1.]), np.array([9., 4., 4., 1., 8., 10.])
	assert plots.paretoFront(cost, error).tolist() == [0, 1, 3]


def made(case, solver, n, stepping, **options):
	extra = {k: options.pop(k) for k in ('error', 'result', 'signal', 'automataNs') if k in options}
	j = plan.job(case, solver, n, **options)
	phases = dict(density=10., pairs=20., cells=5.)
	return dict(j, name=plan.name(j), stepping=stepping, timers=stepping, built=.1, wall=2., steps=10, automata=n * n, cells=0, simulated=1e-6, energyError=1e-3, phases=phases, phasesPerStep=phases, memory=100., load=1.,
	            compiler='GCC', isa='x86-64', processor='p', commit='c', version='v', cellNs=None, **{'error': None, 'automataNs': 10., **extra})


def example():
	t = np.linspace(0, 6e-5, 50)
	wave = lambda e: np.stack((t, (1 + e) * np.sin(1e5 * t))).tolist()
	records = [made('elasticWave', s, n, c * n**3, error=e / n**2) for s, c, e in (('automata', 1e-3, 1.), ('grid', 1e-4, .5)) for n in (3, 6, 12)] + [made('elasticWave', 'automata', 6, .1, rule='inversePower', error=.03)]
	records += [made('plateWave', 'automata', n, 1e-4 * n**3, signal=wave(0 if n == 48 else n**-2.)) for n in (12, 24, 48)] + [made('plateWave', 'coupled', 24, 0.25e-4 * 24**3, signal=wave(24**-2.))]
	records += [made('penetration', 'coupled', n, .1, result=dict(lengthLoss=.3 + .3 / n, velocityLossAll=.1, velocityLossTail=.04)) for n in (10, 1000000)] + [
	        made('penetration', 'automata', 10, .2, result=dict(lengthLoss=.3, velocityLossAll=.1, velocityLossTail=.04))]
	records += [made('law', 'McaEngine', 100, .01, automataNs=50.), made('law', 'McaEngine', 100, .005, automataNs=25., threads=2), made('law', 'CpmMat', 100, .2, automataNs=1000.),
	            made('law', 'Law2', 100, .2, automataNs=1000., kind='elastic')]
	records += [dict(made('space', 'McaEngine', 10000, .02 / threads, automataNs=150. / threads, threads=threads), bytes=3000.) for threads in (1, 2)]
	return results.giveErrors(records)


def test_errorsAgainstTheFinestRun():
	records = {r['name']: r for r in example()}
	assert records['plateWave/automata/w120/N12']['error'] == pytest.approx(12**-2., rel=1e-6)
	assert records['plateWave/automata/w120/N48']['error'] is None and records['plateWave/coupled/w120/N24']['against'] == 'plateWave/automata/w120/N48'
	assert records['penetration/coupled/w120/N10']['error'] == pytest.approx(.1 / math.sqrt(2), rel=1e-4)


def test_ratios():
	records = example()
	(row, ) = results.equalError(records)
	assert row[:2] == (120, 24) and row[5] == pytest.approx(4.) and row[6]  # the same error in a quarter of the time
	assert results.widths(records)[0][:5] == (120, 10, .1, .2, 2.)
	assert results.speedUps(records) == [(name, pytest.approx(2.), 1.) for name in ('law/McaEngine/N100', 'space/McaEngine/N10000')]
	assert {r[3]: r[5] for r in results.peers(records) if r[2] == 1} == {'McaEngine': 1., 'CpmMat': 20., 'Law2': None}
	report = Report('t')
	results.add(report, records)
	cases = {c.name: c for c in report.cases}
	assert cases['law/N100/plastic/1threads/CpmMatOverMcaEngine'].passed and cases['law/N100/plastic/1threads/CpmMatOverMcaEngine'].limit == 12
	for c in report.cases:  # an aim that is not asserted is not printed as a reference
		assert c.limit is not None or (c.reference is None and not c.asserted), c.name
	assert cases['law/N100/plastic/1threads/McaEngine'].value == records[[r['name'] for r in records].index('law/McaEngine/N100')]['automataNs']
	slow = Report('t')
	results.add(slow, [dict(r, automataNs=170., timers=.02) if r['case'] == 'space' else r for r in records])
	assert [c.name for c in slow.failed] == ['space/McaEngine/N10000', 'space/McaEngine/N10000/2threads']  # 160 ns, 1.8 times
	slow = Report('t')
	results.add(slow, [dict(r, automataNs=500.) if r['solver'] == 'CpmMat' else r for r in records])
	assert [c.name for c in slow.failed] == ['law/N100/plastic/1threads/CpmMatOverMcaEngine']
	for load, passed in ((1., False), (5., True)):  # two threads are held to the target on an idle machine only
		r = Report('t')
		results.add(r, [dict(x, load=load, timers=.009) if x['threads'] == 2 else x for x in records])
		assert next(c for c in r.cases if c.name == 'law/McaEngine/N100/2threads').passed is passed


def test_picturesAndTables(tmp_path):
	records = [{k: v for k, v in r.items() if k != 'signal'} for r in example()]
	for name, draw in pictures.PICTURES.items():
		picture = draw(tmp_path / name, records)
		assert (tmp_path / picture).read_bytes().startswith(b'\x89PNG') and (tmp_path / picture).stat().st_size > 10000
	(tmp_path / 'bench.json').write_text(json.dumps(dict(records=records, kernels=dict(bench_grid=[dict(name='step<Feature::plastic>/64/1', time=1., ns_per_cell=17.)]))))
	assert cli.main(['bench', '--doc', str(tmp_path)]) == 0
	text = {p.stem: p.read_text() for p in tmp_path.glob('*.inc')}
	assert len(text) == 8 and all('.. list-table::' in t for t in text.values())
	assert '- 150' in text['bench-space'] and '- 20.0' in text['bench-law'] and 'ns_per_cell 17' in text['bench-kernels'] and 'inversePower' in text['bench-options'] and '- 4.0' in text['bench-equal']


def test_aFolderKeepsTheCasesThatAreNotRunAgain(tmp_path, monkeypatch):
	monkeypatch.setattr(process, 'measured', lambda j: dict(made(j['case'], j['solver'], j['n'], 1., error=.1), name=plan.name(j)))
	monkeypatch.setattr(plan, 'quick', lambda: [plan.job('elasticWave', 'grid', 3), plan.job('plasticShock', 'grid', 3)])
	monkeypatch.setattr(google, 'run', lambda quick: ({}, ['not built']))
	out = ['--quick', '--out', str(tmp_path), '--json', str(tmp_path / 'x.json')]
	assert cli.main(['bench', *out]) == 0 and cli.main(['bench', *out, '--only', 'plasticShock']) == 0
	assert [r['case'] for r in json.loads((tmp_path / 'bench.json').read_text())['records']] == ['elasticWave', 'plasticShock']
	old = tmp_path / 'old.json'
	old.write_text(json.dumps(dict(records=[made('elasticWave', 'grid', 3, 7., error=.25)])))
	assert cli.main(['bench', *out, '--before', str(old)]) == 0 and cli.main(['bench', *out, '--only', 'elasticWave']) == 0
	kept = json.loads((tmp_path / 'bench.json').read_text())['before']  # once given, it stays
	assert [(r['name'], r['stepping'], 'phases' in r) for r in kept] == [('elasticWave/grid/N3', 7., False)]
	assert cli.main(['bench', '--doc', str(tmp_path)]) == 0
	table = (tmp_path / 'bench-front.inc').read_text()
	assert 'time before [s]' in table and '- 7.000' in table and '- 0.25' in table
	assert len((tmp_path / 'bench.jsonl').read_text().splitlines()) == 2 and all(json.loads(x) for x in (tmp_path / 'bench.jsonl').read_text().splitlines())
	assert bench.line(dict(name='a', ended='because')).endswith('because')


def test_theFasterOfTwoRunsWithTheSameLibraries():
	slow, fast = made('law', 'Law2', 9, 2., error=1.), made('law', 'Law2', 9, 1., error=1.)
	other = made('law', 'Law2', 10, 3.)
	assert bench.fastest([fast, other], [slow]) == [fast, other] and bench.fastest([slow], [fast, other]) == [fast, other]
	assert bench.fastest([dict(fast, build='older')], [dict(slow, build='new')]) == [dict(slow, build='new')]


def test_programsThatAreNotBuiltAreSaidSo(tmp_path):
	assert google.run(True, tmp_path) == ({}, ['bench_grid is not built (build target bench_grid)', 'bench_automata is not built (build target bench_automata)',
	                                                'bench_space is not built (build target bench_space)'])
	(tmp_path / 'bench_grid').write_text('#!/bin/sh\necho \'{"benchmarks": [{"name": "a", "time_unit": "us", "real_time": 2.0, "run_type": "iteration", "ns_per_cell": 3.0}]}\'\n')
	(tmp_path / 'bench_grid').chmod(0o755)
	found, remarks = google.run(False, tmp_path)
	assert found == dict(bench_grid=[dict(name='a', time=2000., ns_per_cell=3.)]) and len(remarks) == 2
	row, report = dict(name='step<Feature::johnsonCook>/256/1/min_time:0.200/real_time', time=1.), Report('t')
	google.add(report, dict(bench_grid=[dict(row, ns_per_cell=24.), dict(row, ns_per_cell=26.), dict(name='step<Feature::plastic>/256/1', time=1., ns_per_cell=99.)]))
	assert [c.passed for c in report.cases] == [True, False, True] and [c.limit for c in report.cases] == [25., 25., None]
