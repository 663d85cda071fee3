# SPDX-License-Identifier: GPL-2.0-or-later
"""The laws that scripts choose by name, on every road: flow stresses against the ordinary differential equation of a material point, an equation of state
against the jump conditions, both saved and loaded; and the table of laws that Python has against the library's.
"""
import json
import math
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from yade_mca import materials

D = 1e-3
SHEAR, DT, STEPS = 2e4, 2e-9, 1200  # rate of pure shear [1/s], step [s], steps: strain 0.048
#: material and flow stress of the library
FLOWS = [('OFHC_Cu', 'zerilliArmstrong'), ('Armco_iron', 'zerilliArmstrong'), ('OFHC_Cu', 'steinbergGuinan'), ('Al6061_T6', 'steinbergGuinan'), ('OFHC_Cu', 'johnsonCook')]
INVISCID = dict(viscosityLinear=0., viscosityQuadratic=0.)


def published(m, ep, rate, T):
	"""Flow stress [Pa] by the equations (11a), (11c), (11d), written here for themselves."""
	rate = max(rate, 1.)
	if m.yieldModel == 'zerilliArmstrong':
		hot = (m.thermalStress + m.thermalHardening * math.sqrt(ep)) * math.exp(-m.thermalDecay * T + m.rateDecay * T * math.log(rate))
		return m.yieldStress + hot + m.hardeningModulus * ep**m.hardeningExponent
	if m.yieldModel == 'steinbergGuinan':
		return min(m.yieldStress * (1 + m.strainFactor * ep)**m.hardeningExponent, m.largestYieldStress) * (1 - m.softeningPerKelvin * (T - 298.))
	static = m.yieldStress + m.hardeningModulus * ep**m.hardeningExponent
	return static * (1 + m.rateCoefficient * math.log(rate)) * (1 - ((T - 298.) / (m.meltTemperature - 298.))**m.thermalSoftening)


def pointInShear(m):
	"""(Mises stress, plastic strain, temperature) of a material point at the end, from d sigma/dt = 3G (rate - plastic rate), sigma = Y."""
	def speed(t):
		"""Rate of the equivalent strain: the velocities are those of the first moment, the body stretches meanwhile."""
		a, b = SHEAR / (1 + SHEAR * t), -SHEAR / (1 - SHEAR * t)
		return math.sqrt(2 / 3 * (a * a + b * b - (a + b)**2 / 3))

	def rates(t, y):
		sigma, ep, T = y
		# the plastic rate at which sigma is the flow stress; below the slowest one none
		gap = lambda log: published(m, ep, math.exp(log), T) - sigma
		total = speed(t)
		if gap(0.) > 0: plastic = 0.
		elif gap(math.log(2 * total)) < 0: plastic = 2 * total
		else: plastic = math.exp(brentq(gap, 0., math.log(2 * total), xtol=1e-12))
		return [3 * m.shearModulus * (total - plastic), plastic, m.taylorQuinney * sigma * plastic / (m.density * m.heatCapacity)]

	if m.yieldModel == 'steinbergGuinan':  # no rate: sigma follows Y, the plastic rate is what is left of the total one
		return shearWithoutRate(m, speed)
	return solve_ivp(rates, (0, STEPS * DT), [0., 0., 298.], method='LSODA', rtol=1e-8, atol=[1., 1e-10, 1e-6], max_step=STEPS * DT / 500).y[:, -1]


def shearWithoutRate(m, speed):
	yields = published(m, 0., 1., 298.) / (3 * m.shearModulus)
	start = brentq(lambda t: t * speed(t) - yields, 0, STEPS * DT)

	def rates(t, y):
		ep, T = y
		sigma = published(m, ep, 1., T)
		h = 1e-7
		hard, heat = (published(m, ep + h, 1., T) - sigma) / h, (published(m, ep, 1., T + 1e-3) - sigma) / 1e-3
		perStrain = m.taylorQuinney * sigma / (m.density * m.heatCapacity)
		plastic = 3 * m.shearModulus * speed(t) / (3 * m.shearModulus + hard + heat * perStrain)
		return [plastic, perStrain * plastic]

	ep, T = solve_ivp(rates, (start, STEPS * DT), [0., 298.], rtol=1e-9, atol=[1e-11, 1e-7]).y[:, -1]
	return published(m, ep, 1., T), ep, T


