# SPDX-License-Identifier: GPL-2.0-or-later
"""How a stress case is judged: it held, it was refused with a clear error, or it failed. Numbers in, words out; no YADE needed."""
import math
import re
from dataclasses import dataclass
from typing import Callable

HELD, REFUSED, FAILED = 'held', 'refused', 'failed'
#: largest change of the independent energy sum, over the initial (or given) energy, unless a case states its own. These bodies are some ten spacings wide, so
#: that fronts are a good part of them; the dissipation of the pair viscosity is booked with the velocities before the step, which is of first order in it
ENERGY = 0.02
LEAPFROG = 0.02  #: what leapfrog's own error, (omega dt)^2/4 of a wave of some ten spacings, adds at the largest stable step
LIMITS = {
        'booked': 1e-10,  #: kinetic energy minus booked work, over the initial (or given) energy
        'momentum': 1e-12,  #: momentum minus impulses from outside, over sqrt(2 m E)
        'growth': 1.01,  #: kinetic energy over the initial (or given) one: above it energy came from nowhere
        'lost': 0,  #: automata
}
SAYS = {'booked': 'booked energy off by', 'momentum': 'momentum off by', 'growth': 'kinetic energy has grown to', 'lost': 'automata lost:'}
#: what a user must never see
OBSCURE = re.compile(r"Traceback|std::|bad_alloc|boost|Boost|unidentifiable|NoneType|object has no attribute|index out|out of range \(|not enough values|division by zero|segmentation|assert", re.I)



def energyBound(factor=0.4):
	"""Bound on the independent energy sum for a step of `factor` times the largest stable one."""
	return ENERGY + LEAPFROG * factor**2


@dataclass
class StressCase:
	"""One case. `run()` builds a scene, runs it and returns its measures (dict); what it raises is judged."""
	name: str
	run: Callable
	expect: str = HELD  #: HELD, REFUSED, or 'either' where both are fine
	energy: float = energyBound()  #: bound on the independent energy sum


@dataclass
class Outcome:
	name: str
	outcome: str
	text: str  #: the refusal, or why it failed
	measures: dict
	expect: str = HELD
	energyBound: float = ENERGY
	seconds: float = 0.


def clear(error):
	"""Whether an exception is a refusal that a user can act on: of the program's own kinds, one line that names a number or a thing."""
	text = str(error)
	named = re.search(r"\d|'[^']+'", text)
	return isinstance(error, (RuntimeError, ValueError)) and len(text) >= 30 and '\n' not in text.strip() and bool(named) and not OBSCURE.search(text)


def violations(measures, energy=ENERGY):
	"""What speaks against 'held', list of str; empty when nothing does."""
	found = []
	if not measures.get('finite', True):
		found.append('not a number in the state')
	for key, limit in dict(LIMITS, energy=energy).items():
		value = measures.get(key)
		if value is None: continue
		if not (math.isfinite(value) and value <= limit):
			found.append('%s %.3g (allowed: %g)' % (SAYS.get(key, 'energy sum off by'), value, limit))
	for key, value in measures.items():
		if isinstance(value, float) and not math.isfinite(value) and key not in LIMITS and key != 'energy':
			found.append('%s is not a number' % key)
	if measures.get('atLeast') is not None and not measures['value'] >= measures['atLeast']:
		found.append('%.6g is below %.6g' % (measures['value'], measures['atLeast']))
	if measures.get('atMost') is not None and not measures['value'] <= measures['atMost']:
		found.append('%.6g is above %.6g' % (measures['value'], measures['atMost']))
	return found


def judge(case, measures=None, error=None, after=None):
	"""Outcome of a case from its measures or from the exception it ended with.

	after: what was found after an exception: dict(finite=bool, saved=bool), None when there was no scene yet.
	"""
	done = lambda outcome, text: Outcome(case.name, outcome, text, measures or {}, case.expect, case.energy)
	if error is None:
		found = violations(measures, case.energy)
		if found:
			return done(FAILED, '; '.join(found))
		return done(HELD, '') if case.expect != REFUSED else done(FAILED, 'ran, but must be refused')
	text = ' '.join(str(error).split())
	if not clear(error):
		return done(FAILED, '%s: %s' % (type(error).__name__, text))
	if after is not None and not after.get('finite', True):
		return done(FAILED, 'not a number in the state after: ' + text)
	if after is not None and not after.get('saved', True):
		return done(FAILED, 'cannot be saved after: ' + text)
	return done(REFUSED, text) if case.expect != HELD else done(FAILED, 'refused: ' + text)
