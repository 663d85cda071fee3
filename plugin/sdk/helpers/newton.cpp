// SPDX-License-Identifier: GPL-2.0-or-later
#include <cstring>
#include <lib/serialization/Serializable.hpp>
#include <malloc.h>
#include <sdk/newton.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	namespace {
		const char* bytesOf(const Engine& e) { return static_cast<const char*>(dynamic_cast<const void*>(&e)); }

		/// The one place in the object that holds a after setting it to a, and b after b [bytes].
		template <class T> size_t placeOf(py::object engine, const char* attribute, T a, T b)
		{
			const char*  begin = bytesOf(py::extract<const Engine&>(engine)());
			const size_t n     = malloc_usable_size(const_cast<char*>(begin));
			engine.attr(attribute) = a;
			const vector<char> first(begin, begin + n);
			engine.attr(attribute) = b;
			size_t found = 0, place = 0;
			for (size_t at = 0; at + sizeof(T) <= n; at += sizeof(T))
				if (!std::memcmp(&first[at], &a, sizeof(T)) && !std::memcmp(begin + at, &b, sizeof(T))) place = at, found++;
			if (found != 1)
				throw std::runtime_error(string("NewtonIntegrator.") + attribute + " was not found in this version of YADE; please report it.");
			return place;
		}
		struct Places {
			size_t damping, mask;
			Places()
			{
				const PyGILState_STATE state = PyGILState_Ensure();
				string                 error;
				try {
					py::object n = py::import("yade.wrapper").attr("NewtonIntegrator")();
					damping      = placeOf(n, "damping", 0.4321, 0.1234);
					mask         = placeOf(n, "mask", 0x5a3c7e19, 0x1f2e3d4c);
				} catch (const std::exception& e) {
					error = e.what();
				} catch (const py::error_already_set&) {
					PyErr_Clear();
					error = "NewtonIntegrator has no damping or mask in this version of YADE; please report it.";
				}
				PyGILState_Release(state);
				if (!error.empty()) throw std::runtime_error(error);
			}
		};
	} // namespace

	NewtonFacts newtonFacts(const Engine& newton)
	{
		static const Places places;
		NewtonFacts         facts {};
		std::memcpy(&facts.damping, bytesOf(newton) + places.damping, sizeof facts.damping);
		std::memcpy(&facts.mask, bytesOf(newton) + places.mask, sizeof facts.mask);
		return facts;
	}
} // namespace sdk
} // namespace yade
