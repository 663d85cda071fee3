# SPDX-License-Identifier: GPL-2.0-or-later
"""Task `penetration` on a coarse scene: report, files, end of the run, restart after SIGKILL, full disk, damaged checkpoints, wrong options."""
import json
import os
import resource
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest
from support import table

from yade_mca.tasks import cli

PACKAGE = Path(__file__).resolve().parents[2] / 'pyscripts'
SCENE = ['--spacing', '2', '--thickness', '16', '--until', '12']


@pytest.fixture(autouse=True)
def needsThePlugin(plugin):
	pass


def process(*words, **keywords):
	env = dict(os.environ, MPLBACKEND='Agg', OMP_NUM_THREADS='1', PYTHONPATH=str(PACKAGE))
	return subprocess.Popen(['/usr/bin/python3', '-m', 'yade_mca.tasks', 'penetration', *words], env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **keywords)


def result(path):
	return json.loads(Path(path).read_text())


def record(path):
	"""The whole history and the fields at the end: what two identical runs share."""
	return result(path)['penetration']['record']


def cases(path):
	return {c['name']: c for c in result(path)['cases']}


def test_theSumsOfASampleAreThoseOfTheCoupler(plugin):
	from yade import O
	from yade_mca import impact, scenes
	O.reset()
	run = impact.Impact(scenes.penetration(thickness=16e-3, spacing=2e-3))
	run.advance(2)
	b = run.scene.couplers[0].energies()
	assert run.last['grid'] > 0
	for name, value in dict(kinetic=b['kinetic'], total=b['total'], booked=b['booked'], momentumX=b['momentumX'] - b['impulseX'], momentumY=b['momentumY'] - b['impulseY']).items():
		assert abs(run.last[name] - value) <= 1e-12 * (run.impactEnergy + abs(value)), name


@pytest.mark.parametrize('mode', ['coupled', 'mca'])
def test_aRunReportsAndWritesEverything(tmp_path, capsys, mode):
	out = tmp_path / 'out'
	assert cli.main(['penetration', *SCENE, '--mode', mode, '--out', str(out), '--json', str(tmp_path / 'r.json')]) == 0
	c = cases(tmp_path / 'r.json')
	n = 'T16/%s/' % mode
	assert {n + k for k in ('lengthLoss', 'lengthLossUnbroken', 'lengthLossGeometric', 'velocityLossTail', 'velocityLossAll', 'energyError', 'energyBooked', 'momentumBooked', 'automataLost', 'clamped', 'deepest', 'wall')} <= set(c)
	assert 0.02 < c[n + 'lengthLoss']['value'] < 0.4 and 0 < c[n + 'velocityLossTail']['value'] < c[n + 'velocityLossAll']['value'] < 0.3
	assert c[n + 'energyError']['limit'] == 0.01 and c[n + 'energyBooked']['limit'] == 1e-10 and c[n + 'momentumBooked']['limit'] == 1e-12
	names = {p.name for p in out.iterdir()}
	assert {'pattern_00us.png', 'pattern_end.png', 'history.png', 'penetration.pvd', 'penetration.checkpoint', 'penetration.gif', 'penetration.html', 'summary.json', 'paraview'} <= names
	vtk = [p for p in (out / 'paraview').iterdir()]
	assert all(p.stat().st_size > 1000 and not p.name.startswith('.') for p in vtk)
	text = (out / 'penetration.pvd').read_text()
	assert text.count('automata_') == 4 and all(('paraview/' + p.name) in text for p in vtk)
	assert any('grid_' in p.name for p in vtk) == any('interface_' in p.name for p in vtk) == (mode == 'coupled')
	shown = capsys.readouterr().out
	assert 'Alekseevskii-Tate' in shown and 'plastic strain < 0.3' in shown and 'time 12 us reached' in shown


