# SPDX-License-Identifier: GPL-2.0-or-later
"""`check`: runs the examples with coarse settings and compares their numbers with those they expect."""
import os
import re
import subprocess
import sys
import time

from . import registry
from .registry import UsageError

SUMMARY = registry.SUMMARIES['check']
HERE = os.path.dirname(os.path.abspath(__file__))
#: scripts of the source tree, and where the package installs them
FOLDERS = (os.path.join(HERE, '..', '..', 'examples'), '/usr/share/yade-mca/examples')
LAUNCHERS = (os.path.join(HERE, '..', '..', 'yade-mca'), '/usr/bin/yade-mca')
LINE = re.compile(r'^EXPECT (.*?): (\S+) (\S*), expected (\S+), off (\S+) \(allowed (\S+)\)$', re.M)


def first(paths):
	for p in paths:
		if os.path.exists(p): return os.path.abspath(p)
	raise UsageError('no examples here (looked in %s)' % ', '.join(os.path.abspath(p) for p in paths))


def names():
	"""Examples that have a table, sorted."""
	folder = first(FOLDERS)
	return sorted(f[:-6] for f in os.listdir(folder) if f.endswith('.table') and os.path.exists(os.path.join(folder, f[:-6] + '.py')))


def runExample(name, line=2, timeout=600):
	"""Runs one example with a line of its table, as yade-batch does: (status, output, [(name, value, unit, expected, off, allowed)])."""
	folder = first(FOLDERS)
	environment = dict(os.environ, YADE_BATCH='%s:%d' % (os.path.join(folder, name + '.table'), line), OMP_WAIT_POLICY='passive', GOMP_SPINCOUNT='1000', MPLBACKEND='Agg')
	command = [sys.executable, first(LAUNCHERS), '-n', '-x', os.path.join(folder, name + '.py')]
	done = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout)
	found = [(n, float(v), unit, float(e), float(off), float(limit)) for n, v, unit, e, off, limit in LINE.findall(done.stdout)]
	return done.returncode, done.stdout, found


def addArguments(parser):
	parser.add_argument('--only', metavar='NAME', action='append', help='this example only; may be given several times')


def check(args):
	for name in args.only or ():
		if name not in names():
			raise UsageError("no example '%s'; there are %s" % (name, ', '.join(names())))


def run(args, report, progress):
	wanted = args.only or names()
	with progress(len(wanted), 'examples', 'examples') as bar:
		for n, name in enumerate(wanted):
			start = time.monotonic()
			status, output, found = runExample(name)
			for case, value, unit, expected, off, limit in found:
				report.add('%s/%s' % (name, case), value, expected, error=off, limit=limit, unit=unit)
			report.add(name + '/wall', time.monotonic() - start, unit='s', passed=status == 0 and len(found) > 0)
			if status != 0: print(output)
			bar.update(n + 1)
