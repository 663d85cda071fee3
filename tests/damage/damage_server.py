# SPDX-License-Identifier: GPL-2.0-or-later
"""Loads damaged files in processes forked for that, and tells what became of each: `damage_server.py FILE FORMAT COUNT SEED` prints JSON.

What may come out: 'refused' (an error, by loading or in the two steps after it), 'same' (loaded, and the plugin's numbers are those that were saved), and two kinds of other states:
    made up     their checksum was made right: a number within its range is another valid state, no checksum can tell
    taken over  our part of the file is as saved, but a position, velocity or mass that stock YADE stores is not, and the engine has taken it as a script's change
What must not: 'silent' (our numbers differ), 'crash', 'hang', 'memory' (above 1 GB, or the damage was ours and memory ran out). Where the first damaged byte is YADE's, a crash
or a large memory is that of YADE's reader, which follows the numbers of objects in a binary file without a look: counted apart.

Our numbers are the arrays of the engines (sdk::Blob) and the attributes that the plugin's classes add to YADE's. A file is as saved in our part when each array and each object of ours
in it holds bit for bit what one of those saved held. What stock YADE stores beside them (positions, stock attributes such as density, which object hangs on which) has no checksum in .yade
and .xml; a change there is YADE's.
"""
import json
import os
import pickle
import random
import resource
import select
import signal
import struct
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import damage_bytes

LIMIT = 1 << 30  #: memory a load may take [bytes]
SECONDS = 120  #: one load and two steps may take
BATCH = 50  #: loads by one process


def load(path, form):
	from yade import O
	if form == 'checkpoint':
		from yade_mca import checkpoint
		checkpoint.read(path)
	else:
		O.load(path)


def plain(value):
	"""Bits of an attribute; other objects count by their class only, since they are looked at themselves."""
	if isinstance(value, float): return struct.pack('<d', value)
	if isinstance(value, (bool, int, str)) or value is None: return value
	if hasattr(value, '__len__'): return tuple(plain(v) for v in value)
	return type(value).__name__


def ownAttributes(thing):
	"""(class, attributes that the plugin's classes add) of an object, or None for one of stock YADE."""
	names = [c.__name__ for c in type(thing).__mro__]
	own = [i for i, n in enumerate(names) if n.startswith(('Mca', 'Ip2_McaMat', 'Ip2_FrictMat_McaMat', 'Law2_ScGeom_McaPhys'))]
	if not own: return None
	stock = type(thing).__mro__[own[-1] + 1]
	inherited = stock().dict().keys() if stock.__name__ not in ('object', 'instance') else ()
	return names[0], tuple((k, plain(v)) for k, v in sorted(thing.dict().items()) if k not in inherited)


def ours():
	"""Set of everything of the plugin that the scene holds."""
	from yade import O
	things = list(O.engines) + list(O.materials)
	for e in O.engines:
		for dispatcher in (getattr(e, a, None) for a in ('geomDispatcher', 'physDispatcher', 'lawDispatcher')):
			if dispatcher is not None: things += dispatcher.functors
	for b in O.bodies:
		if b is not None: things += [b.mat, b.state]
	things += [i.phys for i in O.interactions if i.phys is not None]
	return set(map(ownAttributes, (t for t in things if t is not None))) - {None} | set(damage_bytes.contents(O.sceneToString()))


def takenOver(path, form, known, new):
	"""Only the arrays differ, and those in the file do not."""
	if not all(isinstance(n, bytes) for n in new): return False
	return set(damage_bytes.stored(Path(path).read_bytes(), form)) == {n for n in known if isinstance(n, bytes)}


def attempt(path, form, known, madeUp):
	"""In the child: what becomes of the file."""
	from yade import O
	try:
		load(path, form)
		new = None if known is None else ours() - known
	except MemoryError as e:
		return 'refused', 'MemoryError'
	except Exception as e:
		return 'refused', str(e)[:300]
	verdict = 'same' if not new else 'made up' if madeUp else 'taken over' if takenOver(path, form, known, new) else 'silent'
	detail = ' '.join(str(n)[:200] for n in new) if new else ''
	try:
		O.run(2, True)
	except Exception as e:
		if verdict != 'silent': return 'refused', 'run: ' + str(e)[:300]
	return verdict, detail


