# SPDX-License-Identifier: GPL-2.0-or-later
"""`tests/run clean`: the commands of README.md, in their order, on machines with nothing of ours on them; called by tests/run.

For each supported release of Debian a minimal root is made by mmdebstrap, the commit at hand is cloned into it, and its owner, root or an ordinary user with sudo, types what
README.md says. Then a second user works with the first one's build: an ordinary user without sudo, or root. At the end files saved in one release are loaded in the other.
The bare roots are kept in build/roots (YADE_MCA_ROOTS names another folder). Needs root; where no root can be made or entered, it says so and nothing fails.
Last line: `clean: N passed, N failed`, and how many releases were skipped. Beside the time of each command stands that of the processors, which does not depend on who else works here.
"""
import argparse
import concurrent.futures
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

TREE = Path(__file__).resolve().parents[1]
ROOTS = Path(os.environ.get('YADE_MCA_ROOTS', TREE / 'build' / 'roots')).resolve()
SUITES = {'bookworm': 'root', 'trixie': 'anna'}  #: release -> who owns the tree there and builds
WARNING = ('forky', )  #: tried as well when named; what fails there is shown and not counted
INCLUDE = 'ca-certificates,git,sudo'  #: what one must have to fetch a source tree and to install packages
FAILS = {'pyscripts/run': 2}  #: status of commands for which it is not 0: without a task the list comes as a refusal
LEFT_OUT = ('tests/run', )  #: many minutes for what continuous integration does anyway
ONCE = ('cmake', 'sudo', 'pyscripts/run docs', 'pyscripts/run check')  #: what the second user leaves out: it writes into the tree, or (`check`) takes minutes and the owner of the other release's tree does it
FETCH = 'E: (Failed to fetch|Unable to fetch|Some index files failed)'  #: what apt says when a mirror does not answer
printing = threading.Lock()


class Skipped(Exception):
	"""The machine does not allow the check."""


class Broken(Exception):
	"""A root could not be made ready though the machine allows it."""


def say(text):
	with printing:
		print(text, flush=True)


def readme(text):
	"""(commands in their order, the script ball.py) of README.md: indented blocks are commands, the Python block is the script."""
	commands = [line[4:].split('  #')[0].strip() for line in re.sub(r'```.*?```', '', text, flags=re.S).splitlines() if re.match(r' {4}\S', line)]
	for command in commands:
		if not re.match(r'(\w+=\S+ )?(pyscripts/|tests/|yade |/usr/bin/python3 |cmake |sudo apt-get )', command): raise Broken("README.md: '%s' is no command this check knows" % command)
	script = re.findall(r'```python\n(.*?)```', text, re.S)
	if len(commands) < 6 or len(script) != 1: raise Broken('README.md: %d commands and %d scripts found' % (len(commands), len(script)))
	return [c for c in commands if not c.startswith(LEFT_OUT)], script[0]


def output(*command, **environment):
	return subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=dict(os.environ, **environment))


def git(*command):
	"""git, which root may use on a tree that belongs to somebody else; a clone asks again for that, in a process that sees nothing but the settings of the user."""
	settings = ROOTS / 'git.conf'
	settings.write_text('[safe]\n\tdirectory = *\n')
	return output('git', *command, GIT_CONFIG_GLOBAL=str(settings))


def aptSettings():
	"""How this machine reaches its mirror (proxies, checks of dates), for the apt in the roots."""
	dump = output('apt-config', 'dump').stdout
	return ''.join(line + '\n' for line in dump.splitlines() if re.match(r'Acquire::(https?::|Check-Valid-Until|Check-Date|Retries)', line))


def mirror():
	"""Address of the Debian packages that this machine itself uses."""
	found = output('apt-get', 'indextargets', '--format', '$(REPO_URI)', 'Created-By: Packages', 'Component: main').stdout.split()
	for uri in found:
		if uri.rstrip('/').endswith('/debian'): return uri
	raise Skipped('apt knows no mirror of Debian here')


def mayMakeRoots():
	"""Raises Skipped where a root cannot be made or entered."""
	if os.getuid() != 0: raise Skipped('only root can make and enter a root')
	if not shutil.which('mmdebstrap'):
		output('apt-get', 'update')
		output('apt-get', 'install', '-y', '--no-install-recommends', 'mmdebstrap')
	if not shutil.which('mmdebstrap'): raise Skipped('mmdebstrap is missing and cannot be installed')
	trial = ROOTS / 'trial'
	trial.mkdir(parents=True, exist_ok=True)
	try:
		done = output('mount', '-t', 'proc', 'proc', str(trial))
		if done.returncode: raise Skipped('nothing can be mounted here (%s)' % done.stdout.strip())
		output('umount', str(trial))
	finally:
		trial.rmdir()
	if git('-C', str(TREE), 'rev-parse', 'HEAD').returncode: raise Skipped('the tree is no git repository: there is no commit to clone')


