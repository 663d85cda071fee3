# SPDX-License-Identifier: GPL-2.0-or-later
"""Exact small-amplitude behaviour of the discrete medium: phase speeds of the hexagonal packing and reflection at a tied row.

The equations are those of the automata linearised about the stress-free packing (d spacing, S0 = d/sqrt3, Omega0 = sqrt3/2 d^2):
    theta_i = (1/3) sum_j n.(u_j - u_i)/d                     volume strain, plane strain, 6 neighbours
    P_i = -K theta_i,   f_ij = S0 (P_i + P_j)/2               pressure force
    s_ij = 2G (n.(u_j - u_i)/d - (theta_i + theta_j)/6)       normal deviatoric stress of the pair
    tau_ij = 2G (t.(u_j - u_i)/d - (phi_i + phi_j)/2)         shear stress of the pair, phi rotation
    m u_i'' = sum_j S0 ((s_ij - (P_i + P_j)/2) n + tau_ij t),   (m R^2/2) phi_i'' = sum_j S0 R tau_ij
"""
import math

import numpy as np


def _dynamicalMatrix(kd, bulk, shear):
	"""omega^2 matrix (3, 3) of (ux, uy, R phi) for wave vector times spacing kd (2,), with density = spacing = 1."""
	d, radius = 1., 0.5
	contact, mass = d / math.sqrt(3), math.sqrt(3) / 2 * d * d
	inertia = 0.5 * mass * radius**2
	stiffness = np.zeros((3, 3), complex)
	angle = math.pi / 3 * np.arange(6)
	normals = np.stack((np.cos(angle), np.sin(angle)), axis=1)
	ahead = np.exp(1j * normals @ kd) - 1  # u_j - u_i = ahead * u
	theta = np.zeros(3, complex)  # row: theta_i = theta . (ux, uy, phi)
	theta[:2] = (ahead[:, None] * normals).sum(axis=0) / (3 * d)
	for n, a in zip(normals, ahead):
		t = np.array((-n[1], n[0]))
		both = 2 + a  # value at i + value at j
		pressure = -bulk * theta * both / 2
		normal = 2 * shear * (np.append(n * a / d, 0) - theta * both / 6)
		tangential = 2 * shear * np.append(t * a / d, -both / 2)
		force = contact * (np.outer(n, normal - pressure) + np.outer(t, tangential))
		stiffness[:2] -= force / mass
		stiffness[2] -= contact * radius * tangential / inertia
	# phi measured as R phi, which makes the matrix Hermitian up to the ratio of inertia and mass
	scale = np.array((1, 1, radius))
	return stiffness * scale[:, None] / scale[None, :]


def hexagonalSpeeds(wavelength, poisson, angle=0.):
	"""Phase speeds of P and S waves in the hexagonal packing over those of the continuum: (P, S) [-].

	wavelength in spacings d (number or array), `angle` [rad] of the wave vector against the close-packed rows.
	"""
	shear, bulk = 1., 2 * (1 + poisson) / (3 * (1 - 2 * poisson))
	cP, cS = math.sqrt(bulk + 4 / 3), 1.
	direction = np.array((math.cos(angle), math.sin(angle)))
	result = []
	for length in np.atleast_1d(np.asarray(wavelength, float)):
		k = 2 * math.pi / length
		w2, modes = np.linalg.eig(_dynamicalMatrix(k * direction, bulk, shear))
		# the spin mode is the one that moves the centres least; of the others P is the one that moves along the wave
		moves = np.abs(modes[:2])**2
		centres = np.argsort(-moves.sum(axis=0))[:2]
		along = np.abs(direction @ modes[:2, centres])**2 / moves[:, centres].sum(axis=0)
		p, s = centres[np.argsort(-along)]
		result.append([math.sqrt(w2[p].real) / k / cP, math.sqrt(w2[s].real) / k / cS])
	result = np.array(result).T
	return tuple(result) if np.ndim(wavelength) else tuple(result[:, 0])


