# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases `law` and `space` of `bench`: cost of one automaton and step by McaEngine, by the same law in YADE's own loop and by YADE's own bonded laws, on one packing.

Hexagonal packing, all bonds made; the velocity is a shear flow with waves of 20 mm and random motion on top, so that all material is strained and yields where it can.
kind      elastic; plastic (linear hardening); fracture (the same, and links break); random: plastic, bodies in random order
space: the same by McaEngine alone in a cube of the face-centred cubic packing, in a shear flow of three dimensions; kind johnsonCook, too.
YADE's laws have no plasticity of this kind: CpmMat is elastic with damage, CohFrictMat elastic with bonds that can break; both run as they are.
"""
import math
import time

import __main__
import numpy as np

from ... import _yade, materials, packings
from ..._yade import yadeClass
from ...scenes import law2Engines
from .meter import Meter, residentMemory, withoutOthers

D, DT = 1e-3, 1e-8  #: spacing [m]; time step [s], a tenth of the limit
WAVE, SHEAR, NOISE = 20e-3, 5e3, 5.  #: length [m] and rate [1/s] of the shear flow, random speed [m/s]
PEERS = ('CpmMat', 'CohFrictMat')
ROADS = ('McaEngine', 'Law2', *PEERS)
WARM, WINDOWS, WINDOW, WINDOW_OF_PEERS = 40, 16, 25, 4  #: steps before; windows of one run, steps of each with McaEngine and with the others (a third, half as many)


def loop(physics, law, factor, geometry='Ig2_Sphere_Sphere_ScGeom', d=D):
	"""YADE's engines for bodies bonded to neighbours closer than `factor` diameters."""
	make = yadeClass
	return [
	        make('ForceResetter')(),
	        make('InsertionSortCollider')([make('Bo1_Sphere_Aabb')(aabbEnlargeFactor=factor)], verletDist=0.05 * d),
	        make('InteractionLoop')([make(geometry)(interactionDetectionFactor=factor)], physics, law),
	        make('NewtonIntegrator')(damping=0),
	]


def bonded(name, positions, velocities, density=7800.):
	"""Bodies of one of YADE's own bonded laws and its engines; mass of each body as an automaton of that density [kg/m]."""
	make, O = yadeClass, _yade.scene()
	if name == 'CpmMat':
		m = make('CpmMat')(young=200e9, poisson=0.2, density=density, frictionAngle=0.3, sigmaT=1e9, epsCrackOnset=1e-2, relDuctility=30)
		O.engines = loop([make('Ip2_CpmMat_CpmMat_CpmPhys')(cohesiveThresholdIter=5)], [make('Law2_ScGeom_CpmPhys_Cpm')()], 1.2)
	else:
		m = make('CohFrictMat')(young=200e9, poisson=0.3, density=density, frictionAngle=0.3, isCohesive=True, normalCohesion=1e12, shearCohesion=1e12, momentRotationLaw=True)
		O.engines = loop([make('Ip2_CohFrictMat_CohFrictMat_CohFrictPhys')(setCohesionNow=True)], [make('Law2_ScGeom6D_CohFrictPhys_CohesionMoment')()], 1.2, 'Ig2_Sphere_Sphere_ScGeom6D')
	O.materials.append(m)
	bodies, mass = [], density * math.pi / 6 * D**3
	for (x, y), (vx, vy) in zip(positions.tolist(), velocities.tolist()):
		b = make('Body')()
		b.shape, b.material, b.state = make('Sphere')(radius=0.5 * D), m, m.newAssocState()
		b.state.pos, b.state.vel, b.state.mass = (x, y, 0), (vx, vy, 0), mass
		b.state.inertia = (0.1 * mass * D**2, ) * 3
		b.state.blockedDOFs = 'zXY'
		bodies.append(b)
	O.bodies.append(bodies)


def elastic(name, packing, velocities, material, factor):
	"""A packing of YADE's own law with the time step that automata would have; returns the speed of its long P waves [m/s].

	Of a hexagonal packing with normal and shear stiffness kn, ks and mass m: cP^2 = 3/8 (3 kn + ks) d^2/m.
	"""
	O = _yade.scene()
	bonded(name, packing.positions, velocities)
	O.dt = 1e-12
	O.run(8, True)
	bond = next(i.phys for i in O.interactions if i.isReal)
	c = math.sqrt(0.375 * (3 * bond.kn + bond.ks) * D**2 / O.bodies[0].state.mass)
	O.dt = factor / 0.4 * 0.26 * D / c
	return c


