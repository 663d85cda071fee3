# SPDX-License-Identifier: GPL-2.0-or-later
"""The cells of the matrix of ordinary scripting: how a script comes to look at the scene (stops), and what makes a cell right, refused or wrong.

    python3 matrix_cells.py ROAD     reads cells 'stop/action' from stdin, one a line, and writes one line of JSON for each
"""
import json
import math
import os
import re
import sys
import tempfile
import time
from pathlib import Path

if __name__ == '__main__':
	sys.path.insert(0, str(Path(__file__).resolve().parent))
	import yade_mca  # noqa: F401  loads the classes

from matrix_actions import ACTIONS, undisturbed
from matrix_scene import DT, MatrixScene, difference

ROADS = ('engine', 'law2', 'coupled')
STEPS, GAP, AFTER = 56, 64, 60  #: steps to the stop, until C1 meets C2, and from there to the end
LONG = 600  #: gap where nobody knows at which step the run stops


class Retry(Exception):
	"""The run stopped too late for this scene."""


def runner(command, step, place=None):
	"""A PyRunner at the end of O.engines that does `command` once, as the last deed of step number `step`; or at `place`, in the step after that."""
	from yade import O
	from yade.wrapper import PyRunner
	e = O.engines
	place = len(e) if place is None else place
	O.engines = e[:place] + [PyRunner(command=command, iterPeriod=1, nDo=1, firstIterRun=step - 1 if place == len(e) else step)] + e[place:]


def run(steps):
	from yade import O
	O.run(steps, True)


def stopAtIter(c):
	from yade import O
	O.stopAtIter = STEPS
	O.run()
	O.wait()
	c.at(O.iter)


def stopAtTime(c):
	from yade import O
	O.stopAtTime = (STEPS - 0.5) * DT
	O.run()
	O.wait()
	O.stopAtTime = 0
	c.at(O.iter)


def pauseAtPrompt(c):
	from yade import O
	O.run()
	while O.iter < 10: pass
	O.pause()
	n = O.iter
	if n > c.gap - 20: raise Retry
	c.at(n)


def pauseInRunner(c):
	from yade import O
	runner('O.pause()', STEPS)
	O.run()
	O.wait()
	c.at(O.iter)


def inRunner(c):
	import builtins
	builtins.matrixHook = lambda: c.at(STEPS)
	c.inside = True
	runner('matrixHook()', STEPS)
	run(c.end)


def failing(c, place, done):
	from yade import O
	runner('raise ValueError("a script error")', STEPS, place)
	try:
		run(c.end)
	except RuntimeError:
		pass
	while O.running: time.sleep(1e-3)
	c.at(O.iter + done)


def exceptionAfter(c):
	failing(c, None, 1)  # the step is done, YADE has not counted it


def exceptionBetween(c):
	from yade import O
	names = [type(e).__name__ for e in O.engines]
	failing(c, {'engine': 0, 'law2': names.index('NewtonIntegrator') if c.road == 'law2' else 0, 'coupled': len(names) - 1}[c.road], 0)


def endOfRun(c):
	run(STEPS)
	c.at(STEPS)


def step(c):
	from yade import O
	for _ in range(STEPS): O.step()
	c.at(STEPS)


def load(c):
	from yade import O
	run(STEPS)
	O.save(c.file)
	run(7)
	O.load(c.file)
	c.at(O.iter)


def loadTmp(c):
	from yade import O
	run(STEPS)
	O.saveTmp()
	run(7)
	O.loadTmp()
	c.at(O.iter)


def reload(c):
	from yade import O
	run(STEPS)
	O.save(c.file)
	O.load(c.file)
	run(7)
	O.reload()
	c.at(O.iter)


def switchToScene(c):
	from yade import O
	run(STEPS)
	here = O.thisScene if hasattr(O, 'thisScene') else 0
	other = O.addScene()
	O.switchToScene(other)
	MatrixScene(c.road, c.gap)
	run(9)
	O.switchToScene(here)
	c.at(O.iter)


def sameEngines(c):
	from yade import O
	return list(O.engines) if c.road == 'law2' else c.scene.engine()


def reset(c):
	from yade import O
	run(STEPS)
	old = sameEngines(c)
	O.reset()
	c.scene = MatrixScene(c.road, c.gap, old)
	c.anew = True
	c.at(0)


def clear(c):
	"""Grid and coupler, which stand for other bodies, are made anew."""
	from yade import O
	run(STEPS)
	old = sameEngines(c)
	O.bodies.clear()
	O.interactions.clear()
	c.scene = MatrixScene(c.road, c.gap, old)
	c.anew = True
	c.at(0)


STOPS = {
        'stopAtIter': stopAtIter,
        'stopAtTime': stopAtTime,
        'pause at the prompt': pauseAtPrompt,
        'pause in a PyRunner': pauseInRunner,
        'in a PyRunner': inRunner,
        'exception after the step': exceptionAfter,
        'exception within the step': exceptionBetween,
        'end of O.run': endOfRun,
        'O.step': step,
        'load': load,
        'loadTmp': loadTmp,
        'reload': reload,
        'switchToScene': switchToScene,
        'reset': reset,
        'clear': clear,
}


def doesNotApply(road, stop, action):
	"""Why there is no such cell, or None."""
	if action == 'tied velocity' and road != 'coupled': return 'no row is tied to a grid on this road'
	if action == 'tied velocity' and stop in ('reset', 'clear'): return 'the row is tied in the first step and takes the velocity of the grid then'
	return None


def cells(road):
	"""[(stop, action)] of the road."""
	return [(s, a) for s in STOPS for a in ACTIONS if not doesNotApply(road, s, a)]


