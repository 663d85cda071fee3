# SPDX-License-Identifier: GPL-2.0-or-later
"""What the files of a penetration run are made of, read from the scene as plain arrays, and when they are due.

They are drawn and written by impact_files, beside the run.
"""
import errno
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .beside import Beside
from .frames import frameNumber
from .tasks.attempts import Attempts

__all__ = ['Output', 'Still', 'patternPicture', 'still', 'writeParaview']


@dataclass
class Still:
	"""A moment of a run, all that pictures and files of it need."""
	time: float  #: [s]
	positions: np.ndarray  #: of all automata (N, 2) [m]
	radius: np.ndarray  #: (N,) [m]
	fields: dict  #: name with unit -> (N,) or (N, 2)
	grids: dict  #: name of the block -> (nodes (rows, columns, 2) [m], cell fields, node fields)
	rows: list  #: for each interface which automata are tied
	facts: dict  #: of the scene
	bounds: tuple  #: what all pictures of the run show (x0, y0, x1, y1) [m]
	text: str = ''  #: above a frame of the animation
	space: dict = None  #: in space, where the rest is the section z = 0: positions (N, 3) [m], radius (N,) [m] and fields of all automata


def automataFields(s):
	"""(ids, positions (N, 2) [m], radius (N,) [m], fields) of all automata; names of the fields carry their units."""
	f = s.automata.fields(['ids', 'x', 'y', 'vx', 'vy', 'diameter', 'pressure', 'equivalentStress', 'plasticStrain', 'temperature', 'links'])
	fields = {'velocity [m/s]': np.stack((f['vx'], f['vy']), axis=1), 'pressure [Pa]': f['pressure'], 'equivalentStress [Pa]': f['equivalentStress'],
	          'plasticStrain': f['plasticStrain'], 'temperature [K]': f['temperature'], 'links': f['links'], 'rod': np.isin(f['ids'], s.ids['rod']).astype(np.uint8)}
	return f['ids'], np.stack((f['x'], f['y']), axis=1), 0.5 * f['diameter'], fields


def _section(s, ids, positions, radius, fields):
	"""A scene in space: (positions, radius, fields) of the automata that the plane z = 0 cuts, a quarter with its image, and Still.space."""
	z = s.automata.fields(['z', 'vz'])
	space = dict(positions=np.column_stack((positions, z['z'])), radius=radius, fields=dict(fields, **{'velocity [m/s]': np.column_stack((fields['velocity [m/s]'], z['vz']))}))
	cut = abs(z['z']) < radius
	positions, radius, fields = positions[cut], radius[cut], {k: v[cut] for k, v in fields.items()}
	if s.facts['parts'] == 1: return positions, radius, fields, space
	image, turned = positions * (-1, 1), dict(fields, **{'velocity [m/s]': fields['velocity [m/s]'] * (-1, 1)})
	return np.concatenate((positions, image)), np.tile(radius, 2), {k: np.concatenate((v, turned[k])) for k, v in fields.items()}, space


def gridFields(s, block):
	"""(nodes (rows, columns, 2) [m], cell fields, node fields) of a grid block."""
	v = lambda name: np.array(s.grid.view(block, name))
	nodes = np.stack((v('x'), v('y')), axis=-1)
	cells = {'pressure [Pa]': v('pressure'), 'plasticStrain': v('plasticStrain')}
	cells['equivalentStress [Pa]'] = np.sqrt(3 * (v('sxx')**2 + v('sxx') * v('syy') + v('syy')**2 + v('sxy')**2))
	return nodes, cells, {'velocity [m/s]': np.stack((v('vx'), v('vy')), axis=-1)}


def bounds(s):
	"""What all pictures of a run show (x0, y0, x1, y1) [m]: the plate, the rod at the start and as much below the plate."""
	f = s.facts
	half = 0.5 * f.get('plateWidth', f['automataWidth']) + 2 * f['spacing']
	half = max(min(half, 0.6 * f['rodLength']), abs(f['direction'][0]) * f['rodLength'] + 2 * f['rodDiameter'])  # an oblique rod leans over
	return (-half, -f['thickness'] - 0.85 * f['rodLength'], half, 1.02 * f['rodLength'])


def still(s, time, text=''):
	"""The scene as it stands, a Still; time [s]."""
	ids, positions, radius, fields = automataFields(s)
	if s.facts.get('dimension') == 3:
		positions, radius, fields, space = _section(s, ids, positions, radius, fields)
		return Still(time, positions, radius, fields, {}, [], s.facts, bounds(s), text, space)
	grids, rows = {name: gridFields(s, k) for name, k in s.blocks.items()}, [np.searchsorted(ids, np.array(c.rowIds)) for c in s.couplers]
	return Still(time, positions, radius, fields, grids, rows, s.facts, bounds(s), text)