def windows(count):
	"""Windows of a run: half as many where one takes seconds."""
	return WINDOWS // (2 if count > 5e5 else 1)


def cube(count):
	half = 0.5 * (count / math.sqrt(2))**(1 / 3) * D
	return packings.fcc(D, packings.Box((-half, ) * 3, (half, ) * 3))


def packing(count):
	side = math.sqrt(count * 0.5 * math.sqrt(3)) * D
	return packings.hexagonal(D, packings.Rectangle((0, 0), (side, side)))


def velocities(positions):
	"""Shear flow and noise, (N, 2) or (N, 3) [m/s]."""
	k = 2 * math.pi / WAVE
	flow = SHEAR / k * np.sin(k * np.roll(positions, -1, axis=1))
	return flow + np.random.default_rng(1).uniform(-NOISE, NOISE, positions.shape)


def strengthOf(kind, count):
	"""Constants of the material of a kind."""
	if kind == 'elastic': return dict(yieldModel='elastic')
	if kind == 'johnsonCook': return {}
	return dict(yieldModel='linearHardening', yieldStress=0.1e9, hardeningModulus=0.5e9, **(dict(fractureStrain=0.02 * windows(count) / WINDOWS, strengthSpread=0.1) if kind == 'fracture' else {}))


def scene(road, count, kind, space=False):
	"""Fills O; returns McaEngine or None."""
	O, p = _yade.scene(), (cube if space else packing)(count)
	if kind == 'random': p = p.select(np.random.default_rng(2).permutation(len(p)))
	v = velocities(p.positions)
	O.dt = DT
	if road in PEERS:
		bonded(road, p.positions, v)
		return None
	packings.addBodies(p, materials.mcaMat('4340', **strengthOf(kind, count)), velocity=v)  # of those that break, few do
	if road == 'Law2':
		O.engines = law2Engines()
		return None
	engine = yadeClass('McaEngine')(adaptive=False, sleeping=False)
	O.engines = [engine]
	return engine


def law(job):
	"""The best of the later windows of one run, without the write-back at its end; `flowing`: share of the automata whose plastic strain has grown in it, `broken`: broken links per automaton."""
	road, begin, memory = job['solver'], time.perf_counter(), residentMemory()
	O, engine = _yade.scene(), scene(road, job['n'], job['kind'], job['case'] == 'space')
	meter, built, seen = Meter(engine), time.perf_counter() - begin, []
	meter.steps(WARM if engine else WARM // 3)  # all bonds are made, first yield
	before = engine.field('plasticStrain') if engine else None
	__main__.benchWindow = lambda: seen.append((O.iter, meter.nanoseconds(), time.process_time(), time.perf_counter()))
	steps = WINDOW if engine else WINDOW_OF_PEERS
	O.engines = [*O.engines, yadeClass('PyRunner')(command='benchWindow()', iterPeriod=steps, firstIterRun=O.iter + 1)]
	meter.steps((windows(job['n']) // (1 if engine else 2) // (4 if job.get('short') else 1)) * steps + 3)
	count, found = len(O.bodies), [part(a, b, len(O.bodies)) for a, b in zip(seen, seen[1:])]
	best = min(found[len(found) // 2:], key=lambda r: r['automataNs'])
	bonds = len(engine.links()) if engine else O.interactions.countReal()
	r = dict(best, automata=count, cells=0, cellNs=None, simulated=O.time, built=built, bonds=bonds / count, windowsNs=[f['automataNs'] for f in found], triad=yadeClass('McaInfo')().triad(1), error=None, energyError=None)
	r['bytes'] = (residentMemory() - memory) / count
	if engine:
		c = engine.counters()
		r.update(flowing=float((engine.field('plasticStrain') > before).mean()), broken=c['brokenLinks'] / count, contacts=c['contacts'] / count)
	return r


def part(a, b, count):
	"""Cost between two windows."""
	steps = b[0] - a[0]
	spent = {k: (v - a[1].get(k, 0.)) / steps for k, v in b[1].items()}
	timers, processor = 1e-9 * sum(spent.values()) * steps, b[2] - a[2]
	stepping = withoutOthers(timers, processor)
	spent = {k: v * stepping / timers for k, v in spent.items()}
	ns = sum(spent.values())
	return dict(steps=steps, stepping=stepping, timers=timers, processorSeconds=processor, processorShare=processor / (b[3] - a[3]), automataNs=ns / count, phasesPerStep=spent,
	            phases={k: v / count for k, v in spent.items()})


CASES = dict(law=law, space=law)
