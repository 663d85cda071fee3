// SPDX-License-Identifier: GPL-2.0-or-later
// Flat arrays as numpy arrays.
#pragma once
#include <initializer_list>
#include <lib/serialization/Serializable.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	// memory shown to Python through the buffer protocol
	struct ArrayMemory {
		void*                   data;
		const char*             format; // of one item, as in Python's struct module
		Py_ssize_t              itemSize;
		vector<Py_ssize_t>      shape;
		vector<Py_ssize_t>      strides; // bytes
		boost::shared_ptr<void> owner;   // kept alive as long as any view
		bool                    writable;
	};
	py::object makeArrayView(ArrayMemory&&); // arrayView.cpp

	template <class T> constexpr const char* bufferFormat();
	template <> constexpr const char*        bufferFormat<double>() { return "d"; }
	template <> constexpr const char*        bufferFormat<float>() { return "f"; }
	template <> constexpr const char*        bufferFormat<int>() { return "i"; }
	template <> constexpr const char*        bufferFormat<long>() { return "q"; }
	template <> constexpr const char*        bufferFormat<unsigned char>() { return "B"; }
	template <> constexpr const char*        bufferFormat<signed char>() { return "b"; }

	/// numpy array of the given shape (C order) on memory of `owner`, which lives at least as long. No copy. The caller sees to it that the memory is
	/// neither moved nor freed while owner lives (an engine that may resize its arrays should return copies, or own each array by a shared pointer).
	template <class T> py::object arrayView(T* data, vector<Py_ssize_t> shape, boost::shared_ptr<void> owner, bool writable = false)
	{
		vector<Py_ssize_t> strides(shape.size());
		Py_ssize_t         step = sizeof(T);
		for (size_t i = shape.size(); i-- > 0; step *= shape[i])
			strides[i] = step;
		using Item = std::remove_const_t<T>;
		return makeArrayView({ const_cast<Item*>(data), bufferFormat<Item>(), Py_ssize_t(sizeof(T)), std::move(shape), std::move(strides),
		                       std::move(owner), writable });
	}
	/// the same with a Python object as the owner: `static py::object view(py::object self)` as a property keeps its engine alive
	template <class T> py::object arrayView(T* data, vector<Py_ssize_t> shape, const py::object& owner, bool writable = false)
	{
		return arrayView(
			data, std::move(shape), boost::shared_ptr<void>(new py::object(owner), [](void* p) { delete static_cast<py::object*>(p); }), writable);
	}
	/// a copy as a numpy array of its own
	template <class T> py::object arrayCopy(const T* data, vector<Py_ssize_t> shape)
	{
		return arrayView(data, std::move(shape), boost::shared_ptr<void>()).attr("copy")();
	}
} // namespace sdk
} // namespace yade
