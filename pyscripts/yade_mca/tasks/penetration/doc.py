# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables of the documentation of the penetration study (reStructuredText) from stored results; nothing in them is typed by hand."""
import json
import os

from . import report as results

LOSSES = ('lengthLoss', 'velocityLossTail', 'velocityLossAll')
HEADS = ('dl/l0', 'dU/U0, tail', 'dU/U0, all')


def listTable(title, head, rows):
	lines = ['.. list-table:: %s' % title, '   :header-rows: 1', '']
	for r in [head, *rows]:
		for k, cell in enumerate(r):
			lines.append('   %s - %s' % ('*' if k == 0 else ' ', cell))
	return '\n'.join(lines) + '\n'


def number(x, digits=3):
	return '' if x is None else '%.*f' % (digits, x)


def valuesOf(data):
	return {c['name']: c['value'] for c in data['cases']}


def madeBy(data, command):
	return 'Made by ``pyscripts/run %s`` (%s, %d threads, %.0f s).\n' % (command, (data['commit'] or data['version'])[:10], data['threads'], data['wall'])


def table1(data):
	rows = [('%g' % r['thickness'], r['mode'], number(r['lengthLoss']), number(r['lengthLossUnbroken']), number(r['atExit/lengthLossGeometric']), number(r['publishedLengthLoss'], 2), number(r['tateLengthLoss']), number(r['velocityLossTail']),
	         number(r['velocityLossAll']), number(r['publishedVelocityLoss'], 2), number(r['tateVelocityLoss'])) for r in data['table1']['rows']]
	head = ('plate [mm]', 'mode', 'dl/l0 by mass', 'by mass, with head', 'as length, at exit', 'published', 'Tate', 'dU/U0, tail', 'dU/U0, all', 'published', 'Tate')
	worst = max(c['value'] for c in data['cases'] if c['name'].endswith('energyError'))
	return listTable('Six thicknesses in both modes', head, rows) + '\nLargest drift of the independent energy sum: %.1f %%. ' % (100 * worst) + madeBy(data, 'table1')


def convergence(data):
	v = valuesOf(data)
	rows = []
	for name in dict.fromkeys(n.rsplit('/', 2)[0] for n in v if '/at' in n):
		spacing, mode = name.split('/')[-2:]
		for t in (42, 80):
			rows.append((spacing[1:], mode, '%d' % t, *(number(v['%s/at%dus/%s' % (name, t, k)], 4 if 'U' not in k else 3) for k in LOSSES), number(100 * v[name + '/energyError'], 2) + ' %'))
	for r in results.table('penetration_peers.csv'):
		if r['plate_mm'] == '25':
			rows.append((r['spacing_mm'], r['code'], r['time_us'], *(r[k] for k in LOSSES), ''))
	rows.sort(key=lambda r: (float(r[2]) > 50, -float(r[0])))
	return listTable('25 mm plate, fixed ends: spacing, and two independent codes with the same constants', ('d [mm]', 'mode or code', 't [us]', *HEADS, 'energy sum'), rows) + '\n' + madeBy(data, 'study convergence')


def seeds(data):
	v = valuesOf(data)
	rows = []
	for t in (42, 80):
		for k, head in zip(LOSSES, HEADS):
			rows.append((head, '%d' % t, *('%.4f +- %.4f' % (v['study/seeds/%s/at%dus/%s/mean' % (m, t, k)], v['study/seeds/%s/at%dus/%s/deviation' % (m, t, k)]) for m in ('coupled', 'mca')),
			             number(v['study/seeds/modesDiffer/at%dus/%s' % (t, k)], 1)))
	return listTable('Ten seeds: mean and standard deviation', ('', 't [us]', 'coupled, 120 mm', 'mca, 80 mm', 'difference of the means [deviations]'), rows) + '\n' + madeBy(data, 'study seeds')


def options(data):
	v = valuesOf(data)
	names = dict.fromkeys(c['name'].split('/')[2] for c in data['cases'])
	rows = []
	for n in names:
		key = 'study/options/' + n
		failed = next((c['unit'] for c in data['cases'] if c['name'] == key), None)
		if failed:
			rows.append((n.replace('_', ' '), 'ended: ' + failed.split(' Remedy')[0].split(': ', 1)[-1], '', '', '', ''))
		else:
			rows.append((n.replace('_', ' '), *(number(v['%s/at80us/%s' % (key, k)]) for k in LOSSES), number(100 * v[key + '/energyError'], 2) + ' %', number(v[key + '/wall'], 0)))
	return listTable('One option at a time, coupled, at 80 us', ('option', *HEADS, 'energy sum', 'time [s]'), rows) + '\n' + madeBy(data, 'study options')


def width(data):
	v = valuesOf(data)
	runs = (('coupled, 80 mm of automata', 'coupled'), ('coupled, 60 mm of automata', 'coupled60'), ('automata only', 'mca'))
	rows = [(text, *(number(v['study/width400/%s/at80us/%s' % (m, k)]) for k in LOSSES), number(v['study/width400/%s/wall' % m], 1)) for text, m in runs]
	gains = '\nThe coupled runs are %.1f and %.1f times as fast as automata everywhere. ' % (v['study/width400/gain'], v['study/width400/gain60'])
	return listTable('A plate 400 mm wide, at 80 us', ('mode', *HEADS, 'time [s]'), rows) + gains + madeBy(data, 'study width')


def write(folder):
	"""Writes FOLDER/penetration-NAME.inc of each result FOLDER/NAME.json there is; returns their names."""
	from ..report import writeAtomically
	done = []
	for name, make in (('table1', table1), ('study-convergence', convergence), ('study-seeds', seeds), ('study-options', options), ('study-width', width)):
		path = os.path.join(folder, name + '.json')
		if os.path.exists(path):
			with open(path) as f:
				writeAtomically(os.path.join(folder, 'penetration-%s.inc' % name), make(json.load(f)))
			done.append(name)
	return done
