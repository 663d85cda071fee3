# SPDX-License-Identifier: GPL-2.0-or-later
"""What a script does in the cells of the matrix, and what is right afterwards: exact physics, or an undisturbed run by the other road.

An action has apply(c), which returns the function that takes it back (None: cannot be), and expect(c): {group: (N, columns)} after c.end steps; numbers that
are NaN and groups that are missing are not compared. c is a cell: c.scene, c.n steps done when the action came, c.left steps after it.
"""
import os

import numpy as np

from matrix_scene import AT, COLUMNS, D, DT, HIT, OTHER, PINNED, SOFT, flight, reference, hexagon

X, V, OMEGA, STRAIN, TEMPERATURE, LINKS = slice(0, 2), slice(2, 4), 4, 6, 7, 8
SHIFT, KICK = np.array((1e-3, -2e-3)), np.array((5., -3.))
#: constants of McaMat: some that a pair uses, some that an automaton uses
CONSTANTS = dict(yieldStress=0.5e9, shearModulus=88e9, bulkSoundSpeed=4900., viscosityLinear=0.5, frictionAngle=0.4)
OBJECT = dict(yieldStress=0.3e9, shearModulus=60e9)


def undisturbed(c, steps=None, **change):
	out = reference(c.road, c.gap, c.end if steps is None else steps, **change)
	if 'F' in out: out['F'] = flight(c.end if steps is None else steps)
	return out


def assign(changes):
	"""Sets (body id, 'state' or 'material' or None, attribute, value) and returns what sets it back."""
	from yade import O
	holder = lambda i, part: getattr(O.bodies[i], part) if part else O.bodies[i]
	kept = lambda v: tuple(v) if hasattr(v, 'norm') else v  # a vector attribute is a reference, which would follow the change
	old = [(i, part, name, kept(getattr(holder(i, part), name))) for i, part, name, _ in changes]

	def set(values):
		for i, part, name, value in values: setattr(holder(i, part), name, value)

	set(changes)
	return lambda: set(old)


class Read:
	"""Nothing is changed: the bodies, and what the engine shows, are those of an undisturbed run."""
	mayRefuse = ()
	words = ()

	def apply(self, c):
		c.seen = c.scene.look()
		if c.road != 'law2':
			e = c.scene.engine()
			ids = np.array(e.ids)
			fields = {k: e.field(k) for k in COLUMNS}
			bodies = c.scene.look()
			for k, f in fields.items():
				for group, now in bodies.items():
					if group == 'grid': continue
					at = np.searchsorted(ids, c.scene.ids[group])
					same = at.max() < len(f) and np.array_equal(f[at], now[:, COLUMNS.index(k)])
					if not same: c.problem("field('%s') of %s is not what the bodies hold" % (k, group))
		return lambda: None

	def expect(self, c):
		return undisturbed(c)

	def check(self, c):
		if c.seen is not None: c.compare('at the stop', c.seen, c.atTheStop())


class SetVelocity:
	"""A flyer flies on with the new velocity, a spin stays, a drifting body drifts on, a body at rest that is hit is as one hit at its start."""
	mayRefuse = ()
	words = ()

	def apply(self, c):
		s, ids = c.scene, c.scene.ids
		from yade import O
		vel = lambda i: np.array(O.bodies[i].state.vel)[:2]
		changes = [(ids['F'][0], 'state', 'vel', (-7., 4., 0.)), (ids['F'][1], 'state', 'angVel', (0., 0., 50.))]
		changes += [(i, 'state', 'vel', (v[0], v[1], 0.)) for i, v in zip(ids['R'], HIT.tolist())]
		kicked = [ids['S'][s.free()]] if s.coupled else ids['S']
		changes += [(i, 'state', 'vel', tuple(vel(i) + KICK) + (0., )) for i in kicked]
		c.momentum = s.momentum('S') + KICK * sum(O.bodies[i].state.mass for i in kicked)
		return assign(changes)

	def expect(self, c):
		e, t = undisturbed(c), c.left * DT
		start = flight(c.n)
		e['F'][0, X], e['F'][0, V] = start[0, X] + np.array((-7., 4.)) * t, (-7., 4.)
		e['F'][1, OMEGA] = 50.
		e['R'] = reference(c.road, c.gap, c.left, hit=HIT)['R']
		if c.scene.coupled: del e['S'], e['grid']
		else: e['S'][:, X] += KICK * t; e['S'][:, V] += KICK
		return e


