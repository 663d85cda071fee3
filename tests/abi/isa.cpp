// SPDX-License-Identifier: GPL-2.0-or-later
// Which build of the solver library the dynamic loader took.
#include "isa.hpp"
#include <gtest/gtest.h>
#include <string>

TEST(Isa, IsTheHighestLevelOfThisMachine)
{
	std::string expected = "x86-64";
#ifdef MCA_HWCAPS // else there is but one build
	if (__builtin_cpu_supports("x86-64-v3")) expected = "x86-64-v3";
	if (__builtin_cpu_supports("x86-64-v4")) expected = "x86-64-v4";
#endif
	EXPECT_EQ(mca::isa(), expected);
}