def hexagonalStableStep(poisson, samples=60):
	"""Largest stable leapfrog step of the elastic packing over R/cP: 2/omega_max over the Brillouin zone [-]."""
	shear, bulk = 1., 2 * (1 + poisson) / (3 * (1 - 2 * poisson))
	top = 0.
	b1, b2 = 2 * math.pi * np.array((1, -1 / math.sqrt(3))), 2 * math.pi * np.array((0, 2 / math.sqrt(3)))
	for u in np.arange(samples) / samples:
		for v in np.arange(samples) / samples:
			top = max(top, np.linalg.eigvals(_dynamicalMatrix(u * b1 + v * b2, bulk, shear)).real.max())
	return 2 / math.sqrt(top) * math.sqrt(bulk + 4 / 3) / 0.5


ROW = math.sqrt(3) / 2  #: distance of close-packed rows over the spacing


def chainReflection(wavelength, cells, interfaceMass='half'):
	"""Exact |R| of a plane wave, normal incidence, from rows of automata into a one-dimensional grid with lumped masses.

	wavelength     c/frequency in spacings d, with the speed c of long waves (number or array)
	cells          lengths of the grid cells over d, from the interface outwards; the last goes on for ever
	interfaceMass  'half': the tied row counts half its mass, as it should; 'full': counted in full, for comparison
	Rows (distance sqrt3/2 d) and cells have the same density and modulus, each link the stiffness modulus/length.
	"""
	if interfaceMass not in ('half', 'full'):
		raise ValueError("interfaceMass is 'half' or 'full', not %r" % (interfaceMass,))
	h = [float(c) for c in cells]
	out = []
	for length in np.atleast_1d(np.asarray(wavelength, float)):
		w2 = (2 * math.pi / length)**2
		k = 2 / ROW * math.asin(0.5 * ROW * 2 * math.pi / length)
		# far field of the grid: u ~ z^n with z + 1/z = 2 - w2 h^2, outgoing or decaying
		x = 1 - 0.5 * w2 * h[-1]**2
		z = complex(x, -math.sqrt(1 - x * x)) if abs(x) < 1 else x - math.copysign(math.sqrt(x * x - 1), x)
		# force per displacement with which the grid beyond a node pulls it back, from the far end to the interface
		pull = (1 - z) / h[-1]
		for left, right in zip(reversed(h[:-1]), reversed(h[1:])):
			node = pull - w2 * 0.5 * (left + right)  # the node between the cells: its own inertia
			pull = node / (1 + left * node)  # in series with the link of length `left`
		mass = (0.5 * ROW if interfaceMass == 'half' else ROW) + 0.5 * h[0]
		# interface row 0: -w2 m u0 = (u_-1 - u0)/ROW - pull u0 with u_n = exp(-i k x) + R exp(i k x)
		e = complex(math.cos(k * ROW), math.sin(k * ROW))
		load = lambda left: w2 * mass + (left - 1) / ROW - pull
		out.append(abs(load(e) / load(1 / e)))
	return np.array(out) if np.ndim(wavelength) else out[0]


def tiedRowReflection(wavelength, cell, interfaceMass='half'):
	"""chainReflection() with a uniform grid of cells `cell` spacings long: the table of the tied row."""
	return chainReflection(wavelength, [cell], interfaceMass)


