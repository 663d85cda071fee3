# SPDX-License-Identifier: GPL-2.0-or-later
"""Files of a penetration run: pictures of the pattern, the history plot, the animation, ParaView files. Needs no more of YADE than the scene's arrays."""
import time
from pathlib import Path

import numpy as np

from . import plots, vtk_output
from .tasks.attempts import Attempts

__all__ = ['Output', 'historyPicture', 'patternPicture', 'writeParaview']

STRAIN = dict(label='plastic strain', unit='', vmin=0., vmax=1.5, cmap='inferno')
PRESSURE = dict(label='pressure', unit='Pa', vmin=-6e9, vmax=6e9, cmap='RdBu_r')


def automataFields(s):
	"""(positions (N, 2) [m], radius (N,) [m], fields) of all automata; names of the fields carry their units."""
	f = s.automata.fields(['ids', 'x', 'y', 'vx', 'vy', 'diameter', 'pressure', 'equivalentStress', 'plasticStrain', 'temperature', 'links'])
	fields = {'velocity [m/s]': np.stack((f['vx'], f['vy']), axis=1), 'pressure [Pa]': f['pressure'], 'equivalentStress [Pa]': f['equivalentStress'],
	          'plasticStrain': f['plasticStrain'], 'temperature [K]': f['temperature'], 'links': f['links'], 'rod': np.isin(f['ids'], s.ids['rod']).astype(np.uint8)}
	return np.stack((f['x'], f['y']), axis=1), 0.5 * f['diameter'], fields


def gridFields(s, block):
	"""(nodes (rows, columns, 2) [m], cell fields, node fields) of a grid block."""
	v = lambda name: np.array(s.grid.view(block, name))
	nodes = np.stack((v('x'), v('y')), axis=-1)
	cells = {'pressure [Pa]': v('pressure'), 'plasticStrain': v('plasticStrain')}
	cells['equivalentStress [Pa]'] = np.sqrt(3 * (v('sxx')**2 + v('sxx') * v('syy') + v('syy')**2 + v('sxy')**2))
	return nodes, cells, {'velocity [m/s]': np.stack((v('vx'), v('vy')), axis=-1)}


def writeParaview(s, folder, name, time):
	"""Writes automata, grid blocks and interface; returns {part number: path} for a Collection."""
	folder = Path(folder)
	positions, radius, fields = automataFields(s)
	files = {0: vtk_output.writeAutomata(folder / ('automata_%s.vtp' % name), positions, fields, radius, time)}
	for k, (block, number) in enumerate(sorted(s.blocks.items())):
		nodes, cells, velocities = gridFields(s, number)
		files[1 + k] = vtk_output.writeGrid(folder / ('grid_%s_%s.vts' % (block, name)), nodes, cells, velocities, time)
	for k, c in enumerate(s.couplers):
		row = np.searchsorted(s.automata.ids, np.array(c.rowIds))
		if len(row):
			f = {'velocity [m/s]': fields['velocity [m/s]'][row], 'pressure [Pa]': fields['pressure [Pa]'][row]}
			files[10 + k] = vtk_output.writeInterface(folder / ('interface_%d_%s.vtp' % (k, name)), positions[row], f, time)
	return files


def bounds(s):
	"""What all pictures of a run show (x0, y0, x1, y1) [m]: the plate, the rod at the start and as much below the plate."""
	f = s.facts
	half = 0.5 * f.get('plateWidth', f['automataWidth']) + 2 * f['spacing']
	half = max(min(half, 0.6 * f['rodLength']), abs(f['direction'][0]) * f['rodLength'] + 2 * f['rodDiameter'])  # an oblique rod leans over
	return (-half, -f['thickness'] - 0.85 * f['rodLength'], half, 1.02 * f['rodLength'])


def patternPicture(path, s, time, title=''):
	"""Plastic strain and pressure side by side; the outline of the bodies at the start as a line, the mesh of the grid drawn."""
	positions, radius, fields = automataFields(s)
	grids = [gridFields(s, k)[:2] for k in s.blocks.values()]
	x0, y0, x1, y1 = bounds(s)
	near = (positions[:, 0] > x0 - 0.01) & (positions[:, 0] < x1 + 0.01) & (positions[:, 1] > y0 - 0.01) & (positions[:, 1] < y1 + 0.01)
	plt = plots.plt
	with plt.rc_context(plots.STYLE):
		figure, axes = plt.subplots(1, 2, sharey=True, figsize=(8.4, 3.9 * (y1 - y0) / (x1 - x0) + 1.2), layout='constrained')
		for ax, what, name in ((axes[0], STRAIN, 'plasticStrain'), (axes[1], PRESSURE, 'pressure [Pa]')):
			factor, unit = plots.SCALES.get(what['unit'], (1., what['unit']))
			style = dict(cmap=what['cmap'], vmin=factor * what['vmin'], vmax=factor * what['vmax'])
			for nodes, cells in grids:
				plots.drawGrid(ax, nodes, factor * cells[name], **style).set_edgecolor('0.55')
			ax.grid(False)
			drawn = plots.drawAutomata(ax, positions[near], radius[near], factor * fields[name][near], **style)
			f = s.facts
			for y in (0., -1e3 * f['thickness']):
				ax.axhline(y, color='0.6', lw=0.5, ls=':', zorder=0)
			ax.set(xlim=(1e3 * x0, 1e3 * x1), ylim=(1e3 * y0, 1e3 * y1), aspect='equal', xlabel='x [mm]')
			figure.colorbar(drawn, ax=ax, label='%s [%s]' % (what['label'], unit) if unit else what['label'], location='bottom', shrink=0.8,
			                aspect=30, pad=0.01, extend='max' if what['vmin'] == 0 else 'both')
		axes[0].set_ylabel('y [mm]')
		figure.suptitle(title or '%.1f µs' % (1e6 * time), fontsize=9)
		return _saveFixed(figure, path)


