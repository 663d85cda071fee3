# SPDX-License-Identifier: GPL-2.0-or-later
"""Files of a penetration run from plain arrays: pictures of the pattern, the history plot, the animation, ParaView files, checkpoints.

Files runs in a process beside the run: there is no YADE here.
"""
import time
from pathlib import Path

from . import checkpoint, plots, vtk_output
from .frames import Frames, frameNumber, writeGif

__all__ = ['Files', 'Pattern', 'historyPicture', 'writeParaview']

STRAIN = dict(label='plastic strain', unit='', vmin=0., vmax=1.5, cmap='inferno')
PRESSURE = dict(label='pressure', unit='Pa', vmin=-6e9, vmax=6e9, cmap='RdBu_r')


def writeParaview(still, folder, name):
	"""Writes automata, grid blocks and interface of an impact_output.Still; returns {part number: path} for a Collection."""
	folder = Path(folder)
	a = still.space or dict(positions=still.positions, fields=still.fields, radius=still.radius)
	files = {0: vtk_output.writeAutomata(folder / ('automata_%s.vtp' % name), a['positions'], a['fields'], a['radius'], still.time)}
	for k, (block, (nodes, cells, velocities)) in enumerate(sorted(still.grids.items())):
		files[1 + k] = vtk_output.writeGrid(folder / ('grid_%s_%s.vts' % (block, name)), nodes, cells, velocities, still.time)
	for k, row in enumerate(still.rows):
		if len(row):
			f = {what: still.fields[what][row] for what in ('velocity [m/s]', 'pressure [Pa]')}
			files[10 + k] = vtk_output.writeInterface(folder / ('interface_%d_%s.vtp' % (k, name)), still.positions[row], f, still.time)
	return files


class Pattern:
	"""Plastic strain and pressure side by side; the outline of the bodies at the start as a line, the mesh of the grid drawn.

	One figure for all pictures of a run: its layout is found once.
	"""

	def __init__(self):
		self.figure = None

	def _begin(self, still):
		"""Figure and axes for the view of `still`."""
		x0, y0, x1, y1 = still.bounds
		size = (8.4, 3.9 * (y1 - y0) / (x1 - x0) + 1.2)
		self.figure, self.axes = plots.plt.subplots(1, 2, sharey=True, figsize=size, layout='constrained')
		for ax, what in zip(self.axes, (STRAIN, PRESSURE)):
			ax.grid(False)
			for y in (0., -1e3 * still.facts['thickness']):
				ax.axhline(y, color='0.6', lw=0.5, ls=':', zorder=0)
			ax.set(xlim=(1e3 * x0, 1e3 * x1), ylim=(1e3 * y0, 1e3 * y1), aspect='equal', xlabel='x [mm]')
			_, unit, style = self._style(what)
			self.figure.colorbar(plots.scale(**style), ax=ax, label='%s [%s]' % (what['label'], unit) if unit else what['label'], location='bottom', shrink=0.8,
			                     aspect=30, pad=0.01, extend='max' if what['vmin'] == 0 else 'both')
		self.axes[0].set_ylabel('y [mm]')
		self.title, self.drawn = self.figure.suptitle(' ', fontsize=9), []

	@staticmethod
	def _style(what):
		factor, unit = plots.SCALES.get(what['unit'], (1., what['unit']))
		return factor, unit, dict(cmap=what['cmap'], vmin=factor * what['vmin'], vmax=factor * what['vmax'])

	def write(self, path, still, title=''):
		"""Draws the moment; returns the path."""
		x0, y0, x1, y1 = still.bounds
		p = still.positions
		near = (p[:, 0] > x0 - 0.01) & (p[:, 0] < x1 + 0.01) & (p[:, 1] > y0 - 0.01) & (p[:, 1] < y1 + 0.01)
		with plots.plt.rc_context(plots.STYLE):
			first = self.figure is None
			if first: self._begin(still)
			for artist in self.drawn: artist.remove()
			self.drawn = []
			for ax, what, name in zip(self.axes, (STRAIN, PRESSURE), ('plasticStrain', 'pressure [Pa]')):
				factor, _, style = self._style(what)
				for nodes, cells, _ in still.grids.values():
					self.drawn.append(plots.drawGrid(ax, nodes, factor * cells[name], **style))
					self.drawn[-1].set_edgecolor('0.55')
				self.drawn.append(plots.drawAutomata(ax, p[near], still.radius[near], factor * still.fields[name][near], **style))
			self.title.set_text(title or '%.1f µs' % (1e6 * still.time))
			path = plots.saveFixed(self.figure, path)
			if first: self.figure.set_layout_engine('none')
		return path

	def close(self):
		if self.figure is not None: plots.plt.close(self.figure)
		self.figure = None


