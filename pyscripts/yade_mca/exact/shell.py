# SPDX-License-Identifier: GPL-2.0-or-later
"""Collapse of a cylindrical shell of incompressible, rigid, perfectly plastic material in plane strain (Howell & Ball 2002).

The shell moves with v = Ri V/r; every material circle keeps its area, so R^2 - r^2 = Ri^2 - ri^2, and eps_p = (2/sqrt3) ln(R/r).
The kinetic energy is spent in plastic work; that gives the inner radius at rest for an initial velocity.
"""
import math

from scipy.integrate import quad
from scipy.optimize import brentq


def _plasticWork(Y, inner, outer, stop):
	"""Plastic work [J/m] until the inner radius is `stop`."""
	gone = inner**2 - stop**2
	strain = lambda R: 2 / math.sqrt(3) * 0.5 * -math.log1p(-gone / R**2)
	return quad(lambda R: Y * strain(R) * 2 * math.pi * R, inner, outer, epsrel=1e-12)[0]


def shellVelocity(density, Y, inner, outer, stop):
	"""Inward velocity [m/s] of the inner surface from which the shell (radii inner, outer [m]) comes to rest at inner radius `stop` [m]."""
	if not 0 < stop < inner < outer:
		raise ValueError('radii must be 0 < stop < inner < outer; got %r, %r, %r' % (stop, inner, outer))
	return math.sqrt(_plasticWork(Y, inner, outer, stop) / (math.pi * density * inner**2 * math.log(outer / inner)))


def shellStopRadius(density, Y, inner, outer, velocity):
	"""Inner radius [m] at rest for an inward velocity [m/s] of the inner surface; 0 when the shell closes."""
	if velocity >= shellVelocity(density, Y, inner, outer, 1e-9 * inner):
		return 0.
	return brentq(lambda s: shellVelocity(density, Y, inner, outer, s) - velocity, 1e-9 * inner, inner * (1 - 1e-12), xtol=1e-14)
