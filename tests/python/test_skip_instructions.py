# SPDX-License-Identifier: GPL-2.0-or-later
"""What features cost that do nothing, counted in instructions: the same on any machine and under any load. Slow (valgrind)."""
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

PROGRAM = Path(os.environ.get('YADE_MCA_BUILD', Path(__file__).resolve().parents[2] / 'build')) / 'bench' / 'skip_count'
pytestmark = pytest.mark.study


@pytest.fixture(scope='module')
def perStep():
	"""Function: instructions of one step with a feature, from runs of two lengths, so that building and leaving cancel."""
	if not PROGRAM.exists() or not shutil.which('valgrind'):
		pytest.skip('needs the built program %s and valgrind' % PROGRAM)
	known = {}

	def count(feature, steps):
		done = subprocess.run(['valgrind', '--tool=callgrind', '--callgrind-out-file=/dev/null', str(PROGRAM), feature, str(steps)], capture_output=True, text=True, env=dict(os.environ, OMP_NUM_THREADS='1'))
		assert done.returncode == 0, done.stderr
		return int(re.search(r'Collected\s*:\s*(\d+)', done.stderr)[1])

	def get(feature):
		if feature not in known:
			known[feature] = (count(feature, 60) - count(feature, 20)) / 40
		return known[feature]

	return get


@pytest.mark.parametrize('present, absent', [('spread', 'none'), ('gruneisen', 'none'), ('friction', 'none'), ('none', 'contacts'), ('none', 'awake')])
def test_aFeatureThatDoesNothingCostsNoInstructions(perStep, present, absent):
	assert perStep(present) <= 1.02 * perStep(absent)


@pytest.mark.parametrize('more, less', [('account', 'none'), ('strength', 'none'), ('none', 'elastic'), ('none', 'inviscid')])
def test_leavingAFeatureOutSavesItsInstructions(perStep, more, less):
	"""No account, no test of strengths, no plasticity and no viscosity where the scene has none."""
	assert perStep(more) > 1.005 * perStep(less)


def test_whatWallsCost(perStep):
	"""A wall that nothing touches, and one along a whole side of a block of 40 x 40 automata: more of them touch it than of a rod of the main job."""
	assert perStep('wallFar') <= 1.005 * perStep('none')
	assert perStep('wallTouching') <= 1.03 * perStep('none')
