# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs stress cases in child processes, so that a case that kills its process costs that case only: start and outcome of each go through a file."""
import json
import math
import signal
import subprocess
import sys
import time
from dataclasses import asdict

from ..attempts import inMemory
from . import impact, lattice, limit, long, material, random, space, step
from .judge import FAILED, Outcome, judge

GROUPS = (step, limit, impact, material, lattice, long, random, space)
PATIENCE = 3600.  #: longest time of one case [s]


def allCases(quick, seed):
	"""{name: StressCase} in order."""
	return {c.name: c for g in GROUPS for c in g.cases(quick, seed)}


def afterError():
	"""What is left of the scene after a refusal: are all numbers finite, and can it be saved? None without engines."""
	from ..._yade import scene
	from .watch import VIEWS, fieldsOf
	import numpy as np
	o = scene()
	if not o.engines:
		return None
	found = dict(finite=True, saved=True)
	for e in o.engines:
		try:
			if type(e).__name__ == 'McaEngine':
				found['finite'] = found['finite'] and all(np.isfinite(e.field(k)).all() for k in fieldsOf(e))
			if type(e).__name__ == 'McaGridEngine':
				found['finite'] = found['finite'] and all(np.isfinite(e.view(b, k)).all() for b in range(len(e.blocks)) for k in VIEWS[:4])
		except RuntimeError:
			pass  # there is nothing to look at: the scene was refused before it was built
	try:
		o.saveTmp('stress', quiet=True)
	except Exception:
		found['saved'] = False
	return found


def runCase(case):
	"""Outcome of one case, here."""
	start, measures, error, after = time.perf_counter(), None, None, None
	try:
		measures = case.run()
	except Exception as e:
		error, after = e, afterError()
	outcome = judge(case, measures, error, after)
	outcome.seconds = time.perf_counter() - start
	return outcome


def child(path, quick, seed, names):
	"""Runs the cases and writes a line before and after each to `path`."""
	from ..._yade import scene
	scene()  # loads YADE and the plugin, whose time is none of the first case
	cases = allCases(quick, seed)
	with open(path, 'a', buffering=1) as f:
		for name in names:
			f.write(json.dumps(dict(started=name)) + '\n')
			f.write(json.dumps(asdict(runCase(cases[name])), default=str) + '\n')
			f.flush()


def death(status):
	"""How a process ended, in words."""
	return 'killed by %s' % signal.Signals(-status).name if status < 0 else 'ended with status %d' % status


class Children:
	"""Runs the named cases one after another in a child process, and a new one after each death. Yields outcomes."""

	def __init__(self, names, quick, seed, patience=PATIENCE):
		self.names, self.quick, self.seed, self.patience = list(names), quick, seed, patience

	def __iter__(self):
		left = list(self.names)
		while left:
			with inMemory('outcomes') as path, inMemory('log') as said, open(said, 'w+') as log:
				command = [sys.executable, '-m', __name__, path, '1' if self.quick else '0', str(self.seed)]
				process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=log, stderr=log, text=True)
				process.stdin.write('\n'.join(left))
				process.stdin.close()
				for outcome in self.follow(process, path, log):
					left.remove(outcome.name)
					yield outcome

	def follow(self, process, path, log):
		"""Outcomes of one child as they come; the last one is that of the case it died in."""
		started, since, hung = None, time.monotonic(), False
		with open(path) as f:
			while True:
				over = process.poll() is not None
				line = f.readline()
				if line.endswith('\n'):
					d, since = json.loads(line), time.monotonic()
					if 'started' in d:
						started = d['started']
					else:
						started = None
						yield Outcome(**d)
				elif over:
					break
				else:
					time.sleep(0.05)
					if time.monotonic() - since > self.patience:
						hung = True
						process.kill()
						process.wait()
		if process.returncode == 0 and started is None:
			return
		log.seek(0)
		said = ' '.join(log.read().split())[-300:]
		why = 'no end within %g s' % self.patience if hung else 'the process was %s' % death(process.returncode)
		if started is None:
			raise RuntimeError('a child process could not start its cases: %s; %s' % (why, said))
		yield Outcome(started, FAILED, '%s; it said: %s' % (why, said), {}, seconds=time.monotonic() - since)


def readable(outcome):
	"""Outcome as a dict for the JSON file: numbers that are not finite as text."""
	d = asdict(outcome)
	d['measures'] = {k: str(v) if isinstance(v, float) and not math.isfinite(v) else v for k, v in d['measures'].items()}
	return d


if __name__ == '__main__':
	path, quick, seed = sys.argv[1:4]
	child(path, quick == '1', int(seed), sys.stdin.read().split('\n'))
