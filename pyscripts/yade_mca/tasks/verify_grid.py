# SPDX-License-Identifier: GPL-2.0-or-later
"""`verify grid`: the Lagrangian grid against exact solutions, its balances, its cost."""
from . import grid_cost, grid_lamb, grid_shell, grid_shocks, grid_waves

GROUPS = [*grid_waves.CASES, *grid_lamb.CASES, *grid_shocks.CASES, *grid_shell.CASES, *grid_cost.CASES]


def run(args, report, progress):
	from .. import _yade  # opens YADE and the plugin
	quick, only = getattr(args, 'quick', False), getattr(args, 'only', None)
	want = lambda name: only is None or only in name or name in only
	with progress(len(GROUPS), 'verify grid', 'group') as bar:
		for k, group in enumerate(GROUPS):
			group(report, want, quick)
			bar.update(k + 1)
