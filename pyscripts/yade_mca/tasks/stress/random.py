# SPDX-License-Identifier: GPL-2.0-or-later
"""Random scenes from a seed: materials, shapes, speeds, orientation, noise, coupled or not. The description is numbers and names only, so that any
scene can be made again: `stress --only random/17 --seed 1`.
"""
import math

import numpy as np

from ... import materials, packings
from ...outlines import Polygon
from ..trials import D, material
from .judge import StressCase
from .watch import jittered, transit, watchedAutomata

COUNT = 50
BOUND = 0.05  #: on the energy sum: steps up to 0.9 of the limit, speeds up to 6 km/s
METALS = ('WHA_JC', '4340', 'OFHC_Cu', 'Al2024_T4')
SHAPES = {
        'rectangle': ((0, 0), (1, 0), (1, 1), (0, 1)),
        'triangle': ((0, 0.5), (1, 0), (1, 1)),
        'wedge': ((0, 0), (1, 0.5), (0, 1)),
        'ell': ((0, 0), (1, 0), (1, 0.4), (0.45, 0.4), (0.45, 1), (0, 1)),
        'disc': None,
}


def describe(seed, k):
	"""Scene number k of a seed, a dict of numbers, words and truth values; lengths in spacings, angles in degrees."""
	r = np.random.default_rng((seed, k))
	pick = lambda *of: of[int(r.integers(len(of)))]
	part = lambda: dict(metal=pick(*METALS), yieldModel=pick('johnsonCook', 'linearHardening', 'perfect', 'elastic'), eos=pick('shockAdiabat', 'linear', 'mieGruneisen'), breaks=bool(r.random() < 0.6),
	                    viscosity=round(float(r.uniform(0.3, 2.)), 2), friction=round(float(r.uniform(0., 0.8)), 2), angle=round(float(r.uniform(0., 60.)), 1), noise=round(float(r.choice((0., 0.02, 0.06))), 2))
	return dict(flyer=dict(part(), shape=pick(*SHAPES), size=(int(r.integers(6, 20)), int(r.integers(6, 20)))), target=dict(part(), size=(int(r.integers(12, 28)), int(r.integers(16, 36)))),
	            speed=round(float(10**r.uniform(1., math.log10(6000.))), 1), slant=round(float(r.uniform(-50., 50.)), 1), dtFactor=round(float(r.uniform(0.1, 0.9)), 2),
	            rule=pick('affine', 'affine', 'affine', 'inversePower', 'meanDistance'), coupled=bool(r.random() < 0.4))


def matter(p):
	"""McaMat of one part of a description."""
	strength = dict(fractureStrain=0.8, spallStrength=3e9, strengthSpread=0.1) if p['breaks'] else {}
	m = materials.get(p['metal'])
	return material(p['metal'], yieldModel=p['yieldModel'], eos=p['eos'], frictionAngle=math.atan(p['friction']), viscosityLinear=p['viscosity'] * m.viscosityLinear,
	                viscosityQuadratic=p['viscosity'] * m.viscosityQuadratic, **strength)


def body(p, seed):
	"""Packing of the flyer."""
	w, h = (n * D for n in p['size'])
	outline = packings.disc((0, 0), 0.5 * max(w, h)) if SHAPES[p['shape']] is None else Polygon(np.array(SHAPES[p['shape']]) * (w, h))
	return jittered(packings.hexagonal(D, outline, angle=math.radians(p['angle'])), p['noise'], seed)


def build(d, seed=1):
	"""(Watch, time to run [s]) of a description."""
	a, b = matter(d['flyer']), matter(d['target'])
	slant = math.radians(d['slant'])
	flyer = body(d['flyer'], seed)
	if d['coupled']:
		from .impact import watchedPlate
		t = watchedPlate(flyer, a, b, d['speed'], slant, thickness=min(d['target']['size']), dtFactor=d['dtFactor'], volumeRule=d['rule'])
	else:
		t = watchedAutomata(volumeRule=d['rule'], dtFactor=d['dtFactor'])
		w, h = (n * D for n in d['target']['size'])
		target = jittered(packings.hexagonal(D, packings.Rectangle((0, 0), (w, h)), angle=math.radians(d['target']['angle'])), d['target']['noise'], seed + 1)
		middle = 0.5 * (flyer.positions[:, 1].max() + flyer.positions[:, 1].min())
		packings.addBodies(flyer.translated((-flyer.positions[:, 0].max() - 0.5 * D, -middle)), a, velocity=(d['speed'] * math.cos(slant), d['speed'] * math.sin(slant)), mask=1)
		packings.addBodies(target.translated((-target.positions[:, 0].min() + 0.5 * D, 0)), b, mask=2)
	return t, transit(a, b, length=20 * D, times=3.)


def words(d):
	"""A description in one line."""
	part = lambda p: ' '.join(str(p[k]) for k in ('metal', 'yieldModel', 'eos')) + (' breaks' if p['breaks'] else '')
	return '%s %s on %s%s, %g m/s at %g deg, %s, dt %g' % (part(d['flyer']), d['flyer']['shape'], part(d['target']), ' (coupled)' if d['coupled'] else '', d['speed'], d['slant'], d['rule'], d['dtFactor'])


def run(seed, k):
	d = describe(seed, k)
	t, end = build(d, seed + k)
	return t.run(until=end).measures(scene=words(d))


def cases(quick, seed):
	return [StressCase('random/%d' % k, lambda k=k: run(seed, k), 'either', BOUND) for k in range(12 if quick else COUNT)]
