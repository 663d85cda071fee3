// SPDX-License-Identifier: GPL-2.0-or-later
// Steps of a block of automata with one feature present or absent, for counting instructions (valgrind --tool=callgrind):
// tests/python/test_skip_instructions.py.
//   skip_count FEATURE STEPS
#include "../unit/automata_scene.hpp"
#include <iostream>
using namespace automatatest;

int main(int argc, char** argv)
{
	if (argc != 3) {
		std::cerr << "usage: skip_count FEATURE STEPS\n";
		return 2;
	}
	const std::string feature = argv[1];
	Material          m       = steel(YieldKind::perfect);
	Options           o;
	m.viscosity = { 0.25, 1.2 };
	if (feature == "spread") m.fracture.ratio = 3; // without a strength
	else if (feature == "gruneisen") m.eos.gruneisen = 3;
	else if (feature == "friction") m.friction = 0.9;
	else if (feature == "contacts") o.contacts = false;
	else if (feature == "awake") o.sleeping = false;
	else if (feature == "account") o.account = true;
	else if (feature == "strength") m.fracture.spall = 1e15;
	else if (feature == "elastic") m.yield = steel().yield;
	else if (feature == "inviscid") m.viscosity = { 0., 0. };
	else if (feature != "none") {
		std::cerr << "no feature '" << feature << "'\n";
		return 2;
	}
	const double d    = 1e-3;
	auto         list = packing(d, 40, 40, m, { 0, 0.2 * d, 0 });
	shake(list, 5., 1);
	Solver s;
	s.build(list, { m }, o);
	for (int k = 0; k < std::atoi(argv[2]); k++)
		s.computeForces(), s.integrate(2e-9);
	std::cout << s.counters.searches << '\n';
}
