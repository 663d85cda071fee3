# SPDX-License-Identifier: GPL-2.0-or-later
"""What test_every_call.py has to be told: right arguments of methods, and values that are rightly accepted, each with its reason.

An attribute or argument that is missing here gets the strictest treatment: every kind of value in every_call_values must be refused.
"""
#: YADE's own, of no effect on what is computed here
NOT_OURS = {'timingDeltas', 'dispIndex', 'dispHierarchy', 'bases'}
#: methods that are refused in the first scene, for a reason
LATE = {'McaGridEngine.gauge': 'there is no gauge yet', 'Engine.__call__': 'half of a step by itself', 'McaSolverEngine': 'a base class'}
#: classes whose objects go with their bodies
OF_BODIES = ('McaMat', 'McaState', 'State', 'FrictMat', 'ElastMat', 'Material', 'NormPhys', 'NormShearPhys', 'McaPhys')
#: moments at which the steps may be refused without any call
MAY_FAIL = ('foreign', 'halfMade', 'noState', 'emptyScene', 'erased', 'afterReset')
#: other words by which a message may call an attribute or argument
ALSO_CALLED = {
        'pos': ('position', ), 'vel': ('velocity', ), 'angVel': ('angular velocity', 'spin'), 'ori': ('orientation', ), 'frictionAngle': ('friction', ), 'ids': ('body', 'bodies'),
        'nodes': ('node', ), 'xs': ('line', 'rising'), 'ys': ('line', 'rising'), 'i': ('node', ), 'j': ('node', ), 'number': ('gauge', ), 'what': ('view', ), 'at': ('point', 'gauge'),
        'start': ('nodes', ), 'end': ('nodes', ), 'McaEngine.field(name)': ('field', ), **{k: ('unknown material', 'material', 'newAssocState') for k in ('name', 'material', 'rod', 'plate', 'flyer', 'target')}, 'automata': ('McaEngine', ), 'grid': ('McaGridEngine', ), 'plasticStrain': ('plastic strain', ), 'heatCapacity': ('taylorQuinney/(density heatCapacity)', )
}

# ---- right arguments

