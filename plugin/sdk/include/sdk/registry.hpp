// SPDX-License-Identifier: GPL-2.0-or-later
// The list of new classes. Static initialisers only fill it; YADE hears of a class after the guard has passed (module.cpp).
#pragma once
#include <lib/factory/ClassFactory.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	struct NewClass {
		const char*                         name;
		ClassFactory::CreateFactorableFnPtr create;
		ClassFactory::CreateSharedFnPtr     createShared;
		ClassFactory::CreatePureCustomFnPtr createPure;
	};
	vector<NewClass>& newClasses();

	template <class C> void addClass(const char* name)
	{
		newClasses().push_back(
			{ name, []() -> Factorable* { return new C; }, []() { return shared_ptr<Factorable>(new C); }, []() -> void* { return new C; } });
	}
	// tell YADE of all classes listed; returns their names. Throws if a name is taken or YADE does not take one in.
	py::list registerClasses();
} // namespace sdk
} // namespace yade
