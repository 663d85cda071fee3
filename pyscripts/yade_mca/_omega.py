# SPDX-License-Identifier: GPL-2.0-or-later
"""Where YADE itself is mended at run time, so that bodies and engines agree whenever a script can look; all of it is in this module.

Stock O.pause(), and at times O.wait(), return while the last step is still being made, and nothing tells an engine that the loop has ended: whoever reads O.bodies then may
find the state of an earlier step. Here they return when that step is over, and O.bodies asks the plugin's engines first to write what they have
not written (nothing, nearly always). O.save and its kin, called while the loop runs in the background, would mix two steps in one file: they
pause, save and go on. O.reset and its kin take the loop away from a thread that has been paused before it has begun: O.pause() waits for its end,
and they pause first.

Set YADE_MCA_STOCK_OMEGA=1 to leave YADE as it is (a YADE that waits in O.pause() does not need this).
"""
import functools
import os
import threading
import time

SAVING = ('save', 'saveTmp', 'sceneToString')
ENDING = ('reset', 'load', 'loadTmp', 'reload', 'stringToScene')
TASKS = '/proc/self/task'
PATIENCE = 5.  #: [s] that a thread has for its end after the last step


class Loop:
	"""The thread that the last O.run(n) has started; YADE's own record of it ends before the thread does."""

	def __init__(self): self.threads, self.before = set(), None  # tasks of this process; before: those that were there, while it is being started

	@staticmethod
	def alive():
		"""All tasks. A listing ends early where a task dies while it is made (the loop before): it has to have as many as the folder counts."""
		try:
			for _ in range(100):
				names = os.listdir(TASKS)
				if len(names) == os.stat(TASKS).st_nlink - 2: break
			return set(names)
		except OSError:  # no /proc: as stock YADE
			return set()

	def started(self, start):
		"""start() makes the thread, which may ask isThis() before it is known here."""
		self.before = self.alive()
		try:
			start()
			self.threads = self.alive() - self.before - {str(t.native_id) for t in threading.enumerate() if not t.name.startswith('Dummy-')}  # foreign ones have such names
		finally:
			self.before = None

	def isThis(self):
		"""Whether it is the thread that asks: a PyRunner."""
		me, before = str(threading.get_native_id()), self.before
		return me in self.threads if before is None else me not in before

	def end(self):
		"""Waits until it is gone; others may go on meanwhile."""
		last = time.monotonic() + PATIENCE
		while self.threads and not self.isThis() and time.monotonic() < last:
			self.threads = {t for t in self.threads if os.path.exists(f'{TASKS}/{t}')}
			if self.threads: time.sleep(1e-4)


def mend(omega, settler):
	"""Changes the class `omega` (yade.wrapper.Omega); settler: class with settle(), endStepUnderWay() and inLoop()."""
	if os.environ.get('YADE_MCA_STOCK_OMEGA') == '1' or hasattr(omega, '_yadeMcaMended'): return
	omega._yadeMcaMended = True
	pause, run, bodies, settle, loop = omega.pause, omega.run, omega.bodies, settler.settle, Loop()

	@functools.wraps(pause)
	def pauseWhole(self):
		running = self.running
		pause(self)
		if loop.isThis(): return  # a PyRunner
		if running: settler.endStepUnderWay()
		if not settler.inLoop(): loop.end()

	def whole(call):
		"""O.wait() and O.run(n, True) may come back before the last step is counted, when a PyRunner has paused the loop."""

		@functools.wraps(call)
		def wrapped(self, *args, **keywords):
			call(self, *args, **keywords)
			if not self.running: settler.endStepUnderWay()

		return wrapped

	runWhole = whole(run)

	@functools.wraps(run)
	def runNoted(self, *args, **keywords):
		if (keywords['wait'] if 'wait' in keywords else len(args) > 1 and args[1]): return runWhole(self, *args, **keywords)
		loop.started(lambda: run(self, *args, **keywords))

	def bodiesUpToDate(self):
		settle()
		return bodies.fget(self)

	omega.pause, omega.wait, omega.run = pauseWhole, whole(omega.wait), runNoted
	omega.bodies = property(bodiesUpToDate, doc=bodies.__doc__)
	for name in SAVING:
		if hasattr(omega, name): setattr(omega, name, _betweenSteps(getattr(omega, name), pauseWhole, settler))
	for name in ENDING:
		if hasattr(omega, name): setattr(omega, name, _afterTheLoop(getattr(omega, name), pauseWhole, settler))


def _betweenSteps(call, pause, settler):
	@functools.wraps(call)
	def saved(self, *args, **keywords):
		if not self.running or settler.inLoop(): return call(self, *args, **keywords)
		pause(self)
		try:
			return call(self, *args, **keywords)
		finally:
			self.run()

	return saved


def _afterTheLoop(call, pause, settler):
	@functools.wraps(call)
	def ending(self, *args, **keywords):
		if not settler.inLoop(): pause(self)
		return call(self, *args, **keywords)

	return ending