class Cell:
	def __init__(self, road, stop, action, folder):
		from yade import O
		O.reset()
		self.road, self.stop, self.action, self.folder = road, stop, ACTIONS[action], folder
		self.file = os.path.join(folder, 'stop.yade.gz')
		self.gap = LONG if stop == 'pause at the prompt' else GAP
		self.end = self.gap + AFTER
		self.problems, self.inside, self.anew, self.n, self.momentum, self.seen = [], False, False, None, None, None
		self.scene = MatrixScene(road, self.gap)

	@property
	def left(self):
		return self.end - self.n

	def problem(self, text):
		if text not in self.problems: self.problems.append(text)

	def at(self, n):
		"""Python can look: n steps are done."""
		from yade import O
		self.n, self.iter = n, O.iter
		expected = n if self.stop == 'pause at the prompt' else 0 if self.anew else STEPS
		if n != expected: self.problem('%d steps are done instead of %d' % (n, expected))
		self.then = self.scene.look()
		self.undo = self.action.apply(self)
		self.then = self.scene.look()

	def goOn(self):
		from yade import O
		start = O.iter
		run(self.left)
		if O.iter != start + self.left: self.problem('O.run(%d, True) made %d steps and raised nothing' % (self.left, O.iter - start))

	def compare(self, when, now, expected):
		for group, e in expected.items():
			off, words = difference(now.get(group, e[:0]), e)
			if not off <= 1: self.problem('%s: %s, %s (%.3g of the tolerance)' % (when, group, words, off))

	def result(self):
		"""(verdict, words)"""
		message = None
		try:
			STOPS[self.stop](self)
			if not self.inside: self.goOn()
		except RuntimeError as e:
			message = str(e)
			if self.n is None: return 'wrong', 'never came to act: ' + message
		if message is not None: return self.refused(message)
		if getattr(self.action, 'mustRefuse', False): return 'wrong', 'not refused'
		self.finish(self.action)
		return self.verdict('right')

	def finish(self, action):
		now = self.scene.look()
		if self.momentum is not None and not (self.between and self.scene.coupled):  # nobody knows the momentum of half a step
			p = self.scene.momentum('S')
			kept = abs(p - self.momentum).max() < 1e-8 * (abs(self.momentum).max() + 1e-3)
			if not kept: self.problem('momentum of S is %s instead of %s' % (p, self.momentum))
		if hasattr(action, 'check'): action.check(self)
		self.compare('at the end', now, action.expect(self))

	def atTheStop(self):
		"""What the bodies should hold at the stop. Within a step pressures and strains may be those of the next one already."""
		out = undisturbed(self, self.n)
		if self.between:
			out.pop('grid', None)  # half of its nodes may have moved
			for e in out.values(): e[:, 5:] = math.nan
		if self.n == 0:
			for group, e in out.items():
				if group != 'grid': e[:, 8] = math.nan  # links are made in the first step, or when somebody asks
		return out

	@property
	def between(self):
		"""The run was stopped between forces and motion."""
		return self.stop == 'exception within the step' and self.road != 'engine'

	def refused(self, message):
		from yade import O
		late = O.iter - self.iter - self.inside  # a PyRunner acts before its own step is counted
		if late: self.problem('refused %d steps after the change: %s' % (late, message))
		elif not self.inside:
			now = self.scene.look()
			moved = any(abs(now[g][:, :2] - e[:, :2]).max(initial=0.) > 0 for g, e in self.then.items())
			if moved: self.problem('something moved although the step was refused: ' + message)
		if self.anew:  # an engine that stands for other bodies may say so; the remedy is a new one
			if len(message) < 50: self.problem('says too little: ' + message)
			self.scene.engines()
			try:
				self.goOn()
				if getattr(self.action, 'mustRefuse', False): self.problem('not refused')
				self.compare('with new engines, at the end', self.scene.look(), self.action.expect(self))
				return self.verdict('refused', message)
			except RuntimeError as e:
				message = str(e)
		if not self.action.mayRefuse: return 'wrong', 'must not be refused: ' + message
		if len(message) < 50 or not all(re.search(w, message) for w in self.action.words):
			self.problem('says too little: ' + message)
		blamed = re.search('state\\.(\\w+) was set to', message)
		if blamed and blamed.group(1) != getattr(self.action, 'name', None):
			self.problem('blames what the script has not done: ' + message)
		if self.undo is None: return self.verdict('refused', message)
		self.undo()
		try:
			self.goOn()
			self.compare('mended, at the end', self.scene.look(), undisturbed(self))
		except RuntimeError as e:
			self.problem('does not go on after mending: %s' % e)
		return self.verdict('refused', message)

	def verdict(self, good, words=''):
		return ('wrong', '; '.join(self.problems)) if self.problems else (good, words)


def judge(road, stop, action):
	"""One cell, in this process: (verdict, words)."""
	with tempfile.TemporaryDirectory() as folder:
		for _ in range(20):
			cell = Cell(road, stop, action, folder)
			try:
				return cell.result()
			except Retry:
				continue
			except Exception as e:  # the scene itself broke, or what it shows
				return 'wrong', '%s: %s' % (type(e).__name__, e)
	return 'wrong', 'never stopped in time'


def worker(road):
	out = os.fdopen(os.dup(1), 'w')
	os.dup2(2, 1)  # YADE talks on stdout
	for line in sys.stdin:
		stop, action = line.strip().split('/')
		out.write(json.dumps([stop, action, *judge(road, stop, action)]) + '\n')
		out.flush()
	out.close()
	os._exit(0)  # YADE's own end is not the subject


if __name__ == '__main__':
	worker(sys.argv[1])
