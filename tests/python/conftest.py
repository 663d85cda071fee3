# SPDX-License-Identifier: GPL-2.0-or-later
"""Puts the package, this folder and stock YADE on the path, so that `pytest tests/python` works from anywhere.

Where the compiled part is not built, the package is opened without it: the modules tested here that only compute need no YADE. Tests that
do need it ask for the fixture `plugin` and are skipped then.
"""
import importlib
import sys
import types
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

try:
	importlib.import_module('yade_mca')
	MISSING = None
except ImportError as e:
	MISSING = str(e)
	bare = types.ModuleType('yade_mca')
	bare.__path__ = [str(PACKAGE)]
	sys.modules['yade_mca'] = bare


@pytest.fixture
def plugin():
	"""The loaded package yade_mca with an empty scene before and after."""
	if MISSING:
		pytest.skip(MISSING)
	from yade import O
	O.reset()
	yield sys.modules['yade_mca']
	O.reset()
