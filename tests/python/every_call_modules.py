# SPDX-License-Identifier: GPL-2.0-or-later
"""Every function and method of the package's modules that scripts call, with bad arguments, for test_every_call.py; found by looking at the modules."""
import dataclasses
import importlib
import inspect

import every_call_judge as judge
import every_call_table as table
import every_call_values as values
from every_call_classes import Call

MODULES = ('packings', 'outlines', 'measure', 'materials', 'scenes')
#: records that functions return: nobody makes them
RESULTS = ('RodMeasure', 'CellGeometry', 'Scene')
D = 1e-3


def packing():
	from yade_mca import packings
	return packings.hexagonal(D, packings.Rectangle((0, 0), (4 * D, 3 * D)))


def spacePacking():
	from yade_mca import packings
	return packings.fcc(D, ball())


def ball():
	from yade_mca import packings
	return packings.Ball((0., 0., 0.), 2 * D)


def rectangle():
	from yade_mca import outlines
	return outlines.Rectangle((0, 0), (4 * D, 3 * D))


def predicate():
	from yade import pack
	return pack.inSphere((0, 0, 0), 4 * D)


def bodies():
	from yade_mca import packings
	return packings.addBodies(packing(), '4340')


def record():
	from yade_mca import materials
	return materials.get('4340')


def penetrationScene():
	from yade_mca import scenes
	return scenes.penetration(**{k: v for k, v in argumentsOf('scenes.penetration').items()})


def strips():
	from yade_mca import scenes
	return scenes.plateImpact('4340', '4340', 4 * D, 4 * D, 6 * D, D, 50.)


def wholeBodies():
	from yade_mca import packings
	return packings.addBodies(packings.hexagonal(D, rectangle(), rim='full'), '4340')


def anEngine():
	from yade import O
	from yade.wrapper import McaEngine
	bodies()
	O.engines = [McaEngine()]
	return O.engines[0]


#: right arguments by name; functions make fresh ones. Where a name means different things: 'module.function.name'
GOOD = {
        'd': D, 'spacing': D, 'outline': rectangle, 'angle': 0., 'origin': (0., 0.), 'rim': 'cells', 'minWeight': 0.2, 'dim': None,
        'packing': packing, 'material': '4340', 'velocity': (1., 0.), 'angularVelocity': 0., 'mask': 1, 'color': (0.5, 0.5, 0.5), 'by': (D, 0.),
        'which': [0, 1, 2], 'point': (0., 0.), 'direction': (0., 1.), 'tolerance': 1e-3, 'scale': 1., 'density': 7800.,
        'points': [(0, 0), (D, 0), (0, D)], 'holes': (), 'center': (0., 0.), 'size': (4 * D, 3 * D), 'radius': 3 * D, 'segments': 60,
        'predicate': predicate, 'z': 0., 'pad': 0., 'shape': rectangle, 'cells': [[(0, 0), (D, 0), (0, D)]], 'mass': [1., 1.],
        'plasticStrain': [0., 0.2], 'impactSpeed': 100., 'positions': [(0., 0.), (0., -D)], 'values': [1., 2.], 'rear': (0., 0.), 'quantile': 0.95, 'time': [0., 1., 2.], 'volume': [1e-6, 1e-6], 'step': D, 'surface': (0., 0.), 'parts': 1.,
        'momentum': [3., 2., 2.], 'window': 0.5, 'name': '4340', 'label': 'x', 'yieldModel': 'perfect', 'rate': 1., 'temperature': 300.,
        'triaxiality': 0.3, 'volumeRule': 'affine', 'stepFactor': 0.4, 'length': 5 * D, 'height': 3 * D, 'upper': packing, 'lower': packing,
        'flyer': '4340', 'target': '4340', 'flyerThickness': 3 * D, 'targetThickness': 3 * D, 'speed': 50., 'lateral': 'fixed', 'diameter': 3 * D,
        'friction': 0.1, 'engineOptions': None, 'start': 0., 'end': 10 * D, 'first': D, 'growth': 1.1, 'largest': 3 * D, 'thickness': 3 * D,
        'automataWidth': 8 * D, 'plateWidth': 20 * D, 'mode': 'coupled', 'ends': 'fixed', 'scene': None, 'dtFactor': 0.4, 'rodLength': 4 * D,
        'rodDiameter': 3 * D, 'rod': 'WHA_JC', 'plate': '4340', 'fractureStrain': 1., 'spallStrength': (3e9, 3e9), 'strengthSpread': 0.05,
        'eos': 'shockAdiabat', 'viscosity': 1., 'seed': 1, 'part': 'rod', 'normal': (0., -1.), 'begin': 0., 'rows': 4, 'anvil': 'smooth',
        'obliquity': 0., 'vx': 10., 's': penetrationScene, 'scenes.profile.s': strips, 'scenes.profile.part': 'flyer', 'scenes.driveEnd.s': strips,
        'scenes.addStrip.packing': lambda: packing().translated((0.5, 0.)), 'scenes.driveEnd.part': 'flyer', 'scenes.taylorBar.anvil': 'rough',
        'ids': [0, 1], 'links': [(0, 1)], 'number': 10., 'mean': 2., 'measure.fragments.velocity': [(0., -90.), (0., -80.)], 'measure.fragmentsOf.engine': anEngine,
        'measure.rodMeasure.velocity': [(0., -90.), (0., -80.)], 'measure.speedAlong.velocity': [(0., -90.), (0., -80.)],
        'packings.resetStates.ids': bodies, 'packings.clump.ids': wholeBodies, 'packings.cellGeometry.name': 'hexagonal', 'packings.create.name': 'hexagonal', 'scenes.tiedPlate.largest': 3.,
        'materials.Material.flowStress.plasticStrain': 0.1, 'materials.Material.johnsonCookFractureStrain.triaxiality': 0.3,
        'measure.momentumSettled.tolerance': 1e-3, 'outlines.Polygon.classify.radius': D, 'packings.fcc.shape': ball,
        'packings.fcc.rim': 'full', 'packings.fcc.mirror': '', 'packings.fcc.origin': (0., 0., 0.), 'packings.fcc.orientation': ((1., 1., 1.), (1., -1., 0.)), 'packings.SpacePacking.translated.by': (D, 0., 0.),
        'packings.Box.low': (0., 0., 0.), 'packings.Box.high': (D, D, D), 'packings.Cylinder.start': (0., 0., 0.), 'packings.Cylinder.end': (0., 0., D),
        'packings.Ball.centre': (0., 0., 0.), 'packings.Box.inside.points': [(0., 0., 0.)], 'packings.Cylinder.inside.points': [(0., 0., 0.)],
        'packings.Ball.inside.points': [(0., 0., 0.)]
}


