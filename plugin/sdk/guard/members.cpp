// SPDX-License-Identifier: GPL-2.0-or-later
// Each attribute is set through YADE's own Python wrapper and must be found at the declared place.
#include "Probe.hpp"
#include <sdk/layout.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	/// Long because it is a list.
	void checkMembers(Probe& probe)
	{
		const Vector3r v(1.5, -2.5, 3.5);
// clang-format off
		// stock objects of the classes themselves or, where those cannot be made in Python, of a class derived from them
#define MEMBER(object, cls, name, ...) probe.member(#object, #name, &cls::name, __VA_ARGS__);
		MEMBER(NewtonIntegrator, Engine, dead, true)
		MEMBER(NewtonIntegrator, Engine, ompThreads, 5)
		MEMBER(NewtonIntegrator, Engine, label, string("guard"))
		MEMBER(TranslationEngine, PartialEngine, dead, true)
		MEMBER(PyRunner, PeriodicEngine, virtPeriod, 1.25)
		MEMBER(PyRunner, PeriodicEngine, realPeriod, 2.25)
		MEMBER(PyRunner, PeriodicEngine, iterPeriod, 3L)
		MEMBER(PyRunner, PeriodicEngine, nDo, 4L)
		MEMBER(PyRunner, PeriodicEngine, initRun, true)
		MEMBER(PyRunner, PeriodicEngine, firstIterRun, 5L)
		MEMBER(PyRunner, PeriodicEngine, virtLast, 3.25)
		MEMBER(PyRunner, PeriodicEngine, realLast, 4.25)
		MEMBER(PyRunner, PeriodicEngine, iterLast, 6L)
		MEMBER(PyRunner, PeriodicEngine, nDone, 7L)
		MEMBER(GlobalStiffnessTimeStepper, TimeStepper, active, false)
		MEMBER(GlobalStiffnessTimeStepper, TimeStepper, timeStepUpdateInterval, 9u)
		MEMBER(State, State, mass, 1.25)
		MEMBER(State, State, vel, v)
		MEMBER(State, State, angVel, Vector3r(2 * v))
		MEMBER(State, State, angMom, Vector3r(3 * v))
		MEMBER(State, State, inertia, Vector3r(4 * v))
		MEMBER(State, State, refPos, Vector3r(5 * v))
		MEMBER(State, State, refOri, Quaternionr(.5, .5, .5, .5))
		MEMBER(State, State, isDamped, false)
		MEMBER(State, State, densityScaling, 7.25)
		MEMBER(State, State, blockedDOFs, string("xZ"), unsigned(State::DOF_X | State::DOF_RZ))
		MEMBER(Sphere, Shape, color, v)
		MEMBER(Sphere, Shape, wire, true)
		MEMBER(Sphere, Shape, highlight, true)
		MEMBER(Sphere, Sphere, radius, 3.5)
		MEMBER(Aabb, Bound, refPos, v)
		MEMBER(Aabb, Bound, sweepLength, 1.5)
		MEMBER(Aabb, Bound, color, Vector3r(2 * v))
		MEMBER(FrictMat, Material, label, string("guard"))
		MEMBER(FrictMat, Material, density, 3.5)
		MEMBER(FrictMat, ElastMat, young, 4.5)
		MEMBER(FrictMat, ElastMat, poisson, 5.5)
		MEMBER(FrictMat, FrictMat, frictionAngle, 6.5)
		MEMBER(Aabb, Bound, min, Vector3r(3 * v))
		MEMBER(Aabb, Bound, max, Vector3r(4 * v))
		MEMBER(Aabb, Bound, lastUpdateIter, 8)
		MEMBER(Body, Body, groupMask, 13)
		MEMBER(Body, Body, id, 17)
		MEMBER(Body, Body, clumpId, 19)
		MEMBER(Body, Body, iterBorn, 23L)
		MEMBER(Body, Body, timeBorn, 2.5)
		MEMBER(Body, Body, flags, 5)
		MEMBER(FrictPhys, NormPhys, kn, 3.5)
		MEMBER(FrictPhys, NormPhys, normalForce, v)
		MEMBER(FrictPhys, NormShearPhys, ks, 4.5)
		MEMBER(FrictPhys, NormShearPhys, shearForce, Vector3r(2 * v))
		MEMBER(FrictPhys, FrictPhys, tangensOfFrictionAngle, 5.5)
#if MCA_YADE_NUMBER >= 20260100
		MEMBER(FrictPhys, FrictPhys, frictDissip, 6.5)
#endif
		MEMBER(ScGeom6D, GenericSpheresContact, normal, v)
		MEMBER(ScGeom6D, GenericSpheresContact, contactPoint, Vector3r(2 * v))
		MEMBER(ScGeom6D, GenericSpheresContact, refR1, 3.5)
		MEMBER(ScGeom6D, GenericSpheresContact, refR2, 4.5)
		MEMBER(ScGeom6D, ScGeom, penetrationDepth, 5.5)
		MEMBER(ScGeom6D, ScGeom, shearInc, Vector3r(3 * v))
		MEMBER(ScGeom6D, ScGeom6D, twist, 6.5)
		MEMBER(ScGeom6D, ScGeom6D, bending, Vector3r(4 * v))
		MEMBER(Interaction, Interaction, isActive, false)
		MEMBER(Interaction, Interaction, id1, 17)
		MEMBER(Interaction, Interaction, id2, 19)
		MEMBER(Interaction, Interaction, iterMadeReal, 21L)
		MEMBER(Interaction, Interaction, iterBorn, 23L)
		MEMBER(Interaction, Interaction, cellDist, Vector3i(1, 2, 3))
		MEMBER(Ip2_FrictMat_FrictMat_FrictPhys, Functor, label, string("guard"))
		MEMBER(Scene, Scene, dt, 1.5)
		MEMBER(Scene, Scene, iter, 12L)
		MEMBER(Scene, Scene, subStepping, true)
		MEMBER(Scene, Scene, subStep, 3)
		MEMBER(Scene, Scene, time, 2.5)
		MEMBER(Scene, Scene, stopAtIter, 34L)
		MEMBER(Scene, Scene, stopAtTime, 3.5)
		MEMBER(Scene, Scene, isPeriodic, true)
		MEMBER(Scene, Scene, trackEnergy, true)
		MEMBER(Scene, Scene, doSort, true)
		MEMBER(Scene, Scene, selectedBody, 6)
#undef MEMBER
// clang-format on
	}
} // namespace sdk
} // namespace yade
