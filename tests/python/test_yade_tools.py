# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE's own tools work with the classes of the plugin: plot, PyRunner, energy, timing, saving, VTKRecorder, batch."""
import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def coupled(plugin):
	"""A rod on a plate, automata and grid, 100 automata."""
	from yade_mca import scenes
	return scenes.penetration(thickness=10e-3, spacing=2e-3, rodLength=20e-3, rodDiameter=8e-3, automataWidth=30e-3, plateWidth=50e-3, engineOptions=dict(account=True))


def test_plotAndPyRunner(coupled, tmp_path):
	import yade.plot
	from yade import O, PyRunner
	yade.plot.reset()
	import builtins
	builtins.record = lambda: yade.plot.addData(t=O.time, e=coupled.automata.energies()['kinetic'], v=float(O.bodies[int(coupled.ids['rod'][0])].state.vel[1]))
	coupled.automata.writePeriod = 10
	O.engines = O.engines + [PyRunner(command='record()', iterPeriod=10)]
	O.run(101, True)
	assert len(yade.plot.data['t']) >= 10 and np.ptp(yade.plot.data['e']) > 0
	assert len(set(yade.plot.data['v'])) > 5  # bodies were written back while running
	yade.plot.plots = {'t': ('e', )}
	figure = yade.plot.plot(noShow=True)
	figure.savefig(tmp_path / 'plot.png')
	yade.plot.saveDataTxt(str(tmp_path / 'data.txt'))
	assert (tmp_path / 'plot.png').stat().st_size > 5000
	assert np.loadtxt(tmp_path / 'data.txt').shape == (len(yade.plot.data['t']), 3)


def test_trackEnergy(coupled):
	from yade import O
	O.trackEnergy = True
	O.run(50, True)
	tracked, own = dict(O.energy.items()), coupled.automata.energies()
	assert len(tracked) >= 8
	kinetic = [v for k, v in tracked.items() if 'kinetic' in k.lower()]
	assert any(v == pytest.approx(own['kinetic'], rel=1e-12) for v in kinetic), (tracked, own)
	assert any(v == pytest.approx(coupled.grid.energies()['internal'], rel=1e-12) for v in tracked.values())


def test_timingShowsThePhases(coupled, capfd):
	import yade.timing
	from yade import O
	O.timingEnabled = True
	try:
		yade.timing.reset()
		O.run(50, True)
		for engine in (coupled.automata, coupled.couplers[-1]):  # the last coupler integrates both, so it has phases, too
			assert engine.execCount == 50 and engine.execTime > 0
			phases = engine.timingDeltas.data
			assert len(phases) >= 2 and all(time >= 0 for _, time, _ in phases)
			assert 0 < sum(time for _, time, _ in phases) <= 1.01 * sum(e.execTime for e in O.engines)
		capfd.readouterr()
		yade.timing.stats()
		text = capfd.readouterr().out
	finally:
		O.timingEnabled = False
	for name, _, _ in coupled.automata.timingDeltas.data:
		assert name in text
	assert 'McaEngine' in text and 'McaGridEngine' in text


def test_saveAndLoadInMemoryAndOnDisk(coupled, tmp_path):
	from yade import O
	O.run(50, True)
	O.saveTmp()
	O.save(str(tmp_path / 'scene.xml.bz2'))
	O.run(50, True)
	onward = O.engines[1].field('vy')
	for load in (lambda: O.loadTmp(), lambda: O.load(str(tmp_path / 'scene.xml.bz2'))):
		load()
		O.run(50, True)
		assert np.array_equal(O.engines[1].field('vy'), onward)


def test_vtkRecorder(coupled, tmp_path):
	from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
	from yade import O
	from yade.wrapper import VTKRecorder
	coupled.automata.writePeriod = 20
	O.engines = O.engines + [VTKRecorder(iterPeriod=20, recorders=['spheres', 'velocity', 'colors', 'id'], fileName=str(tmp_path / 'r-'))]
	O.run(41, True)
	files = sorted(tmp_path.glob('r-spheres*.vtu'))
	assert len(files) >= 2
	reader = vtkXMLUnstructuredGridReader()
	reader.SetFileName(str(files[-1]))
	reader.Update()
	data = reader.GetOutput()
	assert data.GetNumberOfPoints() == coupled.automata.count
	assert data.GetPointData().GetArray('linVelVec').GetRange(1)[0] < -1000


def test_batchRunsATableOfAnExample(tmp_path):
	for end in ('.py', '.table'):
		(tmp_path / ('pair' + end)).write_text((ROOT / 'pyscripts' / 'examples' / ('pair' + end)).read_text())
	(tmp_path / 'pair.table').write_text('description dtFactor periods\na 0.2 3\nb 0.1 3\n')
	done = subprocess.run([str(ROOT / 'pyscripts' / 'yade-mca-batch'), '-j1', 'pair.table', 'pair.py'], cwd=tmp_path, env=dict(os.environ), stdin=subprocess.DEVNULL, capture_output=True,
	                      text=True, timeout=200)
	logs = {p.name: p.read_text() for p in tmp_path.glob('*.log')}
	assert done.returncode == 0 and len(logs) == 2, (done.stdout, logs)
	assert all('EXPECT period' in text and 'Unexpected' not in text for text in logs.values()), logs
	assert {re.search(r'pair\.py\.(\w+)\.log', name)[1] for name in logs} == {'a', 'b'}

