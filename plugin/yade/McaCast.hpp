// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <typeinfo>

namespace yade {
/// dynamic_cast<T*>(p) that is fast when *p is exactly a T, as it nearly always is in the loops over bodies and interactions. Null for null.
template <class T, class Base> inline T* castTo(Base* p)
{
	if (p && typeid(*p) == typeid(T)) return static_cast<T*>(p);
	return dynamic_cast<T*>(p);
}
} // namespace yade
