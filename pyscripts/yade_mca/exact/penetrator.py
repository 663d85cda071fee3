# SPDX-License-Identifier: GPL-2.0-or-later
"""Alekseevskii-Tate model of a long rod (Alekseevskii 1966; Tate 1967), solved exactly as far as integrals go (Segletes & Walters 2003)."""
import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq


@dataclass(frozen=True)
class Tate:
	"""Rod of strength Y eroding against a target of resistance R.

	    Y + rhoP (v - u)^2/2 = R + rhoT u^2/2,   dL/dt = -(v - u),   rhoP L dv/dt = -Y,   dP/dt = u
	"""
	rhoP: float  #: density of the rod [kg/m3]
	rhoT: float  #: density of the target [kg/m3]
	Y: float  #: strength of the rod [Pa], above 0
	R: float  #: resistance of the target [Pa]

	def penetrationSpeed(self, v):
		"""u [m/s] for tail speed v [m/s]; 0 below the speed at which the rod begins to penetrate."""
		v = np.asarray(v, float)
		m, a = self.rhoT / self.rhoP, 2 * (self.R - self.Y) / self.rhoP
		# (v - u)^2 - m u^2 = a; the root with u <= v
		if abs(1 - m) < 1e-12:
			u = (v * v - a) / (2 * np.maximum(v, 1e-300))
		else:
			u = (v - np.sqrt(np.maximum(m * v * v + (1 - m) * a, 0))) / (1 - m)
		return np.clip(u, 0, v)

	def erosion(self, v0, v):
		"""Length over initial length of the rod when its tail has slowed from v0 to v [m/s]: exp(-(rhoP/Y) int (v - u) dv)."""
		return math.exp(-self.rhoP / self.Y * quad(lambda w: w - float(self.penetrationSpeed(w)), v, v0, epsabs=0, epsrel=1e-12)[0])

	def _along(self, v0, v, integrand):
		"""int over time of integrand(v) per initial length, with dt = -(rhoP/Y) L dv. The length is integrated along."""
		from scipy.integrate import solve_ivp

		def rate(w, y):
			length = math.exp(y[0])
			return [self.rhoP / self.Y * (w - float(self.penetrationSpeed(w))), -self.rhoP / self.Y * length * integrand(w)]

		return solve_ivp(rate, (v0, v), [0., 0.], method='DOP853', rtol=1e-11, atol=1e-14).y[1, -1]

	def depth(self, v0, v):
		"""Penetration over initial length when the tail has slowed from v0 to v [m/s]."""
		return self._along(v0, v, lambda w: float(self.penetrationSpeed(w)))

	def time(self, v0, v):
		"""Time over initial length [s/m] in which the tail slows from v0 to v [m/s]."""
		return self._along(v0, v, lambda w: 1.)

	def stopSpeed(self):
		"""Tail speed [m/s] at which either penetration (R > Y) or erosion (Y > R) ends."""
		return math.sqrt(2 * abs(self.R - self.Y) / (self.rhoP if self.R > self.Y else self.rhoT))


def tatePlate(length, thickness, speed, rhoP, rhoT, Y, R):
	"""Rod of `length` [m] at `speed` [m/s] through a plate: the model of a half-space, stopped when u has covered `thickness` [m].

	Returns a dict: perforates (bool), velocityLoss (U0 - U)/U0 of the tail, lengthLoss (l0 - l)/l0 [-] and time [s].
	The release at the rear face is not in the model, so the losses are upper estimates.
	"""
	t = Tate(rhoP, rhoT, Y, R)
	low = t.stopSpeed() * (1 + 1e-9)
	if speed <= low or length * t.depth(speed, low) < thickness:
		v = min(low, speed)
		return dict(perforates=False, velocityLoss=1 - v / speed, lengthLoss=1 - t.erosion(speed, v), time=length * t.time(speed, v))
	v = brentq(lambda w: length * t.depth(speed, w) - thickness, low, speed * (1 - 1e-12), xtol=1e-10 * speed)
	return dict(perforates=True, velocityLoss=1 - v / speed, lengthLoss=1 - t.erosion(speed, v), time=length * t.time(speed, v))
