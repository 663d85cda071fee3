# SPDX-License-Identifier: GPL-2.0-or-later
"""Library of materials: literature constants with their sources, as records and as YADE materials.

    >>> from yade_mca import materials
    >>> materials.names()
    ['304SS', '4340', ...]
    >>> rod = materials.get('WHA_JC')                               # a record, SI units
    >>> soft = materials.get('WHA_JC', yieldModel='linearHardening')   # a simpler variant of the same metal
    >>> m = materials.mcaMat('4340', fractureStrain=1.0)            # a yade McaMat, ready for O.materials.append

Everything is SI: kg, m, s, Pa, K. The numbers stand in ``data/materials.csv``, whose head names the sources. The bulk modulus of
a record is rho0 c0^2, the slope of its shock adiabat at rest; a static value from another source would make two numbers of one.
"""
import csv
import difflib
import json
import math
import reprlib
from dataclasses import dataclass, field, fields, make_dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from ._arguments import LARGEST, numbersOfAnyShape, refuse as refuseArgument

__all__ = ['Material', 'MaterialError', 'names', 'get', 'mcaMat', 'MCAMAT_ATTRIBUTES', 'YIELD_MODELS', 'EOS_MODELS', 'DAMAGE_MODELS']

DATA = Path(__file__).with_name('data') / 'materials.csv'
STRENGTH = Path(__file__).with_name('data') / 'law_constants.csv'
TOUGHNESS = Path(__file__).with_name('data') / 'fracture_toughness.csv'
#: laws and their constants as the library knows them, by kind ('eos', 'yieldModel'); written by the build (plugin/laws.cpp)
LAWS = json.loads(Path(__file__).with_name('data').joinpath('laws.json').read_text())
EOS_MODELS = tuple(law['name'] for law in LAWS['eos'])
YIELD_MODELS = tuple(law['name'] for law in LAWS['yieldModel'])
DAMAGE_MODELS = ('none', 'johnsonCook')
DISTRIBUTIONS = ('uniform', 'normal', 'weibull')
#: plastic strain up to which the straight line of ``linearHardening`` is fitted to the full curve [-]
FIT_STRAIN = 0.5
#: area of the pairs that a crack along the closest rows or planes cuts, over its own, by dimension [-]
FACETS = {2: 2 / math.sqrt(3), 3: math.sqrt(1.5)}


class MaterialError(ValueError):
	"""A material, attribute or value that the library cannot accept; the message says what is allowed."""


def _constants(kind):
	"""What the constants of the laws of one kind are, by name: {name: dict of unit, default, range, ends, text}."""
	return {c['name']: c for law in LAWS[kind] for c in law['constants']}


#: constants of all laws by name
CONSTANTS = {**_constants('eos'), **_constants('yieldModel')}
_LawConstants = make_dataclass('_LawConstants', [(name, float, float(c['default'])) for name, c in CONSTANTS.items()], frozen=True)


