// SPDX-License-Identifier: GPL-2.0-or-later
// std::vector attributes whose element type YADE itself does not convert (pointers to new classes, vectors of vectors): list <-> vector.
#pragma once
#include <lib/base/Math.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	template <class Vector> struct SequenceConverter {
		using Element = typename Vector::value_type;
		static PyObject* convert(const Vector& values)
		{
			py::list list;
			for (const Element& value : values)
				list.append(value);
			return py::incref(list.ptr());
		}
		static void* convertible(PyObject* object) { return PySequence_Check(object) && !PyUnicode_Check(object) ? object : nullptr; }
		static void  construct(PyObject* object, py::converter::rvalue_from_python_stage1_data* data)
		{
			void*   memory = reinterpret_cast<py::converter::rvalue_from_python_storage<Vector>*>(data)->storage.bytes;
			Vector* values = new (memory) Vector();
			data->convertible = memory;
			const long n = PySequence_Size(object);
			values->reserve(n);
			for (long i = 0; i < n; i++) {
				const py::object item { py::handle<>(PySequence_GetItem(object, i)) };
				values->push_back(py::extract<Element>(item));
			}
		}
	};
	template <class T> struct IsVector : std::false_type { };
	template <class E> struct IsVector<std::vector<E>> : std::true_type { };

	template <class T> void registerSequence()
	{
		if constexpr (IsVector<T>::value) {
			registerSequence<typename T::value_type>();
			const auto* known = py::converter::registry::query(py::type_id<T>());
			if (!known || !known->m_to_python) py::to_python_converter<T, SequenceConverter<T>>();
			if (!known || !known->rvalue_chain)
				py::converter::registry::push_back(&SequenceConverter<T>::convertible, &SequenceConverter<T>::construct, py::type_id<T>());
		}
	}
} // namespace sdk
} // namespace yade
