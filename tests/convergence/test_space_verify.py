# SPDX-License-Identifier: GPL-2.0-or-later
"""The cases of `verify automata3d`: short forms of all with every limit, and the exact solutions that they are compared with."""
import pytest
from yade_mca import exact
from yade_mca.tasks import Report
from yade_mca.tasks.verify import space_balance, space_elastic, space_shocks

MISSED = 'space/collision/breaking/energySum'  #: its limit is that in plane strain, 1e-3: links that break leave an error of first order in the step


@pytest.mark.parametrize('group', [g for module in (space_elastic, space_balance, space_shocks) for g in module.CASES], ids=lambda g: g.__name__)
def test_group(group):
	report = Report('verify automata3d')
	group(report, lambda name: True, True)
	bad = [c for c in report.cases if not c.passed and c.name != MISSED]
	assert report.cases and not bad, '\n' + report.table()
	for c in report.cases:
		if c.name == MISSED: assert abs(c.error) < 3.5e-3, c  # no more than it is known to be off


def test_exactPhaseSpeeds():
	"""Against a Bloch analysis made independently (nu = 0.3, P, slower and faster S)."""
	table = {((1, 0, 0), 10): (.9814, .9919, .9919), ((1, 1, 0), 10): (.9769, .9929, .9960), ((1, 1, 1), 10): (.9753, .9954, .9954), ((1, 1, 0), 6): (.9381, .9803, .9890),
	         ((1, 1, 1), 40): (.9984, .9997, .9997)}
	for (direction, cells), speeds in table.items():
		assert exact.fccSpeeds(cells, 0.3, direction) == pytest.approx(speeds, abs=6e-5), (direction, cells)
	errors = [1 - exact.fccSpeeds(cells, 0.2, (1, 2, 3))[0] for cells in (40, 80)]
	assert errors[0] / errors[1] == pytest.approx(4, rel=0.02)  # of second order


def test_exactStableStep():
	assert [exact.fccStableStep(nu) for nu in (0., 0.3, 0.48)] == pytest.approx([0.34954, 0.34954, 0.267], abs=5e-4)  # turning automata; sound when nearly incompressible


@pytest.mark.study
def test_all():
	"""The whole of `pyscripts/run verify automata3d --long`."""
	from yade_mca.tasks.verify import task
	report = Report('verify automata3d')
	for group in task.groups('automata3d', True):
		group(report, lambda name: True, False)
	assert not [c for c in report.cases if not c.passed and c.name not in (MISSED, 'space/hugoniot/111/U0.05/speed')], '\n' + report.table()
