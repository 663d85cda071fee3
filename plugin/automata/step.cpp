// SPDX-License-Identifier: GPL-2.0-or-later
// Forces at the present positions: the order of the passes, checks of what they find.
#include "../kernels/automaton/filter.hpp"
#include "parallel.hpp"
#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace mca::automata {

void Solver::overlapError(size_t i, size_t j, double ratio) const
{
	const Store&       S = store;
	std::ostringstream s;
	s << "automata " << S.id[i] << " at " << S.position.at(i) << " m and " << S.id[j] << " at " << S.position.at(j) << " m are " << ratio
	  << " rest distances apart in step " << counters.steps
	  << "; the least allowed is 0.5 (0.2 if linked). Remedy: a smaller time step, a smaller impact speed, or no overlap in the packing.";
	throw Error(s.str());
}

void Solver::checkResults(double nearestContact, size_t closest)
{
	const Store& S       = store;
	double       nearest = nearestContact;
	int64_t      clamped = 0;
	for (int32_t b : awake) {
		const BlockResult& R = results[b];
		if (R.bad >= 0) {
			std::ostringstream s;
			s << "automaton " << S.id[R.bad] << ": volume ratio " << S.J[R.bad] << " in step " << counters.steps
			  << " is not in (0, 1e6). Remedy: a smaller time step (the limit was " << dtLimit << " s, the step " << lastDt << " s).";
			throw Error(s.str());
		}
		nearest = std::min(nearest, R.nearest);
		clamped += R.clamped;
	}
	counters.clamped += clamped;
	counters.deepest = std::min(counters.deepest, std::sqrt(nearest));
	// linked automata may shear until they are close; contacts may not overlap that far
	if (nearestContact >= deepestContact && nearest >= deepestLink) return;
	nearest = nearestContact < deepestContact ? nearestContact : nearest;
	if (nearestContact <= nearest) overlapError(contacts.owner[closest], contacts.other[closest], std::sqrt(nearest));
	for (int32_t b : awake)
		if (results[b].nearest <= nearest)
			for (int q = 0; q < nLinks * blockSize; q++) {
				const size_t i = size_t(b) * blockSize + q % blockSize, j = S.neighbour[size_t(b) * nLinks * blockSize + q];
				if (holds(S.flags[i], q / blockSize) && S.distance2(i, j) <= nearest * sqr(S.restDistance(i, j)) * 1.0001)
					overlapError(i, j, std::sqrt(nearest));
			}
}

void Solver::exchangeVolumes()
{
	filterTime += lastMove;
	if (!flows || !(options.volumeFilter > 0) || counters.steps % filterPeriod != 0) return;
	Timer t(timing, counters.nsDensity);
	filterVolumes();
}

/// What this step needs beside the links; null where the scene does not need it.
Extra Solver::extra()
{
	if (contacts.size() && options.account) scratch.resize(store.size(), true); // switched on since the last search
	Extra X;
	X.perMove = lastMove > 0 ? 1. / lastMove : 0.;
	if (contacts.size())
		X.contactSum = scratch.sum.data(), X.contactSq = scratch.square.data(), X.contactOld = scratch.old.data(), X.scale = scratch.scale.data(),
		X.contactForce = std::as_const(scratch.force).planes();
	for (int c = 0; contacts.size() && c < turns; c++) X.contactT[c] = turnPlane(scratch.torque, c).data();
	if (!options.account) return X;
	store.resizeShares(store.size()), accountForce.volumetric.resize(store.size()), accountForce.viscous.resize(store.size());
	X.account = true, X.volumetric = accountForce.volumetric.planes(), X.viscous = accountForce.viscous.planes();
	return X;
}

/// Pass 1, of contacts and links.
void Solver::volumes(const Extra& X)
{
	double nearest = 1e300;
	size_t closest = 0;
	if (contacts.size()) {
		Timer t(timing, counters.nsContact);
		nearest = contactVolumes(store, contacts, options.volumeRule, scratch, closest);
	}
	{
		Timer t(timing, counters.nsDensity);
		eachAwake([&](size_t b) { store.packBlock(b); });
		eachAwake([&](size_t b) {
			results[b].bad = -1;
			volumePass(store, b, options.volumeRule, X, false, results[b]);
		});
	}
	checkResults(nearest, closest);
}

/// Pass 2: the strain of the last move. Contacts give their trial stresses to the return of their owners and get its scale back.
void Solver::stresses(const Extra& X)
{
	const bool contact = contacts.size() > 0, account = options.account;
	contactSpeed2      = 0;
	if (contact) {
		Timer t(timing, counters.nsContact);
		contactSpeed2 = contactTrial(store, contacts, lastMove, scratch, account);
	}
	if (account) std::fill(works.begin(), works.end(), BlockWork());
	{
		Timer t(timing, counters.nsStress);
		eachAwake([&](size_t b) { stressPass(store, b, options.volumeRule, lastMove, X, results[b], account ? &works[b] : nullptr); });
	}
	ContactWork rubbed;
	if (contact) {
		Timer t(timing, counters.nsContact);
		contactPressure(store, contacts, options.volumeRule);
		if (lastMove > 0) contactFriction(store, contacts, scratch, account ? &rubbed : nullptr);
	}
	contactWork = rubbed;
}

/// Pass 3.
void Solver::forces(const Extra& X)
{
	if (contacts.size()) {
		Timer t(timing, counters.nsContact);
		contactForces(contacts, scratch, options.account);
	}
	Timer t(timing, counters.nsForce);
	eachAwake([&](size_t b) { forcePass(store, b, options.volumeRule, X); });
	if (bonds.size()) pullTogether();
}

/// Where materials have an internal energy, the heat of the viscosity of the last step goes into it.
void Solver::viscousHeats()
{
	if (store.heat.empty() || !(lastMove > 0)) return;
	eachAwake([&](size_t b) {
		const Material& m = store.materialOf(store.blocks[b]);
		if (m.eos.heats() && m.viscosity.active()) viscousHeat(store, b, options.volumeRule, lastMove, options.account ? &works[b] : nullptr);
	});
}

void Solver::bookPasses()
{
	if (!options.account) return;
	for (int32_t b : awake)
		sums.plastic += works[b].plastic, sums.coupling += works[b].coupling, sums.heated += works[b].heated;
	sums.friction += contactWork.friction, sums.coupling += contactWork.coupling, sums.plastic += contactWork.plastic;
}

void Solver::computeForces()
{
	if (options.contacts) searchIfNeeded();
	wake();
	counters.blockSteps += int64_t(awake.size());
	exchangeVolumes();
	const Extra X = extra();
	volumes(X);
	stresses(X);
	forces(X);
	viscousHeats();
	bookPasses();
	limitStep();
}
}