def historyPicture(path, record, facts, impactEnergy, title=''):
	"""Velocities, losses and energies against time. record: {name: array} of impact.COLUMNS; impactEnergy [J/m]."""
	r, e0 = record, impactEnergy
	panels = [
	        ('velocity', 'm/s', {'tail': r['tailVelocity'], 'all rod material': r['allVelocity']}),
	        ('loss', '', {'dl/l0 by mass': r['lengthLoss'], 'dl/l0 as length': r['lengthLossGeometric'], 'dU/U0 of the tail': r['velocityLossTail'], 'dU/U0 of all': r['velocityLossAll']}),
	        ('energy', 'J' if facts.get('dimension') == 3 else 'J/m', dict({'sum': r['total'], 'kinetic': r['kinetic'], 'plastic work': r['plastic'], 'stored': r['stored'], 'viscous': r['viscous'], 'friction': r['friction']},
	                               **({'grid, internal': r['grid']} if facts['mode'] == 'coupled' else {}))),
	        ('sum / impact energy - 1', '%', {'independent sum': 100 * (r['total'] - r['total'][0]) / e0}),
	]
	mark = r['time'][r['clearance'] >= 0.5 * facts['rodDiameter']][:1]
	return plots.history(path, r['time'], panels, title, marks=mark)


class Files:
	"""Writes the files of one run into its folder, each when it is told to. Raises OSError for what cannot be written."""

	def __init__(self, folder):
		"""folder: exists; nothing is touched yet."""
		self.folder, self.pattern = Path(folder), Pattern()
		self.paraview = self.folder / 'paraview'

	def begin(self, bounds, interval, resumeAt, animation):
		"""bounds: of all pictures (x0, y0, x1, y1) [m]; interval: least time between frames [s]; resumeAt: time of the checkpoint from which a run goes on [s].

		Returns the time of the last ParaView files, or None, and in which interval the last frame lies, or -1.
		"""
		self.paraview.mkdir(exist_ok=True)
		self.collection = vtk_output.Collection(self.folder / 'penetration.pvd', keep=resumeAt is not None)
		if resumeAt is not None:
			for f in [*(f for kind in ('png', 'gif', 'html', 'pvd', 'json') for f in self.folder.glob('.*.%s.*' % kind)), *self.paraview.glob('.*.part')]:
				f.unlink()  # what a killed process has left unfinished
			self.collection.truncate(resumeAt * (1 + 1e-12) + 1e-18)
		self.frames = Frames(self.folder / 'frames', bounds, interval, resumeAt) if animation else None
		entries = self.collection.entries
		frame = frameNumber(max(self.frames.files), interval) if animation and self.frames.files else -1
		return entries[-1][0] if entries else None, frame

	def series(self, still):
		"""ParaView files of a moment, and the list of all; nothing when they are there."""
		if self.collection.entries and self.collection.entries[-1][0] >= still.time: return
		self.collection.add(still.time, writeParaview(still, self.paraview, '%06d' % round(1e9 * still.time)))

	def patternPicture(self, path, still):
		self.pattern.write(path, still)

	def frame(self, still):
		"""A frame of the animation where one is due. Returns the processor time [s]."""
		start = time.process_time()
		self.frames.update(still)
		return time.process_time() - start

	def gif(self, path):
		"""The animation. Returns the processor time [s]."""
		start = time.process_time()
		images = self.frames.images()
		if images: writeGif(path, images)
		return time.process_time() - start

	def history(self, path, *what):
		historyPicture(path, *what)

	def checkpoint(self, path, head, parts):
		"""After all that was told before: whoever goes on from it finds the files of the time before."""
		checkpoint.store(path, head, parts)
