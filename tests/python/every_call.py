# SPDX-License-Identifier: GPL-2.0-or-later
"""Every attribute and every method of every class of the plugin with bad values, at bad moments; the list is made by looking at the classes.

    python3 tests/python/every_call.py [--study] [--only TEXT] [--json FILE]     # prints the counts and each finding

A call is a class, an attribute or an argument, a kind of value (every_call_values) and a moment (every_call_scenes). It is right when it is refused, by the call or
by the next step before anything has moved, in a message that says what, where and what is allowed; or when every_call_table declares it accepted.
Calls run in a process that keeps a journal: what crashes or hangs is named, and a new process goes on with the next call.
"""
import argparse
import collections
import json
import os
import re
import signal
import sys
import tempfile
import time
from pathlib import Path

import every_call_table as table
import every_call_values as values

HERE = Path(__file__).resolve().parent
LIMIT = 10., 90.  #: longest silence of the process that makes the calls [s]: by its own clock (a loop), by the clock on the wall (a lock)
#: what must not happen
FAULTS = ('crash', 'hang', 'silent', 'moved', 'poor', 'broken')
#: kinds that are tried before the first step only, and those that are tried at all moments; the study tries all at all
TYPES = ('text', 'texts', 'none', 'list', 'empty', 'complex', 'class', 'hugeInt', 'long', 'dict', 'number', 'short', 'wide', 'nested', 'cube', 'half')
FEW = ('nan', 'nonsense', 'fresh')
Call = collections.namedtuple('Call', 'name key kind moment run')


# ---- what there is


def members(cls):
	"""(defining class, name, object) of all attributes and methods up to YADE's Serializable."""
	seen = set()
	for c in cls.__mro__:
		if c.__name__ in ('instance', 'object', 'Serializable'): continue
		for name, thing in vars(c).items():
			wanted = not name.startswith('__') or name == '__call__'
			if wanted and name not in seen and name not in table.NOT_OURS:
				seen.add(name)
				yield c, name, thing


def typeOf(prop):
	found = re.search(r':yattrtype:`([^`]*)`', prop.__doc__ or '')
	return found.group(1) if found else ''


def arguments(function):
	"""[(type, name, has a default)] from Boost.Python's signature in the docstring, without self."""
	head = (function.__doc__ or '').strip().split('\n')[0]
	inside = head[head.find('(') + 1:head.rfind(') ->')] if ') ->' in head else ''
	found = re.findall(r'\((\w+)\)(\w+)(=?)', inside)
	return [(t, n, d == '=') for t, n, d in found[1:]]


def kindsOf(typeName, value):
	own = None
	if typeName.startswith('shared_ptr<Mca'):
		import yade.wrapper
		own = getattr(yade.wrapper, typeName[11:-1], None)
	if not typeName: typeName = type(value).__name__
	return values.ofType(typeName, own)


# ---- one call


def positions():
	from yade import O
	out = []
	for b in O.bodies:
		if b.state is not None: out.append(tuple(b.state.pos))
	for e in O.engines:
		if type(e).__name__ == 'McaGridEngine' and e.count: out += [e.view(k, c).tobytes() for k in range(len(e.blocks)) for c in 'xy']
	return repr(out)


RANGE = re.compile(r"\d|must|allowed|one of|known are|there are|remedy|instead|finite|\b(make|set|give|use|call|take|add|put|name)\b", re.I)
WHERE = re.compile(r"\bMca\w+|\bbody|\bbodies|material '|automat|block|packing|scene|O\.\w+|\bgrid\b", re.I)


def poor(error, names, where=()):
	"""What the message of a refusal lacks, or ''. Boost.Python's own refusal of a type is taken as it is: it stands at the line that sets.

	names: words for what; where: words that say where, besides those of WHERE.
	"""
	text = str(error)
	if type(error).__name__ == 'ArgumentError' or isinstance(error, (AttributeError, OverflowError)) or 'No registered converter' in text: return ''
	lacks = []
	if not any(n.lower() in text.lower() for n in names): lacks.append('what')
	if not WHERE.search(text) and not any(w.lower() in text.lower() for w in where): lacks.append('where')
	if not RANGE.search(text): lacks.append('allowed or remedy')
	return ', '.join(lacks)


def attempt(act, after, names, accepted, moment, inCall=()):
	"""(verdict, text): `act` makes the call, `after` the steps that follow; inCall: words for the method that is called."""
	where = None
	try:
		act()
		if moment not in ('running', 'stale', 'afterReset'): where = positions()
		after()
	except Exception as e:
		text = '%s: %s' % (type(e).__name__, e)
		lacks = poor(e, names, inCall)
		if where is not None and positions() != where: return 'moved', text
		return ('poor', 'lacks %s: %s' % (lacks, text)) if lacks and not accepted else ('refused', text)
	return ('accepted' if accepted else 'silent'), ''


def names(key):
	"""Words of which a message about this attribute or argument must have one."""
	own = key.split('(')[-1].rstrip(')') if '(' in key else key.split('.')[-1]
	return [own, *table.ALSO_CALLED.get(key, table.ALSO_CALLED.get(own, ()))]