class Root:
	"""A root of one release in which `owner` has the tree. Use as a context manager: what it mounts it unmounts."""

	def __init__(self, suite, owner, ccache=None, end=float('inf'), late=Broken):
		self.suite, self.owner, self.ccache, self.end, self.late = suite, owner, ccache, end, late
		self.name = '%s %s' % (suite, owner)
		self.path = ROOTS / ('%s-%s' % (suite, owner))
		self.home = {'root': '/root', 'anna': '/home/anna'}
		self.tree = '/opt/yade-mca' if owner == 'root' else '/home/anna/yade-mca'
		self.log = ROOTS / (self.path.name + '.log')
		self.failed = self.passed = 0
		self.running, self.ending = None, False

	def make(self):
		"""The bare root, from the kept one where there is one."""
		kept = ROOTS / (self.suite + '.tar')
		start = time.time()
		if not kept.exists():
			uri, part = mirror(), ROOTS / (self.path.name + '.part.tar')
			if output('/usr/lib/apt/apt-helper', 'download-file', '%s/dists/%s/InRelease' % (uri.rstrip('/'), self.suite), str(part)).returncode:
				raise Skipped('the mirror of packages does not answer or has no %s' % self.suite)
			settings = ROOTS / 'apt.conf'
			settings.write_text(aptSettings())
			done = output('mmdebstrap', '--mode=root', '--variant=minbase', '--aptopt=%s' % settings, '--include=' + INCLUDE, self.suite, str(part), 'deb %s %s main' % (uri, self.suite))
			if done.returncode and re.search(FETCH, done.stdout): raise Skipped('the mirror of packages stopped answering')
			if done.returncode: raise Broken('mmdebstrap failed:\n' + done.stdout[-3000:])
			part.rename(kept)
		self.path.mkdir(parents=True)
		done = output('tar', '-C', str(self.path), '-xf', str(kept))
		if done.returncode: raise Broken('tar failed: ' + done.stdout[-500:])
		for name in ('resolv.conf', 'hosts'):
			shutil.copy('/etc/' + name, self.path / 'etc' / name)
		(self.path / 'usr/sbin/policy-rc.d').write_text('#!/bin/sh\nexit 101\n')  # no service of a package starts in here
		(self.path / 'usr/sbin/policy-rc.d').chmod(0o755)
		(self.path / 'etc/dpkg/dpkg.cfg.d/unsafe-io').write_text('force-unsafe-io\n')  # nobody needs this root after a power cut
		mounts = [('mount', '-t', 'proc', 'proc', '/proc'), ('mount', '--rbind', '/dev', '/dev'), ('mount', '--make-rslave', '/dev')]
		if self.ccache:
			(self.path / 'ccache').mkdir()
			mounts.append(('mount', '--bind', self.ccache, '/ccache'))
		for command in mounts:
			done = output(*command[:-1], str(self.path) + command[-1])
			if done.returncode: raise Skipped('%s: %s' % (' '.join(command), done.stdout.strip()))
		if self.ccache: self.shell('root', 'apt-get update && apt-get install -y --no-install-recommends ccache && chmod -R a+rwX /ccache', '/')
		say('%-14s %7.1f s            a bare root%s' % (self.name, time.time() - start, ' with ccache' if self.ccache else ''))

	def clone(self, script):
		where = Path(str(self.path) + self.tree)
		self.shell('root', 'useradd -m -s /bin/bash anna', '/')
		if self.owner != 'root': (self.path / 'etc/sudoers.d/anna').write_text('anna ALL=(ALL) NOPASSWD: ALL\n')
		done = git('clone', '-q', '--no-hardlinks', str(TREE), str(where))
		if done.returncode: raise Broken('git clone failed: ' + done.stdout)
		(where / 'ball.py').write_text(script)
		self.shell('root', 'chown -R %s: %s && mkdir -p /exchange && chmod 777 /exchange' % (self.owner, self.tree), '/')

	def shell(self, user, command, folder):
		"""(status, output, seconds of processors) of a command typed by `user` in `folder`."""
		environment = ['HOME=' + self.home[user], 'USER=' + user, 'LANG=C.UTF-8', 'TERM=dumb', 'PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin']
		if self.ccache:
			environment += ['CMAKE_CXX_COMPILER_LAUNCHER=ccache', 'CCACHE_DIR=/ccache', 'CCACHE_UMASK=000', 'CCACHE_NOHASHDIR=1', 'CCACHE_BASEDIR=' + os.path.dirname(self.tree),
			                'CCACHE_SLOPPINESS=pch_defines,time_macros']
		if self.ending: raise Broken('interrupted')
		left = self.end - time.time()
		if left < 0: raise self.late('the time is over, what is left was not tried')
		number = '0:0' if user == 'root' else '1000:1000'
		timed = 'cd %s || exit; TIMEFORMAT="PROCESSORS %%U %%S"; time { %s\n}' % (folder, command)
		full = ['chroot', '--userspec=' + number, '--groups=' + number.split(':')[0], str(self.path), '/usr/bin/env', '-i', *environment, 'bash', '-c', timed]
		self.running = subprocess.Popen(full, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors='replace', start_new_session=True)
		try:
			text, _ = self.running.communicate(timeout=min(left, 1e6))
		except subprocess.TimeoutExpired:
			self.stop()
			text = self.running.communicate()[0] + '\nstopped: the time is over'
			if self.late is Skipped: raise Skipped('the time was over in `%s`' % command)
		text, *used = re.split(r'PROCESSORS ([\d.]+) ([\d.]+)\n$', text)
		return self.running.returncode, text, sum(float(x) for x in used if x)

	def stop(self, forever=False):
		"""Ends what is running in the root, and what would come after it."""
		self.ending = forever
		if self.running and self.running.poll() is None: os.killpg(self.running.pid, signal.SIGKILL)

	def count(self, who, command, start, used, good, text):
		if good: self.passed += 1
		else: self.failed += 1
		with open(self.log, 'a') as file:
			file.write('==== %s: %s\n%s\n' % (who, command, text))
		say('%-14s %7.1f s %7.1f s  %s  %s: %s' % (self.name, time.time() - start, used, 'ok    ' if good else 'FAILED', who, command))
		if not good: say('\n'.join('    ' + line for line in text.splitlines()[-60:]))

	def type(self, user, commands):
		"""The commands of README.md as `user` types them; in somebody else's tree with full paths, from the own home."""
		own = user == self.owner
		for command in commands:
			typed = command if own else re.sub(r'\b(?=pyscripts/|pyscripts\b|ball\.py)', self.tree + '/', command)
			start = time.time()
			status, text, used = self.shell(user, typed, self.tree if own else self.home[user])
			if status and re.search(FETCH, text): raise Skipped('the mirror of packages stopped answering at `%s`' % typed)
			good = status == FAILS.get(command, 0) and 'Traceback' not in text
			self.count(user, typed, start, used, good, text)
			if not good and command == commands[0]:
				say('%-14s the first command sets up and builds: the others are not tried' % self.name)
				return

	def __enter__(self):
		self.remove()
		return self

	def __exit__(self, *error):
		self.remove()

	def remove(self):
		self.stop()
		if not self.path.exists(): return
		for _ in range(10):
			mounted = [line.split()[1] for line in open('/proc/mounts') if line.split()[1].startswith(str(self.path) + '/')]
			if not mounted: break
			for place in reversed(mounted):
				output('umount', '-l', place)
		else: raise Broken('%s is still mounted; nothing is deleted' % ', '.join(mounted))
		subprocess.run(['rm', '-rf', '--one-file-system', str(self.path)])


