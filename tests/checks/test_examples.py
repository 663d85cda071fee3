# SPDX-License-Identifier: GPL-2.0-or-later
"""Every example runs with the coarse line of its table and its numbers are the expected ones."""
import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / 'pyscripts' / 'examples'
sys.path.insert(0, str(ROOT / 'pyscripts'))
import yade_mca.tasks.check as check

SCRIPTS = sorted(EXAMPLES.glob('*.py'))


@pytest.mark.parametrize('name', check.names())
def test_numbers(name):
	status, output, found = check.runExample(name)
	assert status == 0 and found, output
	for what, value, unit, expected, off, allowed in found:
		assert abs(value - expected) / (abs(expected) or 1) <= allowed + 1e-5, (what, value, expected, allowed)


def test_eachHasATableWithACoarseLine():
	assert {p.stem for p in SCRIPTS} == set(check.names())
	for name in check.names():
		lines = (EXAMPLES / (name + '.table')).read_text().splitlines()
		assert lines[0].split()[0] == 'description' and lines[1].split()[0] == 'coarse', name
		assert all(len(line.split()) == len(lines[0].split()) for line in lines), name


@pytest.mark.parametrize('script', SCRIPTS, ids=lambda p: p.stem)
def test_isShortAndSaysWhatItIsFor(script):
	text = script.read_text()
	doc = ast.get_docstring(ast.parse(text))
	assert len(text.splitlines()) <= 120
	assert 'Purpose:' in doc and 'Expected number' in doc, doc


def test_aWrongNumberFails(tmp_path, monkeypatch):
	"""The status of a script whose number is off is not 0, and the number is reported."""
	(tmp_path / 'off.py').write_text("from yade_mca.expected import expect\nexpect('half', 0.5, 1., 0.1)\n")
	(tmp_path / 'off.table').write_text('description a\ncoarse 1\n')
	monkeypatch.setattr(check, 'FOLDERS', (str(tmp_path), ))
	status, output, found = check.runExample('off')
	assert status != 0 and found[0][:2] == ('half', 0.5) and 'allowed' in output
