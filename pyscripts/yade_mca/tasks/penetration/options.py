# SPDX-License-Identifier: GPL-2.0-or-later
"""Options of the penetration tasks: what they mean, what is allowed, and the scene they describe. Lengths in mm, times in us on the command line."""
import argparse
import math

from ...materials import DAMAGE_MODELS, EOS_MODELS, YIELD_MODELS
from ..cli import positive
from ..registry import UsageError


def fraction(text):
	"""A type for argparse: a number from 0 to 1."""
	try:
		value = float(text)
	except ValueError:
		value = math.nan
	if not 0 <= value <= 1:
		raise argparse.ArgumentTypeError("'%s' is not a number from 0 to 1" % text)
	return value


def degrees(largest):
	"""A type for argparse: an angle from -largest to largest [degrees]."""

	def convert(text):
		try:
			value = float(text)
		except ValueError:
			value = math.nan
		if not abs(value) <= largest:
			raise argparse.ArgumentTypeError("'%s' is not an angle from -%g to %g degrees" % (text, largest, largest))
		return value

	return convert


def seed(text):
	"""A type for argparse: a whole number from 0 on."""
	if not text.isdigit() or int(text) > 2**31 - 1:
		raise argparse.ArgumentTypeError("'%s' is not a whole number from 0 to 2147483647" % text)
	return int(text)


#: option -> (default, keywords of add_argument); what makes up the scene, and so cannot be changed at a restart
SCENE = {
        'thickness': (25., dict(type=positive(float, 'mm'), metavar='MM', help='of the plate')),
        'spacing': (1., dict(type=positive(float, 'mm'), metavar='MM', help='diameter of the automata')),
        'speed': (1520., dict(type=positive(float, 'm/s'), metavar='M/S', help='of the rod')),
        'mode': ('coupled', dict(choices=['coupled', 'mca'], help='coupled: the middle of the plate is automata, the rest grid; mca: automata only')),
        'ends': (None, dict(choices=['fixed', 'viscous', 'free'], help='where the plate ends (default: fixed when coupled, viscous with automata only)')),
        'dimension': (2, dict(type=int, choices=[2, 3], help='2: plane strain; 3: a round rod and a square plate in space, automata only')),
        'model': ('quarter', dict(choices=['quarter', 'whole'], help='in space: a quarter with planes of symmetry, or all of it')),
        'seed': (1, dict(type=seed, metavar='N', help='of the scattered strengths')),
        'automata-width': (80., dict(type=positive(float, 'mm'), metavar='MM', help='width of the part of the plate that is automata')),
        'width': (120., dict(type=positive(float, 'mm'), metavar='MM', help='whole width of the plate when coupled; with automata only it is --automata-width')),
        'rod-length': (100., dict(type=positive(float, 'mm'), metavar='MM', help='of the rod')),
        'rod-diameter': (10., dict(type=positive(float, 'mm'), metavar='MM', help='of the rod')),
        'angle': (0., dict(type=degrees(180), metavar='DEG', help='by which the packings are turned against the normal of the plate and the axis of the rod')),
        'obliquity': (0., dict(type=degrees(75), metavar='DEG', help='between the flight of the rod and the normal of the plate')),
        'yield-model': (None, dict(choices=list(YIELD_MODELS), help='of both materials (default: Johnson-Cook)')),
        'eos': ('shockAdiabat', dict(choices=list(EOS_MODELS), help='equation of state of both materials')),
        'fracture-strain': (None, dict(type=positive(float), metavar='X', help='plastic strain at which pairs unlink (default: 1, with a damage model never)')),
        'damage': ('none', dict(choices=list(DAMAGE_MODELS), help='by plastic flow, of both materials; johnsonCook: fracture strain by triaxiality, rate and temperature')),
        'spall': (1., dict(type=positive(float), metavar='X', help='factor on the tensile strengths, 3.8 GPa of the rod and 3.0 GPa of the plate')),
        'spread': (0.05, dict(type=fraction, metavar='X', help='relative scatter of the strengths')),
        'friction': (None, dict(type=fraction, metavar='X', help='coefficient between unlinked automata (default: 0.1)')),
        'viscosity': (1., dict(type=positive(float), metavar='X', help='factor on the artificial viscosity')),
        'volume-rule': ('affine', dict(choices=['affine', 'inversePower', 'meanDistance'], help='of the automata')),
        'dt-factor': (0.5, dict(type=positive(float), metavar='X', help='share of the largest stable time step')),
}


