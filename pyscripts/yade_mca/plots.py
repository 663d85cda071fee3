# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures: automata and grid coloured by a field, histories, convergence, time against error. numpy in, image files out (matplotlib, Agg).

Lengths come in metres and are drawn in millimetres. A field is given in SI with its unit; `scale` and the unit shown are chosen from SCALES.
Every function returns the path it wrote; files appear whole or not at all.
"""
import io
import math
import os

import matplotlib

matplotlib.use('Agg')
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.cm import ScalarMappable
from matplotlib.collections import EllipseCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.ticker import MaxNLocator, NullFormatter

from .tasks.report import writeAtomically

__all__ = ['automataPicture', 'convergence', 'crackHistory', 'drawAutomata', 'drawGrid', 'drawPareto', 'fragmentMasses', 'gridQuads', 'history', 'pareto', 'paretoFront', 'save', 'saveFixed', 'scale', 'spacePicture']

#: unit of the data -> (factor, unit shown)
SCALES = {'Pa': (1e-9, 'GPa'), 'm': (1e3, 'mm'), 's': (1e6, 'µs'), 'J/kg': (1e-3, 'kJ/kg'), 'J/m': (1e-3, 'kJ/m')}
STYLE = {'font.size': 9, 'axes.spines.top': False, 'axes.spines.right': False, 'legend.frameon': False, 'figure.dpi': 150, 'savefig.dpi': 150}


def shown(values, unit):
	"""(values, unit) as they are drawn."""
	factor, name = SCALES.get(unit, (1., unit))
	return np.asarray(values, float) * factor, name


def save(figure, path):
	"""Writes a figure by the suffix of `path` (png, pdf, svg), atomically, and closes it."""
	data = io.BytesIO()
	kind = os.path.splitext(str(path))[1].lstrip('.') or 'png'
	figure.savefig(data, format=kind, bbox_inches='tight')
	plt.close(figure)
	writeAtomically(str(path), data.getvalue())
	return str(path)


def saveFixed(figure, path):
	"""As save(), but as a PNG of the figure's own size, which all pictures of a series share; the figure stays open."""
	data = io.BytesIO()
	figure.savefig(data, format='png')
	writeAtomically(str(path), data.getvalue())
	return str(path)


def scale(cmap, vmin, vmax):
	"""What a colour bar is made of, without the data."""
	return ScalarMappable(Normalize(vmin, vmax), cmap)


def gridQuads(nodes):
	"""Corners (cells, 4, 2) of the cells of a structured block with nodes (ni, nj, 2); cell (i, j) is number i*(nj-1) + j."""
	n = np.asarray(nodes, float)[..., :2]
	return np.stack((n[:-1, :-1], n[1:, :-1], n[1:, 1:], n[:-1, 1:]), axis=2).reshape(-1, 4, 2)


def drawAutomata(axes, positions, radius, values, cmap='viridis', vmin=None, vmax=None):
	"""Discs of true size: positions (N, 2) [m], radius scalar or (N,) [m], values (N,). Returns the collection. Fast up to about 1e6."""
	p = 1e3 * np.asarray(positions, float)[:, :2]
	size = 2e3 * np.broadcast_to(np.asarray(radius, float), len(p))
	discs = EllipseCollection(size, size, np.zeros(len(p)), offsets=p, units='xy', transOffset=axes.transData, linewidths=0, cmap=cmap)
	discs.set_array(np.asarray(values, float))
	discs.set_clim(vmin, vmax)
	axes.add_collection(discs)
	return discs


def drawGrid(axes, nodes, values, cmap='viridis', vmin=None, vmax=None, lines=True):
	"""Cells of a block with nodes (ni, nj, 2) [m] coloured by values (ni-1, nj-1), and the mesh. Returns the collection."""
	cells = PolyCollection(1e3 * gridQuads(nodes), linewidths=0.25 if lines else 0, edgecolors='0.25' if lines else 'none', cmap=cmap)
	cells.set_array(np.asarray(values, float).ravel())
	cells.set_clim(vmin, vmax)
	axes.add_collection(cells)
	return cells