def visit(root, commands, script):
	"""Everything in one root but the exchange of files."""
	if root.log.exists(): root.log.unlink()
	root.make()
	root.clone(script)
	root.type(root.owner, commands)
	other = 'anna' if root.owner == 'root' else 'root'
	root.type(other, [c for c in commands if not c.startswith(ONCE)])


def save(root):
	start = time.time()
	status, text, used = root.shell(root.owner, 'pyscripts/yade-mca -n -x tests/clean_exchange.py save %s /exchange' % root.suite, root.tree)
	root.count(root.owner, 'files are saved', start, used, status == 0, text)


def load(root, sources):
	"""Files saved in other releases are loaded in this one."""
	for source in sources:
		for file in sorted((source.path / 'exchange').glob(source.suite + '-*')):
			shutil.copy(file, root.path / 'exchange')
			os.chmod(root.path / 'exchange' / file.name, 0o644)
		for file in sorted((root.path / 'exchange').glob(source.suite + '-*[lz]')):  # not the numbers, .json
			start = time.time()
			status, text, used = root.shell(root.owner, 'pyscripts/yade-mca -n -x tests/clean_exchange.py load %s /exchange/%s' % (root.suite, file.name), root.tree)
			said = re.findall(r'^EXCHANGE (.*)$', text, re.M)
			# YADE reads the bytes of NewtonIntegrator's new members from what follows: an error, or by chance the end of the process
			chance = '-law2.' in file.name and file.name.endswith('.gz')
			answer = said[0] if said else 'ends YADE, which is known' if chance else 'no answer'
			root.count(root.owner, 'loads %s: %s' % (file.name, answer), start, used, chance or (status == 0 and len(said) == 1), text)