def _rowMatrix(kind, wavelength, bulk, shear, cells, particleRows):
	"""Sparse dynamic stiffness (forces minus inertia) for normal incidence: `particleRows` rows, row 0 the tied one on the right, and `cells` of the
	grid behind it (None: rows on both sides, row 0 an ordinary one in the middle). Absorbing layers at both ends. Density = spacing = 1."""
	from scipy.sparse import lil_matrix
	contact, modulus = 1 / math.sqrt(3), bulk + 4 / 3 * shear if kind == 'P' else shear
	w2 = (2 * math.pi / wavelength)**2 * modulus
	spin = kind == 'S'
	tied = cells is not None
	rows = particleRows if tied else 2 * particleRows
	nodes = len(cells) if tied else 0
	per = 2 if spin else 1
	size = rows * per + nodes
	at = lambda n, k=0: n * per + k  # rows from the left, n = rows - 1 is the tied one; then the nodes
	node = lambda n: at(rows - 1) if n == 0 else rows * per + n - 1
	matrix = lil_matrix((size, size), dtype=complex)
	absorb = lambda n, total: 1 + 0.6j * max(0., 1 - n / (0.7 * total))**4
	share = lambda n: 0.5 if tied and n == rows - 1 else 1.
	# volume strain of each row as (index, factor)
	theta = []
	for n in range(rows):
		if tied and n == rows - 1: theta.append([(n, 1 / ROW), (n - 1, -1 / ROW)])
		elif n == 0: theta.append([(1, 1 / ROW), (0, -1 / ROW)])
		elif n == rows - 1: theta.append([(n, 1 / ROW), (n - 1, -1 / ROW)])
		else: theta.append([(n + 1, 0.5 / ROW), (n - 1, -0.5 / ROW)])
	for n in range(rows):
		far = min(n, 2 * particleRows - 1 - n)
		mass = w2 * share(n) * ROW * absorb(far, particleRows)
		matrix[at(n), at(n)] += mass
		if spin:
			matrix[at(n, 1), at(n, 1)] += mass / 8 - 2 * shear * contact * share(n)  # inertia m R^2/2; the two links along the row
		else:
			for i, a in theta[n]:
				for j, b in theta[n]:
					matrix[at(i), at(j)] -= bulk * share(n) * ROW * a * b
	for n in range(rows - 1):
		for me, other, nx in ((n, n + 1, ROW), (n + 1, n, -ROW)):  # two links each, to the next row
			k = 4 * shear * contact
			matrix[at(me), at(other)] += k
			matrix[at(me), at(me)] -= k
			if spin:
				for row in me, other:
					matrix[at(me), at(row, 1)] -= 0.5 * k * nx
					matrix[at(me, 1), at(row, 1)] -= 0.25 * k
				matrix[at(me, 1), at(other)] += 0.5 * k * nx
				matrix[at(me, 1), at(me)] -= 0.5 * k * nx
			else:
				for row in me, other:
					for i, a in theta[row]:
						matrix[at(me), at(i)] -= k * nx / 6 * a
	for n, h in enumerate(cells if tied else ()):
		for i, j in ((node(n), node(n + 1)), (node(n + 1), node(n))):
			matrix[i, i] -= modulus / h
			matrix[i, j] += modulus / h
			matrix[i, i] += 0.5 * h * w2 * absorb(nodes - n, nodes)
	return matrix.tocsc(), at


def tiedLatticeReflection(wavelength, cells, kind='P', poisson=0.3, rows=1500):
	"""|R| of a plane wave, normal incidence, from the hexagonal packing with the laws of the automata into a grid tied to one of its close-packed rows.

	As chainReflection(), but with the packing's own laws, linearised (pressure from the mean over the neighbours, rotation, pair stresses), so with its
	true dispersion: the response to a time-harmonic load, once with the grid and once with automata all along; absorbing layers at the ends.
	wavelength [d] one number; cells: length of all cells, or lengths from the interface outwards of which the last goes on; kind 'P' or 'S'.
	"""
	from scipy.sparse.linalg import spsolve
	shear, bulk = 1., 2 * (1 + poisson) / (3 * (1 - 2 * poisson))
	h = [float(cells)] if np.ndim(cells) == 0 else [float(c) for c in cells]
	h += [h[-1]] * int(rows * ROW / h[-1])
	source, gauge = rows - 300, rows - 150
	got = []
	for c in None, h:
		matrix, at = _rowMatrix(kind, wavelength, bulk, shear, c, rows)
		load = np.zeros(matrix.shape[0], complex)
		load[at(source)] = 1
		got.append(spsolve(matrix, load)[at(gauge)])
	return float(abs(got[1] - got[0]) / abs(got[0]))
