# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures of `bench` from its records: time against error, cost against size, cost by phase."""

from ... import plots
from .plan import LAWS, variants

COLOURS = {'automata': 'C0', 'grid': 'C1', 'coupled': 'C2', 'Law2': 'C3', 'CpmMat': 'C4', 'CohFrictMat': 'C5', 'McaEngine': 'C0'}
TITLES = dict(elasticWave='elastic wave', plasticShock='plastic shock', taylorBar='Taylor bar', plateWave='plate with a wave', penetration='penetration, 25 mm')
#: phase -> colour, in the order of the bars
PHASES = {'neighbours': '#4c72b0', 'density': '#55a868', 'pairs': '#c44e52', 'forces': '#dd8452', 'contacts': '#8172b3', 'fracture': '#937860', 'integration': '#da8bc3', 'writeBack': '#64b5cd',
          'rest': '#8c8c8c', 'McaTimeStepper': '#bcbd22', 'cells': '#1f4e79', 'nodes': '#7f9fbf', 'interface': '#000000'}


def short(r):
	return ' '.join(['N%d' % r['n'], *variants(r)])


def panels(records):
	"""(title, records with time and error) of each panel: one per case, plates with a wave by width. The titles tell the panels apart."""
	found = []
	for case, title in TITLES.items():
		of = [r for r in records if r['case'] == case and r.get('error') and r.get('stepping')]
		for width in sorted({r.get('width') for r in of if case == 'plateWave'}) or [None]:
			some = [r for r in of if width is None or r['width'] == width]
			if some: found.append((title + (', %d mm' % width if width else ''), some))
	return found


def front(path, records, before=()):
	"""Run time against error of every run, one panel per case, log-log, with the Pareto front; runs with an option changed are hollow.

	before: records of an older result, whose fronts stand beside in grey.
	"""
	plt, found, old = plots.plt, panels(records), dict(panels(before))
	columns = min(4, max(1, len(found)))
	rows = -(-len(found) // columns) or 1
	with plt.rc_context(plots.STYLE):
		figure, axes = plt.subplots(rows, columns, figsize=(3.6 * columns, 3.2 * rows), squeeze=False)
		for ax in axes.flat[len(found):]:
			ax.axis('off')
		for ax, (title, some) in zip(axes.flat, found):
			plots.drawPareto(ax, [r['stepping'] for r in some], [r['error'] for r in some], [short(r) for r in some], [r['solver'] for r in some], COLOURS, [bool(variants(r)) for r in some])
			plots.drawOldPareto(ax, [r['stepping'] for r in old.get(title, ())], [r['error'] for r in old.get(title, ())])
			ax.set(title=title, xlabel='time of the steps [s]')
			ax.legend(fontsize=6)
		for ax in axes[:, 0]:
			ax.set_ylabel('error')
		figure.tight_layout()
		return plots.save(figure, path)


def size(path, records, before=()):
	"""Left: ns per automaton (cell) and step against their number. Right: time per simulated microsecond against size."""
	plt = plots.plt
	with plt.rc_context(plots.STYLE):
		figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
		curves = {}
		for r in records:
			if not r.get('stepping'): continue
			if r['case'] == 'law' and r['kind'] == 'plastic': curves.setdefault(('%s, plastic' % r['solver'], r['threads'], COLOURS[r['solver']]), []).append((r['automata'], r['automataNs']))
			if r['case'] == 'elasticWave' and r['solver'] == 'grid' and set(variants(r)) <= {'2threads'}: curves.setdefault(('grid, elastic wave', r['threads'], 'C1'), []).append((r['cells'], r['cellNs']))
		for (label, threads, colour), points in curves.items():
			left.loglog(*zip(*sorted(points)), 'o-' if threads == 1 else 's--', color=colour, ms=4, lw=1, label='%s, %d thread%s' % (label, threads, 's' * (threads > 1)))
		left.set(xlabel='automata or cells', ylabel='ns per automaton (cell) and step')
		for k, case in enumerate(TITLES):
			for solver, style in (('automata', 'o-'), ('coupled', 's--'), ('grid', '^:')):
				some = sorted((r['automata'] + r['cells'], 1e-6 * r['stepping'] / r['simulated']) for r in records if r['case'] == case and r['solver'] == solver and r.get('stepping') and not variants(r) and r.get('width', 120) == 120)
				if some: right.loglog(*zip(*some), style, color='C%d' % k, ms=4, lw=1, label='%s, %s' % (TITLES[case], solver))
		right.set(xlabel='automata and cells', ylabel='time per simulated microsecond [s]')
		for ax in (left, right):
			if ax.lines: ax.legend(fontsize=6)
		return plots.save(figure, path)


def shown(records):
	"""Records of the bars: the finest default run of each case and solver, and all default runs of penetration at 120 mm."""
	found = {}
	for r in records:
		if r.get('phasesPerStep') and not variants(r) and r['case'] not in LAWS and r.get('width', 120) == 120 and r['solver'] not in ('Law2', 'CpmMat', 'CohFrictMat'):
			key = (r['case'], r['solver'], r['n'] if r['case'] == 'penetration' else 0)
			if key not in found or found[key]['n'] < r['n']: found[key] = r
	return list(found.values())


def phases(path, records, before=()):
	"""Stacked bars: ns per step over automata and cells, by phase."""
	plt, some = plots.plt, shown(records)
	with plt.rc_context(plots.STYLE):
		figure, ax = plt.subplots(figsize=(9, 0.28 * len(some) + 1.4))
		ends = [0.] * len(some)
		for phase, colour in PHASES.items():
			lengths = [(r['phasesPerStep'].get(phase) or 0.) / (r['automata'] + r['cells']) for r in some]
			if any(lengths): ax.barh(range(len(some)), lengths, left=ends, color=colour, label=phase)
			ends = [a + b for a, b in zip(ends, lengths)]
		ax.set_yticks(range(len(some)), ['%s, %s, N%d' % (TITLES[r['case']], r['solver'], r['n']) for r in some], fontsize=7)
		ax.set(xlabel='ns per step over automata and cells')
		ax.invert_yaxis()
		if some: ax.legend(fontsize=6, ncols=2)
		return plots.save(figure, path)


#: name -> function(path, records, records of an older result) that draws it
PICTURES = {'bench-front.png': front, 'bench-size.png': size, 'bench-phases.png': phases}
