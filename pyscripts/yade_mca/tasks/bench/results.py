# SPDX-License-Identifier: GPL-2.0-or-later
"""What the records of `bench` say together: errors against the finest run, fronts, cost at equal error, ratios of laws and threads."""
import math
import re

import numpy as np

from .plan import ERRORS, variants

#: McaEngine against CpmMat, 2 threads against 1 (at least); ns per automaton and step of McaEngine on one thread, plastic, by number of automata (at most)
TARGETS = dict(peer=12., threads=1.7, nanoseconds={10000: 45., 100000: 70., 1000000: 70.})
IDLE = 1.3  #: load of the machine up to which two threads have two processors
COMPONENTS = dict(taylorBar=('length', 'foot'), penetration=('lengthLoss', 'velocityLossAll'))
#: the same in space
SPACE = dict(threads=1.8, nanoseconds={10000: 160., 100000: 320.})
REFERENCE = dict(taylorBar='automata', plateWave='automata', penetration='coupled')  #: solver of the finest run


def isDefault(r):
	return not variants(r)


def reference(records, case, width=None):
	"""The finest default record of a case (and width), or None."""
	found = [r for r in records if r['case'] == case and r['solver'] == REFERENCE[case] and isDefault(r) and r.get('width') == width and ('result' in r or 'signal' in r)]
	return max(found, key=lambda r: r['n'], default=None)


def distance(a, b):
	"""Relative L2 distance of signal a from b, rows (times, then quantities) of equal kind, on the times of b."""
	from scipy.interpolate import CubicSpline
	a, b = np.asarray(a), np.asarray(b)
	t = b[0][(b[0] >= a[0][0]) & (b[0] <= a[0][-1])]
	at = lambda s: CubicSpline(s[0], s[1:], axis=1)(t)
	return float(np.sqrt(((at(a) - at(b))**2).sum() / (at(b)**2).sum()))


def giveErrors(records):
	"""Fills `error` and `against` of records whose case has no exact solution. The finest run has no error; other widths of penetration are other problems."""
	for case in REFERENCE:
		of = [r for r in records if r['case'] == case]
		for width in {r.get('width') for r in of}:
			ref = reference(of, case, width)
			if ref is None or (case == 'penetration' and width != 120): continue
			for r in of:
				if r is ref or r.get('width') != width: continue
				if 'signal' in r: error = distance(r['signal'], ref['signal'])
				elif 'result' in r: error = math.sqrt(np.mean([(r['result'][k] / ref['result'][k] - 1)**2 for k in COMPONENTS[case]]))
				else: continue
				if error > 1e-12: r.update(error=error, against=ref['name'])  # else: the finest run once more, say on two threads
	return records


def equalError(records):
	"""Plates with a wave, per width: time that automata alone need for the error of each coupled run, over its time.

	Time against error of the automata's runs is interpolated, or extended at its end, as straight lines in the logarithms. Rows (width, n, error, coupled s, automata s, ratio, inside).
	"""
	rows = []
	for width in sorted({r['width'] for r in records if r['case'] == 'plateWave'}):
		of = lambda solver: sorted((r for r in records if r['case'] == 'plateWave' and r['width'] == width and r['solver'] == solver and isDefault(r) and r.get('error')), key=lambda r: -r['error'])
		alone = of('automata')
		if len(alone) < 2: continue
		e, t = (np.log([r[k] for r in alone]) for k in ('error', 'stepping'))
		for r in of('coupled'):
			x = math.log(r['error'])
			k = min(max(int(np.searchsorted(-e, -x)) - 1, 0), len(e) - 2)
			there = math.exp(t[k] + (t[k + 1] - t[k]) * (x - e[k]) / (e[k + 1] - e[k]))
			rows.append((width, r['n'], r['error'], r['stepping'], there, there / r['stepping'], bool(e[-1] <= x <= e[0])))
	return rows


def widths(records):
	"""Penetration in both modes, per width and n: rows (width, n, coupled s, automata s, ratio, differences of lengthLoss and velocityLossAll)."""
	of = {(r['width'], r['n'], r['solver']): r for r in records if r['case'] == 'penetration' and isDefault(r) and 'result' in r}
	rows = []
	for width, n, solver in sorted(of):
		a, c = of.get((width, n, 'automata')), of.get((width, n, 'coupled'))
		if solver == 'coupled' and a:
			rows.append((width, n, c['stepping'], a['stepping'], a['stepping'] / c['stepping'], *(abs(a['result'][k] - c['result'][k]) for k in COMPONENTS['penetration'])))
	return rows