class Calls:
	"""Makes the list for one class at one moment."""

	def __init__(self, cls, scene, moment, study):
		import every_call_scenes as scenes
		self.cls, (self.sceneName, self.build, self.find), self.moment, self.study = cls, scene, moment, study
		self.enter = scenes.MOMENTS[moment]
		self.refusals = {}  # of methods with right arguments, at this moment
		self.fails = None  # whether the steps fail without any call at this moment

	def label(self, what, kind): return '%s = %s | %s, %s' % (what, kind, self.sceneName, self.moment)

	def start(self):
		from yade import O
		import every_call_scenes as scenes
		scenes.stop()  # YADE itself does not survive O.reset() during a run
		O.reset()
		return self.enter(self.build, self.find)

	def baseline(self):
		thing, after = self.start()
		try:
			after()
		except Exception as e:
			self.fails = '%s: %s' % (type(e).__name__, e)
			expected = self.moment in table.MAY_FAIL or self.cls.__name__ in table.LATE
			lacks = poor(e, [''])
			return ('refused' if expected and not lacks else 'poor' if expected else 'broken'), self.fails
		self.fails = ''
		return 'accepted', ''

	def judged(self, act, after, key, kind, atThisMoment=None):
		"""At a moment whose steps fail anyway only a crash can be told from right. atThisMoment: refusal of right arguments as well."""
		if self.fails is None: self.baseline(), self.start()
		method = re.findall('[A-Z]?[a-z]+', key.split('(')[0].split('.')[1]) if '(' in key else ()
		verdict, text = attempt(act, after, names(key), table.accepted(key, kind, self.moment), self.moment, method)
		if verdict == 'poor' and atThisMoment and atThisMoment in text: verdict = 'refused'
		return ('refused' if self.fails and verdict in ('silent', 'poor', 'moved') else verdict), text

	def attribute(self, owner, name, kind, value):
		def run():
			thing, after = self.start()
			return self.judged(lambda: setattr(thing, name, value), after, '%s.%s' % (owner, name), kind)

		return run

	def reading(self, name):
		def run():
			thing, after = self.start()
			try:
				getattr(thing, name)
			except Exception as e:
				lacks = poor(e, [''])
				return 'poor' if lacks else 'refused', '%s: %s' % (type(e).__name__, e)
			return 'accepted', ''

		return run

	def method(self, key, name, good, argument, kind, value):
		def run():
			thing, after = self.start()
			given = dict(good(thing))
			if argument is not None: given[argument] = value
			if argument is not None and self.moment != 'before' and key not in self.refusals:
				try:
					getattr(thing, name)(**(good(thing)))
					self.refusals[key] = None
				except Exception as e:
					self.refusals[key] = str(e)
				thing, after = self.start()
			if argument is None:  # right arguments: may be refused at a bad moment, not at the first
				try:
					getattr(thing, name)(**given)
				except Exception as e:
					lacks = poor(e, [''])
					return ('broken' if self.moment == 'before' and key not in table.LATE else 'poor' if lacks else 'refused'), '%s: %s' % (type(e).__name__, e)
				try:
					after()
				except Exception as e:
					return ('refused' if self.fails is None or self.fails else 'broken'), '%s: %s' % (type(e).__name__, e)
				return 'accepted', ''
			return self.judged(lambda: getattr(thing, name)(**given), after, '%s(%s)' % (key, argument), kind, self.refusals.get(key))

		return run

	def wanted(self, kind, key):
		if self.study: return True
		if table.ACCEPTED.get(key, ('', ))[0] == table.ALL: return self.moment == 'before'
		return self.moment == 'before' or kind in FEW or self.moment == 'between' and kind not in TYPES

	def all(self):
		call = lambda what, key, kind, run: Call(self.label(what, kind), key, kind, self.moment, run)
		cls = self.cls.__name__
		yield call(cls, cls, 'nothing', self.baseline)
		for owner, name, thing in members(self.cls):
			key = '%s.%s' % (owner.__name__, name)
			what = '%s.%s' % (cls, name)
			if isinstance(thing, property):
				if self.moment != 'between': yield call(what, key, 'read', self.reading(name))
				try:
					now = getattr(self.cls(), name)
				except Exception:
					now = None
				for kind, value in kindsOf(typeOf(thing), now).items():
					if self.wanted(kind, key) and (thing.fset or kind == 'zero' and self.moment == 'before'): yield call(what, key, kind, self.attribute(owner.__name__, name, kind, value))
			elif callable(thing):
				given = arguments(thing)
				good = table.goodArguments(key, given)
				yield call(what, key, 'good', self.method(key, name, good, None, 'good', None))
				for typeName, argument, _ in given:
					for kind, value in kindsOf(typeName, None).items():
						if self.wanted(kind, '%s(%s)' % (key, argument)): yield call('%s(%s)' % (what, argument), key, kind, self.method(key, name, good, argument, kind, value))


def everyCall(study=False):
	"""All calls, always in the same order."""
	import yade.wrapper
	import yade_mca
	import every_call_scenes as scenes
	for name in yade_mca.classes:
		cls = getattr(yade.wrapper, name)
		for scene in scenes.holdersOf(cls):
			for moment in scenes.momentsOf(scene[0]):
				yield from Calls(cls, scene, moment, study).all()
	import every_call_modules as modules
	yield from modules.everyCall(Call, study)


# ---- processes


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
	import yade_mca
	calls = list(everyCall(study))
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
				todo = [k for k in todo if (calls[k].name.split('.')[0], calls[k].name.split(' | ')[1]) != group]
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
	sys.path[:0] = [str(HERE)]
	main()
