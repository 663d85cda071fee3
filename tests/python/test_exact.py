# SPDX-License-Identifier: GPL-2.0-or-later
"""The exact solutions agree with independently computed tables and with their own defining equations."""
import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from support import table
from yade_mca.exact import (Hugoniot, Tate, chainReflection, elasticLimit, freeBeam, hexagonalSpeeds, hexagonalStableStep, impedanceMatch, kirsch,
                            lambSurface, piston, rayleighSpeed, shellStopRadius, shellVelocity, tatePlate, tiedRowReflection)
from yade_mca.exact.lattice import ROW
from yade_mca.materials import get


@settings(max_examples=50)
@given(u=st.floats(0.1, 3000), b=st.floats(0, 2), c0=st.floats(1000, 8000), rho0=st.floats(1000, 2e4))
@example(u=998., b=0., c0=1000., rho0=1000.)
def test_hugoniot_obeys_the_jump_conditions_and_its_adiabat(u, b, c0, rho0):
	h = Hugoniot(rho0, c0, b)
	assume(u < 0.999 * h.shockSpeed(u))  # beyond, the material would be compressed to nothing
	D, rho = h.shockSpeed(u), h.density(u)
	assert rho0 * D == pytest.approx(rho * (D - u), rel=1e-12)
	assert h.adiabat(h.strain(u)) == pytest.approx(h.pressure(u), rel=1e-10)
	e, step = h.strain(u), 1e-6 * h.strain(u)
	slope = (h.adiabat(e - step) - h.adiabat(e + step)) / (2 * step)
	assert h.tangent(e) == pytest.approx(slope, rel=1e-5)
	n, w = np.polynomial.legendre.leggauss(40)
	assert h.energy(e) == pytest.approx(-0.5 * e * w @ h.adiabat(0.5 * e * (n + 1)), rel=1e-8)


@pytest.mark.parametrize('u', [1000., 2000., np.array([10., 1000.]), float('nan')])
def test_no_shock_compresses_to_nothing(u):
	h = Hugoniot(7830, 1000., 0.)
	for what in (h.strain, h.density):
		with pytest.raises(ValueError, match='below the shock speed'):
			what(u)
	assert h.density(999.) == pytest.approx(1000 * 7830)


def test_tension_is_linear():
	h = Hugoniot(7830, 4578, 1.33)
	assert h.adiabat(0.01) == pytest.approx(-7830 * 4578**2 * 0.01) and h.energy(0.01) == pytest.approx(0.5 * 7830 * 4578**2 * 1e-4)


def test_impedance_match():
	names = {'WHA 17.6': 'WHA_JC', '4340 steel': '4340', 'Cu': 'OFHC_Cu', 'Al2024': 'Al2024_T4'}
	for r in table('impedance_match.csv'):
		m = impedanceMatch(*(Hugoniot.of(get(names[r[k]])) for k in ('flyer', 'target')), float(r['V_ms']))
		for key, column, unit in (('u', 'u_interface_ms', 1), ('P', 'P_GPa', 1e9), ('targetD', 'Us_target_ms', 1), ('flyerD', 'Us_flyer_ms', 1),
		                          ('targetRatio', 'rho_ratio_target', 1), ('flyerRatio', 'rho_ratio_flyer', 1)):
			assert m[key] == pytest.approx(float(r[column]) * unit, rel=1e-5), (r, key)


COLUMNS = (('precursorD', 'c_elastic_jump_ms', 1), ('precursorU', 'v_precursor_ms', 1), ('HEL', 'HEL_axial_GPa', 1e9), ('precursorRho', 'rho_precursor', 1),
           ('precursorP', 'p_precursor_GPa', 1e9), ('D', 'D_plastic_ms', 1), ('P', 'p2_GPa', 1e9), ('sigma', 'sigma2_GPa', 1e9), ('rho', 'rho2', 1),
           ('e', 'e2_kJkg', 1e3))


def test_elastic_plastic_piston():
	for r in table('ep_piston_exact.csv'):
		f = {k: float(v) for k, v in r.items() if k != 'case'}
		p = piston(f['rho0'], f['c0'], f['s'], f['G_GPa'] * 1e9, f['Y_GPa'] * 1e9, f['piston_ms'], f['Gamma'], constantGamma=True)
		assert p['waves'] == 'two'
		for key, column, unit in COLUMNS:
			assert p[key] == pytest.approx(f[column] * unit, rel=3e-5), (r['case'], key)
		near = piston(f['rho0'], f['c0'], f['s'], f['G_GPa'] * 1e9, f['Y_GPa'] * 1e9, f['piston_ms'], f['Gamma'])
		assert near['D'] == pytest.approx(p['D'], rel=2e-4) and near['D'] != p['D']  # Gamma rho constant: close, not the same


