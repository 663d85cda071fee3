# SPDX-License-Identifier: GPL-2.0-or-later
"""ParaView files hold what was given, appear whole, and the series names them."""
import os
import xml.etree.ElementTree as tree

import numpy as np
import pytest

vtk = pytest.importorskip('vtkmodules.vtkIOXML')
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402

from yade_mca import vtk_output  # noqa: E402


def read(path, kind):
	r = getattr(vtk, 'vtkXML%sReader' % kind)()
	r.SetFileName(str(path))
	r.Update()
	return r.GetOutput()


def array(data, name):
	return vtk_to_numpy(data.GetArray(name))


def test_automata(tmp_path):
	rng = np.random.default_rng(1)
	p, pressure, v, linked = rng.random((1000, 2)), rng.normal(size=1000), rng.normal(size=(1000, 2)), rng.random(1000) > 0.5
	d = read(vtk_output.writeAutomata(tmp_path / 'a.vtp', p, {'pressure [Pa]': pressure, 'velocity [m/s]': v, 'linked': linked}, radius=0.1, time=2e-5), 'PolyData')
	assert d.GetNumberOfVerts() == 1000
	assert np.array_equal(vtk_to_numpy(d.GetPoints().GetData())[:, :2], p)  # double precision, not a bit lost
	f = d.GetPointData()
	assert np.array_equal(array(f, 'pressure [Pa]'), pressure) and np.array_equal(array(f, 'velocity [m/s]')[:, :2], v)
	assert np.array_equal(array(f, 'linked'), linked) and (array(f, 'radius [m]') == 0.1).all()
	assert array(d.GetFieldData(), 'TimeValue')[0] == 2e-5


def test_grid_cells_keep_their_values(tmp_path):
	x, y = np.meshgrid(np.linspace(0, 1, 6)**2, np.linspace(0, 2, 4), indexing='ij')
	nodes = np.stack((x, y), axis=-1)
	middle = 0.25 * (nodes[1:, 1:] + nodes[:-1, 1:] + nodes[1:, :-1] + nodes[:-1, :-1])
	d = read(vtk_output.writeGrid(tmp_path / 'g.vts', nodes, {'middle': middle, 'x': middle[..., 0]}, {'y': y}), 'StructuredGrid')
	assert d.GetNumberOfCells() == 15
	for k in range(15):
		b = d.GetCell(k).GetBounds()
		assert array(d.GetCellData(), 'middle')[k][:2] == pytest.approx([(b[0] + b[1]) / 2, (b[2] + b[3]) / 2])
	assert np.array_equal(array(d.GetPointData(), 'y'), vtk_to_numpy(d.GetPoints().GetData())[:, 1])


def test_interface_and_series(tmp_path):
	points = np.stack((np.zeros(5), np.arange(5.)), axis=1)
	series = vtk_output.Collection(tmp_path / 'run.pvd')
	for k in range(3):
		series.add(1e-6 * k, [vtk_output.writeInterface(tmp_path / ('i%d.vtp' % k), points, {'slip': np.arange(5.)}, time=1e-6 * k)])
	assert read(tmp_path / 'i1.vtp', 'PolyData').GetNumberOfLines() == 4
	again = vtk_output.Collection(tmp_path / 'run.pvd', keep=True)
	assert again.entries == [(1e-6 * k, 0, 'i%d.vtp' % k) for k in range(3)]
	again.truncate(2e-6)
	again.add(2e-6, {1: tmp_path / 'b & c.vtp'})
	listed = [(d.get('timestep'), d.get('part'), d.get('file')) for d in tree.parse(tmp_path / 'run.pvd').getroot().iter('DataSet')]
	assert len(listed) == 3 and listed[-1][1:] == ('1', 'b & c.vtp') and float(listed[1][0]) == 1e-6


def test_empty_scene(tmp_path):
	assert read(vtk_output.writeAutomata(tmp_path / 'a.vtp', np.zeros((0, 2)), {'p': np.zeros(0)}), 'PolyData').GetNumberOfPoints() == 0


def test_nothing_is_left_behind_when_writing_fails(tmp_path, monkeypatch):
	with pytest.raises(ValueError, match="field 'p'"):
		vtk_output.writeAutomata(tmp_path / 'a.vtp', np.zeros((3, 2)), {'p': np.zeros(2)})
	with pytest.raises(ValueError, match='nodes'):
		vtk_output.writeGrid(tmp_path / 'g.vts', np.zeros((3, 2)))
	monkeypatch.setattr(os, 'replace', lambda a, b: (_ for _ in ()).throw(OSError(28, 'No space left on device')))
	with pytest.raises(OSError):
		vtk_output.writeAutomata(tmp_path / 'a.vtp', np.zeros((3, 2)))
	assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not os.path.exists('/dev/full'), reason='no /dev/full')
def test_full_disk_is_an_error(tmp_path, monkeypatch):
	from yade_mca.tasks import report
	monkeypatch.setattr(report.tempfile, 'mkstemp', lambda suffix, prefix, dir: (os.open('/dev/full', os.O_WRONLY), str(tmp_path / 'full')))
	os.symlink('/dev/full', tmp_path / 'full')
	with pytest.raises(OSError, match='disk full'):
		vtk_output.writeAutomata(tmp_path / 'a.vtp', np.random.default_rng(0).random((20000, 2)))
	assert not (tmp_path / 'a.vtp').exists()
