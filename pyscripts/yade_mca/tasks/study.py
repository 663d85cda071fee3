# SPDX-License-Identifier: GPL-2.0-or-later
"""`study`: how the result of the penetration task depends on spacing, seeds, options and width, with plots. Hours on a coarse machine: pick parts.

    convergence  25 mm plate at spacings 25/12, 1, 0.5 (and 0.25 with --fine) mm, coupled, and beside the two independent codes
    seeds        ten seeds in both modes
    options      one option at a time away from the default
    width        a plate 400 mm wide: coupled, and automata everywhere
"""
import math
import os

import numpy as np

from .penetration import options, report as results
from . import registry
from .attempts import Attempts
from .cli import positive
from .report import Report
from .table1 import runAll

SUMMARY = registry.SUMMARIES['study']
PARTS = ('convergence', 'seeds', 'options', 'width')
LOSSES = ('lengthLoss', 'velocityLossTail', 'velocityLossAll')
LABELS = {'lengthLoss': 'dl/l0', 'velocityLossTail': 'dU/U0 of the tail', 'velocityLossAll': 'dU/U0 of all'}
TIMES = (42, 80)
SEEDS = range(1, 11)
VARIANTS = [{}, dict(volume_rule='inversePower'), dict(volume_rule='meanDistance'), dict(viscosity=0.5), dict(viscosity=2.), dict(fracture_strain=0.5), dict(fracture_strain=2.),
            dict(spall=0.5), dict(spall=2.), dict(friction=0.), dict(friction=0.3), dict(spread=0.), dict(spread=0.2), dict(eos='mieGruneisen'), dict(yield_model='linearHardening'),
            dict(yield_model='perfect'), dict(ends='viscous'), dict(ends='free'), dict(width=200.), dict(dt_factor=0.1)]


def addArguments(parser):
	parser.add_argument('parts', nargs='*', metavar='PART', help='of %s (default: all)' % ', '.join(PARTS))
	parser.add_argument('--doc', metavar='DIR', help='only make the tables of the documentation from the results in DIR (table1.json, study-PART.json)')
	parser.add_argument('--fine', action='store_true', help='convergence: 0.25 mm, too')
	parser.add_argument('--spacing', metavar='MM', type=positive(float, 'mm'), default=1., help='of seeds, options and width (default: 1)')
	parser.add_argument('--thickness', metavar='MM', type=positive(float, 'mm'), default=25., help='of the plate (default: 25)')


def check(args):
	for p in args.parts:
		if p not in PARTS:
			raise registry.UsageError("part '%s' is not one of %s" % (p, ', '.join(PARTS)))
	if args.doc and not os.path.isdir(args.doc):
		raise registry.UsageError("--doc: folder '%s' does not exist" % args.doc)
	args.parts = args.parts or list(PARTS)
	options.fill(args)


def losses(result):
	"""{(time [us], loss): value} and wall-clock seconds of a run."""
	c = {x['name'].split('/', 2)[2]: x['value'] for x in result['cases']}
	return {(t, k): c['at%dus/%s' % (t, k)] for t in TIMES for k in LOSSES}, c['wall'], c['energyError']


def do(jobs, args, progress, label):
	"""Runs {key: options} to 80 us; {key: (losses, wall, energy error) or the error's text}."""
	base = dict(thickness=args.thickness, spacing=args.spacing, until=float(TIMES[-1]))
	threads = args.threads or 1
	found = runAll({k: options.commandLine(**dict(base, **o)) for k, o in jobs.items()}, progress, label, threads=threads)
	return {k: r['error'] if r.get('error') else losses(r) for k, r in found.items()}


def convergence(report, args, progress, attempt):
	spacings = [args.thickness / 12, 1., 0.5] + ([0.25] if args.fine else [])
	jobs = {(d, mode): dict(spacing=d, mode=mode, ends='fixed') for d in spacings for mode in ('coupled', 'mca')}
	found = do(jobs, args, progress, 'convergence')
	for (d, mode), f in found.items():
		add(report, 'study/convergence/d%.3g/%s' % (d, mode), f)
	if args.out and not any(isinstance(f, str) for f in found.values()):
		curves = {(mode, t, k): [found[d, mode][0][t, k] for d in spacings] for mode in ('coupled', 'mca') for t in TIMES for k in LOSSES}
		path = os.path.join(args.out, 'convergence.png')
		attempt(path, picture, path, spacings, curves)


def add(report, name, f):
	if isinstance(f, str):
		report.add(name, math.nan, unit=f)
		return
	for (t, k), v in f[0].items():
		report.add('%s/at%dus/%s' % (name, t, k), v)
	report.add(name + '/wall', f[1], unit='s')
	report.add(name + '/energyError', f[2])