@dataclass(frozen=True, kw_only=True)
class Material(_LawConstants):
	"""One set of constants of one metal. Attributes up to `viscosityQuadratic`, and the constants of all laws (CONSTANTS), carry the names of McaMat's attributes."""
	name: str
	density: float  #: at rest [kg/m3]
	bulkSoundSpeed: float  #: c0 of the shock adiabat D = c0 + b U; the bulk modulus is density c0^2 [m/s]
	shearModulus: float  #: [Pa]; nan where the source gives none
	eos: str = 'shockAdiabat'  #: one of EOS_MODELS
	yieldModel: str = 'elastic'  #: one of YIELD_MODELS
	referenceTemperature: float = 298.0  #: initial temperature [K]
	heatCapacity: float = 0.0  #: [J/kg/K]
	taylorQuinney: float = 0.9  #: share of plastic work that heats (Taylor & Quinney 1934) [-]
	fractureStrain: float = math.inf  #: plastic strain at which a pair unlinks [-]
	spallStrength: float = math.inf  #: tensile pressure at which a pair unlinks [Pa]
	pairStrength: float = math.inf  #: tensile normal stress of a pair at which it unlinks [Pa]
	fractureStress: float = math.inf  #: Mises stress at which a pair unlinks; see strengthRatio [Pa]
	fractureEnergy: float = 0.0  #: G_f, work per area of crack until a broken pair has parted [J/m2]; 0: it parts at once; see toughnessEnergy
	strengthRatio: float = 1.0  #: a = sigma_c/sigma_t of the two-parameter criterion 0.5 (a+1) sigma_eq + 1.5 (a-1) sigma_m; 1: Mises [-]
	damageModel: str = 'none'  #: one of DAMAGE_MODELS; the library fills D1 ... D5 where it has them, whatever the model
	damageD1: float = 0.0  #: fracture strain of Johnson and Cook (1985): (D1 + D2 exp(D3 sigma_m/sigma_eq)) (1 + D4 ln rate) (1 + D5 T*) [-]
	damageD2: float = 0.0
	damageD3: float = 0.0
	damageD4: float = 0.0
	damageD5: float = 0.0
	strengthSpread: float = 0.0  #: relative standard deviation of the strengths from automaton to automaton [-]
	strengthDistribution: str = 'uniform'  #: one of DISTRIBUTIONS
	frictionAngle: float = math.atan(0.1)  #: dry metal on metal at high sliding speed, coefficient of the order of 0.1 (Bowden & Freitag 1958) [rad]
	viscosityLinear: float = 0.25  #: c1 of the pair viscosity [-]
	viscosityQuadratic: float = 1.2  #: c2 of the pair viscosity [-]
	# not attributes of McaMat
	staticBulkModulus: float = math.nan  #: from another source, for information only [Pa]
	johnsonCook: tuple = None  #: (A [Pa], B [Pa], n, C, m) or None
	steinbergGuinan: tuple = None  #: (Y0 [Pa], beta, n, Ymax [Pa]) or None
	lawConstants: dict = field(default_factory=dict)  #: {law: {constant: value in SI units}} of laws whose constants stand in law_constants.csv
	minimumPressure: float = 0.0  #: shock pressure from which on the adiabat holds [Pa]
	eosSource: str = ''
	strengthSource: str = ''
	fractureToughness: float = math.nan  #: K_Ic, for information and for toughnessEnergy [Pa m^0.5]; nan: not in the library
	toughnessSource: str = ''  #: publication of fractureToughness; the metal that was measured

	@property
	def bulkModulus(self):
		"""K = rho0 c0^2 [Pa]."""
		return self.density * self.bulkSoundSpeed**2

	@property
	def poisson(self):
		"""Poisson's ratio from K and G [-]."""
		k, g = self.bulkModulus, self.shearModulus
		return (3 * k - 2 * g) / (2 * (3 * k + g))

	@property
	def young(self):
		"""Young's modulus [Pa]."""
		k, g = self.bulkModulus, self.shearModulus
		return 9 * k * g / (3 * k + g)

	@property
	def cP(self):
		"""Longitudinal wave speed at rest [m/s]."""
		return math.sqrt((self.bulkModulus + 4 * self.shearModulus / 3) / self.density)

	@property
	def cS(self):
		"""Shear wave speed at rest [m/s]."""
		return math.sqrt(self.shearModulus / self.density)

	@property
	def cR(self):
		"""Speed of Rayleigh's surface wave [m/s]."""
		from .exact import rayleighSpeed
		return rayleighSpeed(self.cP, self.cS)

	@property
	def impedance(self):
		"""Acoustic impedance rho cP of longitudinal waves [Pa s/m]."""
		return self.density * self.cP

	@property
	def toughnessEnergy(self):
		"""Energy per area of crack from the toughness, K_Ic^2 (1 - nu^2)/E in plane strain (G. R. Irwin, J. Appl. Mech. 24, 1957, 361-364) [J/m2].

		What a script may give as fractureEnergy. Raises MaterialError where fractureToughness is not known or the metal has no shear modulus.
		"""
		if not self.fractureToughness > 0:
			raise MaterialError("material '%s' has no fracture toughness in the library; give fractureToughness [Pa m^0.5] or fractureEnergy" %
			                    self.name)
		if not self.shearModulus > 0:
			raise MaterialError("material '%s' has no shear modulus, so no energy follows from its toughness; give shearModulus [Pa]" % self.name)
		return self.fractureToughness**2 * (1 - self.poisson**2) / self.young

	@property
	def validTemperature(self):
		"""(lowest, highest) temperature of the yield law [K]: Johnson-Cook is defined between room and melt temperature."""
		return (self.referenceTemperature, self.meltTemperature)

	@property
	def validPressure(self):
		"""(lowest, highest) pressure of the shock adiabat [Pa]; above, P(eps) grows without limit where 1 + b eps = 0."""
		return (self.minimumPressure, math.inf)

	@property
	def validStrain(self):
		"""(lowest, 0) volume strain J - 1 at which the shock adiabat is finite [-]: lowest = -1/b."""
		return (-1 / self.hugoniotSlope if self.hugoniotSlope > 0 else -1.0, 0.0)

	def longestSpacing(self, dimension=2):
		"""Largest diameter of automata at which the strengths fit fractureEnergy: 2 M G_f/(facets strength^2), M = rho0 cP^2 [m].

		With larger ones a pair holds more elastic energy as it breaks than the crack may cost, and the engine refuses them. The strength is the largest
		finite one of spallStrength, pairStrength and fractureStress/strengthRatio; `facets` is 2/sqrt(3) in the plane and sqrt(3/2) in space (FACETS).
		Infinite where no strength is finite or fractureEnergy is 0. Raises MaterialError for a dimension other than 2 and 3 and for a metal without
		shear modulus.
		"""
		if not isinstance(dimension, (int, np.integer)) or dimension not in FACETS: refuseArgument('dimension', '2 or 3', dimension, MaterialError)
		strengths = [s for s in (self.spallStrength, self.pairStrength, self.fractureStress / self.strengthRatio) if math.isfinite(s)]
		if not (strengths and self.fractureEnergy > 0): return math.inf
		if math.isnan(self.shearModulus):
			raise MaterialError("material '%s' has an equation of state only; give shearModulus [Pa] (0 for a fluid)" % self.name)
		modulus = self.bulkModulus + 4 * self.shearModulus / 3
		return 2 * modulus * self.fractureEnergy / (FACETS[dimension] * max(strengths)) / max(strengths)

	def flowStress(self, plasticStrain, rate=None, temperature=None):
		"""Yield stress [Pa] of the record's yieldModel; plasticStrain [-], rate [1/s] and temperature [K] may be arrays.

		They count where the law depends on them; None means the reference rate and temperature. Raises MaterialError for negative or not finite ones,
		ImportError without YADE: the law is that of McaMat.
		"""
		given = (('plasticStrain', plasticStrain, None, 0., 1e6), ('rate', rate, self.referenceRate, 1e-30, 1e30), ('temperature', temperature, self.referenceTemperature, 1e-9, 1e9))
		values = [np.clip(numbersOfAnyShape(name, start if v is None and start is not None else v, MaterialError, 0), low, high) for name, v, start, low, high in given]
		m = mcaMat(self, shearModulus=1.0)  # of no influence here, but a material without is none
		e, r, t = np.broadcast_arrays(*values)
		return np.array([m.flowStress(*map(float, point)) for point in zip(e.flat, r.flat, t.flat)]).reshape(e.shape)

	def johnsonCookFractureStrain(self, triaxiality, rate=1.0, temperature=298.0):
		"""Plastic strain at fracture by Johnson & Cook (1985) [-]; triaxiality = mean stress / Mises stress, tension positive.

		What damageModel='johnsonCook' goes by, and for choosing `fractureStrain`; raises MaterialError when the metal has no D1 ... D5 (damageD1 ...).
		"""
		d1, d2, d3, d4, d5 = (getattr(self, name) for name in _DAMAGE)
		if not d1 + d2 > 0:
			raise MaterialError("material '%s' has no Johnson-Cook fracture constants D1 ... D5" % self.name)
		triaxiality, rate = numbersOfAnyShape('triaxiality', triaxiality, MaterialError), numbersOfAnyShape('rate', rate, MaterialError, 0)
		temperature = numbersOfAnyShape('temperature', temperature, MaterialError, 0)
		t = np.clip((temperature - self.referenceTemperature) / (self.meltTemperature - self.referenceTemperature), 0, 1)
		return np.maximum((d1 + d2 * np.exp(d3 * triaxiality)) * (1 + d4 * np.log(np.maximum(rate / self.referenceRate, 1.0))) * (1 + d5 * t), LEAST_FRACTURE_STRAIN)


