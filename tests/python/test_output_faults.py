# SPDX-License-Identifier: GPL-2.0-or-later
"""What a task has computed is not lost where it cannot be written: full disks, devices, pipes, links, readers that leave."""
import json
import os
import resource
import signal
import subprocess
import threading
from pathlib import Path

import pytest

from yade_mca.tasks.report import isPlain, writeAtomically

PACKAGE = Path(__file__).resolve().parents[2] / 'pyscripts'
SCENE = ['penetration', '--spacing', '4', '--thickness', '16', '--until', '3']
TABLE = ('T16/coupled/lengthLoss ', 'Alekseevskii-Tate', ' passed, ')


@pytest.fixture(autouse=True)
def needsThePlugin(plugin):
	pass


def task(*words, **keywords):
	env = dict(os.environ, MPLBACKEND='Agg', OMP_NUM_THREADS='1', PYTHONPATH=str(PACKAGE))
	streams = dict(stdout=subprocess.PIPE, stderr=subprocess.PIPE)
	return subprocess.Popen(['/usr/bin/python3', '-m', 'yade_mca.tasks', *words], env=env, text=True, **dict(streams, **keywords))


def ended(*words, **keywords):
	p = task(*words, **keywords)
	out, err = p.communicate(timeout=600)
	return p.returncode, out, err


# ---- a full disk


def test_aFullDiskAtTheEndCostsOnlyTheFilesItHits(tmp_path):
	"""Writing to /dev/full fails as on a full disk; the links are where the last picture and the page go."""
	for name in ('pattern_end.png', 'penetration.html'):
		(tmp_path / name).symlink_to('/dev/full')
	status, out, err = ended(*SCENE, '--out', str(tmp_path), '--json', str(tmp_path / 'r.json'))
	assert status == 1 and all(word in out for word in TABLE) and 'Traceback' not in err
	last = err.strip().splitlines()[-1]
	assert '2 files could not be written' in last
	for name in ('pattern_end.png', 'penetration.html'):
		assert "'%s': No space left on device" % (tmp_path / name) in last
	for name in ('summary.json', 'r.json'):
		assert len(json.loads((tmp_path / name).read_text())['cases']) > 8
	assert {'history.png', 'penetration.gif', 'penetration.checkpoint', 'penetration.pvd'} <= set(os.listdir(tmp_path))


def test_aDiskThatIsFullAllTheTimeCostsNoNumber(tmp_path):
	"""A limit on the size of files stands for the disk: pictures, ParaView files and checkpoints are larger, the summary is not."""

	def limit():
		signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
		resource.setrlimit(resource.RLIMIT_FSIZE, (30000, 30000))

	status, out, err = ended(*SCENE, '--out', str(tmp_path), preexec_fn=limit)
	assert status == 1 and all(word in out for word in TABLE) and 'Traceback' not in err
	last = err.strip().splitlines()[-1]
	for name in ('pattern_00us.png', 'pattern_end.png', 'history.png', 'penetration.html'):
		assert "'%s': File too large" % (tmp_path / name) in last, name
	assert "no checkpoint" in err and 'penetration.checkpoint' in err
	assert len(json.loads((tmp_path / 'summary.json').read_text())['cases']) > 8
	assert not [f for f in [*os.listdir(tmp_path), *os.listdir(tmp_path / 'paraview')] if f.startswith('.')]


def test_aFullDiskBehindStandardOutputCostsNoFile(tmp_path):
	path = tmp_path / 'i.json'
	with open('/dev/full', 'w') as full:
		status, _, err = ended('info', '--json', str(path), stdout=full)
	assert status == 1 and 'standard output could not be written: No space left on device' in err and 'Traceback' not in err
	assert json.loads(path.read_text())['cases']


# ---- readers that leave


@pytest.mark.parametrize('words, status', [(['info'], 0), (['penetration', '--help'], 0), (['penetration', '--speed', '-1'], 2)])
def test_aReaderThatLeavesIsNoError(words, status):
	p = task(*words)
	p.stdout.close()  # as `| head -1` does, only sooner
	err = p.stderr.read()
	assert p.wait(600) == status and 'BrokenPipe' not in err and 'Traceback' not in err and 'Exception' not in err


def test_bothStreamsMayBeGone():
	p = task('penetration', '--speed', '-1')
	p.stdout.close()
	p.stderr.close()
	assert p.wait(600) == 2


