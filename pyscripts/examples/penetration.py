# SPDX-License-Identifier: GPL-2.0-or-later
"""A tungsten-alloy rod, 10 x 100 mm and 1520 m/s, goes through a steel plate: automata in the middle of the plate, a grid beside.

Purpose: the whole chain in one script to copy and change; `pyscripts/run penetration` does the same with options, restart and report.
Expected number: dl/l0 and dU/U0 of the rod at 42 us, spacing 0.5 mm, as two independent codes with the same constants have them
(0.298 ... 0.306, 0.038 ... 0.043); at 1 mm a little less exact.
Run: pyscripts/yade-mca penetration.py with the viewer, pyscripts/yade-mca -n -x penetration.py to the end without.
Sweep: pyscripts/yade-mca-batch penetration.table penetration.py
"""
from yade import O, PyRunner, plot, runtime, utils
from yade_mca import scenes
from yade_mca.expected import expect
from yade_mca.impact_output import patternPicture

utils.readParamsFromTable(noTableOk=True, thickness=25e-3, spacing=1e-3, speed=1520., mode='coupled', seed=1, until=42e-6, pictures=True)
from yade.params.table import mode, pictures, seed, spacing, speed, thickness, until

# bodies O.bodies, engines O.engines, all ready; materials by name from the library, see scenes.penetration for the rest of the options
s = scenes.penetration(thickness=thickness, spacing=spacing, speed=speed, mode=mode, ends='fixed', seed=seed)


def record():
	"""Called every now and then: losses of the rod and the energy sum, for yade.plot."""
	r, e = scenes.rodMeasure(s), s.couplers[0].energies() if s.couplers else s.automata.energies()
	plot.addData(t=1e6 * O.time, lengthLoss=r.lengthLoss, tail=r.velocityLossTail, all=r.velocityLossAll, sum=e['total'])
	s.automata.sync()  # positions and states to O.bodies, for the viewer
	if O.time >= until:
		O.pause()


O.engines = O.engines + [PyRunner(command='record()', iterPeriod=round(20e-3 / spacing), initRun=True)]
plot.plots = {'t': ('lengthLoss', 'tail', 'all'), 't ': ('sum', )}

if runtime.hasDisplay and not runtime.opts.exitAfter:
	O.run()  # watch it in the viewer
else:
	O.run(wait=True)
	if pictures and not utils.runningInBatch():
		patternPicture('penetration.png', s, O.time)
	if (thickness, speed, until) == (25e-3, 1520., 42e-6):
		expect('dl/l0', plot.data['lengthLoss'][-1], 0.302, 0.1)
		expect('dU/U0 of the tail', plot.data['tail'][-1], 0.0405, 0.2)
	expect('energy, last over first', plot.data['sum'][-1] / plot.data['sum'][0], 1, 0.01)