def addSceneArguments(parser, leaveOut=()):
	"""The options above; unset ones are None until fill()."""
	group = parser.add_argument_group('scene')
	for name, (default, keywords) in SCENE.items():
		if name not in leaveOut:
			words = dict(keywords)
			if default is not None:
				words['help'] += ' (default: %s)' % default
			group.add_argument('--' + name, default=None, **words)


def given(args):
	"""Names of the scene options that stand on the command line."""
	return [k for k in SCENE if getattr(args, k.replace('-', '_'), None) is not None]


def fill(args):
	"""Puts the defaults where nothing was given and checks what goes together; raises UsageError."""
	if getattr(args, 'dimension', None) == 3:
		if args.mode is None: args.mode = 'mca'
		for key, only in (('mode', 'mca'), ('angle', None), ('obliquity', None), ('width', None)):
			if getattr(args, key, None) not in (None, 0, only): raise UsageError('--%s: %s is for plane strain; leave it out with --dimension 3' % (key, getattr(args, key)))
	for k, (default, _) in SCENE.items():
		key = k.replace('-', '_')
		if getattr(args, key, None) is None:
			setattr(args, key, default)
	checkScene(args.thickness, args.spacing, args)


def checkScene(thickness, spacing, args):
	if spacing > args.rod_diameter:
		raise UsageError('--spacing: %g mm is larger than the rod, which is %g mm thick' % (spacing, args.rod_diameter))
	if spacing > 0.5 * min(args.rod_diameter, thickness):
		raise UsageError('--spacing: %g mm is above half of the rod (%g mm) or plate (%g mm)' % (spacing, args.rod_diameter, thickness))
	if args.dimension == 2 and abs(thickness / spacing - round(thickness / spacing)) > 1e-6:
		raise UsageError('--spacing: the plate of %g mm is not a whole number of spacings of %g mm; %g mm would do' % (thickness, spacing, thickness / math.ceil(thickness / spacing)))
	if args.mode == 'coupled' and args.width < args.automata_width + 2 * spacing:
		raise UsageError('--width: %g mm leaves no room for a grid beside %g mm of automata' % (args.width, args.automata_width))
	if args.dt_factor > 1:
		raise UsageError('--dt-factor: %g is above 1, the limit of stability' % args.dt_factor)
	from ... import scenes
	try:
		scenes.checkImpact(**dict(sizes(args), thickness=1e-3 * thickness, spacing=1e-3 * spacing, dimension=args.dimension), rod='WHA_JC', plate='4340')
	except scenes.SceneError as e:
		raise UsageError(str(e)) from None


def sizes(args):
	"""Keywords of scenes.penetration() that give its geometry and speed, SI units."""
	return dict(thickness=1e-3 * args.thickness, spacing=1e-3 * args.spacing, speed=args.speed, mode=args.mode, rodLength=1e-3 * args.rod_length, rodDiameter=1e-3 * args.rod_diameter,
	            automataWidth=1e-3 * args.automata_width, plateWidth=1e-3 * args.width, angle=math.radians(args.angle), obliquity=math.radians(args.obliquity))


def sceneOf(args):
	"""Builds the scene of filled options."""
	from ... import scenes
	return scenes.penetration(
	        **sizes(args), ends=args.ends, fractureStrain=args.fracture_strain, damageModel=args.damage,
	        spallStrength=(args.spall * scenes.SPALL[0], args.spall * scenes.SPALL[1]), strengthSpread=args.spread, friction=args.friction, eos=args.eos, yieldModel=args.yield_model, viscosity=args.viscosity, seed=args.seed,
	        dtFactor=args.dt_factor, dimension=args.dimension, quarter=args.model == 'quarter', engineOptions=dict(volumeRule=args.volume_rule))


def commandLine(**options):
	"""Scene options as words of a command line, for processes that are started."""
	words = []
	for k, v in options.items():
		if v is not None:
			words += ['--' + k.replace('_', '-'), repr(v) if isinstance(v, float) else str(v)]
	return words
