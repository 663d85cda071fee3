# SPDX-License-Identifier: GPL-2.0-or-later
"""What test_every_call.py has to be told: right arguments of methods, and values that are rightly accepted (tests/data/every_call.csv).

An attribute or argument that is in neither gets the strictest treatment: every kind of value in every_call_values must be refused.
"""
import support

#: YADE's own, of no effect on what is computed here
NOT_OURS = {'timingDeltas', 'dispIndex', 'dispHierarchy', 'bases'}
#: methods that are refused in the first scene, for a reason
LATE = {'McaGridEngine.gauge': 'there is no gauge yet', 'Engine.__call__': 'half of a step by itself', 'McaSolverEngine': 'a base class', 'McaDensity': 'McaLaw by its old name'}
#: classes whose objects go with their bodies
OF_BODIES = ('Law2_ScGeom_McaPhys_Mca', 'McaMat', 'McaState', 'State', 'FrictMat', 'ElastMat', 'Material', 'NormPhys', 'NormShearPhys', 'McaPhys')
#: moments at which the steps may be refused without any call
MAY_FAIL = ('foreign', 'halfMade', 'noState', 'emptyScene', 'erased', 'afterReset')
#: other words by which a message may call an attribute or argument
ALSO_CALLED = {
        'pos': ('position', ), 'vel': ('velocity', ), 'angVel': ('angular velocity', 'spin'), 'ori': ('orientation', ), 'frictionAngle': ('friction', ),
        'plasticStrain': ('plastic strain', ), 'heatCapacity': ('taylorQuinney/(density heatCapacity)', ), 'ids': ('body', 'bodies'), 'nodes': ('node', ),
        'xs': ('line', 'rising'), 'ys': ('line', 'rising'), 'i': ('node', ), 'j': ('node', ), 'start': ('nodes', ), 'end': ('nodes', ), 'number': ('gauge', ),
        'what': ('view', ), 'at': ('point', 'gauge'), 'automata': ('McaEngine', ), 'grid': ('McaGridEngine', ), 'McaEngine.field(name)': ('field', ),
        **{k: ('unknown material', 'material', 'newAssocState') for k in ('name', 'material', 'rod', 'plate', 'flyer', 'target')}
}

# ---- right arguments

BY_NAME = {
        'block': 0, 'side': 'left', 'start': 0, 'end': -1, 'nodes': [0, 1], 'direction': (1., 0.), 'velocity': (1., 0.), 'at': (1e-3, 1e-3), 'period': 1,
        'number': 0, 'n': 5, 'ids': [0, 1], 'normal': (1., 0.), 'name': 'vx', 'i': 1, 'j': 1, 'what': 'x', 'xs': [10e-3, 11e-3, 12e-3],
        'ys': [0., 1e-3, 2e-3], 'value': 1e6, 'names': ['x'], 'pairs': [(0, 1)], 'volumeRatio': 0.95, 'plasticStrain': 0.1, 'rate': 10., 'temperature': 400., 'threads': 1
}
BY_TYPE = {'int': 0, 'float': 1., 'str': '', 'bool': True, 'object': 1.}
ARGUMENTS = {
        'McaEngine.prescribe': {'x': 1.}, 'McaEngine.push': {'x': 1.}, 'McaEngine.press': {'pressure': 1e6}, 'McaEngine.setStress': {'stress': (1e6, 0., 0.)},
        'McaGridEngine.setCells': {'plasticStrain': 0.1},
        'McaGridEngine.addBlock': {'x': [[10e-3, 11e-3], [10e-3, 11e-3]], 'y': [[0, 0], [1e-3, 1e-3]]},
        'McaGridEngine.prescribeNodes': {'velocity': 1.},
        'McaGridEngine.probeLine': {'start': (0., 1e-3), 'end': (3e-3, 1e-3)},
}


def goodArguments(key, given):
	"""Function of the object that makes right arguments of a method; given: [(type, name, has a default)]."""

	def make(thing):
		import every_call_scenes as scenes
		out = {}
		for t, name, default in given:
			if default and name not in ('start', 'end') and name not in ARGUMENTS.get(key, ()): continue
			if t == 'Material' or name in ('material1', 'material2'): out[name] = scenes.metal()
			elif name in ARGUMENTS.get(key, ()): out[name] = ARGUMENTS[key][name]
			elif name in BY_NAME: out[name] = BY_NAME[name]
			elif t.startswith('Vector'): out[name] = (0., ) * int(t[6])
			else: out[name] = BY_TYPE.get(t, 1.)
		return out

	return make


# ---- what is rightly accepted

ALL = '*'
#: 'Class.attribute' or 'Class.method(argument)' -> (kinds of values, reason); Class is the one that defines it
ACCEPTED = {row['call']: (row['kinds'], row['reason']) for row in support.table('every_call.csv')}


def accepted(key, kind, moment):
	kinds = ACCEPTED.get(key, ('', ))[0]
	if '(' not in key and moment in ('stale', 'afterReset', 'emptyScene') and (moment == 'stale' or key.split('.')[0] in OF_BODIES):
		return True  # of an object that no scene holds any more: nothing reads it
	return kinds == ALL or kind in kinds.split()