#: attributes of McaMat that mcaMat() sets
MCAMAT_ATTRIBUTES = tuple(f.name for f in fields(Material))[:[f.name for f in fields(Material)].index('viscosityQuadratic') + 1]
MCAMAT_ATTRIBUTES = tuple(name for name in MCAMAT_ATTRIBUTES if name != 'name')


_DAMAGE = tuple('damageD%d' % i for i in range(1, 6))
#: where the constants give less, or nothing: strong tension [-]
LEAST_FRACTURE_STRAIN = 1e-6


def _number(row, key, unit=1.0, default=None):
	return float(row[key]) * unit if row.get(key) else default


def _record(row):
	jc = tuple(_number(row, k, u) for k, u in (('JC_A_MPa', 1e6), ('JC_B_MPa', 1e6), ('JC_n', 1), ('JC_C', 1), ('JC_m', 1)))
	damage = {name: _number(row, name[-2:]) for name in _DAMAGE}
	sg = tuple(_number(row, k, u) for k, u in (('Y0_GPa', 1e9), ('SG_beta', 1), ('SG_n', 1), ('SG_Ymax_GPa', 1e9)))
	m = Material(
	        name=row['name'], density=_number(row, 'rho_kgm3'), bulkSoundSpeed=_number(row, 'c0_ms'), hugoniotSlope=_number(row, 's'),
	        gruneisen=_number(row, 'gamma0', default=0.0), shearModulus=_number(row, 'G_GPa', 1e9, math.nan),
	        meltTemperature=_number(row, 'Tm_K', default=math.inf), heatCapacity=_number(row, 'cp', default=0.0),
	        staticBulkModulus=_number(row, 'K_GPa', 1e9, math.nan), johnsonCook=None if None in jc else jc,
	        **({} if None in damage.values() else damage), steinbergGuinan=None if None in sg else sg,
	        minimumPressure=_number(row, 'Pmin_GPa', 1e9, 0.0), eosSource=row['eos_src'], strengthSource=row['str_src'],
	        **_toughness().get(row['name'], {}))
	m.lawConstants.update(_lawConstants().get(m.name, {}))
	best = 'johnsonCook' if m.johnsonCook else 'linearHardening' if m.steinbergGuinan else 'elastic'
	return _withYield(m, best)


