# SPDX-License-Identifier: GPL-2.0-or-later
"""Work beside the run: calls in their order, errors that come back, and no process that stays behind, however the run ends."""
import json
import os
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

from yade_mca.beside import Beside, BesideError

PACKAGE = Path(__file__).resolve().parents[2] / 'pyscripts'
RUN = ['penetration', '--spacing', '0.5', '--thickness', '16', '--until', '90', '--checkpoint-interval', '0.01']  # goes on for half a minute after its first checkpoint, which a busy machine writes late


def there(pid):
	"""Whether a process runs (one that only waits to be asked for its status does not)."""
	try:
		return Path('/proc/%d/stat' % pid).read_text().rpartition(')')[2].split()[0] != 'Z'
	except FileNotFoundError:
		return False


def waitFor(met, seconds=300):
	end = time.monotonic() + seconds
	while not met():
		assert time.monotonic() < end
		time.sleep(0.02)


def beside(pid):
	"""The process beside a run."""
	found = [int(i) for t in Path('/proc/%d/task' % pid).iterdir() for i in (t / 'children').read_text().split()]
	return next(i for i in found if 'beside' in Path('/proc/%d/cmdline' % i).read_text())


@pytest.fixture
def run(plugin, tmp_path):
	"""A run that has written its first checkpoint: (process, the one beside it, folder)."""
	env = dict(os.environ, OMP_NUM_THREADS='1', PYTHONPATH=str(PACKAGE))
	# shells start what runs in the background with interrupts ignored, and so all that it starts
	heard = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)
	p = subprocess.Popen(['/usr/bin/python3', '-m', 'yade_mca.tasks', *RUN, '--out', str(tmp_path)], env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
	                     text=True, start_new_session=True, preexec_fn=heard)
	waitFor(lambda: (tmp_path / 'penetration.checkpoint').exists() or p.poll() is not None)
	assert p.poll() is None, p.communicate()
	yield p, beside(p.pid), tmp_path
	if p.poll() is None: p.kill()
	p.communicate()


# ---- calls


def test_callsAreMadeInTheirOrderWithWhatTheyWereGiven():
	b, a = Beside('builtins', 'list'), np.zeros(300000)
	for k in range(40):  # more than may wait, of more than a pipe holds
		a[0] = k
		b.call('append', a.copy() if k % 2 else a)
	assert [b.call('pop').result()[0] for _ in range(40)] == list(range(39, -1, -1))
	b.close()
	assert b.process.returncode == 0 and isinstance(b.call('pop').exception(), BesideError)


def test_errorsComeBack():
	b = Beside('pathlib', 'Path', '/no/such/file')
	with pytest.raises(FileNotFoundError) as e:
		b.call('read_text').result()
	assert e.value.filename == '/no/such/file' and e.value.errno == 2
	with pytest.raises(AttributeError):
		b.call('nothing').result()
	assert b.call('exists').result() is False
	b.close()
	b = Beside('pathlib', 'NoSuchClass')
	with pytest.raises(AttributeError, match='NoSuchClass'):
		b.call('exists').result()
	b.close()


def test_theDeadAreNoticed():
	b = Beside('time', 'localtime')
	b.process.kill()
	for _ in range(40):  # also when nobody makes room any more
		with pytest.raises(BesideError, match='killed by signal 9'):
			b.call('count', 1).result(60)
	b.close()
	assert not there(b.process.pid)


def test_stopWaitsForNothing():
	b = Beside('threading', 'Event')
	assert b.call('is_set').result() is False
	f = b.call('wait', 600)
	b.stop()
	assert isinstance(f.exception(), BesideError) and not there(b.process.pid)


def test_whatIsPrintedIsNoAnswer(capfd):
	b = Beside('yade_mca.tasks.progress', 'Progress', 10)
	assert b.call('_print', {}).exception() is None
	b.close()


def test_yadeIsNotThere(tmp_path):
	b = Beside('yade_mca.impact_files', 'Files', str(tmp_path))
	b.call('begin', (0., 0., 1., 1.), 1., None, True).result()
	maps = Path('/proc/%d/maps' % b.process.pid).read_text()
	b.close()
	assert 'numpy' in maps and 'yade' not in maps.replace('yade_mca', '')


# ---- runs


def test_aRunWhoseFilesCannotBeMadeIsReportedAndKeepsItsNumbers(run):
	p, other, folder = run
	os.kill(other, signal.SIGKILL)
	out, err = p.communicate(timeout=600)
	last = err.strip().splitlines()[-1]
	assert p.returncode == 1 and 'could not be written' in last
	assert "pattern_end.png': BesideError: the process beside this one has ended, killed by signal 9" in last
	assert 'Traceback' not in err and 'Alekseevskii-Tate' in out
	assert len(json.loads((folder / 'summary.json').read_text())['cases']) > 8


def test_anInterruptedRunLeavesItsStateAndNoProcess(run):
	p, other, folder = run
	os.killpg(p.pid, signal.SIGINT)  # as a terminal does
	out, err = p.communicate(timeout=600)
	assert p.returncode == 1 and 'interrupted' in err.strip().splitlines()[-1] and 'Traceback' not in err
	assert 'is in %s' % (folder / 'penetration.checkpoint') in err
	assert not there(other)
	assert not [f.name for f in folder.rglob('.*')]
	from yade_mca import checkpoint
	record = checkpoint.peek(str(folder / 'penetration.checkpoint'))
	assert record['extra']['options']['thickness'] == 16


@pytest.mark.parametrize('how', [signal.SIGKILL, signal.SIGTERM])
def test_aKilledRunLeavesNoProcess(run, how):
	p, other, folder = run
	p.send_signal(how)
	p.communicate()
	waitFor(lambda: not there(other), 60)


def test_aProcessThatDiesCostsOneRunOfTheTable(plugin):
	from yade_mca.tasks import table1
	words = ['--spacing', '5', '--thickness', '15', '--until', '1']
	with table1.Processes(1) as processes:
		found = table1.child(words, processes)
		first = processes.all[0].process
		assert table1.child(words, processes)['penetration']['record'] == found['penetration']['record'] and len(processes.all) == 1
		with pytest.raises(RuntimeError, match='--spacing'):
			table1.child(['--spacing', '-1'], processes)
		first.kill()
		with pytest.raises(BesideError, match='killed by signal 9'):
			table1.child(words, processes)
		assert table1.child(words, processes)['penetration']['record'] == found['penetration']['record'] and len(processes.all) == 2
	assert not any(there(p.process.pid) for p in processes.all)
