# SPDX-License-Identifier: GPL-2.0-or-later
"""Every attribute and every method of every class of the plugin with bad values, at bad moments; the list is made by looking at the classes.

    python3 tests/python/every_call.py [--study] [--only TEXT] [--json FILE]     # prints the counts and each finding

A call is a class, an attribute or an argument, a kind of value (every_call_values) and a moment (every_call_scenes). It is right when it is refused, by
the call or by the next step before anything has moved, in a message that says what, where and what is allowed (every_call_judge); or when
tests/data/every_call.csv declares it accepted. Calls run in processes that keep a journal: what crashes or hangs is named, and a new process goes on
with the next call.
"""
import argparse
import collections
import json
import os
import signal
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
if str(HERE) not in sys.path: sys.path.insert(0, str(HERE))
#: longest silence of the process that makes the calls [s]: by its own clock (a loop), by the clock on the wall (a lock)
LIMIT = 10., 90.
#: what must not happen. moved: refused one step too late; poor: a message that does not help; broken: a right call is refused
FAULTS = ('crash', 'hang', 'silent', 'moved', 'poor', 'broken')


def everyCall(study=False):
	"""All calls, always in the same order."""
	import every_call_classes as classes
	import every_call_modules as modules
	return [*classes.everyCall(study), *modules.everyCall()]


def make(calls, chosen, journal):
	"""In a process of its own: the calls with these numbers, each with a line in the journal before and after."""
	import resource
	resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
	resource.setrlimit(resource.RLIMIT_AS, (12 << 30, 12 << 30))
	quiet = os.open(os.devnull, os.O_WRONLY)
	os.dup2(quiet, 1)
	os.dup2(os.open(str(journal) + '.err', os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 2)
	from yade import O
	O.reset()  # a new loop: threads do not live on in a forked process
	with open(journal, 'a', buffering=1) as out:
		for k in chosen:
			out.write(json.dumps({'k': k}) + '\n')
			begin = time.time()
			try:
				verdict, text = calls[k].run()
			except Exception as e:  # the scene itself could not be made
				verdict, text = 'broken', '%s: %s' % (type(e).__name__, e)
			out.write(json.dumps({'k': k, 'verdict': verdict, 'text': text[:600], 'seconds': round(time.time() - begin, 4)}) + '\n')
	os._exit(0)  # whatever a call has left behind is not what is tested here


def processorTime(process):
	"""What a process has used so far [s]; 0 when it has just ended."""
	try:
		fields = Path('/proc/%d/stat' % process).read_text().rsplit(')', 1)[1].split()
	except OSError:
		return 0.
	return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def follow(process, journal):
	"""Waits until the process ends, or is silent too long. Returns ('crash' or 'hang', text)."""
	size, since, used = -1, 0., 0.
	while True:
		pid, status = os.waitpid(process, os.WNOHANG)
		if pid: break
		now = journal.stat().st_size if journal.exists() else 0
		if now != size: size, since, used = now, time.time(), processorTime(process)
		if processorTime(process) - used > LIMIT[0] or time.time() - since > LIMIT[1]:
			os.kill(process, signal.SIGKILL)
			os.waitpid(process, 0)
			return 'hang', 'no answer in %g s of processor time or %g s' % LIMIT
		time.sleep(0.02)
	tail = Path(str(journal) + '.err').read_bytes()[-400:].decode(errors='replace').strip().split('\n')[-1]
	return 'crash', ('signal %d' % os.WTERMSIG(status) if os.WIFSIGNALED(status) else 'status %d' % os.WEXITSTATUS(status)) + ': ' + tail


def run(study=False, only='', report=None):
	"""Makes all calls. Returns a list of dicts (name, key, verdict, text), in order. YADE must not have run in this process: it is forked."""
	calls = everyCall(study)
	todo = [k for k, c in enumerate(calls) if only in c.name]
	results = []
	with tempfile.TemporaryDirectory() as folder:
		while todo:
			now, later = todo[:3000], todo[3000:]  # a process holds on to what its scenes leave behind
			journal = Path(folder) / ('journal%d' % todo[0])
			sys.stdout.flush()
			process = os.fork()
			if process == 0:
				try:
					make(calls, now, journal)
				finally:
					os._exit(1)
			how, text = follow(process, journal)
			done = {}
			for line in journal.read_text().splitlines():
				entry = json.loads(line)
				done[entry['k']] = entry
			for k, entry in done.items():
				if 'verdict' not in entry: entry.update(verdict=how, text=text)
				results.append(dict(entry, name=calls[k].name, key=calls[k].key, kind=calls[k].kind, moment=calls[k].moment))
			todo = now[len(done):] + later
			if how in ('crash', 'hang') and results and results[-1]['kind'] == 'nothing':  # nothing else can be told from this there
				group = results[-1]['name'].split(' = ')[0], results[-1]['name'].split(' | ')[1]
				todo = [k for k in todo if (calls[k].name.split('.')[0], calls[k].name.partition(' | ')[2]) != group]
			if report: report(results)
	return results


def counts(results):
	c = collections.Counter(r['verdict'] for r in results)
	return 'calls %d; refused %d, accepted %d; ' % (len(results), c['refused'], c['accepted']) + ', '.join('%s %d' % (k, c[k]) for k in FAULTS)


def main():
	parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
	parser.add_argument('--study', action='store_true', help='all kinds of values at all moments')
	parser.add_argument('--only', default='', help='calls whose name contains this')
	parser.add_argument('--json', help='write all results to this file')
	options = parser.parse_args()
	begin = time.time()
	results = run(options.study, options.only, lambda r: print('  %d calls, last: %s: %s' % (len(r), r[-1]['verdict'], r[-1]['name']), file=sys.stderr))
	if options.json: Path(options.json).write_text(json.dumps(results, indent=0))
	for r in results:
		if r['verdict'] in FAULTS: print('%-7s %s   %s' % (r['verdict'], r['name'], r['text'].replace('\n', ' ')[:300]))
	print(counts(results) + '; %.0f s' % (time.time() - begin))


if __name__ == '__main__':
	main()
