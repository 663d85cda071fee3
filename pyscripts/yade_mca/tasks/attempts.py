# SPDX-License-Identifier: GPL-2.0-or-later
"""A full disk costs the files that it hits, not what was computed: each file is tried, the rest goes on, and all that could not be written are named at the end."""
import contextlib
import os
import sys

__all__ = ['Attempts', 'inMemory']


class Attempts:
	"""attempt(path, write, *args) calls write(*args); `failures` is {path: why} of what could not be written."""

	def __init__(self, task):
		self.task, self.failures = task, {}

	def __call__(self, path, write, *args):
		"""True when it worked. A path that could not be written stays in `failures` until it can."""
		try:
			write(*args)
		except OSError as e:
			name, why = str(e.filename or path), e.strerror or str(e)
			if name not in self.failures:
				print("\n%s: cannot write '%s': %s; the run goes on" % (self.task, name, why), file=sys.stderr)
			self.failures[name] = why
			return False
		self.failures.pop(str(path), None)
		return True

	def finish(self):
		"""Raises OSError that names all files that are missing, if any are."""
		if self.failures:
			raise OSError('%d file%s could not be written: %s' % (len(self.failures), 's' * (len(self.failures) > 1), '; '.join("'%s': %s" % f for f in self.failures.items())))


@contextlib.contextmanager
def inMemory(name):
	"""Path of an empty file without a disk, for what child processes hand back: it can be written when no disk has room. Gone afterwards."""
	handle = os.memfd_create(name)
	try:
		yield '/proc/%d/fd/%d' % (os.getpid(), handle)
	finally:
		os.close(handle)
