# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers of penetration runs: cases of the report, the text on the screen, and what they are compared with."""
import csv
import functools
import math
from pathlib import Path

TATE = dict(rhoP=17600., rhoT=7830., Y=1.5e9, R=5.0e9)  #: Alekseevskii-Tate line of the study
DATA = Path(__file__).resolve().parents[2] / 'data'
COLUMN = {'coupled': 'mca_grid', 'mca': 'mca_only'}
LENGTH_LIMIT = 0.04  #: allowed distance of the published dl/l0 from the range lengthLossUnbroken ... lengthLoss, for its scene and spacings up to 1 mm [-]
ROUNDING = 0.005  #: the published table has two digits
SUM_LIMIT, BOOKED_LIMIT, MOMENTUM_LIMIT = 0.01, 1e-10, 1e-12


def table(name):
	"""Rows of a data file as dicts; lines that start with # are its head."""
	with open(DATA / name, newline='') as f:
		return list(csv.DictReader(line for line in f if not line.startswith('#')))


def published(thickness, mode):
	"""(dl/l0, dU/U0) of Chertov et al. 2004, Table 1, for a plate of `thickness` [mm]; (None, None) where it has none."""
	for row in table('penetration_reference.csv'):
		if abs(float(row['plate_mm']) - thickness) < 1e-9:
			return float(row[COLUMN[mode] + '_dl']), float(row[COLUMN[mode] + '_dU'])
	return None, None


def experiment():
	"""The experiment of the published table: thickness [mm], lengthLoss, velocityLoss."""
	row = next(r for r in table('penetration_reference.csv') if r['exp_dl'])
	return dict(thickness=float(row['plate_mm']), lengthLoss=float(row['exp_dl']), velocityLoss=float(row['exp_dU']))


def tate(thickness, speed=1520., length=100., obliquity=0.):
	"""Alekseevskii-Tate losses of the rod at a plate of `thickness` [mm], along its flight at `obliquity` [degrees]; see exact.tatePlate."""
	return dict(_tate(thickness, speed, length, obliquity))


@functools.lru_cache  # a run asks for it several times
def _tate(thickness, speed, length, obliquity):
	from ...exact import tatePlate
	return tatePlate(1e-3 * length, 1e-3 * thickness / math.cos(math.radians(obliquity)), speed, **TATE)


def name(args):
	return 'T%g/%s%s' % (args.thickness, args.mode, '3d' if getattr(args, 'dimension', 2) == 3 else '')


def normal(args):
	"""True for the speed and direction of the published table."""
	return args.speed == 1520 and args.obliquity == 0


def isStudy(args):
	"""True for the scene of the published table, which is in plane strain, fine enough to be held against it."""
	return normal(args) and getattr(args, 'dimension', 2) != 3 and args.angle == 0 and args.rod_length == 100 and args.rod_diameter == 10 and args.spacing <= 1 and args.until is None


def add(report, run, args, wall):
	"""Adds the cases T../mode/... of a run and the whole record to the report."""
	n, last, sane = name(args), run.last, run.sane()
	length, velocity = published(args.thickness, args.mode) if normal(args) else (None, None)
	held = isStudy(args)
	off = lambda x, y: None if y is None else abs(x - y)
	for k in ('lengthLoss', 'lengthLossUnbroken'):
		report.add('%s/%s' % (n, k), last[k], length, error=off(last[k], length))
	report.add(n + '/lengthLossGeometric', last['lengthLossGeometric'])
	if held and length is not None:  # the source does not say what it calls intact
		beyond = max(last['lengthLossUnbroken'] - length - ROUNDING, length - ROUNDING - last['lengthLoss'], 0.)
		report.add(n + '/publishedLengthLoss', length, error=beyond, limit=LENGTH_LIMIT)
	tail = last['velocityLossTail']
	report.add(n + '/velocityLossTail', tail, velocity, error=off(tail, velocity))
	report.add(n + '/velocityLossAll', last['velocityLossAll'], velocity, error=off(last['velocityLossAll'], velocity))
	report.add(n + '/energyError', sane['energySum'], limit=SUM_LIMIT)
	report.add(n + '/energyBooked', sane['energyBooked'], limit=BOOKED_LIMIT)
	report.add(n + '/momentumBooked', sane['momentumBooked'], limit=MOMENTUM_LIMIT)
	report.add(n + '/automataLost', sane['lost'], limit=0)
	report.add(n + '/clamped', sane['clamped'], limit=0)
	report.add(n + '/deepest', sane['deepest'], limit=0.2, passed=sane['deepest'] > 0.2, unit='rest distances')
	report.add(n + '/endTime', run.time, unit='s', passed=run.until is not None or run.time < run.longest)
	report.add(n + '/steps', last['step'], unit='steps')
	report.add(n + '/wall', wall, unit='s')
	if run.exitTime is not None:
		report.add(n + '/exitTime', run.exitTime, unit='s')
		atExit = run.at(run.exitTime)
		report.add(n + '/atExit/lengthLoss', atExit['lengthLoss'])
		report.add(n + '/atExit/lengthLossGeometric', atExit['lengthLossGeometric'], length, error=off(atExit['lengthLossGeometric'], length))
	at = {t: run.at(1e-6 * t) for t in (42, 80) if run.time >= 1e-6 * t}
	for t, sample in at.items():
		for k in ('lengthLoss', 'velocityLossTail', 'velocityLossAll'):
			report.add('%s/at%dus/%s' % (n, t, k), sample[k])
	f = run.scene.facts
	report.extra['penetration'] = dict(facts=f, definitions=DEFINITIONS, reason=run.reason, record={k: v.tolist() for k, v in run.arrays().items()}, tate=tate(args.thickness, args.speed, args.rod_length, args.obliquity))


