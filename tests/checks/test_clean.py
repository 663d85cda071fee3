# SPDX-License-Identifier: GPL-2.0-or-later
"""What `tests/run clean` takes from README.md, that it is skipped where no root can be made, and what .ci/run makes of both results."""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'tests'))
import clean

TEXT = (ROOT / 'README.md').read_text()


def test_commandsAreThoseOfTheReadme():
	commands, script = clean.readme(TEXT)
	assert commands[0] == 'pyscripts/run penetration' and 'pyscripts/run check' in commands and not any(c.startswith('tests/run') for c in commands)
	for road in ('pyscripts/yade-mca -n -x ball.py', 'PYTHONPATH=pyscripts yade -n -x ball.py', 'PYTHONPATH=pyscripts /usr/bin/python3 ball.py'):
		assert road in commands
	assert script.startswith('from yade_mca import')
	with pytest.raises(clean.Broken, match='no command this check knows'):
		clean.readme(TEXT + '\n    make install\n')
	with pytest.raises(clean.Broken, match='found'):
		clean.readme('nothing\n')


def test_fullPathsInSomebodyElsesTree(monkeypatch):
	root, typed = clean.Root('trixie', 'anna'), []
	monkeypatch.setattr(root, 'shell', lambda user, command, folder: (typed.append((user, command, folder)), (0, '', 0))[1])
	monkeypatch.setattr(root, 'count', lambda *a: None)
	root.type('root', ['PYTHONPATH=pyscripts yade -n -x ball.py', 'pyscripts/yade-mca -n -x pyscripts/examples/pair.py'])
	tree = '/home/anna/yade-mca/'
	assert typed == [('root', 'PYTHONPATH=%spyscripts yade -n -x %sball.py' % (tree, tree), '/root'), ('root', '%spyscripts/yade-mca -n -x %spyscripts/examples/pair.py' % (tree, tree), '/root')]


def test_skippedWhereNoRootCanBeMade(tmp_path):
	other = ('setpriv', '--reuid=65534', '--regid=65534', '--clear-groups') if os.getuid() == 0 else ()
	script = Path('/tmp/clean-%d.py' % os.getpid())  # where the other user may read it
	shutil.copy(ROOT / 'tests' / 'clean.py', script)
	try:
		done = subprocess.run([*other, '/usr/bin/python3', '-B', str(script)], cwd='/', env=dict(os.environ, YADE_MCA_ROOTS='/tmp/no-roots'), capture_output=True, text=True, timeout=60)
	finally:
		script.unlink()
	assert done.returncode == 0 and done.stdout.splitlines()[0] == 'skipped: only root can make and enter a root' and done.stdout.endswith('\nclean: 0 passed, 0 failed, 2 skipped\n'), done.stdout + done.stderr


