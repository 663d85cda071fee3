# SPDX-License-Identifier: GPL-2.0-or-later
"""Shocks: Hugoniot of D = c0 + b U, impedance match, elastic limit, elastic-plastic piston. P > 0 in compression, SI units."""
import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq


@dataclass(frozen=True)
class Hugoniot:
	"""Shock adiabat D = c0 + b U of a material at rest and without strength (Rankine-Hugoniot; Marsh 1980 for constants)."""
	rho0: float  #: [kg/m3]
	c0: float  #: [m/s]
	b: float  #: [-]

	@classmethod
	def of(cls, material):
		"""From a record of yade_mca.materials."""
		return cls(material.density, material.bulkSoundSpeed, material.hugoniotSlope)

	def shockSpeed(self, u):
		"""D [m/s] for particle speed u [m/s]."""
		return self.c0 + self.b * u

	def pressure(self, u):
		"""P = rho0 D u [Pa]."""
		return self.rho0 * self.shockSpeed(u) * u

	def strain(self, u):
		"""Volume strain J - 1 = -u/D [-]. Raises ValueError where u reaches D, which would compress to nothing (b < 1 only)."""
		D = self.shockSpeed(u)
		if not np.all(np.asarray(u) < D):
			raise ValueError('particle speed %r m/s must be below the shock speed c0 + b u = %r m/s: nothing would be left of the volume' % (u, D))
		return -u / D

	def density(self, u):
		"""rho [kg/m3] behind the shock."""
		return self.rho0 / (1 + self.strain(u))

	def adiabat(self, strain):
		"""P [Pa] at volume strain J - 1: -K e/(1 + b e)^2 in compression, -K e in tension, K = rho0 c0^2."""
		e = np.asarray(strain, float)
		return -self.rho0 * self.c0**2 * e / np.where(e < 0, 1 + self.b * e, 1)**2

	def tangent(self, strain):
		"""dP/d(-e) [Pa]."""
		e = np.asarray(strain, float)
		return self.rho0 * self.c0**2 * np.where(e < 0, (1 - self.b * e) / (1 + self.b * e)**3, 1)

	def energy(self, strain):
		"""Stored energy per rest volume, -int P de [J/m3]."""
		e = np.asarray(strain, float)
		x = np.where(e < 0, self.b * e, 0)
		# (ln(1+x) - x/(1+x))/x^2, which cancels for small x: its series there
		series = 0.5 - 2 * x / 3 + 0.75 * x**2 - 0.8 * x**3 + 5 * x**4 / 6
		y = np.where(abs(x) < 1e-3, -0.5, x)
		return self.rho0 * self.c0**2 * e**2 * np.where(abs(x) < 1e-3, series, (np.log1p(y) - y / (1 + y)) / y**2)


def impedanceMatch(flyer, target, speed):
	"""Flyer at `speed` [m/s] on a target at rest, Hugoniots without strength, by reflection of the flyer's.

	Returns a dict: u [m/s] of the interface, P [Pa], shock speeds D [m/s] in both (in the flyer: relative to its own material), and
	rho/rho0 in both.
	"""
	u = brentq(lambda v: target.pressure(v) - flyer.pressure(speed - v), 0, speed, xtol=1e-14 * speed, rtol=8.9e-16)
	w = speed - u
	return dict(u=u, P=target.pressure(u), targetD=target.shockSpeed(u), flyerD=flyer.shockSpeed(w), targetRatio=target.density(u) / target.rho0,
	            flyerRatio=flyer.density(w) / flyer.rho0)


def elasticLimit(Y, poisson):
	"""Hugoniot elastic limit Y (1 - nu)/(1 - 2 nu) of small strains: axial stress at yield in uniaxial strain [Pa]."""
	return Y * (1 - poisson) / (1 - 2 * poisson)