DEFINITIONS = {
        'lengthLoss': 'dl/l0 by mass = 1 - mass of rod material with plastic strain below 0.3 and within 15 % of the tail\'s velocity / mass of the rod',
        'lengthLossUnbroken': 'dl/l0 by mass with the mushroomed head counted as rod: 1 - mass of rod material with plastic strain below 1 / mass of the rod',
        'lengthLossGeometric': 'dl/l0 as a length = 1 - distance from the rear of the tail to the front of unbroken rod material / the same of the undeformed rod; the front: 1 % of the rod material with '
                               'plastic strain below 1 within the rod\'s radius of the axis is ahead of it; meant for the moment of exit, when the head is half a diameter beyond the rear face, normal to it',
        'velocityLossTail': 'dU/U0 = 1 - mean velocity of rod material with plastic strain below 0.1 / impact velocity',
        'velocityLossAll': 'dU/U0 = 1 - momentum of all rod material, debris included / momentum before impact',
        'energyError': 'largest change of kinetic + stored + dissipated + given-away energy, each computed on its own / impact energy',
        'energyBooked': 'largest change of kinetic energy - work booked / impact energy',
        'momentumBooked': 'largest change of momentum - impulses from outside / momentum before impact',
}


def text(run, args):
	"""The result as a few lines."""
	last, sane, f = run.last, run.sane(), run.scene.facts
	length, velocity = published(args.thickness, args.mode) if normal(args) else (None, None)
	t = tate(args.thickness, args.speed, args.rod_length, args.obliquity)
	show = lambda x: '-' if x is None or not math.isfinite(x) else '%.3f' % x
	turned = ''.join(', %s %g deg' % (k, getattr(args, k)) for k in ('angle', 'obliquity') if getattr(args, k))
	lines = ['%g mm plate, %s, ends %s, %g m/s%s, d = %g mm: %s at %.1f us (step %d)' %
	         (args.thickness, args.mode, f['ends'], args.speed, turned, args.spacing, run.reason, 1e6 * run.time, last['step']), '',
	         '                    dl/l0: mass  with head   length   dU/U0: tail        all']
	row = lambda label, a, b, c, head=None, length=None: '%-20s %10s  %9s  %7s   %11s  %9s' % (label, show(a), show(head), show(length), show(b), show(c))
	rowOf = lambda label, r: row(label, r['lengthLoss'], r['velocityLossTail'], r['velocityLossAll'], r['lengthLossUnbroken'], r['lengthLossGeometric'])
	lines.append(rowOf('this run', last))
	if run.exitTime is not None:
		lines.append(rowOf('  at exit, %.0f us' % (1e6 * run.exitTime), run.at(run.exitTime)))
	for us in (42, 80):
		if run.time >= 1e-6 * us:
			lines.append(rowOf('  at %d us' % us, run.at(1e-6 * us)))
	if length is not None:
		lines.append(row('published', length, velocity, None))
	e = experiment()
	if args.thickness == e['thickness'] and normal(args):
		lines.append(row('experiment', e['lengthLoss'], e['velocityLoss'], None))
	lines.append(row('Alekseevskii-Tate', t['lengthLoss'], t['velocityLoss'], None))
	lines += ['', 'dl/l0 by mass: 1 - share of rod material with plastic strain < 0.3 and within 15 % of the tail\'s velocity; with head: 1 - share with plastic strain < 1;',
	          'as a length, to be read at exit: rear of the tail to the front of material with plastic strain < 1 within the rod\'s radius of the axis;',
	          'tail: mean velocity of rod material with plastic strain < 0.1; all: momentum of all rod material, debris included.',
	          'energy: booked %.1e, independent sum %.2f %%; momentum %.1e; lost %d, clamped %d, deepest overlap %.2f of the rest distance'
	          % (sane['energyBooked'], 100 * sane['energySum'], sane['momentumBooked'], sane['lost'], sane['clamped'], sane['deepest']), '']
	return '\n'.join(lines)
