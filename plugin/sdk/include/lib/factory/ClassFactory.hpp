// SPDX-License-Identifier: GPL-2.0-or-later
// The factory of the process. Only addresses of exported members are used, so its layout is of no concern.
#pragma once
#include <lib/factory/Factorable.hpp>

// in the global namespace, as in the library: Singleton<yade::X>::self is exported data
template <class T> class Singleton {
public:
	static T* self;
};

namespace yade {
class ClassFactory {
public:
	using CreateSharedFnPtr      = shared_ptr<Factorable> (*)();
	using CreateFactorableFnPtr  = Factorable* (*)();
	using CreatePureCustomFnPtr  = void* (*)();
	static ClassFactory& instance() { return *Singleton<ClassFactory>::self; }
	bool                 registerFactorable(std::string name, CreateFactorableFnPtr, CreateSharedFnPtr, CreatePureCustomFnPtr);
	// file name, class names, null
	void registerPluginClasses(const char* fileAndClasses[]);
};
} // namespace yade
