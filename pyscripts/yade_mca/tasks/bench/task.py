# SPDX-License-Identifier: GPL-2.0-or-later
"""`bench`: run time against error, cost by phase, cost against size, beside YADE's own laws. Each run is a process of its own; `--out` gets

    bench.jsonl        one record per run and line, as they come
    bench.json         the whole result; a case that is run again with --only replaces its old records there
    bench-front.png    time against error with the Pareto front; bench-size.png, bench-phases.png

With `--before FILE` the fronts of an older bench.json stand beside in grey, and its times and errors in the table; DIR/bench.json keeps them. A record holds the job (case, solver, n, rule, factor, sleeping, account, threads, kind, width, until) and

    stepping           time of all steps [s]: `timers` (YADE's, of its engines) or, on 1 thread, `processorSeconds` when that is less because other processes ran
    wall               [s] from the start of the process to the end of the run; start: of YADE and the plugin; built: of the scene
    steps, automata, cells, simulated [s], error, against, energyError
    automataNs, cellNs ns per automaton and per cell and step; interfaceNs, phasesPerStep: ns per step
    phases             ns per automaton (cells, nodes: per cell) and step: neighbours, density, pairs, forces, contacts, fracture, integration, cells, nodes, interface, writeBack, rest
    triad              of the case law: memory bandwidth of one thread then [B/s]; flowing, broken, contacts: shares of the automata
    memory             peak resident memory of the process [MB]; processorShare: processor time over wall time of the run; load: of the machine before
    threads, compiler, isa, processor, commit (of the source tree), build (commit of the libraries), version; ended: the message when an engine ended the run
"""
import json
import os

from .. import environment, registry
from ..attempts import Attempts
from ..registry import UsageError
from ..report import Report, jsonable, writeAtomically
from . import google, plan, process, results

SUMMARY = registry.SUMMARIES['bench']
KERNELS = 'kernels'


def addArguments(parser):
	parser.add_argument('--quick', action='store_true', help='fewer and coarser runs, two to three minutes')
	parser.add_argument('--only', metavar='CASE', action='append', help='of %s; may be given several times' % ', '.join((*plan.CASES, KERNELS)))
	parser.add_argument('--fastest', action='store_true', help='keep the runs that are in DIR/bench.json and, of runs made again with the same libraries, the faster one: for machines that others use')
	parser.add_argument('--before', metavar='FILE', help='a bench.json of another version: its fronts are shown beside the new ones')
	parser.add_argument('--doc', metavar='DIR', help='only make the tables of the documentation from DIR/bench.json')


def check(args):
	for case in args.only or ():
		if case not in (*plan.CASES, KERNELS):
			raise UsageError("--only: case '%s' is not one of %s" % (case, ', '.join((*plan.CASES, KERNELS))))
	if args.threads:
		raise UsageError('--threads: bench sets the number of threads of each run itself')
	if args.before:
		if not args.out: raise UsageError('--before: give --out, where the pictures go')
		older(args.before)
	if args.doc and not os.path.isfile(os.path.join(args.doc, 'bench.json')):
		raise UsageError("--doc: there is no file '%s'" % os.path.join(args.doc, 'bench.json'))


def line(r):
	"""A record as one line of the screen."""
	if r.get('failed') or r.get('ended'):
		return '%-44s ended: %s' % (r['name'], (r.get('failed') or r['ended'])[:110])
	show = lambda x, form: '-' if x is None else form % x
	return '%-44s %8.3f s %7d automata %6d cells %6d steps  error %-8s  %6s ns per automaton, %5s per cell  %5.0f MB' % (
	        r['name'], r['stepping'], r['automata'], r['cells'], r['steps'], show(r.get('error'), '%.2g'), show(r['automataNs'], '%.0f'), show(r['cellNs'], '%.0f'), r['memory'])


