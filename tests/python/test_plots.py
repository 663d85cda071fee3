# SPDX-License-Identifier: GPL-2.0-or-later
"""Pictures: true sizes and colours of discs and cells, the range of the colour bar, the Pareto front."""
import numpy as np
import pytest
from matplotlib import image
from matplotlib import pyplot as plt

from yade_mca import plots


def pixels(path):
	return image.imread(path)[..., :3]


def test_discs_have_their_true_size(tmp_path):
	figure, axes = plt.subplots(figsize=(4, 4), dpi=100)
	axes.set_position([0, 0, 1, 1])
	axes.set(xlim=(0, 4), ylim=(0, 4))
	axes.axis('off')
	plots.drawAutomata(axes, [(1e-3, 1e-3), (3e-3, 3e-3)], [0.5e-3, 0.25e-3], [0., 1.], cmap='gray', vmin=0, vmax=2)
	figure.savefig(tmp_path / 'd.png', dpi=100)
	plt.close(figure)
	p = pixels(tmp_path / 'd.png')[..., 0]
	assert np.sum(p < 0.01) == pytest.approx(np.pi * 50**2, rel=0.03)  # black disc of radius 0.5 mm at 100 pixels per mm
	assert np.sum(abs(p - 0.5) < 0.02) == pytest.approx(np.pi * 25**2, rel=0.05)


def test_quads_of_a_block():
	x, y = np.meshgrid([0., 1., 3.], [0., 2.], indexing='ij')
	q = plots.gridQuads(np.stack((x, y), axis=-1))
	assert q.shape == (2, 4, 2) and q[1].tolist() == [[1, 0], [3, 0], [3, 2], [1, 2]]


@pytest.mark.parametrize('n, blocks', [(50, 0), (0, 1), (50, 1)])
def test_picture_with_and_without_grid(tmp_path, n, blocks):
	rng = np.random.default_rng(1)
	x, y = np.meshgrid(np.linspace(1e-2, 2e-2, 5), np.linspace(0, 1e-2, 4), indexing='ij')
	block = (np.stack((x, y), axis=-1), rng.normal(size=(4, 3)))
	path = plots.automataPicture(tmp_path / 'p.png', 1e-2 * rng.random((n, 2)), 5e-4, rng.normal(size=n) * 1e9, 'pressure', 'Pa', blocks=[block] * blocks)
	assert pixels(path).std() > 0.05 and [f.name for f in tmp_path.iterdir()] == ['p.png']


def test_constant_and_infinite_values_do_not_break_the_colour_bar(tmp_path):
	plots.automataPicture(tmp_path / 'p.png', np.eye(2), 0.1, [3., 3.], 'x')
	plots.automataPicture(tmp_path / 'q.png', np.eye(2), 0.1, [np.nan, np.inf], 'x')


@pytest.mark.parametrize('values, blocks', [([1.], ()), ([1., 2.], [(np.zeros((3, 3, 2)), np.zeros((3, 3)))])])
def test_shapes_that_do_not_fit(tmp_path, values, blocks):
	with pytest.raises(ValueError, match='shape'):
		plots.automataPicture(tmp_path / 'p.png', np.eye(2), 0.1, values, 'x', blocks=blocks)


def test_pareto_front():
	cost, error = np.array([1, 2, 4, 8, 3, 1.]), np.array([.1, .05, .04, .06, .2, .3])
	assert plots.paretoFront(cost, error).tolist() == [0, 1, 2]


def test_curves(tmp_path):
	t = np.linspace(0, 8e-5, 20)
	for path in (plots.history(tmp_path / 'h.png', t, [('speed', 'm/s', {'tail': t, 'mean': 2 * t}), ('energy', 'J/m', {'kinetic': t})], marks=[4e-5]),
	             plots.convergence(tmp_path / 'c.pdf', [2, 1, .5], {'a': [.1, .05, np.nan], 'b': [0, .05, .01]}),
	             plots.pareto(tmp_path / 'p.svg', [1, 2, 4], [.1, .05, .04], 'abc', groups='xxy')):
		assert (tmp_path / path).stat().st_size > 2000


def test_pointsInSpaceWithTheirImages(tmp_path):
	x, v = plots.mirrored(np.array([(1., 2., 3.)]), np.array([5.]), 'xz')
	assert sorted(map(tuple, x.tolist())) == [(-1, 2, -3), (-1, 2, 3), (1, 2, -3), (1, 2, 3)] and v.tolist() == [5.] * 4
	points = np.random.default_rng(1).random((100, 3)) * 1e-2
	path = plots.spacePicture(tmp_path / 's.png', points, 1e3 * points[:, 1], 'speed', 'm/s', mirror='xz')
	assert pixels(path).std() > 0.05
	plots.spacePicture(tmp_path / 't.png', points[:1], [1.], 'one')
	for wrong in (dict(positions=points[:, :2]), dict(values=[1.]), dict(mirror='q'), dict(up='up')):
		with pytest.raises(ValueError): plots.spacePicture(**dict(dict(path=tmp_path / 'u.png', positions=points, values=points[:, 0], label='x'), **wrong))
