# SPDX-License-Identifier: GPL-2.0-or-later
"""Waves across the interface: each run is compared with one in which automata take the place of the grid; the difference is what the line sends back."""
import math

import numpy as np

from ... import exact
from ..._yade import scene as omega
from ..._yade import yadeClass
from ...scenes import gradedLines
from .. import trials
from ..trials import D, PITCH, elastic

LENGTHS = (10, 16, 20, 40)  #: wavelengths over the spacing
WIDTH = 3.5  #: of the Gaussian pulse, in spacings: its spectrum covers all LENGTHS
START, GAUGE = -32, -8  #: centre of the pulse, place of the gauge


def pulse(kind, coupled, h=1., xs=None, window=95.):
	"""(t, signal, speed) at the gauge: a plane P or S pulse, normal incidence; `window` is its time in spacings over the wave speed."""
	m = elastic()
	c = m.cP if kind == 'P' else m.cS
	profile = lambda x: np.exp(-((x / D - START) / WIDTH)**2)
	left = math.ceil(0.5 * (window - START - GAUGE) + 3 * WIDTH) + 2
	right = math.ceil(0.5 * (window + START + GAUGE) + 3 * WIDTH) + 2
	height = 4 * math.ceil(0.25 * 2.15 * window * m.cP / c)  # nothing from the free surfaces arrives in time
	velocity = (lambda x, y: (profile(x), 0. * y)) if kind == 'P' else (lambda x, y: (0. * y, profile(x)))
	s = trials.halves(m, left, 4 * math.ceil(right / 4), height, h, coupled, xs=xs, ys=None if xs is None else np.arange(0, height + 1.), velocity=velocity)
	dt = 0.14 * D / m.cS
	trials.fixedStep(s, dt)
	every = 3
	steps = math.ceil(window * D / c / dt / every) * every
	v = trials.record(s, [trials.nearest(s, GAUGE, 0.5 * height)], 'vx' if kind == 'P' else 'vy', steps, every)[:, 0]
	return dt * every * np.arange(len(v)), v, c


def spectrum(t, v, c, lengths):
	"""Size of the Fourier components of these wavelengths; the last quarter of the record fades out, so that what still rings does not leak."""
	fade = np.where(t < 0.75 * t[-1], 1., np.cos(0.5 * math.pi * (t / t[-1] - 0.75) / 0.25)**2)
	return np.array([abs(np.exp(-2j * math.pi * c / (l * D) * t) @ (fade * v)) for l in lengths])


def reflection(report, want, quick):
	for kind in 'P', 'S':
		cells = [h for h in ((1,) if quick else (1, 2, 4)) if want('reflection/%s/h%g' % (kind, h))]
		graded = kind == 'P' and want('reflection/P/graded')
		if not cells and not graded: continue
		t, whole, c = pulse(kind, False)
		m = elastic()
		poisson = 0.5 * (1 - 2 * (m.cS / m.cP)**2) / (1 - (m.cS / m.cP)**2)
		sent = lambda v, lengths: spectrum(t, v - whole, c, lengths) / spectrum(t, whole, c, lengths)
		for h in cells:
			got = sent(pulse(kind, True, h)[1], LENGTHS)
			for l, r in zip(LENGTHS, got):
				lattice, chain = exact.tiedLatticeReflection(l, h, kind, poisson), exact.tiedRowReflection(l, h)
				name = 'reflection/%s/h%gd/lambda%gd' % (kind, h, l)
				report.add(name, r, lattice, limit=0.2, unit='amplitude')
				report.add(name + '/chain', r, chain, unit='amplitude')
		if graded:
			xs = gradedLines(0., 80., 1., 1.1, 4.)
			got = sent(pulse(kind, True, xs=xs)[1], (16, 20))
			for l, r in zip((16, 20), got):
				report.add('reflection/P/graded4d/lambda%gd' % l, r, limit=0.015 if l == 16 else None, unit='amplitude')


def _burst(t, frequency):
	"""Gaussian tone burst of two cycles: narrow enough that its wavelength means something."""
	x = (t * frequency - 2.)
	return np.exp(-x**2) * np.cos(2 * math.pi * x)


def _source(s, at, direction, times, force):
	"""A force [N/m] on the automaton at `at`, by YADE's own engine."""
	ids = [int(s.ids['half'][trials.nearest(s, *at)])]
	engine = yadeClass('InterpolatingDirectedForceEngine')(times=list(times), magnitudes=list(force), direction=direction, ids=ids)
	omega().engines = [yadeClass('ForceResetter')(), engine] + list(omega().engines)


