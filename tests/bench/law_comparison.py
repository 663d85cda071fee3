#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Cost of one automaton and step by McaEngine, by the law in YADE's loop and by YADE's own bonded laws, on one packing in one run; prints JSON.

    law_comparison.py [--count 10000] [--steps 20] [--repeats 3] [--threads 1]

The packing is hexagonal with a random velocity field, everything moving, all bonds made. Sum of YADE's timers of all engines [ns per automaton and step], the best of the repeats; the laws
take turns in each repeat, so that a drifting load of the machine meets them all. (The wall time of O.run cannot be used: it waits in naps of 40 ms.) Times are printed, never asserted.
"""
import argparse
import json
import math
import os
import sys
import time
from pathlib import Path

parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
parser.add_argument('--count', type=int, default=10000, help='automata')
parser.add_argument('--steps', type=int, default=20, help='steps of YADE\'s laws per repeat; McaEngine does ten times as many')
parser.add_argument('--repeats', type=int, default=3)
parser.add_argument('--threads', type=int, default=1)
args = parser.parse_args()
os.environ['OMP_NUM_THREADS'] = str(args.threads)  # before YADE starts its threads
os.environ.setdefault('OMP_WAIT_POLICY', 'passive')
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / 'pyscripts'))
for p in Path('/usr/lib').glob('*/yade-double/py'):
	sys.path.append(str(p))

import numpy as np
import yade_mca
from yade_mca import materials, packings
from yade import O
from yade import wrapper as y

D = 1e-3


def automata(road):
	m = materials.mcaMat('4340', yieldModel='linearHardening', yieldStress=0.8e9, hardeningModulus=0.5e9)
	packing = square()
	packings.addBodies(packing, m, velocity=velocities(len(packing)))
	if road == 'McaEngine':
		O.engines = [y.McaEngine(adaptive=False, sleeping=False)]
		return
	O.engines = loop([y.Ip2_McaMat_McaMat_McaPhys()], [y.Law2_ScGeom_McaPhys_Mca()], 1.4)
	O.engines = O.engines[:2] + [y.McaDensity()] + O.engines[2:3] + [y.McaForces()] + O.engines[3:]


def square():
	side = math.sqrt(args.count * 0.5 * math.sqrt(3)) * D
	return packings.hexagonal(D, packings.Rectangle((0, 0), (side, side)))


def velocities(n):
	return np.random.default_rng(1).uniform(-30, 30, (n, 2))


def loop(physics, law, factor, geometry='Ig2_Sphere_Sphere_ScGeom'):
	return [
	        y.ForceResetter(),
	        y.InsertionSortCollider([y.Bo1_Sphere_Aabb(aabbEnlargeFactor=factor)], verletDist=0.05 * D),
	        y.InteractionLoop([getattr(y, geometry)(interactionDetectionFactor=factor)], physics, law),
	        y.NewtonIntegrator(damping=0),
	]


def bonded(name):
	"""YADE's own bonded laws on the same packing, six bonds per body."""
	if name == 'CpmMat':
		m = y.CpmMat(young=200e9, poisson=0.2, density=7800, frictionAngle=0.3, sigmaT=1e9, epsCrackOnset=1e-2, relDuctility=30)
		engines = loop([y.Ip2_CpmMat_CpmMat_CpmPhys(cohesiveThresholdIter=5)], [y.Law2_ScGeom_CpmPhys_Cpm()], 1.2)
	else:
		m = y.CohFrictMat(young=200e9, poisson=0.3, density=7800, frictionAngle=0.3, isCohesive=True, normalCohesion=1e12, shearCohesion=1e12, momentRotationLaw=True)
		engines = loop([y.Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True)],
		               [y.Law2_ScGeom6D_CohFrictPhys_CohesionMoment()], 1.2, 'Ig2_Sphere_Sphere_ScGeom6D')
	O.materials.append(m)
	packing = square()
	bodies = []
	for (x, z), v in zip(packing.positions.tolist(), velocities(len(packing)).tolist()):
		b = y.Body()
		b.shape, b.material, b.state = y.Sphere(radius=0.5 * D), m, m.newAssocState()
		b.state.pos, b.state.vel = (x, z, 0), (v[0], v[1], 0)
		b.state.mass = 7800 * math.pi / 6 * D**3
		b.state.inertia = (0.1 * b.state.mass * D**2, ) * 3
		b.state.blockedDOFs = 'zXY'
		bodies.append(b)
	O.bodies.append(bodies)
	O.engines = engines


LAWS = {
        'McaEngine': lambda: automata('McaEngine'),
        'Law2': lambda: automata('Law2'),
        'CpmMat': lambda: bonded('CpmMat'),
        'CohFrictMat': lambda: bonded('CohFrictMat'),
}


def main():
	best, bonds, scenes = {k: math.inf for k in LAWS}, {}, {}
	O.reset()
	for k, make in LAWS.items():  # one scene each, kept side by side
		if scenes: O.switchToScene(O.addScene())
		scenes[k] = O.thisScene
		make()
		O.dt = 1e-8
		O.run(12, True)
		bonds[k] = len(O.engines[0].links()) if k == 'McaEngine' else O.interactions.countReal()
	O.timingEnabled = True
	for _ in range(args.repeats):
		for k in LAWS:
			O.switchToScene(scenes[k])
			steps, first = args.steps * (10 if k == 'McaEngine' else 1), O.iter
			before = sum(e.execTime for e in O.engines)
			O.run(steps, True)
			assert O.iter - first == steps
			best[k] = min(best[k], (sum(e.execTime for e in O.engines) - before) / steps / len(O.bodies))
	count = len(O.bodies)
	print(json.dumps(dict(automata=count, threads=args.threads, load=os.getloadavg()[0], bondsPerAutomaton={k: round(2 * v / count, 2) for k, v in bonds.items()},
	                      nanoseconds={k: round(v, 1) for k, v in best.items()}, overMcaEngine={k: round(v / best['McaEngine'], 2) for k, v in best.items()},
	                      overLaw2={k: round(v / best['Law2'], 2) for k, v in best.items()}), indent=1))


main()