def main():
	signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that mounts are taken down, too
	parser = argparse.ArgumentParser(prog='tests/run clean', description=__doc__.split('\n')[0])
	parser.add_argument('suite', nargs='*', help='releases; default: %s; %s as a warning' % (', '.join(SUITES), ', '.join(WARNING)))
	parser.add_argument('--owner', choices=['root', 'anna'], help='who owns the tree and builds: root, or a user with sudo (default: %s)' % ', '.join('%s in %s' % (o, s) for s, o in SUITES.items()))
	parser.add_argument('--ccache', metavar='FOLDER', help='keep what is compiled in this folder: shorter, but ccache is on the machine then')
	parser.add_argument('--limit', metavar='MINUTES', type=float, default=180, help='longest time of all (default: %(default)g); what is not done then has failed')
	parser.add_argument('--spare', action='store_true', help='what --limit leaves undone is skipped')
	options = parser.parse_args()
	for suite in options.suite:
		if suite not in SUITES and suite not in WARNING: parser.error("no release '%s'; there are %s" % (suite, ', '.join([*SUITES, *WARNING])))
	suites = options.suite or list(SUITES)
	passed = failed = skipped = 0
	start = time.time()
	try:
		mayMakeRoots()
		commands, script = readme((TREE / 'README.md').read_text())
		if git('-C', str(TREE), 'status', '--porcelain', '--untracked-files=no').stdout: say('the tree has changes that are not committed and so not in the clones')
		roots = [Root(suite, options.owner or SUITES.get(suite, 'root'), options.ccache, start + 60 * options.limit, Skipped if options.spare else Broken) for suite in suites]
		with contexts(roots), concurrent.futures.ThreadPoolExecutor(len(roots)) as pool:
			try:
				problems = list(pool.map(attempt, [(visit, root, commands, script) for root in roots]))
				ready = [root for root, problem in zip(roots, problems) if problem is None and not root.failed]
				if len(ready) > 1:
					list(pool.map(save, ready))
					list(pool.map(load, ready, [[r for r in ready if r is not root] for root in ready]))
			except BaseException:  # interrupted: the threads would go on to the end
				for root in roots:
					root.stop(forever=True)
				raise
			for root in roots:
				if root.suite in WARNING: say('%s is a warning only: %d passed, %d failed are not counted' % (root.suite, root.passed, root.failed))
				else: passed, failed = passed + root.passed, failed + root.failed
			failed += sum(p == 'broken' and r.suite not in WARNING for r, p in zip(roots, problems))
			skipped = problems.count('skipped')
	except Skipped as e:
		say('skipped: %s' % e)
		skipped = len(suites)
	except Broken as e:
		say('FAILED: %s' % e)
		failed += 1
	except (SystemExit, KeyboardInterrupt):
		say('clean: interrupted; what was mounted is unmounted')
		raise
	used = os.times()
	say('%.0f s, %.0f s of processors' % (time.time() - start, used.children_user + used.children_system))
	say('clean: %d passed, %d failed%s' % (passed, failed, ', %d skipped' % skipped if skipped else ''))
	return 1 if failed else 0


def contexts(roots):
	import contextlib
	stack = contextlib.ExitStack()
	for root in roots:
		stack.enter_context(root)
	return stack


def attempt(job):
	"""None, or what came of a visit that did not reach its end."""
	function, root, *rest = job
	try:
		function(root, *rest)
	except Skipped as e:
		say('%-14s skipped: %s' % (root.name, e))
		return 'skipped'
	except Broken as e:
		say('%-14s FAILED: %s' % (root.name, e))
		return 'broken'


if __name__ == '__main__':
	sys.exit(main())