def _forced(coupled, frequency, direction, at, left, right, height, steps, dt, every):
	"""(scene, velocities (samples, 2, automata) in the automata's half, which automata)."""
	s = trials.halves(elastic(), left, right, height, 1., coupled, readForces=True)
	t = np.arange(steps) * dt
	_source(s, at, direction, t, 1e3 * _burst(t, frequency))
	trials.fixedStep(s, dt)
	keep = np.flatnonzero(s.packings['half'].positions[:, 0] < -1e-3 * D)
	out = []
	for _ in range(steps // every):
		omega().run(every, True)
		out.append(np.stack((s.automata.field('vx')[keep], s.automata.field('vy')[keep])))
	return s, np.array(out), keep


def point(report, want, quick):
	"""Point force 40 rows before the line: P and S, all angles; amplitude of the field the line adds, over that of the half of the waves sent out towards it."""
	for wavelength, limit in ((20, 0.008),) if quick else ((20, 0.008), (40, 0.0025)):
		for name, direction in ('x', (1, 0, 0)), ('y', (0, 1, 0)):
			label = 'point/lambdaP%gd/%s' % (wavelength, name)
			if not want(label): continue
			m = elastic()
			dt = 0.14 * D / m.cS
			last = 4 * wavelength + 40 * PITCH * m.cP / m.cS + wavelength  # [spacings over cP]: burst, S wave to the line, and on
			steps, every = math.ceil(last * D / m.cP / dt), 25
			# what the outer boundaries send back is the same in both runs, or comes too late
			left, right, height = math.ceil(0.75 * last), 2 * math.ceil(0.25 * (last - 30)), 2 * math.ceil(0.65 * last)
			args = (m.cP / (wavelength * D), direction, (-40 * PITCH, 0.5 * height), left, right, height, steps, dt, every)
			whole, a, keep = _forced(False, *args)
			# leave out what waves from the corners, where the line meets the free surfaces, can have reached
			x, y = whole.packings['half'].positions[keep].T / D
			far = last - math.hypot(40 * PITCH, 0.5 * height)
			clean = (np.hypot(x, y) > far) & (np.hypot(x, y - height) > far)
			mass, e = whole.automata.field('mass')[keep], whole.automata.energies()
			sent = e['kinetic'] + e['volumetric'] + e['deviatoric']
			_, b, _ = _forced(True, *args)
			kinetic = (0.5 * ((a - b)**2).sum(axis=1) * mass)[:, clean].sum(axis=1).max()
			report.add(label, math.sqrt(kinetic / (0.5 * sent)), limit=limit, unit='amplitude')


def rayleigh(report, want, quick):
	"""A force on the free surface sends a Rayleigh wave along it across the line; its amplitude beyond the line against the run without."""
	if not want('rayleigh'): return
	m, wavelength, gauge = elastic(), 20, 24
	cR = exact.rayleighSpeed(m.cP, m.cS)
	dt, height, at = 0.14 * D / m.cS, 80, (-70 * PITCH, 80)
	lengthP = wavelength * m.cP / cR  # the wavelet's frequency is cP/lengthP
	window = 1.2 * lengthP + (70 * PITCH + gauge + wavelength) * m.cP / cR
	steps, every = math.ceil(window * D / m.cP / dt), 4
	signal = []
	for coupled in False, True:
		s = trials.halves(m, 110, 2 * math.ceil(60), height, 1., coupled, readForces=True)
		f = cR / (wavelength * D)
		t = np.arange(steps) * dt
		_source(s, at, (0, 1, 0), t, 1e3 * exact.ricker(t, f, 1.2 / f))
		trials.fixedStep(s, dt)
		place = (28 * PITCH, height)  # an even row: automata on the surface
		if coupled:
			k = s.grid.addGauge((place[0] * D, (height - 1e-9) * D), every)
			omega().run(steps // every * every, True)
			signal.append(np.interp(np.arange(1, steps // every + 1) * every * dt, s.grid.gauge(k)[:, 0], s.grid.gauge(k)[:, 4]))
		else:
			signal.append(trials.record(s, [trials.nearest(s, *place)], 'vy', steps, every)[:, 0])
	a, b = signal
	t = np.arange(len(a)) * every * dt
	ratio = spectrum(t, b, cR, (wavelength,))[0] / spectrum(t, a, cR, (wavelength,))[0]
	report.add('rayleigh/transmitted', ratio, 1., limit=0.01, unit='amplitude')


CASES = [reflection, point, rayleigh]
