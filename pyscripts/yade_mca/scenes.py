# SPDX-License-Identifier: GPL-2.0-or-later
"""Ready scenes: bar, plate impact, Taylor bar, plate tied to a grid, penetration. Each fills YADE's O with ordinary bodies and engines.

    >>> from yade_mca import scenes
    >>> s = scenes.penetration(thickness=25e-3, spacing=1e-3)
    >>> O.run(1000, True); s.automata.sync(); s.field('rod', 'plasticStrain').max()

Every builder resets nothing: call O.reset() first for a fresh scene. The script may edit what it gets before the first step: O.bodies,
O.engines, s.automata (McaEngine), s.grid (McaGridEngine or None), s.couplers. Plane strain in x-y, SI units, per 1 m of thickness.
"""
import math

import numpy as np

from . import measure
from ._yade import yadeClass
from ._arguments import array
from ._bodies import material as asMaterial
from .packings import Rectangle, hexagonal
from .round_bodies import rodAndPlate, roundBar
from .scene import PITCH, PLATE, ROD, Scene, SceneError, affordable, oneOf, positive, start, subsonic, within
from .tied_plate import gradedLines, leaning, plateGeometry, tiedPlate
from .uniaxial import addStrip, driveEnd, middle, plateImpact, profile, strip

__all__ = ['Scene', 'SceneError', 'addStrip', 'bar', 'checkImpact', 'driveEnd', 'gradedLines', 'law2Engines', 'middle', 'penetration', 'plateImpact', 'profile',
           'rodLength', 'rodMeasure', 'roundBar', 'start', 'strip', 'taylorBar', 'tiedPlate', 'touchDown']

SPALL = (3.8e9, 3.0e9)  #: tensile strength of rod and plate [Pa], see penetration()
STEEPEST = math.radians(75)  #: largest obliquity of the rod [rad]


def law2Engines(volumeRule='affine', stepFactor=None, **newton):
	"""Engines that move automata by the law in YADE's own loop, beside walls, facets and boxes; put them into O.engines. Slow: McaEngine is the fast road.

	volumeRule: of McaLaw. stepFactor: share of the largest stable time step for a McaTimeStepper; None: the script sets O.dt [s].
	newton: attributes of NewtonIntegrator, e.g. gravity=(0, -9.81, 0) [m/s2].
	"""
	oneOf('volumeRule', volumeRule, ('affine', 'inversePower', 'meanDistance'))
	if stepFactor is not None: within('stepFactor', stepFactor, 0., 1., openLow=True)
	make = lambda name, *a, **k: yadeClass(name)(*a, **k)
	bounds = [make('Bo1_Sphere_Aabb', aabbEnlargeFactor=1.4), make('Bo1_Facet_Aabb'), make('Bo1_Wall_Aabb'), make('Bo1_Box_Aabb')]
	geometry = [make('Ig2_Sphere_Sphere_ScGeom', interactionDetectionFactor=1.4), make('Ig2_Facet_Sphere_ScGeom'), make('Ig2_Wall_Sphere_ScGeom'), make('Ig2_Box_Sphere_ScGeom')]
	laws = [make('Ip2_McaMat_McaMat_McaPhys'), make('Ip2_FrictMat_McaMat_McaPhys')], [make('Law2_ScGeom_McaPhys_Mca')]
	stepper = [make('McaTimeStepper', factor=stepFactor)] if stepFactor is not None else []
	return [make('ForceResetter'), make('InsertionSortCollider', bounds), *stepper, make('McaLaw', volumeRule=volumeRule), make('InteractionLoop', geometry, *laws),
	        make('McaForces'), make('NewtonIntegrator', damping=0, **newton)]


