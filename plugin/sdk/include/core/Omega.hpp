// SPDX-License-Identifier: GPL-2.0-or-later
// The singleton behind Python's O. Only exported members are used, so its layout is of no concern.
#pragma once
#include <lib/factory/ClassFactory.hpp>

namespace yade {
class Scene;
class Omega {
public:
	static Omega&            instance() { return *Singleton<Omega>::self; }
	const shared_ptr<Scene>& getScene() const;
	Real                     getRealTime() const; // s since start
	bool                     isRunning();
	bool                     isInheritingFrom_recursive(const string& cls, const string& base);
	void                     buildDynlibDatabase(const vector<string>& newClasses);
};
} // namespace yade
