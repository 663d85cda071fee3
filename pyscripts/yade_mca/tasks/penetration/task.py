# SPDX-License-Identifier: GPL-2.0-or-later
"""`penetration`: a tungsten-alloy rod through a steel plate, from the scene to table, pictures, animation, page, ParaView files and checkpoint.

What is reported, and when, is defined in yade_mca/measure.py and yade_mca/impact.py.
"""
import contextlib
import math
import os
import sys
import time
from concurrent.futures import Future

from .. import registry
from ..cli import positive, writable
from ..registry import UsageError
from . import options
from . import report as results

SUMMARY = registry.SUMMARIES['penetration']
CHECKPOINT = 'penetration.checkpoint'
PAGE = 'penetration.html'
SHARE = 0.05  #: of the time that may go into checkpoints


def addArguments(parser):
	options.addSceneArguments(parser)
	group = parser.add_argument_group('run')
	group.add_argument('--until', metavar='US', type=positive(float, 'us'), help='end at the first sample from this time on, instead of by the physical criterion')
	group.add_argument('--longest', metavar='US', type=positive(float, 'us'), default=150., help='end at this time in any case (default: 150)')
	group.add_argument('--restart', metavar='FILE', help='go on from a checkpoint; the scene is that of the checkpoint')
	group.add_argument('--no-files', action='store_true', help='no pictures, page, ParaView files or checkpoints')
	group.add_argument('--no-page', action='store_true', help='no penetration.html, the page that shows the run')
	group.add_argument('--no-animation', action='store_true', help='no penetration.gif')
	group.add_argument('--checkpoint-interval', metavar='S', type=positive(float, 's'), default=2., help='least time between checkpoints (default: 2)')


def check(args):
	if args.restart is None:
		options.fill(args)
	else:
		if options.given(args):
			raise UsageError('--restart: the scene is that of the checkpoint; leave out --%s' % ', --'.join(options.given(args)))
		if not os.path.isfile(args.restart):
			raise UsageError("--restart: there is no file '%s'" % args.restart)
		from ... import checkpoint
		try:
			args.saved = checkpoint.peek(args.restart)['extra']
		except checkpoint.CheckpointError as e:
			raise UsageError('--restart: %s' % e) from None
		for k, v in args.saved['options'].items():
			if k.replace('_', '-') in options.SCENE: setattr(args, k, v)
	if args.no_files or args.out:
		return
	args.out = os.path.dirname(os.path.abspath(args.restart)) if args.restart else os.path.join('results', '%s_%gmm' % (results.name(args).replace('/', '_'), args.spacing))
	try:
		os.makedirs(args.out, exist_ok=True)
	except OSError as e:
		raise UsageError("--out: cannot make folder '%s': %s" % (args.out, e.strerror)) from None
	writable(args.out, '--out')


def title(args):
	return 'penetration'


class Keeper:
	"""Writes the checkpoint now and then: at most every `interval` seconds, and so rarely that it takes little of the time."""

	def __init__(self, path, interval, extra, beside=None):
		"""beside: process that writes them, after all that it was asked for before; None, or when it is gone: this one does."""
		from ... import checkpoint
		self.path, self.interval, self.extra, self.beside = path, interval, extra, beside
		self.next, self.failures, self.open = time.monotonic() + interval, 0, []
		checkpoint.removeLeftovers(path)

	def _store(self, head, parts):
		"""Future of the written file."""
		if self.beside and not self.beside.ended: return self.beside.call('checkpoint', self.path, head, parts)
		from ... import checkpoint
		done = Future()
		try:
			done.set_result(checkpoint.store(self.path, head, parts))
		except OSError as e:
			done.set_exception(e)
		return done

	def update(self, run, end=False):
		self.look()
		start = time.monotonic()
		if start < self.next and not end:
			return
		self.open.append((1e6 * run.time, self._store(*run.packed(self.extra))))
		self.look()
		spent = time.monotonic() - start
		self.next = time.monotonic() + max(self.interval, spent / SHARE)

	def look(self, wait=False):
		"""Says which have failed; wait: until all have been written or not."""
		while self.open and (wait or self.open[0][1].done()):
			at, future = self.open.pop(0)
			e = future.exception()
			if e:
				self.failures += 1
				print("\npenetration: no checkpoint at %.1f us: cannot write '%s': %s; the run goes on, the last one stays" % (at, self.path, getattr(e, 'strerror', None) or e), file=sys.stderr)