def _range(arrays, low, high):
	"""Colour range: what is given, else the smallest and largest finite value of all arrays."""
	every = np.concatenate([np.ravel(np.asarray(a, float)) for a in arrays]) if arrays else np.zeros(1)
	every = every[np.isfinite(every)]
	low = low if low is not None else every.min() if len(every) else 0.
	high = high if high is not None else every.max() if len(every) else 1.
	return low, high if high > low else low + (abs(low) or 1.) * 1e-12 + 1e-300


def automataPicture(path, positions, radius, values, label, unit='', blocks=(), title='', vmin=None, vmax=None, cmap='viridis', bounds=None, width=7.):
	"""Picture of automata and grid coloured by one field.

	positions (N, 2) [m], radius scalar or (N,) [m], values (N,) in `unit`
	blocks    sequence of (nodes (ni, nj, 2) [m], values (ni-1, nj-1)) of the grid, drawn with its mesh
	vmin, vmax  colour range in `unit`; default: the range of the data
	bounds    (xmin, ymin, xmax, ymax) [m] shown; default: everything
	width     of the picture in inches
	Raises ValueError where shapes do not fit.
	"""
	positions, values = np.asarray(positions, float).reshape(-1, np.shape(positions)[-1] if np.size(positions) else 2)[:, :2], np.asarray(values, float)
	if values.shape != (len(positions),):
		raise ValueError('values must have shape (%d,), one per automaton; got %s' % (len(positions), values.shape))
	for nodes, v in blocks:
		if np.shape(v) != tuple(n - 1 for n in np.shape(nodes)[:2]):
			raise ValueError('cell values of shape %s do not fit nodes of shape %s' % (np.shape(v), np.shape(nodes)))
	factor, name = SCALES.get(unit, (1., unit))
	limits = _range([values] * bool(len(values)) + [v for _, v in blocks], vmin, vmax)
	low, high = (factor * v for v in limits)
	if bounds is None:
		ends = [np.asarray(n, float)[..., :2].reshape(-1, 2) for n, _ in blocks]
		if len(positions):
			r = float(np.max(radius))
			ends += [positions - r, positions + r]
		every = np.concatenate(ends)
		bounds = (*every.min(axis=0), *every.max(axis=0))
	x0, y0, x1, y1 = (1e3 * b for b in bounds)
	with plt.rc_context(STYLE):
		figure, axes = plt.subplots(figsize=(width, min(max(width * (y1 - y0) / (x1 - x0), 0.3 * width), 2 * width) + 0.8))
		drawn = [drawGrid(axes, n, factor * np.asarray(v, float), cmap, low, high) for n, v in blocks]
		if len(positions):
			drawn.append(drawAutomata(axes, positions, radius, factor * values, cmap, low, high))
		axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect='equal', xlabel='x [mm]', ylabel='y [mm]', title=title)
		outside = 'both' if (vmin is not None and vmax is not None) else 'min' if vmin is not None else 'max' if vmax is not None else 'neither'
		figure.colorbar(drawn[-1], ax=axes, label='%s [%s]' % (label, name) if name else label, shrink=0.8, extend=outside)
		return save(figure, path)


def mirrored(positions, values, mirror):
	"""positions (N, 3) and values (N,) with their images at the planes across the axes named, e.g. 'xz', through 0."""
	for c in mirror:
		image = positions * np.where(np.arange(3) == 'xyz'.index(c), -1., 1.)
		positions, values = np.concatenate((positions, image)), np.concatenate((values, values))
	return positions, values


