# SPDX-License-Identifier: GPL-2.0-or-later
"""`docs`: builds the documentation of the source tree as HTML; warnings are errors."""
import os
import subprocess
import sys

from . import registry
from .registry import UsageError

SUMMARY = registry.SUMMARIES['docs']
ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
SOURCE = os.path.join(ROOT, 'plugin', 'doc')


def addArguments(parser):
	pass


def check(args):
	if not os.path.exists(os.path.join(SOURCE, 'conf.py')):
		raise UsageError('the documentation is built in the source tree only')


def run(args, report, progress):
	out = os.path.abspath(args.out or os.path.join(os.environ.get('YADE_MCA_BUILD', os.path.join(ROOT, 'build')), 'doc'))
	done = subprocess.run([sys.executable, '-m', 'sphinx', '-W', '--keep-going', '-q', '-b', 'html', '-d', os.path.join(out, '.doctrees'), SOURCE, out],
	                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
	warnings = [line for line in done.stdout.splitlines() if 'WARNING' in line or 'ERROR' in line]
	if done.returncode: print(done.stdout)
	report.add('warnings', len(warnings), passed=done.returncode == 0)
	print(os.path.join(out, 'index.html'))
