# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic waves: Rayleigh's speed and Lamb's problem on the surface of a half-plane."""
import math

import numpy as np
from scipy.optimize import brentq


def rayleighSpeed(cP, cS):
	"""Speed of the surface wave [m/s] (Rayleigh 1885): root of (2 - x)^2 = 4 sqrt(1 - x) sqrt(1 - x cS^2/cP^2), x = (c/cS)^2."""
	k = (cS / cP)**2
	if not 0 < k <= 0.75 + 1e-12:  # 3/4 at nu = -1
		raise ValueError('cS/cP = %g is not below 1' % math.sqrt(k) if k > 0 else 'cS and cP must be above 0')
	# divided by x, so that the trivial root x = 0 is gone
	f = lambda x: ((2 - x)**2 - 4 * math.sqrt(1 - x) * math.sqrt(1 - k * x)) / x
	return cS * math.sqrt(brentq(f, 1e-3, 1 - 1e-15, xtol=1e-16, rtol=8.9e-16))


def ricker(t, frequency, delay):
	"""Ricker's wavelet (1 - 2a) exp(-a), a = (pi f (t - delay))^2 [-]; t may be complex."""
	a = (math.pi * frequency * (t - delay))**2
	return (1 - 2 * a) * np.exp(-a)


def lambSurface(times, x, density, cP, cS, frequency, delay, nodes=1200):
	"""Lamb's problem (1904) in plane strain: normal line force on the free surface of a half-plane, times a Ricker wavelet.

	times [s] (n,), x [m] distance along the surface, frequency [Hz], delay [s] of the wavelet. Returns (uz, ux), each (n,), displacement of
	the surface per unit line force [m per N/m], z into the solid, x away from the force.

	With slownesses p on the Cagniard-de Hoop path (t = p x on the surface) the answer is a convolution with the wavelet. The wavelet is an
	entire function, so the path is bent below the Rayleigh pole and the head-wave branch points and the integral is smooth.
	"""
	a, b, cR = 1 / cP, 1 / cS, rayleighSpeed(cP, cS)
	times = np.asarray(times, float)
	width = 1 / (math.pi * frequency)
	end = max(times.max() + abs(delay) + 20 * width, 1.5 * x / cR) / x + 2 / cR
	depth = 0.5 * min(width / x, 0.2 * a)
	# from 0 along the real axis to a/2 nothing is radiated: start there, dip by `depth`, run to the end
	node, weight = np.polynomial.legendre.leggauss(200)
	s = 0.5 * (node + 1)
	down = 0.5 * a - 1j * depth * s
	node2, weight2 = np.polynomial.legendre.leggauss(nodes)
	s2 = 0.5 * (node2 + 1)
	along = 0.5 * a - 1j * depth + (end - 0.5 * a) * s2
	p = np.concatenate((down, along))
	dp = np.concatenate((-0.5j * depth * weight, 0.5 * (end - 0.5 * a) * weight2))
	q = 1j * p
	alpha, beta = np.sqrt(a * a + q * q), np.sqrt(b * b + q * q)
	# the branch with Re > 0 that continues the real axis of q from below in p
	alpha, beta = (np.where(v.real < 0, -v, v) for v in (alpha, beta))
	rayleigh = (2 * q * q + b * b)**2 - 4 * q * q * alpha * beta
	mu = density * cS**2
	gz = (1j * b * b * alpha / rayleigh * dp) / (math.pi * mu)
	gx = (q * (2 * q * q + b * b - 2 * alpha * beta) / rayleigh * dp) / (math.pi * mu)
	uz, ux = np.empty(len(times)), np.empty(len(times))
	for i, t in enumerate(times):
		f = ricker(t - p * x, frequency, delay)
		uz[i], ux[i] = (gz @ f).real, (gx @ f).real
	return uz, ux
