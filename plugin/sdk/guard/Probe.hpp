// SPDX-License-Identifier: GPL-2.0-or-later
// Tools of the guard. Nothing here trusts the declarations: memory is read through the kernel, so a wrong address is a failed check, not a crash.
#pragma once
#include <lib/base/Math.hpp>

namespace yade {
namespace sdk __attribute__((visibility("hidden"))) {
	class Probe {
	public:
		Probe();
		~Probe();
		int    made() const { return checks; }
		int    failed() const { return failures; }
		string report() const { return text; }

		void check(bool passes, const string& whatIsWrong);
		// the address of an exported symbol, null if it is missing
		static void* symbol(const string& mangled);
		// copy n bytes from an address that may be wrong; false if it cannot be read
		bool read(const void* from, void* to, size_t n) const;
		bool equal(const void* memory, const void* expected, size_t n) const;
		// whether an object of stock class cls lies at p
		bool isObject(const void* p, const string& cls) const;

		// sizeof(class) against what the library allocates for one
		void size(const string& cls, size_t declared);
		// virtual function number `slot` of the class is the exported function
		void slot(const string& cls, int slot, const string& function);
		// function pointer to virtual member -> its slot (Itanium ABI: offset in the table plus one)
		template <class Member> static int slotOf(Member member)
		{
			static_assert(sizeof(member) == 2 * sizeof(long), "pointer to member function");
			long words[2];
			__builtin_memcpy(words, &member, sizeof words);
			return words[0] & 1 ? int((words[0] - 1) / long(sizeof(void*))) : -1;
		}
		// set an attribute of a stock object from Python, find the value at the declared place
		template <class C, class M, class V> void member(const char* cls, const char* name, M C::*place, const V& value, const M& expected)
		{
			const auto* object = static_cast<const C*>(make(cls, name, py::object(value), py::type_id<C>()));
			check(object && equalMember(&(object->*place), expected), string(cls) + "." + name + " is not where the declarations have it");
		}
		template <class C, class M> void member(const char* cls, const char* name, M C::*place, const M& value)
		{
			member(cls, name, place, value, value);
		}

	private:
		const void* make(const char* cls, const char* attribute, const py::object& value, const py::type_info& type);
		template <class M> bool equalMember(const M* memory, const M& expected) const { return equal(memory, &expected, sizeof(M)); }
		bool        equalMember(const string* memory, const string& expected) const;

		int                              checks = 0, failures = 0;
		string                           text;
		int                              pipe[2] = { -1, -1 };
		std::map<string, py::object>     objects; // one of each class, shared by all its members
		py::object                       wrapper;
	};
	// groups of checks; each may rely on those before it
	void checkBuild(Probe&);
	void checkSizes(Probe&);
	void checkSlots(Probe&);
	void checkMembers(Probe&);
	void checkScene(Probe&);
} // namespace sdk
} // namespace yade