def writeParaview(s, folder, name, time):
	"""Writes automata, grid blocks and interface; returns {part number: path} for a Collection."""
	from . import impact_files
	return impact_files.writeParaview(still(s, time), folder, name)


def patternPicture(path, s, time, title=''):
	"""Plastic strain and pressure side by side; the outline of the bodies at the start as a line, the mesh of the grid drawn."""
	from .impact_files import Pattern
	pattern = Pattern()
	try:
		return pattern.write(path, still(s, time), title)
	finally:
		pattern.close()


class Output:
	"""Pictures at given times and at the end, frames of the animation and ParaView files at regular ones, all made by a process beside this one (use as a context manager).

	A file that cannot be written does not end the run, nor does the end of that process: it is named on the standard error and in `attempt.failures` ({path: why}).
	"""

	def __init__(self, folder, pictures=(0., 20e-6, 40e-6), every=5e-6, animation=True):
		"""folder exists. pictures: times [s]; every: interval of the ParaView files [s]; animation: False for none.

		The other process gets ready while the scene is built.
		"""
		self.folder, self.pictures, self.every, self.animation = Path(folder), list(pictures), every, animation
		self.beside = Beside('yade_mca.impact_files', 'Files', str(folder), environment=dict(OMP_NUM_THREADS='1'))
		self.attempt = Attempts('penetration')
		self.asked = []  # (path, future, kind) of what is being made
		self.seconds = {'animation': 0.}  #: processor time by kind of file, of both processes
		self.next, self.lastSeries, self.lastFrame = 0, None, -1
		self.interval = None  # the shortest between frames [s]; there may be fewer, see Frames

	def __enter__(self):
		return self

	def __exit__(self, kind, *error):
		if kind is None: self.beside.close()
		else: self.beside.stop()

	def begin(self, run, resumeAt=None):
		"""Before the first update(). resumeAt: time of the checkpoint of a run that goes on [s]."""
		f = run.scene.facts
		self.interval = f['rodLength'] / f['speed'] / 52  # some 55 in all: most runs end soon after the rod has flown its length
		self.lastSeries, self.lastFrame = self.beside.call('begin', bounds(run.scene), self.interval, resumeAt, self.animation).result()
		if resumeAt is not None:
			self.pictures = [t for t in self.pictures if t > resumeAt or not (self.folder / self.name(t)).exists()]
			self.next = int(resumeAt / self.every) + 1

	@staticmethod
	def name(t):
		return 'pattern_%02.0fus.png' % (1e6 * t)

	def update(self, run, end=False):
		"""To be called at the start and after each sample; asks for what is due. What was interrupted may be called again."""
		start, due, number = time.process_time(), [t for t in self.pictures if run.time >= t], frameNumber(round(1e9 * run.time), self.interval)
		series = (run.time >= self.next * self.every or end) and not (self.lastSeries is not None and self.lastSeries >= run.time)
		frame = self.animation and number > self.lastFrame
		now = self._still(run) if due or series or frame or end else None
		if frame:
			self._ask(self.folder / 'frames', 'frame', now, kind='animation')
			self.lastFrame = number
			self.seconds['animation'] += time.process_time() - start
		if series:
			self._ask(self.folder / 'penetration.pvd', 'series', now)
			self.next, self.lastSeries = int(run.time / self.every) + 1, run.time
		if due:
			self._picture(self.name(due[-1]), 'patternPicture', now)
			self.pictures = [t for t in self.pictures if t > run.time]
		if end:
			self._picture('pattern_end.png', 'patternPicture', now)
			self._picture('history.png', 'history', run.arrays(), run.scene.facts, run.impactEnergy)
			if self.animation: self._picture('penetration.gif', 'gif', kind='animation')
		self.look()

	def _still(self, run):
		text = '%5.1f µs' % (1e6 * run.time)
		if run.record['time']:
			text += '     rod, tail %4.0f m/s, mean %4.0f m/s' % (run.last['tailVelocity'], run.last['allVelocity'])
		return still(run.scene, run.time, text)

	def _picture(self, name, method, *args, kind=None):
		self._ask(self.folder / name, method, str(self.folder / name), *args, kind=kind)

	def _ask(self, path, method, *args, kind=None):
		self.asked.append((path, self.beside.call(method, *args), kind))

	def look(self, wait=False):
		"""Takes in what has been made, or could not be; wait: until all has."""
		while self.asked and (wait or self.asked[0][1].done()):
			path, future, kind = self.asked.pop(0)
			self.attempt(path, self._outcome, future, kind)

	def _outcome(self, future, kind):
		try:
			seconds = future.result()
		except OSError:
			raise
		except Exception as e:  # costs the file, not the run
			raise OSError(errno.EIO, '%s: %s' % (type(e).__name__, e)) from e
		if kind: self.seconds[kind] += seconds