@pytest.mark.parametrize('mode', ['coupled', 'mca'])
def test_obliqueAndTurned(tmp_path, capsys, mode):
	"""To the exit and beyond, by the task: exit is read normal to the face, the published table is for normal impact only, and the run restarts identically."""
	words = ['penetration', '--spacing', '2', '--thickness', '8', '--rod-length', '40', '--mode', mode, '--angle', '-12', '--obliquity', '35', '--until', '30', '--checkpoint-interval', '0.01']
	out = tmp_path / 'out'
	assert cli.main([*words, '--out', str(out)]) == 0
	c, n = cases(out / 'summary.json'), 'T8/%s/' % mode
	r = {k: np.array(v) for k, v in record(out / 'summary.json').items()}
	at = c[n + 'exitTime']['value']
	assert np.interp(at, r['time'], r['clearance']) == pytest.approx(5e-3, rel=1e-6)
	assert at > (8e-3 / np.cos(np.radians(35)) + 5e-3) / 1520  # not before the rod could be there
	assert c[n + 'atExit/lengthLossGeometric']['value'] == pytest.approx(np.interp(at, r['time'], r['lengthLossGeometric']), rel=1e-9) and r['lengthLossGeometric'][0] == pytest.approx(0, abs=1e-3)
	assert all(x['passed'] for x in c.values()) and n + 'publishedLengthLoss' not in c
	shown = capsys.readouterr().out
	assert 'angle -12 deg, obliquity 35 deg' in shown and 'published' not in shown and 'length' in shown
	again = tmp_path / 'again'
	assert cli.main(['penetration', '--restart', str(out / 'penetration.checkpoint'), '--until', '32', '--out', str(again)]) == 0
	whole = tmp_path / 'whole'
	assert cli.main([*words[:-4], '--until', '32', '--out', str(whole)]) == 0
	assert record(again / 'summary.json') == record(whole / 'summary.json')


def test_paraviewFilesHoldTheScene(plugin, tmp_path):
	from vtkmodules.util.numpy_support import vtk_to_numpy
	from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLStructuredGridReader

	from yade_mca import impact, impact_output, scenes
	s = scenes.penetration(thickness=16e-3, spacing=2e-3)
	run = impact.Impact(s, until=5e-6)
	run.advance(4)
	files = impact_output.writeParaview(s, tmp_path, 'x', run.time)
	reader = vtkXMLPolyDataReader()
	reader.SetFileName(files[0])
	reader.Update()
	data = reader.GetOutput()
	assert np.array_equal(vtk_to_numpy(data.GetPoints().GetData())[:, 0], s.automata.field('x'))
	assert np.array_equal(vtk_to_numpy(data.GetPointData().GetArray('plasticStrain')), s.automata.field('plasticStrain'))
	for block, path in zip(sorted(s.blocks), (files[1], files[2])):
		reader = vtkXMLStructuredGridReader()
		reader.SetFileName(path)
		reader.Update()
		p = vtk_to_numpy(reader.GetOutput().GetPoints().GetData())
		assert {tuple(x) for x in p[:, :2].tolist()} == set(zip(np.ravel(s.grid.view(s.blocks[block], 'x')).tolist(), np.ravel(s.grid.view(s.blocks[block], 'y')).tolist()))


def test_unfinishedNamesOfParaviewFilesAreNotCut(tmp_path, monkeypatch):
	from yade_mca import vtk_output
	monkeypatch.setattr(tempfile, '_get_candidate_names', lambda: iter(['abcdefg_', 'abcdefh_']))
	path = vtk_output.writeAutomata(tmp_path / 'a.vtp', np.zeros((10, 2)))
	assert os.path.getsize(path) > 200 and os.listdir(tmp_path) == ['a.vtp']


def test_theRunEndsByTheCriterion(plugin):
	from yade_mca import impact, scenes
	s = scenes.penetration(thickness=4e-3, spacing=2e-3, rodLength=30e-3, mode='mca')
	run = impact.Impact(s)
	while not run.finished:
		run.advance()
	r = run.arrays()
	assert 'has left the plate' in run.reason and run.time < run.longest
	assert r['clearance'][-1] >= 5e-3 and 0 < run.exitTime < run.time
	assert np.interp(run.exitTime, r['time'], r['clearance']) == pytest.approx(5e-3, rel=1e-6)
	recent = r['momentum'][r['time'] >= r['time'][-1] - 10e-6]
	assert np.ptp(recent) <= 1e-3 * r['momentum'][0]
	assert run.reason and not impact.Impact(s, longest=1.).finished


def waitFor(there, p, seconds=60):
	end = time.monotonic() + seconds
	while not there():
		assert p.poll() is None, p.communicate()
		assert time.monotonic() < end
		time.sleep(0.005)


