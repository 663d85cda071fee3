# SPDX-License-Identifier: GPL-2.0-or-later
"""Where YADE itself is mended at run time, so that bodies and engines agree whenever a script can look; all of it is in this module.

Stock O.pause(), and at times O.wait(), return while the last step is still being made, and nothing tells an engine that the loop has ended: whoever reads O.bodies then may
find the state of an earlier step. Here they return when that step is over, and O.bodies asks the plugin's engines first to write what they have
not written (nothing, nearly always). O.save and its kin, called while the loop runs in the background, would mix two steps in one file: they
pause, save and go on.

Set YADE_MCA_STOCK_OMEGA=1 to leave YADE as it is (a YADE that waits in O.pause() does not need this).
"""
import functools
import os

SAVING = ('save', 'saveTmp', 'sceneToString')


def mend(omega, settler):
	"""Changes the class `omega` (yade.wrapper.Omega); settler: class with settle(), endStepUnderWay() and inLoop()."""
	if os.environ.get('YADE_MCA_STOCK_OMEGA') == '1' or hasattr(omega, '_yadeMcaMended'): return
	omega._yadeMcaMended = True
	pause, bodies, settle = omega.pause, omega.bodies, settler.settle

	@functools.wraps(pause)
	def pauseWhole(self):
		running = self.running
		pause(self)
		if running: settler.endStepUnderWay()

	def whole(call):
		"""O.wait() and O.run(n, True) may come back before the last step is counted, when a PyRunner has paused the loop."""

		@functools.wraps(call)
		def wrapped(self, *args, **keywords):
			call(self, *args, **keywords)
			if not self.running: settler.endStepUnderWay()

		return wrapped

	def bodiesUpToDate(self):
		settle()
		return bodies.fget(self)

	omega.pause, omega.wait, omega.run = pauseWhole, whole(omega.wait), whole(omega.run)
	omega.bodies = property(bodiesUpToDate, doc=bodies.__doc__)
	for name in SAVING:
		if hasattr(omega, name): setattr(omega, name, _betweenSteps(getattr(omega, name), pauseWhole, settler))


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