def _saveFixed(figure, path):
	"""As plots.save, but all pictures of a series keep one size."""
	import io
	data = io.BytesIO()
	figure.savefig(data, format='png')
	plots.plt.close(figure)
	plots.writeAtomically(str(path), data.getvalue())
	return str(path)


def historyPicture(path, run, title=''):
	"""Velocities, losses and energies against time."""
	r = run.arrays()
	e0 = run.impactEnergy
	panels = [
	        ('velocity', 'm/s', {'tail': r['tailVelocity'], 'all rod material': r['allVelocity']}),
	        ('loss', '', {'dl/l0 by mass': r['lengthLoss'], 'dl/l0 as length': r['lengthLossGeometric'], 'dU/U0 of the tail': r['velocityLossTail'], 'dU/U0 of all': r['velocityLossAll']}),
	        ('energy', 'J/m', dict({'sum': r['total'], 'kinetic': r['kinetic'], 'plastic work': r['plastic'], 'stored': r['stored'], 'viscous': r['viscous'], 'friction': r['friction']},
	                               **({'grid, internal': r['grid']} if run.scene.grid else {}))),
	        ('sum / impact energy - 1', '%', {'independent sum': 100 * (r['total'] - r['total'][0]) / e0}),
	]
	mark = r['time'][r['clearance'] >= 0.5 * run.scene.facts['rodDiameter']][:1]
	return plots.history(path, r['time'], panels, title, marks=mark)


class Output:
	"""Pictures at given times and at the end, frames of the animation and ParaView files at regular ones.

	A file that cannot be written does not end the run: it is named on the standard error and in `attempt.failures` ({path: why}).
	"""

	def __init__(self, folder, pictures=(0., 20e-6, 40e-6), every=5e-6, resumeAt=None, animation=True):
		"""folder exists. pictures: times [s]; every: interval of the ParaView files [s]; resumeAt: time of the checkpoint of a run that goes on [s]; animation: False for none."""
		self.folder, self.pictures, self.every, self.resumeAt = Path(folder), list(pictures), every, resumeAt
		self.paraview = self.folder / 'paraview'
		self.paraview.mkdir(exist_ok=True)
		self.collection = vtk_output.Collection(self.folder / 'penetration.pvd', keep=resumeAt is not None)
		self.attempt = Attempts('penetration')
		self.animation, self.frames = animation, None
		self.seconds = {'animation': 0.}  #: processor time by kind of file, what the computation pays
		self.next = 0
		if resumeAt is not None:
			for f in [*self.folder.glob('.*.png.*'), *self.folder.glob('.*.gif.*'), *self.folder.glob('.*.html.*'), *self.folder.glob('.*.pvd.*'), *self.folder.glob('.*.json.*'),
			          *self.paraview.glob('.*.part')]:
				f.unlink()  # what a killed process has left unfinished
			self.collection.truncate(resumeAt * (1 + 1e-12) + 1e-18)
			self.pictures = [t for t in self.pictures if t > resumeAt or not (self.folder / self.name(t)).exists()]
			self.next = int(resumeAt / every) + 1

	@staticmethod
	def name(t):
		return 'pattern_%02.0fus.png' % (1e6 * t)

	def update(self, run, end=False):
		"""To be called at the start and after each sample; writes what is due."""
		if (run.time >= self.next * self.every or end) and not (self.collection.entries and self.collection.entries[-1][0] >= run.time):
			self.attempt(self.collection.path, lambda: self.collection.add(run.time, writeParaview(run.scene, self.paraview, '%06d' % round(1e9 * run.time), run.time)))
			self.next = int(run.time / self.every) + 1
		due = [t for t in self.pictures if run.time >= t]
		if due:
			self._pattern(self.name(due[-1]), run)
			self.pictures = [t for t in self.pictures if t > run.time]
		if self.animation:
			start = time.process_time()
			self.attempt(self.folder / 'frames', self._frame, run)
			self.seconds['animation'] += time.process_time() - start
		if end:
			self._pattern('pattern_end.png', run)
			self.attempt(self.folder / 'history.png', historyPicture, self.folder / 'history.png', run)
			if self.frames and self.frames.files:
				start = time.process_time()
				self.attempt(self.folder / 'penetration.gif', self._gif)
				self.seconds['animation'] += time.process_time() - start

	def _pattern(self, name, run):
		self.attempt(self.folder / name, patternPicture, self.folder / name, run.scene, run.time)

	def _frame(self, run):
		if self.frames is None:
			from .frames import Frames
			f = run.scene.facts
			self.frames = Frames(self.folder / 'frames', bounds(run.scene), f['rodLength'] / f['speed'] / 52, self.resumeAt)  # some 55 in all: most runs end soon after the rod has flown its length
		self.frames.update(run)

	def _gif(self):
		from .frames import writeGif
		images = self.frames.images()
		if images: writeGif(self.folder / 'penetration.gif', images)
