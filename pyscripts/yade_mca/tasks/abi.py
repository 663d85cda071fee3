# SPDX-License-Identifier: GPL-2.0-or-later
"""`abi`: an installed YADE beside the declarations of the plugin. `pyscripts/run abi` starts plugin/sdk/abi.py itself, for where it is needed most the plugin cannot be loaded."""
import os
import sys

from . import environment, registry
from .registry import UsageError

SUMMARY = registry.SUMMARIES['abi']


def addArguments(parser):
	parser.add_argument('--yade', metavar='FOLDER', default='/usr/lib/x86_64-linux-gnu/yade-double', help='folder of libyade.so (default: %(default)s)')


def check(args):
	if not (environment.SOURCE / 'plugin' / 'sdk' / 'abi.py').exists():
		raise UsageError('abi compares with the declarations in the source tree; there is none here')


def run(args, report, progress):
	sys.path.insert(0, str(environment.SOURCE / 'plugin' / 'sdk'))
	import abi
	found = abi.compare(os.path.abspath(args.yade))
	abi.show(found)
	for name in ('tables', 'slots', 'symbols'):
		report.add(name, found[name] or 0)
	report.add('sizes', len(found['sizes']))
	report.add('differences', len(found['differences']), passed=not found['differences'])
