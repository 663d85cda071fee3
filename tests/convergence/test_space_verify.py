# SPDX-License-Identifier: GPL-2.0-or-later
"""The cases of `verify automata3d` with their limits: the cheap ones."""
import pytest

import yade_mca.tasks.verify.space_balance as balance
import yade_mca.tasks.verify.space_elastic as elastic
from yade_mca.tasks import Report


@pytest.mark.parametrize('group', [elastic.uniform, elastic.phaseSpeeds, elastic.stableStep, elastic.tension, balance.collision], ids=lambda v: v.__name__)
def test_group(group):
	report = Report('verify automata3d')
	group(report, lambda name: True, True)
	assert report.cases and not report.failed, '\n' + report.table()
