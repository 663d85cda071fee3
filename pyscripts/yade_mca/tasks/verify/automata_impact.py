# SPDX-License-Identifier: GPL-2.0-or-later
"""Taylor bar and spall of the automata."""
import math

import numpy as np

from ... import scenes
from ..._yade import scene as omega
from .. import trials
from ..trials import material, order

LENGTH, WIDTH, SPEED, END = 25.4e-3, 7.62e-3, 130., 60e-6  #: of the Taylor bar [m], [m/s]; by END [s] it has come to rest but for vibration
HEIGHTS = np.array((0.5, 1., 2., 3., 4., 6., 8.)) * 1e-3  #: above the anvil, where widths are compared [m]


def soft():
	"""Perfectly plastic copper that does not break."""
	return material('OFHC_Cu', yieldModel='perfect', yieldStress=400e6)


def outline(y, x):
	"""Widths at HEIGHTS over the width at the start, of a side through (x, y) [m]."""
	o = np.argsort(y)
	return 2 * np.interp(HEIGHTS, y[o], x[o]) / WIDTH


def barOfAutomata(n, material=None, speed=SPEED, end=END):
	"""Length and widths at the end over those at the start, and the error of the energy sum; n automata across, on a smooth anvil."""
	omega().reset()
	run = scenes.taylorBar(material or soft(), LENGTH, WIDTH, WIDTH / n, speed, engineOptions=dict(account=True))
	p = run.packings['bar']
	x0, y0 = abs(p.positions[:, 0]), p.positions[:, 1]
	rear, side = y0 > y0.max() - 1.2 * p.spacing, x0 > 0.5 * WIDTH - 0.6 * p.spacing  # the ends of rows are a quarter of the spacing outside and inside
	length = []
	while omega().time < end:
		trials.steps(run, 50)
		if omega().time > 0.75 * end: length.append(1 + (run.field('bar', 'y') - y0)[rear].mean() / LENGTH)
	x, y, e = run.field('bar', 'x'), run.field('bar', 'y'), run.automata.energies()
	stretch = abs(x[side]) / x0[side]
	return np.mean(length), outline(y[side], 0.5 * WIDTH * stretch), e['total'] / e['kineticStart'] - 1


def barOfCells(n, material=None, speed=SPEED, end=END):
	"""The same on the Lagrangian grid, half of the bar."""
	run, h = trials.grid(), WIDTH / n
	run.grid.addRectangle(material or soft(), np.linspace(0, 0.5 * WIDTH, n // 2 + 1), np.linspace(0, LENGTH, round(LENGTH / h) + 1))
	run.grid.symmetry(0, 'left')
	run.grid.symmetry(0, 'bottom')
	run.grid.setVelocity(0, (0., -speed))
	length = []
	while run.grid.time < end:
		trials.steps(run, 50)
		if run.grid.time > 0.75 * end: length.append(run.grid.view(0, 'y')[-1].mean() / LENGTH)
	return np.mean(length), outline(run.grid.view(0, 'y')[:, -1], run.grid.view(0, 'x')[:, -1])


def taylor(report, want, quick):
	"""Copper bar on a rigid smooth anvil in plane strain: length and outline converge with the spacing, to those of the grid."""
	if not want('taylor'): return
	levels = (8, 16) if quick else (8, 16, 32)
	ref, refWidths = barOfCells(levels[-1])
	found = [barOfAutomata(n) for n in levels]
	lengths = [f[0] for f in found]
	for n, (length, widths, energy) in zip(levels, found):
		last = n == levels[-1]
		report.add('taylor/N%d/length' % n, length, ref, limit=0.01 if last else None, unit='of the original')
		report.add('taylor/N%d/outline' % n, np.mean(abs(widths / refWidths - 1)), 0., limit=0.03 if last else None, unit='mean difference of widths')
		report.add('taylor/N%d/energySum' % n, energy, 0., unit='of the kinetic energy')
	change = lambda k: np.mean(abs(found[k][1] / found[k - 1][1] - 1))
	report.add('taylor/lastRefinement/length', lengths[-1], lengths[-2], limit=0.01, unit='of the original', order=order(abs(np.diff(lengths))) if len(levels) > 2 else None)
	report.add('taylor/lastRefinement/outline', change(-1), 0., limit=0.03, unit='mean difference of widths')


def spallBar(flow, strength, depth, rise=30, peak=1.4):
	"""A wave of compression with a long linear decay is reflected at the right end of a bar, which opens at `depth` spacings from it.

	Returns pull-back of the free surface [m/s], impedance rho c [Pa s/m], axial tension at which links break [Pa], number of broken links. The piston's velocity rises
	within `rise` spacings of travel and decays so that the tension reaches the strength at `depth`; the peak is `peak` times the strength.
	"""
	d = 0.25e-3
	m = material('OFHC_Cu', eos='linear', yieldModel='perfect', yieldStress=flow, spallStrength=strength)
	K, G = m.density * m.bulkSoundSpeed**2, m.shearModulus
	elastic = math.isinf(flow)
	# the criterion is the mean stress; in elastic uniaxial strain the axial one is (K + 4G/3)/K times it
	c, sigma = (m.cP, strength * (K + 4 / 3 * G) / K) if elastic else (m.bulkSoundSpeed, strength + 2 / 3 * flow)
	up, start, decay = peak * sigma / (m.density * c), rise * d / c, 2 * peak * depth * d / c
	columns = round(2.5 * peak * depth) + depth + rise
	bar = trials.bar(m, columns * d, d, rows=6)
	piston = scenes.driveEnd(bar, 'bar', 0.)
	surface = []
	while omega().time < (columns + 3.2 * depth) * d / c:
		trials.steps(bar, 10)
		t = omega().time
		trials.move(piston, vx=up * math.sin(0.5 * math.pi * t / start)**2 if t < start else max(0., up * (1 - (t - start) / decay)))
		surface.append((t * c / d - columns, scenes.profile(bar, 'bar', 'vx')[1][-2:].mean()))
	at, v = np.array(surface).T  # travel since the pulse has reached the surface [d]
	top = int(np.argmax(np.where(at < rise + 0.5 * depth, v, 0.)))
	return v[top] - v[top:].min(), m.density * c, sigma, bar.automata.counters()['brokenLinks']


def spall(report, want, quick):
	"""Pull-back of the free surface when a bar opens: du = 2 sigma/(rho c), exact in an elastic bar for a long pulse.

	What is missing is the width over which the front from the new surface is smeared on its way: like the root of one over the depth. With plastic flow the
	elastic part of the front runs ahead, and the identity itself is low by a few yield stresses.
	"""
	strength, depths = 1.5e9, (60, 120) if quick else (60, 120, 240)
	cases = [('elastic', math.inf, depth, 0.05 if depth == 240 else None) for depth in depths] + ([] if quick else [('plastic', 1e7, 120, None)])
	for name, flow, depth, limit in cases:
		name = 'spall/%s/depth%dd' % (name, depth)
		if not want(name): continue
		fall, impedance, sigma, broken = spallBar(flow, strength, depth)
		report.add(name + '/pullBack', fall, 2 * sigma / impedance, limit=limit, unit='m/s')
		report.add(name + '/brokenLinks', broken, passed=broken > 0)


CASES = [taylor, spall]
