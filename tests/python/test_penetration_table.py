# SPDX-License-Identifier: GPL-2.0-or-later
"""Tasks `table1` and `study` on the coarsest scene there is, and the tables made of their results."""
import json

import pytest

from yade_mca.tasks import cli, table1
from yade_mca.tasks.penetration import doc as penetration_doc, report as penetration_report


@pytest.fixture(autouse=True)
def needsThePlugin(plugin):
	pass


@pytest.mark.parametrize('argv, word', [
        (['table1', '--spacing', '-1'], 'above 0'),
        (['table1', '--spacing', '4'], 'whole number of spacings'),
        (['table1', '--mode', 'mca'], 'unrecognized'),
        (['table1', '--out', '/proc/self/x'], 'cannot make'),
        (['study', 'colours'], 'convergence, seeds, options, width'),
        (['study', '--spacing', '0'], 'above 0'),
        (['study', '--doc', '/no/such/folder'], 'does not exist'),
])
def test_wrongOptionsEndInOneLineAndStatus2(capsys, argv, word):
	assert cli.main(argv) == 2
	shown = capsys.readouterr()
	assert word in shown.err and shown.err.count('\n') == 1 and not shown.out


def test_table(tmp_path, capsys, monkeypatch):
	"""Two thicknesses stand for the six."""
	monkeypatch.setattr(table1, 'THICKNESSES', (15., 40.))
	cli.main(['table1', '--spacing', '5', '--longest', '70', '--json', str(tmp_path / 't.json'), '--out', str(tmp_path)])
	data = json.loads((tmp_path / 't.json').read_text())
	c = {x['name']: x for x in data['cases']}
	for t in (15, 40):
		for mode in ('coupled', 'mca'):
			name = 'T%d/%s/' % (t, mode)
			assert c[name + 'lengthLoss']['reference'] == penetration_report.published(t, mode)[0]
			assert 0 < c[name + 'velocityLossTail']['value'] < c[name + 'velocityLossAll']['value'] < 0.5
			assert c[name + 'energyBooked']['passed'] and c[name + 'momentumBooked']['passed'] and c[name + 'automataLost']['value'] == 0
	for row in data['table1']['rows']:
		assert row['atExit/lengthLossGeometric'] is None or 0 < row['atExit/lengthLossGeometric'] < row['lengthLoss'] + 0.1
	assert data['table1']['rows'][0]['atExit/lengthLossGeometric'] > 0 and 'as a length' in data['table1']['definitions']['lengthLossGeometric']
	assert c['coupled/velocityLossAll/rises']['passed'] and c['mca/lengthLoss/rises']['passed']
	assert c['wall']['value'] > 0 and (tmp_path / 'table1.png').stat().st_size > 10000
	shown = capsys.readouterr().out
	assert 'As a length, when the head leaves the plate' in shown and 'published' in shown and 'Tate' in shown and 'experiment at 25 mm' in shown and 'total' in shown
	assert penetration_doc.write(str(tmp_path)) == ['table1']
	text = (tmp_path / 'penetration-table1.inc').read_text()
	assert '.. list-table::' in text and '%.3f' % c['T15/coupled/lengthLoss']['value'] in text and 'as length, at exit' in text


def test_aRunThatFailsIsReportedNotLost(capsys, monkeypatch):
	monkeypatch.setattr(table1, 'THICKNESSES', (15.,))
	monkeypatch.setattr(table1, 'child', lambda words, threads: (_ for _ in ()).throw(RuntimeError('no luck')))
	assert cli.main(['table1', '--spacing', '5']) == 1
	assert 'no luck' in capsys.readouterr().err


def test_published_numbers():
	assert penetration_report.published(25, 'coupled') == (0.28, 0.07) and penetration_report.published(40, 'mca') == (0.39, 0.12)
	assert penetration_report.published(22, 'mca') == (None, None)
	assert penetration_report.experiment() == dict(thickness=25., lengthLoss=0.24, velocityLoss=0.05)
	assert penetration_report.tate(25)['lengthLoss'] == pytest.approx(0.277, abs=1e-3) and penetration_report.tate(40)['velocityLoss'] == pytest.approx(0.042, abs=1e-3)
