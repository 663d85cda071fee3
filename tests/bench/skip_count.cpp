// SPDX-License-Identifier: GPL-2.0-or-later
// Steps of a block of automata with one feature present or absent, for counting instructions (valgrind --tool=callgrind):
// tests/python/test_skip_instructions.py.
//   skip_count FEATURE STEPS
#include "../unit/automata_scene.hpp"
#include <algorithm>
#include <automata/automata.hpp>
#include <iostream>
using namespace automatatest;

namespace {
	/// The same block as the caller's interface takes it, above a rigid wall: far away, or along its lowest row, which it touches.
	void overWall(const std::vector<Automaton>& list, const Material& m, const Options& o, double d, bool touches, int steps)
	{
		std::vector<mca::AutomatonStart> starts;
		double                           low = 1e300;
		for (const Automaton& a : list) {
			mca::AutomatonStart s;
			s.position = { a.position[0], a.position[1], 0. }, s.velocity = { a.velocity[0], a.velocity[1], 0. };
			s.mass = a.mass, s.inertia = a.inertia, s.diameter = a.diameter, s.weight = a.weight, s.id = a.id, s.group = a.group;
			low = std::min(low, a.position[1]);
			starts.push_back(s);
		}
		const auto solver = mca::plane::makeAutomata();
		solver->build(starts, { m }, o, nullptr);
		mca::WallStart wall;
		mca::WallPlace at;
		wall.id = int(list.size()) + 1000, wall.form.axis = 1;
		at.position = { { 0., low - (touches ? 0.45 : 5.) * d, 0. } };
		solver->setWalls({ wall });
		for (int k = 0; k < steps; k++) {
			solver->computeForces();
			solver->clearForces();
			at.moved = k == 0;
			solver->pushWalls({ at }, 0.);
			solver->integrate(2e-9);
		}
		std::cout << solver->counters().searches << '\n';
	}
}

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
	else if (feature != "none" && feature != "wallFar" && feature != "wallTouching") {
		std::cerr << "no feature '" << feature << "'\n";
		return 2;
	}
	const double d    = 1e-3;
	auto         list = packing(d, 40, 40, m, { 0, 0.2 * d, 0 });
	shake(list, 5., 1);
	if (feature.compare(0, 4, "wall") == 0) return overWall(list, m, o, d, feature == "wallTouching", std::atoi(argv[2])), 0;
	Solver s;
	s.build(list, { m }, o);
	for (int k = 0; k < std::atoi(argv[2]); k++)
		s.computeForces(), s.integrate(2e-9);
	std::cout << s.counters.searches << '\n';
}