def test_aRunWhoseReaderLeavesGoesOnToItsFiles(tmp_path):
	p = task(*SCENE, '--out', str(tmp_path), stderr=subprocess.STDOUT)
	p.stdout.close()
	assert p.wait(600) == 0
	assert json.loads((tmp_path / 'summary.json').read_text())['cases'] and (tmp_path / 'penetration.html').exists()


def test_headInAShell():
	"""The status of the task counts, as with `set -o pipefail`."""
	env = dict(os.environ, OMP_NUM_THREADS='1', PYTHONPATH=str(PACKAGE))
	done = subprocess.run(['bash', '-c', 'set -o pipefail; /usr/bin/python3 -m yade_mca.tasks info | head -1'], env=env, capture_output=True, text=True, timeout=600)
	assert done.returncode == 0 and done.stdout.startswith('version') and done.stdout.count('\n') == 1 and 'BrokenPipe' not in done.stderr


# ---- devices, pipes, links


def test_aDeviceStaysOne(tmp_path):
	device = '/dev/full'
	before = os.stat(device)
	status, out, err = ended('info', '--json', device)
	after = os.stat(device)
	assert (after.st_mode, after.st_rdev, after.st_ino) == (before.st_mode, before.st_rdev, before.st_ino)
	assert status == 1 and "cannot write '/dev/full': No space left on device" in err and 'passed' in out
	assert ended('info', '--json', '/dev/null')[0] == 0


def test_aPipeIsWritten(tmp_path):
	pipe, found = tmp_path / 'pipe', []
	os.mkfifo(pipe)
	reader = threading.Thread(target=lambda: found.append(pipe.read_text()))
	reader.start()
	assert ended('info', '--json', str(pipe))[0] == 0
	reader.join(600)
	assert json.loads(found[0])['task'] == 'info' and not isPlain(pipe) and os.listdir(tmp_path) == ['pipe']


@pytest.mark.parametrize('name', ['/dev/stdout', '/dev/fd/1', '/proc/self/fd/1'])
def test_standardOutputMayBeTheFile(tmp_path, name):
	status, out, _ = ended('info', '--json', name)
	assert status == 0 and json.loads(out[out.rindex('\n{'):])['task'] == 'info'
	with open(tmp_path / 'all', 'w') as f:
		assert ended('info', '--json', name, stdout=f)[0] == 0
	text = (tmp_path / 'all').read_text()
	assert 'passed' in text[:text.rindex('\n{')] and json.loads(text[text.rindex('\n{'):])['task'] == 'info'


def test_linksAreFollowed(tmp_path):
	(tmp_path / 'there').mkdir()
	link = tmp_path / 'link.json'
	link.symlink_to('there/file.json')
	for text in ('one', 'two'):  # a link to nothing yet, then to a file
		writeAtomically(link, text)
		assert link.is_symlink() and (tmp_path / 'there' / 'file.json').read_text() == text
	assert os.listdir(tmp_path / 'there') == ['file.json']
	(tmp_path / 'astray').symlink_to('nowhere/file.json')
	status, _, err = ended('info', '--json', str(tmp_path / 'astray'))
	assert status == 2 and 'does not exist' in err and err.count('\n') == 1


def test_anErrorNamesTheFile(tmp_path):
	with pytest.raises(OSError) as e:
		writeAtomically('/dev/full', 'x')
	assert e.value.filename == '/dev/full' and e.value.errno == 28
	with pytest.raises(OSError) as e:
		writeAtomically(tmp_path / 'no' / 'file', 'x')
	assert e.value.filename == str(tmp_path / 'no' / 'file')


def test_paraviewFilesFollowLinksAndStayDevices(tmp_path):
	vtk_output = pytest.importorskip('yade_mca.vtk_output')
	pytest.importorskip('vtkmodules.vtkIOXML')
	(tmp_path / 'there').mkdir()
	link = tmp_path / 'a.vtp'
	link.symlink_to('there/file.vtp')
	for n in 2, 3:  # a link to nothing yet, then to a file
		vtk_output.writeAutomata(link, [[0., k] for k in range(n)])
		assert link.is_symlink() and b'NumberOfPoints="%d"' % n in (tmp_path / 'there' / 'file.vtp').read_bytes()
	assert os.listdir(tmp_path / 'there') == ['file.vtp']
	full = tmp_path / 'full.vtp'
	full.symlink_to('/dev/full')
	with pytest.raises(OSError) as e:
		vtk_output.writeAutomata(full, [[0., 0.]])
	assert e.value.errno == 28 and e.value.filename == str(full) and full.is_symlink()


