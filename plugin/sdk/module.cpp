// SPDX-License-Identifier: GPL-2.0-or-later
// Entry point of a Python extension (MCA_MODULE, _yade_mca for the plugin itself): guard first, then the new classes. It is written out because
// BOOST_PYTHON_MODULE returns a module with an error set when its body throws, which Python reports as an opaque SystemError instead of the ImportError.
#include <lib/serialization/Serializable.hpp>
#include <sdk/guard.hpp>

namespace {
void fillModule(boost::python::object module)
{
	module.attr("guardChecks") = yade::sdk::guard(); // throws when this YADE does not fit
	module.attr("classes")     = yade::sdk::registerClasses();
}
}

extern "C" __attribute__((visibility("default"))) PyObject* BOOST_PP_CAT(PyInit_, MCA_MODULE)()
{
	static PyModuleDef definition = { PyModuleDef_HEAD_INIT, BOOST_PP_STRINGIZE(MCA_MODULE), nullptr, -1, nullptr, nullptr, nullptr, nullptr, nullptr };
	PyObject*          module     = PyModule_Create(&definition);
	if (!module) return nullptr;
	try {
		fillModule(boost::python::object(boost::python::handle<>(boost::python::borrowed(module))));
		return module;
	} catch (const boost::python::error_already_set&) {
	} catch (const std::exception& e) {
		PyErr_SetString(PyExc_ImportError, e.what());
	}
	Py_DECREF(module);
	return nullptr;
}
