// SPDX-License-Identifier: GPL-2.0-or-later
// Automata added and erased during a run: those that stay keep their links, stresses, contacts and history.
#include "solver.hpp"
#include <algorithm>

namespace mca::automata {

Solver Solver::knowing(const std::vector<Automaton>& automata, const std::vector<Material>& materials, const std::vector<LinkRecord>& links)
{
	auto   apart = automata; // in one row, so far apart that no links form but those that are told
	double d     = 0;
	for (auto& a : apart)
		d = std::max(d, a.diameter);
	for (size_t i = 0; i < apart.size(); i++) apart[i].position = {}, apart[i].position[0] = 4. * d * double(i), apart[i].triangles = 0;
	Options o;
	o.contacts = false;
	Solver known;
	known.build(apart, materials, o);
	Store& S = known.store;
	for (const LinkRecord& r : links) {
		const size_t i = size_t(known.indexOf(r.id));
		S.flags[i] = r.flags, S.invN[i] = r.invN;
		for (int k = 0; k < nLinks; k++) {
			const int64_t j = known.indexOf(r.partner[k]);
			if (j >= 0) S.neighbour[linkSlot(i, k)] = int32_t(j);
			else if ((S.flags[i] >> (hadShift + k)) & 1) // its partner was erased
				S.flags[i] = withoutTriangles(S.flags[i] & ~slotBits(k)) | exposedBit;
		}
	}
	return known;
}

/// Links between automata that the old solver knew, in their old slots; links to erased ones are gone for good.
void Solver::inheritLinks(const Solver& old)
{
	Store&       S = store;
	const Store& O = old.store;
	for (size_t i = 0; i < S.size(); i++) {
		const int64_t o = S.id[i] < 0 ? -1 : indexIn(old, S.id[i]);
		if (o < 0) continue;
		S.flags[i] |= O.flags[o] & Flags(exposedBit | outlineBits);
		S.invN[i] = O.invN[o];
		for (int k = 0; k < nLinks; k++) {
			const size_t at = linkSlot(i, k), from = linkSlot(o, k);
			if (!((O.flags[o] >> (hadShift + k)) & 1)) continue;
			const int32_t partner = O.id[O.neighbour[from]];
			const int64_t j       = indexIn(old, partner) < 0 ? -1 : indexOf(partner);
			if (j < 0) { // its partner was erased: the slot is free for a new automaton
				S.flags[i] = withoutTriangles(S.flags[i]) | exposedBit;
				continue;
			}
			S.neighbour[at] = int32_t(j), S.setStress(at, O.stressAt(from));
			S.flags[i] |= O.flags[o] & slotBits(k);
		}
	}
}

/// Tied automata keep their places in the order of tie().
void Solver::inheritTied(const Solver& old)
{
	Store&       S = store;
	const Store& O = old.store;
	for (int32_t o : old.tied) {
		const int64_t i = indexIn(old, O.id[o]) < 0 ? -1 : indexOf(O.id[o]);
		if (i < 0) throw Error("automaton " + std::to_string(O.id[o]) + " is tied to a grid; it cannot be erased.");
		S.flags[i] |= tiedBit;
		S.perMass.set(i, O.perMass.at(o)), setTurn(S.perInertia, i, turnAt(O.perInertia, o));
		tied.push_back(int32_t(i));
	}
	tiedVelocity = old.tiedVelocity, tiedSpin = old.tiedSpin;
}

/// Old contacts bring their stresses along through the search; what the volumes of their owners hold stays in the account until then.
void Solver::inheritContacts(const Solver& old)
{
	const Store& O = old.store;
	Store&       S = store;
	for (size_t r = 0; r < old.contacts.rows(); r++) {
		const int32_t id = O.id[old.contacts.rowOwner[r]];
		const int64_t i  = indexIn(old, id) < 0 ? -1 : indexOf(id);
		if (i < 0) continue;
		const size_t first = contacts.size();
		double       gone  = 0; // terms of those that are erased
		for (int32_t c = old.contacts.rowBegin[r]; c < old.contacts.rowBegin[r + 1]; c++) {
			const int32_t mate = O.id[old.contacts.other[c]];
			const int64_t j    = indexIn(old, mate) < 0 ? -1 : indexOf(mate);
			if (j < 0) {
				const double r2 = O.distance2(old.contacts.owner[c], old.contacts.other[c]), rest = old.contacts.rest[c];
				if (pushes(r2, rest, old.contacts.d[c]) > 0.)
					dispatch(options.volumeRule, [&](auto rule) { gone += volumeTerm<ofContacts(rule.value)>(rest, r2); });
				continue;
			}
			contacts.owner.push_back(int32_t(i)), contacts.other.push_back(int32_t(j));
			pushSide(contacts, sideOf(old.contacts, c));
			contacts.rest.push_back(old.contacts.rest[c]), contacts.twoG.push_back(old.contacts.twoG[c]);
		}
		if (contacts.size() == first) continue;
		if (contacts.rowBegin.empty()) contacts.rowBegin.push_back(0);
		contacts.rowOwner.push_back(int32_t(i)), contacts.rowBegin.push_back(int32_t(contacts.size()));
		if (scratch.sum.empty()) scratch.resize(S.size(), options.account);
		S.blocks[size_t(i) / blockSize].contact = true, scratch.sum[i] = std::max(0., old.contactSum(size_t(indexIn(old, id))) - gone);
	}
}

void Solver::inheritState(const Solver& old)
{
	Store&       S = store;
	const Store& O = old.store;
	broken = old.broken;
	for (size_t q = 0; q < old.asked.size(); q += 2)
		if (indexOf(old.asked[q]) >= 0 && indexOf(old.asked[q + 1]) >= 0) asked.push_back(old.asked[q]), asked.push_back(old.asked[q + 1]);
	bonds = old.bonds;
	const auto stays = [&](int32_t id) { return indexIn(old, id) >= 0 && indexOf(id) >= 0; };
	bonds.keep([&](size_t q) { return stays(bonds.first[q]) && stays(bonds.second[q]); });
	knownBonds = bonds.size();
	sums = old.sums, counters = old.counters, time = old.time, lastDt = old.lastDt, lastMove = old.lastMove, lastSort = old.lastSort, dtLimit = old.dtLimit,
	filterTime = old.filterTime;
	for (size_t i = 0; i < S.size(); i++) {
		const int64_t o = S.id[i] < 0 ? -1 : indexIn(old, S.id[i]);
		if (o < 0) continue;
		S.J[i] = O.J[o], S.P[i] = O.P[o], S.mean[i] = O.mean[o], S.viscous[i] = O.viscous[o], S.h[i] = O.h[o],
		S.eqps[i] = O.eqps[o], S.dTheta[i] = O.dTheta[o];
		S.temperature[i] = O.temperature[o], S.strength[i] = O.strength[o], S.criterion[i] = O.criterion[o];
		setTurn(S.angle, i, turnAt(O.angle, o));
#define MCA_INHERIT(name, ...) S.name[i] = O.name[o];
		MCA_DEVIATORS(MCA_INHERIT)
#undef MCA_INHERIT
		if (!S.heat.empty() && !O.heat.empty()) S.heat[i] = O.heat[o];
		if (!S.damage.empty() && !O.damage.empty()) S.damage[i] = O.damage[o];
		bool same = trianglesIn(S.flags[i]) == trianglesIn(O.flags[o]);
		for (int k = 0; k < nLinks; k++) {
			const bool before = (O.flags[o] >> k) & 1, now = (S.flags[i] >> k) & 1;
			same &= before == now && (!now || S.id[S.neighbour[linkSlot(i, k)]] == O.id[O.neighbour[linkSlot(o, k)]]);
		}
		S.rest[i] = O.rest[o], S.factor[i] = O.factor[o];
		if (same) continue;
		// the volume goes on from where it was (the change over the last step is lost: J was taken before the last move)
		if (options.volumeRule == VolumeRule::affine && S.factor[i] == 0.) S.factor[i] = 1.;
		keepVolume(i, S.J[i]);
		if (options.volumeRule != VolumeRule::affine && S.flags[i] & linkBits && O.blocks[size_t(o) / blockSize].contact)
			S.rest[i] += old.contactSum(size_t(o)); // its contacts come back with the search
	}
	sums.fracture = old.sums.fracture; // what deviators lose here has left with the erased ones, see below
	inheritTied(old);
	inheritContacts(old);
	for (auto& B : S.blocks)
		B.moving = B.awake = true;
	topologyChanged = true;
	// what joined or left changes the sum, not the balance
	const Account now = account(), before = old.account();
	sums.leftKinetic += before.kinetic - now.kinetic, sums.leftVolumetric += before.volumetric - now.volumetric,
		sums.leftDeviatoric += before.deviatoric - now.deviatoric;
	sums.left += before.kinetic + before.volumetric + before.deviatoric - now.kinetic - now.volumetric - now.deviatoric;
	sums.leftMomentum += before.momentum - now.momentum;
	sums.leftMass += old.ownMass() - ownMass();
	wake();
	for (size_t i = 0; i < S.size(); i++)
		results[i / blockSize].criterion = std::max(results[i / blockSize].criterion, S.flags[i] & linkBits ? S.criterion[i] : 0.);
	searchDue = true; // the next computeForces() makes the list of contacts whole
}
}