def older(path):
	"""The records of a bench.json without what only the run itself needs."""
	try:
		with open(path) as f:
			records = json.load(f)['records']
	except (OSError, ValueError, KeyError, TypeError) as e:
		raise UsageError("--before: '%s' is no bench.json: %s" % (path, e))
	return [{k: v for k, v in r.items() if k not in ('phases', 'phasesPerStep', 'signal')} for r in records]


def kept(path, only, everything=False):
	"""(records, kernels, records before) of an older result that this run does not renew."""
	if not os.path.isfile(path) or not (only or everything):
		return [], {}, []
	with open(path) as f:
		old = json.load(f)
	before = old.get('before', [])
	if everything:
		return old['records'], old.get('kernels', {}), before
	return [r for r in old.get('records', ()) if r['case'] not in only], {} if KERNELS in only else old.get('kernels', {}), before


def fastest(old, new):
	"""All records of both; of two with the same name and libraries the faster one, else the new one. Errors do not depend on which it is."""
	best = {r['name']: r for r in old}
	for r in new:
		b = best.get(r['name'])
		if not (b and r.get('stepping') and b.get('stepping') and b.get('build') == r.get('build') and b['stepping'] / b['steps'] <= r['stepping'] / r['steps']): best[r['name']] = r
	return list(best.values())


def run(args, report, progress):
	if args.doc:
		from . import doc
		print('made', ', '.join(doc.write(args.doc)))
		return
	jobs = plan.plan(args.quick, args.only, environment.cores())
	path = args.out and os.path.join(args.out, 'bench.json')
	old, kernels, before = kept(path, args.only, args.fastest) if path else ([], {}, [])
	if args.before: before = older(args.before)
	records, attempt = [], Attempts('bench')
	with progress(len(jobs), 'bench', 'run') as bar:
		for j in jobs:
			records.append(process.measured(j))
			print(line(records[-1]), flush=True)
			if args.out:
				attempt(os.path.join(args.out, 'bench.jsonl'), append, args.out, records)
			bar.update(len(records))
	results.giveErrors(records)
	for r in records:
		r.pop('signal', None)
	remarks = []
	if not args.only or KERNELS in args.only:
		kernels, remarks = google.run(args.quick)
		google.add(report, kernels)
	for text in remarks:
		print('bench:', text)
	results.add(report, records)
	report.extra.update(command=command(args), records=fastest(old, records), kernels=kernels, remarks=remarks)
	if args.out:
		made = written(args, fastest(old, records), kernels, remarks, before, attempt)
		print('%s are in %s' % (', '.join(made) or 'no files', os.path.abspath(args.out)))
		attempt.finish()


def append(folder, records):
	"""The last record as a line of bench.jsonl; the first one begins the file anew."""
	with open(os.path.join(folder, 'bench.jsonl'), 'a' if len(records) > 1 else 'w') as f:
		f.write(json.dumps(jsonable({k: v for k, v in records[-1].items() if k != 'signal'})) + '\n')


def written(args, records, kernels, remarks, before, attempt):
	"""Writes records, result and pictures of all cases that are in the folder now; returns the names of the files."""
	from . import plots
	records, whole = jsonable(records), Report('bench')
	results.add(whole, records)
	google.add(whole, kernels)
	if before: whole.extra.update(before=before)
	whole.extra.update(command=command(args), records=records, kernels=kernels, remarks=remarks, wall=sum(r.get('wall') or 0. for r in records))
	lines = ''.join(json.dumps(r) + '\n' for r in records)
	files = {'bench.json': whole.write, 'bench.jsonl': lambda path: writeAtomically(path, lines)}
	files.update({name: lambda path, make=make: make(path, records, before) for name, make in plots.PICTURES.items()})
	return [name for name, make in files.items() if attempt(path := os.path.join(args.out, name), make, path)]


def command(args):
	return ' '.join(['pyscripts/run bench', *['--quick'] * args.quick, *('--only ' + c for c in args.only or ()), *['--before'] * bool(args.before)])