def spacePicture(path, positions, values, label, unit='', mirror='', up='y', size=2., view=(15., -60.), title='', vmin=None, vmax=None, cmap='viridis', width=6.):
	"""Points in space coloured by one field, in true proportions; for debris, of which one sees the outside.

	positions (N, 3) [m], values (N,) in `unit`; mirror: axes across which images are added, 'xz' of a quarter; up: the axis that is drawn upwards
	size      of the points [pt]; view: elevation and azimuth of the eye [degrees]; vmin, vmax: colour range in `unit`; width of the picture in inches
	Raises ValueError where shapes do not fit.
	"""
	positions, values = np.asarray(positions, float), np.asarray(values, float)
	if positions.ndim != 2 or positions.shape[1] != 3 or not len(positions): raise ValueError('positions must have shape (N, 3); got %s' % (positions.shape, ))
	if values.shape != (len(positions), ): raise ValueError('values must have shape (%d,), one per point; got %s' % (len(positions), values.shape))
	if not set(mirror) <= set('xyz') or up not in ('x', 'y', 'z'): raise ValueError('mirror and up name axes, x, y or z; got %r and %r' % (mirror, up))
	factor, name = SCALES.get(unit, (1., unit))
	low, high = (factor * v for v in _range([values], vmin, vmax))
	positions, values = mirrored(1e3 * positions, factor * values, mirror)
	order = [('xyz'.index(up) + k) % 3 for k in (1, 2, 0)]
	p = positions[:, order]
	with plt.rc_context(STYLE):
		figure = plt.figure(figsize=(width, width))
		axes = figure.add_subplot(projection='3d')
		drawn = axes.scatter(*p.T, c=values, s=size, cmap=cmap, vmin=low, vmax=high, linewidths=0, depthshade=False, rasterized=True)
		ends = np.stack((p.min(axis=0), p.max(axis=0)))
		axes.set(**{'%slim' % c: (a, b if b > a else a + 1) for c, (a, b) in zip('xyz', ends.T)})
		axes.set_box_aspect(np.maximum(np.ptp(ends, axis=0), 1e-3 * np.ptp(ends)), zoom=1.1)
		axes.set(**{'%slabel' % c: '%s [mm]' % 'xyz'[k] for c, k in zip('xyz', order)}, title=title)
		axes.view_init(*view)
		for axis in (axes.xaxis, axes.yaxis, axes.zaxis): axis.set_major_locator(MaxNLocator(5))
		figure.colorbar(drawn, ax=axes, label='%s [%s]' % (label, name) if name else label, shrink=0.6, pad=0.16)
		return save(figure, path)


def history(path, time, panels, title='', marks=()):
	"""Curves against time, one panel above the other.

	time (n,) [s]; panels: sequence of (label, unit, {name: values (n,)}); marks: times [s] drawn as thin lines.
	"""
	with plt.rc_context(STYLE):
		figure, axes = plt.subplots(len(panels), 1, sharex=True, figsize=(7, 1.9 * len(panels) + 0.6), squeeze=False)
		t, unit = shown(time, 's')
		for ax, (label, unitOfPanel, curves) in zip(axes[:, 0], panels):
			for name, values in curves.items():
				ax.plot(t, shown(values, unitOfPanel)[0], label=name, lw=1.2)
			u = shown(0, unitOfPanel)[1]
			ax.set_ylabel('%s [%s]' % (label, u) if u else label)
			for m in marks:
				ax.axvline(shown(m, 's')[0], color='0.7', lw=0.6)
			if len(curves) > 1:
				ax.legend(fontsize=8)
		axes[-1, 0].set_xlabel('t [%s]' % unit)
		axes[0, 0].set_title(title)
		figure.align_ylabels()
		return save(figure, path)


