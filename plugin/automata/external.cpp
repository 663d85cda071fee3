// SPDX-License-Identifier: GPL-2.0-or-later
// What others do to the automata: forces, transmitting boundaries, ties to a grid, changes of place.
#include "solver.hpp"
#include <algorithm>
#include <cmath>
#include <sstream>

namespace mca::automata {

void Solver::addForce(size_t i, Vec<double> force, Turn<double> torque)
{
	Store& S = store;
	if (S.outside.empty()) S.outside.resize(S.size()), S.outsideTorque.resize(S.size());
	pushed.resize(S.blocks.size()), pushed[i / blockSize] = 1;
	S.outside.add(i, force), addTurn(S.outsideTorque, i, torque);
	if (!isZero(force) || !isZero(torque)) {
		if (!S.blocks[i / blockSize].moving) topologyChanged = true;
		S.blocks[i / blockSize].moving = true;
	}
}

void Solver::clearForces()
{
	for (size_t b = 0; b < pushed.size(); b++) {
		if (!pushed[b]) continue;
		const auto first = std::ptrdiff_t(b * blockSize);
		eachPlane([&](auto& v) { std::fill(v.begin() + first, v.begin() + first + blockSize, 0.); }, store.outside, store.outsideTorque);
		pushed[b] = 0;
	}
}

void Solver::drive(size_t i, int axis, double velocity)
{
	Store&       S = store;
	const double before = S.velocity[axis][i];
	const auto   who = "automaton " + std::to_string(S.id[i]);
	if (S.flags[i] & tiedBit) throw Error(who + " is tied to a grid, which moves it; its velocity cannot be prescribed.");
	if (S.perMass[axis][i] != 0.) throw Error(who + " has a prescribed velocity and is free to move in that direction; block it (blockedDOFs).");
	if (velocity == before) return;
	if (options.account)
		sums.external += 0.5 * S.mass[i] * (velocity * velocity - before * before), sums.impulse[axis] += S.mass[i] * (velocity - before);
	S.velocity[axis][i] = velocity;
	if (!S.blocks[i / blockSize].moving) S.blocks[i / blockSize].moving = topologyChanged = true;
}

void Solver::setDamping(size_t i, Vec<double> b)
{
	Store& S = store;
	if (!std::all_of(b.component, b.component + dim, [](double v) { return v >= 0 && std::isfinite(v); })) {
		std::ostringstream s;
		s << "automaton " << S.id[i] << ": viscous boundary coefficient " << b << " kg/(m s) must be finite and not negative (rho c A).";
		throw Error(s.str());
	}
	if (S.damp.empty()) S.damp.resize(S.size());
	S.damp.set(i, b);
}

size_t Solver::tie(size_t i, bool freeSpin)
{
	Store& S = store;
	if (S.flags[i] & tiedBit) throw Error("automaton " + std::to_string(S.id[i]) + " is tied already.");
	S.flags[i] |= tiedBit;
	S.perMass.set(i, {});
	if (!freeSpin) setTurn(S.perInertia, i, {});
	tied.push_back(int32_t(i)), tiedVelocity.push_back(S.velocity.at(i)), tiedSpin.push_back(turnAt(S.omega, i));
	sums.kineticStart -= 0.5 * (S.mass[i] * plainSquare(S.velocity.at(i)) + (turnsFreely(i) ? 0. : S.inertia[i] * plainSquare(turnAt(S.omega, i))));
	return tied.size() - 1;
}

void Solver::setTiedVelocity(size_t t, Vec<double> velocity, Turn<double> omega)
{
	Store&       S = store;
	const size_t i = tied[t];
	tiedVelocity.set(t, S.velocity.at(i)), setTurn(tiedSpin, t, turnAt(S.omega, i));
	S.velocity.set(i, velocity);
	if (!turnsFreely(i)) setTurn(S.omega, i, omega);
	if ((!isZero(velocity) || !isZero(omega)) && !S.blocks[i / blockSize].moving) S.blocks[i / blockSize].moving = topologyChanged = true;
}

void Solver::moved()
{
	lastMove        = 0.;
	topologyChanged = searchDue = true;
	for (auto& B : store.blocks)
		B.moving = B.awake = true;
}
}
