# SPDX-License-Identifier: GPL-2.0-or-later
"""`stress`: numerical stability. Each case held, was refused with a clear error, or failed; none may fail."""
import os

from .. import registry
from ..attempts import Attempts
from ..penetration.options import seed
from ..registry import UsageError
from ..report import writeAtomically

SUMMARY = registry.SUMMARIES['stress']
RATIOS = 'ratios'  #: the word for the cost of what a scene does not need (ratios.py)


def addArguments(parser):
	parser.add_argument('--quick', action='store_true', help='fewer cases and shorter runs, 1 to 2 minutes')
	parser.add_argument('--only', metavar='WORD', help="only the cases whose name contains WORD; '%s': what features cost that a scene does not need" % RATIOS)
	parser.add_argument('--seed', type=seed, default=1, metavar='N', help='of the random scenes and of the noise (default: 1)')


def names(args):
	from . import children
	return [n for n in children.allCases(args.quick, args.seed) if args.only is None or args.only in n]


def ratios(args, report):
	from . import ratios
	for r in ratios.measure(args.quick):
		report.add(**r)


def row(o):
	"""One line of the table on screen."""
	m = o.measures
	show = lambda k: '%.2g' % m[k] if isinstance(m.get(k), float) else '-'
	return '%-52s %-8s energy %-8s booked %-8s momentum %-8s %s' % (o.name, o.outcome, show('energy'), show('booked'), show('momentum'), 'value %.6g' % m['value'] if 'value' in m else '')


def table(outcomes):
	"""The whole table as text: what held with its errors, then what was refused and how, then what failed and why."""
	lines = [row(o) for o in outcomes if o.outcome == 'held']
	for kind in 'refused', 'failed':
		lines += ['', '%s: %d' % (kind, sum(o.outcome == kind for o in outcomes))]
		lines += ['  %s: %s%s' % (o.name, o.text, ' [%s]' % o.measures['scene'] if 'scene' in o.measures else '') for o in outcomes if o.outcome == kind]
	return '\n'.join(lines)


def run(args, report, progress):
	if args.only == RATIOS:
		return ratios(args, report)
	from . import children
	wanted = names(args)
	if not wanted:
		raise UsageError("no case's name contains '%s'" % args.only)
	outcomes, count = [], dict(held=0, refused=0, failed=0)
	with progress(len(wanted), 'stress', 'cases') as bar:
		for o in children.Children(wanted, args.quick, args.seed):
			outcomes.append(o)
			count[o.outcome] += 1
			held = o.outcome == 'held'
			value = o.measures.get('value', o.measures.get('energy')) if held else None
			limit = (o.measures.get('atMost') if 'value' in o.measures else o.energyBound) if held else None
			report.add(o.name, value, limit=limit, unit=o.outcome if 'unit' not in o.measures else '%s: %s' % (o.outcome, o.measures['unit']), passed=o.outcome != 'failed')
			bar.update(len(outcomes), **count)
	report.extra['stress'] = dict(count, seed=args.seed, quick=args.quick, failedCases=[o.name for o in outcomes if o.outcome == 'failed'],
	                              outcomes=[children.readable(o) for o in outcomes])
	text = table(outcomes)
	print(text)
	print('\nheld %d, refused %d, failed %d' % (count['held'], count['refused'], count['failed']))
	if args.out:
		from .doc import page
		attempt = Attempts('stress')
		for name, made in ('stress.txt', text + '\n'), ('stress.inc', page(report.asDict())):
			path = os.path.join(args.out, name)
			attempt(path, writeAtomically, path, made)
		attempt.finish()