@lru_cache(maxsize=None)
def _lawConstants():
	"""{material: {law: {constant: value}}} of law_constants.csv."""
	out = {}
	with open(STRENGTH, newline='') as f:
		for row in csv.DictReader(line for line in f if not line.startswith('#')):
			out.setdefault(row['name'], {})[row['law']] = {k: float(v) for k, v in (pair.split('=') for pair in row['constants'].split())}
	return out


@lru_cache(maxsize=None)
def _toughness():
	"""{material: fractureToughness and toughnessSource} of fracture_toughness.csv."""
	with open(TOUGHNESS, newline='') as f:
		rows = csv.DictReader(line for line in f if not line.startswith('#'))
		return {r['name']: dict(fractureToughness=float(r['K_Ic']), toughnessSource='%s; %s' % (r['source'], r['condition'])) for r in rows}


def _uses(kind, law):
	return [c['name'] for c in next(x for x in LAWS[kind] if x['name'] == law)['uses']]


def _withYield(m, model):
	"""The same metal with another yield model, its constants taken from the fullest law the library holds for it.

	'perfect' takes the initial yield stress. 'linearHardening' is the least-squares line through the static room-temperature curve
	(Johnson-Cook, else Steinberg-Guinan) for plastic strains from 0 to FIT_STRAIN.
	"""
	none = {k: float(c['default']) for k, c in _constants('yieldModel').items() if k not in ('yieldStress', 'referenceRate', 'meltTemperature')}
	if model == 'elastic':
		return replace(m, yieldModel=model, yieldStress=math.inf, **none)
	if model == 'johnsonCook':
		if not m.johnsonCook:
			raise MaterialError("material '%s' has no Johnson-Cook constants; choose yieldModel 'linearHardening', 'perfect' or 'elastic'" % m.name)
		a, b, n, c, t = m.johnsonCook
		return replace(m, yieldModel=model, yieldStress=a, hardeningModulus=b, hardeningExponent=n, rateCoefficient=c, thermalSoftening=t)
	if model in m.lawConstants:
		return replace(m, yieldModel=model, **dict(none, **m.lawConstants[model]))
	if model not in ('perfect', 'linearHardening'):
		raise MaterialError("material '%s' has no constants of '%s' in the library; give %s yourself" % (m.name, model, ', '.join(_uses('yieldModel', model))))
	if not (m.johnsonCook or m.steinbergGuinan):
		raise MaterialError("material '%s' has no strength data; give yieldStress yourself or choose yieldModel 'elastic'" % m.name)
	if model == 'perfect':
		return replace(m, yieldModel=model, yieldStress=(m.johnsonCook or m.steinbergGuinan)[0], **none)
	strain = np.linspace(0, FIT_STRAIN, 501)
	if m.johnsonCook:
		a, b, n = m.johnsonCook[:3]
		curve = a + b * strain**n
	else:
		y0, beta, n, top = m.steinbergGuinan
		curve = np.minimum(y0 * (1 + beta * strain)**n, top)
	slope, start = np.polyfit(strain, curve, 1)
	return replace(m, yieldModel=model, yieldStress=float(start), **dict(none, hardeningModulus=float(max(slope, 0.0))))


