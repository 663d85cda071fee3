// SPDX-License-Identifier: GPL-2.0-or-later
#include "Probe.hpp"
#include <sdk/layout.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	void checkSizes(Probe& probe)
	{
// clang-format off
#define SIZE(cls) probe.size(#cls, sizeof(cls));
		SIZE(Engine) SIZE(GlobalEngine) SIZE(PartialEngine) SIZE(PeriodicEngine) SIZE(TimeStepper) SIZE(BoundaryController)
		SIZE(State) SIZE(Shape) SIZE(Sphere) SIZE(Bound) SIZE(Aabb) SIZE(Material) SIZE(ElastMat) SIZE(FrictMat) SIZE(Body)
		SIZE(IGeom) SIZE(GenericSpheresContact) SIZE(ScGeom) SIZE(ScGeom6D) SIZE(IPhys) SIZE(NormPhys) SIZE(NormShearPhys)
		SIZE(FrictPhys) SIZE(Interaction)
		SIZE(BodyContainer) SIZE(InteractionContainer) SIZE(EnergyTracker) SIZE(Scene)
		SIZE(Functor) SIZE(BoundFunctor) SIZE(IGeomFunctor) SIZE(IPhysFunctor) SIZE(LawFunctor) SIZE(GlShapeFunctor)
#undef SIZE
// clang-format on
	}
} // namespace sdk
} // namespace yade