BY_NAME = {
        'block': 0, 'side': 'left', 'start': 0, 'end': -1, 'nodes': [0, 1], 'direction': (1., 0.), 'velocity': (1., 0.), 'at': (1e-3, 1e-3), 'period': 1, 'number': 0, 'n': 5, 'ids': [0, 1],
        'normal': (1., 0.), 'name': 'vx', 'i': 1, 'j': 1, 'what': 'x', 'xs': [10e-3, 11e-3, 12e-3], 'ys': [0., 1e-3, 2e-3], 'value': 1e6, 'volumeRatio': 0.95, 'plasticStrain': 0.1, 'rate': 10.,
        'temperature': 400., 'threads': 1
}
BY_TYPE = {'int': 0, 'float': 1., 'str': '', 'bool': True, 'object': 1.}
ARGUMENTS = {
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
			if default and name not in ('start', 'end'): continue
			if t == 'Material': out[name] = scenes.metal()
			elif name in ARGUMENTS.get(key, ()): out[name] = ARGUMENTS[key][name]
			elif name in BY_NAME: out[name] = BY_NAME[name]
			elif t.startswith('Vector'): out[name] = (0., ) * int(t[6])
			else: out[name] = BY_TYPE.get(t, 1.)
		return out

	return make


#: arguments of functions of the modules that are not tried
SELDOM = {}

# ---- what is rightly accepted: kinds of values, reason

ALL = '*'
ACCEPTED = {
        # YADE's own attributes, which YADE reads
        'Engine.label': (ALL, 'a name for the script'), 'Functor.label': (ALL, 'a name for the script'), 'Material.label': (ALL, 'a name for the script'),
        'Engine.dead': (ALL, 'YADE leaves the engine out'), 'Engine.ompThreads': (ALL, "YADE's; not read here"), 'Engine.execTime': (ALL, 'a count of YADE'), 'Engine.execCount': (ALL, 'a count of YADE'),
        'State.refPos': (ALL, 'for displ() only'), 'State.refOri': (ALL, 'for rot() only'), 'State.isDamped': (ALL, 'NewtonIntegrator reads it'),
        'State.densityScaling': (ALL, 'NewtonIntegrator reads it'), 'State.angMom': (ALL, 'of aspherical bodies in space only'),
        'State.blockedDOFs': (ALL, 'YADE takes the letters it knows'),
        'TimeStepper.timeStepUpdateInterval': ('huge long', 'rarely'),
        # motion
        'State.pos': ('zero negative', 'any finite place'), 'State.vel': ('zero negative', 'any finite velocity'), 'State.angVel': ('zero negative', 'any finite spin'),
        # McaState
        'McaState.pressure': ('zero negative', 'tension'), 'McaState.stressZZ': ('zero negative', 'either sign'), 'McaState.plasticStrain': ('zero', 'fresh'),
        'McaState.temperature': ('zero', 'absolute zero'), 'McaState.dissipated': ('zero', 'fresh'), 'McaState.strength': ('zero', 'drawn by the engine'),
        'McaState.equivalentStress': (ALL, 'output'), 'McaState.links': (ALL, 'output'), 'McaState.brokenLinks': (ALL, 'output'),
        # McaMat
        'McaMat.hugoniotSlope': ('zero', 'linear'), 'McaMat.gruneisen': ('zero', 'no heat in the pressure'), 'McaMat.shearModulus': ('zero', 'a fluid'),
        'McaMat.yieldStress': ('zero inf huge', 'flows at once; elastic'), 'McaMat.hardeningModulus': ('zero', 'none'), 'McaMat.rateCoefficient': ('zero', 'no rate'),
        'McaMat.meltTemperature': ('inf huge', 'does not melt'), 'McaMat.referenceTemperature': ('zero', 'absolute zero'), 'McaMat.heatCapacity': ('zero', 'no heating'),
        'McaMat.taylorQuinney': ('zero', 'no heating'), 'McaMat.fractureStrain': ('inf huge', 'never'), 'McaMat.spallStrength': ('inf huge', 'never'), 'McaMat.pairStrength': ('inf huge', 'never'),
        'McaMat.fractureStress': ('inf huge', 'never'), 'McaMat.strengthSpread': ('zero', 'all alike'), 'McaMat.viscosityLinear': ('zero', 'none'), 'McaMat.viscosityQuadratic': ('zero', 'none'),
        'FrictMat.frictionAngle': ('zero', 'smooth'), 'McaMat.flowStress(plasticStrain)': ('zero', 'fresh'),
        # McaPhys
        'NormPhys.normalForce': (ALL, 'output'), 'NormShearPhys.shearForce': ('zero negative', 'the friction of the wall so far'),
        # engines
        'McaEngine.volumeFilter': ('zero', 'off'), 'McaEngine.writePeriod': ('zero huge', 'at the end only'), 'McaEngine.seed': ('zero negative -2 huge -huge', 'any whole number'),
        'McaEngine.gravity': ('zero negative', 'any finite vector'), 'McaDensity.volumeFilter': ('zero', 'off'), 'McaDensity.seed': ('zero negative -2 huge -huge', 'any whole number'),
        'McaTimeStepper.growth': ('inf huge', 'no limit of growth'), 'McaTimeStepper.largest': ('inf huge', 'no bound'),
        'McaGridCoupler.automata': ('none', 'the only one'), 'McaGridCoupler.grid': ('none', 'the only one'), 'McaGridCoupler.block': ('zero', 'the first'), 'McaGridCoupler.start': ('zero', 'the first'),
        'McaGridCoupler.end': ('negative', 'the last'), 'McaGridCoupler.ids': ('empty', 'all on the line'),
        # McaGridEngine
        'McaGridEngine.addRectangle(name)': (ALL, 'any name'), 'McaGridEngine.addBlock(name)': (ALL, 'any name'), 'McaGridEngine.addRectangle(hourglass)': ('zero', 'off'),
        'McaGridEngine.addBlock(hourglass)': ('zero', 'off'),
        **{'McaGridEngine.%s(block)' % m: ('zero', 'the first') for m in ('openInteriorNode', 'openNode', 'sideNodes', 'fix', 'symmetry', 'prescribe', 'traction', 'pressure', 'viscous', 'setVelocity', 'view')},
        **{'McaGridEngine.%s(start)' % m: ('zero', 'the first') for m in ('sideNodes', 'fix', 'prescribe', 'traction', 'pressure', 'viscous')},
        **{'McaGridEngine.%s(end)' % m: ('negative', 'the last') for m in ('sideNodes', 'fix', 'prescribe', 'traction', 'pressure', 'viscous')},
        **{'McaGridEngine.%s(%s)' % (m, x): ('zero negative half', 'any finite number') for m in ('prescribe', 'traction', 'force') for x in 'xy'},
        **{'McaGridEngine.%s(nodes)' % m: ('zero', 'the first') for m in ('fixNodes', 'prescribeNodes', 'force')},
        'McaGridEngine.prescribeNodes(velocity)': ('zero negative half', 'any finite number'), 'McaGridEngine.pressure(value)': ('zero negative half', 'any finite number'),
        **{'McaGridEngine.%s(%s)' % (m, x): ('three', 'rising lines') for m in ('addRectangle', ) for x in ('xs', 'ys')}, 'McaGridEngine.openInteriorNode(i)': ('zero', 'open already'),
        'McaGridEngine.openInteriorNode(j)': ('zero', 'open already'), 'McaGridEngine.prescribeNodes(direction)': ('negative', 'to the left'), 'McaGridEngine.addGauge(period)': ('huge', 'once'),
        'McaGridEngine.gauge(number)': ('zero', 'the first'), 'McaGridEngine.addGauge(at)': ('zero', 'a corner'),
        'McaGridEngine.probeLine(start)': ('zero negative huge', 'points outside are left out'), 'McaGridEngine.probeLine(end)': ('zero negative huge', 'points outside are left out'),
        'McaGridEngine.openNode(i)': ('zero', 'the first'), 'McaGridEngine.openNode(j)': ('zero', 'the first'), 'McaEngine.setViscous(normal)': ('negative', 'to the left'),
        **{'McaGridEngine.%s(end)' % m: ('negative zero', 'the last; the first') for m in ('sideNodes', 'fix', 'prescribe')},
        'McaEngine.setViscous(ids)': ('empty', 'nobody'),
}
for m in 'prescribe(x)', 'prescribe(y)': ACCEPTED['McaGridEngine.' + m] = ('zero negative half none', 'any finite number; None: free')
ACCEPTED.update({
        # packings and outlines
        **{'packings.%s' % k: ('zero negative', 'any finite numbers') for k in ('Packing.translated(by)', 'Packing.onLine(point)', 'addBodies(velocity)', 'addBodies(angularVelocity)')},
        **{'outlines.%s' % k: ('zero negative', 'any finite numbers') for k in ('Rectangle(center)', 'Rectangle(angle)', 'disc(center)', 'Predicate.inside(pad)')},
        'packings.Packing.onLine(direction)': ('negative', 'to the left'), 'packings.Packing.onLine(tolerance)': ('zero', 'to the last bit'), 'packings.hexagonal(angle)': ('zero negative', 'any angle'),
        'packings.hexagonal(origin)': ('zero negative none', 'any place; None: the middle of the outline'), 'packings.hexagonal(minWeight)': ('zero', 'all automata inside stay'),
        'packings.addBodies(mask)': ('negative -2 zero huge -huge', '32 bits'), 'packings.addBodies(color)': ('zero none', 'black; the default'),
        'outlines.Polygon(holes)': ('empty', 'no hole'), 'outlines.Polygon.edgeDistance(points)': ('empty', 'no point'), 'outlines.Polygon.classify(points)': ('empty', 'no point'),
        'outlines.Polygon.classify(radius)': ('zero', 'a point'), 'outlines.Polygon.overlap(cells)': ('empty cube', 'no cell; cells of two corners enclose nothing'), 'outlines.Predicate(z)': ('zero negative none', 'any plane; the middle'),
        'outlines.Predicate.inside(points)': ('empty', 'no point'), 'outlines.Predicate.classify(points)': ('empty', 'no point'), 'outlines.Predicate.classify(radius)': ('zero', 'a point'),
        'outlines.Predicate.overlap(cells)': ('empty cube', 'no cell; cells of two corners enclose nothing'),
        # scenes
        **{'scenes.%s(angle)' % k: ('zero negative', 'any angle') for k in ('tiedPlate', 'bar', 'checkImpact', 'penetration')}, 'scenes.strip(angle)': ('zero', 'along x'),
        'scenes.gradedLines(start)': ('zero negative', 'any place'), 'scenes.gradedLines(end)': ('zero negative', 'any place'), 'scenes.gradedLines(largest)': ('inf huge none hugeInt', 'no bound'),
        'scenes.tiedPlate(mask)': ('negative -2 zero huge -huge', '32 bits'), 'scenes.addStrip(part)': ('nonsense long', 'any name'), 'scenes.strip(begin)': ('zero negative', 'any place'),
        'scenes.law2Engines(stepFactor)': ('none', 'the script sets O.dt'), 'scenes.bar(velocity)': ('zero negative', 'any velocity'), 'scenes.touchDown(direction)': ('negative huge', 'any direction'),
        'scenes.taylorBar(friction)': ('zero', 'smooth'), 'scenes.checkImpact(obliquity)': ('zero', 'normal'), 'scenes.penetration(obliquity)': ('zero', 'normal'),
        'scenes.penetration(ends)': ('none', 'as the mode says'), 'scenes.penetration(fractureStrain)': ('inf huge', 'never'), 'scenes.penetration(strengthSpread)': ('zero', 'all alike'),
        'scenes.penetration(friction)': ('zero none', 'smooth; that of the library'), 'scenes.penetration(yieldModel)': ('none', 'the fullest'), 'scenes.penetration(viscosity)': ('zero', 'none'),
        'scenes.penetration(seed)': ('zero huge', 'any'), 'scenes.driveEnd(vx)': ('zero negative', 'any velocity'), 'scenes.start(engineOptions)': ('none', 'as they are'),
        # measure
        'measure.speedAlong(velocity)': ('empty', 'nobody'), **{'measure.%s(direction)' % m: ('negative', 'to the left') for m in ('speedAlong', 'rodMeasure', 'rearClearance')},
        'measure.rearClearance(rear)': ('zero negative', 'any point'), 'measure.rearClearance(quantile)': ('zero', 'the rearmost'), 'measure.momentumSettled(tolerance)': ('zero', 'not at all'),
        'measure.momentumSettled(time)': ('three', 'right'), 'measure.momentumSettled(momentum)': ('three', 'right'),
        # materials
        **{'materials.Material.%s' % k: ('zero list empty none', 'numbers or arrays of any shape; None: the reference') for k in ('flowStress(plasticStrain)', 'flowStress(rate)', 'flowStress(temperature)')},
        'materials.Material.johnsonCookFractureStrain(triaxiality)': ('zero negative list empty', 'numbers or arrays of any shape'),
        **{'materials.Material.johnsonCookFractureStrain(%s)' % k: ('zero list empty', 'numbers or arrays of any shape') for k in ('rate', 'temperature')},
        'materials.get(yieldModel)': ('none', 'the fullest'), 'materials.mcaMat(yieldModel)': ('none', 'the fullest'), 'materials.mcaMat(label)': (ALL, 'any name'),
        **{'materials.get(%s)' % k.split('.')[1]: v for k, v in ACCEPTED.items() if k.startswith('McaMat.') and '(' not in k}, 'materials.get(frictionAngle)': ('zero', 'smooth'),
        'materials.get(shearModulus)': ('zero nan', 'a fluid; an equation of state alone'), 'materials.get(yieldStress)': ('inf huge', 'elastic'),
        'materials.get(hardeningExponent)': ('zero', 'laws without it'), 'materials.get(thermalSoftening)': ('zero', 'laws without it'),
})


def accepted(key, kind, moment):
	kinds = ACCEPTED.get(key, ('', ))[0]
	if '(' not in key and moment in ('stale', 'afterReset', 'emptyScene') and (moment == 'stale' or key.split('.')[0] in OF_BODIES):
		return True  # of an object that no scene holds any more: nothing reads it
	return kinds == ALL or kind in kinds.split()