@lru_cache(maxsize=None)
def _library():
	with open(DATA, newline='') as f:
		return {r['name']: _record(r) for r in csv.DictReader(line for line in f if not line.startswith('#'))}


def names():
	"""Names of all materials, sorted (list of str)."""
	return sorted(_library())


def get(name, yieldModel=None, **overrides):
	"""The record `name`, as Material.

	`yieldModel` picks a simpler variant of the same metal (see YIELD_MODELS; None: the fullest that the library holds); any other
	attribute of Material may be given by keyword and replaces the library's value. Raises MaterialError for an unknown name,
	attribute or model and for values out of range.
	"""
	if isinstance(name, Material):
		m = name
	else:
		if not isinstance(name, str) or name not in _library():
			near = difflib.get_close_matches(str(name), names(), 3, 0.4)
			raise MaterialError("unknown material '%s'%s; the library holds: %s" %
			                    (name, " (did you mean '%s'?)" % "' or '".join(near) if near else '', ', '.join(names())))
		m = _library()[name]
	if yieldModel is not None and yieldModel != m.yieldModel:
		if yieldModel not in YIELD_MODELS:
			raise MaterialError("yieldModel '%s' must be one of %s" % (yieldModel, ', '.join(YIELD_MODELS)))
		held = m.johnsonCook or m.steinbergGuinan if yieldModel in ('perfect', 'linearHardening', 'johnsonCook') else yieldModel in m.lawConstants
		given = 'yieldStress' in overrides and not held  # the caller brings the strength along
		m = replace(m, yieldModel=yieldModel) if given else _withYield(m, yieldModel)
	known = {f.name for f in fields(Material)}
	for key in overrides:
		if key not in known:
			near = difflib.get_close_matches(key, known, 1)
			raise MaterialError("material has no attribute '%s'%s" % (key, " (did you mean '%s'?)" % near[0] if near else ''))
	m = replace(m, **dict(m.lawConstants.get(overrides.get('eos'), {}) if isinstance(overrides.get('eos'), str) else {}, **overrides))
	_check(m)
	return m


