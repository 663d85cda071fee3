# SPDX-License-Identifier: GPL-2.0-or-later
"""The cases of `verify grid`, coarse: every error below its limit, every balance at round-off."""
import pytest

import yade_mca.tasks.verify.grid_lamb as lamb
import yade_mca.tasks.verify.grid_shell as shell
import yade_mca.tasks.verify.grid_shocks as shocks
import yade_mca.tasks.verify.grid_waves as waves
from yade_mca.tasks import Report


@pytest.mark.parametrize('group, only', [(waves.speeds, 'speed'), (waves.convergence, 'convergence'), (waves.patch, 'patch'), (waves.rotation, 'rotation'),
                                         (lamb.lamb, 'lamb'), (shocks.piston, '4340'), (shocks.piston, 'Al2024/up400'), (shocks.impact, 'WHAonSteel'),
                                         (shocks.impact, 'edge'), (shell.shell, 'stop50')], ids=lambda v: v if isinstance(v, str) else v.__name__)
def test_group(group, only):
	report = Report('verify grid')
	group(report, lambda name: only in name or name in only, True)
	assert report.cases, 'nothing was computed'
	assert not report.failed, '\n' + report.table()
