// SPDX-License-Identifier: GPL-2.0-or-later
// Attributes of new classes in Python: flags, keyword constructor, getters and setters, conversion of vectors.
#pragma once
#include <boost/python/raw_function.hpp>
#include <lib/serialization/Serializable.hpp>
#include <sdk/sequences.hpp>
#include <type_traits>

namespace yade {
namespace Attr {
	// numbers as in the docstrings of the stock classes (:yattrflags:)
	enum flags { noSave = 1, readonly = 2, triggerPostLoad = 4, hidden = 8, noResize = 16 };
}
namespace sdk __attribute__((visibility("hidden"))) {
	// the flags entry of an attribute, which may be empty
	constexpr unsigned flags() { return 0; }
	constexpr unsigned flags(unsigned f) { return f; }

	// returned to Python by reference, so that engine.force[2] = 1 changes the engine
	template <class T> constexpr bool isReferred = std::is_same_v<T, Vector2i> || std::is_same_v<T, Vector3i> || std::is_same_v<T, Vector2r>
	        || std::is_same_v<T, Vector3r> || std::is_same_v<T, Matrix3r> || std::is_same_v<T, Quaternionr>;

	template <class C> shared_ptr<C> construct(py::tuple& args, py::dict& keywords)
	{
		shared_ptr<C> instance(new C);
		instance->pyHandleCustomCtorArgs(args, keywords);
		if (py::len(args) > 0) throw std::runtime_error(instance->getClassName() + ": only keyword arguments are accepted");
		if (py::len(keywords) > 0) instance->pyUpdateAttrs(keywords); // runs the postLoad hook as well
		return instance;
	}
	// f(self, *args, **keywords) -> construct(args, keywords)
	struct RawConstructor {
		py::object make;
		PyObject*  operator()(PyObject* a, PyObject* k)
		{
			const py::object args(py::handle<>(py::borrowed(a)));
			const py::dict   keywords = k ? py::dict(py::handle<>(py::borrowed(k))) : py::dict();
			return py::incref(py::object(make(py::object(args[0]), py::tuple(args.slice(1, py::len(args))), keywords)).ptr());
		}
	};
	template <class C> py::object keywordConstructor()
	{
		return py::detail::make_raw_function(py::objects::py_function(
			RawConstructor { py::make_constructor(&construct<C>) }, boost::mpl::vector2<void, py::object>(), 1,
			(std::numeric_limits<unsigned>::max)()));
	}

	template <class C, class T, T C::*member> void setAndPostLoad(C& instance, const T& value)
	{
		instance.*member = value;
		instance.callPostLoad();
	}

	template <class C, class T, T C::*member, unsigned flags, class PyClass>
	void attribute([[maybe_unused]] PyClass& cls, [[maybe_unused]] const char* name, [[maybe_unused]] const string& doc, [[maybe_unused]] const char* type,
	               [[maybe_unused]] const char* dflt)
	{
		if constexpr (!(flags & Attr::hidden)) {
			registerSequence<T>();
			// the inspector of the graphical interface reads these roles
			const string text = doc + " :ydefault:`" + dflt + "` :yattrtype:`" + type + "` :yattrflags:`" + std::to_string(flags) + "` ";
			py::object   get;
			if constexpr (isReferred<T>) get = py::make_getter(member, py::return_internal_reference<>());
			else
				get = py::make_getter(member, py::return_value_policy<py::return_by_value>());
			if constexpr (flags & Attr::readonly) cls.add_property(name, get, text.c_str());
			else if constexpr (flags & Attr::triggerPostLoad)
				cls.add_property(name, get, py::make_function(&setAndPostLoad<C, T, member>), text.c_str());
			else
				cls.add_property(name, get, py::make_setter(member), text.c_str());
		}
	}
} // namespace sdk
} // namespace yade
