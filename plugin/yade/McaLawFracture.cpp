// SPDX-License-Identifier: GPL-2.0-or-later
// McaLaw: breaking of links and exchange of volume, at the steps and in the order of plugin/automata.
#include "McaLaw.hpp"
#include "McaVec.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <kernels/automaton/energy.hpp>
#include <kernels/automaton/filter.hpp>
#include <kernels/automaton/outline.hpp>

namespace yade {
using mca::nLinks;
using mca::sqr;
using mca::VolumeRule;

bool McaLaw::breaks(const Row& r, int k) const
{
	const Side& s = r.link[k];
	if (!r.material->fracture.active()) return false;
	const auto end = [&](const Row& a, int side) { return mca::LinkEnd { a.l->criterion, s.p->s[side], a.m->volumeRatio, a.m->pressure, a.m->strength }; };
	return mca::breaks(r.material->fracture, end(r, s.side), end(rows[size_t(s.other)], 1 - s.side), distance2(r, s), s.p->d);
}

void McaLaw::breakLinks()
{
	vector<std::pair<int, int>> pairs; // (row, link)
	vector<int>                 touched;
	for (size_t i = 0; i < rows.size(); i++)
		for (int k = 0; k < nLinks; k++)
			if (rows[i].link[k].p && breaks(rows[i], k))
				pairs.emplace_back(int(i), k), touched.push_back(int(i)), touched.push_back(rows[i].link[k].other);
	std::sort(touched.begin(), touched.end());
	touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
	// the volume at the present positions, as all links measure it: the work of the last move must not be lost
	vector<Real> J;
	for (int i : touched) {
		const Row& r = rows[size_t(i)];
		J.push_back(r.l->rule == int(VolumeRule::affine) && r.l->factor > 0 ? r.l->factor * determinantNow(r) + r.l->rest : r.m->volumeRatio);
	}
	for (const auto& [i, k] : pairs) {
		Row& r = rows[size_t(i)];
		if (!r.link[k].p) continue; // seen from the other side before
		const Side s = r.link[k];
		Row&       o = rows[size_t(s.other)];
		const int  back = mca::Lattice::opposite(k);
		unlink(r, s, k), unlink(o, { s.p, 1 - s.side, int(i) }, back);
		s.p->linked = s.p->half = false;
		s.p->startContact(distance(r, s)); // stresses go on
		r.link[k] = o.link[back] = Side();
		brokenLinks++;
		r.m->brokenLinks++, o.m->brokenLinks++;
	}
	for (size_t q = 0; q < touched.size(); q++)
		keepVolume(touched[q], J[q]);
}

/// One end of a link that breaks. It stays known as one that has held; its stresses go on in the contact.
void McaLaw::unlink(Row& r, const Side& s, int k)
{
	Real &     normal = s.p->s[s.side], &shear = s.p->tau[s.side];
	const Real weight = mca::linkWeight(r.l->flags, k), J = r.m->volumeRatio;
	if (Omega::instance().getScene()->trackEnergy) fracture += mca::lostAtBreak(r.d, weight, mca::pairEnergy(normal, shear, J, s.p->twoG));
	r.lost += weight * normal / J;
	normal *= weight, shear *= weight;
	r.l->flags = mca::withoutTriangles(r.l->flags & ~(1 << k | 1 << (mca::halfShift + k))) | mca::exposedBit;
}

/// det F of the links that hold, at the present positions.
Real McaLaw::determinantNow(const Row& r) const
{
	mca::Tensor<Real> sum = {};
	for (int k = 0; k < nLinks; k++) {
		if (!r.link[k].p) continue;
		const Vector3r x = rows[size_t(r.link[k].other)].state->se3.position - r.state->se3.position;
		addDyad(sum, mca::outlineTable.of(mca::trianglesIn(r.l->flags), k), vec(x));
	}
	return mca::linkDeterminant(sum, mca::Lattice::perVolume(r.d));
}

// What the links had measured goes on as the rest state of what is left.
void McaLaw::keepVolume(int i, Real J)
{
	Row&         r = rows[size_t(i)];
	McaLawState& l = *r.l;
	if (l.rule == int(VolumeRule::affine)) {
		if (l.factor == 0) return;
		l.factor = mca::affineFactor(J, l.rest, determinantNow(r));
		if (l.factor == 0) unsettled.emplace_back(i, J > 0 ? J : r.m->volumeRatio);
		return;
	}
	mca::dispatch(VolumeRule(l.rule), [&](auto rule) {
		Real sum = 0;
		for (int k = 0; k < nLinks; k++)
			if (r.link[k].p) sum += mca::linkWeight(l.flags, k) * mca::volumeTerm<rule.value>(r.link[k].p->d, distance2(r, r.link[k]));
		l.rest = mca::restKeeping<rule.value>(r.m->volumeRatio, sum + l.contactSum, l.invN);
	});
	if (l.flags & mca::linkBits) return;
	l.rest = 0;
	unsettled.emplace_back(i, r.m->volumeRatio);
}

Real McaLaw::coldEnergyAt(const Row& r, Real J) const { return mca::coldEnergy(*r.material, r.l->cell, J); }
/// Of the volume that contacts give it, if it has links: in the affine rule a volume of its own.
Real McaLaw::contactEnergyAt(const Row& r, Real Jc) const { return mca::coldEnergy(*r.material, mca::contactCell(r.d, r.l->cell, 1.), Jc); }

/// Stresses of all its pairs, kept as J times them.
void McaLaw::scaleStresses(const Row& r, Real ratio)
{
	for (const Side& s : r.link)
		if (s.p) s.p->s[s.side] *= ratio, s.p->tau[s.side] *= ratio;
	for (int c = r.firstContact; c < r.lastContact; c++) {
		const Side& s = contacts[size_t(c)];
		s.p->s[s.side] *= ratio, s.p->tau[s.side] *= ratio;
	}
}

// See mca::Settling: what has lost its volume has it from its contacts from now on; what cannot go on is released, and booked.
void McaLaw::settleVolumes(bool account)
{
	for (const auto& entry : unsettled) {
		Row&       r      = rows[size_t(entry.first)];
		const Real J      = entry.second;
		const auto rule   = VolumeRule(r.l->rule);
		const bool affine = rule == VolumeRule::affine, heat = r.material->eos.heats();
		int        near   = 0;
		Real       sum    = 0;
		for (int c = r.firstContact; c < r.lastContact; c++) {
			const Side& s = contacts[size_t(c)];
			const Real  r2 = distance2(r, s);
			near += mca::Settling::isNear(std::sqrt(r2), s.p->d);
			if (affine && s.p->pushes(s.side, r2)) sum += mca::volumeTerm<mca::ofContacts(VolumeRule::affine)>(s.p->rest[s.side], r2);
		}
		const Real          Jc = mca::contactRatio(sum), now = r.m->volumeRatio;
		const mca::Settling settling(rule, J, Jc, near, r.l->invN);
		for (int c = r.firstContact; (settling.holds || !affine) && c < r.lastContact; c++) {
			const Side& s         = contacts[size_t(c)];
			s.p->rest[s.side] = settling.restDistance(rule, distance(r, s), s.p->d);
		}
		if (account && settling.holds) fracture += affine ? contactEnergyAt(r, Jc) : 0.;
		if (account && !settling.holds && !heat) // else it is in the heat
			fracture += coldEnergyAt(r, J) + (affine ? contactEnergyAt(r, Jc) - coldEnergyAt(r, Jc) : 0.);
		if (settling.holds) continue;
		if (affine && heat) { // what the contacts' own volume (5) had stored is from now on part of the internal energy
			r.m->dissipated += contactEnergyAt(r, Jc) / (r.l->cell * r.material->eos.rho0);
			r.l->P = r.m->pressure = mca::pressure(r.material->eos, Jc - 1.);
		}
		scaleStresses(r, Jc / now); // stresses go on
		r.m->volumeRatio = Jc;
	}
	unsettled.clear();
}

void McaLaw::filterVolumes(bool account)
{
	const auto exchanges = [](const Row& r) { return mca::exchangesVolume(r.m->plasticStrain, r.l->flags, r.l->factor); };
	for (Row& r : rows) {
		r.curvature = 0;
		if (!exchanges(r)) continue;
		for (const Side& s : r.link)
			r.curvature += rows[size_t(s.other)].m->volumeRatio - r.m->volumeRatio;
	}
	vector<Real> change(rows.size(), 0.);
	for (size_t i = 0; i < rows.size(); i++) {
		const Row& r = rows[i];
		if (!exchanges(r)) continue;
		Real sum = 0;
		for (const Side& s : r.link) {
			const Row& o = rows[size_t(s.other)];
			if (exchanges(o) && o.material == r.material && o.d == r.d) sum += r.curvature - o.curvature;
		}
		change[i] = sum * mca::volumeExchange(volumeFilter, r.material->eos.c0, filterTime, r.d);
	}
	for (size_t i = 0; i < rows.size(); i++) {
		if (change[i] == 0) continue;
		Row&       r = rows[i];
		const Real now = r.m->volumeRatio, J = now + change[i], ratio = J / now;
		if (account) {
			Real pairs = 0;
			for (const Side& s : r.link)
				pairs += mca::pairEnergy(s.p->s[s.side], s.p->tau[s.side], now, s.p->twoG);
			coupling += (r.material->eos.heats() ? 0. : coldEnergyAt(r, now) - coldEnergyAt(r, J))
				+ mca::deviatorEnergy(r.material->G, r.d, pairs, now, r.m->stressZZ, r.l->invN) * (1. - ratio);
		}
		r.m->volumeRatio = J;
		r.l->factor *= ratio;
		for (const Side& s : r.link)
			s.p->s[s.side] *= ratio, s.p->tau[s.side] *= ratio;
	}
	filterTime = 0;
}
} // namespace yade