def bar(material, length, height, spacing, velocity=(0., 0.), angle=0., rim='triangles', engineOptions=None):
	"""A free bar of automata along x, centred at the origin. Part 'bar'.

	material: McaMat, name or record; length, height, spacing [m]; velocity [m/s]; angle of the close-packed rows [rad]; rim: of packings.hexagonal().
	With 'triangles' free surfaces are of second order, and lengths across rows are whole numbers of rows, along them of spacings: s.packings['bar'].area is
	the area that was made [m2], .outlineArea that asked for. With 'cells' the mass is exactly that of the outline.
	"""
	positive(length=length, height=height, spacing=spacing)
	within('angle', angle, -2 * math.pi, 2 * math.pi, 'rad')
	oneOf('rim', rim, ('triangles', 'cells', 'full'))
	affordable(spacing, (length, height))
	body = hexagonal(spacing, Rectangle((0, 0), (length, height)), angle=angle, rim=rim)
	subsonic('velocity', float(np.abs(array('velocity', velocity, SceneError, ((2, ), (len(body), 2)))).max()), material)
	s = start(engineOptions)
	s.add('bar', body, material, velocity=velocity)
	return s


def _front(u, w, reach):
	"""Indices of the points that can be the first to touch something at lower w: those less than two `reach` above the lowest in their neighbourhood."""
	column = np.floor((u - u.min()) / reach).astype(int)
	lowest = np.full(column.max() + 1, np.inf)
	np.minimum.at(lowest, column, w)
	return np.flatnonzero(w < lowest[column] + 2 * reach)


def touchDown(upper, lower, direction=(0., -1.)):
	"""Packing `upper` moved along `direction` (or back) until its foremost automata just touch those of `lower` (no overlap). Raises SceneError."""
	n = array('direction', direction, SceneError, (2, ))
	if not n.any(): raise SceneError('direction must not be (0, 0)')
	n = n / np.hypot(*n)
	reach = upper.radius + lower.radius
	frame = lambda p: (p @ (-n[1], n[0]), p @ -n)  # across the flight, and back along it
	(au, aw), (bu, bw) = frame(upper.positions), frame(lower.positions)
	under = np.flatnonzero((bu > au.min() - reach) & (bu < au.max() + reach))
	if not len(under):
		raise SceneError('the bodies do not meet: no automaton of one lies above the other')
	a, b = _front(au, aw, reach), under[_front(bu[under], -bw[under], reach)]
	du = au[a][:, None] - bu[b][None, :]
	over = abs(du) < reach
	if not over.any():
		raise SceneError('the bodies do not meet: no automaton of one lies above the other')
	need = bw[b][None, :] + np.sqrt(np.maximum(reach**2 - du**2, 0)) - aw[a][:, None]
	return upper.translated(-n * (need[over].max() + 1e-9 * reach))


def taylorBar(material, length, diameter, spacing, speed, friction=0., anvil='smooth', rim='triangles', engineOptions=None):
	"""Taylor test in plane strain: a bar along y meets a rigid anvil at y = 0 with its lower end. Part 'bar', and 'anvil' where it is rough.

	length, diameter, spacing [m]; speed [m/s] towards -y.
	anvil    'smooth': the lowest row, of half weight, slides along y = 0 and is at rest in y from the start, as at a plane of symmetry (it cannot lift off);
	         'rough': a double row of fixed automata of the same material, its upper edge at y = 0: the bar's automata interlock with it, and the foot
	         stays narrower and the bar longer than on a smooth one, by a few per cent and up to a quarter
	friction angle [rad] between bar and rough anvil, of the material `material` from now on
	rim      of packings.hexagonal(): with 'triangles' the free sides are of second order, and lengths across rows are whole numbers of rows, along them
	         of spacings (s.packings['bar'].area is the area that was made [m2], .outlineArea that asked for); with 'cells' the mass is exactly that of
	         the outline. Rows run along x on a smooth anvil, along y on a rough one
	"""
	positive(length=length, diameter=diameter, spacing=spacing, speed=speed)
	oneOf('anvil', anvil, ('smooth', 'rough'))
	oneOf('rim', rim, ('triangles', 'cells'))
	within('friction', friction, 0., 1.5, 'rad')
	if spacing > 0.5 * min(length, diameter):
		raise SceneError('spacing %g m is above half the length or diameter of the bar (%g, %g m)' % (spacing, length, diameter))
	if friction and anvil == 'smooth':
		raise SceneError("friction %g rad on a smooth anvil: take anvil='rough'" % friction)
	affordable(spacing, (length, diameter))
	subsonic('speed', speed, material)
	outline, rough = Rectangle((0, 0.5 * length), (diameter, length)), anvil == 'rough'
	if rough: place = dict(angle=0.5 * math.pi, origin=None if rim == 'triangles' else (0, 0.5 * spacing))
	else:  # a row on the anvil; with triangles the ends of rows are a quarter of the spacing inside and outside by turns
		place = dict(origin=((0.25 - 0.5 * max(round(diameter / spacing), 1)) * spacing if rim == 'triangles' else 0., 0.))
	body = hexagonal(spacing, outline, rim=rim, **place)
	s = start(engineOptions)
	m = asMaterial(material)
	s.facts.update(speed=speed, length=length, diameter=diameter, anvil=anvil)
	if rough:
		m.frictionAngle = friction
		plate = hexagonal(spacing, Rectangle((0, -PITCH * spacing), (6 * diameter, 2 * PITCH * spacing)), rim='full')
		s.add('bar', touchDown(body, plate), m, velocity=(0., -speed), mask=ROD)
		s.add('anvil', plate, m, fixed=True, mask=PLATE)
	else:
		foot = body.positions[:, 1] < 0.1 * spacing
		ids = s.add('bar', body, m, velocity=np.stack((np.zeros(len(body)), np.where(foot, 0., -speed)), axis=1), mask=ROD)
		s.block(ids[foot], 'yZ')  # the mirror image turns the other way
	return s