class Move:
	"""Bodies put elsewhere as wholes go on there as they would have here; a target put aside is hit where it is."""
	mayRefuse = ()
	words = ()

	def apply(self, c):
		from yade import O
		ids = c.scene.ids
		moved = [(ids['F'][0], (2e-3, 1e-3))] + [(i, (0., 3e-3)) for i in ids['R']] + [(i, (0., 0.4 * D)) for i in ids['C2']]
		if not c.scene.coupled: moved += [(i, SHIFT) for i in ids['S']]
		at = lambda i, by: tuple(np.array(O.bodies[i].state.pos)[:2] + by) + (0., )
		return assign([(i, 'state', 'pos', at(i, by)) for i, by in moved])

	def expect(self, c):
		e = undisturbed(c)
		e['F'][0, X] += (2e-3, 1e-3)
		e['R'][:, X] += (0., 3e-3)
		if not c.scene.coupled: e['S'][:, X] += SHIFT
		hit = reference(c.road, c.gap, c.end, shift=(0., 0.4 * D))
		e['C1'], e['C2'] = hit['C1'], hit['C2']
		return e


class Erase:
	"""What is erased is gone; a body at rest stays at rest; without its target C1 flies on; a stressed body keeps the momentum of what is left."""
	mayRefuse = 'all'
	words = ('body|bodies', '^(?!.*damaged)')  # nothing is damaged when a script erases a body

	def apply(self, c):
		from yade import O
		s, ids = c.scene, c.scene.ids
		inner = s.free() if s.coupled else 12
		for group, k in ('F', 0), ('R', 3), ('S', inner):
			O.bodies.erase(ids[group].pop(k))
		for i in ids['C2']: O.bodies.erase(i)
		ids['C2'] = []
		c.momentum = s.momentum('S')
		return None

	def expect(self, c):
		e = undisturbed(c, target=False)
		e['F'] = np.delete(e['F'], 0, axis=0)
		e['R'] = np.delete(e['R'], 3, axis=0)
		e['R'][:, LINKS] -= 1
		e['C2'] = np.zeros((0, len(COLUMNS)))
		del e['S']
		e.pop('grid', None)
		return e

	def check(self, c):
		v = c.scene.look()['S'][:, V]
		if not abs(v).max() < 300: c.problem('speed %.3g m/s in the body that an automaton was erased from' % abs(v).max())


class Add:
	"""A new flyer flies; a new body that is hit is linked and moves as one made before the first step."""
	mayRefuse = 'all'
	words = ('body|bodies', )

	def apply(self, c):
		from yade import O
		from yade_mca import packings
		s = c.scene
		m = s.body('R', 0).material
		one = hexagon((0., 0.)).select([3])
		s.ids['F'] += packings.addBodies(one.translated(np.array((-60e-3, 80e-3)) - one.positions[0]), m, velocity=(2., 3.))
		s.ids['Q'] = packings.addBodies(hexagon(AT['Q']), m, velocity=HIT)

		def undo():
			for i in [s.ids['F'].pop()] + s.ids.pop('Q'): O.bodies.erase(i)

		return undo

	def expect(self, c):
		e = undisturbed(c)
		new = np.zeros((1, len(COLUMNS)))
		new[0, X], new[0, V], new[0, TEMPERATURE] = np.array((-60e-3, 80e-3)) + np.array((2., 3.)) * c.left * DT, (2., 3.), 298.
		e['F'] = np.concatenate((e['F'], new))
		e['Q'] = reference(c.road, c.gap, c.left, hit=HIT)['R']
		e['Q'][:, X] += np.array(AT['Q']) - AT['R']
		return e


class Block:
	"""Of a target at rest another automaton is held and the one held before is freed; a flyer that is blocked keeps its velocity."""
	mayRefuse = 'all'
	words = ('body|bodies', 'blockedDOFs')

	def apply(self, c):
		ids = c.scene.ids
		held = (ids['C2'][OTHER], 'xyzXYZ'), (ids['C2'][PINNED], 'zXY'), (ids['F'][0], 'xyzXYZ')
		return assign([(i, 'state', 'blockedDOFs', dofs) for i, dofs in held])

	def expect(self, c):
		return undisturbed(c, pinned=OTHER)


