# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables of the page on performance (reStructuredText) from bench.json; nothing in them is typed by hand."""
import json
import os
import re

from ..penetration.doc import listTable, number
from ..report import writeAtomically
from . import results
from .plan import ERRORS, LAWS, RESOLUTION, variants
from .plots import PHASES, TITLES, shown

KINDS = {'elastic': 'elastic', 'johnsonCook': 'Johnson-Cook', 'plastic': 'plastic', 'fracture': 'plastic, links break', 'random': 'plastic, bodies in random order'}


def madeBy(records):
	"""One line: commits, machine, load of these records."""
	if not records:
		return ''
	one = lambda k: ', '.join(sorted({str(r[k])[:10] if k == 'build' else str(r[k]) for r in records if r.get(k)}))
	loads = [r['load'] for r in records if r.get('load') is not None]
	return '\nMade by ``pyscripts/run bench`` (libraries of commit %s; %s; %s, %s; load of the machine before a run %.1f to %.1f).\n' % (one('build'), one('processor'), one('compiler'), one('isa'), min(loads), max(loads))


def law(records):
	rows = {}
	for n, kind, threads, road, ns, ratio, load in results.peers(records):
		rows.setdefault((road, kind, n), {})[threads] = (ns, ratio)
	ratios = {name: ratio for name, ratio, _ in results.speedUps(records)}
	speed = {(r['solver'], r['kind'], r['n']): ratios.get(r['name']) for r in records if r['case'] == 'law' and r['threads'] == 1}
	lines = []
	for (road, kind, n), of in sorted(rows.items(), key=lambda x: (x[0][2], list(KINDS).index(x[0][1]), x[1].get(1, (0, ))[0])):
		one, two = of.get(1), of.get(2)
		lines.append((road, KINDS[kind] if road in ('McaEngine', 'Law2') else 'its own', '%d' % n, number(one and one[0], 0), number(two and two[0], 0), number(speed.get((road, kind, n)), 2),
		              number(one and one[1], 1), number(two and two[1], 1)))
	head = ('law', 'material', 'automata', 'ns, 1 thread', 'ns, 2 threads', '1 over 2 threads', 'over McaEngine, 1 thread', '2 threads')
	return listTable('Nanoseconds per automaton and step', head, lines) + targets(records) + madeBy([r for r in records if r['case'] == 'law'])


def space(records):
	"""Cost in space by material, size and threads."""
	ratios, of = {name: ratio for name, ratio, _ in results.speedUps(records)}, [r for r in records if r['case'] == 'space' and r.get('automataNs')]
	lines = [(KINDS[r['kind']], '%d' % r['n'], number(r['automataNs'], 0), number(ratios.get(r['name']), 2), number(r['bytes'], 0)) for r in of if r['threads'] == 1]
	t = results.SPACE
	aim = '\nAim, plastic: at most %s ns; two threads at least %g times as fast.\n' % (', '.join('%g at %d' % (v, k) for k, v in t['nanoseconds'].items()), t['threads'])
	return listTable('In space', ('material', 'automata', 'ns, 1 thread', '1 over 2 threads', 'bytes with its body'), lines) + aim + madeBy(of) if lines else 'Not measured for these results.\n'


def targets(records):
	"""What was aimed at and what is reached, plastic material, as sentences."""
	law, t = [r for r in results.peers(records) if r[1] == 'plastic'], results.TARGETS
	each = lambda rows, form: ', '.join((form + ' at %d') % (v, n) for v, n in rows) or 'not measured'
	return ('\nCpmMat over McaEngine on one thread: %s (aim: at least %g). McaEngine on one thread: %s ns (aim: at most %s). Two threads over one: %s (aim: at least %g).\n' % (
	        each([(r[5], r[0]) for r in law if r[3] == 'CpmMat' and r[2] == 1 and r[5]], '%.1f'), t['peer'],
	        each([(r[4], r[0]) for r in law if r[3] == 'McaEngine' and r[2] == 1], '%.0f'), ', '.join('%g at %d' % (v, k) for k, v in t['nanoseconds'].items()),
	        each([(ratio, int(name.split('/N')[1])) for name, ratio, _ in results.speedUps(records) if re.fullmatch(r'law/McaEngine/N\d+', name)], '%.2f'), t['threads']))


