# SPDX-License-Identifier: GPL-2.0-or-later
"""`verify automata`: the movable cellular automata against exact solutions, their balances."""
from . import automata_balance, automata_elastic, automata_impact, automata_roads, automata_shocks

GROUPS = [*automata_elastic.CASES, *automata_balance.CASES, *automata_roads.CASES, *automata_shocks.CASES, *automata_impact.CASES]


def run(args, report, progress):
	from .. import _yade  # opens YADE and the plugin
	quick, only = getattr(args, 'quick', False), getattr(args, 'only', None)
	want = lambda name: only is None or only in name or name in only
	with progress(len(GROUPS), 'verify automata', 'group') as bar:
		for k, group in enumerate(GROUPS):
			group(report, want, quick)
			bar.update(k + 1)