def test_piston_limits():
	args = dict(rho0=7830., c0=4578., b=1.33, G=80e9)
	weak = piston(Y=0.792e9, speed=1., **args)
	assert weak['waves'] == 'elastic' and weak['D'] == pytest.approx(get('4340').cP, rel=1e-3)
	fluid = piston(Y=0., speed=500., **args)
	assert fluid['D'] == pytest.approx(4578 + 1.33 * 500, rel=1e-9) and fluid['P'] == pytest.approx(fluid['sigma'])
	assert piston(Y=0.792e9, speed=2000., **args)['waves'] == 'overdriven'


def test_elastic_limit_of_small_strains():
	for r in table('hel.csv'):
		value = [float(v) for k, v in r.items() if k != 'material']
		assert elasticLimit(value[0], value[1]) == pytest.approx(value[2], rel=3e-4)  # nu has four digits there
	p = piston(7830., 4578., 1.33, 80e9, 1e5, 100.)  # small yield stress, so small strains
	assert p['HEL'] == pytest.approx(elasticLimit(1e5, get('4340').poisson), rel=1e-5)


def test_rayleigh_speed():
	for r in table('rayleigh_vs_nu.csv'):
		nu = float(r['nu'])
		ratio = math.sqrt((1 - 2 * nu) / (2 - 2 * nu)) if nu < 0.5 else 1e-6
		assert rayleighSpeed(1., ratio) / ratio == pytest.approx(float(r['cR_over_cS']), abs=1e-8)


def test_lamb_surface_displacement():
	d = np.array([[float(v) for v in r.values()] for r in table('lamb_surface_50mm.csv')])[::5]
	uz, ux = lambSurface(d[:, 0] * 1e-6, 0.05, 7830., 5979.92, 3196.42, 200e3, 6e-6)
	for mine, column in ((uz, 1), (ux, 2)):
		assert abs(mine - d[:, column]).max() < 1e-6 * abs(d[:, column]).max()


def test_phase_speeds_of_the_hexagonal_packing():
	known = {6: (0.926, 0.983), 10: (0.972, 0.994), 20: (0.993, 0.9985), 40: (0.998, 0.9996)}
	for angle in (0, math.pi / 6, 0.2):
		for length, (p, s) in known.items():
			assert hexagonalSpeeds(length, 0.3, angle) == pytest.approx((p, s), abs=8e-4)
	# second order: the error falls by four when the wave is twice as long; the long wave sees an isotropic continuum
	errors = 1 - np.array(hexagonalSpeeds([40, 80], 0.2, 0.3))
	assert errors[:, 0] / errors[:, 1] == pytest.approx([4, 4], rel=0.01)


def test_largest_stable_step_of_the_hexagonal_packing():
	assert hexagonalStableStep(0.3) == pytest.approx(1.32, abs=0.005)


def test_reflection_at_the_tied_row():
	cells = {'h=0.866d': ROW, 'h=d': 1., 'h=2d': 2., 'h=4d': 4.}
	for r in table('reflection_1d_exact.csv'):
		for column, value in r.items():
			if column != 'lambda_over_d':
				size, mass = column.split()
				assert tiedRowReflection(float(r['lambda_over_d']), cells[size], mass) == pytest.approx(float(value), abs=6e-6)


def test_reflection_from_graded_grids():
	grids = {'abrupt_4d': [4.], 'g=2 (1;2;4)': [1., 2., 4.], 'g=1.26 (6 steps)': [4**(i / 6) for i in range(7)], 'g=1.1 (14 cells)': [1.1**i for i in range(15)] + [4.]}
	for r in table('reflection_1d_graded.csv'):
		for column, cells in grids.items():
			assert chainReflection(float(r['lambda_over_d']), cells) == pytest.approx(float(r[column]), rel=0.02, abs=1e-4), (r, column)


def test_reflection_keeps_energy_where_the_grid_carries_the_wave():
	# the same chain goes on: nothing is reflected whatever the grading inside reads
	assert chainReflection([5., 9., 30.], [ROW, ROW, ROW]) == pytest.approx(0, abs=1e-13)
	assert chainReflection([6., 8.], [4.]) == pytest.approx(1)  # beyond the cut-off of the coarse grid


TATE = dict(rhoP=17600., rhoT=7830., Y=1.5e9, R=5e9)


