# SPDX-License-Identifier: GPL-2.0-or-later
"""An object in another process, for what need not be done in the process that computes. It takes calls one after the other, in their order.

    >>> files = Beside('yade_mca.impact_files', 'Files', folder)       # Files(folder), there
    >>> done = files.call('history', path, record)                     # a Future; the result, or what was raised, when it is there
    >>> files.close()                                                  # all calls have been made and the process is gone

Arguments, results and errors go through pipes (pickle). The other process is a Python of its own, which holds of YADE what its module imports. It ends
with this one, however this one ends; a Ctrl-C in the terminal is for this one only. When it dies, its open and later calls raise BesideError.
"""
import atexit
import contextlib
import fcntl
import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import Future

__all__ = ['Beside', 'BesideError']

#: calls that may wait; the next one waits for room, or their arrays would fill the memory, and files would come much later than the run is
AHEAD = 6
PATIENCE = 2.  #: [s] that the other process has for its end before it is killed
PIPE = 2**20  #: bytes that a pipe holds, where the system allows it


class BesideError(RuntimeError):
	"""The other process is gone."""


class Beside:
	"""See the head of this module."""

	def __init__(self, module, name, *args, environment=None):
		"""module, name: of the class whose object is made there with `args`; environment: variables {name: value} to change.

		What making it raises comes with each call.
		"""
		package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
		path = os.pathsep.join([package, *filter(None, [os.environ.get('PYTHONPATH')])])
		environment = dict(os.environ, PYTHONPATH=path, **(environment or {}))
		self.process = subprocess.Popen([sys.executable, '-c', 'from yade_mca import beside; beside.serve()'], env=environment, stdin=subprocess.PIPE,
		                                stdout=subprocess.PIPE)
		with contextlib.suppress(OSError, AttributeError): fcntl.fcntl(self.process.stdin, fcntl.F_SETPIPE_SZ, PIPE)
		self.waiting, self.room, self.lock = queue.SimpleQueue(), threading.Semaphore(AHEAD), threading.Lock()
		self.number, self.open, self.ended = 0, {}, False
		self.threads = [threading.Thread(target=t, daemon=True) for t in (self._send, self._receive)]
		for t in self.threads: t.start()
		atexit.register(self.stop)
		self.waiting.put(pickle.dumps((module, name, args), pickle.HIGHEST_PROTOCOL))

	def call(self, method, *args):
		"""Future of method(*args) there; arrays may change once this returns. Waits while too many calls do."""
		future = Future()
		self.room.acquire()
		with self.lock:
			self.number += 1
			data = pickle.dumps((self.number, method, args), pickle.HIGHEST_PROTOCOL)
			if self.ended:
				future.set_exception(self._gone())
				self.room.release()
			else:
				self.open[self.number] = future
				self.waiting.put(data)
		return future

	def close(self):
		"""Waits until all calls have been made and the process is gone."""
		self.waiting.put(pickle.dumps(None))
		self.threads[1].join()
		self.stop()

	def stop(self):
		"""Ends the process now; calls that have not been made raise BesideError."""
		if self.process.poll() is None:
			self.process.terminate()
			try:
				self.process.wait(PATIENCE)
			except subprocess.TimeoutExpired:
				self.process.kill()
		self.waiting.put(None)
		for t in self.threads: t.join()
		atexit.unregister(self.stop)

	def _send(self):
		with contextlib.suppress(OSError):  # it is gone, which the other thread notices
			while (data := self.waiting.get()) is not None:
				self.process.stdin.write(data)
				self.process.stdin.flush()
		with contextlib.suppress(OSError): self.process.stdin.close()

	def _receive(self):
		with contextlib.suppress(Exception):  # its end, or the middle of an answer
			while True:
				number, error, value = pickle.load(self.process.stdout)
				with self.lock:
					future = self.open.pop(number)
				(future.set_exception if error else future.set_result)(value)
				self.room.release()
		self.process.wait()
		self.process.stdout.close()
		with self.lock:
			self.ended, left, self.open = True, self.open, {}
		for future in left.values():
			future.set_exception(self._gone())
			self.room.release()

	def _gone(self):
		status = self.process.returncode
		return BesideError('the process beside this one has ended, ' + ('killed by signal %d' % -status if status < 0 else 'status %d' % status))


# ---- in the other process


def serve():
	"""Makes the object and answers calls until it is told that there are no more."""
	signal.signal(signal.SIGINT, signal.SIG_IGN)
	signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
	sys.setswitchinterval(5e-4)  # calls are to be taken in while one is made
	answers, waiting = os.fdopen(os.dup(1), 'wb'), queue.SimpleQueue()
	os.dup2(2, 1)  # what is printed is no answer
	threading.Thread(target=_listen, args=(os.fdopen(os.dup(0), 'rb'), waiting), daemon=True).start()
	os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
	made = failed = None
	try:
		module, name, args = waiting.get()
		made = getattr(__import__(module, fromlist=[name]), name)(*args)
	except Exception as e:
		failed = e
	while (message := waiting.get()) is not None:
		number, method, args = message
		answers.write(_answer(number, failed, made, method, args))
		answers.flush()


def _answer(number, failed, made, method, args):
	try:
		if failed: raise failed
		return pickle.dumps((number, False, getattr(made, method)(*args)), pickle.HIGHEST_PROTOCOL)
	except Exception as e:
		answer = (number, True, e)
	with contextlib.suppress(Exception):
		pickle.loads(data := pickle.dumps(answer))  # not all errors come back as they were
		return data
	return pickle.dumps((number, True, RuntimeError('%s: %s' % (type(answer[2]).__name__, answer[2]))))


def _listen(calls, waiting):
	"""Hands on what comes. When the pipe ends without a word the other process is gone, and this one ends, too."""
	with contextlib.suppress(EOFError, pickle.UnpicklingError, OSError):
		while True:
			message = pickle.load(calls)
			waiting.put(message)
			if message is None: return
	os.kill(os.getpid(), signal.SIGTERM)
	time.sleep(PATIENCE)
	os._exit(1)