# ---- other tasks on a full disk


@pytest.mark.parametrize('words, files, said', [
        (['bench', '--only', 'elasticWave'], ['bench.json', 'bench.jsonl', 'bench-front.png', 'bench-size.png', 'bench-phases.png'], 'elasticWave/'),
        (['stress', '--only', 'limit/automata/stretched10%'], ['stress.txt', 'stress.inc'], 'held 1, refused 0, failed 0'),
])
def test_aFullDiskCostsNoNumberOfOtherTasks(tmp_path, monkeypatch, capsys, words, files, said):
	"""What was measured (of bench: replaced here by what runs return) is shown and reported, and every missing file named."""
	from test_bench import made
	from yade_mca.tasks import cli
	from yade_mca.tasks.bench import plan, process
	monkeypatch.setattr(process, 'measured', lambda j: dict(made(j['case'], j['solver'], j['n'], 1., error=.1), name=plan.name(j)))
	out = tmp_path / 'out'
	out.mkdir()
	for name in files:
		(out / name).symlink_to('/dev/full')
	assert cli.main([*words, '--quick', '--out', str(out), '--json', str(tmp_path / 'r.json')]) == 1
	text, err = capsys.readouterr()
	assert said in text and 'Traceback' not in err
	assert json.loads((tmp_path / 'r.json').read_text())['cases']
	last = err.strip().splitlines()[-1]
	assert '%d files could not be written' % len(files) in last
	for name in files:
		assert "'%s': No space left on device" % (out / name) in last
	assert sorted(os.listdir(out)) == sorted(files)


def test_whatChildrenHandBackNeedsNoDisk():
	"""Not even for temporary files."""
	from yade_mca.tasks.attempts import inMemory
	with inMemory('x') as path:
		subprocess.run(['/usr/bin/python3', '-c', 'import sys; open(sys.argv[1], "a").write("y" * 100000)', path], check=True)
		assert os.path.getsize(path) == 100000 and Path(path).read_text() == 'y' * 100000
		assert os.readlink(path).startswith('/memfd:')
		writeAtomically(path, 'z')
		assert Path(path).read_text().endswith('yz')
	assert not os.path.exists(path)


def test_aFullDiskCostsNoNumberOfTableAndStudy(tmp_path, monkeypatch, capsys):
	"""Pictures and results go where no byte fits; runs, replaced here by their results, are in the table and in the report all the same."""
	from yade_mca.tasks import cli, study, table1
	folder = tmp_path / 'out'
	folder.mkdir()
	names = [c for c in table1.CASES] + ['wall', 'energyError'] + ['at%dus/%s' % (t, k) for t in study.TIMES for k in study.LOSSES]
	made = lambda words: dict(cases=[dict(name='T%s/%s/%s' % (words[words.index('--thickness') + 1], 'x', n), value=0.1 + 0.01 * k) for k, n in enumerate(names)])
	monkeypatch.setattr(table1, 'child', lambda words, threads: made(words))
	for name in 'table1.png', 'table1.json', 'convergence.png', 'study-convergence.json':
		(folder / name).symlink_to('/dev/full')
	for words, files in (['table1'], ['table1.json', 'table1.png']), (['study', 'convergence'], ['convergence.png', 'study-convergence.json']):
		report = tmp_path / 'report.json'
		assert cli.main([*words, '--out', str(folder), '--json', str(report)]) == 1
		text, err = capsys.readouterr()
		assert len(json.loads(report.read_text())['cases']) > 8 and ('Alekseevskii' in text or 'T25' in text or 'study/' in text)
		last = err.strip().splitlines()[-1]
		assert '2 files could not be written' in last and all("'%s': No space left on device" % (folder / f) in last for f in files)


def test_aRunThatFailsCostsNoOtherOfTheTable(tmp_path, monkeypatch, capsys):
	from yade_mca.tasks import cli, table1

	def child(words, threads):
		if words[words.index('--thickness') + 1] in ('40', '40.0'): raise RuntimeError('a picture of this')
		return dict(cases=[dict(name='T/x/' + n, value=0.1) for n in table1.CASES])

	monkeypatch.setattr(table1, 'child', child)
	assert cli.main(['table1', '--json', str(tmp_path / 'r.json')]) == 1
	assert 'a picture of this' in capsys.readouterr().err
	assert len(json.loads((tmp_path / 'r.json').read_text())['cases']) >= 10
