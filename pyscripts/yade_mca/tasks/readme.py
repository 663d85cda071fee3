# SPDX-License-Identifier: GPL-2.0-or-later
"""`readme`: fills the tables and pictures of README.md from the results of other tasks. Nothing between the markers is typed by hand.

    <!-- readme: NAME -->  ...  <!-- end -->

Results lie in plugin/doc/results, one JSON file per task, with the command that made it; those of `bench` are put there by `bench --out` itself. `--run` runs tasks anew; `--check` writes nothing and fails
when README.md is not what the results give.
"""
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

from . import registry
from .registry import UsageError
from .report import writeAtomically

SUMMARY = registry.SUMMARIES['readme']
ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
README, RESULTS = os.path.join(ROOT, 'README.md'), os.path.join(ROOT, 'plugin', 'doc', 'results')
#: result -> (arguments of pyscripts/run, pictures in its --out folder that README shows: pattern -> name)
JOBS = {
        'verify-automata': (['verify', 'automata'], {}),
        'verify-automata3d': (['verify', 'automata3d'], {}),
        'verify-grid': (['verify', 'grid', '--quick'], {}),
        'verify-interface': (['verify', 'interface', '--quick'], {}),
        'check': (['check'], {}),
        'penetration': (['penetration', '--spacing', '1'], {r'penetration\.gif': 'penetration.gif'}),
}
#: rows of the verification table: result, pattern of the cases, what they are
ROWS = [
        ('verify-grid', r'speed/', 'grid: wave speeds'),
        ('verify-grid', r'lamb/h[^/]*$', "grid: Lamb's problem, line force on a half-plane"),
        ('verify-grid', r'piston/.*plasticSpeed$', 'grid: speed of a plastic shock'),
        ('verify-grid', r'piston/.*/stress$', 'grid: stress behind a plastic shock'),
        ('verify-grid', r'impact/.*(?<!Error)$', 'grid: plate impact, speeds and pressure'),
        ('verify-grid', r'shell/.*N\d+$', 'grid: collapse of a plastic shell'),
        ('verify-grid', r'energyError$', 'grid: energy, all runs'),
        ('verify-interface', r'reflection/[PS]/.*lambda\d+d$', 'interface: reflection of P and S waves'),
        ('verify-interface', r'point/', 'interface: point source, what the line adds'),
        ('verify-interface', r'rayleigh/', 'interface: Rayleigh wave across the line'),
        ('verify-interface', r'energy', 'interface: energy'),
        ('verify-automata', r'uniform/', 'automata: Hooke and Mises in uniform fields, any orientation'),
        ('verify-automata', r'phaseSpeed/', 'automata: phase speeds, 6 to 40 spacings per wave'),
        ('verify-automata', r'rotation/', 'automata: rigid turns'),
        ('verify-automata', r'hugoniot/affine/', 'automata: speed and pressure of plastic shocks'),
        ('verify-automata', r'precursor/', 'automata: elastic precursor and plastic shock'),
        ('verify-automata', r'impact/[^/]*/(?!library)', 'automata: plate impact, plateau'),
        ('verify-automata', r'impact/[^/]*/library', "automata: the same with the library's hardening and heat, breaking links"),
        ('verify-automata', r'taylor/', 'automata: Taylor bar, against the grid'),
        ('verify-automata', r'surface/', 'automata: free surfaces: strip, beam, hole, half-plane, ring'),
        ('verify-automata', r'spall/', 'automata: spall, pull-back of the free surface'),
        ('verify-automata', r'roads/', "automata: YADE's loop against the engine, 1000 steps"),
        ('verify-automata', r'[mM]omentum$', 'automata: momenta'),
        ('verify-automata', r'longRun/energyDrift', 'automata: energy over a million steps'),
        ('verify-automata', r'bookedEnergy', 'automata: energy, work of all forces'),
        ('verify-automata', r'energySum$', 'automata: energy, state functions and dissipations'),
        ('verify-automata3d', r'uniform/', 'in space: Hooke and Mises in uniform fields, any orientation'),
        ('verify-automata3d', r'phaseSpeed/', 'in space: phase speeds in four directions, 6 to 20 spacings per wave'),
        ('verify-automata3d', r'stableStep/', 'in space: largest stable step'),
        ('verify-automata3d', r'rotation/', 'in space: rigid turns under stress'),
        ('verify-automata3d', r'tension/', 'in space: modulus of a bar with plane faces'),
        ('verify-automata3d', r'hugoniot/.*(speed|pressure)$', 'in space: speed and pressure of plastic shocks'),
        ('verify-automata3d', r'[mM]omentum$', 'in space: momenta, also of a tumbling top'),
        ('verify-automata3d', r'(vibration|turning|top/[^/]*)/energy$', 'in space: energy of free bodies, up to 1e5 steps'),
        ('verify-automata3d', r'collision/.*(bookedEnergy|energySum)$', 'in space: energy of colliding balls, both sums'),
        ('check', r'/(?!wall)[^/]*$', 'examples'),
]


def addArguments(parser):
	parser.add_argument('--run', metavar='NAME', nargs='*', help='run these results anew before (none named: all): %s' % ', '.join(JOBS))
	parser.add_argument('--check', action='store_true', help='write nothing; fail when README.md is not what the results give')


def check(args):
	if not os.path.exists(README):
		raise UsageError('README.md is made in the source tree only')
	for name in args.run or ():
		if name not in JOBS: raise UsageError("no result '%s'; there are %s" % (name, ', '.join(JOBS)))


