# SPDX-License-Identifier: GPL-2.0-or-later
"""The cases of `verify automata`: the cheap ones with every limit, and rates at which errors fall with the spacing and the step."""
import math

import pytest

import yade_mca.tasks.verify.automata_balance as balance
import yade_mca.tasks.verify.automata_elastic as elastic
import yade_mca.tasks.verify.automata_impact as impact
import yade_mca.tasks.verify.automata_roads as roads
import yade_mca.tasks.verify.automata_shocks as shocks
import yade_mca.tasks.verify.automata_surfaces as surfaces
from yade_mca.tasks import Report


def cases(group, only, quick=True):
	report = Report('verify automata')
	group(report, lambda name: only in name or name in only, quick)
	assert report.cases, 'nothing was computed'
	return report


@pytest.mark.parametrize('group, only', [(elastic.uniform, 'uniform'), (elastic.rotation, 'rotation'), (elastic.phaseSpeeds, 'phaseSpeed'), (elastic.stableStep, 'stableStep'),
                                         (balance.reaction, 'reaction'), (balance.longRun, 'longRun'), (roads.roads, 'roads'), (shocks.hugoniot, 'affine/along/U0.05'),
                                         (shocks.hugoniot, 'affine/across/U0.20'), (shocks.precursor, '4340'), (shocks.impact, 'impact'), (impact.taylor, 'taylor'),
                                         (impact.spall, 'depth60d'), (surfaces.strip, 'along'), (surfaces.hole, 'hole/along')], ids=lambda v: v if isinstance(v, str) else v.__name__)
def test_group(group, only):
	report = cases(group, only)
	assert not report.failed, '\n' + report.table()


def rate(errors):
	return math.log(errors[0] / errors[1], 2)


def test_phaseSpeedIsOfSecondOrder():
	"""Error of the speed of a P and an S wave against the continuum at 10 and 20 spacings per wavelength."""
	for kind in 'P', 'S':
		errors = [1 - next(c.value for c in cases(elastic.phaseSpeeds, 'phaseSpeed/%s/along/%dd' % (kind, n), False).cases if c.name.endswith('exact')) for n in (10, 20)]
		assert 1.8 < rate(errors) < 2.2, errors


def test_shockSpeedConvergesWithTheLengthOfTheBar():
	errors = [c.error for c in cases(shocks.hugoniotLength, 'hugoniotLength').cases if c.name.startswith('hugoniotLength/U0.05')]
	assert len(errors) == 2 and errors[1] < 0.6 * errors[0] < 0.01


def test_taylorBarConverges():
	"""Length of the bar at 8 and 16 automata across against that of the grid."""
	errors = [c.error for c in cases(impact.taylor, 'taylor').cases if c.name.endswith('/length') and 'taylor/N' in c.name]
	assert rate(errors) > 0.7, errors


def test_energySumConvergesWithTheStep():
	"""The sum from state functions and dissipations, after an impact with plastic flow and fracture; the booked one is at round-off."""
	found = {c.name.split('/', 1)[1]: c for c in cases(balance.impactBalance, 'impactBalance').cases}
	assert found['energySumAtAQuarter'].order > 0.8  # over two halvings
	assert all(found[k].passed for k in ('momentum', 'angularMomentum', 'bookedEnergy', 'brokenLinks'))


@pytest.mark.study
def test_all():
	"""The whole of `pyscripts/run verify automata`."""
	from yade_mca.tasks.verify import task
	report = Report('verify automata')
	for group in task.groups('automata'):
		group(report, lambda name: True, False)
	assert not report.failed, '\n' + report.table()


def test_bendingIsOfSecondOrder():
	"""A beam of triangles, four and eight spacings high, against Timoshenko."""
	errors = [1 - surfaces.bendingFrequency(rows, 0.) for rows in (4, 8)]
	assert 1.7 < rate(errors) < 2.3 and errors[1] < 0.002, errors