def child(cases, form, known, out):
	"""Answers for all cases (number, file, made up), one line of JSON each. Never returns."""
	quiet = os.open(os.devnull, os.O_RDWR)
	for k in range(3): os.dup2(quiet, k)
	resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
	for s in (signal.SIGSEGV, signal.SIGABRT, signal.SIGFPE, signal.SIGBUS, signal.SIGILL): signal.signal(s, signal.SIG_DFL)
	size = int(Path('/proc/self/statm').read_text().split()[0]) * resource.getpagesize()
	before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
	resource.setrlimit(resource.RLIMIT_AS, (size + LIMIT, size + LIMIT))
	for number, path, madeUp in cases:
		verdict, detail = attempt(path, form, known, madeUp)
		grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
		os.write(out, json.dumps((number, verdict, detail, grown)).encode() + b'\n')
		if grown > LIMIT >> 12: break  # the peak would be counted for the next ones, too
	os._exit(0)


def answers(cases, form, known):
	"""Yields (number, verdict, detail, growth of memory [kB]) of each case; a process that dies costs its case only."""
	cases = list(cases)
	while cases:
		r, w = os.pipe()
		pid = os.fork()
		if pid == 0:
			os.close(r)
			child(cases[:BATCH], form, known, w)
		os.close(w)
		end = cases[BATCH:]
		batch, data = cases[:BATCH], b''
		with os.fdopen(r, 'rb', 0) as pipe:
			while batch:
				if b'\n' not in data:
					ready, _, _ = select.select([pipe], [], [], SECONDS)
					more = pipe.read(65536) if ready else None
					if not more: break
					data += more
					continue
				line, data = data.split(b'\n', 1)
				yield tuple(json.loads(line))
				batch.pop(0)
		if batch and more is None: os.kill(pid, signal.SIGKILL)
		_, status = os.waitpid(pid, 0)
		if batch and not (status == 0 and len(batch) < len(cases[:BATCH])):
			number = batch.pop(0)[0]
			yield (number, 'hang', '', 0) if more is None else (number, 'crash', 'signal %d' % os.WTERMSIG(status) if os.WIFSIGNALED(status) else 'status %d' % status, 0)
		cases = batch + end


def reference(path, form):
	"""Our numbers in the undamaged file; found in a child, so that this process never loads or runs anything."""
	r, w = os.pipe()
	pid = os.fork()
	if pid == 0:
		load(path, form)
		with os.fdopen(w, 'wb') as f: pickle.dump(ours(), f)
		os._exit(0)
	os.close(w)
	with os.fdopen(r, 'rb') as f: known = pickle.load(f)
	os.waitpid(pid, 0)
	return known


def main(path, form, count, seed):
	import yade_mca  # noqa: F401
	whole = Path(path).read_bytes()
	known = reference(path, form)
	(_, verdict, detail, _), = answers([(0, path, False)], form, known)
	assert verdict == 'same', 'the undamaged file: %s %s' % (verdict, detail)
	facts, cases, worst, wrong = {}, {}, 0, []

	def make():
		for k in range(count):
			dice = random.Random('%s %d %d' % (form, seed, k))
			data, what, isOurs, madeUp = damage_bytes.damage(dice, form, whole)
			bad = Path(path).with_name('damaged-%d-%d-%d.%s' % (os.getpid(), seed, k, form))
			bad.write_bytes(data)
			facts[k] = bad, what, isOurs, data == whole
			yield k, str(bad), madeUp

	for k, verdict, detail, grown in answers(make(), form, known):
		bad, what, isOurs, unchanged = facts[k]
		bad.unlink()
		if unchanged and verdict == 'same': verdict = 'unchanged'
		if verdict not in ('crash', 'hang') and (grown > LIMIT >> 10 or (isOurs and detail == 'MemoryError')): verdict = 'memory'
		worst = max(worst, grown)
		where = 'ours' if isOurs else "YADE's"
		cases[verdict + ', ' + where] = cases.get(verdict + ', ' + where, 0) + 1
		if verdict in ('silent', 'crash', 'hang', 'memory'): wrong.append(dict(number=k, what=what, where=where, verdict=verdict, detail=detail[:120]))
	print(json.dumps(dict(count=count, cases=cases, worstMemory=worst, wrong=wrong)))


if __name__ == '__main__':
	main(sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
