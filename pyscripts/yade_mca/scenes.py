# SPDX-License-Identifier: GPL-2.0-or-later
"""Ready scenes: bar, plate impact, Taylor bar, plate tied to a grid, penetration. Each fills YADE's O with ordinary bodies and engines.

    >>> from yade_mca import scenes
    >>> s = scenes.penetration(thickness=25e-3, spacing=1e-3)
    >>> O.run(1000, True); s.automata.sync(); s.field('rod', 'plasticStrain').max()

Every builder resets nothing: call O.reset() first for a fresh scene. The script may edit what it gets before the first step: O.bodies,
O.engines, s.automata (McaEngine), s.grid (McaGridEngine or None), s.couplers. Plane strain in x-y, SI units, per 1 m of thickness.
"""
import math
from dataclasses import dataclass, field

import numpy as np

from . import packings
from ._yade import scene as omega
from ._yade import yadeClass
from .packings import Rectangle, addBodies, hexagonal

__all__ = ['Scene', 'SceneError', 'bar', 'gradedLines', 'law2Engines', 'penetration', 'plateImpact', 'rodMeasure', 'taylorBar', 'tiedPlate', 'touchDown']

PITCH = 0.5 * math.sqrt(3)  #: distance of close-packed rows over the spacing
SPALL = (3.8e9, 3.0e9)  #: tensile strength of rod and plate [Pa], see penetration()
ROD, PLATE = 1, 2  #: Body.mask of the two bodies of an impact: bodies of different mask do not link


class SceneError(ValueError):
	"""A scene that cannot be built; the message names the value and what is allowed."""


@dataclass
class Scene:
	"""What a builder made. `ids`: name of a part -> body ids (numpy int), `packings`: the same names -> Packing."""
	automata: object = None  #: McaEngine
	grid: object = None  #: McaGridEngine or None
	couplers: list = field(default_factory=list)
	ids: dict = field(default_factory=dict)
	packings: dict = field(default_factory=dict)
	blocks: dict = field(default_factory=dict)  #: name -> number of the grid block
	facts: dict = field(default_factory=dict)  #: sizes, speed, materials as used

	def field(self, part, name):
		"""Quantity `name` of McaEngine.field() for the automata of `part`, in the order of ids[part]."""
		return self.automata.field(name)[np.searchsorted(self.automata.ids, self.ids[part])]

	def vectors(self, part, x, y):
		"""Two quantities as columns, e.g. vectors('rod', 'vx', 'vy')."""
		return np.stack((self.field(part, x), self.field(part, y)), axis=1)

	def add(self, part, packing, material, **options):
		"""Adds bodies under the name `part`; see packings.addBodies."""
		self.ids[part], self.packings[part] = np.array(addBodies(packing, material, **options)), packing
		return self.ids[part]


def _positive(**values):
	for name, v in values.items():
		if not (isinstance(v, (int, float, np.floating, np.integer)) and 0 < v < math.inf):
			raise SceneError('%s must be above 0 and finite; got %r' % (name, v))


def _oneOf(name, value, allowed):
	if value not in allowed:
		raise SceneError("%s '%s' is not one of %s" % (name, value, ', '.join(allowed)))


def _start(engineOptions):
	s = Scene()
	s.automata = yadeClass('McaEngine')(**(engineOptions or {}))
	omega().engines = [s.automata]
	return s


def law2Engines(volumeRule='affine', stepFactor=None, **newton):
	"""Engines that move automata by the law in YADE's own loop, beside walls, facets and boxes; put them into O.engines. Slow: McaEngine is the fast road.

	volumeRule: of McaDensity. stepFactor: share of the largest stable time step for a McaTimeStepper; None: the script sets O.dt [s].
	newton: attributes of NewtonIntegrator, e.g. gravity=(0, -9.81, 0) [m/s2].
	"""
	make = lambda name, *a, **k: yadeClass(name)(*a, **k)
	bounds = [make('Bo1_Sphere_Aabb', aabbEnlargeFactor=1.4), make('Bo1_Facet_Aabb'), make('Bo1_Wall_Aabb'), make('Bo1_Box_Aabb')]
	geometry = [make('Ig2_Sphere_Sphere_ScGeom', interactionDetectionFactor=1.4), make('Ig2_Facet_Sphere_ScGeom'), make('Ig2_Wall_Sphere_ScGeom'), make('Ig2_Box_Sphere_ScGeom')]
	laws = [make('Ip2_McaMat_McaMat_McaPhys'), make('Ip2_FrictMat_McaMat_McaPhys')], [make('Law2_ScGeom_McaPhys_Mca')]
	stepper = [make('McaTimeStepper', factor=stepFactor)] if stepFactor else []
	return [make('ForceResetter'), make('InsertionSortCollider', bounds), *stepper, make('McaDensity', volumeRule=volumeRule), make('InteractionLoop', geometry, *laws),
	        make('McaForces'), make('NewtonIntegrator', damping=0, **newton)]