def speedUps(records):
	"""Rows (name of the run on 1 thread, ratio of the timers on 1 and 2 threads, largest load before them) where both were run."""
	key = lambda r: tuple(r.get(k) for k in ('case', 'solver', 'n', 'rule', 'factor', 'sleeping', 'account', 'kind', 'width'))
	two = {key(r): r for r in records if r['threads'] == 2 and r.get('stepping')}
	return [(r['name'], perStep(r) / perStep(two[key(r)]), max(r['load'], two[key(r)]['load'])) for r in records if r['threads'] == 1 and r.get('stepping') and key(r) in two]


def perStep(r):
	return r['timers'] / r['steps']


def peers(records):
	"""Rows (n, kind, threads, road, ns, over McaEngine's of the same n, kind (of YADE's laws: plastic) and threads, load) of the case law."""
	law = [r for r in records if r['case'] == 'law' and r.get('automataNs')]
	ns = {(r['n'], r['kind'], r['threads']): r['automataNs'] for r in law if r['solver'] == 'McaEngine'}
	return [(r['n'], r['kind'], r['threads'], r['solver'], r['automataNs'], r['automataNs'] / ns[k] if (k := (r['n'], r['kind'], r['threads'])) in ns else None, r['load']) for r in law]


def addSpace(report, records):
	"""Costs in space: plastic ones have the limits of SPACE on an idle machine."""
	for r in records:
		if r['case'] != 'space' or not r.get('automataNs'): continue
		limit = SPACE['nanoseconds'].get(r['n']) if r['kind'] == 'plastic' and r['threads'] == 1 and r['load'] <= IDLE else None
		report.add(r['name'], r['automataNs'], limit=limit, unit='ns per automaton and step, load %.1f' % r['load'], passed=r['automataNs'] <= limit if limit else None)
		report.add(r['name'] + '/bytes', r['bytes'], unit='bytes per automaton, its body among them')
	for name, ratio, load in speedUps(records):
		if not name.startswith('space/'): continue
		held = load <= IDLE
		report.add(name + '/2threads', ratio, limit=SPACE['threads'] if held else None, unit='times as fast as 1 thread, load %.1f' % load, passed=ratio >= SPACE['threads'] if held else None)


def add(report, records):
	"""The cases of the report: errors and times of all runs, and the ratios; those of TARGETS have limits, on an idle machine of the kind they were set for; all else is measured and not judged."""
	for r in records:
		if r.get('failed') or (r.get('ended') and not r['mayEnd']):
			report.add(r['name'], math.nan, unit=r.get('failed') or r['ended'])
		if not r.get('stepping'): continue
		report.add(r['name'] + '/time', r['stepping'], unit='s')
		if r.get('error') is not None: report.add(r['name'] + '/error', r['error'], unit=ERRORS[r['case']])
		if r.get('energyError') is not None: report.add(r['name'] + '/energyError', r['energyError'], unit='of the energy in play')
	for n, kind, threads, road, ns, ratio, load in peers(records):
		label = 'law/N%d/%s/%dthreads/' % (n, kind, threads)
		limit = TARGETS['nanoseconds'].get(n) if road == 'McaEngine' and kind == 'plastic' and threads == 1 and load <= IDLE else None
		report.add(label + road, ns, limit=limit, unit='ns per automaton and step', passed=ns <= limit if limit else None)
		if ratio and road != 'McaEngine':
			held = road == 'CpmMat' and threads == 1
			report.add(label + road + 'OverMcaEngine', ratio, limit=TARGETS['peer'] if held else None, unit='times', passed=ratio >= TARGETS['peer'] if held else None)
	addSpace(report, records)
	for name, ratio, load in speedUps(records):
		if name.startswith('space/'): continue
		held = (name.startswith('law/McaEngine') or re.match(r'penetration/.*N(50|100)\b', name)) and load <= IDLE
		report.add(name + '/2threads', ratio, limit=TARGETS['threads'] if held else None, unit='times as fast as 1 thread, load %.1f' % load, passed=ratio >= TARGETS['threads'] if held else None)
	for width, n, error, coupled, alone, ratio, inside in equalError(records):
		report.add('equalError/w%d/N%d' % (width, n), ratio, unit='automata only over coupled' + ('' if inside else ', extended'))
	for width, n, coupled, alone, ratio, *off in widths(records):
		report.add('penetration/w%d/N%d/automataOverCoupled' % (width, n), ratio, unit='times')
