// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>

namespace yade {
// vptr at 0, weak pointer at 8
class Factorable : public boost::enable_shared_from_this<Factorable> {
public:
	Factorable() = default;
	virtual ~Factorable();                                   // slots 0, 1
	virtual string getBaseClassName(unsigned int = 0) const; // 2
	virtual int    getBaseClassNumber() const;               // 3
	virtual string getClassName() const;                     // 4
};
} // namespace yade
