# SPDX-License-Identifier: GPL-2.0-or-later
"""`verify [automata|grid|interface|all]`: each part is a module verify_PART with run(args, report, progress) and optional addArguments."""
from . import registry
from .registry import UsageError

SUMMARY = registry.SUMMARIES['verify']


def addArguments(parser):
	parser.add_argument('part', nargs='?', default='all', choices=[*registry.PARTS, 'all'], help='what to verify (default: all)')
	parser.add_argument('--quick', action='store_true', help='coarse resolutions only')
	parser.add_argument('--only', metavar='WORD', help='only the cases whose name contains WORD')


def parts(args):
	return list(registry.PARTS) if args.part == 'all' else [args.part]


def check(args):
	args.modules = [registry.load(registry.PARTS[p]) for p in parts(args)]


def title(args):
	return 'verify ' + args.part


def run(args, report, progress):
	for module in args.modules:
		module.run(args, report, progress)
	if not report.cases:
		raise UsageError('no case was verified%s' % (", no name contains '%s'" % args.only if args.only else ''))
