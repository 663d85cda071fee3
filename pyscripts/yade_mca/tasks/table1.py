# SPDX-License-Identifier: GPL-2.0-or-later
"""`table1`: six plate thicknesses in both modes, runs at once in processes of their own, beside the published table, the experiment and the Tate line."""
import concurrent.futures
import contextlib
import io
import json
import math
import os
import queue
import time

from .. import _yade
from ..beside import Beside
from . import cli, environment, registry
from .penetration import options, report as results
from .attempts import Attempts, inMemory
from .cli import positive

SUMMARY = registry.SUMMARIES['table1']
THICKNESSES = (15., 20., 25., 30., 35., 40.)
MODES = ('coupled', 'mca')
GEOMETRIC = 'atExit/lengthLossGeometric'
CASES = ('lengthLoss', 'lengthLossUnbroken', GEOMETRIC, 'velocityLossTail', 'velocityLossAll')


def addArguments(parser):
	options.addSceneArguments(parser, leaveOut=('thickness', 'mode', 'dimension', 'model'))
	group = parser.add_argument_group('runs')
	group.add_argument('--longest', metavar='US', type=positive(float, 'us'), default=150., help='end of a run in any case (default: 150)')
	group.add_argument('--jobs', metavar='N', type=positive(int), help='runs at once (default: processors / threads)')


def check(args):
	args.asked = {k.replace('-', '_'): getattr(args, k.replace('-', '_')) for k in options.given(args)}
	for mode in MODES:
		args.thickness, args.mode = THICKNESSES[0], mode
		options.fill(args)
		for t in THICKNESSES:
			options.checkScene(t, args.spacing, args)


class Runs:
	"""Made in a process of its own: the task `penetration`, run after run, with YADE loaded once."""

	def __init__(self):
		_yade.scene()

	def penetration(self, words):
		"""Its JSON object. Raises RuntimeError with what it said when there is none."""
		said = io.StringIO()
		with inMemory('run.json') as path:
			with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(said):
				status = cli.main(['penetration', *words, '--no-files', '--json', path])
			if not os.path.getsize(path):
				raise RuntimeError('penetration %s: %s' % (' '.join(words), (said.getvalue().strip().splitlines() or ['status %d' % status])[-1]))
			with open(path) as f:
				return json.load(f)


class Processes:
	"""Processes with Runs of `threads` each, started when they are needed and kept for the next run. A context manager that ends them."""

	def __init__(self, threads):
		self.threads, self.all, self.idle = threads, [], queue.SimpleQueue()

	def __enter__(self):
		return self

	def __exit__(self, kind, *error):
		for p in self.all: p.stop() if kind else p.close()

	def take(self):
		try:
			return self.idle.get_nowait()
		except queue.Empty:
			self.all.append(Beside(__name__, 'Runs', environment=dict(OMP_NUM_THREADS=str(self.threads))))
			return self.all[-1]

	def give(self, process):
		if not process.ended: self.idle.put(process)


def child(words, processes):
	"""Runs `penetration` in one of the processes; returns its JSON object. Raises RuntimeError when it failed or the process died, which costs this run only."""
	process = processes.take()
	try:
		return process.call('penetration', words).result()
	finally:
		processes.give(process)


