// SPDX-License-Identifier: GPL-2.0-or-later
#include <sdk/arrayView.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	namespace {
		struct ViewObject {
			PyObject_HEAD;
			ArrayMemory* memory;
		};

		int getBuffer(PyObject* self, Py_buffer* view, int flags)
		{
			ArrayMemory& m = *reinterpret_cast<ViewObject*>(self)->memory;
			if ((flags & PyBUF_WRITABLE) && !m.writable) {
				PyErr_SetString(PyExc_BufferError, "this array is read-only");
				return -1;
			}
			Py_ssize_t bytes = m.itemSize;
			for (const Py_ssize_t n : m.shape)
				bytes *= n;
			view->buf        = m.data;
			view->obj        = self;
			view->len        = bytes;
			view->readonly   = !m.writable;
			view->itemsize   = m.itemSize;
			view->format     = (flags & PyBUF_FORMAT) ? const_cast<char*>(m.format) : nullptr;
			view->ndim       = int(m.shape.size());
			view->shape      = m.shape.data();
			view->strides    = m.strides.data();
			view->suboffsets = nullptr;
			view->internal   = nullptr;
			Py_INCREF(self);
			return 0;
		}
		void release(PyObject* self)
		{
			PyTypeObject* type = Py_TYPE(self);
			delete reinterpret_cast<ViewObject*>(self)->memory;
			type->tp_free(self);
			Py_DECREF(type);
		}
		PyTypeObject* viewType()
		{
			static PyType_Slot slots[] = { { Py_bf_getbuffer, reinterpret_cast<void*>(&getBuffer) },
				                       { Py_tp_dealloc, reinterpret_cast<void*>(&release) },
				                       { 0, nullptr } };
			static PyType_Spec spec    = { "yade_mca.ArrayMemory", sizeof(ViewObject), 0, Py_TPFLAGS_DEFAULT, slots };
			static PyObject*   type    = PyType_FromSpec(&spec);
			if (!type) py::throw_error_already_set();
			return reinterpret_cast<PyTypeObject*>(type);
		}
	}

	py::object makeArrayView(ArrayMemory&& memory)
	{
		PyTypeObject*    type = viewType();
		py::handle<>     self(type->tp_alloc(type, 0));
		reinterpret_cast<ViewObject*>(self.get())->memory = new ArrayMemory(std::move(memory));
		return py::import("numpy").attr("asarray")(py::object(self));
	}
} // namespace sdk
} // namespace yade
