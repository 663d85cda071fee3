# SPDX-License-Identifier: GPL-2.0-or-later
"""The numbers behind the baselines: cheap, physically meaningful. Each group is measured anew from the program; what they were lies in GROUP.json.

A new one: a function here that returns {name: value}, its entry in GROUPS, then `tests/baseline update GROUP --tolerance X --why TEXT`.
"""
import math

import numpy as np


def penetration():
	"""Tungsten rod through 25 mm of steel at 42 us, spacing 2.5 mm, coupled: losses of length and speed [-]."""
	from yade import O
	from yade_mca import scenes
	from yade_mca.impact import Impact
	O.reset()
	run = Impact(scenes.penetration(thickness=25e-3, spacing=2.5e-3), until=42e-6)
	while not run.finished:
		run.advance()
	at = run.at(42e-6)
	return {k: at[k] for k in ('lengthLoss', 'velocityLossTail', 'velocityLossAll')}


def shock():
	"""Piston into copper, U = 0.1 c0, rows along the motion: shock speed [m/s] and pressure [Pa] over the exact ones."""
	from yade_mca import exact, scenes
	from yade_mca.tasks.verify import automata_shocks as shocks
	m = shocks.material('OFHC_Cu', eos='shockAdiabat', yieldModel='perfect')
	m.yieldStress = 0.01 * m.density * m.bulkSoundSpeed**2
	up, columns = 0.1 * m.bulkSoundSpeed, 120
	ref = exact.piston(m.density, m.bulkSoundSpeed, m.hugoniotSlope, m.shearModulus, m.yieldStress, up)
	bar = shocks.drive(m, up, 0., 'affine', columns, 8)
	speed, front = shocks.fronts(bar, lambda name: scenes.profile(bar, 'bar', name), ref, up, columns * shocks.D, np.linspace(0.4, 0.75, 6))[1::2]
	x, P = scenes.profile(bar, 'bar', 'pressure')
	return dict(speed=speed / ref['D'], pressure=shocks.between(x, P, x[0], front) / ref['P'])


def lamb():
	"""Lamb's problem with cells of 1 mm: relative L2 error of the displacement at the surface 50 mm from the force [-]."""
	from yade_mca import exact
	from yade_mca.tasks.verify import grid_lamb as g
	m, run, gauges = g.solve(1e-3)
	t, ux, uz = gauges[-1]
	rz, rx = exact.lambSurface(t, g.GAUGES[-1], m.density, m.cP, m.cS, g.FREQUENCY, g.DELAY)
	return dict(error=math.sqrt(np.sum((ux - rx)**2 + (uz - rz)**2) / np.sum(rx**2 + rz**2)))


def reflection():
	"""Normal P wave onto a tied row, cells of two spacings: amplitude sent back at a wavelength of 20 spacings [-]."""
	from yade_mca.tasks.verify import interface_waves as w
	t, whole, c = w.pulse('P', False, window=60.)
	tied = w.pulse('P', True, 2., window=60.)[1]
	sent = lambda lengths: w.spectrum(t, tied - whole, c, lengths) / w.spectrum(t, whole, c, lengths)
	return dict(lambda20d=float(sent((20, ))[0]))


def taylor():
	"""Copper bar on a smooth rigid anvil at 190 m/s, 8 automata across, after 70 us: length over the original one, mean plastic strain [-]."""
	from yade import O
	from yade_mca import materials, scenes
	length, width, n = 25.4e-3, 7.62e-3, 8
	O.reset()
	s = scenes.taylorBar(materials.mcaMat('OFHC_Cu', fractureStrain=1.), length, width, width / n, 190.)
	O.run(2, True)
	while O.time < 70e-6:
		O.run(100, True)
	y, w = s.field('bar', 'y'), s.field('bar', 'weight')
	y0 = s.packings['bar'].positions[:, 1]
	return dict(length=1 + (y - y0)[y0 > y0.max() - 1.2 * width / n].mean() / length, plasticStrain=float(s.field('bar', 'plasticStrain') @ w / w.sum()))


GROUPS = dict(penetration=penetration, shock=shock, lamb=lamb, reflection=reflection, taylor=taylor)