def bar(material, length, height, spacing, velocity=(0., 0.), angle=0., engineOptions=None):
	"""A free bar of automata along x, centred at the origin. Part 'bar'.

	material: McaMat, name or record; length, height, spacing [m]; velocity [m/s]; angle of the close-packed rows [rad].
	"""
	_positive(length=length, height=height, spacing=spacing)
	s = _start(engineOptions)
	s.add('bar', hexagonal(spacing, Rectangle((0, 0), (length, height)), angle=angle), material, velocity=velocity)
	return s


def touchDown(upper, lower):
	"""Packing `upper` moved along y until its lowest automata just touch those of `lower` (no overlap)."""
	reach = upper.radius + lower.radius
	low, high = upper.positions[:, 1].min(), lower.positions[:, 1].max()
	a = upper.positions[upper.positions[:, 1] < low + 2 * reach]
	b = lower.positions[lower.positions[:, 1] > high - 2 * reach]
	dx = a[:, None, 0] - b[None, :, 0]
	over = abs(dx) < reach
	if not over.any():
		raise SceneError('the bodies do not meet: no automaton of one lies above the other')
	need = b[None, :, 1] + np.sqrt(np.maximum(reach**2 - dx**2, 0)) - a[:, None, 1]
	return upper.translated((0., need[over].max() + 1e-9 * reach))


def plateImpact(flyer, target, flyerThickness, targetThickness, height, spacing, speed, lateral='fixed', engineOptions=None):
	"""Flyer on target in uniaxial strain along x. Parts 'flyer', 'target'.

	flyer, target: materials; thicknesses along x and height [m]; speed of the flyer towards +x [m/s].
	lateral: 'fixed' blocks all motion along y (uniaxial strain; read values away from the upper and lower edge, whose automata lack
	neighbours), 'free' leaves the edges free. Rows run along x; the free face of the target is at x = targetThickness.
	"""
	_positive(flyerThickness=flyerThickness, targetThickness=targetThickness, height=height, spacing=spacing, speed=speed)
	_oneOf('lateral', lateral, ('fixed', 'free'))
	s = _start(engineOptions)
	# one lattice through both, so that the faces fit; the flyer ends half a spacing before the target begins
	whole = hexagonal(spacing, Rectangle((0.5 * (targetThickness - flyerThickness), 0), (targetThickness + flyerThickness, height)), rim='full')
	front = whole.positions[:, 0] < 0
	for name, material, part, v, mask in (('flyer', flyer, front, speed, ROD), ('target', target, ~front, 0., PLATE)):
		ids = s.add(name, whole.select(part), material, velocity=(v, 0.), mask=mask)
		if lateral == 'fixed':
			for i in ids.tolist():
				omega().bodies[i].state.blockedDOFs = 'yzXYZ'
	s.facts.update(speed=speed, middle=0.25 * height)
	return s


def taylorBar(material, length, diameter, spacing, speed, friction=0., engineOptions=None):
	"""Taylor test in plane strain: a bar along y falls on a rigid anvil below it. Parts 'bar', 'anvil'.

	length, diameter, spacing [m]; speed [m/s] towards -y; the anvil is a double row of fixed automata of the same material, its upper edge at
	y = 0; friction: angle [rad] of bar and anvil.
	"""
	_positive(length=length, diameter=diameter, spacing=spacing, speed=speed)
	s = _start(engineOptions)
	m = packings._material(material)
	m.frictionAngle = friction
	anvil = hexagonal(spacing, Rectangle((0, -PITCH * spacing), (6 * diameter, 2 * PITCH * spacing)), rim='full')
	body = hexagonal(spacing, Rectangle((0, 0.5 * length), (diameter, length)), angle=0.5 * math.pi, origin=(0, 0.5 * spacing))
	s.add('bar', touchDown(body, anvil), m, velocity=(0., -speed), mask=ROD)
	s.add('anvil', anvil, m, fixed=True, mask=PLATE)
	s.facts.update(speed=speed, length=length, diameter=diameter)
	return s


