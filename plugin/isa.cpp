// SPDX-License-Identifier: GPL-2.0-or-later
#include "isa.hpp"

namespace mca {
const char* isa()
{
#if defined(__AVX512F__)
	return "x86-64-v4";
#elif defined(__AVX2__)
	return "x86-64-v3";
#else
	return "x86-64";
#endif
}
} // namespace mca
