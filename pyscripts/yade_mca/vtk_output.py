# SPDX-License-Identifier: GPL-2.0-or-later
"""ParaView files from numpy arrays: automata (.vtp), grid blocks (.vts), interface (.vtp), and their series (.pvd).

Binary, appended, compressed XML files of VTK; each appears whole or not at all. Points are (x, y, 0) in [m]. Fields are given as
{name: array}, one entry per automaton, cell or node, scalar (N,) or with components (N, k); two components become (x, y, 0). Put the
unit into the name, as in 'pressure [Pa]'.
"""
import errno
import os
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from .tasks.report import writeAtomically

__all__ = ['Collection', 'writeAutomata', 'writeGrid', 'writeInterface']


def _vtk():
	"""The parts of VTK in use; raises ImportError with the remedy."""
	try:
		from vtkmodules.util import numpy_support
		from vtkmodules import vtkCommonCore, vtkCommonDataModel, vtkIOXML
	except ImportError as e:
		raise ImportError('VTK output needs the package python3-vtk9 of /usr/bin/python3: apt install python3-vtk9 (%s)' % e) from e
	return numpy_support.numpy_to_vtk, numpy_support.numpy_to_vtkIdTypeArray, vtkCommonCore, vtkCommonDataModel, vtkIOXML


def _array(values, count, name):
	"""Values as VTK takes them. Raises ValueError when there is not one row per entry."""
	a = np.asarray(values)
	if a.ndim == 0 or a.shape[0] != count or a.ndim > 2:
		raise ValueError("field '%s' has shape %s, expected (%d,) or (%d, k)" % (name, a.shape, count, count))
	if a.dtype == bool:
		a = a.astype(np.uint8)
	if a.ndim == 2 and a.shape[1] == 2:
		a = np.concatenate((a, np.zeros((count, 1))), axis=1)
	return np.ascontiguousarray(a)


def _points(positions):
	p = np.asarray(positions, float)
	if p.ndim != 2 or p.shape[1] not in (2, 3):
		raise ValueError('positions must have shape (N, 2) or (N, 3); got %s' % (p.shape,))
	toVtk, _, core, _, _ = _vtk()
	points = core.vtkPoints()
	points.SetDataTypeToDouble()
	points.SetData(toVtk(_array(p, len(p), 'positions'), deep=True))
	return points, len(p)


def _fields(data, fields, count):
	toVtk = _vtk()[0]
	for name, values in (fields or {}).items():
		v = toVtk(_array(values, count, name), deep=True)
		v.SetName(name)
		data.AddArray(v)


def _write(writer, dataset, path, time):
	"""Writes `dataset` to `path`, whole or not at all, as writeAtomically does; raises OSError when VTK could not write it all."""
	path = str(path)
	if time is not None:
		toVtk = _vtk()[0]
		t = toVtk(np.array([float(time)]), deep=True)
		t.SetName('TimeValue')
		dataset.GetFieldData().AddArray(t)

	def fill(name):
		writer.SetFileName(name)
		writer.SetInputData(dataset)
		writer.SetDataModeToAppended()
		writer.EncodeAppendedDataOff()
		if not writer.Write() or writer.GetErrorCode():
			raise OSError(errno.EIO, 'VTK error %d (is the disk full?)' % writer.GetErrorCode())

	writeAtomically(path, fill)
	return path


def _polyData(positions, cells, kind):
	"""vtkPolyData of points joined in `cells` (M, k) int as 'verts' or 'lines'."""
	_, toIds, _, model, _ = _vtk()
	points, count = _points(positions)
	cells = np.ascontiguousarray(cells, dtype=np.int64)
	if len(cells) and (cells.min() < 0 or cells.max() >= count):
		raise ValueError('cells name points outside 0 ... %d' % (count - 1))
	array = model.vtkCellArray()
	array.SetData(toIds(np.arange(0, cells.size + 1, max(cells.shape[1], 1), dtype=np.int64), deep=True), toIds(cells.ravel(), deep=True))
	data = model.vtkPolyData()
	data.SetPoints(points)
	(data.SetVerts if kind == 'verts' else data.SetLines)(array)
	return data, count