def piston(rho0, c0, b, G, Y, speed, gruneisen=None, constantGamma=False):
	"""Piston driven at `speed` [m/s] into a half-space of hypoelastic, perfectly plastic material with a shock adiabat.

	The deviator grows with the logarithmic strain, s = (4/3) G ln(rho/rho0), up to 2 Y/3. Jump conditions across the elastic precursor and
	the plastic shock (Udaykumar et al. 2003; the verification problem "EPpiston" of ExactPack). Units SI.
	gruneisen      None: P(strain) of the adiabat alone. A number Gamma0: Mie-Grueneisen, P = P_H + Gamma rho (e - e_H), e_H on the adiabat
	constantGamma  False: Gamma rho = Gamma0 rho0, as the solvers have it. True: Gamma = Gamma0
	Returns a dict: waves ('elastic', 'two' or 'overdriven'); precursor speed `precursorD`, state behind it `precursorU`, `HEL` (axial stress),
	`precursorRho`, `precursorP`; plastic shock `D` (in the laboratory), and the state at the piston `P`, `sigma` (axial), `rho`, `e` [J/kg].
	"""
	h = Hugoniot(rho0, c0, b)

	gamma = gruneisen or 0.

	def thermal(rho):
		"""Gamma rho: pressure per specific energy."""
		return gamma * (rho if constantGamma else rho0)

	def pressure(rho, e):
		return float(h.adiabat(rho0 / rho - 1)) * (1 - 0.5 * thermal(rho) * (1 / rho0 - 1 / rho)) + thermal(rho) * e

	def behind(rho, s, before):
		"""State behind a shock into `before` (rho, sigma, u, e) that reaches density rho with deviatoric axial stress s, and the shock's speed."""
		r1, sig1, u1, e1 = before
		dv = 1 / r1 - 1 / rho
		cold = pressure(rho, 0.) + s
		e = (e1 + 0.5 * (sig1 + cold) * dv) / (1 - 0.5 * thermal(rho) * dv)  # energy jump, linear in e
		sigma = cold + thermal(rho) * e
		mass = math.sqrt(max((sigma - sig1) / dv, 0.))  # mass flux through the shock
		return (rho, sigma, u1 + mass * dv, e), u1 + mass / r1

	rest = (rho0, 0., 0., 0.)
	yieldRho = rho0 * math.exp(Y / (2 * G)) if G > 0 else rho0
	elastic = lambda rho: behind(rho, 4 / 3 * G * math.log(rho / rho0), rest)
	def solve(state, low):
		error = lambda rho: state(rho)[0][2] - speed
		high = low
		while error(high) < 0:  # the shock adiabat ends at 1/(1 - 1/b): go there in steps of what is left
			high += 0.1 * ((rho0 * b / (b - 1) if b > 1 else 1e3 * rho0) - high)
		return brentq(error, low, high, xtol=1e-14 * rho0, rtol=8.9e-16)

	def result(waves, pre, preD, end, D):
		return dict(waves=waves, precursorD=preD, precursorU=pre[2], HEL=pre[1], precursorRho=pre[0], precursorP=pressure(pre[0], pre[3]), D=D,
		            P=pressure(end[0], end[3]), sigma=end[1], rho=end[0], e=end[3])

	if yieldRho > rho0 * (1 + 1e-15):
		pre, preD = elastic(yieldRho)
		if speed <= pre[2]:
			end, D = elastic(brentq(lambda rho: elastic(rho)[0][2] - speed, rho0 * (1 + 1e-12), yieldRho))
			return result('elastic', end, D, end, D)
	else:
		pre, preD = rest, 0.
	plastic = lambda rho: behind(rho, 2 / 3 * Y, pre)
	end, D = plastic(solve(plastic, pre[0] * (1 + 1e-9)))
	if yieldRho > rho0 and D < preD:
		return result('two', pre, preD, end, D)
	single = lambda rho: behind(rho, 2 / 3 * Y, rest)
	end, D = single(solve(single, max(yieldRho, rho0 * (1 + 1e-9))))
	return result('overdriven', end, D, end, D)
