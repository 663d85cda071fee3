# SPDX-License-Identifier: GPL-2.0-or-later
"""README.md: its tables are those of the stored results, its script runs, its commands and files exist."""
import json
import re
from pathlib import Path

import pytest

from yade_mca.tasks import readme, registry

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / 'README.md').read_text()


def test_tablesAreThoseOfTheResults(plugin):
	assert readme.filled(TEXT, readme.results()) == TEXT, 'run pyscripts/run readme'
	assert len(readme.results()) >= 3 and '| grid: wave speeds | ' in TEXT


def test_everyTableCarriesItsCommand():
	for name, result in readme.results().items():
		assert result['command'] == 'pyscripts/run ' + ' '.join(readme.JOBS[name][0])
		assert '`%s`' % result['command'] in TEXT, name


def test_aChangedResultShows(plugin):
	found = json.loads(json.dumps(readme.results()))
	for case in found['verify-grid']['cases']:
		case['passed'] = False
	assert '| 0 of ' in readme.filled(TEXT, found)


def test_unknownSectionIsRefused(plugin):
	with pytest.raises(registry.UsageError):
		readme.filled('<!-- readme: nothing -->\n<!-- end -->', {})


def test_theScriptRuns(plugin, capsys):
	from yade import O
	script = re.search(r'```python\n(.*?)```', TEXT, re.S)[1]
	assert len([line for line in script.splitlines() if line.strip()]) <= 15
	exec(script, {})
	out = capsys.readouterr().out
	assert int(re.search(r'(\d+) links broken', out)[1]) > 0 and O.iter == 2000


def test_filesAndTasksExist():
	for path in re.findall(r'[`(\s](?:\.\./)?((?:plugin|pyscripts|tests|patches)/[\w./-]+)', TEXT + (ROOT / 'plugin' / 'CONTRIBUTING.md').read_text()):
		path = path.rstrip('.')
		if '*' not in path: assert (ROOT / path).exists() or path.startswith('tests/<'), path
	for task in re.findall(r'pyscripts/run (\w+)', TEXT + (ROOT / 'plugin' / 'CONTRIBUTING.md').read_text()):
		assert task in registry.TASKS, task