def seeds(report, args, progress, attempt):
	jobs = {(mode, n): dict(mode=mode, seed=n, ends='fixed') for mode in ('coupled', 'mca') for n in SEEDS}
	found = do(jobs, args, progress, 'seeds')
	values = {}
	for key, f in found.items():
		if isinstance(f, str): add(report, 'study/seeds/%s/%d' % key, f)
	found = {k: f for k, f in found.items() if not isinstance(f, str)}
	if len(found) < len(jobs):
		return
	for mode in ('coupled', 'mca'):
		for t in TIMES:
			for k in LOSSES:
				v = np.array([found[mode, n][0][t, k] for n in SEEDS])
				values[mode, t, k] = v
				report.add('study/seeds/%s/at%dus/%s/mean' % (mode, t, k), v.mean())
				report.add('study/seeds/%s/at%dus/%s/deviation' % (mode, t, k), v.std(ddof=1))
	for t in TIMES:
		for k in LOSSES:  # both modes are one answer within the scatter: means within three standard errors of their difference or within one deviation
			a, b = values['coupled', t, k], values['mca', t, k]
			spread = max(a.std(ddof=1), b.std(ddof=1))
			report.add('study/seeds/modesDiffer/at%dus/%s' % (t, k), abs(a.mean() - b.mean()) / spread, limit=3., unit='deviations over seeds')
	report.extra['seeds'] = {'%s/%d/%s' % key: v.tolist() for key, v in values.items()}


def label(variant):
	return ', '.join('%s %s' % (k.replace('_', ' '), v) for k, v in variant.items()) or 'default'


def variants(report, args, progress, attempt):
	found = do({label(v): v for v in VARIANTS}, args, progress, 'options')
	for name, f in found.items():
		add(report, 'study/options/' + name.replace(' ', '_'), f)
	if args.out:
		path = os.path.join(args.out, 'options.png')
		attempt(path, bars, path, found)


def width(report, args, progress, attempt):
	jobs = {'coupled': dict(mode='coupled', width=400., ends='fixed'), 'coupled60': dict(mode='coupled', width=400., automata_width=60., ends='fixed'),
	        'mca': dict(mode='mca', automata_width=400., ends='fixed')}
	found = {}
	for k, o in jobs.items():  # one after the other: their times are compared
		found.update(do({k: o}, args, progress, 'width 400 mm, ' + k))
		add(report, 'study/width400/' + k, found[k])
	if any(isinstance(f, str) for f in found.values()):
		return
	for name in ('coupled', 'coupled60'):
		ratio = found['mca'][1] / found[name][1]
		report.add('study/width400/gain' + name[7:], ratio, limit=5., unit='times', passed=ratio >= 5.)
		for t in TIMES:
			for k in LOSSES:
				report.add('study/width400/difference%s/at%dus/%s' % (name[7:], t, k), abs(found['mca'][0][t, k] - found[name][0][t, k]))


def picture(path, spacings, curves):
	"""Losses against spacing, with what the independent codes give as bands."""
	from .. import plots
	plt, peers = plots.plt, results.table('penetration_peers.csv')
	with plt.rc_context(plots.STYLE):
		figure, axes = plt.subplots(1, 3, figsize=(10, 3.4))
		for ax, k in zip(axes, LOSSES):
			for t, colour in zip(TIMES, ('C0', 'C1')):
				for mode, style in (('coupled', 'o-'), ('mca', 's--')):
					ax.semilogx(spacings, curves[mode, t, k], style, color=colour, ms=4, lw=1, label='%s, %d us' % (mode, t))
				near = [r for r in peers if float(r['plate_mm']) == 25 and (abs(float(r['time_us']) - t) < 11 if t > 50 else abs(float(r['time_us']) - t) < 2)]
				for name, marker in (('Karamelo', 'x'), ('ULSPH', '+')):
					rows = [r for r in near if r['code'] == name]
					ax.semilogx([float(r['spacing_mm']) for r in rows], [float(r[k]) for r in rows], marker, color=colour, ms=6, label='%s, about %d us' % (name, t))
			ax.set(xlabel='d [mm]', title=LABELS[k], ylim=(0, None))
		axes[0].legend(fontsize=6)
		return plots.save(figure, path)


def bars(path, found):
	"""Each variant's losses at the last time, with the default as a line."""
	from .. import plots
	plt = plots.plt
	ok = {k: f for k, f in found.items() if not isinstance(f, str)}
	names = list(ok)
	with plt.rc_context(plots.STYLE):
		figure, axes = plt.subplots(1, 3, sharey=True, figsize=(10, 0.22 * len(names) + 1.2))
		for ax, k in zip(axes, LOSSES):
			for t, colour in zip(TIMES, ('C0', 'C1')):
				ax.plot([ok[n][0][t, k] for n in names], range(len(names)), 'o', color=colour, ms=4, label='%d us' % t)
				if 'default' in ok: ax.axvline(ok['default'][0][t, k], color=colour, lw=0.6)
			ax.set(title=LABELS[k], xlim=(0, None))
		axes[0].set_yticks(range(len(names)), names)
		axes[0].invert_yaxis()
		axes[0].legend(fontsize=7)
		return plots.save(figure, path)


def run(args, report, progress):
	if args.doc:
		from .penetration import doc as penetration_doc
		print('made from', ', '.join(penetration_doc.write(args.doc)) or 'nothing')
		return
	attempt = Attempts('study')
	for part in args.parts:  # a report of its own each, for its file and its time
		own = Report('study ' + part)
		{'convergence': convergence, 'seeds': seeds, 'options': variants, 'width': width}[part](own, args, progress, attempt)
		if args.out:
			path = os.path.join(args.out, 'study-%s.json' % part)
			attempt(path, own.write, path)
		report.cases += own.cases
		report.extra.update(own.extra)
	attempt.finish()
