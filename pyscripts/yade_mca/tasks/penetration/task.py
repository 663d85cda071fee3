# SPDX-License-Identifier: GPL-2.0-or-later
"""`penetration`: a tungsten-alloy rod through a steel plate, from the scene to table, pictures, animation, page, ParaView files and checkpoint.

What is reported, and when, is defined in yade_mca/measure.py and yade_mca/impact.py.
"""
import math
import os
import sys
import time

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

	def __init__(self, path, interval, extra):
		from ... import checkpoint
		self.path, self.interval, self.extra = path, interval, extra
		self.next, self.failures, self.seconds = time.monotonic() + interval, 0, 0.
		checkpoint.removeLeftovers(path)

	def update(self, run, end=False):
		start = time.monotonic()
		if start < self.next and not end:
			return
		try:
			run.save(self.path, self.extra)
		except OSError as e:
			self.failures += 1
			print("\npenetration: no checkpoint at %.1f us: cannot write '%s': %s; the run goes on, the last one stays" % (1e6 * run.time, self.path, e.strerror or e), file=sys.stderr)
		spent = time.monotonic() - start
		self.seconds += spent
		self.next = time.monotonic() + max(self.interval, spent / SHARE)


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
	from ...exact import tatePlate
	f = run.scene.facts
	if run.until is not None:
		return run.until
	tate = tatePlate(f['rodLength'], f['thickness'] / math.cos(f['obliquity']), f['speed'], **results.TATE)
	return min(run.longest, 1.3 * tate['time'] + run.window + f['rodDiameter'] / f['speed'])


def run(args, report, progress):
	from ... import _yade
	_yade.scene().reset()
	began = time.perf_counter()
	run, resumed = start(args)
	output = keeper = None
	if not args.no_files:
		from ...impact_output import Output
		output = Output(args.out, resumeAt=resumed, animation=not args.no_animation)
		saved = {k: getattr(args, k) for k in (n.replace('-', '_') for n in options.SCENE)}
		keeper = Keeper(os.path.join(args.out, CHECKPOINT), args.checkpoint_interval, dict(options=saved))
		if resumed is None:
			output.update(run)
	expected = max(expectedEnd(run), 1.01 * run.time)
	already = resumed or 0.
	with progress(1e6 * (expected - already), results.name(args), 'us') as bar:
		while not run.finished:
			try:
				run.advance()
			except (RuntimeError, KeyboardInterrupt):
				if keeper:  # a refused step leaves the state before it
					keeper.update(run, end=True)
					print('penetration: the state at %.2f us is in %s' % (1e6 * run.time, keeper.path), file=sys.stderr)
				raise
			rate = (run.last['step'] - run.startStep) / run.stepSeconds
			if run.time > expected and not run.finished:  # as much longer as the criterion looks back
				expected = min(run.longest, run.time + run.window) if run.until is None else run.time
				bar.grow(1e6 * (expected - already))
			bar.update(1e6 * (min(run.time, expected) - already), stepsPerSecond=float(rate), energy=run.sane()['energySum'], energyBooked=run.sane()['energyBooked'])
			if keeper:
				output.update(run)
				keeper.update(run)
	wall = time.perf_counter() - began
	results.add(report, run, args, wall)
	print(results.text(run, args), flush=True)
	if keeper:
		finish(run, args, report, output, keeper, began, wall)


def finish(run, args, report, output, keeper, began, wall):
	"""Writes what is written at the end, the numbers first. Files that cannot be written are named in one error at the end; everything else is there then."""
	record, summary = report.extra['penetration'], os.path.join(args.out, 'summary.json')
	record['checkpointFailures'] = keeper.failures
	output.attempt(summary, report.write, summary)
	output.update(run, end=True)
	keeper.update(run, end=True)
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
