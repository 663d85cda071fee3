// SPDX-License-Identifier: GPL-2.0-or-later
// Pairs whose links have broken and that hold together until their fracture energy is spent (11f)-(11h).
#include "../threads.hpp"
#include "solver.hpp"
#include <cmath>

namespace mca::automata {
namespace {
	constexpr long parallelFrom = 1024; ///< pairs below which waking a thread costs more than it brings
}

/// Whether the links of an automaton carry its pressure.
bool Solver::spansVolume(size_t i) const { return options.volumeRule != VolumeRule::affine || store.factor[i] > 0.; }

/// What the stress of one end of a link loses where its contact goes on with what pushes.
double Solver::lostToBond(size_t i, int k, Vec<double> r) const
{
	const Store&       S = store;
	const size_t       at = linkSlot(i, k), j = size_t(S.neighbour[at]);
	const Side<double> side = S.stressAt(at);
	const double       twoG = S.pairTwoG(S.speciesOf(i), j, arm(S.diameter[i], S.diameter[j]));
	return mca::lostToBond(S.diameter[i], linkWeight(S.flags[i], k), pairEnergy(side, S.J[i], twoG), pairEnergy(pushOnly(side, r), S.J[i], twoG));
}

/// What a link does as it breaks, by the stresses of both ends.
Breaking Solver::breakingOf(size_t i, int k) const
{
	const Store&       S = store;
	const size_t       j = size_t(S.neighbour[linkSlot(i, k)]);
	const Material &   a = S.materialOf(i), &b = S.materialOf(j);
	const Vec<double>  r = S.between(i, j);
	const double       d = S.restDistance(i, j), area = linkWeight(S.flags[i], k) * Lattice::area(d) / d;
	const Side<double> mine = scaled(wholeSideAt(S, i, k, r), 1. / S.J[i]), theirs = scaled(wholeSideAt(S, j, Lattice::opposite(k), -r), 1. / S.J[j]);
	const auto         pressing = [&](size_t q) { return spansVolume(q) ? S.mean[q] : 0.; }; // through this link
	const double       lost = lostToBond(i, k, r) + lostToBond(j, Lattice::opposite(k), -r);
	return breakingPair(ofBothSides(0.5 * area, mine, theirs), r, 0.5 * area * (pressing(i) + pressing(j)), area, d, a, b, lost);
}

/// A pair whose link breaks may hold together; returns whether it does. Its contact has no share of what it pulls.
bool Solver::bondAt(size_t i, int k, BreakCause cause)
{
	const size_t      j = size_t(store.neighbour[linkSlot(i, k)]);
	const Vec<double> r = store.between(i, j), u = (store.velocity.at(j) - store.velocity.at(i)) * lastMove;
	const Breaking    b = breakingOf(i, k);
	const Bond        bond = isCohesive(cause) ? startBond(b) : Bond {};
	const bool        holdsOn = bond.first > 0;
	if (holdsOn) bonds.add(store.id[i], store.id[j], bond, scaled(b.pull, 1. / bond.stiffness));
	if (!options.account) return holdsOn;
	sums.fracture += workAtBreak(b, r, u, options.volumeRule == VolumeRule::affine, holdsOn);
	if (holdsOn) sums.fracture += b.lost - heldAtStart(bond);
	return holdsOn;
}

/// What its contact goes on with at one end: what pushes.
void Solver::leavePush(size_t i, int k)
{
	const size_t at = linkSlot(i, k), j = size_t(store.neighbour[at]);
	store.setStress(at, pushOnly(store.stressAt(at), store.between(i, j)));
}

/// Throws Error where strengths are too much for a fracture energy.
void Solver::checkCohesion(const PairRules& rules) const
{
	const Store& S = store;
	for (const Species& a : S.species)
		for (const Species& b : S.species)
			mca::checkCohesion(
				S.materials[size_t(a.material)], S.materials[size_t(b.material)], 0.5 * (a.d + b.d), rules.of(a.material, b.material));
}

/// Adds what they pull to the forces; those that have parted are forgotten.
void Solver::pullTogether()
{
	Bonds& B = bonds;
	B.pull.resize(B.size()), B.spentNow.resize(B.size());
	inParts(long(B.size()), parallelFrom, [&](long first, long last) {
		for (size_t q = size_t(first); q < size_t(last); q++) {
			const size_t       i = size_t(indexOf(B.first[q])), j = size_t(indexOf(B.second[q]));
			const double       q1 = arm(store.diameter[i], store.diameter[j]);
			const double       since = q < knownBonds ? lastMove : 0.; // those that broke in this step start where they are
			const Vec<double>  r = store.between(i, j), u = (store.velocity.at(j) - store.velocity.at(i)) * since;
			const Turn<double> spin = pairSpin(turnAt(store.omega, i), turnAt(store.omega, j), q1, since);
			Bond               b    = B.at(q);
			const double       before = spent(b);
			const Side<double> w      = opened(sideOf(B, q), b.rest, r, u, spin);
			setSide(B, q, w);
			B.pull[q] = pullOf(b, w, r, q1);
			B.most[q] = b.most, B.spentNow[q] = spent(b) - before;
		}
	});
	for (size_t q = 0; q < B.size(); q++) {
		const size_t i = size_t(indexOf(B.first[q])), j = size_t(indexOf(B.second[q]));
		const Pull&  p = B.pull[q];
		store.force.add(i, p.force), store.force.add(j, -p.force);
		addTurn(store.torque, i, p.torque), addTurn(store.torque, j, p.other);
		if (options.account) sums.fracture += B.spentNow[q];
	}
	B.keep([&](size_t q) { return B.most[q] < B.until[q]; });
	knownBonds = B.size();
}

double Solver::energyOfBonds() const
{
	double sum = 0;
	for (size_t q = 0; q < bonds.size(); q++) {
		const size_t i = size_t(indexOf(bonds.first[q])), j = size_t(indexOf(bonds.second[q]));
		sum += heldNow(bonds.at(q), sideOf(bonds, q), store.between(i, j));
	}
	return sum;
}
}
