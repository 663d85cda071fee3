# SPDX-License-Identifier: GPL-2.0-or-later
"""Bending vibration of a free beam with shear and rotary inertia (Timoshenko 1921)."""
import math

import numpy as np
from scipy.optimize import brentq

SLENDER = 4.730040744862704  #: first root of cos x cosh x = 1: the free beam of Euler and Bernoulli


def freeBeam(length, height, density, young, poisson, stress='strain'):
	"""First bending frequency [rad/s] of a free beam of rectangular section in the plane.

	length, height [m], density [kg/m3], young [Pa]; stress: 'strain' for plane strain, 'stress' for plane stress. The shear coefficient is
	5 (1 + nu)/(6 + 5 nu), with the Poisson's ratio of the plane (Kaneko 1975). Raises ValueError when height/length is above 0.4, where no beam is left.
	"""
	if not 0 < height <= 0.4 * length:
		raise ValueError('height/length = %g must be above 0 and at most 0.4' % (height / length))
	E, nu = (young / (1 - poisson**2), poisson / (1 - poisson)) if stress == 'strain' else (young, poisson)
	G, shear = 0.5 * young / (1 + poisson), 5 * (1 + nu) / (6 + 5 * nu)
	euler = SLENDER**2 / length**2 * height * math.sqrt(E / (12 * density))

	def edge(w):
		"""Zero where a symmetric mode leaves no moment and no shear force at the ends."""
		a, b, c = density * w**2 / E, density * w**2 / (shear * G), 12 * density * w**2 / (E * height**2)
		root = math.sqrt(0.25 * (a - b)**2 + c)
		p, q = math.sqrt(0.5 * (a + b) + root), math.sqrt(root - 0.5 * (a + b))
		x = 0.5 * length
		turn = np.array(((b - p**2) * math.cos(p * x), (q**2 + b) * math.cosh(q * x)))
		slip = np.array((-p - (b - p**2) / p, q - (q**2 + b) / q)) * (math.sin(p * x), math.sinh(q * x))
		return turn[0] * slip[1] - turn[1] * slip[0]

	return brentq(edge, 0.3 * euler, 1.0001 * euler, rtol=1e-13)
