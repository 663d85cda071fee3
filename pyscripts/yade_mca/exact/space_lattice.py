# SPDX-License-Identifier: GPL-2.0-or-later
"""Exact small-amplitude behaviour of the face-centred cubic packing in space (Bloch analysis): phase speeds and largest stable step.

The equations are those of the automata linearised about the stress-free packing (d spacing, S0 = d^2/(2 sqrt2), Omega0 = d^3/sqrt2, twelve directions e):
    theta_i = (1/4) sum_k e.(u_k - u_i)/d                     volume strain
    P_i = -K theta_i,   push of the pair Omega0/(4 d) (P_i + P_k) e
    F_ik = 2G S0 ((u_k - u_i)/d - (phi_i + phi_k)/2 x e - e (theta_i + theta_k)/6)
    m u_i'' = sum_k (F_ik - push),   I phi_i'' = sum_k (d/2) e x F_ik,   I = 0.4 m (3 Omega0/(4 pi))^(2/3)
"""
import math

import numpy as np

_half = np.array(((1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1))) / math.sqrt(2)
DIRECTIONS = np.concatenate((_half, -_half))  #: of the twelve neighbours in the cube
VOLUME, CONTACT = 1 / math.sqrt(2), 1 / (2 * math.sqrt(2))  #: of a cell and of a pair, at spacing 1
GYRATION = math.sqrt(0.4) * (3 * VOLUME / (4 * math.pi))**(1 / 3)  #: sqrt(I/m) at spacing 1
_cross = np.array([np.cross(e, np.eye(3)).T for e in DIRECTIONS])  # matrices: e x a


def _dynamicalMatrix(kd, poisson):
	"""omega^2 matrices (..., 6, 6) of (u, gyration phi) for wave vectors times spacing (..., 3) in the cube, with density = spacing = G = 1."""
	bulk = 2 * (1 + poisson) / (3 * (1 - 2 * poisson))
	kd = np.asarray(kd, float)
	ahead = np.exp(1j * kd @ DIRECTIONS.T) - 1  # u_k - u_i = ahead * u
	theta = ahead @ DIRECTIONS / 4  # theta_i = theta . u
	stiffness = np.zeros((*kd.shape[:-1], 6, 6), complex)
	for k, (e, cross) in enumerate(zip(DIRECTIONS, _cross)):
		a, both = ahead[..., k, None, None], 2 + ahead[..., k, None, None]  # both: value at i + value at k
		row = theta[..., None, :] * e[:, None]  # e theta
		pair = np.concatenate((2 * CONTACT * (a * np.eye(3) - row * both / 6), 2 * CONTACT * both / 2 * cross / GYRATION), axis=-1)
		push = -bulk * VOLUME / 4 * row * both
		stiffness[..., :3, :] -= pair / VOLUME
		stiffness[..., :3, :3] += push / VOLUME
		stiffness[..., 3:, :] -= 0.5 * cross @ pair / (VOLUME * GYRATION)
	return stiffness


def fccModes(wavelength, poisson, direction):
	"""Plane waves of the fcc packing along `direction` (h, k, l) of the cube: [(speed, u, phi)] of P and of the slower and the faster S wave.

	wavelength   in spacings d, one number
	speed        phase speed over that of the continuum [-]
	u, phi       complex amplitudes (3,) of displacement [d] and turn [rad], in the cube, of a wave exp(i k.x) whose displacement has the length 1
	"""
	bulk = 2 * (1 + poisson) / (3 * (1 - 2 * poisson))
	n = np.asarray(direction, float) / np.linalg.norm(direction)
	k = 2 * math.pi / wavelength
	w2, modes = np.linalg.eigh(_dynamicalMatrix(k * n, poisson))
	# the modes of turns are those that move the centres least; of the others P is the one that moves along the wave
	centres = np.sort(np.argsort(-(abs(modes[:3])**2).sum(axis=0))[:3])
	p = centres[np.argmax(abs(n @ modes[:3, centres]))]
	found = []
	for at, c in ((p, math.sqrt(bulk + 4 / 3)), *((s, 1.) for s in centres if s != p)):
		u = modes[:, at] * np.exp(-1j * np.angle(modes[np.argmax(abs(modes[:3, at])), at])) / np.linalg.norm(modes[:3, at])
		found.append((math.sqrt(w2[at]) / k / c, u[:3], u[3:] / GYRATION))
	return found


def fccSpeeds(wavelength, poisson, direction):
	"""Phase speeds over those of the continuum of the P wave, the slower and the faster S wave: see fccModes()."""
	return tuple(speed for speed, _, _ in fccModes(wavelength, poisson, direction))


def fccStableStep(poisson, samples=16):
	"""Largest stable leapfrog step of the elastic packing over d/cS: 2/omega_max over the Brillouin zone [-]."""
	u = np.arange(samples) / samples
	b = 2 * math.pi / math.sqrt(2) * np.array(((-1, 1, 1), (1, -1, 1), (1, 1, -1)))  # reciprocal to half the diagonals of the cube's faces
	kd = np.stack(np.meshgrid(u, u, u, indexing='ij'), axis=-1).reshape(-1, 3) @ b
	return 2 / math.sqrt(np.linalg.eigvalsh(_dynamicalMatrix(kd, poisson)).max())
