# SPDX-License-Identifier: GPL-2.0-or-later
"""What a task found: cases with value, reference, error and limit; as a table on screen and as one JSON object."""
import json
import math
import os
import stat
import sys
import tempfile
import time
from dataclasses import asdict, dataclass

from . import environment


@dataclass
class Case:
	"""One number. None where there is no reference, error, limit or order of convergence."""
	name: str
	value: float
	reference: float = None
	error: float = None  #: |value - reference|/|reference|, or the absolute difference where the reference is 0, unless given
	limit: float = None
	unit: str = ''
	order: float = None
	passed: bool = True
	asserted = True  # not a field of the file: False where nothing but finite numbers is asked for


def _plain(x):
	"""A Python number or None of a numpy scalar, number or bool."""
	if x is None or isinstance(x, (bool, int, str)):
		return x
	return x.item() if hasattr(x, 'item') else float(x)


def _finite(x):
	return x is None or isinstance(x, (bool, str)) or math.isfinite(x)


def jsonable(x):
	"""x with numpy numbers as Python's and not-a-number and infinity as None, which is what JSON can hold."""
	if isinstance(x, dict):
		return {str(k): jsonable(v) for k, v in x.items()}
	if isinstance(x, (list, tuple)):
		return [jsonable(v) for v in x]
	if hasattr(x, 'tolist'):
		return jsonable(x.tolist())
	return x if _finite(x) else None


def writeAtomically(path, data):
	"""Writes `data` (bytes or str) to `path` so that a reader finds the old file or the whole new one, never a part.

	data may also be a function that fills the file with the name it gets. Links are followed. What is no regular file (a device, a pipe) is written as it stands. Raises OSError that names `path`.
	"""
	data = data.encode() if isinstance(data, str) else data
	try:
		if isPlain(path):
			_replace(os.path.realpath(path), data)
		else:
			_writeInto(path, data)
	except OSError as e:
		raise OSError(e.errno, e.strerror or str(e), str(path)) from e


def isPlain(path):
	"""True when `path` can be replaced by a new file: a regular file or none yet, and not one that this or another process holds open (/dev/stdout)."""
	try:
		if not stat.S_ISREG(os.stat(path).st_mode):
			return False
	except FileNotFoundError:
		pass
	return not os.path.abspath(path).startswith(('/dev/', '/proc/'))


def _writeInto(path, data):
	if callable(data): data = _filled(data)
	if sys.stdout: sys.stdout.flush()  # which `path` may be
	handle = os.open(path, os.O_WRONLY | os.O_APPEND)
	with os.fdopen(handle, 'wb', buffering=0) as f:
		while data:
			data = data[f.write(data):]


def _filled(fill):
	"""What fill(name) writes."""
	with tempfile.NamedTemporaryFile(suffix='.part') as f:
		fill(f.name)
		return f.read()


def _replace(path, data):
	handle, temporary = tempfile.mkstemp('.part', '.' + os.path.basename(path) + '.', os.path.dirname(path))  # VTK cuts '_' off the end of a name
	try:
		with os.fdopen(handle, 'wb') as f:
			if callable(data): data(temporary)
			else: f.write(data)
			f.flush()
			os.fsync(f.fileno())
		mask = os.umask(0)
		os.umask(mask)
		os.chmod(temporary, 0o666 & ~mask)
		os.replace(temporary, path)
	except BaseException:
		os.unlink(temporary)
		raise


class Report:
	"""Collects the cases of one task. `task` as typed, e.g. 'verify automata'."""

	def __init__(self, task, stream=None):
		self.task, self.stream = task, stream or sys.stdout
		self.cases, self.extra, self.error = [], {}, None
		self._start = time.monotonic()

	def add(self, name, value, reference=None, error=None, limit=None, unit='', order=None, passed=None):
		"""Adds a case and returns it.

		error    default: relative to the reference (absolute where that is 0); without a reference and with a limit, |value|
		limit    largest error allowed; None: nothing is asserted except that the numbers are finite
		passed   overrides the comparison of error and limit (e.g. for a lower bound); numbers that are not finite fail all the same
		"""
		value, reference, error, limit, order = (_plain(x) for x in (value, reference, error, limit, order))
		if error is None and reference is not None:
			error = abs(value - reference) / (abs(reference) or 1.)
		compared = error if error is not None else abs(value) if limit is not None else None
		ok = _finite(value) and _finite(reference) and _finite(error)
		holds = (limit is None or compared <= limit) if passed is None else bool(passed)
		case = Case(name, value, reference, error, limit, unit, order, bool(ok and holds))
		case.asserted = limit is not None or passed is not None
		self.cases.append(case)
		return case

	@property
	def failed(self):
		"""The cases that did not pass."""
		return [c for c in self.cases if not c.passed]

	@property
	def exitCode(self):
		"""0 when there was no error and every case passed, else 1."""
		return 1 if self.failed or self.error else 0

	def asDict(self):
		"""The object that goes to the JSON file."""
		d = dict(task=self.task, version=environment.version(), commit=environment.commit(), threads=environment.threads(), isa=environment.isa(),
		         wall=time.monotonic() - self._start, cases=[asdict(c) for c in self.cases])
		if self.error:
			d['error'] = self.error
		d.update(self.extra)
		return jsonable(d)

	def write(self, path):
		"""Writes the JSON file, whole or not at all."""
		writeAtomically(path, json.dumps(self.asDict(), indent=1, allow_nan=False) + '\n')

	def table(self):
		"""The cases as text, one line each; the last word is empty where nothing is asserted."""
		show = lambda x: '-' if x is None else '%.6g' % x if isinstance(x, float) else str(x)
		head = ('case', 'value', 'reference', 'error', 'limit', 'order', 'unit', '')
		rows = [(c.name, show(c.value), show(c.reference), '-' if c.error is None else '%.3g' % c.error, show(c.limit),
		         '-' if c.order is None else '%.2f' % c.order, c.unit or '-', 'FAILED' if not c.passed else 'ok' if c.asserted else '') for c in self.cases]
		width = [max(len(r[k]) for r in [head, *rows]) for k in range(len(head))]
		line = lambda r: '  '.join(r[k].ljust(width[k]) if k in (0, 6, 7) else r[k].rjust(width[k]) for k in range(len(head))).rstrip()
		return '\n'.join(map(line, [head, *rows]))

	def show(self):
		"""Prints the table and the summary line."""
		if self.cases:
			print(self.table(), file=self.stream)
			passed = sum(c.passed and c.asserted for c in self.cases)
			measured = len(self.cases) - len(self.failed) - passed
			print('%s: %d passed, %d failed, %s%.1f s' % (self.task, passed, len(self.failed), '%d only measured, ' % measured if measured else '', time.monotonic() - self._start),
			      file=self.stream)