@pytest.mark.parametrize('mode, drawn', [('coupled', 0), ('coupled', 3), ('mca', 2)])
def test_killedAndRestartedEndsIdentically(tmp_path, mode, drawn):
	"""drawn: pictures of the animation that are there when the run is killed, however fast it is."""
	words = ['--mode', mode, '--checkpoint-interval', '0.01', *SCENE]
	whole, parts = tmp_path / 'whole', tmp_path / 'parts'
	p = process(*words, '--out', str(whole))
	assert p.wait(120) == 0, p.communicate()
	p = process(*words, '--out', str(parts))
	waitFor(lambda: (parts / 'penetration.checkpoint').exists() and len(list((parts / 'frames').glob('frame_*.png'))) >= drawn, p)
	p.send_signal(signal.SIGKILL)
	p.wait()
	assert not (parts / 'summary.json').exists(), 'the run was over before it was killed'
	for f in (parts / '.pattern_end.png.abc', parts / '.penetration.html.abc', parts / '.penetration.gif.abc', parts / 'frames' / '.frame_0000000.png', parts / '.penetration.checkpoint.abc', parts / 'paraview' / '.automata_000000.vtp.abc.part'):
		f.write_text('unfinished')
	p = process('--restart', str(parts / 'penetration.checkpoint'), '--until', '12')
	assert p.wait(120) == 0, p.communicate()
	assert record(parts / 'summary.json') == record(whole / 'summary.json')
	values = lambda f: {k: c['value'] for k, c in cases(f).items() if not k.endswith('wall')}
	assert values(parts / 'summary.json') == values(whole / 'summary.json')
	frames = sorted(f.name for f in (whole / 'frames').iterdir())
	assert sorted(f.name for f in (parts / 'frames').iterdir()) == frames and len(frames) > 5
	for f in ('pattern_00us.png', 'pattern_end.png', 'history.png', 'penetration.gif', *('frames/' + f for f in frames)):
		assert (parts / f).read_bytes() == (whole / f).read_bytes(), f
	assert (parts / 'penetration.pvd').read_text() == (whole / 'penetration.pvd').read_text()
	assert not [f for f in os.listdir(parts) + os.listdir(parts / 'paraview') if f.startswith('.')]


def test_fullDiskKeepsTheLastCheckpointAndTheRunGoesOn(plugin, tmp_path, capsys):
	"""A limit on the size of files stands for the full disk: writing fails half-way."""
	from yade_mca import impact, scenes
	from yade_mca.tasks.penetration.task import Keeper
	s = scenes.penetration(thickness=16e-3, spacing=2e-3)
	run = impact.Impact(s, until=12e-6)
	run.advance()
	path = tmp_path / 'c'
	keeper = Keeper(str(path), 0., {})
	keeper.update(run, end=True)
	before = path.read_bytes()
	run.advance()
	signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
	soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
	try:
		resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) // 2, hard))
		keeper.update(run, end=True)
	finally:
		resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
	assert keeper.failures == 1 and 'the run goes on' in capsys.readouterr().err
	assert path.read_bytes() == before and os.listdir(tmp_path) == ['c']
	run.advance()
	keeper.update(run, end=True)
	t = run.time
	again, _ = impact.Impact.load(str(path))
	assert again.time == t


