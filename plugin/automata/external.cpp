// SPDX-License-Identifier: GPL-2.0-or-later
// What others do to the automata: forces, transmitting boundaries, ties to a grid, changes of place.
#include "solver.hpp"
#include <algorithm>
#include <cmath>
#include <sstream>

namespace mca::automata {

void Solver::addForce(size_t i, double fx, double fy, double torque)
{
	Store& S = store;
	for (auto v : { &S.outsideX, &S.outsideY, &S.outsideTorque })
		if (v->empty()) v->assign(S.size(), 0.);
	S.outsideX[i] += fx, S.outsideY[i] += fy, S.outsideTorque[i] += torque;
	if (fx != 0 || fy != 0 || torque != 0) {
		if (!S.blocks[i / blockSize].moving) topologyChanged = true;
		S.blocks[i / blockSize].moving = true;
	}
}

void Solver::clearForces()
{
	for (auto v : { &store.outsideX, &store.outsideY, &store.outsideTorque })
		std::fill(v->begin(), v->end(), 0.);
}

void Solver::setDamping(size_t i, double bx, double by)
{
	Store& S = store;
	if (!(bx >= 0) || !(by >= 0) || !std::isfinite(bx + by)) {
		std::ostringstream s;
		s << "automaton " << S.id[i] << ": viscous boundary coefficient (" << bx << ", " << by
		  << ") kg/(m s) must be finite and not negative (rho c A).";
		throw Error(s.str());
	}
	for (auto v : { &S.dampX, &S.dampY })
		if (v->empty()) v->assign(S.size(), 0.);
	S.dampX[i] = bx, S.dampY[i] = by;
}

size_t Solver::tie(size_t i, bool freeSpin)
{
	Store& S = store;
	if (S.flags[i] & tiedBit) throw Error("automaton " + std::to_string(S.id[i]) + " is tied already.");
	S.flags[i] |= tiedBit;
	S.perMassX[i] = S.perMassY[i] = 0.;
	if (!freeSpin) S.perInertia[i] = 0.;
	tied.push_back(int32_t(i)), tiedVx.push_back(S.vx[i]), tiedVy.push_back(S.vy[i]), tiedW.push_back(S.omega[i]);
	sums.kineticStart -= 0.5 * (S.mass[i] * (sqr(S.vx[i]) + sqr(S.vy[i])) + (S.perInertia[i] > 0 ? 0. : S.inertia[i] * sqr(S.omega[i])));
	return tied.size() - 1;
}

void Solver::setTiedVelocity(size_t t, double vx, double vy, double omega)
{
	Store&       S = store;
	const size_t i = tied[t];
	tiedVx[t] = S.vx[i], tiedVy[t] = S.vy[i], tiedW[t] = S.omega[i];
	S.vx[i] = vx, S.vy[i] = vy;
	if (!(S.perInertia[i] > 0)) S.omega[i] = omega;
	if ((vx != 0 || vy != 0 || omega != 0) && !S.blocks[i / blockSize].moving) S.blocks[i / blockSize].moving = topologyChanged = true;
}

void Solver::moved()
{
	lastMove        = 0.;
	topologyChanged = searchDue = true;
	for (auto& B : store.blocks)
		B.moving = B.awake = true;
}
}
