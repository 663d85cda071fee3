// SPDX-License-Identifier: GPL-2.0-or-later
// The number of a virtual function follows from its place in the declarations; the library's table must hold the function of that name there.
#include "Probe.hpp"
#include <sdk/layout.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	namespace {
		// to name the protected index functions
		template <class Base> struct Index : Base {
			static int modify() { return Probe::slotOf(&Index::modifyClassIndex); }
			static int increment() { return Probe::slotOf(&Index::incrementMaxCurrentlyUsedClassIndexOfKin); }
		};
		string mangled(const string& cls, const string& function, const char* arguments, bool isConst)
		{
			return string("_ZN") + (isConst ? "K" : "") + "4yade" + std::to_string(cls.size()) + cls + std::to_string(function.size()) + function
				+ arguments;
		}
	}
	void checkSlots(Probe& probe)
	{
// clang-format off
		// class whose table is read, class of the function, function, mangled arguments
#define SLOT(cls, owner, function, arguments) probe.slot(#cls, Probe::slotOf(&cls::function), mangled(#owner, #function, arguments, false));
#define SLOT_CONST(cls, owner, function, arguments) probe.slot(#cls, Probe::slotOf(&cls::function), mangled(#owner, #function, arguments, true));
#define INDEX(cls)                                                                                                                                             \
	SLOT_CONST(cls, cls, getClassIndex, "Ev")                                                                                                              \
	SLOT_CONST(cls, cls, getBaseClassIndex, "Ei")                                                                                                          \
	SLOT_CONST(cls, cls, getMaxCurrentlyUsedClassIndexOfKin, "Ev")                                                                                         \
	probe.slot(#cls, Index<cls>::modify(), mangled(#cls, "modifyClassIndex", "Ev", false));                                                                \
	probe.slot(#cls, Index<cls>::increment(), mangled(#cls, "incrementMaxCurrentlyUsedClassIndexOfKin", "Ev", false));
		probe.slot("Serializable", 1, "_ZN4yade12SerializableD0Ev");
		SLOT_CONST(Serializable, Serializable, getBaseClassNumber, "Ev")
		SLOT_CONST(Serializable, Serializable, getBaseClassName, "B5cxx11Ej")
		SLOT_CONST(Serializable, Serializable, getClassName, "B5cxx11Ev")
		SLOT(Serializable, Serializable, pySetAttr, "ERKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEERKN5boost6python3api6objectE")
		SLOT_CONST(Serializable, Serializable, pyDict, "Ev")
		SLOT_CONST(Serializable, Serializable, pyDictCustom, "Ev")
		SLOT(Serializable, Serializable, callPostLoad, "Ev")
		SLOT(Serializable, Serializable, pyRegisterClass, "EN5boost6python3api6objectE")
		SLOT(Serializable, Serializable, pyHandleCustomCtorArgs, "ERN5boost6python5tupleERNS2_4dictE")
		SLOT(Engine, Engine, isActivated, "Ev")
		SLOT(Engine, Engine, action, "Ev")
		SLOT(GlobalEngine, Engine, action, "Ev")
		SLOT(PeriodicEngine, PeriodicEngine, isActivated, "Ev")
		SLOT(TimeStepper, TimeStepper, isActivated, "Ev")
		SLOT(TimeStepper, TimeStepper, action, "Ev")
		SLOT(TimeStepper, TimeStepper, computeTimeStep, "EPNS_5SceneE")
		SLOT(BoundaryController, BoundaryController, action, "Ev")
		SLOT_CONST(Material, Material, newAssocState, "Ev")
		SLOT_CONST(Material, Material, stateTypeOk, "EPNS_5StateE")
		SLOT(Body, Body, userForcedDisplacementRedrawHook, "Ev")
		SLOT_CONST(Interaction, Interaction, pyDictCustom, "Ev")
		INDEX(State)
		INDEX(Shape)
#if MCA_YADE_NUMBER >= 20260100
		SLOT(Shape, Shape, getVolume, "Ev")
		SLOT(Sphere, Sphere, getVolume, "Ev")
#endif
		INDEX(Bound)
		INDEX(Material)
		INDEX(IGeom)
		INDEX(IPhys)
		SLOT_CONST(ScGeom, ScGeom, getClassIndex, "Ev")
		SLOT_CONST(NormShearPhys, NormShearPhys, getClassIndex, "Ev")
		SLOT_CONST(FrictMat, FrictMat, getClassIndex, "Ev")
		SLOT_CONST(Functor, Functor, getFunctorTypes, "B5cxx11Ev")
		SLOT(IGeomFunctor, IGeomFunctor, preStep, "Ev")
		SLOT(LawFunctor, LawFunctor, pyRegisterClass, "EN5boost6python3api6objectE")
#undef SLOT
#undef SLOT_CONST
#undef INDEX
// clang-format on
	}
} // namespace sdk
} // namespace yade