def test_tate_against_known_results_and_direct_integration():
	for thickness, loss, length in ((15e-3, 0.013, 0.166), (25e-3, 0.023, 0.277), (40e-3, 0.042, 0.447)):
		p = tatePlate(0.1, thickness, 1520., **TATE)
		assert p['perforates'] and p['velocityLoss'] == pytest.approx(loss, abs=1e-3) and p['lengthLoss'] == pytest.approx(length, abs=1e-3)
	t = Tate(**TATE)

	def rate(time, y):
		v, L = y[:2]
		u = float(t.penetrationSpeed(v))
		return [-t.Y / (t.rhoP * L), -(v - u), u]

	y = solve_ivp(rate, (0, p['time']), [1520., 0.1, 0.], rtol=1e-10, atol=1e-13).y[:, -1]
	assert y == pytest.approx([1520 * (1 - p['velocityLoss']), 0.1 * (1 - p['lengthLoss']), 40e-3], rel=1e-7)


def test_tate_limits():
	t = Tate(17600., 7830., 1.5e9, 5e9)
	u = t.penetrationSpeed(1520.)
	assert t.Y + 0.5 * t.rhoP * (1520 - u)**2 == pytest.approx(t.R + 0.5 * t.rhoT * u**2)
	assert Tate(8000., 8000., 1e9, 1e9).penetrationSpeed(1000.) == pytest.approx(500)  # equal densities, no strength: half the speed
	assert Tate(17600., 7830., 1., 1.).depth(3000., 2999.999) == pytest.approx(math.sqrt(17600 / 7830) * (1 - Tate(17600., 7830., 1., 1.).erosion(3000., 2999.999)), rel=1e-4)
	assert not tatePlate(0.1, 0.4, 1520., **TATE)['perforates']


def test_shell_collapse():
	for r in table('shell_collapse.csv'):
		args = float(r['rho']), float(r['Y_MPa']) * 1e6, float(r['Ri_mm']) * 1e-3, float(r['Ro_mm']) * 1e-3
		v = shellVelocity(*args, float(r['r_stop_mm']) * 1e-3)
		assert v == pytest.approx(float(r['V0_inner_ms']), rel=2e-5)
		assert shellStopRadius(*args, v) == pytest.approx(float(r['r_stop_mm']) * 1e-3, rel=1e-9)


def test_beam():
	"""Slender: the frequency of Euler and Bernoulli, in plane strain with E/(1 - nu^2); what shear and rotary inertia take off is of second order in the height."""
	slender = freeBeam(1., 1e-3, 7800., 2e11, 0.3, 'stress')
	assert slender == pytest.approx(22.373285448061 * 1e-3 * math.sqrt(2e11 / (12 * 7800.)), rel=1e-4)
	assert freeBeam(1., 1e-3, 7800., 2e11, 0.3) / slender == pytest.approx(1 / math.sqrt(1 - 0.09), rel=1e-4)
	w = [freeBeam(1., h, 7800., 2e11, 0.29) / h for h in (1e-3, 0.02, 0.04)]
	assert (w[0] - w[2]) / (w[0] - w[1]) == pytest.approx(4, rel=0.03)
	with pytest.raises(ValueError, match='height/length = 0.5'):
		freeBeam(1., 0.5, 7800., 2e11, 0.3)


def test_kirsch():
	"""Three times the tension at the sides of the hole, minus one at its ends; far away a uniform field; displacement and stress by Hooke's law."""
	nu = 0.29
	at = lambda x, y: [v[0] for v in kirsch(np.array([x]), np.array([y]), 1., nu)]
	for (x, y), S in (((0., 1.), 3.), ((1., 0.), -1.)):
		_, mean, mises = at(x, y)
		assert mean == pytest.approx(S * (1 + nu) / 3) and mises == pytest.approx(abs(S) * math.sqrt(1 - nu + nu**2))
	assert at(300., 200.)[1] == pytest.approx((1 + nu) / 3, rel=1e-4)
	rng, h = np.random.default_rng(1), 1e-5
	for r, a in zip(rng.uniform(1.1, 4, 20), rng.uniform(0, 7, 20)):
		x, y = r * math.cos(a), r * math.sin(a)
		dx, dy = ((at(x + p, y + q)[0] - at(x - p, y - q)[0]) / (2 * h) for p, q in ((h, 0), (0, h)))
		exx, eyy, exy = dx[0], dy[1], 0.5 * (dx[1] + dy[0])  # times 2G
		theta = exx + eyy
		s = np.array((exx - theta / 3, eyy - theta / 3, -theta / 3))
		assert at(x, y)[1] == pytest.approx(theta * (1 + nu) / (3 * (1 - 2 * nu)), rel=1e-6, abs=1e-7)
		assert at(x, y)[2] == pytest.approx(math.sqrt(1.5 * ((s**2).sum() + 2 * exy**2)), rel=1e-6)
