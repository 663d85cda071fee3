// SPDX-License-Identifier: GPL-2.0-or-later
// Marks what the solver library shows to its users; everything else stays hidden, so that the three builds of the
// library (one per instruction level) can never exchange inline code with each other or with YADE.
#pragma once
#define MCA_API __attribute__((visibility("default")))
