// SPDX-License-Identifier: GPL-2.0-or-later
// Sizes and offsets of the stock packages, found in their machine code (`pyscripts/run abi`); the compiler refuses declarations that disagree.
// MCA_SDK_NO_LAYOUT_ASSERT leaves this first wall out, for the tests of the second one (guard.cpp).
#pragma once
#include <core/Dispatching.hpp>
#include <core/PartialEngine.hpp>
#include <core/Scene.hpp>
#include <core/TimeStepper.hpp>
#include <cstddef>
#include <pkg/common/Aabb.hpp>
#include <pkg/common/BoundaryController.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/GLDrawFunctors.hpp>
#include <pkg/common/PeriodicEngines.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/FrictPhys.hpp>
#include <pkg/dem/ScGeom.hpp>

#ifndef MCA_SDK_NO_LAYOUT_ASSERT
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
namespace yade {
// clang-format off
#define SIZE(cls, bytes) static_assert(sizeof(cls) == bytes, "sizeof " #cls);
#define FROM(number, newer, older) (MCA_YADE_NUMBER >= number ? newer : older)
#define OFFSET(cls, member, bytes) static_assert(offsetof(cls, member) == bytes, "offset of " #cls "::" #member);
static_assert(alignof(Quaternionr) == 8 && alignof(Se3r) == 8 && alignof(Matrix3r) == 8, "alignment of Eigen's types");
SIZE(Vector3r, 24) SIZE(Quaternionr, 32) SIZE(Se3r, 56) SIZE(Matrix3r, 72)
SIZE(Serializable, 0x18) SIZE(Engine, 0x68) SIZE(GlobalEngine, 0x68) SIZE(PartialEngine, 0x80) SIZE(TimeStepper, 0x70) SIZE(PeriodicEngine, 0xb8)
SIZE(BoundaryController, 0x68) SIZE(State, 0x140) SIZE(Shape, 0x60) SIZE(Sphere, 0x68) SIZE(Bound, 0x90) SIZE(Aabb, 0x90) SIZE(Material, 0x50)
SIZE(ElastMat, 0x60) SIZE(FrictMat, 0x68) SIZE(Body, 0xb0) SIZE(IGeom, 0x20) SIZE(IPhys, 0x20) SIZE(NormPhys, 0x40) SIZE(NormShearPhys, 0x60)
SIZE(FrictPhys, FROM(20260100, 0x70, 0x68)) SIZE(GenericSpheresContact, 0x60) SIZE(ScGeom, 0xc0) SIZE(ScGeom6D, 0x140)
SIZE(Interaction, 0xa8) SIZE(BodyContainer, 0xc8) SIZE(InteractionContainer, 0xc0) SIZE(ForceContainer, 0x130)
SIZE(EnergyTracker, 0xb0) SIZE(Scene, 0x2f0) SIZE(Functor, 0x50) SIZE(BoundFunctor, 0x58)
SIZE(IGeomFunctor, 0x58) SIZE(IPhysFunctor, 0x58) SIZE(LawFunctor, 0x58) SIZE(GlShapeFunctor, 0x58)
OFFSET(Engine, scene, 0x18) OFFSET(Engine, timingDeltas, 0x30) OFFSET(Engine, dead, 0x40) OFFSET(Engine, ompThreads, 0x44) OFFSET(Engine, label, 0x48)
OFFSET(TimeStepper, active, 0x68) OFFSET(PeriodicEngine, virtPeriod, 0x68) OFFSET(PeriodicEngine, initRun, 0x88) OFFSET(PeriodicEngine, nDone, 0xb0)
OFFSET(State, se3, 0x58) OFFSET(State, vel, 0x90) OFFSET(State, mass, 0xa8) OFFSET(State, angVel, 0xb0) OFFSET(State, angMom, 0xc8)
OFFSET(State, inertia, 0xe0) OFFSET(State, refPos, 0xf8) OFFSET(State, refOri, 0x110) OFFSET(State, blockedDOFs, 0x130) OFFSET(State, densityScaling, 0x138)
OFFSET(Shape, color, 0x40) OFFSET(Shape, wire, 0x58) OFFSET(Sphere, radius, 0x60) OFFSET(Bound, refPos, 0x28) OFFSET(Bound, min, 0x60)
OFFSET(Material, label, 0x28) OFFSET(Material, density, 0x48) OFFSET(ElastMat, young, 0x50) OFFSET(FrictMat, frictionAngle, 0x60)
OFFSET(Body, id, 0x18) OFFSET(Body, material, 0x28) OFFSET(Body, state, 0x38) OFFSET(Body, shape, 0x48) OFFSET(Body, bound, 0x58) OFFSET(Body, intrs, 0x68)
OFFSET(Body, clumpId, 0x98) OFFSET(Body, iterBorn, 0xa0) OFFSET(Body, timeBorn, 0xa8) OFFSET(NormPhys, normalForce, 0x28) OFFSET(NormShearPhys, ks, 0x40)
OFFSET(NormShearPhys, shearForce, 0x48) OFFSET(ScGeom, twist_axis, 0x60) OFFSET(ScGeom, penetrationDepth, 0xa0) OFFSET(ScGeom, shearInc, 0xa8)
OFFSET(ScGeom6D, twist, 0x120) OFFSET(ScGeom6D, bending, 0x128) OFFSET(Interaction, functorCache, 0x20) OFFSET(Interaction, id1, 0x58)
OFFSET(Interaction, geom, 0x70) OFFSET(Interaction, phys, 0x80) OFFSET(Interaction, cellDist, 0x90) OFFSET(Interaction, linIx, 0x9c)
OFFSET(Interaction, iterBorn, 0xa0) OFFSET(BodyContainer, realBodies, 0x68) OFFSET(BodyContainer, drawloopmutex, 0xa0)
OFFSET(InteractionContainer, currSize, 0x50) OFFSET(InteractionContainer, dirty, 0x80) OFFSET(InteractionContainer, iterColliderLastRun, 0xb8)
OFFSET(ForceContainer, synced, 0x118) OFFSET(EnergyTracker, names, 0x58) OFFSET(EnergyTracker, resetStep, 0x88) OFFSET(Scene, forces, 0x20)
OFFSET(Scene, dt, 0x1b8) OFFSET(Scene, iter, 0x1c0) OFFSET(Scene, time, 0x1d0) OFFSET(Scene, isPeriodic, 0x1f0) OFFSET(Scene, trackEnergy, 0x1f1)
OFFSET(Scene, engines, 0x228) OFFSET(Scene, bodies, 0x258) OFFSET(Scene, interactions, 0x268) OFFSET(Scene, energy, 0x278) OFFSET(Scene, materials, 0x288)
OFFSET(Scene, cell, 0x2b0) OFFSET(Functor, scene, 0x28) OFFSET(Functor, label, 0x30)
#undef SIZE
#undef FROM
#undef OFFSET
// clang-format on
} // namespace yade
#pragma GCC diagnostic pop
#endif
