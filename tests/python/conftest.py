# SPDX-License-Identifier: GPL-2.0-or-later
"""Puts the package, this folder and stock YADE on the path, so that `pytest tests/python` works from anywhere.

Where the compiled part is not built, the modules tested here that only compute work all the same. Tests that need it ask for the fixture `plugin`
and are skipped then.
"""
import sys
from pathlib import Path

import hypothesis
import pytest

hypothesis.settings.register_profile('tests', deadline=None)  # a busy machine is no failure
hypothesis.settings.load_profile('tests')

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parents[1] / 'pyscripts' / 'yade_mca'
for p in (HERE, PACKAGE.parent):
	if str(p) not in sys.path:
		sys.path.insert(0, str(p))
for p in Path('/usr/lib').glob('*/yade-double/py'):  # where Debian's package keeps the module `yade`
	if str(p) not in sys.path:
		sys.path.append(str(p))

import yade_mca.measure  # noqa: E402  a module first, so that the package is there whether its classes can be loaded or not

try:
	yade_mca.classes
	MISSING = None
except ImportError as e:
	MISSING = str(e)


@pytest.fixture
def plugin():
	"""The loaded package yade_mca with an empty scene before and after."""
	if MISSING:
		pytest.skip(MISSING)
	from yade import O
	O.reset()
	yield yade_mca
	O.reset()