def start(args):
	"""(Impact, time of the checkpoint or None)."""
	from ... import checkpoint, impact
	until = None if args.until is None else 1e-6 * args.until
	if args.restart is None:
		return impact.Impact(options.sceneOf(args), until=until, longest=1e-6 * args.longest), None
	try:
		run, _ = impact.Impact.load(args.restart, until)
	except checkpoint.CheckpointError as e:
		raise UsageError('--restart: %s' % e) from None
	run.longest = max(1e-6 * args.longest, run.longest)
	return run, run.time


def expectedEnd(run):
	"""A guess of the end of the run [s], for the remaining time shown; it grows when the run goes on beyond."""
	f = run.scene.facts
	if run.until is not None:
		return run.until
	deep = f['thickness'] / math.cos(f['obliquity']) * (1 + math.sqrt(results.TATE['rhoT'] / results.TATE['rhoP'])) / f['speed']  # at the speed of two jets
	return min(run.longest, 1.3 * deep + run.window + f['rodDiameter'] / f['speed'])


def run(args, report, progress):
	output = None
	with contextlib.ExitStack() as stack:
		if not args.no_files:  # first: it gets ready while YADE starts and the scene is built
			from ...impact_output import Output
			output = stack.enter_context(Output(args.out, animation=not args.no_animation))
		_run(args, report, progress, output)


def _keeper(args, output):
	saved = {k: getattr(args, k) for k in (n.replace('-', '_') for n in options.SCENE)}
	return Keeper(os.path.join(args.out, CHECKPOINT), args.checkpoint_interval, dict(options=saved), output.beside)


def _run(args, report, progress, output):
	from ... import _yade
	_yade.scene().reset()
	began = time.perf_counter()
	run, resumed = start(args)
	keeper = None
	if output:
		output.begin(run, resumed)
		keeper = _keeper(args, output)
		if resumed is None:
			output.update(run)
	_advance(run, args, progress, output, keeper, resumed or 0.)
	wall = time.perf_counter() - began
	results.add(report, run, args, wall)
	print(results.text(run, args), flush=True)
	if keeper:
		finish(run, args, report, output, keeper, began, wall)


def _advance(run, args, progress, output, keeper, already):
	"""Runs to the end."""
	expected = max(expectedEnd(run), 1.01 * run.time)
	with progress(1e6 * (expected - already), results.name(args), 'us') as bar:
		while not run.finished:
			try:
				run.advance()
				rate = (run.last['step'] - run.startStep) / run.stepSeconds
				if run.time > expected and not run.finished:  # as much longer as the criterion looks back
					expected = min(run.longest, run.time + run.window) if run.until is None else run.time
					bar.grow(1e6 * (expected - already))
				sane = run.sane()
				bar.update(1e6 * (min(run.time, expected) - already), stepsPerSecond=float(rate), energy=sane['energySum'], energyBooked=sane['energyBooked'])
				if keeper:
					output.update(run)
					keeper.update(run)
			except (RuntimeError, KeyboardInterrupt):
				if keeper: _keep(run, output, keeper)
				raise


def _keep(run, output, keeper):
	"""The state of a run that cannot go on; a refused step leaves the state before it."""
	if run.record['time'][-1:] == [run.time]: output.update(run)  # it may have been interrupted there
	keeper.update(run, end=True)
	output.look(wait=True)
	keeper.look(wait=True)
	print('penetration: the state at %.2f us is in %s' % (1e6 * run.time, keeper.path), file=sys.stderr)


def finish(run, args, report, output, keeper, began, wall):
	"""Writes what is written at the end, the numbers first. Files that cannot be written are named in one error at the end; everything else is there then."""
	record, summary = report.extra['penetration'], os.path.join(args.out, 'summary.json')
	output.update(run, end=True)
	record['checkpointFailures'] = keeper.failures
	output.attempt(summary, report.write, summary)
	keeper.update(run, end=True)
	output.look(wait=True)
	keeper.look(wait=True)
	if not args.no_page:
		from . import page
		start, path = time.process_time(), os.path.join(args.out, PAGE)
		output.attempt(path, page.write, path, run, args, report, args.out, wall)
		output.seconds['page'] = time.process_time() - start
	record.update(checkpointFailures=keeper.failures, wallWithFiles=time.perf_counter() - began, processorSecondsOfFiles=output.seconds)
	output.attempt(summary, report.write, summary)
	print('%s, ParaView files (penetration.pvd), checkpoint and summary.json are in %s' % (
	        ', '.join(['pictures', *['animation (penetration.gif)'] * (not args.no_animation), *['page (%s)' % PAGE] * (not args.no_page)]), os.path.abspath(args.out)))
	output.attempt.finish()