def gradedLines(start, end, first, growth=1.1, largest=None):
	"""Grid lines from `start` to `end` (either sense): the first cell `first` long, each next at most `growth` times longer, none above `largest`.

	Returns an array from start to end [m]. The growth is lowered a little so that the last line falls on `end`; where that cannot be (a
	distance of few cells), the distance is divided evenly.
	"""
	_positive(first=first, growth=growth)
	distance, largest = abs(end - start), largest or math.inf
	if growth < 1 or largest < first:
		raise SceneError('growth must be at least 1 and largest at least first; got %r, %r, %r' % (growth, largest, first))
	cells = lambda n, q: np.minimum(first * q**np.arange(n), largest)
	n = 1
	while cells(n, growth).sum() < distance * (1 - 1e-9):
		n += 1
	if cells(n, 1 / growth).sum() > distance:
		lengths = np.full(max(round(distance / first), 1), 1.)
	else:
		low, high = 1 / growth, growth
		for _ in range(100):
			mid = 0.5 * (low + high)
			low, high = (mid, high) if cells(n, mid).sum() < distance else (low, mid)
		lengths = cells(n, high)
	lengths *= distance / lengths.sum()
	lines = start + math.copysign(1, end - start) * np.concatenate(((0.,), np.cumsum(lengths)))
	lines[-1] = end
	return lines


def _tie(s, block, side, ids):
	"""Ties the automata `ids` to a side of a grid block by a McaGridCoupler."""
	coupler = yadeClass('McaGridCoupler')(block=block, side=side, ids=[int(i) for i in ids])
	s.couplers.append(coupler)
	return coupler


def _plateEnds(s, material, spacing, thickness, half, plateHalf, ends, growth, largest, dtFactor):
	"""Grid blocks left and right of the automata (|x| from `half` to `plateHalf`), tied to the rows at |x| = half."""
	s.grid = yadeClass('McaGridEngine')()
	ys = np.linspace(-thickness, 0., round(thickness / spacing) + 1)
	lines = gradedLines(half, plateHalf, spacing, growth, largest)
	sides = (('right', lines, 'left', 'right'), ('left', -lines[::-1], 'right', 'left'))
	for name, xs, inner, outer in sides:  # all blocks come before the first boundary
		s.blocks[name] = s.grid.addRectangle(material, xs.tolist(), ys.tolist(), name=name)
	for name, xs, inner, outer in sides:
		b = s.blocks[name]
		if ends == 'fixed':
			s.grid.fix(b, outer)
		elif ends == 'viscous':
			s.grid.viscous(b, outer)
	for name, inner, sign in (('right', 'left', 1), ('left', 'right', -1)):
		row = s.packings['plate'].onLine((sign * half, 0), (0, 1))
		_tie(s, s.blocks[name], inner, s.ids['plate'][row])
	omega().engines = [yadeClass('McaTimeStepper')(factor=dtFactor), s.automata, s.grid, *s.couplers]


def tiedPlate(material, thickness, spacing, automataWidth=80e-3, plateWidth=120e-3, mode='coupled', ends='fixed', growth=1.1, largest=4., mask=PLATE,
              scene=None, dtFactor=0.4, engineOptions=None):
	"""A plate (top face y = 0, rear face y = -thickness) whose middle is automata and whose rest is grid. Part 'plate', blocks 'left', 'right'.

	mode      'coupled': grid outside the automata, tied at the columns nearest |x| = automataWidth/2; 'mca': automata only, no grid
	ends      'fixed', 'viscous' (transmitting) or 'free': where the plate ends, |x| = plateWidth/2 ('coupled') or automataWidth/2 ('mca')
	growth    of the cells away from the interface; largest: longest cell in spacings
	dtFactor  share of the largest stable time step
	thickness must be a whole number of spacings. Close-packed columns run along y, so that the tied column has the nodes of the grid.
	"""
	_positive(thickness=thickness, spacing=spacing, automataWidth=automataWidth, plateWidth=plateWidth)
	_oneOf('mode', mode, ('coupled', 'mca'))
	_oneOf('ends', ends, ('fixed', 'viscous', 'free'))
	if abs(thickness / spacing - round(thickness / spacing)) > 1e-6:
		raise SceneError('thickness %g m is not a whole number of spacings %g m: take spacing %g m' % (thickness, spacing, thickness / math.ceil(thickness / spacing)))
	columns = round(0.5 * automataWidth / (PITCH * spacing))
	half = columns * PITCH * spacing
	if mode == 'coupled' and 0.5 * plateWidth < half + spacing:
		raise SceneError('plateWidth %g m leaves no room for a grid beside %g m of automata' % (plateWidth, 2 * half))
	s = scene or _start(engineOptions)
	s.automata.dtFactor = dtFactor
	plate = hexagonal(spacing, Rectangle((0, -0.5 * thickness), (2 * half, thickness)), angle=0.5 * math.pi, origin=(half, 0.))
	m = packings._material(material)
	s.add('plate', plate, m, mask=mask)
	s.facts.update(thickness=thickness, spacing=spacing, automataWidth=2 * half, mode=mode, ends=ends, plate=m.label)
	if mode == 'coupled':
		s.facts['plateWidth'] = plateWidth
		_plateEnds(s, m, spacing, thickness, half, 0.5 * plateWidth, ends, growth, largest * spacing, dtFactor)
	else:
		for sign in (-1, 1):
			ids = s.ids['plate'][plate.onLine((sign * half, 0), (0, 1))].tolist()
			if ends == 'fixed':
				for i in ids:
					omega().bodies[i].state.blockedDOFs = 'xyzXYZ'
			elif ends == 'viscous':
				s.automata.setViscous(ids, (float(sign), 0.))
	return s


