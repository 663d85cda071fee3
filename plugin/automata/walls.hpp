// SPDX-License-Identifier: GPL-2.0-or-later
// Rigid bodies beside the automata: who touches them, and with what force. Nothing is looked at that neither automata nor walls can have reached since the last
// look; a scene without walls pays nothing.
#pragma once
#include "automata.hpp"
#include "solver.hpp"

namespace mca::automata {

class Walls {
public:
	/// Others than before, or other forms; contacts go on by their numbers.
	void set(std::vector<WallStart> list);
	/// Contacts that have held shear forces, by number of automaton and wall.
	const std::vector<WallTouch>& touches() const { return held; }
	void                          setTouches(const std::vector<WallTouch>& list) { held = list; }
	/// Puts the forces of this step on the automata; returns those on the walls, about their positions. A second call before keep() gives the same.
	/// level: where the plane of plane strain lies [m]. Throws Error where someone is too deep in a wall, or a wall ends within the plane.
	const std::vector<WallPush>& push(Solver& solver, const std::vector<WallPlace>& places, double level);
	/// The step is made.
	void keep() { held.swap(now); }
	/// The largest stable step where it is `free` without walls [s].
	double limit(double free) const;
	/// What was known of places is out of date: automata were sorted or moved by others.
	void forget() { known = false; }

private:
	struct Near { ///< of one block
		double               slack = 0; ///< travel of block and walls that changes nothing [m]
		double               from = 0;  ///< travel of both at the last look [m]
		std::vector<int32_t> walls;     ///< that may touch someone in it
		std::vector<int32_t> lanes;     ///< automata that they may touch
	};
	void   follow(const std::vector<WallPlace>& places);
	void   look(const Solver& solver, size_t block, double level);
	void   pushBlock(Solver& solver, size_t block, const std::vector<WallPlace>& places, double level);
	void   touch(Solver& solver, size_t i, size_t wall, const WallGap& gap, const WallPlace& place);
	bool   hidden(const WallGap& gap, double d) const;

	std::vector<WallStart>  walls;
	std::vector<WallBounds> bounds; ///< in this step
	double                  moved = 0; ///< largest way of any wall in each step, summed [m]
	std::vector<Near>       near;      ///< of all blocks
	bool                    known = false;     ///< `near` is right
	int64_t                 sorts = -1;        ///< of the automata, when it was made
	std::vector<WallTouch>  held, now; ///< of the last step and this one, by number of automaton
	std::vector<WallGap>    found;     ///< accepted contacts of one automaton
	std::vector<WallPush>   pushes;
	double                  stiffness = 0, stiffest = 0; ///< of one automaton, and the largest: sum of stiffnesses over mass [1/s2]
	std::vector<double>     onWall;       ///< sum of the stiffnesses on each wall [N/m]
};
}