def automata(road, m):
	"""The automata of a block that is driven in pure shear; (stress, strain, temperature) in its middle."""
	import law2_scene
	from yade import O
	from yade_mca import packings
	ids = packings.addBodies(packings.hexagonal(D, packings.Rectangle((0, 0), (7 * D, 7 * D))), m)
	for i in ids:
		s = O.bodies[i].state
		s.blockedDOFs = 'xyzXYZ'
		s.vel = (SHEAR * s.pos[0], -SHEAR * s.pos[1], 0)
	law2_scene.engines(road, DT)
	O.run(STEPS + 1, True)  # what a step has moved, the next one has the stress of
	if road == 'engine': O.engines[0].sync()
	s = min((O.bodies[i].state for i in ids), key=lambda s: s.pos.norm())
	return s.equivalentStress, s.plasticStrain, s.temperature


def cells(road, m):
	from yade import O
	from yade.wrapper import McaGridEngine
	e, x = McaGridEngine(adaptive=False), (np.arange(61) - 30) * D
	e.addRectangle(m, x.tolist(), x.tolist())
	X, Y = np.meshgrid(x, x)
	e.setVelocity(0, np.stack([SHEAR * X, -SHEAR * Y], axis=-1))
	O.engines, O.dt = [e], DT
	O.run(STEPS + 1, True)
	at = lambda what: float(np.asarray(e.view(0, what))[30, 30])
	xx, yy, xy = at('sxx'), at('syy'), at('sxy')
	return math.sqrt(3 * (xx * xx + yy * yy + xx * yy + xy * xy)), at('plasticStrain'), at('temperature')


@pytest.mark.parametrize('road', ['engine', 'law2', 'grid'])
@pytest.mark.parametrize('name, law', FLOWS)
def test_flowStressOfAMaterialPoint(plugin, road, name, law):
	"""All at once: law, return, rate of the step, heating. The roads take 1200 steps, the equation as many as it wants."""
	m = materials.get(name, yieldModel=law, **INVISCID)
	expected = pointInShear(m)
	found = (cells if road == 'grid' else automata)(road, materials.mcaMat(m))
	assert expected[1] > 0.03 and expected[2] > 298.5
	for a, b, tolerance in zip(found, expected, (2e-3, 1e-3, 1e-3 * 298 / expected[2])):
		assert a == pytest.approx(b, rel=tolerance), (found, expected)


def test_flowStressOfTheLibraryIsThePublishedOne(plugin):
	for name, law in FLOWS:
		m = materials.get(name, yieldModel=law)
		for ep, rate, T in ((0.01, 1., 298.), (0.3, 1e4, 500.), (1., 1e6, 700.)):
			assert m.flowStress(ep, rate, T) == pytest.approx(published(m, ep, rate, T), rel=1e-9), (name, law)
		assert m.flowStress([0.1, 0.2], temperature=[[300.], [400.], [500.]]).shape == (3, 2)


def hugoniot(m, up):
	"""(shock speed, pressure) of the polynomial (4c) by the jump conditions: momentum P = rho0 D u, energy E = rho0 u^2/2."""
	K = m.density * m.bulkSoundSpeed**2
	eos = lambda mu, E: K * mu + m.quadraticModulus * mu**2 + m.cubicModulus * mu**3 + (m.gruneisen + m.gruneisenSlope * mu) * E
	speed = brentq(lambda D: eos(1 / (1 - up / D) - 1, 0.5 * m.density * up**2) - m.density * D * up, m.bulkSoundSpeed, 4 * m.bulkSoundSpeed)
	return speed, m.density * speed * up


