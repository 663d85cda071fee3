// SPDX-License-Identifier: GPL-2.0-or-later
#include <core/Omega.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	vector<NewClass>& newClasses()
	{
		static vector<NewClass> list;
		return list;
	}

	py::list registerClasses()
	{
		Omega&              omega = Omega::instance();
		vector<string>      names;
		vector<const char*> fileAndNames { "yade_mca" };
		py::list            result;
		for (const NewClass& c : newClasses()) {
			if (omega.isInheritingFrom_recursive(c.name, "Serializable"))
				throw std::runtime_error(
					string("a class named ") + c.name + " is loaded already; is another copy of the plugin in this process?");
			ClassFactory::instance().registerFactorable(c.name, c.create, c.createShared, c.createPure);
			names.push_back(c.name);
			fileAndNames.push_back(c.name);
			result.append(c.name);
		}
		fileAndNames.push_back(nullptr);
		ClassFactory::instance().registerPluginClasses(fileAndNames.data());
		omega.buildDynlibDatabase(names);
		// buildDynlibDatabase only prints what goes wrong in Python registration
		const py::object wrapper = py::import("yade.wrapper");
		for (const string& name : names)
			if (!PyObject_HasAttrString(wrapper.ptr(), name.c_str()))
				throw std::runtime_error("YADE did not take in class " + name + "; see its message above");
		return result;
	}
} // namespace sdk
} // namespace yade
