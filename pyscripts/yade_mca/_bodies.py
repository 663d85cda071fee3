# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE bodies made of packings; used through packings.addBodies() and packings.resetStates()."""
import math
import reprlib

import numpy as np

from ._arguments import array, number, whole


def material(m):
	"""A yade material from a McaMat, a name or a record of the library, appended to O.materials when it is not there yet."""
	from ._yade import scene
	from .materials import Material, mcaMat
	from .packings import PackingError
	if isinstance(m, (str, Material)): m = mcaMat(m)
	if not (hasattr(m, 'newAssocState') and hasattr(m, 'density')):
		raise PackingError('material must be a McaMat, or a name or record of the library (materials.names()); got %r' % (m, ))
	if getattr(m, 'id', 0) < 0:
		scene().materials.append(m)
	return m


def _motion(packing, velocity, angularVelocity):
	"""Checked velocities (N, 3) and spin (3,), lists. Raises PackingError."""
	from .packings import Packing, PackingError
	n, dim = len(packing), 2 if isinstance(packing, Packing) else 3
	velocity = array('velocity', np.zeros(dim) if velocity is None else velocity, PackingError, ((dim, ), (n, dim)))
	if dim == 2 or np.ndim(angularVelocity) == 0: spin = [0., 0., number('angularVelocity', angularVelocity, PackingError, unit=' rad/s')]
	else: spin = array('angularVelocity', angularVelocity, PackingError, (3, )).tolist()
	v = np.array(np.broadcast_to(velocity, (n, dim)))
	for c in range(dim) if dim == 3 else (): v[packing.mirrors >> c & 1 == 1, c] = 0.
	return _threeComponents(v), spin


def _blocked(packing, fixed):
	"""State.blockedDOFs of each automaton."""
	from .packings import Packing
	if fixed: return ['xyzXYZ'] * len(packing)
	if isinstance(packing, Packing): return ['zXY'] * len(packing)
	across = ('xYZ', 'yXZ', 'zXY')  # a plane of symmetry: along its normal, and turns but about it
	of = [''.join(sorted(set(''.join(a for c, a in enumerate(across) if k >> c & 1)))) for k in range(8)]
	return [of[k] for k in packing.mirrors.tolist()]


def _threeComponents(v):
	return np.concatenate((v, np.zeros((len(v), 3 - v.shape[1]))), axis=1).tolist()


def addBodies(packing, material, velocity=None, angularVelocity=0., mask=1, fixed=False, color=None):
	"""One YADE body (a Sphere of radius d/2; in plane strain at z = 0) per automaton; returns their ids, a list of int in the packing's order.

	packing      a Packing of hexagonal(), then the bodies are in plane strain, or a SpacePacking of fcc(), then in space; a scene takes one kind
	material     McaMat, or a name or record of the library; needs density [kg/m3]
	velocity     (2,) or (N, 2), in space (3,) or (N, 3) [m/s]; None: at rest. Automata on a plane of symmetry do not move across it: that component is 0
	angularVelocity  of each automaton about z; in space (3,), too [rad/s]
	mask         Body.mask (int, its 32 bits), by which other engines tell groups of bodies apart
	fixed        True: all degrees of freedom are blocked, so that the bodies keep the velocity they have; else in plane strain those out of it, 'zXY', and in
	             space those that a plane of symmetry takes away
	color        (r, g, b) in 0 ... 1, default grey
	Mass is weight * density * Omega0, and the moment of inertia in plane strain m R^2/2 (disc), both per 1 m of thickness, in space that of the sphere of
	the same volume. With rim='triangles' state.triangles says for how many each stands: an engine that finds another number, or another mass, refuses the
	body instead of giving it another surface.
	Raises PackingError for an argument that is not finite, out of range or of the wrong shape, before there is a body.
	"""
	from ._yade import scene, yadeClass
	from .packings import Packing, PackingError, SpacePacking
	if not isinstance(packing, (Packing, SpacePacking)):
		raise PackingError('packing must be a Packing, as hexagonal() makes one, or a SpacePacking, as fcc() does; got %r' % (packing, ))
	velocities, spin = _motion(packing, velocity, angularVelocity)
	mask = whole('mask', mask, PackingError, -2**31, 2**31 - 1)
	color = (0.6, 0.6, 0.6) if color is None else tuple(array('color', color, PackingError, (3, )).tolist())
	if not all(0 <= c <= 1 for c in color):
		raise PackingError('color must be (r, g, b), each from 0 to 1; got %r' % (color, ))
	m = _material(material)
	if not (m.density > 0 and math.isfinite(m.density)):
		raise PackingError('density of the material must be above 0; it is %r' % m.density)
	flat, radius, masses = isinstance(packing, Packing), packing.radius, packing.masses(m.density)
	inertias = 0.5 * radius**2 * masses if flat else packing.inertias(m.density)
	triangles = np.round(6 * packing.weight).astype(int) if flat and packing.rim == 'triangles' else np.zeros(len(packing), int)
	Body, Sphere = yadeClass('Body'), yadeClass('Sphere')
	mirrors = [0] * len(packing) if flat else packing.mirrors.tolist()
	bodies, rows = [], zip(_threeComponents(packing.positions), velocities, masses.tolist(), inertias.tolist(), triangles.tolist(), mirrors, _blocked(packing, fixed))
	for position, v, mass, inertia, around, mirror, blocked in rows:
		b = Body()
		b.shape = Sphere(radius=radius, color=color)
		b.material = m
		s = m.newAssocState()
		s.pos = s.refPos = position
		s.vel, s.angVel = v, spin
		s.mass, s.inertia = mass, (inertia, inertia, inertia)
		if around: s.triangles = around
		if mirror: s.mirrors = mirror
		s.blockedDOFs = blocked
		b.state = s
		b.mask = mask
		bodies.append(b)
	return scene().bodies.append(bodies)


