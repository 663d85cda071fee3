# SPDX-License-Identifier: GPL-2.0-or-later
"""Standard output and error that outlive their reader: `| head -1` closes the pipe, a full disk refuses what is printed, and the task goes on to its files and its status."""
import errno
import io
import os
import sys


class Lasting(io.FileIO):
	"""A file descriptor that takes everything; what cannot be written is dropped, from the first error on, which is kept in `failure`."""

	failure = None

	def __init__(self, descriptor):
		super().__init__(descriptor, 'w', closefd=False)

	def write(self, data):
		if self.failure is None:
			try:
				return super().write(data)
			except OSError as e:
				self.failure = e
				with open(os.devnull, 'wb') as nothing:
					os.dup2(nothing.fileno(), self.fileno())  # for child processes and for what is not Python
		return len(data)


def install():
	"""Puts such streams in the place of sys.stdout and sys.stderr; done once by each process that runs a task."""
	for name in ('stdout', 'stderr'):
		old = getattr(sys, name)
		try:
			descriptor = old.fileno()
			old.flush()
		except (AttributeError, OSError, ValueError):  # closed, or not a file
			continue
		raw = Lasting(descriptor)
		new = io.TextIOWrapper(io.BufferedWriter(raw), encoding=old.encoding, errors=old.errors, line_buffering=name == 'stderr' or old.line_buffering or old.write_through)
		setattr(sys, name, new)


def refused():
	"""Why standard output could not take all that was printed: text, or None; a reader that has left is no failure."""
	if sys.stdout is None: return None
	sys.stdout.flush()
	raw = getattr(getattr(sys.stdout, 'buffer', None), 'raw', None)
	failure = getattr(raw, 'failure', None)
	return None if failure is None or failure.errno == errno.EPIPE else failure.strerror
