# SPDX-License-Identifier: GPL-2.0-or-later
"""`verify interface`: what the line between automata and grid does to waves, rest, motion, balances and cost."""
from . import interface_block, interface_waves

GROUPS = [*interface_block.CASES, *interface_waves.CASES]


def run(args, report, progress):
	from .. import _yade  # opens YADE and the plugin
	quick, only = getattr(args, 'quick', False), getattr(args, 'only', None)
	want = lambda name: only is None or only in name or name in only
	with progress(len(GROUPS), 'verify interface', 'group') as bar:
		for k, group in enumerate(GROUPS):
			group(report, want, quick)
			bar.update(k + 1)
