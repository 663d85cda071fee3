# SPDX-License-Identifier: GPL-2.0-or-later
"""Erosion: automata that matter no more leave the scene, and what they take along stays in the account.

    >>> gone = erosion.erode(engine, lambda a: (a['links'] == 0) & (a['y'] < -50e-3))    # debris that has left; in a PyRunner, or between runs
    >>> engine.energies()['leftMass'], engine.energies()['leftMomentumX']
"""
import numpy as np

__all__ = ['ErosionError', 'erode']


class ErosionError(ValueError):
	"""What erode() cannot take; the message says what is allowed."""


def erode(engine, where, names=('x', 'y', 'vx', 'vy', 'links', 'plasticStrain', 'damage', 'temperature')):
	"""Erases the automata of a McaEngine for which `where` holds; returns their ids, numpy (n,) int.

	where: f(a) with a: dict of name -> numpy (N,), the fields `names` (those of McaEngine.field()) and 'ids', that returns truth values (N,).
	Mass, momentum and energies of the erased stand in engine.energies(): 'leftMass' [kg/m, in space kg], 'leftMomentumX' and so on, 'leftKinetic', 'leftVolumetric',
	'leftDeviatoric' and their sum within 'left', so that 'total' goes on; plastic work, friction and the like stay where they were booked. Links and contacts
	with them are gone; who stays keeps volume and stress. Erosion is no fracture criterion: what still carries load leaves a hole, and 'total' moves in the next
	step by the work of half a step on it, since velocities stand half a step after stresses ('bookedError' does not). When the last automaton is erased the engine starts anew.
	Raises ErosionError when where(a) is none, RuntimeError of the engine's next step when a body cannot go (tied to a grid).
	"""
	from ._yade import scene
	a = engine.fields(['ids'] + [n for n in names if n != 'ids'])
	found = np.asarray(where(a)) if callable(where) else None
	if found is None or found.shape != a['ids'].shape or found.dtype != bool:
		raise ErosionError(
			'where must be a function of the fields that returns %d truth values (numpy bool), one for each automaton; %s' %
			(len(a['ids']), 'got %r' % (where, ) if found is None else 'it gave %s of shape %s' % (found.dtype, found.shape)))
	gone = a['ids'][found]
	bodies = scene().bodies
	for i in gone.tolist():
		bodies.erase(i)
	return gone