def crackHistory(path, broken, bins=18, title=''):
	"""Cracks over time and their directions: cumulative number of broken links by cause, and the rose of crack lines in the plane of x and y.

	path: of the picture. broken: cracks.history(engine), or a dict with its 'time' [s], 'cause' (names), 'nx', 'ny'. bins: of the rose, over 180 degrees.
	Raises ValueError when nothing has broken or bins are no whole number from 1 to 360.
	"""
	time, cause = np.asarray(broken['time'], float), np.asarray(broken['cause'])
	if not len(time): raise ValueError('no link has broken, so there is nothing to draw')
	if isinstance(bins, bool) or not isinstance(bins, (int, np.integer)) or not 1 <= bins <= 360: raise ValueError('bins must be a whole number from 1 to 360; got %r' % (bins, ))
	with plt.rc_context(STYLE):
		figure = plt.figure(figsize=(8, 3.4))
		left, right = figure.add_subplot(121), figure.add_subplot(122, projection='polar')
		shownTime, unit = shown(time, 's')
		for name in sorted(set(cause.tolist())):
			t = np.sort(shownTime[cause == name])
			left.step(np.r_[t, shownTime.max()], np.r_[1:len(t) + 1, len(t)], where='post', label='%s (%d)' % (name, len(t)))
		left.set(xlabel='t [%s]' % unit, ylabel='broken links', title=title)
		left.legend(fontsize=8)
		angle = (np.arctan2(broken['ny'], broken['nx']) + 0.5 * np.pi) % np.pi  # of the crack's line, across the normal
		counts, edges = np.histogram(angle, bins=int(bins), range=(0, np.pi))
		for turn in 0, np.pi:
			right.bar(edges[:-1] + turn, counts, width=np.pi / bins, align='edge', color='C0')
		right.set_yticklabels([])
		figure.tight_layout()
		return save(figure, path)


def fragmentMasses(path, found, title='', skip=1):
	"""Cumulative masses of fragments beside Mott and Grady-Kipp through their mean.

	path: of the picture. found: measure.Fragments, or {name: Fragments} for several in one picture. skip: heaviest fragments that are left out, as what is left of
	the bodies (whole number, 0 or more). Raises ValueError when nothing is left.
	"""
	from .measure import cumulative, gradyKipp, mott
	several = found if isinstance(found, dict) else {'': found}
	if isinstance(skip, bool) or not isinstance(skip, (int, np.integer)) or skip < 0: raise ValueError('skip must be a whole number of 0 or more; got %r' % (skip, ))
	with plt.rc_context(STYLE):
		figure, ax = plt.subplots(figsize=(5, 3.6))
		for q, (name, f) in enumerate(several.items()):
			mass = f.mass[skip:]
			if not len(mass): raise ValueError('skip = %d leaves no fragment of %d' % (skip, len(f.mass)))
			m, number = cumulative(mass)
			ax.step(m, number, where='pre', color='C%d' % q, label=(name + ': ' if name else '') + '%d fragments' % len(m))
			at = np.geomspace(m[0], m[-1], 100) if m[-1] > m[0] else m
			ax.plot(at, mott(at, len(m), m.mean()), '--', color='C%d' % q, lw=0.8, label='Mott' if not q else None)
			ax.plot(at, gradyKipp(at, len(m), m.mean()), ':', color='C%d' % q, lw=0.8, label='Grady-Kipp' if not q else None)
		ax.set(xscale='log', yscale='log', xlabel='mass [kg/m]' if f.position.shape[1] == 2 else 'mass [kg]', ylabel='fragments at least as heavy', title=title)
		ax.set_ylim(bottom=0.7)
		ax.legend(fontsize=8)
		figure.tight_layout()
		return save(figure, path)


