# SPDX-License-Identifier: GPL-2.0-or-later
"""Arguments of the tasks, and running one: wrong options end with one line and status 2."""
import argparse
import difflib
import os
import sys
import traceback

from . import registry, streams
from .progress import Progress
from .registry import UsageError
from .report import Report, isPlain

PROGRAM = os.environ.get('YADE_MCA_PROGRAM', 'pyscripts/run')


class Parser(argparse.ArgumentParser):
	"""argparse with one line per error."""

	def __init__(self, *args, **options):
		super().__init__(*args, allow_abbrev=False, **options)

	def error(self, message):
		raise UsageError('%s (see %s --help)' % (message, self.prog))


def positive(kind=float, unit=''):
	"""A type for argparse: a finite number above 0."""

	def convert(text):
		try:
			value = kind(text)
		except ValueError:
			value = None
		if value is None or not 0 < value < float('inf'):
			raise argparse.ArgumentTypeError("'%s' is not %s above 0%s" % (text, 'a whole number' if kind is int else 'a number', ' [%s]' % unit if unit else ''))
		return value

	return convert


def commonArguments(parser):
	parser.add_argument('--json', metavar='FILE', help='write the result as one JSON object')
	parser.add_argument('--out', metavar='DIR', help='folder for pictures and data')
	parser.add_argument('--threads', metavar='N', type=positive(int), help='OpenMP threads (default: OMP_NUM_THREADS, else all processors)')
	parser.add_argument('--debug', action='store_true', help='show the traceback of an error')


def writable(folder, what):
	"""Raises UsageError when files cannot be made in `folder`."""
	if not os.path.isdir(folder):
		raise UsageError("%s: folder '%s' does not exist" % (what, folder))
	if not os.access(folder, os.W_OK | os.X_OK):
		raise UsageError("%s: folder '%s' is not writable" % (what, folder))


def checkCommon(args):
	if args.json is not None:
		if os.path.isdir(args.json) or not args.json:
			raise UsageError("--json: '%s' is not a file name" % args.json)
		if isPlain(args.json):
			writable(os.path.dirname(os.path.realpath(args.json)), '--json')
		elif not os.access(args.json, os.W_OK):
			raise UsageError("--json: '%s' is not writable" % args.json)
	if args.out is not None:
		try:
			os.makedirs(args.out, exist_ok=True)
		except OSError as e:
			raise UsageError("--out: cannot make folder '%s': %s" % (args.out, e.strerror)) from None
		writable(args.out, '--out')


def usage():
	lines = ['usage: %s TASK [options]' % PROGRAM, '', 'tasks:']
	lines += ['  %-12s %s' % item for item in registry.SUMMARIES.items()]
	return '\n'.join(lines + ['', '%s TASK --help shows the options of a task' % PROGRAM])


def parse(argv):
	"""(args, module) of a command line; raises UsageError."""
	if not argv or argv[0].startswith('-') or argv[0] == 'help':
		if argv and argv[0] in ('-h', '--help', 'help'):
			print(usage())
			raise SystemExit(0)
		raise UsageError('which task? %s (see %s --help)' % (', '.join(registry.TASKS), PROGRAM))
	task = argv[0]
	if task not in registry.TASKS:
		near = difflib.get_close_matches(task, registry.TASKS, 1)
		raise UsageError("unknown task '%s'%s; tasks are %s" % (task, " (did you mean '%s'?)" % near[0] if near else '', ', '.join(registry.TASKS)))
	module = registry.load(registry.TASKS[task])
	parser = Parser(prog='%s %s' % (PROGRAM, task), description=module.SUMMARY)
	commonArguments(parser)
	module.addArguments(parser)
	args = parser.parse_args(argv[1:])
	checkCommon(args)
	if hasattr(module, 'check'):
		module.check(args)
	args.task = task
	return args, module


def setThreads(args):
	"""OpenMP reads its number of threads once, when YADE is loaded: start anew with the number that was asked for."""
	if args.threads and os.environ.get('OMP_NUM_THREADS') != str(args.threads):
		os.environ['OMP_NUM_THREADS'] = str(args.threads)
		sys.stdout.flush()
		sys.stderr.flush()
		os.execv(sys.executable, [sys.executable, '-m', __package__, *sys.argv[1:]])


def main(argv=None):
	"""Runs a task; returns the status of the process. argv: None for the words of the command line."""
	if argv is not None:
		return runTask(argv)
	streams.install()
	status = runTask(None)
	why = streams.refused()
	if why:
		print('%s: the standard output could not be written: %s' % (PROGRAM, why), file=sys.stderr)
	return 1 if why and not status else status


def runTask(argv):
	try:
		args, module = parse(sys.argv[1:] if argv is None else argv)
	except UsageError as e:
		print('%s: %s' % (PROGRAM, e), file=sys.stderr)
		return 2
	if argv is None:
		setThreads(args)
	report = Report(module.title(args) if hasattr(module, 'title') else args.task)
	try:
		module.run(args, report, Progress)
	except UsageError as e:
		print('%s: %s' % (PROGRAM, e), file=sys.stderr)
		return 2
	except KeyboardInterrupt:
		report.error = 'interrupted'
	except Exception as e:
		report.error = '%s: %s' % (type(e).__name__, e)
		if args.debug:
			traceback.print_exc()
	report.show()
	if report.error:
		print('%s: %s' % (PROGRAM, report.error), file=sys.stderr)
	if args.json:
		try:
			report.write(args.json)
		except OSError as e:
			print("%s: cannot write '%s': %s" % (PROGRAM, args.json, e.strerror), file=sys.stderr)
			return 1
	return report.exitCode
