// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "api.hpp"
#include <stdexcept>
#include <string>

namespace mca {
/// Every refusal of the solvers: says what, where (ids), the value, the allowed range and the remedy.
/// Never thrown inside an OpenMP region; the state is left as it was before the step that failed.
class MCA_API Error : public std::runtime_error {
public:
	explicit Error(const std::string& what)
	        : std::runtime_error(what)
	{
	}
};
}
