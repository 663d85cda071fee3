# SPDX-License-Identifier: GPL-2.0-or-later
"""The cases of `verify fracture` that are quick: toughness at one spacing, fragments at one rate. All of them: the study."""
import math

import pytest
from yade_mca.tasks import Report
from yade_mca.tasks.verify import fracture_cracks, fracture_fragments


def test_cracksGrowAtTheirToughness():
	"""At a spacing of 1 mm, the coarsest: K_Ic within 5 % of what was given, below the speed of Rayleigh's waves, energy."""
	G, speed, off = fracture_cracks.grown(1e-3)
	assert math.sqrt(G) == pytest.approx(1, abs=0.05)
	assert 500 < speed < 2800 and abs(off) < 0.005


def test_fragmentsDoNotFollowTheSpacing():
	"""At 1e5/s: twice as many automata along the strip make about as many fragments; without a fracture energy there are as many as columns allow."""
	found = [fracture_fragments.stretched(d, 1e5) for d in (0.25e-3, 0.18e-3)]
	assert max(f[0] for f in found) < 1.5 * min(f[0] for f in found)
	assert all(20 < f[0] < 120 and abs(f[2]) < 1e-3 for f in found)


def test_spall():
	fall, zone, off = fracture_fragments.spallOf(100e-6)
	assert fall == pytest.approx(0.945, abs=0.03) and 0.5e-3 < zone < 4e-3 and abs(off) < 0.005


@pytest.mark.study
def test_all():
	"""The whole of `pyscripts/run verify fracture`."""
	from yade_mca.tasks.verify import task
	report = Report('verify fracture')
	for group in task.groups('fracture'):
		group(report, lambda name: True, False)
	assert not [c for c in report.cases if not c.passed], '\n' + report.table()
