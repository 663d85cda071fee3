# SPDX-License-Identifier: GPL-2.0-or-later
"""The expected number of a script: printed beside what came out, and asserted."""


class Unexpected(RuntimeError):
	"""A result that is off by more than the script allows."""


def expect(name, value, expected, tolerance, unit=''):
	"""Prints one line and returns the relative deviation of `value` from `expected` (absolute where `expected` is 0).

	tolerance: largest deviation allowed. Raises Unexpected when it is exceeded or the value is not a number.
	"""
	off = abs(value - expected) / (abs(expected) or 1.)
	print('EXPECT %s: %.6g %s, expected %.6g, off %.2g (allowed %.2g)' % (name, value, unit, expected, off, tolerance), flush=True)
	if not off <= tolerance:
		raise Unexpected('%s is %.6g %s instead of %.6g: off by %.2g, allowed %.2g' % (name, value, unit, expected, off, tolerance))
	return off
