// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/serialization/Serializable.hpp>

namespace yade {
class McaInfo : public Serializable {
public:
	string isa() const;
	int    threads() const;
	string version() const;
	Real   triad(int n) const;
	Real   flops(int n) const;
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(McaInfo, Serializable, "Facts about the loaded plugin: ``McaInfo().isa``.", , ,
		.add_property("isa", &McaInfo::isa, "Instruction level of the solver library the dynamic loader took: x86-64, x86-64-v3 or x86-64-v4.")
		.add_property("version", &McaInfo::version, "Version of the plugin.")
		.add_property("threads", &McaInfo::threads, "Threads that the solvers use: as many as OpenMP's (yade -j, OMP_NUM_THREADS), up to 64.")
		.def("triad", &McaInfo::triad, (py::arg("threads") = 1), "Memory bandwidth now, of a = b + s c on large arrays [B/s].")
		.def("flops", &McaInfo::flops, (py::arg("threads") = 1), "Fused multiply-adds on registers now [flop/s].")
	)
	// clang-format on
};
REGISTER_SERIALIZABLE(McaInfo);
} // namespace yade
