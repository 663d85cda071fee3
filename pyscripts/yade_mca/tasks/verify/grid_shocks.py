# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic-plastic piston and plate impact on the grid."""
import numpy as np

from ... import exact
from ..._yade import scene as omega
from .. import trials
from ..trials import crossing, material

#: name, set of constants, changes to it, speed of the piston [m/s]
PISTONS = [
        ('Al2024/up100', 'Al2024_T4', dict(density=2790., bulkSoundSpeed=5330., hugoniotSlope=1.34, gruneisen=2., shearModulus=28.6e9, yieldStress=0.26e9), 100.),
        ('Al2024/up400', 'Al2024_T4', dict(density=2785., bulkSoundSpeed=5328., hugoniotSlope=1.338, gruneisen=2., shearModulus=27.6e9, yieldStress=0.3e9), 400.),
        ('Al6061/up150', 'Al6061_T6', dict(density=2703., bulkSoundSpeed=5240., hugoniotSlope=1.4, gruneisen=1.97, shearModulus=27.6e9, yieldStress=0.29e9), 150.),
        ('Cu/up200', 'OFHC_Cu', dict(density=8930., bulkSoundSpeed=3940., hugoniotSlope=1.489, gruneisen=2.02, shearModulus=47.7e9, yieldStress=0.09e9), 200.),
        ('4340/up200', '4340', dict(density=7830., bulkSoundSpeed=4578., hugoniotSlope=1.33, gruneisen=1.67, shearModulus=80e9, yieldStress=0.792e9), 200.),
        ('WHA/up200', 'WHA_JC', dict(density=17600., bulkSoundSpeed=4030., hugoniotSlope=1.237, gruneisen=1.54, shearModulus=124e9, yieldStress=1.506e9), 200.),
]
#: name, flyer, target, speed [m/s], edge viscosity
IMPACTS = [('WHAonSteel', 'WHA_JC', '4340', 1520., False), ('CuCu400', 'OFHC_Cu', 'OFHC_Cu', 400., False), ('CuCu1000', 'OFHC_Cu', 'OFHC_Cu', 1000., False),
           ('Al2024', 'Al2024_T4', 'Al2024_T4', 800., False), ('4340', '4340', '4340', 1000., False), ('WHAonSteel/edge', 'WHA_JC', '4340', 1520., True)]
LENGTH = 0.05  #: [m]


def tube(cells, blocks, edge=False):
	"""A row of blocks, (material, from, to, cells) each, in which all moves along x."""
	run = trials.grid()
	e, h = run.grid, LENGTH / cells
	for m, a, b, n in blocks:
		e.addRectangle(m, np.linspace(a, b, n + 1), np.arange(3) * h, edgeViscosity=edge)
	for k in range(len(blocks)):
		e.symmetry(k, 'bottom')
		e.symmetry(k, 'top')
	return run


def middle(x, f, a, b):
	"""Median of f(x) over the middle part of [a, b]."""
	return float(np.median(f[(x > a + 0.3 * (b - a)) & (x < b - 0.3 * (b - a))]))