def runAll(jobs, progress, label, atOnce=None, threads=1):
	"""Runs {key: words of the command line} and returns {key: JSON object}; the longest first. A failed run has the key 'error'."""
	atOnce = atOnce or max(1, environment.cores() // threads)
	done = {}
	with concurrent.futures.ThreadPoolExecutor(atOnce) as pool, Processes(threads) as processes, progress(len(jobs), label, 'run') as bar:
		started = {pool.submit(child, words, processes): key for key, words in jobs.items()}
		try:
			for future in concurrent.futures.as_completed(started):
				done[started[future]] = _result(future)
				bar.update(len(done))
		except BaseException:
			for future in started:
				future.cancel()
			raise
	return {key: done[key] for key in jobs}


def _result(future):
	try:
		return future.result()
	except RuntimeError as e:
		return dict(error=str(e), cases=[])


def run(args, report, progress):
	began = time.perf_counter()
	jobs = {(t, mode): options.commandLine(**dict(args.asked, thickness=t, mode=mode), longest=args.longest) for t in reversed(THICKNESSES) for mode in MODES}
	found = runAll(jobs, progress, 'table1', args.jobs, args.threads or 1)
	rows, failed = {}, []
	for t in THICKNESSES:
		for mode in MODES:
			result = found[t, mode]
			if result.get('error'): failed.append('%g mm, %s: %s' % (t, mode, result['error']))
			for c in result['cases']:
				if not c['name'].split('/')[2].startswith('at') or 'atExit' in c['name']:
					report.add(**c)
			if result.get('error'): continue
			rows[t, mode] = {k: c['value'] for c in result['cases'] if (k := c['name'].split('/', 2)[2]) in CASES}
			rows[t, mode].setdefault(GEOMETRIC, math.nan)  # the rod has not come through
	if failed:  # what the others have found stands in the report
		raise RuntimeError('; '.join(failed))
	compare(report, rows, args)
	report.extra['table1'] = dict(definitions=results.DEFINITIONS, rows=[dict(thickness=t, mode=m, **v, **reference(t, m)) for (t, m), v in rows.items()])
	print(text(rows, args, time.perf_counter() - began))
	report.add('wall', time.perf_counter() - began, unit='s')
	if args.out:
		attempt, folder = Attempts('table1'), os.path.abspath(args.out)
		made = [name for name, write in (('table1.json', report.write), ('table1.png', lambda path: picture(path, rows))) if attempt(path := os.path.join(folder, name), write, path)]
		print('%s in %s' % (' and '.join(made) or 'no files', folder))
		attempt.finish()


def reference(t, mode):
	length, velocity = results.published(t, mode)
	tate = results.tate(t)
	return dict(publishedLengthLoss=length, publishedVelocityLoss=velocity, tateLengthLoss=tate['lengthLoss'], tateVelocityLoss=tate['velocityLoss'])


def compare(report, rows, args):
	"""What is asserted of the table as a whole: losses rise with thickness; the published dU/U0 lies between tail and all material."""
	for mode in MODES:
		for what in CASES:
			v = [rows[t, mode][what] for t in THICKNESSES]
			if not any(map(math.isnan, v)):
				report.add('%s/%s/rises' % (mode, what), min(b - a for a, b in zip(v, v[1:])), passed=all(b > a for a, b in zip(v, v[1:])))
		for t in THICKNESSES:
			velocity = results.published(t, mode)[1]
			low, high = rows[t, mode]['velocityLossTail'], rows[t, mode]['velocityLossAll']
			report.add('T%g/%s/publishedBetween' % (t, mode), velocity, passed=low - results.ROUNDING <= velocity <= high + results.ROUNDING if args.speed == 1520 else True)


def text(rows, args, wall):
	lines = ['10 x 100 mm rod, %g m/s, d = %g mm; "published": MCA + Grid beside coupled, MCA only beside mca; one set of constants for all' % (args.speed, args.spacing), '',
	         'plate         |                      dl/l0                         |                 dU/U0',
	         '[mm]  mode    |   mass  with head   length  published   Tate       |   tail    all   published   Tate']
	for (t, mode), v in rows.items():
		r = reference(t, mode)
		lines.append('%4g  %-7s | %6.3f  %9.3f   %6.3f  %9.2f  %5.3f       | %6.3f %6.3f   %9.2f  %5.3f' %
		             (t, mode, v['lengthLoss'], v['lengthLossUnbroken'], v[GEOMETRIC], r['publishedLengthLoss'], r['tateLengthLoss'], v['velocityLossTail'], v['velocityLossAll'],
		              r['publishedVelocityLoss'], r['tateVelocityLoss']))
	e = results.experiment()
	lines += ['', 'dl/l0 by mass: rod material with plastic strain < 0.3 and the speed of the tail; with head: < 1; both at the end. As a length, when the head leaves the plate: from the rear of the tail',
	          'to the front of material with plastic strain < 1 near the axis.', 'experiment at %g mm: dl/l0 %.2f, dU/U0 %.2f' % (e['thickness'], e['lengthLoss'], e['velocityLoss']), 'total %.0f s' % wall, '']
	return '\n'.join(lines)


def picture(path, rows):
	"""Both quantities against thickness."""
	from .. import plots
	plt, e = plots.plt, results.experiment()
	with plt.rc_context(plots.STYLE):
		figure, axes = plt.subplots(1, 2, figsize=(9.5, 4))
		for mode, colour in zip(MODES, ('C0', 'C1')):
			get = lambda what: [rows[t, mode][what] for t in THICKNESSES]
			axes[0].fill_between(THICKNESSES, get('lengthLossUnbroken'), get('lengthLoss'), color=colour, alpha=0.12, lw=0)
			axes[0].plot(THICKNESSES, get('lengthLoss'), 'o-', color=colour, ms=4, label='%s, here' % mode)
			axes[0].plot(THICKNESSES, get('lengthLossUnbroken'), '^-', color=colour, ms=4, lw=0.8, label='%s, head counted as rod' % mode)
			axes[0].plot(THICKNESSES, get(GEOMETRIC), 'd-', color=colour, ms=4, lw=0.8, mfc='white', label='%s, length at exit' % mode)
			axes[0].plot(THICKNESSES, [results.published(t, mode)[0] for t in THICKNESSES], 's--', color=colour, mfc='none', ms=5, lw=0.8, label='%s, published' % mode)
			axes[1].fill_between(THICKNESSES, get('velocityLossTail'), get('velocityLossAll'), color=colour, alpha=0.12, lw=0)
			axes[1].plot(THICKNESSES, get('velocityLossTail'), 'o-', color=colour, ms=4, label='%s, tail' % mode)
			axes[1].plot(THICKNESSES, get('velocityLossAll'), '^-', color=colour, ms=4, lw=0.8, label='%s, all material' % mode)
			axes[1].plot(THICKNESSES, [results.published(t, mode)[1] for t in THICKNESSES], 's--', color=colour, mfc='none', ms=5, lw=0.8, label='%s, published' % mode)
		tate = [results.tate(t) for t in THICKNESSES]
		for ax, key, value in ((axes[0], 'lengthLoss', e['lengthLoss']), (axes[1], 'velocityLoss', e['velocityLoss'])):
			ax.plot(THICKNESSES, [x[key] for x in tate], color='0.4', lw=1, ls=':', label='Alekseevskii-Tate')
			ax.plot([e['thickness']], [value], 'k*', ms=9, label='experiment')
			ax.set(xlabel='plate [mm]', ylim=(0, None))
			ax.legend(fontsize=7)
		axes[0].set_ylabel('dl/l0')
		axes[1].set_ylabel('dU/U0')
		return plots.save(figure, path)
