# SPDX-License-Identifier: GPL-2.0-or-later
"""The material library: complete, sourced, refusing what is wrong, and equal to the wave speeds computed elsewhere."""
import csv
import math

import numpy as np
import pytest

from support import DATA
from yade_mca import materials
from yade_mca.materials import MaterialError, get, mcaMat, names


def test_every_record_is_complete_and_sourced():
	assert {'WHA_JC', '4340', 'OFHC_Cu', 'Al6061_T6'} <= set(names())
	for n in names():
		m = get(n)
		assert m.eosSource and m.density > 1000 and m.bulkSoundSpeed > 1000 and 1 < m.hugoniotSlope < 2
		assert m.yieldModel == 'elastic' or m.strengthSource
		if not math.isnan(m.shearModulus):
			assert 0 < m.poisson < 0.45 and m.cS < m.cP < 1.5e4
			assert m.cP**2 - 4 / 3 * m.cS**2 == pytest.approx(m.bulkSoundSpeed**2, rel=1e-12)
			assert m.young == pytest.approx(2 * m.shearModulus * (1 + m.poisson), rel=1e-12)


def test_wave_speeds_against_table():
	table = {r['material']: r for r in csv.DictReader(open(DATA / 'wave_speeds.csv'))}
	for name, row in (('WHA_JC', 'WHA JC (K=rho c0^2)'), ('WHA95_SG', 'WHA SG 18.167'), ('W_pure', 'W pure'), ('OFHC_Cu', 'Cu SG'), ('Al6061_T6', 'Al 6061 SG')):
		m, t = get(name), table[row]
		for value, key, unit in ((m.density, 'rho', 1), (m.bulkModulus, 'K_GPa', 1e9), (m.shearModulus, 'G_GPa', 1e9), (m.cP, 'cP', 1), (m.cS, 'cS', 1)):
			assert value == pytest.approx(float(t[key]) * unit, rel=1e-5), (name, key)
		assert m.poisson == pytest.approx(float(t['nu']), abs=1e-5)


def test_rod_and_plate_of_the_main_job():
	rod, plate = get('WHA_JC'), get('4340')
	assert (rod.yieldStress, rod.hardeningModulus, rod.hardeningExponent, rod.rateCoefficient, rod.thermalSoftening) == (1506e6, 177e6, 0.12, 0.016, 1.0)
	assert (plate.yieldStress, plate.hardeningModulus, plate.hardeningExponent, plate.rateCoefficient, plate.thermalSoftening) == (792e6, 510e6, 0.26, 0.014, 1.03)
	# Johnson & Cook 1983: at the melt temperature nothing is left, at rate 1/s and 298 K the static curve
	assert rod.flowStress(0.5, 1.0, 298.0) == pytest.approx(1506e6 + 177e6 * 0.5**0.12)
	assert plate.flowStress(0.2, 1e4, 1793.0) == 0
	assert plate.flowStress(0.0, math.e) == pytest.approx(792e6 * 1.014)


@pytest.mark.parametrize('name', [n for n in names() if get(n).yieldModel != 'elastic'])
def test_simpler_yield_models_follow_the_full_curve(name):
	full, line, perfect = get(name), get(name, yieldModel='linearHardening'), get(name, yieldModel='perfect')
	strain = np.linspace(0, materials.FIT_STRAIN, 101)
	if full.yieldModel == 'johnsonCook':
		difference = line.flowStress(strain) - full.flowStress(strain)
		assert abs(difference.mean()) < 0.01 * full.yieldStress  # least squares: no bias
		assert abs(difference[10:]).max() < 0.12 * full.flowStress(strain).max()
	assert line.hardeningModulus >= 0 and line.rateCoefficient == 0
	assert perfect.hardeningModulus == 0 and perfect.yieldStress <= line.flowStress(materials.FIT_STRAIN)
	assert get(name, yieldModel='elastic').yieldStress == math.inf


def test_overrides_and_variants():
	m = get('WHA_JC', yieldModel='perfect', yieldStress=1e9, fractureStrain=1.0)
	assert (m.yieldModel, m.yieldStress, m.hardeningModulus, m.fractureStrain) == ('perfect', 1e9, 0.0, 1.0)
	assert get(m, density=18000.).density == 18000. and get(m).yieldModel == 'perfect'
	assert get('W_LASL', yieldModel='perfect', yieldStress=1e9, shearModulus=160e9).yieldStress == 1e9


@pytest.mark.parametrize('args, words', [
        (dict(name='WHA'), "did you mean"),
        (dict(name='4340', yieldModel='plastic'), 'perfect'),
        (dict(name='4340', yieldStres=1e9), "yieldStress"),
        (dict(name='4340', yieldStress=-1e9), '0 or above'),
        (dict(name='4340', hugoniotSlope=-1.), '0 or above'),
        (dict(name='4340', density=float('nan')), 'above 0'),
        (dict(name='4340', eos='tillotson'), 'mieGruneisen'),
        (dict(name='4340', strengthRatio=0.5), 'compression strength'),
        (dict(name='W_LASL', yieldModel='perfect'), 'no strength data'),
        (dict(name='Ta', yieldModel='johnsonCook'), 'no Johnson-Cook'),
])
def test_errors_name_the_remedy(args, words):
	with pytest.raises(MaterialError, match=words):
		get(**args)


def test_equation_of_state_alone_makes_no_solid():
	with pytest.raises(MaterialError, match='shearModulus'):
		mcaMat('W_LASL')


def test_johnson_cook_fracture_strain():
	# 4340, quasi-static, room temperature, triaxiality 1/3 (tension bar): 0.05 + 3.44 exp(-2.12/3)
	assert get('4340').johnsonCookFractureStrain(1 / 3) == pytest.approx(0.05 + 3.44 * math.exp(-2.12 / 3))
	with pytest.raises(MaterialError):
		get('Ta').johnsonCookFractureStrain(0.)


def test_mca_mat_has_all_constants_and_the_same_flow_stress(plugin):
	for name in names():
		m = get(name)
		if math.isnan(m.shearModulus):
			continue
		y = mcaMat(name)
		for key in materials.MCAMAT_ATTRIBUTES:
			assert getattr(y, key) == getattr(m, key), (name, key)
		assert y.label == name and y.cP == pytest.approx(m.cP, rel=1e-12) and y.cS == pytest.approx(m.cS, rel=1e-12)
		for e, rate, temperature in ((0., 1., 298.), (0.3, 1e4, 500.), (1., 1e6, 1200.)):
			expected = m.flowStress(e, rate, temperature)
			assert y.flowStress(e, rate, temperature) == pytest.approx(expected, rel=1e-9) or math.isinf(expected)


def test_library_covers_every_constant_of_mca_mat(plugin):
	own = set(plugin.McaMat().dict()) - set(plugin.FrictMat().dict()) if hasattr(plugin, 'FrictMat') else set(plugin.McaMat().dict())
	assert own - {'id', 'label', 'young', 'poisson'} <= set(materials.MCAMAT_ATTRIBUTES)