@pytest.mark.parametrize('damage', ['cut', 'bit in the scene', 'bit in the head', 'bit in the arrays', 'longer', 'empty', 'another file', 'missing', 'version'])
def test_damagedCheckpointsAreRefused(plugin, tmp_path, capsys, damage):
	from yade_mca import checkpoint, impact, scenes
	s = scenes.penetration(thickness=16e-3, spacing=4e-3)
	run = impact.Impact(s, until=12e-6)
	run.advance()
	path = tmp_path / 'c'
	run.save(str(path), dict(options={}))
	checkpoint.peek(str(path))
	data = bytearray(path.read_bytes())
	at = {'bit in the scene': len(data) - 1000, 'bit in the head': 200, 'bit in the arrays': data.index(b'PK') + 300}.get(damage)
	if at: data[at] ^= 1
	elif damage == 'cut': del data[len(data) // 2:]
	elif damage == 'longer': data += b'x'
	elif damage == 'empty': data = b''
	elif damage == 'another file': data = b'<?xml version="1.0"?>'
	path.write_bytes(data)
	if damage == 'missing': path.unlink()
	if damage == 'version':
		plugin.version, old = '0.0.0', plugin.version
	iteration = run.last['step']
	try:
		with pytest.raises(checkpoint.CheckpointError, match='damaged|not a checkpoint|cannot read|version'):
			checkpoint.read(str(path))
		from yade import O
		assert O.iter == iteration  # the scene at hand is untouched
		if damage != 'version':
			assert cli.main(['penetration', '--restart', str(path), '--out', str(tmp_path)]) == 2
			shown = capsys.readouterr()
			assert shown.err.count('\n') == 1 and '--restart' in shown.err
	finally:
		if damage == 'version': plugin.version = old


@pytest.mark.parametrize('name', ['PyRunner', 'VTKRecorder'])
def test_aCheckpointWithOtherEnginesIsRefused(plugin, tmp_path, capsys, name):
	import yade
	from yade import O

	from yade_mca import impact, scenes
	s = scenes.penetration(thickness=16e-3, spacing=4e-3)
	run = impact.Impact(s, until=12e-6)
	run.advance()
	target = tmp_path / 'ran'
	if name == 'PyRunner': other = yade.wrapper.PyRunner(command="open(%r, 'w')" % str(target), iterPeriod=1)
	else: other = yade.wrapper.VTKRecorder(iterPeriod=1)
	O.engines = [*O.engines, other]
	run.save(str(tmp_path / 'c'), dict(options={'thickness': 16., 'spacing': 4., 'mode': 'coupled'}))
	assert cli.main(['penetration', '--restart', str(tmp_path / 'c'), '--out', str(tmp_path)]) == 2
	err = capsys.readouterr().err
	assert err.count('\n') == 1 and type(other).__name__ in err and not target.exists()


@pytest.mark.parametrize('argv, word', [
        (['--thickness', '-3'], 'above 0'),
        (['--thickness', 'nan'], 'above 0'),
        (['--spacing', '20'], 'larger than the rod'),
        (['--spacing', '6', '--thickness', '24'], 'above half'),
        (['--spacing', '0.7'], 'whole number of spacings'),
        (['--mode', 'grid'], 'invalid choice'),
        (['--ends', 'glued'], 'invalid choice'),
        (['--speed', '0'], 'above 0'),
        (['--seed', '-1'], 'whole number'),
        (['--width', '70'], 'no room'),
        (['--spread', '2'], 'from 0 to 1'),
        (['--obliquity', '80'], 'from -75 to 75 degrees'),
        (['--angle', 'nan'], 'from -180 to 180 degrees'),
        (['--obliquity', '70', '--thickness', '30'], 'too narrow'),
        (['--angle', '20', '--width', '84'], 'lean by 20 degrees'),
        (['--speed', '1e9'], 'times the sound speed'),
        (['--rod-length', '1e9'], 'take a spacing of at least'),
        (['--dt-factor', '1.5'], 'limit of stability'),
        (['--until', '-5'], 'above 0'),
        (['--threads', '0'], 'above 0'),
        (['--out', '/proc/self/x'], 'cannot make'),
        (['--json', '/no/such/folder/x.json'], 'does not exist'),
        (['--restart', '/no/such/file'], 'no file'),
        (['--restart', '/etc/hostname', '--seed', '2'], 'leave out --seed'),
        (['--bogus'], 'unrecognized'),
])
def test_wrongOptionsEndInOneLineAndStatus2(capsys, tmp_path, monkeypatch, argv, word):
	monkeypatch.chdir(tmp_path)
	start = time.process_time()
	assert cli.main(['penetration', *argv]) == 2
	shown = capsys.readouterr()
	assert word in shown.err and shown.err.count('\n') == 1 and not shown.out
	assert os.listdir(tmp_path) == []


def test_optionsReachTheScene(plugin):
	from argparse import Namespace

	from yade import O

	from yade_mca.tasks.penetration import options
	args = Namespace(mode='mca', spacing=2., thickness=16., fracture_strain=0.7, eos='mieGruneisen', friction=0.3, viscosity=2., volume_rule='inversePower', dt_factor=0.2, seed=7,
	                 speed=1000., spread=0.1, yield_model='linearHardening', obliquity=30., angle=60.)
	options.fill(args)
	s = options.sceneOf(args)
	m = {x.label: x for x in O.materials}['4340']
	assert (m.fractureStrain, m.eos, m.yieldModel, m.strengthSpread, m.viscosityQuadratic) == (0.7, 'mieGruneisen', 'linearHardening', 0.1, 2.4)
	assert np.tan(m.frictionAngle) == pytest.approx(0.3) and m.spallStrength == 3e9
	assert s.facts['direction'] == pytest.approx((0.5, -np.sqrt(0.75))) and s.facts['angle'] == pytest.approx(np.pi / 3)
	assert (s.automata.volumeRule, s.automata.dtFactor, s.automata.seed, s.facts['speed'], s.facts['ends']) == ('inversePower', 0.2, 7, 1000., 'viscous')


def test_referencesOfThePackageAreThoseOfTheTests():
	from yade_mca.tasks.penetration import report
	assert report.table('penetration_reference.csv') == table('penetration_reference.csv')


@pytest.mark.study
def test_besideTwoIndependentCodes(plugin):
	"""25 mm, 0.5 mm, fixed ends at 80 mm, same constants: the three losses at 42 us and after the exit."""
	from yade_mca import impact, scenes
	s = scenes.penetration(thickness=25e-3, spacing=0.5e-3, mode='mca', ends='fixed')
	run = impact.Impact(s, until=80e-6)
	while not run.finished:
		run.advance()
	a, b = run.at(42e-6), run.at(75e-6)
	assert a['lengthLoss'] == pytest.approx(0.30, abs=0.03) and a['velocityLossTail'] == pytest.approx(0.040, abs=0.006) and a['velocityLossAll'] == pytest.approx(0.138, abs=0.015)
	assert b['lengthLoss'] == pytest.approx(0.33, abs=0.03) and b['velocityLossTail'] == pytest.approx(0.070, abs=0.015) and b['velocityLossAll'] == pytest.approx(0.155, abs=0.02)


def test_nothingFliesThroughTheInsideOfABody(plugin):
	"""What has come through a stretched rim meets the automata behind it, though they are no rim."""
	from yade import O

	from yade_mca import scenes
	from yade_mca.packings import Rectangle, hexagonal
	d = 1e-3
	s = scenes.bar('4340', 20 * d, 16 * d, d)
	p = s.packings['bar'].positions
	shot = hexagonal(d, Rectangle((0, 0), (0.9 * d, 0.9 * d)), rim='full')
	hole = p[np.argmin(np.hypot(*p.T))] + (0.5 * d, d / np.sqrt(12))  # between three automata of the inside
	s.add('shot', shot.translated(hole - shot.positions[0]), O.materials[0], velocity=(500., 0.), mask=2)
	momentum = s.automata.momentum[0]
	while O.time < 12e-6:  # 6 mm if nothing stopped it
		O.run(20, True)
	assert s.field('shot', 'x')[0] - hole[0] < 1.5 * d and s.automata.momentum[0] == pytest.approx(momentum, rel=1e-9)


@pytest.mark.parametrize('where', ['engine', 'functor'])
def test_restartRefusesEnginesThatTheTaskDoesNotMake(plugin, tmp_path, capsys, where):
	"""A PyRunner in a checkpoint would run Python: nothing of such a scene is made, let alone run; who trusts the file says so."""
	from yade import O, wrapper
	from yade_mca import checkpoint, impact, scenes
	run = impact.Impact(scenes.penetration(thickness=16e-3, spacing=4e-3), until=12e-6)
	run.advance()
	ran = tmp_path / 'ran'
	if where == 'engine': O.engines = O.engines + [wrapper.PyRunner(command="open(%r, 'w')" % str(ran), iterPeriod=1)]
	else: O.engines = O.engines + [wrapper.InteractionLoop([wrapper.Ig2_Sphere_Sphere_ScGeom()], [], [])]
	path = tmp_path / 'c'
	run.save(str(path), dict(options={}))
	O.reset()
	with pytest.raises(checkpoint.CheckpointError, match='PyRunner' if where == 'engine' else 'Ig2_Sphere_Sphere_ScGeom|InteractionLoop'):
		impact.Impact.load(str(path))
	assert len(O.engines) == 0 and len(O.bodies) == 0
	assert cli.main(['penetration', '--restart', str(path), '--out', str(tmp_path / 'out')]) == 2
	assert 'does not make' in capsys.readouterr().err
	assert not ran.exists()
	checkpoint.read(str(path))
	assert len(O.engines) > 1
	O.reset()