@pytest.mark.parametrize('tests, roots, line, status', [
        (('7 passed, 0 failed', 0), ('clean: 5 passed, 0 failed', 0), '12 passed, 0 failed', 0),
        (('2 skipped\n9 s\n7 passed, 0 failed', 0), ('clean: 5 passed, 0 failed, 1 skipped', 0), '12 passed, 0 failed, 3 skipped', 0),
        (('7 passed, 1 failed', 1), ('clean: 5 passed, 0 failed', 0), '12 passed, 1 failed', 1),
        (('7 passed, 0 failed', 0), ('clean: 5 passed, 2 failed', 1), '12 passed, 2 failed', 1),
        (('7 passed, 0 failed', 0), ('skipped: no mount\nclean: 0 passed, 0 failed, 2 skipped', 0), '7 passed, 0 failed, 2 skipped', 0),
        (('setup: no', 2), ('clean: 5 passed, 0 failed', 0), '5 passed, 1 failed', 1),
        (('7 passed, 0 failed', 0), ('Killed', 137), '7 passed, 1 failed', 1),
])
def test_continuousIntegrationAddsBoth(tmp_path, tests, roots, line, status):
	(tmp_path / '.ci').mkdir()
	(tmp_path / 'tests').mkdir()
	shutil.copy(ROOT / '.ci' / 'run', tmp_path / '.ci')
	run = tmp_path / 'tests' / 'run'
	run.write_text('#!/bin/sh\nif [ "$1" = clean ]; then echo "%s"; exit %d; fi\necho "%s"; exit %d\n' % (*roots, *tests))
	run.chmod(0o755)
	done = subprocess.run(['bash', str(tmp_path / '.ci' / 'run')], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
	lines = done.stdout.splitlines()
	assert lines[-1] == line and done.returncode == status, done.stdout
	assert sum(bool(re.match(r'\d+ passed, \d+ failed', x)) for x in lines) == 1, done.stdout


@pytest.mark.parametrize('bare, calls', [('0', ['']), ('1', ['', 'clean --limit 60']), (None, ['', 'clean (bookworm|trixie) --spare --limit 16'])])
def test_whatContinuousIntegrationCalls(tmp_path, bare, calls):
	(tmp_path / '.ci').mkdir()
	(tmp_path / 'tests').mkdir()
	shutil.copy(ROOT / '.ci' / 'run', tmp_path / '.ci')
	run = tmp_path / 'tests' / 'run'
	run.write_text('#!/bin/sh\necho "called: $*"\necho "1 passed, 0 failed"\n')
	run.chmod(0o755)
	environment = {k: v for k, v in os.environ.items() if k != 'MCA_BARE_MACHINES'}
	if bare: environment['MCA_BARE_MACHINES'] = bare
	done = subprocess.run(['bash', str(tmp_path / '.ci' / 'run')], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, env=environment)
	said = re.findall('^called: (.*)$', done.stdout, re.M)
	assert len(said) == len(calls) and all(re.fullmatch(c, s) for c, s in zip(calls, said)), done.stdout
	assert done.stdout.splitlines()[-1] == '%d passed, 0 failed' % len(calls) and done.returncode == 0


@pytest.mark.parametrize('minutes, limit', [(1, 16), (25, 11), (30, None)])
def test_aSlowMachineHasNoTimeForIt(tmp_path, minutes, limit):
	(tmp_path / '.ci').mkdir()
	(tmp_path / 'tests').mkdir()
	script = (ROOT / '.ci' / 'run').read_text()
	assert 'SECONDS' in script
	(tmp_path / '.ci' / 'run').write_text(script.replace('SECONDS', 'TAKEN'))
	run = tmp_path / 'tests' / 'run'
	run.write_text('#!/bin/sh\necho "called: $*"\necho "1 passed, 0 failed"\n')
	run.chmod(0o755)
	environment = {k: v for k, v in os.environ.items() if k != 'MCA_BARE_MACHINES'}
	done = subprocess.run(['bash', str(tmp_path / '.ci' / 'run')], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60, env=dict(environment, TAKEN=str(60 * minutes)))
	assert done.stdout.splitlines()[-1] == ('2 passed, 0 failed' if limit else '1 passed, 0 failed, 1 skipped') and done.returncode == 0
	assert re.findall('--limit (.*)', done.stdout) == ([str(limit)] if limit else [])


@pytest.mark.skipif(os.getuid() != 0, reason='only root can give a tree to somebody else')
def test_clonesATreeThatBelongsToSomebodyElse(tmp_path, monkeypatch):
	"""As continuous integration finds it: another owner, the last commit alone, no branch."""
	monkeypatch.setattr(clean, 'ROOTS', tmp_path)
	run = lambda *a: subprocess.run(a, check=True, capture_output=True, cwd=tmp_path)
	run('git', 'init', '-q', 'a')
	run('git', '-C', 'a', '-c', 'user.name=n', '-c', 'user.email=n@n.invalid', 'commit', '-q', '--allow-empty', '-m', 'one')
	run('git', 'clone', '-q', '--depth', '1', 'file://%s/a' % tmp_path, 'b')
	run('git', '-C', 'b', 'checkout', '-q', '--detach')
	run('chown', '-R', '65534', 'b')
	assert clean.output('git', '-C', str(tmp_path / 'b'), 'rev-parse', 'HEAD').returncode
	head = clean.git('-C', str(tmp_path / 'b'), 'rev-parse', 'HEAD').stdout
	done = clean.git('clone', '-q', '--no-hardlinks', str(tmp_path / 'b'), str(tmp_path / 'c'))
	assert done.returncode == 0 and len(head) == 41 and clean.git('-C', str(tmp_path / 'c'), 'rev-parse', 'HEAD').stdout == head, done.stdout


class Machine(clean.Root):
	"""A root in which nothing is made, entered or removed; `answer(root, command)` gives status and output of what is typed."""
	answer = None

	def make(self): pass

	def clone(self, script): (self.path / 'exchange').mkdir(parents=True, exist_ok=True)

	def remove(self): pass

	def shell(self, user, command, folder):
		if ' save ' in command:
			for name in ('engine.xml', 'law2.yade.gz', 'engine.json'):
				(self.path / 'exchange' / ('%s-%s' % (self.suite, name))).write_text('')
		return (*type(self).answer(self, command), 1.5)


def told(monkeypatch, capsys, tmp_path, answer, *arguments):
	"""(status, lines) of `tests/run clean` on such machines."""
	Machine.answer = staticmethod(answer)
	monkeypatch.setattr(clean, 'Root', Machine)
	monkeypatch.setattr(clean, 'ROOTS', tmp_path)
	monkeypatch.setattr(clean, 'mayMakeRoots', lambda: None)
	monkeypatch.setattr(sys, 'argv', ['clean', *arguments])
	status = clean.main()
	return status, capsys.readouterr().out.splitlines()


def good(root, command):
	return 2 if command.endswith('pyscripts/run') else 0, 'EXCHANGE loads' if ' load ' in command else ''


def test_closingLineWhenAllIsWell(monkeypatch, capsys, tmp_path):
	status, lines = told(monkeypatch, capsys, tmp_path, good)
	assert status == 0 and lines[-1] == 'clean: %d passed, 0 failed' % sum(' ok ' in x for x in lines), lines
	assert sum('loads bookworm-' in x and x.startswith('trixie') for x in lines) == 2 and sum('loads trixie-' in x and x.startswith('bookworm') for x in lines) == 2, lines
	assert any(x.startswith('trixie anna') and x.endswith('  ok      root: /home/anna/yade-mca/pyscripts/run penetration') and ' 1.5 s ' in x for x in lines), lines


def test_closingLineWhenACommandFails(monkeypatch, capsys, tmp_path):
	answer = lambda root, command: (1, 'it broke') if root.suite == 'trixie' and command == 'pyscripts/run docs' else good(root, command)
	status, lines = told(monkeypatch, capsys, tmp_path, answer)
	assert status == 1 and re.fullmatch(r'clean: \d+ passed, 1 failed', lines[-1]) and '    it broke' in lines, lines
	assert not any('are saved' in x for x in lines), 'files are exchanged between good roots only'


def test_closingLineWhenTheMirrorStopsAnswering(monkeypatch, capsys, tmp_path):
	answer = lambda root, command: (100, 'E: Failed to fetch http://x') if root.suite == 'trixie' else good(root, command)
	status, lines = told(monkeypatch, capsys, tmp_path, answer)
	assert status == 0 and re.fullmatch(r'clean: \d+ passed, 0 failed, 1 skipped', lines[-1]) and any('skipped: the mirror' in x for x in lines), lines


def test_closingLineWhenTheTimeIsOver(monkeypatch, capsys, tmp_path):
	def late(root, command): raise clean.Broken('the time is over, what is left was not tried')
	status, lines = told(monkeypatch, capsys, tmp_path, late, 'trixie')
	assert status == 1 and lines[-1] == 'clean: 0 passed, 1 failed', lines