_POSITIVE = ('density', 'bulkSoundSpeed', 'fractureStrain', 'spallStrength', 'pairStrength', 'fractureStress')
_NOT_NEGATIVE = ('heatCapacity', 'taylorQuinney', 'strengthSpread', 'frictionAngle', 'fractureEnergy', 'referenceTemperature',
                 'viscosityLinear', 'viscosityQuadratic', 'shearModulus')


#: may be infinite: no plasticity, no fracture, no melting
_INFINITE = ('fractureStrain', 'spallStrength', 'pairStrength', 'fractureStress', *(name for name, c in CONSTANTS.items() if c['ends'][2]))


def _check(m):
	def refuse(k, rule):
		raise MaterialError("material '%s': %s = %s must be %s" % (m.name, k, reprlib.repr(getattr(m, k)), rule))

	for k in (f.name for f in fields(Material) if f.type is float or f.type == 'float'):
		v = getattr(m, k)
		if not isinstance(v, (int, float, np.integer, np.floating)) or isinstance(v, bool) or isinstance(v, int) and abs(v) > LARGEST: refuse(k, 'a number')
		if abs(v) > LARGEST and not (k in _INFINITE and v > 0): refuse(k, 'finite')
	for k, c in CONSTANTS.items():  # the ranges that hold whatever law is chosen; McaMat checks those of the law, too
		(least, most), (withLeast, withMost, infinite), v = c['range'], c['ends'], getattr(m, k)
		inside = (v >= least if withLeast else v > least) and (v <= most if withMost else v < most)
		if not (inside or infinite and v == math.inf): refuse(k, {(0, False): 'above 0', (0, True): '0 or above'}.get((least, withLeast), c['words']))
	for k in _POSITIVE:
		if not getattr(m, k) > 0: refuse(k, 'above 0')
	for k in _NOT_NEGATIVE:  # an equation of state alone is a record too: no shear modulus
		if not getattr(m, k) >= 0 and not (k == 'shearModulus' and math.isnan(m.shearModulus)): refuse(k, '0 or above')
	if m.fractureToughness <= 0: refuse('fractureToughness', 'above 0 (nan: not known)')
	if m.frictionAngle >= 0.5 * math.pi: refuse('frictionAngle', 'from 0 to below pi/2')
	if m.taylorQuinney > 1: refuse('taylorQuinney', 'from 0 to 1')
	if m.strengthSpread >= 0.5: refuse('strengthSpread', 'from 0 to below 0.5')
	for k, allowed in (('eos', EOS_MODELS), ('yieldModel', YIELD_MODELS), ('damageModel', DAMAGE_MODELS), ('strengthDistribution', DISTRIBUTIONS)):
		if getattr(m, k) not in allowed:
			refuse(k, 'one of ' + ', '.join(allowed))
	for k in _DAMAGE:
		if math.isnan(getattr(m, k)): refuse(k, 'finite')
	if not m.damageD2 >= 0: refuse('damageD2', '0 or above')
	if not m.damageD4 >= -0.01: refuse('damageD4', '-0.01 or above')
	if not m.damageD5 > -1: refuse('damageD5', 'above -1')
	if m.damageModel != 'none' and not m.damageD1 + m.damageD2 > 0:
		raise MaterialError("material '%s' has no constants of damageModel '%s' in the library; give damageD1 ... damageD5 (damageD1 + damageD2 above 0)" % (m.name, m.damageModel))
	if not m.strengthRatio >= 1: refuse('strengthRatio', '1 or above (compression strength / tensile strength)')


def mcaMat(name, label=None, **overrides):
	"""A yade McaMat with the constants of `name` (or of a Material record); keywords as for get().

	`label` is the label in O.materials (default: the material's name). Raises MaterialError when the set has no shear modulus.
	The material is not appended to O.materials; addBodies() of packings does that.
	"""
	m = get(name, **overrides)
	if not math.isfinite(m.shearModulus):
		raise MaterialError("material '%s' has an equation of state only; give shearModulus [Pa] (0 for a fluid)" % m.name)
	from ._yade import yadeClass
	return yadeClass('McaMat')(label=label or m.name, **{k: getattr(m, k) for k in MCAMAT_ATTRIBUTES})