def piston(report, want, quick):
	cells = 400 if quick else 1000
	for name, base, constants, up in PISTONS:
		name = 'piston/' + name
		if not want(name): continue
		m = material(base, eos='mieGruneisen', yieldModel='perfect', **constants)
		ref = exact.piston(m.density, m.bulkSoundSpeed, m.hugoniotSlope, m.shearModulus, m.yieldStress, up, gruneisen=m.gruneisen)
		run = tube(cells, [(m, 0., LENGTH, cells)])
		run.grid.prescribe(0, 'left', x=up)
		fronts = []
		for share in np.linspace(0.55, 0.9, 8):
			trials.until(run, share * LENGTH / ref['precursorD'])
			x, v = run.grid.view(0, 'x')[1], run.grid.view(0, 'vx')[1]
			t = run.grid.time - 0.5 * omega().dt  # of the velocities; the positions belong half a step later
			fronts.append((t, crossing(x, v, 0.5 * ref['precursorU']), crossing(x, v, 0.5 * (up + ref['precursorU']))))
		fronts = np.array(fronts)
		speed = [np.polyfit(fronts[:, 0], fronts[:, k], 1)[0] for k in (1, 2)]
		xc, rho, p = trials.centres(run, 0)[0][0], trials.density(run, 0)[0] * m.density, np.array(run.grid.view(0, 'pressure')[0])
		sigma = p - run.grid.view(0, 'sxx')[0]
		start, plastic, elastic = x[0], fronts[-1, 2], fronts[-1, 1]
		add = lambda what, value, reference, limit, unit: report.add(name + '/' + what, value, reference, limit=limit, unit=unit)
		add('precursorSpeed', speed[0], ref['precursorD'], 0.01, 'm/s')
		add('precursorParticleSpeed', middle(x, v, plastic, elastic), ref['precursorU'], 0.01, 'm/s')
		add('precursorStress', middle(xc, sigma, plastic, elastic), ref['HEL'], 0.01, 'Pa')
		add('plasticSpeed', speed[1], ref['D'], 0.005, 'm/s')
		add('stress', middle(xc, sigma, start, plastic), ref['sigma'], 0.005, 'Pa')
		add('pressure', middle(xc, p, start, plastic), ref['P'], 0.005, 'Pa')
		add('density', middle(xc, rho, start, plastic), ref['rho'], 0.005, 'kg/m3')
		trials.addBalance(report, run, name)


def impact(report, want, quick):
	cells = 400 if quick else 1000
	for name, flyer, target, speed, edge in IMPACTS:
		name = 'impact/' + name
		if not want(name): continue
		m = [material(k, yieldModel='elastic', shearModulus=0.) for k in (flyer, target)]
		ref = exact.impedanceMatch(*[exact.Hugoniot(k.density, k.bulkSoundSpeed, k.hugoniotSlope) for k in m], speed)
		run = tube(cells, [(m[0], -LENGTH, 0., cells), (m[1], 0., LENGTH, cells)], edge)
		run.grid.setVelocity(0, (speed, 0.))
		fronts = []
		end = 0.8 * LENGTH / max(ref['targetD'], ref['flyerD'])
		for share in np.linspace(0.5, 1, 8):
			trials.until(run, share * end)
			x = [run.grid.view(k, 'x')[1] for k in (0, 1)]
			v = [run.grid.view(k, 'vx')[1] for k in (0, 1)]
			t = run.grid.time - 0.5 * omega().dt
			fronts.append((t, crossing(x[0], v[0], 0.5 * (speed + ref['u'])), crossing(x[1], v[1], 0.5 * ref['u'])))
		fronts = np.array(fronts)
		slope = [np.polyfit(fronts[:, 0], fronts[:, k], 1)[0] for k in (1, 2)]
		face = x[1][0]
		add = lambda what, value, reference, unit: report.add(name + '/' + what, value, reference, limit=0.005, unit=unit)
		add('particleSpeed', middle(x[1], v[1], face, fronts[-1, 2]), ref['u'], 'm/s')
		for k, which, a, b in ((0, 'flyer', fronts[-1, 1], face), (1, 'target', face, fronts[-1, 2])):
			xc = trials.centres(run, k)[0][0]
			add(which + 'Pressure', middle(xc, np.array(run.grid.view(k, 'pressure')[0]), a, b), ref['P'], 'Pa')
			add(which + 'DensityRatio', middle(xc, trials.density(run, k)[0], a, b), ref[which + 'Ratio'], '-')
		add('targetShockSpeed', slope[1], ref['targetD'], 'm/s')
		add('flyerShockSpeed', speed - slope[0], ref['flyerD'], 'm/s')
		trials.addBalance(report, run, name)


CASES = [piston, impact]
