// SPDX-License-Identifier: GPL-2.0-or-later
// McaDensity: breaking of links, at the steps and in the order of plugin/automata/fracture.cpp.
#include "McaDensity.hpp"
#include <automata/volume_filter.hpp>

namespace yade {
using mca::sqr;
using mca::VolumeRule;
using mca::automata::exposedBit;
using mca::automata::halfShift;
using mca::automata::nLinks;

bool McaDensity::breaks(const Row& r, int k) const
{
	const Side&          s = r.link[k];
	const Row&           o = rows[size_t(s.other)];
	const mca::Fracture& f = r.material->fracture;
	if (!f.active()) return false;
	if (0.5 * (r.l->criterion + o.l->criterion) >= 1.) return true;
	// sheared so far that the packing is gone: what follows is contact
	if (distance(r, s) < mca::automata::collapsed * s.p->d) return true;
	if (!std::isfinite(f.pairStress)) return false;
	const Real tension = 0.5 * (s.p->s[s.side] / r.m->volumeRatio + s.p->s[1 - s.side] / o.m->volumeRatio - r.m->pressure - o.m->pressure);
	return tension >= 0.5 * f.pairStress * (r.m->strength + o.m->strength);
}

void McaDensity::breakLinks()
{
	vector<std::pair<int, int>> pairs; // (row, link)
	vector<int>                 touched;
	for (size_t i = 0; i < rows.size(); i++)
		for (int k = 0; k < nLinks; k++)
			if (rows[i].link[k].p && breaks(rows[i], k)) pairs.emplace_back(int(i), k), touched.push_back(int(i)), touched.push_back(rows[i].link[k].other);
	std::sort(touched.begin(), touched.end());
	touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
	// the volume at the present positions, as all links measure it: the work of the last move must not be lost
	vector<Real> J;
	for (int i : touched) {
		const Row& r = rows[size_t(i)];
		J.push_back(r.l->rule == int(VolumeRule::affine) && r.l->offset > 0 ? r.l->offset * linkDeterminant(r) : r.m->volumeRatio);
	}
	for (const auto& [i, k] : pairs) {
		Row& r = rows[size_t(i)];
		if (!r.link[k].p) continue; // seen from the other side before
		const Side s = r.link[k];
		Row&       o = rows[size_t(s.other)];
		const int  back = (k + 3) % nLinks;
		r.l->flags = (r.l->flags & ~(1 << k)) | exposedBit, o.l->flags = (o.l->flags & ~(1 << back)) | exposedBit;
		s.p->linked = false;
		s.p->startContact(distance(r, s)); // stresses go on
		r.link[k] = o.link[back] = Side();
		brokenLinks++;
		r.m->brokenLinks++, o.m->brokenLinks++;
	}
	for (size_t q = 0; q < touched.size(); q++)
		keepVolume(touched[q], J[q]);
}

Real McaDensity::linkDeterminant(const Row& r) const
{
	Real Fxx = 0, Fxy = 0, Fyx = 0, Fyy = 0;
	for (int k = 0; k < nLinks; k++) {
		if (!r.link[k].p) continue;
		const Vector3r x = rows[size_t(r.link[k].other)].state->se3.position - r.state->se3.position;
		Fxx += mca::linkX[k] * x[0], Fyx += mca::linkX[k] * x[1], Fxy += mca::linkY[k] * x[0], Fyy += mca::linkY[k] * x[1];
	}
	return (Fxx * Fyy - Fxy * Fyx) / (9. * sqr(r.d));
}

// A break changes no volume: what the links had measured goes on as the rest state of what is left.
void McaDensity::keepVolume(int i, Real J)
{
	Row&         r = rows[size_t(i)];
	McaLawState& l = *r.l;
	if (l.rule == int(VolumeRule::affine)) {
		if (l.offset == 0) return;
		const Real det = linkDeterminant(r);
		l.offset       = det > mca::automata::minVolume && J > 0 ? J / det : 0.;
		if (l.offset == 0) unsettled.emplace_back(i, J > 0 ? J : r.m->volumeRatio);
		return;
	}
	const bool inverse = l.rule == int(VolumeRule::inversePower);
	Real       sum     = 0;
	for (int k = 0; k < nLinks; k++) {
		if (!r.link[k].p) continue;
		const Real d = r.link[k].p->d, r2 = sqr(distance(r, r.link[k])), w = (l.flags >> (halfShift + k)) & 1 ? 0.5 : 1.;
		sum += w * (inverse ? mca::volumeTerm<VolumeRule::inversePower, 2>(d, r2) : mca::volumeTerm<VolumeRule::meanDistance, 2>(d, r2));
	}
	l.rest = sum + l.contactSum - (inverse ? 1. / J - 1. : std::sqrt(J) - 1.) / l.invN;
	if (l.flags & mca::automata::linkBits) return;
	l.rest = 0;
	unsettled.emplace_back(i, r.m->volumeRatio);
}

Real McaDensity::stateEnergy(const Row& r, Real J) const { return r.l->cell * mca::storedEnergy(r.material->eos, J - 1.); }

// An automaton that has lost its volume has it from its contacts alone. Under pressure their rest distances are set so that the pressure goes on;
// tension is released, and booked. With the affine rule contacts have had a volume of their own: the more compressed of the two goes on.
void McaDensity::settleVolumes(bool account)
{
	for (const auto& entry : unsettled) {
		Row&       r    = rows[size_t(entry.first)];
		const Real J    = entry.second;
		const bool mean = r.l->rule == int(VolumeRule::meanDistance), affine = r.l->rule == int(VolumeRule::affine);
		// only neighbours about as near as in the packing can take over: a far one would push across a gap
		const auto near = [&](const Side& s) { return distance(r, s) < 1.1 * s.p->d; };
		int        n    = 0;
		Real       sum  = 0;
		for (int c = r.firstContact; c < r.lastContact; c++) {
			const Side& s  = contacts[size_t(c)];
			const Real  r2 = sqr(distance(r, s));
			n += near(s);
			if (affine && s.p->pushes(s.side, r2)) sum += mca::volumeTerm<VolumeRule::inversePower, 2>(s.p->rest[s.side], r2);
		}
		const Real Jc = 1. / (1. + sum / nLinks), now = r.m->volumeRatio;
		const bool holds = n >= 3 && J < Jc;
		const Real need  = mean ? (std::sqrt(J) - 1.) / (n * r.l->invN) : (1. / J - 1.) / (n * r.l->invN);
		for (int c = r.firstContact; (holds || !affine) && c < r.lastContact; c++) {
			const Side& s  = contacts[size_t(c)];
			const Real  r0 = distance(r, s);
			if (!holds || !near(s)) s.p->rest[s.side] = std::min(r0, s.p->d);
			else s.p->rest[s.side] = mean ? r0 / (1. + need) : r0 * std::sqrt(1. + need);
		}
		if (account && holds) fracture += affine ? stateEnergy(r, Jc) : 0.;
		if (account && !holds && !r.material->eos.heats()) fracture += stateEnergy(r, J); // else it is in the heat
		if (holds) continue;
		if (affine && r.material->eos.heats()) { // what the contacts' own volume (5) had stored is from now on part of the internal energy
			r.m->dissipated += stateEnergy(r, Jc) / (r.l->cell * r.material->eos.rho0);
			r.m->pressure = mca::pressure(r.material->eos, Jc - 1.);
		}
		for (const Side& s : r.link) // stresses go on
			if (s.p) s.p->s[s.side] *= Jc / now, s.p->tau[s.side] *= Jc / now;
		for (int c = r.firstContact; c < r.lastContact; c++) {
			const Side& s = contacts[size_t(c)];
			s.p->s[s.side] *= Jc / now, s.p->tau[s.side] *= Jc / now;
		}
		r.m->volumeRatio = Jc;
	}
	unsettled.clear();
}

// The same exchange as in plugin/automata/volume_filter.cpp.
void McaDensity::filterVolumes(bool account)
{
	const auto exchanges = [](const Row& r) { return mca::automata::exchangesVolume(r.m->plasticStrain, r.l->flags, r.l->offset); };
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
		change[i] = mca::automata::volumeExchange(volumeFilter, r.material->eos.c0, filterTime, r.d) * sum;
	}
	for (size_t i = 0; i < rows.size(); i++) {
		if (change[i] == 0) continue;
		Row&       r = rows[i];
		const Real J = r.m->volumeRatio + change[i], ratio = J / r.m->volumeRatio, G = r.material->G;
		if (account) {
			Real pairs = 0;
			for (const Side& s : r.link)
				if (s.p->twoG > 0) pairs += (sqr(s.p->s[s.side]) + sqr(s.p->tau[s.side])) / (s.p->twoG * r.m->volumeRatio);
			const Real held = G > 0 ? mca::Lattice<2>::cell(r.d) / nLinks * (pairs + r.m->volumeRatio * sqr(r.m->stressZZ) / (4. * G * r.l->invN)) : 0.;
			coupling += (r.material->eos.heats() ? 0. : stateEnergy(r, r.m->volumeRatio) - stateEnergy(r, J)) + held * (1. - ratio);
		}
		r.m->volumeRatio = J;
		r.l->offset *= ratio;
		for (const Side& s : r.link)
			s.p->s[s.side] *= ratio, s.p->tau[s.side] *= ratio;
	}
	filterTime = 0;
}
} // namespace yade