def _rodPacking(s, spacing, length, diameter, angle, obliquity, direction, thickness):
	"""The rod, its axis through the middle of the plate's thickness at x = 0, its head on the plate.

	Where its close-packed columns have the direction of the plate's, it goes on with the plate's lattice, so that all of its head arrives at once and each
	automaton between two of the plate's; a head of which only some stand on top of others is stopped by few contacts, which give way at 4 km/s.
	"""
	plate = s.packings['plate']
	back = -np.asarray(direction)
	if obliquity == 0 and leaning(angle) == 0:
		top = plate.positions[plate.onLine((0, 0), (0, 1)), 1].max()  # 0, or half a spacing below the face
		origin = (0., 0.5 * spacing if top > -0.25 * spacing else 0.)
		p = hexagonal(spacing, Rectangle((0, 0.5 * length), (diameter, length)), angle=plate.angle, origin=origin)
	elif obliquity == 0:
		p = hexagonal(spacing, Rectangle((0, 0.5 * length + 1e-6 * spacing), (diameter, length)), angle=plate.angle, origin=plate.positions[0])
	else:
		middle = np.array((0., -0.5 * thickness)) + back * (0.5 * length + thickness)
		first = middle - back * 0.5 * (length - spacing)
		p = hexagonal(spacing, Rectangle(middle, (diameter, length), angle=obliquity), angle=0.5 * math.pi + angle + obliquity, origin=first)
	return touchDown(p, plate, direction)


def checkImpact(thickness, spacing, speed, mode, rodLength, rodDiameter, rod, plate, automataWidth, plateWidth, angle=0., obliquity=0., dimension=2):
	"""Raises SceneError when penetration() cannot build a scene of these sizes; makes nothing."""
	if not (isinstance(dimension, int) and dimension in (2, 3)): raise SceneError('dimension must be 2 or 3; got %r' % (dimension, ))
	positive(thickness=thickness, spacing=spacing, speed=speed, rodLength=rodLength, rodDiameter=rodDiameter, automataWidth=automataWidth)
	if spacing > 0.5 * min(rodDiameter, thickness):
		raise SceneError('spacing %g m is above half the rod diameter or plate thickness (%g, %g m)' % (spacing, rodDiameter, thickness))
	if rodLength < 2 * spacing:
		raise SceneError('rodLength %g m is below two spacings of %g m' % (rodLength, spacing))
	within('obliquity', obliquity, -STEEPEST, STEEPEST, 'rad')
	if dimension == 2: plateGeometry(thickness, spacing, automataWidth, plateWidth, mode, angle)
	need = thickness * math.tan(abs(obliquity)) + rodDiameter / math.cos(obliquity) + 2 * spacing
	if automataWidth < need:
		raise SceneError('automataWidth %g m is too narrow: at an obliquity of %.3g degrees the rod crosses the plate within %.3g m' % (automataWidth, math.degrees(obliquity), need))
	if dimension == 2: affordable(spacing, (thickness, automataWidth), (rodLength, rodDiameter))
	subsonic('speed', speed, rod, plate)