def penetration(thickness=25e-3, spacing=1e-3, speed=1520., mode='coupled', ends=None, rodLength=100e-3, rodDiameter=10e-3, rod='WHA_JC', plate='4340',
                automataWidth=80e-3, plateWidth=120e-3, fractureStrain=1.0, spallStrength=SPALL, strengthSpread=0.05, friction=None, eos='shockAdiabat',
                yieldModel=None, viscosity=1., seed=1, dtFactor=0.5, account=True, engineOptions=None):
	"""A rod along y falls on the upper face of a plate: the main job. Parts 'rod', 'plate'; impact direction (0, -1).

	thickness [m], spacing [m], speed [m/s]; mode and ends as in tiedPlate() (ends None: 'fixed' when coupled, 'viscous' with automata only)
	rod, plate     names or records of the library, or McaMat (then taken as they are)
	fractureStrain plastic strain at which pairs unlink [-], of both
	spallStrength  tensile pressure at which pairs of rod and plate unlink [Pa]: tungsten alloy W-7Ni-3Fe 3.8 GPa (Zurek & Gray 1991, J. Phys. IV 1,
	               C3-631), quenched and tempered steel 3 GPa, within the range of such steels in Antoun et al. 2003 (Spall Fracture, Springer)
	strengthSpread relative scatter of both from automaton to automaton, drawn with `seed`
	friction       coefficient of both [-]; None: that of the library
	eos, yieldModel of both materials; yieldModel None: the fullest the library holds (Johnson-Cook with rate and heating)
	viscosity      factor on the artificial viscosity of both [-]
	dtFactor       share of the largest stable time step; account: keep the energy account
	Time 0 is the moment of contact: the rod's lowest automata just touch the plate.
	"""
	from .materials import Material, get, mcaMat
	_positive(thickness=thickness, spacing=spacing, speed=speed, rodLength=rodLength, rodDiameter=rodDiameter, dtFactor=dtFactor)
	if spacing > 0.5 * min(rodDiameter, thickness):
		raise SceneError('spacing %g m is above half the rod diameter or plate thickness (%g, %g m)' % (spacing, rodDiameter, thickness))
	_oneOf('mode', mode, ('coupled', 'mca'))
	ends = ends or ('fixed' if mode == 'coupled' else 'viscous')
	s = _start(dict(dict(seed=seed, account=account), **(engineOptions or {})))

	def material(x, spall):
		if not isinstance(x, (str, Material)):
			return x
		m = get(x, yieldModel=yieldModel)
		constants = dict(fractureStrain=fractureStrain, spallStrength=spall, strengthSpread=strengthSpread, eos=eos, viscosityLinear=viscosity * m.viscosityLinear,
		                 viscosityQuadratic=viscosity * m.viscosityQuadratic)
		return mcaMat(m, **dict(constants, **({} if friction is None else dict(frictionAngle=math.atan(friction)))))

	rodMat, plateMat = material(rod, spallStrength[0]), material(plate, spallStrength[1])
	tiedPlate(plateMat, thickness, spacing, automataWidth, plateWidth, mode, ends, scene=s, dtFactor=(engineOptions or {}).get('dtFactor', dtFactor))
	body = hexagonal(spacing, Rectangle((0, 0.5 * rodLength), (rodDiameter, rodLength)), angle=0.5 * math.pi, origin=(0., 0.5 * spacing))
	s.add('rod', touchDown(body, s.packings['plate']), rodMat, velocity=(0., -speed), mask=ROD, color=(0.8, 0.5, 0.2))
	s.facts.update(speed=speed, rodLength=rodLength, rodDiameter=rodDiameter, rod=rodMat.label, direction=(0., -1.), rear=(0., -thickness), seed=seed)
	return s


def rodMeasure(s):
	"""measure.rodMeasure() of a penetration scene now; reads the solver's arrays, no write-back needed."""
	from . import measure
	return measure.rodMeasure(s.field('rod', 'mass'), s.vectors('rod', 'vx', 'vy'), s.field('rod', 'plasticStrain'), s.facts['speed'], s.facts['direction'])