_material = material  # where an argument has the same name


def _automata(ids):
	"""The bodies of these ids, list. Raises PackingError for an id that is no automaton."""
	from ._yade import scene, yadeClass
	from .packings import PackingError
	o, State, Mat, Sphere = scene(), yadeClass('McaState'), yadeClass('McaMat'), yadeClass('Sphere')
	if not isinstance(ids, (list, tuple, range)) and not (isinstance(ids, np.ndarray) and ids.ndim == 1):
		raise PackingError('ids must be a row of whole numbers, each the id of an automaton in O.bodies; got %s' % reprlib.repr(ids))
	bodies = []
	for i in [whole('each of ids', i, PackingError) for i in ids]:
		b = o.bodies[i] if i < len(o.bodies) else None
		if b is None or not isinstance(b.material, Mat) or not isinstance(b.shape, Sphere) or not isinstance(b.state, State):
			raise PackingError('ids: body %d must be an automaton in O.bodies (material McaMat, shape Sphere, state McaState)' % i)
		bodies.append(b)
	return bodies


def clump(ids):
	"""Makes automata one rigid body, a clump of YADE; returns its id (int).

	ids: two or more automata that addBodies() has made, whole numbers. Mass [kg, in plane strain kg/m] and inertia [kg m2, kg m] are those of the members, where
	O.bodies.clump() would take the volumes of spheres; in plane strain motion along z and about x and y stays blocked. The mask is that of the first. What YADE has moves it (NewtonIntegrator with
	a mask that has a bit of it), and automata of McaEngine touch it (12b); McaLaw refuses clumps of automata.
	The mean velocity by mass goes on; what is within 1 % of it, and spins, do not. Automata that an engine moves leave it in its next step. Raises PackingError for fewer than two ids, one that is
	named twice, is no automaton or belongs to a clump already, for velocities that differ by more, and where the centre of mass is not that of the spheres.
	"""
	from ._yade import scene
	from .packings import PackingError
	members = _automata(ids)
	if len(members) < 2 or len({b.id for b in members}) < len(members): raise PackingError('ids must be two or more different automata; got %s' % reprlib.repr(ids))
	for b in members:
		if b.isClumpMember: raise PackingError('ids: body %d belongs to a clump already; each must stand alone' % b.id)
	o, states = scene(), [b.state for b in members]
	velocities, places, weights = (np.array(v) for v in ([tuple(s.vel) for s in states], [tuple(s.pos) for s in states], [s.mass for s in states]))
	mean = weights @ velocities / weights.sum()
	spread = abs(velocities - mean).max()
	if spread > 0.01 * abs(velocities).max(): raise PackingError('ids: velocities must be those of one motion; they differ by %.3g m/s from their mean, and a clump has but that' % spread)
	radii = np.array([b.shape.radius for b in members])
	off = np.linalg.norm(weights @ places / weights.sum() - radii**3 @ places / (radii**3).sum())  # YADE puts the centre by the volumes of spheres
	if off > 1e-3 * radii.max(): raise PackingError("ids: the centre of mass is %.3g m off that of spheres; use automata of one size and of whole cells (rim='full')" % off)
	number = o.bodies.clump([b.id for b in members])
	body, mass = o.bodies[number], sum(s.mass for s in states)
	body.mask, s = members[0].mask, body.state
	if all(set('zXY') <= set(m.blockedDOFs) for m in states):
		around = sum(m.inertia[2] + m.mass * ((m.pos[0] - s.pos[0])**2 + (m.pos[1] - s.pos[1])**2) for m in states)
		s.inertia, s.blockedDOFs = (around, ) * 3, 'zXY'  # the same about all axes: YADE turns the frame of a clump as it likes
	else:
		s.inertia = s.inertia * (mass / s.mass)
	s.mass, s.vel = mass, mean.tolist()
	return number


def resetStates(ids):
	"""Gives automata the state of rest: a fresh McaState with the position, velocity, orientation, spin, mass, inertia, blockedDOFs and strength of the old one.

	ids: of bodies in O.bodies with material McaMat and shape Sphere, whole numbers. For bodies that another engine has moved: links are made anew from where
	they are now (the engine refuses a packing that is too distorted for it), pressure, stresses, plastic strain and heat are gone, the temperature is the
	material's referenceTemperature. An engine takes over bodies in this state when it gathers them for the first time; the one that has moved them refuses
	the next step, so put a new one into O.engines. state.triangles is 0: where a body ends is seen by the masses, as far as it is still whole.
	Raises PackingError for an id that is no automaton, before any state is changed.
	"""
	bodies = _automata(ids)
	for b in bodies:
		old, new = b.state, b.material.newAssocState()
		for name in ('pos', 'ori', 'vel', 'angVel', 'angMom', 'mass', 'inertia', 'refPos', 'refOri', 'blockedDOFs', 'isDamped', 'densityScaling', 'strength', 'mirrors'):
			setattr(new, name, getattr(old, name))
		b.state = new