def penetration(thickness=25e-3, spacing=1e-3, speed=1520., mode='coupled', ends=None, rodLength=100e-3, rodDiameter=10e-3, rod='WHA_JC', plate='4340',
                automataWidth=80e-3, plateWidth=120e-3, fractureStrain=None, spallStrength=SPALL, strengthSpread=0.05, friction=None, eos='shockAdiabat',
                yieldModel=None, viscosity=1., seed=1, dtFactor=0.5, account=True, angle=0., obliquity=0., dimension=2, quarter=True, engineOptions=None,
                damageModel='none', fractureEnergy=(0., 0.)):
	"""A rod falls on the upper face of a plate: the main job. Parts 'rod', 'plate'; impact direction (sin obliquity, -cos obliquity).

	thickness [m], spacing [m], speed [m/s]; mode and ends as in tiedPlate() (ends None: 'fixed' when coupled, 'viscous' with automata only)
	rod, plate     names or records of the library, or McaMat (then taken as they are)
	fractureStrain plastic strain at which pairs unlink [-], of both; None: 1, infinite with a damageModel
	damageModel    'johnsonCook': pairs of both unlink by the fracture strain of Johnson and Cook, (11e); the materials must have its constants
	spallStrength  tensile pressure at which pairs of rod and plate unlink [Pa]: tungsten alloy W-7Ni-3Fe 3.8 GPa (Zurek & Gray 1991, J. Phys. IV 1,
	               C3-631), quenched and tempered steel 3 GPa, within the range of such steels in Antoun et al. 2003 (Spall Fracture, Springer)
	fractureEnergy of rod and plate [J/m2]: broken pairs pull on until it is spent, (11f); 0: they part at once. The spall strengths above need 14 and 18 kJ/m2 at
	               1 mm, less at finer spacings (Material.longestSpacing())
	strengthSpread relative scatter of both from automaton to automaton, drawn with `seed`
	friction       coefficient of both [-]; None: that of the library
	eos, yieldModel of both materials; yieldModel None: the fullest the library holds (Johnson-Cook with rate and heating)
	viscosity      factor on the artificial viscosity of both [-]
	dtFactor       share of the largest stable time step; account: keep the energy account
	angle          by which the packings are turned against the normal of the plate and the axis of the rod [rad]; see tiedPlate()
	obliquity      between the flight of the rod, which is its axis, and the normal of the plate [rad], up to 75 degrees either way; the axis goes through
	               the middle of the thickness at x = 0
	dimension      3: a round rod and a square plate of automataWidth in space; mode='mca', no angle, no obliquity; s.facts['parts'] is what masses, momenta
	               and energies of the model are to be multiplied with, 4 or 1
	quarter        in space: the quarter x, z >= 0 with planes of symmetry
	Time 0 is the moment of contact: the rod's foremost automata just touch the plate. Raises SceneError (a ValueError) for values out of range.
	"""
	from .materials import DAMAGE_MODELS, Material, get, mcaMat
	if not isinstance(quarter, bool): raise SceneError('quarter must be True or False; got %r' % (quarter, ))
	checkImpact(thickness, spacing, speed, mode, rodLength, rodDiameter, rod, plate, automataWidth, plateWidth, angle, obliquity, dimension)
	if dimension == 3 and (mode != 'mca' or angle or obliquity):
		raise SceneError("dimension=3 needs mode='mca' (grids are in plane strain), angle=0 and obliquity=0; got %r, %r and %r" % (mode, angle, obliquity))
	within('strengthSpread', strengthSpread, 0., 1.)
	within('viscosity', viscosity, 0., 100.)
	within('seed', seed, 0, 2**31 - 1)
	oneOf('damageModel', damageModel, DAMAGE_MODELS)
	if fractureStrain is None: fractureStrain = 1. if damageModel == 'none' else math.inf
	within('fractureStrain', fractureStrain, 0., math.inf, openLow=True)
	if friction is not None:
		within('friction', friction, 0., 10.)
	if np.shape(spallStrength) != (2, ):
		raise SceneError('spallStrength must be two numbers [Pa], of rod and plate; got %r' % (spallStrength, ))
	for x in spallStrength:
		within('spallStrength', x, 0., math.inf, 'Pa', openLow=True)
	if np.shape(fractureEnergy) != (2, ):
		raise SceneError('fractureEnergy must be two numbers [J/m2], of rod and plate; got %r' % (fractureEnergy, ))
	for x in fractureEnergy:
		within('fractureEnergy', x, 0., 1e9, 'J/m2')
	if ends is None: ends = 'fixed' if mode == 'coupled' else 'viscous'

	def material(x, spall, energy):
		if not isinstance(x, (str, Material)):
			return x
		m = get(x, yieldModel=yieldModel)
		constants = dict(fractureStrain=fractureStrain, damageModel=damageModel, spallStrength=spall, fractureEnergy=energy, strengthSpread=strengthSpread, eos=eos, viscosityLinear=viscosity * m.viscosityLinear,
		                 viscosityQuadratic=viscosity * m.viscosityQuadratic)
		return mcaMat(m, **dict(constants, **({} if friction is None else dict(frictionAngle=math.atan(friction)))))

	rodMat, plateMat = (material(*x) for x in zip((rod, plate), spallStrength, fractureEnergy))
	if engineOptions is not None and not isinstance(engineOptions, dict): start(engineOptions)  # refuses it
	options = dict(dict(seed=seed, account=account), **(engineOptions or {}))
	dtFactor = options.get('dtFactor', dtFactor)
	direction = (math.sin(obliquity), -math.cos(obliquity))
	if dimension == 3:
		s = start(options)
		s.automata.dtFactor = dtFactor
		body = rodAndPlate(s, rodMat, plateMat, spacing, thickness, automataWidth, rodLength, rodDiameter, speed, ends, quarter)
		s.facts.update(thickness=thickness, spacing=spacing, automataWidth=automataWidth, mode=mode, ends=ends, plate=plateMat.label, angle=angle, dimension=3, parts=4 if quarter else 1)
	else:
		s = tiedPlate(plateMat, thickness, spacing, automataWidth, plateWidth, mode, ends, dtFactor=dtFactor, angle=angle, engineOptions=options)
		body = _rodPacking(s, spacing, rodLength, rodDiameter, angle, obliquity, direction, thickness)
		s.add('rod', body, rodMat, velocity=(speed * direction[0], speed * direction[1]), mask=ROD, color=(0.8, 0.5, 0.2))
	s.facts.update(speed=speed, rodLength=rodLength, rodDiameter=rodDiameter, rod=rodMat.label, direction=direction, rear=(0., -thickness), normal=(0., -1.),
	               obliquity=obliquity, seed=seed)
	s.facts['restLength'] = measure.geometricLength(body.positions[:, :2], np.zeros(len(body)), 0.5 * rodDiameter, direction)
	return s


def rodMeasure(s):
	"""measure.rodMeasure() of a penetration scene now; reads the solver's arrays, no write-back needed."""
	f = s.fields('rod', ('mass', 'vx', 'vy', 'plasticStrain'))
	return measure.rodMeasure(f['mass'], np.stack((f['vx'], f['vy']), axis=1), f['plasticStrain'], s.facts['speed'], s.facts['direction'])


def rodLength(s):
	"""measure.geometricLength() of a penetration scene now [m]; 1 - rodLength(s)/s.facts['restLength'] is the geometric dl/l0."""
	f, facts = s.fields('rod', ('x', 'y', 'plasticStrain')), s.facts
	return measure.geometricLength(np.stack((f['x'], f['y']), axis=1), f['plasticStrain'], 0.5 * facts['rodDiameter'], facts['direction'])
