// SPDX-License-Identifier: GPL-2.0-or-later
#include "Probe.hpp"
#include <sdk/guard.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	void checkBuild(Probe& probe)
	{
		const py::object config  = py::import("yade.config");
		const string     version = py::extract<string>(config.attr("version"));
		probe.check(version == MCA_YADE_VERSION, "YADE's version is " + version + ", the plugin is made for " MCA_YADE_VERSION);
		const py::object features = config.attr("features");
		const auto       has      = [&](const char* name) { return bool(py::extract<bool>(features.attr("__contains__")(name))); };
		for (const char* name : { "OPENMP", "MPI", "QT5" })
			probe.check(has(name), string("this YADE is built without ") + name + ", which changes the layout of its classes");
		for (const char* name : { "MASK_ARBITRARY", "SPH", "LIQMIGRATION", "DEFORM", "PROFILING" })
			probe.check(!has(name), string("this YADE is built with ") + name + ", which changes the layout of its classes");
	}

	int guard()
	{
		Probe probe;
		// a group is only reached when those before it passed: what is not known to fit is not touched
		for (const auto group : { checkBuild, checkSlots, checkSizes, checkMembers, checkScene }) {
			group(probe);
			if (probe.failed()) break;
		}
		if (probe.failed())
			throw std::runtime_error(
				"yade_mca does not fit the YADE in this process (" + std::to_string(probe.failed()) + " of " + std::to_string(probe.made())
				+ " checks failed):\n" + probe.report()
				+ "What to do: install the YADE it is made for (the package yade " MCA_YADE_VERSION
				  "), build the plugin anew with the YADE that is here "
				  "(pyscripts/setup), or build it inside your YADE's source tree (patches/README.md).");
		return probe.made();
	}
} // namespace sdk
} // namespace yade
