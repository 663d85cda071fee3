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


def test_every_toughness_belongs_to_a_metal_and_has_a_source():
	rows = list(csv.DictReader(line for line in open(materials.TOUGHNESS) if not line.startswith('#')))
	assert rows and len({r['name'] for r in rows}) == len(rows)
	for r in rows:
		assert r['name'] in names() and 5e6 < float(r['K_Ic']) < 300e6 and r['condition'] and r['source'], r
		m = get(r['name'])
		assert m.fractureToughness == float(r['K_Ic']) and r['source'] in m.toughnessSource and r['condition'] in m.toughnessSource
		assert get(r['name'], yieldModel='elastic').fractureToughness == m.fractureToughness
	for name in set(names()) - {r['name'] for r in rows}:
		assert math.isnan(get(name).fractureToughness) and get(name).toughnessSource == ''
	assert all(get(n).fractureEnergy == 0 for n in names())  # pairs part at once unless a script says otherwise


def test_energy_from_toughness():
	# 4340: K = 7830 4578^2 = 164.102 GPa, G = 80 GPa, so E = 9KG/(3K+G) = 206.4515 GPa, nu = E/2G - 1 = 0.290322
	assert get('4340').toughnessEnergy == pytest.approx(87.4e6**2 * (1 - 0.290322**2) / 206.4515e9, rel=1e-5)  # 33.9 kJ/m2
	assert get('Ta', fractureToughness=50e6).toughnessEnergy > 0
	for args, words in ((dict(name='OFHC_Cu'), 'no fracture toughness.*fractureEnergy'), (dict(name='W_LASL', fractureToughness=8e6), 'shearModulus'),
	                    (dict(name='4340', fractureToughness=50e6, shearModulus=0.), 'shearModulus')):
		with pytest.raises(MaterialError, match=words):
			get(**args).toughnessEnergy
	for wrong in (-50e6, 0., math.inf, '50e6', None):
		with pytest.raises(MaterialError, match='fractureToughness'):
			get('4340', fractureToughness=wrong)


def test_longest_spacing():
	m = get('4340', fractureEnergy=33e3, spallStrength=2e9, fractureStress=3e9, strengthRatio=2.)
	modulus = 7830 * 4578**2 + 4 / 3 * 80e9  # 270.77 GPa
	assert m.longestSpacing() == m.longestSpacing(2) == pytest.approx(2 * modulus * 33e3 / (1.1547005383792517 * 4e18), rel=1e-12)  # 3.869 mm
	assert m.longestSpacing(3) == pytest.approx(2 * modulus * 33e3 / (1.224744871391589 * 4e18), rel=1e-12)
	assert get(m, fractureStress=8e9).longestSpacing() == pytest.approx(m.longestSpacing() / 4, rel=1e-12)  # 8 GPa / 2 counts
	assert get(m, pairStrength=1e9).longestSpacing() == m.longestSpacing()
	assert get(m, pairStrength=4e9).longestSpacing() == pytest.approx(m.longestSpacing() / 4)
	assert get(m, fractureEnergy=0.).longestSpacing() == get('4340', fractureEnergy=33e3).longestSpacing(3) == get('W_LASL').longestSpacing() == math.inf
	for wrong in (1, 4, 2.5, True, None, '2', [2]):
		with pytest.raises(MaterialError, match='dimension must be 2 or 3; got'):
			m.longestSpacing(wrong)
	with pytest.raises(MaterialError, match='shearModulus'):
		get('W_LASL', fractureEnergy=1e3, spallStrength=1e9).longestSpacing()


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
