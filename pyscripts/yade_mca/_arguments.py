# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks of what scripts hand to the package: each returns the value in the form that is computed with, or raises `error` with name, allowed range and value.

Text is never read as a number, complex numbers keep no half of themselves, and nothing is broadcast.
"""
import math
import numbers
import reprlib

import numpy as np

#: what is larger cannot be squared and summed: no quantity in any system of units
LARGEST = 1e100


def refuse(name, rule, value, error):
	raise error('%s must be %s; got %s' % (name, rule, reprlib.repr(value))) from None


def number(name, value, error, low=-math.inf, above=-math.inf, high=math.inf, below=math.inf, unit=''):
	"""Finite number as float, low <= value <= high and above < value < below, at most LARGEST in size."""
	parts = ['%s %g%s' % (word, limit, unit) for word, limit in (('at least', low), ('above', above), ('at most', high), ('below', below)) if math.isfinite(limit)]
	rule = ' and '.join(['a finite number'] + parts)
	if not isinstance(value, numbers.Real) or isinstance(value, (bool, np.bool_)): refuse(name, rule, value, error)
	try:
		v = float(value)
	except OverflowError:
		refuse(name, rule, value, error)
	if not (abs(v) <= LARGEST and low <= v <= high and above < v < below): refuse(name, rule, value, error)
	return v


def whole(name, value, error, low=0, high=2**31 - 1):
	"""Whole number as int, low <= value <= high."""
	if not isinstance(value, numbers.Integral) or isinstance(value, (bool, np.bool_)) or not low <= value <= high:
		refuse(name, 'a whole number from %d to %d' % (low, high), value, error)
	return int(value)


def oneOf(name, value, allowed, error):
	if not isinstance(value, str) or value not in allowed: refuse(name, 'one of ' + ', '.join("'%s'" % a for a in allowed), value, error)
	return value


def array(name, value, error, shape, empty=False):
	"""Finite numbers as a float array of `shape`, where None stands for any length above 0 (`empty`: or 0); a tuple of shapes allows each of them."""
	shapes = shape if isinstance(shape[0], tuple) else (shape, )
	rule = 'finite numbers of shape ' + ' or '.join('(%s)' % ', '.join('n' if k is None else str(k) for k in s) for s in shapes)
	try:
		a = np.asarray(value)
	except ValueError:  # ragged
		refuse(name, rule, value, error)
	if empty and a.size == 0: return np.zeros([k or 0 for k in shapes[0]])
	fits = any(a.ndim == len(s) and all(k is None and n > 0 or k == n for k, n in zip(s, a.shape)) for s in shapes)
	if a.dtype.kind not in 'iuf' or not fits: refuse(name, rule, value, error)
	a = a.astype(float)
	if not abs(a).max() <= LARGEST: refuse(name, rule, value, error)  # nor nan
	return a


def numbersOfAnyShape(name, value, error, low=-math.inf):
	"""A finite number or an array of them, none below `low`, as a float array of the same shape."""
	rule = 'finite numbers' + (' of at least %g' % low if math.isfinite(low) else '')
	try:
		a = np.asarray(value)
	except ValueError:
		refuse(name, rule, value, error)
	if a.dtype.kind not in 'iuf' or not (abs(a.astype(float)) <= LARGEST).all() or (a < low).any(): refuse(name, rule, value, error)
	return a.astype(float)