@pytest.mark.parametrize('name', ['OFHC_Cu', 'WHA_JC'])
@pytest.mark.parametrize('road', ['engine', 'grid'])
def test_shockOfThePolynomial(plugin, road, name):
	"""A piston of 1000 m/s into material without strength: front and pressure behind it, away from both ends."""
	from yade import O
	from yade_mca import scenes
	from yade_mca.tasks import trials
	from yade_mca.tasks.verify.automata_shocks import drive, between, crossing
	from yade_mca.tasks.verify.grid_shocks import LENGTH, middle, tube
	up = 1000.
	m = materials.get(name, eos='polynomial', yieldModel='perfect', yieldStress=1e6, shearModulus=1e9, viscosityLinear=1.)
	speed, P = hugoniot(m, up)
	assert P > 1.2 * m.bulkModulus * up / m.bulkSoundSpeed  # far from linear
	mat, found = materials.mcaMat(m), []
	if road == 'grid':
		run = tube(400, [(mat, 0., LENGTH, 400)])
		run.grid.prescribe(0, 'left', x=up)
		for share in (0.4, 0.7):
			trials.until(run, share * LENGTH / speed)
			x, v = run.grid.view(0, 'x')[1], run.grid.view(0, 'vx')[1]
			found.append((run.grid.time - 0.5 * O.dt, crossing(x, v, 0.5 * up)))
		behind = middle(trials.centres(run, 0)[0][0], np.array(run.grid.view(0, 'pressure')[0]), x[0], found[-1][1])
	else:
		bar = drive(mat, up, 0., 'affine', 250, 8)
		for share in (0.4, 0.7):
			trials.until(bar, share * 250 * D / speed)
			x, v, p = scenes.profile(bar, 'bar', 'vx', 'pressure')
			found.append((O.time - 0.5 * O.dt, crossing(x, v, 0.5 * up)))
		behind = between(x, p, x[0], found[-1][1])
	(t0, x0), (t1, x1) = found
	assert (x1 - x0) / (t1 - t0) == pytest.approx(speed, rel=0.01)
	assert behind == pytest.approx(P, rel=0.01)


def test_polynomialOfTheLibraryIsTheExpansionOfTheAdiabat(plugin):
	"""(4e) for copper; the published constants of the tungsten alloy are such an expansion, too."""
	for name, tolerance in (('OFHC_Cu', 1e-3), ('WHA_JC', 0.03)):
		m = materials.get(name, eos='polynomial')
		b, gamma, K = m.hugoniotSlope, m.gruneisen, m.bulkModulus
		assert m.quadraticModulus == pytest.approx(K * (2 * b - 1 - gamma / 2), rel=tolerance)
		assert m.cubicModulus == pytest.approx(K * ((b - 1) * (3 * b - 1) - gamma / 2 * (2 * b - 1)), rel=tolerance)


@pytest.mark.parametrize('law', materials.YIELD_MODELS)
@pytest.mark.parametrize('road', ['engine', 'law2', 'grid'])
def test_everyLawIsSavedAndLoaded(plugin, tmp_path, road, law):
	"""Every flow stress with every equation of state: what goes on after loading is what would have gone on."""
	import law2_scene
	from test_skipping import gridBar
	from yade import O
	strength = dict(yieldStress=0.1e9, hardeningModulus=0.3e9, hardeningExponent=0.3, rateCoefficient=0.02, strainFactor=40., largestYieldStress=0.6e9, softeningPerKelvin=4e-4,
	                thermalStress=0.3e9, thermalHardening=0.5e9, thermalDecay=3e-3, rateDecay=1e-4, meltTemperature=1356., heatCapacity=383.)
	for eos in materials.EOS_MODELS:
		O.reset()
		constants = dict(strength, yieldModel=law, eos=eos, gruneisen=2., quadraticModulus=134e9, cubicModulus=-42e9, gruneisenSlope=1.5)
		if road == 'grid':
			gridBar(30, materials.mcaMat('OFHC_Cu', **constants), pulse=400.)
			result = lambda: b''.join(np.asarray(O.engines[0].view(0, k)).tobytes() for k in ('x', 'vx', 'sxx', 'plasticStrain', 'pressure'))
		else:
			ids = law2_scene.impact(speed=500., n=4, **constants)
			law2_scene.engines(road, 5e-9)
			result = lambda: law2_scene.state(ids).tobytes()
		O.run(60, True)
		O.save(str(tmp_path / 'a.yade'))
		O.run(60, True)
		gone = result()
		O.load(str(tmp_path / 'a.yade'))
		O.run(60, True)
		assert result() == gone, eos


def test_tableOfLawsIsThatOfTheLibrary():
	build = os.environ.get('YADE_MCA_BUILD') or str(Path(__file__).resolve().parents[2] / 'build')
	printed = subprocess.run([build + '/plugin/mca_laws'], capture_output=True, text=True, check=True).stdout
	assert json.loads(printed) == materials.LAWS


def test_attributesOfMcaMatAreTheConstantsOfTheLaws(plugin):
	own = plugin.McaMat().dict()
	for name, c in materials.CONSTANTS.items():
		assert own[name] == c['default'] and '[%s]' % c['unit'] in getattr(plugin.McaMat, name).__doc__, name
	for attribute, kind in (('eos', 'eos'), ('yieldModel', 'yieldModel')):
		for law in materials.LAWS[kind]:
			assert "'%s'" % law['name'] in getattr(plugin.McaMat, attribute).__doc__