def convergence(path, sizes, errors, xlabel='d [mm]', ylabel='error', orders=(1, 2), title=''):
	"""Errors against size, log-log, with lines of the given orders. sizes (n,); errors {name: (n,)}. Values that are 0 or nan are left out."""
	with plt.rc_context(STYLE):
		figure, ax = plt.subplots(figsize=(5, 4))
		h, largest = np.asarray(sizes, float), 0.
		for name, e in errors.items():
			e = np.asarray(e, float)
			use = np.isfinite(e) & (e > 0)
			ax.loglog(h[use], e[use], 'o-', ms=4, lw=1.2, label=name)
			largest = max(largest, e[use].max(initial=0.))
		for k in orders:
			ax.loglog(h, (largest or 1.) * (h / h.max())**k, color='0.6', lw=0.8, ls='--', zorder=0)
			ax.annotate('order %g' % k, (h.min(), (largest or 1.) * (h.min() / h.max())**k), fontsize=7, color='0.4')
		ax.set(xlabel=xlabel, ylabel=ylabel, title=title)
		ax.legend(fontsize=8)
		return save(figure, path)


def paretoFront(cost, error):
	"""Indices of the points that no other point beats in both, sorted by cost."""
	order = np.lexsort((error, cost))
	best, front = math.inf, []
	for i in order:
		if error[i] < best:
			best = error[i]
			front.append(int(i))
	return np.array(front, int)


def drawPareto(ax, cost, error, labels, groups=None, colours=None, hollow=None):
	"""Time against error, log-log, on the axes `ax`, with the front as a line and its points named; returns the front (indices).

	groups (n,) names, colours {group: colour}; hollow (n,) bool: points that are drawn hollow. The axes show whole decades.
	"""
	cost, error = np.asarray(cost, float), np.asarray(error, float)
	groups = list(groups) if groups is not None else [''] * len(cost)
	for k, g in enumerate(dict.fromkeys(groups)):
		at = [i for i, x in enumerate(groups) if x == g]
		color, empty = (colours or {}).get(g, 'C%d' % (k % 10)), [i for i in at if hollow is not None and hollow[i]]
		ax.loglog([cost[i] for i in at if i not in empty], [error[i] for i in at if i not in empty], 'o', ms=4, label=g or None, color=color)
		ax.loglog(cost[empty], error[empty], 'o', ms=4, mfc='none', mew=0.8, color=color)
	front = paretoFront(cost, error)
	ax.loglog(cost[front], error[front], '-', color='0.3', lw=1, zorder=0, label='Pareto front')
	for i in front:
		ax.annotate(labels[i], (cost[i], error[i]), fontsize=6, xytext=(3, 3), textcoords='offset points')
	for v, limit, axis in ((cost, ax.set_xlim, ax.xaxis), (error, ax.set_ylim, ax.yaxis)):
		v = np.log10(v[np.isfinite(v) & (v > 0)])
		limit(10**math.floor(v.min() - 0.05), 10**math.ceil(v.max() + 0.05))
		axis.set_minor_formatter(NullFormatter())
	return front


def drawOldPareto(ax, cost, error):
	"""Adds the front of an older result to axes that drawPareto() made, which grow to hold it: points and a dashed line in grey. cost, error (n,)."""
	cost, error = np.asarray(cost, float), np.asarray(error, float)
	front = paretoFront(cost, error)
	if not len(front): return
	ax.loglog(cost[front], error[front], 's--', ms=3, lw=0.8, color='0.65', zorder=0, label='front before')
	for v, (low, high), limit in ((cost[front], ax.get_xlim(), ax.set_xlim), (error[front], ax.get_ylim(), ax.set_ylim)):
		limit(min(low, 10**math.floor(math.log10(v.min()))), max(high, 10**math.ceil(math.log10(v.max()))))


def pareto(path, cost, error, labels, groups=None, xlabel='time [s]', ylabel='error', title=''):
	"""Time against error, log-log, with the Pareto front marked. cost, error (n,); labels n names; groups n names for colours or None."""
	with plt.rc_context(STYLE):
		figure, ax = plt.subplots(figsize=(6.5, 4.5))
		drawPareto(ax, cost, error, labels, groups)
		ax.set(xlabel=xlabel, ylabel=ylabel, title=title)
		ax.legend(fontsize=8)
		return save(figure, path)
