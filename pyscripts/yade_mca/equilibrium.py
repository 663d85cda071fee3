# SPDX-License-Identifier: GPL-2.0-or-later
"""The way of automata to a state of rest: after setStress(), under loads, between walls.

    >>> engine.setStress(ids, (200e6, 0, 0))
    >>> equilibrium.relax(engine)       # what was out of balance has moved, and rests
    640
"""
import math

from ._arguments import number, whole

__all__ = ['RelaxError', 'relax']


class RelaxError(ValueError):
	"""What relax() cannot take, or that rest was not reached; the message says what is allowed or what to do."""


def relax(engine, tolerance=1e-8, damping=0.5, steps=50000):
	"""Runs the scene with McaEngine.damping until the automata are at rest, then stops them where they are; returns the number of steps (int).

	engine: the McaEngine of the present scene. tolerance: kinetic energy at which it ends, over the largest on the way [-], 1e-20 to 0.1, in three looks in a row
	(one every 20 steps); what stays below 1e-18 of the elastic energy rests, too. damping: see McaEngine.damping [-], above 0. steps: at most so many. Loads, walls and gravity act meanwhile, O.time goes on, plastic flow and
	fracture happen as they come. Afterwards all velocities and spins of free degrees of freedom are 0 and engine.damping is what it was.
	Raises RelaxError for numbers out of range, for an engine that does not run in the scene, from within a step (PyRunner), and when the steps are over: prescribed motion never rests.
	"""
	from ._yade import scene, steps as run
	tolerance, damping = number('tolerance', tolerance, RelaxError, low=1e-20, high=0.1), number('damping', damping, RelaxError, low=1e-3, high=0.95)
	steps = whole('steps', steps, RelaxError, low=1)
	if engine.inLoop(): raise RelaxError('relax() runs the scene, and this is within a step (PyRunner); call it from the script, between runs')
	before, done, most, looks, start = engine.damping, 0, 0., 0, engine.counters().get('steps', 0)
	engine.damping = damping
	try:
		while done < steps:
			n = min(20, steps - done)
			if not run(n): raise RelaxError('the scene was paused after %d steps, before it was at rest; call relax() again' % done)
			done += n
			if engine.counters().get('steps', 0) < start + done: raise RelaxError('the engine has made no steps: it must stand in O.engines of the present scene, and not be dead')
			e = engine.energies()
			most, stored = max(most, e['kinetic']), abs(e['volumetric']) + abs(e['deviatoric'])
			looks = looks + 1 if e['kinetic'] <= max(tolerance * most, 1e-18 * stored) else 0  # one look may be at a turning point
			if looks == 3: break
		else:
			raise RelaxError(
				'not at rest after %d steps: the kinetic energy is %.3g of the largest on the way, and tolerance is %.3g; allow more steps, or look whether something is prescribed to move'
				% (done, e['kinetic'] / most if most else math.nan, tolerance))
	finally:
		engine.damping = before
	_stop(scene(), engine)
	return done


def _stop(O, engine):
	"""Velocities and spins of free degrees of freedom to 0."""
	for i in engine.ids.tolist():
		s = O.bodies[i].state
		s.vel = [0. if c not in s.blockedDOFs else v for c, v in zip('xyz', s.vel)]
		s.angVel = [0. if c not in s.blockedDOFs else v for c, v in zip('XYZ', s.angVel)]