class Constants:
	"""Constants of the McaMat of bodies that are not stressed yet: as if they had been so from the start."""
	mayRefuse = 'all'
	words = ('material', '|'.join(CONSTANTS))

	def apply(self, c):
		return assign([(i, 'material', name, value) for i in c.scene.ids['C1'] + c.scene.ids['C2'] for name, value in CONSTANTS.items()])

	def expect(self, c):
		return undisturbed(c, constants=CONSTANTS)


class AnotherMaterial:
	"""The target gets another McaMat before it is hit."""
	mayRefuse = 'all'
	words = ('body|bodies', 'material')

	def apply(self, c):
		from yade import O
		from yade_mca import materials
		new = materials.mcaMat('4340', **dict(SOFT, **OBJECT))
		O.materials.append(new)
		return assign([(i, None, 'material', new) for i in c.scene.ids['C2']])

	def expect(self, c):
		return undisturbed(c, object=OBJECT)


class SetState:
	"""An attribute of McaState of C1 and C2; what it does is what other constants of the material do."""
	mayRefuse = 'all'

	def __init__(self, name, value, constants, column=None):
		self.name, self.value, self.constants, self.column, self.words = name, value, constants, column, ('body', name)

	def apply(self, c):
		return assign([(i, 'state', self.name, self.value) for i in c.scene.ids['C1'] + c.scene.ids['C2']])

	def expect(self, c):
		e = undisturbed(c, constants=self.constants)
		for group in 'C1', 'C2':
			if self.column == STRAIN: e[group][:, STRAIN] += self.value
			if self.column == TEMPERATURE: e[group][:, TEMPERATURE] = self.value
		return e


class SetOutput:
	"""What the engine computes cannot be set: refused, with the name of what can."""
	mayRefuse = 'all'
	mustRefuse = True

	def __init__(self, name, value):
		self.name, self.value, self.words = name, value, ('body', name)

	def apply(self, c):
		return assign([(c.scene.ids['S'][c.scene.free()], 'state', self.name, self.value)])

	def expect(self, c):
		return undisturbed(c)


class TiedVelocity:
	"""An automaton of a tied row moves with the grid: a velocity of its own is refused."""
	mayRefuse = 'all'
	mustRefuse = True
	words = ('body', 'tied|grid')

	def apply(self, c):
		return assign([(list(c.scene.engine('McaGridCoupler').rowIds)[2], 'state', 'vel', (90., -40., 0.))])

	def expect(self, c):
		return undisturbed(c)


class Save:
	"""The saved file, loaded, is the state at the stop and goes on as the run itself does."""
	mayRefuse = ()
	words = ()

	def apply(self, c):
		from yade import O
		self.file = os.path.join(c.folder, 'saved.yade.gz')
		O.save(self.file)
		return lambda: None

	def expect(self, c):
		return undisturbed(c)

	def check(self, c):
		from yade import O
		start, end = c.atTheStop(), undisturbed(c)
		O.load(self.file)
		c.compare('loaded', c.scene.look(), start)
		c.goOn()
		c.compare('loaded and gone on', c.scene.look(), end)


_HOT = 1. - (900. - 298.) / (1793. - 298.)  #: share of the strength left at 900 K
A, B = SOFT['yieldStress'], SOFT['hardeningModulus']
ACTIONS = {
        'read': Read(),
        'set velocity': SetVelocity(),
        'move': Move(),
        'erase': Erase(),
        'add': Add(),
        'block': Block(),
        'material constants': Constants(),
        'another material': AnotherMaterial(),
        'temperature': SetState('temperature', 900., dict(yieldStress=A * _HOT, hardeningModulus=B * _HOT), TEMPERATURE),
        'plastic strain': SetState('plasticStrain', 0.3, dict(yieldStress=A + 0.3 * B), STRAIN),
        'strength': SetState('strength', 0.5, dict(fractureStress=0.5 * SOFT['fractureStress'])),
        'output': SetOutput('pressure', 1.23e9),
        'tied velocity': TiedVelocity(),
        'save': Save(),
}
