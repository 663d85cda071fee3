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