def argumentsOf(where, function=None):
	"""Right arguments of a function as a dict; those that have a default and no entry in GOOD are left to it."""
	if function is None: function = getattr(importlib.import_module('yade_mca.' + where.split('.')[0]), where.split('.')[1])
	out = {}
	for p in inspect.signature(function).parameters.values():
		if p.name in ('self', 'cls') or p.kind in (p.VAR_KEYWORD, p.VAR_POSITIONAL): continue
		value = GOOD.get('%s.%s' % (where, p.name), GOOD.get(p.name, p.default if p.default is not p.empty else 1.))
		out[p.name] = value() if inspect.isfunction(value) else value
	return out


def constants():
	"""The keywords of materials.get(): all constants of a material with their values."""
	r = record()
	return {f.name: getattr(r, f.name) for f in dataclasses.fields(r) if f.name in keywords()}


def keywords():
	from yade_mca import materials
	return materials.MCAMAT_ATTRIBUTES


def kindsOf(value, name):
	"""Bad values instead of this right one."""
	if isinstance(value, bool): return {}  # Python counts the truth of anything
	if isinstance(value, int): return values.INT
	if isinstance(value, float): return values.FLOAT
	if name in ('material', 'rod', 'plate', 'flyer', 'target') and isinstance(value, str): return {**values.TEXT, **values.objects(None)}
	if isinstance(value, str): return values.TEXT
	if isinstance(value, tuple) and value and all(isinstance(v, float) for v in value): return values.vector(len(value))
	if name in ('engineOptions', 'scene', 'friction', 'label'): return {k: v for k, v in values.ANY.items() if k not in ('none', 'dict', 'empty')}
	if isinstance(value, (list, tuple)) or value is None: return values.ANY
	return values.objects(None)


def targets(module):
	"""(name within the module, function of a ready object or None, callable) of all that scripts may call."""
	m = importlib.import_module('yade_mca.' + module)
	for name, thing in vars(m).items():
		home = str(getattr(thing, '__module__', None)).split('.')
		if name not in m.__all__ or home[0] != 'yade_mca' or home[-1] != module and home[-1] in MODULES or name in RESULTS: continue
		if inspect.isfunction(thing): yield name, None, thing
		elif inspect.isclass(thing) and not issubclass(thing, BaseException):
			if not dataclasses.is_dataclass(thing): yield name, None, thing
			for method, f in vars(thing).items():
				if inspect.isfunction(f) and not method.startswith('_'): yield '%s.%s' % (name, method), ready(module, name, thing), f


def ready(module, name, cls):
	made = {'Packing': packing, 'SpacePacking': spacePacking, 'Material': record, 'Scene': penetrationScene}
	return made.get(name) or (lambda: cls(**argumentsOf('%s.%s' % (module, name), cls)))


def after(module, name):
	"""What a script does next with what it has got."""
	from yade import O
	from yade.wrapper import McaEngine
	if module == 'packings' and name == 'addBodies': O.engines = [McaEngine()]
	if len(O.bodies) or any(type(e).__name__ == 'McaGridEngine' for e in O.engines): O.step()


def call(module, name, owner, function, argument=None, kind='good', value=None):
	def run():
		from yade import O
		O.reset()
		where = '%s.%s' % (module, name)
		given = argumentsOf(where, function)
		if argument in keywords() and where == 'materials.get': given['yieldModel'] = None
		made = owner() if owner else None
		if argument is not None: given[argument] = value
		act = lambda: function(made, **given) if owner else function(**given)
		if argument is not None:
			key = '%s(%s)' % (where, argument)
			return judge.attempt(act, lambda: after(module, name), judge.words(key), table.accepted(key, kind, 'before'), still=False, where=[''])
		try:
			act()
			after(module, name)
		except Exception as e:
			return 'broken', judge.told(e)
		return 'accepted', ''

	return run


def everyCall():
	for module in MODULES:
		for name, owner, function in targets(module):
			where = '%s.%s' % (module, name)
			yield Call('%s = good' % where, where, 'good', 'before', call(module, name, owner, function))
			arguments = argumentsOf(where, function)
			if where == 'materials.get': arguments.update(constants())
			for argument, value in arguments.items():
				for kind, bad in kindsOf(value, argument).items():
					run = call(module, name, owner, function, argument, kind, bad)
					yield Call('%s(%s) = %s' % (where, argument, kind), where, kind, 'before', run)
