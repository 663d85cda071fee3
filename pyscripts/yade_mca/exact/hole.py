# SPDX-License-Identifier: GPL-2.0-or-later
"""A round hole in an elastic plane under tension (Kirsch 1898)."""
import numpy as np


def kirsch(x, y, radius, poisson):
	"""Plane strain, tension of 1 along x far away, hole about the origin.

	x, y [m] (n,), outside the hole. Returns displacement times 2G over the tension (n, 2) [m], and the stresses over the tension: mean of the three normal
	stresses and Mises stress, each (n,).
	"""
	r, angle = np.hypot(x, y), np.arctan2(y, x)
	q, c, s = (radius / r)**2, np.cos(2 * angle), np.sin(2 * angle)
	kappa = 3 - 4 * poisson
	ur = 0.25 * r * (kappa - 1 + 2 * c + 2 * q * (1 + (kappa + 1) * c) - 2 * q**2 * c)
	ut = 0.25 * r * s * (-2 + 2 * q * (1 - kappa) - 2 * q**2)
	rr = 0.5 * (1 - q + (1 - 4 * q + 3 * q**2) * c)
	tt = 0.5 * (1 + q - (1 + 3 * q**2) * c)
	rt = -0.5 * (1 + 2 * q - 3 * q**2) * s
	zz = poisson * (rr + tt)
	mises = np.sqrt(0.5 * ((rr - tt)**2 + (tt - zz)**2 + (zz - rr)**2) + 3 * rt**2)
	turn = np.stack((np.cos(angle), np.sin(angle)))
	return (ur * turn + ut * np.stack((-turn[1], turn[0]))).T, (rr + tt + zz) / 3, mises
