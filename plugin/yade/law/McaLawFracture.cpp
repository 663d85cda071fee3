// SPDX-License-Identifier: GPL-2.0-or-later
// McaLaw: breaking of links and exchange of volume, at the steps and in the order of plugin/automata.
#include "McaLawRows.hpp"
#include "automata/sides.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <set>
#include <kernels/automaton/filter.hpp>
#include <kernels/automaton/fracture.hpp>

namespace yade {
namespace MCA_SPACE {
using mca::nLinks;
using mca::VolumeRule;

/// One end of link k.
mca::LinkEnd Loop::linkEnd(const Row& r, int k) const
{
	const Side& s      = r.link[k];
	const Vec   x      = between(r, s);
	const Real  normal = mca::normalStress(wholeStress(*r.m, *r.l, stressOf(*s.p, s.side), x), x);
	return { r.l->criterion, normal, r.m->volumeRatio, r.m->pressure, r.m->strength };
}

bool Loop::breaks(const Row& r, int k) const
{
	const Side& s = r.link[k];
	const Row&  o = rows[size_t(s.other)];
	if (!r.material->fracture.active() && !std::isfinite(ruleOf(r, o).tension)) return false;
	return mca::breaks(r.material->fracture, linkEnd(r, k), linkEnd(o, mca::Lattice::opposite(k)), distance2(r, s), s.p->d, ruleOf(r, o));
}

/// Whether a link that breaks may hold on: a script has not cut it, and it is not only sheared past its packing.
bool Loop::mayHoldOn(const Row& r, int k) const
{
	const Side& s = r.link[k];
	const Row&  o = rows[size_t(s.other)];
	return !mca::collapses(linkEnd(r, k), linkEnd(o, mca::Lattice::opposite(k)), distance2(r, s), s.p->d, ruleOf(r, o));
}

void Loop::breakLinks()
{
	vector<std::pair<int, int>> pairs; // (row, link)
	vector<int>                 touched;
	std::set<std::pair<int, int>> cut; // by a script
	for (size_t q = 0; q < law.asked.size(); q += 2) cut.insert(std::minmax(law.asked[q], law.asked[q + 1]));
	const auto asked = [&](size_t i, int k) { return cut.count(std::minmax(rows[i].id, rows[size_t(rows[i].link[k].other)].id)) > 0; };
	const bool due = law.steps % mca::breakPeriod == 0;
	for (size_t i = 0; i < rows.size(); i++)
		for (int k = 0; k < nLinks; k++)
			if (rows[i].link[k].p && (asked(i, k) || (due && breaks(rows[i], k))))
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
		const int  back    = mca::Lattice::opposite(k);
		const bool holdsOn = s.side ? bond(o, back, !asked(size_t(i), k)) : bond(r, k, !asked(size_t(i), k));
		unlink(r, s, k, holdsOn), unlink(o, { s.p, 1 - s.side, int(i) }, back, holdsOn);
		s.p->linked = s.p->half = false;
		s.p->startContact(distance(r, s)); // stresses go on
		r.link[k] = o.link[back] = Side();
		law.brokenLinks++;
		r.m->brokenLinks++, o.m->brokenLinks++;
	}
	law.asked.clear();
	for (size_t q = 0; q < touched.size(); q++)
		keepVolume(touched[q], J[q]);
}

/// One end of a link that breaks. It stays known as one that has held; its stresses go on in the contact, where cohesion holds on what pushes.
void Loop::unlink(Row& r, const Side& s, int k, bool holdsOn)
{
	const mca::Flags flags  = flagsOf(*r.l);
	const Stress     held   = stressOf(*s.p, s.side);
	const Real       weight = mca::linkWeight(flags, k);
	if (!holdsOn && Omega::instance().getScene()->trackEnergy)
		law.fracture += mca::lostAtBreak(r.d, weight, mca::pairEnergy(held, r.m->volumeRatio, s.p->twoG));
	const Stress goesOn = mca::scaled(holdsOn ? mca::pushOnly(held, between(r, s)) : held, weight);
	setStress(*s.p, s.side, goesOn);
	if (mca::square(goesOn) > 0) r.lost.push_back(s);
	const mca::Flags bits = mca::Flags(1) << k | mca::Flags(1) << (mca::halfShift + k);
	r.l->flags            = mca::withoutTriangles(flags & ~bits) | mca::exposedBit;
}

/// det F of the links that hold, at the present positions.
Real Loop::determinantNow(const Row& r) const
{
	LinkSums sums;
	for (int k = 0; k < nLinks; k++)
		if (r.link[k].p) sums.add(flagsOf(*r.l), k, between(r, r.link[k]));
	sums.complete(*r.l);
	return mca::linkDeterminant(sums.F, mca::Lattice::perVolume(r.d));
}

// What the links had measured goes on as the rest state of what is left.
void Loop::keepVolume(int i, Real J)
{
	Row&         r = rows[size_t(i)];
	McaLawState& l = *r.l;
	if (l.rule == int(VolumeRule::affine)) {
		if (l.factor == 0) return;
		l.factor = mca::affineFactor(J, l.rest, determinantNow(r));
		if (l.factor > 0) return;
		unsettled.emplace_back(i, J > 0 ? J : r.m->volumeRatio);
		// sides of what has lost its volume hold all of its stress
		const Real held = deviatorEnergyAt(r);
		for (const Side& s : r.link)
			if (s.p) setStress(*s.p, s.side, wholeStress(*r.m, l, stressOf(*s.p, s.side), between(r, s)));
		clearDeviator(l);
		if (Omega::instance().getScene()->trackEnergy) law.fracture += held - deviatorEnergyAt(r);
		return;
	}
	mca::dispatch(VolumeRule(l.rule), [&](auto rule) {
		Real sum = 0;
		for (int k = 0; k < nLinks; k++)
			if (r.link[k].p) sum += mca::linkWeight(flagsOf(l), k) * mca::volumeTerm<rule.value>(r.link[k].p->d, distance2(r, r.link[k]));
		l.rest = mca::restKeeping<rule.value>(r.m->volumeRatio, sum + l.contactSum, l.invN);
	});
	if (flagsOf(l) & mca::linkBits) return;
	l.rest = 0;
	unsettled.emplace_back(i, r.m->volumeRatio);
}

/// Of its links and its deviator.
Real Loop::deviatorEnergyAt(const Row& r) const
{
	Real pairs = 0;
	for (int k = 0; k < nLinks; k++)
		if (const Side& s = r.link[k]; s.p)
			pairs += mca::linkWeight(flagsOf(*r.l), k) * mca::pairEnergy(stressOf(*s.p, s.side), r.m->volumeRatio, s.p->twoG);
	return deviatorEnergyOf(*r.m, *r.l, r.material->G, pairs);
}
Real Loop::coldEnergyAt(const Row& r, Real J) const { return mca::coldEnergy(*r.material, r.l->cell, J); }
/// Of the volume that contacts give it, if it has links: in the affine rule a volume of its own.
Real Loop::contactEnergyAt(const Row& r, Real Jc) const { return mca::coldEnergy(*r.material, mca::contactCell(r.d, r.l->cell, 1.), Jc); }

/// Stresses of all its pairs, kept as J times them.
void Loop::scaleStresses(const Row& r, Real ratio)
{
	const auto scale = [&](const Side& s) { setStress(*s.p, s.side, mca::scaled(stressOf(*s.p, s.side), ratio)); };
	for (const Side& s : r.link)
		if (s.p) scale(s);
	for (int c = r.firstContact; c < r.lastContact; c++)
		scale(contacts[size_t(c)]);
}

// See mca::Settling: what has lost its volume has it from its contacts from now on; what cannot go on is released, and booked.
void Loop::settleVolumes(bool account)
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
		if (account && settling.holds) law.fracture += affine ? contactEnergyAt(r, Jc) : 0.;
		if (account && !settling.holds && !heat) // else it is in the heat
			law.fracture += coldEnergyAt(r, J) + (affine ? contactEnergyAt(r, Jc) - coldEnergyAt(r, Jc) : 0.);
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

void Loop::filterVolumes(bool account)
{
	const auto exchanges = [](const Row& r) { return mca::exchangesVolume(r.m->plasticStrain, flagsOf(*r.l), r.l->factor); };
	const auto weight    = [](const Row& r, int k) { return mca::automata::exchangeWeight(flagsOf(*r.l), r.l->cell / mca::Lattice::cell(r.d), k); };
	for (Row& r : rows) {
		r.curvature = 0;
		if (!exchanges(r)) continue;
		for (int k = 0; k < nLinks; k++)
			if (r.link[k].p) r.curvature += weight(r, k) * (rows[size_t(r.link[k].other)].m->volumeRatio - r.m->volumeRatio);
	}
	vector<Real> change(rows.size(), 0.);
	for (size_t i = 0; i < rows.size(); i++) {
		const Row& r = rows[i];
		if (!exchanges(r)) continue;
		Real sum = 0;
		for (int k = 0; k < nLinks; k++) {
			if (!r.link[k].p) continue;
			const Row& o = rows[size_t(r.link[k].other)];
			if (exchanges(o) && o.material == r.material && o.d == r.d) sum += weight(r, k) * (r.curvature - o.curvature);
		}
		change[i] = sum * mca::volumeExchange(law.volumeFilter, r.material->eos.c0, law.filterTime, r.d);
	}
	for (size_t i = 0; i < rows.size(); i++) {
		if (change[i] == 0) continue;
		Row&       r = rows[i];
		const Real now = r.m->volumeRatio, J = now + change[i], ratio = J / now;
		if (account)
			law.coupling += (r.material->eos.heats() ? 0. : coldEnergyAt(r, now) - coldEnergyAt(r, J)) + deviatorEnergyAt(r) * (1. - ratio);
		r.m->volumeRatio = J;
		r.l->factor *= ratio;
		for (const Side& s : r.link)
			if (s.p) setStress(*s.p, s.side, mca::scaled(stressOf(*s.p, s.side), ratio));
	}
	law.filterTime = 0;
}
} // namespace MCA_SPACE
} // namespace yade
