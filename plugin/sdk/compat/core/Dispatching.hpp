// SPDX-License-Identifier: GPL-2.0-or-later
// YADE sources before 2021 keep this header elsewhere.
#pragma once
#include <pkg/common/Dispatching.hpp>
