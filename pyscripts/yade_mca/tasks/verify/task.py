# SPDX-License-Identifier: GPL-2.0-or-later
"""`verify [automata|automata3d|grid|interface|all]`: the solvers against exact solutions, their balances and cost. The modules of each part: registry.PARTS."""
from .. import registry
from ..registry import UsageError

SUMMARY = registry.SUMMARIES['verify']


def addArguments(parser):
	parser.add_argument('part', nargs='?', default='all', choices=[*registry.PARTS, 'all'], help='what to verify (default: all)')
	parser.add_argument('--quick', action='store_true', help='coarse resolutions only')
	parser.add_argument('--long', action='store_true', help='the cases that take minutes, too (automata3d: all shocks)')
	parser.add_argument('--only', metavar='WORD', help='only the cases whose name contains WORD')


def groups(part, long=False):
	"""Functions of (report, want, quick) that add the cases of a part whose name `want` accepts; long: those that take minutes, too. Raises UsageError when a module is missing."""
	modules = [registry.load(module) for module in registry.PARTS[part]]
	return [group for m in modules for group in (*m.CASES, *(getattr(m, 'LONG', ()) if long else ()))]


def check(args):
	args.groups = {part: groups(part, args.long) for part in (registry.PARTS if args.part == 'all' else [args.part])}


def title(args):
	return 'verify ' + args.part


def run(args, report, progress):
	want = lambda name: args.only is None or args.only in name or name in args.only
	for part, functions in args.groups.items():
		with progress(len(functions), 'verify ' + part, 'group') as bar:
			for k, group in enumerate(functions):
				group(report, want, args.quick)
				bar.update(k + 1)
	if not report.cases:
		raise UsageError('no case was verified%s' % (", no name contains '%s'" % args.only if args.only else ''))