def writeAutomata(path, positions, fields=None, radius=None, time=None):
	"""Automata as points. positions (N, 2) or (N, 3) [m], fields one entry per automaton, radius (N,) or scalar [m] for glyphs; time [s]."""
	_, _, _, _, io = _vtk()
	count = len(positions)
	data, _ = _polyData(positions, np.arange(count)[:, None], 'verts')
	if radius is not None:
		fields = dict(fields or {}, **{'radius [m]': np.broadcast_to(np.asarray(radius, float), (count,))})
	_fields(data.GetPointData(), fields, count)
	return _write(io.vtkXMLPolyDataWriter(), data, path, time)


def writeGrid(path, nodes, cellFields=None, nodeFields=None, time=None):
	"""One structured block. nodes (ni, nj, 2) [m]; cellFields (ni-1, nj-1[, k]); nodeFields (ni, nj[, k]); time [s]."""
	_, _, _, model, io = _vtk()
	n = np.asarray(nodes, float)
	if n.ndim != 3 or min(n.shape[:2]) < 2 or n.shape[2] not in (2, 3):
		raise ValueError('nodes must have shape (ni, nj, 2) with ni, nj at least 2; got %s' % (n.shape,))
	ni, nj = n.shape[:2]
	data = model.vtkStructuredGrid()
	data.SetDimensions(ni, nj, 1)
	data.SetPoints(_points(n.transpose(1, 0, 2).reshape(ni * nj, -1))[0])
	_fields(data.GetCellData(), {k: _inOrder(v, ni - 1, nj - 1, k) for k, v in (cellFields or {}).items()}, (ni - 1) * (nj - 1))
	_fields(data.GetPointData(), {k: _inOrder(v, ni, nj, k) for k, v in (nodeFields or {}).items()}, ni * nj)
	return _write(io.vtkXMLStructuredGridWriter(), data, path, time)


def _inOrder(values, rows, cols, name):
	"""(rows, cols[, k]) in VTK's order, the first index running fastest."""
	a = np.asarray(values)
	if a.shape[:2] != (rows, cols):
		raise ValueError("field '%s' has shape %s, expected (%d, %d)" % (name, a.shape, rows, cols))
	return np.swapaxes(a, 0, 1).reshape(rows * cols, *a.shape[2:])


def writeInterface(path, points, fields=None, time=None):
	"""An interface as one open line through points (N, 2) [m] in their order, with fields at the points; time [s]."""
	_, _, _, _, io = _vtk()
	index = np.arange(len(points))
	data, count = _polyData(points, np.stack((index[:-1], index[1:]), axis=1), 'lines')
	_fields(data.GetPointData(), fields, count)
	return _write(io.vtkXMLPolyDataWriter(), data, path, time)


class Collection:
	"""A series in time: a .pvd file that lists which files belong to which time. Rewritten, whole, after each addition.

	A run that is restarted opens the same file again: entries later than its time are forgotten (`truncate`).
	"""

	def __init__(self, path, keep=False):
		"""path of the .pvd; keep=True takes over the entries it has already."""
		self.path, self.entries = Path(path), []
		if keep and self.path.exists():
			import xml.etree.ElementTree as tree
			self.entries = [(float(d.get('timestep')), int(d.get('part')), d.get('file')) for d in tree.parse(self.path).getroot().iter('DataSet')]

	def truncate(self, time):
		"""Forgets what lies at or after `time` [s]."""
		self.entries = [e for e in self.entries if e[0] < time]

	def add(self, time, files):
		"""files: {part number: path} or a list of paths, written at `time` [s]."""
		items = files.items() if isinstance(files, dict) else enumerate(files)
		self.entries += [(float(time), int(part), os.path.relpath(f, self.path.parent)) for part, f in items]
		self.write()

	def write(self):
		lines = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">', ' <Collection>']
		lines += ['  <DataSet timestep="%.17g" part="%d" file=%s/>' % (t, part, quoteattr(f)) for t, part, f in self.entries]
		writeAtomically(str(self.path), '\n'.join(lines + [' </Collection>', '</VTKFile>', '']))
