// SPDX-License-Identifier: GPL-2.0-or-later
// Tables of time that scripts give.
#pragma once
#include <grid/boundary.hpp>
#include <lib/base/Math.hpp>

namespace yade {
/// A number, or a pair (times, values); name: of the argument, for messages. Throws mca::Error. Under Python's lock.
mca::grid::Table tableOf(const boost::python::object& o, const char* name);
} // namespace yade
