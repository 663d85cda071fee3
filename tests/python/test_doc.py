# SPDX-License-Identifier: GPL-2.0-or-later
"""The documentation: every attribute is described with its unit, equation numbers and file names hold, the HTML builds without warnings."""
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOC = ROOT / 'plugin' / 'doc'
PAGES = sorted(DOC.rglob('*.rst'))
FORMULATION = {p.name: p.read_text() for p in PAGES if p.parent.name == 'formulation'}
NUMBERS = re.findall(r'\\tag\{(\d+[a-z]?)\}', '\n'.join(FORMULATION.values()))


def members(plugin):
	for name in plugin.classes:
		cls = getattr(plugin, name)
		for key, member in cls.__dict__.items():
			if not key.startswith('_'):
				yield name, key, member


def test_everyMemberHasADocstringAndEveryNumberAUnit(plugin):
	"""Attributes that are real numbers or vectors of them name their unit in [brackets]."""
	lacking, walked = [], 0
	for name, key, member in members(plugin):
		walked += 1
		doc = member.__doc__ or ''
		kind = re.search(r':yattrtype:`([^`]*)`', doc)
		text = re.sub(r':y\w+:`[^`]*`', '', doc).strip()
		if not text or (kind and re.search('Real|Vector|Matrix', kind[1]) and not re.search(r'\[[^\]]+\]', text)):
			lacking.append('%s.%s: %r' % (name, key, text))
	assert walked > 100 and not lacking, lacking


#: when an attribute that can be set is read. 'look': the first step or call after a script could change something
READ = re.compile(r"""[Rr]ead\ in\ every\ step | [Rr]ead\ at\ every\ look | [Oo]utput\b
	| [Rr]ead\ when\ (bodies\ are\ gathered | a\ body\ is\ taken\ over | automata\ are\ taken\ in | strengths\ are\ drawn | links\ are\ made | the\ row\ is\ tied | the\ first\ block\ is\ added)""", re.X)


def readWhen(member):
	"""True for what cannot be set, too: nobody reads it."""
	return not isinstance(member, property) or member.fset is None or bool(READ.search(re.sub(r':y\w+:`[^`]*`', '', member.__doc__ or '')))


def test_everyAttributeSaysWhenItIsRead(plugin):
	settable = [(name, key, m) for name, key, m in members(plugin) if isinstance(m, property) and m.fset]
	assert len(settable) > 60
	assert [(name, key) for name, key, m in settable if not readWhen(m)] == []


def test_aNewAttributeMustSayIt():
	assert not readWhen(property(lambda s: 1, lambda s, v: None, doc='how deep [m]'))
	assert readWhen(property(lambda s: 1, lambda s, v: None, doc='how deep [m]; read in every step')) and readWhen(property(lambda s: 1, doc='how deep [m]'))


def test_everyClassHasADocstring(plugin):
	for name in plugin.classes:
		assert len(getattr(plugin, name).__doc__.strip()) > 20, name


def test_equationNumbersAreUnique():
	assert len(NUMBERS) > 30
	assert len(set(NUMBERS)) == len(NUMBERS), sorted(n for n in NUMBERS if NUMBERS.count(n) > 1)


def test_codeRefersToEquationsThatExist():
	"""(12), (5)-(9): in comments of kernels and solvers, a number in brackets is that of an equation."""
	wrong = []
	for source in [p for folder in ('kernels', 'automata', 'grid', 'interface') for p in (ROOT / 'plugin' / folder).glob('*.[ch]pp')]:
		for comment in re.findall(r'//(.*)', source.read_text()):
			for number in re.findall(r'(?<![\w\])])\((\d{1,2}[a-z]?)\)', comment):
				if number not in NUMBERS: wrong.append('%s: (%s)' % (source.name, number))
	assert not wrong, wrong


def test_filesNamedInThePagesExist():
	named = 0
	for page in PAGES:
		for path in re.findall(r'``((?:plugin|pyscripts|tests|patches)/[\w./-]+\.\w+|(?:plugin|pyscripts|tests|patches)(?:/[\w-]+)+)``', page.read_text()):
			named += 1
			assert (ROOT / path).exists(), (page.name, path)
	assert named > 30


def test_everyEquationPageNamesFiles():
	for name, text in FORMULATION.items():
		if r'\tag' in text: assert 'File: ``' in text or name == 'departures.rst', name


def test_htmlBuildsWithoutWarnings(plugin, tmp_path):
	done = subprocess.run([sys.executable, '-m', 'sphinx', '-W', '--keep-going', '-q', '-b', 'html', '-d', str(tmp_path / 'trees'), str(DOC), str(tmp_path / 'html')],
	                      capture_output=True, text=True, timeout=300)
	assert done.returncode == 0, done.stdout + done.stderr
	page = (tmp_path / 'html' / 'reference-classes.html').read_text()
	for name in plugin.classes:
		assert 'id="%s"' % name in page, name
	for key in ('volumeRule', 'fractureStrain', 'addRectangle'):
		assert key in page


@pytest.mark.parametrize('page', PAGES, ids=lambda p: p.name)
def test_pythonInThePagesRuns(plugin, page, tmp_path, monkeypatch):
	"""Code blocks of the guide run as printed."""
	from yade import O
	monkeypatch.chdir(tmp_path)
	for block in re.findall(r'\.\. code-block:: python\n\n((?:   .*\n|\n)+)', page.read_text()):
		O.reset()
		exec(re.sub(r'^   ', '', block, flags=re.M), {})