def runJob(name):
	"""Runs a task into plugin/doc/results; returns its status."""
	arguments, pictures = JOBS[name]
	os.makedirs(RESULTS, exist_ok=True)
	with tempfile.TemporaryDirectory() as out:
		path = os.path.join(out, 'result.json')
		status = subprocess.run([sys.executable, '-m', 'yade_mca.tasks', *arguments, '--json', path, '--out', out]).returncode
		if not os.path.exists(path): return status
		with open(path) as f:
			d = json.load(f)
		keep = {k: d[k] for k in ('task', 'version', 'commit', 'threads', 'isa', 'wall', 'cases') if k in d}
		keep['command'] = 'pyscripts/run ' + ' '.join(arguments)
		for pattern, target in pictures.items():
			found = sorted(f for f in os.listdir(out) if re.fullmatch(pattern, f))
			if found: shutil.copyfile(os.path.join(out, found[-1]), os.path.join(RESULTS, target))
		writeAtomically(os.path.join(RESULTS, name + '.json'), json.dumps(keep, indent=0) + '\n')
	return status


def results():
	found = {}
	for name in JOBS:
		path = os.path.join(RESULTS, name + '.json')
		if os.path.exists(path):
			with open(path) as f:
				found[name] = json.load(f)
	return found


def number(x):
	return '' if x is None else '%.4g' % x


def revision(d):
	"""Short name of the revision; a + says that files were changed."""
	commit = d.get('commit') or 'no revision'
	return commit[:10] + '+' * commit.endswith(('+', '-dirty'))


def verification(found):
	"""One line per group of cases: the case nearest to its limit, and how many passed."""
	lines = ['| what | cases passed | nearest to its limit | measured | reference | error | allowed |', '|---|---|---|---|---|---|---|']
	for result, pattern, label in ROWS:
		cases = [c for c in found.get(result, {}).get('cases', ()) if re.search(pattern, c['name']) and c['limit'] is not None]
		if not cases: continue
		error = lambda c: abs(c['value']) if c['error'] is None else c['error']
		worst = max(cases, key=lambda c: error(c) / c['limit'] if c['limit'] > 0 else (error(c) > 0) * 1e9)
		unit = ' ' + worst['unit'] if worst['unit'] else ''
		lines.append('| %s | %d of %d | %s | %s%s | %s | %.2g | %.2g |' % (label, sum(c['passed'] for c in cases), len(cases), worst['name'], number(worst['value']), unit,
		                                                              number(worst['reference']), error(worst), worst['limit']))
	made = ['`%s` (%s, %.0f s)' % (d['command'], revision(d), d['wall']) for name, d in found.items() if name.startswith('verify') or name == 'check']
	return lines + ['', 'Made by ' + ', '.join(made) + '.'] if made else []


def peers(time):
	"""What the independent codes of data/penetration_peers.csv have at 25 mm within 2 us of `time` [us], spacing 0.5 mm or less: key -> (lowest, highest)."""
	with open(os.path.join(os.path.dirname(__file__), '..', 'data', 'penetration_peers.csv'), newline='') as f:
		rows = [r for r in csv.DictReader(line for line in f if not line.startswith('#'))
		        if r['plate_mm'] == '25' and abs(float(r['time_us']) - time) < 2 and float(r['spacing_mm']) <= 0.5]
	return {k: (min(float(r[k]) for r in rows), max(float(r[k]) for r in rows)) for k in ('lengthLoss', 'velocityLossTail', 'velocityLossAll')}


def penetration(found):
	d = found.get('penetration')
	if not d: return []
	others = peers(42)
	lines = ['| rod through 25 mm, at 42 µs | here | two independent codes, same constants |', '|---|---|---|']
	for key, label in (('lengthLoss', 'dl/l0 by mass'), ('velocityLossTail', 'dU/U0, tail'), ('velocityLossAll', 'dU/U0, all rod material')):
		case = next((c for c in d['cases'] if c['name'].endswith('/at42us/' + key)), None)
		if case: lines.append('| %s | %.3f | %.3f ... %.3f |' % (label, case['value'], *others[key]))
	case = next((c for c in d['cases'] if c['name'].endswith('/energyError')), None)
	if case: lines.append('| drift of the energy sum | %.2g | |' % case['value'])
	return lines + ['', 'Made by `%s` (%s, %.0f s on %s threads); independent codes: `pyscripts/yade_mca/data/penetration_peers.csv`.' % (
	        d['command'], revision(d), d['wall'], d['threads'])]


def picture(name, text):
	return lambda found: ['![%s](plugin/doc/results/%s)' % (text, name)] if os.path.exists(os.path.join(RESULTS, name)) else []


SECTIONS = {
        'verification': verification,
        'penetration': penetration,
        'picture': picture('penetration.gif', 'A tungsten rod goes through a steel plate, from left to right: automata in the middle, grid beside, coloured by plastic strain'),
        'front': picture('bench-front.png', 'Run time against error, per case'),
}


def filled(text, found):
	"""README with all sections made anew. Raises UsageError for a marker without a section."""

	def section(match):
		if match[1] not in SECTIONS: raise UsageError("README.md: no section '%s'" % match[1])
		return '\n'.join(['<!-- readme: %s -->' % match[1], *SECTIONS[match[1]](found), '<!-- end -->'])

	return re.sub(r'<!-- readme: (\w+) -->.*?<!-- end -->', section, text, flags=re.S)


def run(args, report, progress):
	if args.run is not None:
		for name in args.run or JOBS:
			report.add(name, runJob(name), unit='status')
	with open(README) as f:
		text = f.read()
	new = filled(text, results())
	report.add('sections', len(re.findall('<!-- readme:', new)))
	if args.check:
		report.add('up to date', new == text, passed=new == text)
	elif new != text:
		writeAtomically(README, new)
