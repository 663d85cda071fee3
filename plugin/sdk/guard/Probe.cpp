// SPDX-License-Identifier: GPL-2.0-or-later
#include "Probe.hpp"
#include <core/Omega.hpp>
#include <algorithm>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	Probe::Probe()
	{
		if (pipe2(pipe, O_CLOEXEC | O_NONBLOCK) != 0)
			throw std::runtime_error("the guard cannot open a pipe: raise the limit of open files (ulimit -n)");
		wrapper = py::import("yade.wrapper");
	}
	Probe::~Probe()
	{
		close(pipe[0]);
		close(pipe[1]);
	}

	void Probe::check(bool passes, const string& whatIsWrong)
	{
		checks++;
		if (passes) return;
		failures++;
		text += "  - " + whatIsWrong + "\n";
	}

	void* Probe::symbol(const string& mangled) { return dlsym(RTLD_DEFAULT, mangled.c_str()); }

	bool Probe::read(const void* from, void* to, size_t n) const
	{
		// the kernel answers EFAULT where a plain read would end the process
		if (write(pipe[1], from, n) != ssize_t(n)) return false;
		return ::read(pipe[0], to, n) == ssize_t(n);
	}
	bool Probe::equal(const void* memory, const void* expected, size_t n) const
	{
		char found[256];
		return n <= sizeof found && read(memory, found, n) && std::memcmp(found, expected, n) == 0;
	}
	bool Probe::equalMember(const string* memory, const string& expected) const
	{
		// short strings lie in the object: the pointer shows there (libstdc++); never follow another
		struct Words {
			const char* pointer;
			size_t      length;
			char        local[16];
		} words;
		static_assert(sizeof(Words) == sizeof(string), "std::string of libstdc++");
		if (!read(memory, &words, sizeof words)) return false;
		return words.pointer == reinterpret_cast<const char*>(memory) + 16 && words.length == expected.size()
		        && std::memcmp(words.local, expected.data(), words.length) == 0;
	}
	bool Probe::isObject(const void* p, const string& cls) const
	{
		const char* table = static_cast<const char*>(symbol("_ZTVN4yade" + std::to_string(cls.size()) + cls + "E"));
		if (!p || !table) return false;
		const char* const start = table + 2 * sizeof(void*);
		return equal(p, &start, sizeof start);
	}

	void Probe::size(const string& cls, size_t declared)
	{
		const string sym  = "_ZN4yade" + std::to_string(16 + cls.size()) + "CreatePureCustom" + cls + "Ev";
		const auto   make = reinterpret_cast<Factorable* (*)()>(symbol(sym));
		if (!make) return check(false, "class " + cls + " is not in this library");
		// malloc tells the size in steps, of 16 bytes with the C library and others with another malloc: compared with what it gives for the declared
		// size in this process. A recycled chunk may be larger than asked for, hence the smallest of several.
		size_t              usable = size_t(-1), expected = size_t(-1);
		vector<Factorable*> made;
		vector<void*>       plain;
		for (int i = 0; i < 8; i++) {
			made.push_back(make());
			plain.push_back(::operator new(declared));
			usable   = std::min(usable, malloc_usable_size(made.back()));
			expected = std::min(expected, malloc_usable_size(plain.back()));
		}
		for (Factorable* object : made)
			delete object; // virtual destructor in slot 1, compared before
		for (void* chunk : plain)
			::operator delete(chunk);
		check(usable == expected,
		      "size of " + cls + ": the library allocates up to " + std::to_string(usable) + " bytes, the declaration has " + std::to_string(declared));
	}

	void Probe::slot(const string& cls, int slot, const string& function)
	{
		void* const* table  = static_cast<void* const*>(symbol("_ZTVN4yade" + std::to_string(cls.size()) + cls + "E"));
		void* const  target = symbol(function);
		void*        found  = nullptr;
		const bool   ok     = table && target && slot >= 0 && read(table + 2 + slot, &found, sizeof found) && found == target;
		check(ok,
		      "virtual function " + std::to_string(slot) + " of " + cls + " is not " + function
		              + (target ? "" : " (no such function in this library)"));
	}

	const void* Probe::make(const char* cls, const char* attribute, const py::object& value, const py::type_info& type)
	{
		try {
			auto it = objects.find(cls);
			if (it == objects.end()) it = objects.emplace(cls, wrapper.attr(cls)()).first;
			if (PyObject_SetAttrString(it->second.ptr(), attribute, value.ptr()) != 0) { // read-only: set as when loading
				PyErr_Clear();
				py::dict attributes;
				attributes[attribute] = value;
				it->second.attr("updateAttrs")(attributes);
			}
			const py::converter::registration* known = py::converter::registry::query(type);
			return known ? py::converter::get_lvalue_from_python(it->second.ptr(), *known) : nullptr;
		} catch (const py::error_already_set&) {
			PyErr_Clear();
			return nullptr;
		}
	}
} // namespace sdk
} // namespace yade