def fronts(records, before=()):
	"""The runs on the front of each case and the default ones, beside the same runs of an older result."""
	from ...plots import paretoFront
	from .plots import panels
	rows, old = [], {r['name']: r for r in before}
	for title, some in panels(records):
		front = set(paretoFront([r['stepping'] for r in some], [r['error'] for r in some]))
		for i, r in sorted(enumerate(some), key=lambda x: x[1]['stepping']):
			if i in front or not variants(r):
				o = old.get(r['name'], {})
				rows.append((title, r['solver'], '%d' % r['n'], ', '.join(variants(r)), number(r['stepping'], 3), '%.2g' % r['error'], '%.1g' % r['energyError'] if r.get('energyError') is not None else '', 'x' if i in front else '',
				             *((number(o.get('stepping'), 3), '%.2g' % o['error'] if o.get('error') else '') if before else ())))
	head = ('case', 'solver', 'N', 'option', 'time of the steps [s]', 'error', 'energy', 'on the front', *(('time before [s]', 'error before') if before else ()))
	return listTable('Time against error', head, rows) + madeBy(records) + madeBy(before).replace('Made', 'Those before made')


def options(records):
	"""Each option against the default run of the same case, solver and resolution."""
	base = {(r['case'], r['solver'], r['n'], r.get('width')): r for r in records if not variants(r) and r['case'] not in LAWS}
	rows = []
	for r in records:
		b = base.get((r['case'], r['solver'], r['n'], r.get('width')))
		if r['case'] in LAWS or not variants(r) or not b: continue
		clock = 'stepping' if r['threads'] == 1 else 'timers'
		if r.get('ended'): rows.append((TITLES[r['case']], r['solver'], '%d' % r['n'], ', '.join(variants(r)), '', '', 'ended: ' + r['ended'].split('Remedy')[0][:100].replace('*', '').replace('`', '')))
		else: rows.append((TITLES[r['case']], r['solver'], '%d' % r['n'], ', '.join(variants(r)), number(r[clock] / b[clock], 2), '%.2g / %.2g' % (r['error'], b['error']) if r.get('error') and b.get('error') else '', ''))
	return listTable('One option at a time', ('case', 'solver', 'N', 'option', 'time over the default run\'s', 'error / that of the default run', ''), rows) + madeBy(records)


def phases(records):
	some = shown(records)
	names = [p for p in PHASES if any((r['phasesPerStep'].get(p) or 0) > 0 for r in some)]
	rows = [(TITLES[r['case']], r['solver'], '%d' % r['n'], '%d' % r['automata'], '%d' % r['cells'], *(number(r['phases'].get(p), 1) for p in names)) for r in some]
	return listTable('Nanoseconds per automaton (cells, nodes: per cell) and step', ('case', 'solver', 'N', 'automata', 'cells', *names), rows) + started(records) + madeBy(some)


def started(records):
	"""Start-up as a sentence."""
	times = sorted(r['start'] for r in records if r.get('start'))
	return '\nStart-up of Python, YADE and the plugin: %.1f s (median of %d processes).\n' % (times[len(times) // 2], len(times)) if times else ''


def equal(records):
	rows = [('%d' % w, '%d' % n, '%.2g' % e, number(c, 2), number(a, 2), number(q, 1) + ('' if inside else ' (extended)')) for w, n, e, c, a, q, inside in results.equalError(records)]
	head = ('width [mm]', 'N', 'error', 'coupled [s]', 'automata only, same error [s]', 'ratio')
	text = listTable('Plate with a wave: automata only against coupled at equal error', head, rows)
	rows = [('%d' % w, '%d' % n, number(c, 2), number(a, 2), number(q, 1), number(x, 4), number(y, 4)) for w, n, c, a, q, x, y in results.widths(records)]
	head = ('width [mm]', 'N', 'coupled [s]', 'automata only [s]', 'ratio', 'difference of dl/l0', 'of dU/U0, all')
	return text + '\n' + listTable('Penetration of 25 mm: both modes', head, rows) + madeBy([r for r in records if r['case'] in ('plateWave', 'penetration')])


def kernels(data):
	rows = []
	for program, of in data.get('kernels', {}).items():
		for r in of:
			values = {k: v for k, v in r.items() if k not in ('name', 'time')}
			rows.append((program, r['name'].replace('<', ' ').replace('>', ' '), ', '.join('%s %.3g' % (k, v) for k, v in values.items() if isinstance(v, (int, float)))))
	return listTable('Google Benchmark', ('program', 'case', 'counters'), rows) if rows else 'The programs were not run for these results.\n'


def what():
	rows = [(TITLES.get(c, c), RESOLUTION[c], ERRORS.get(c, '')) for c in RESOLUTION]
	return listTable('Cases', ('case', 'N counts', 'error'), rows)


def write(folder):
	"""Writes FOLDER/bench-NAME.inc of FOLDER/bench.json; returns their names."""
	with open(os.path.join(folder, 'bench.json')) as f:
		data = json.load(f)
	records, made = data['records'], []
	tables = dict(cases=lambda r: what(), law=law, space=space, front=lambda r: fronts(r, data.get('before', ())), options=options, phases=phases, equal=equal, kernels=lambda r: kernels(data))
	for name, make in tables.items():
		made.append('bench-%s.inc' % name)
		writeAtomically(os.path.join(folder, made[-1]), make(records))
	return made
