// SPDX-License-Identifier: GPL-2.0-or-later
// McaLaw: volume, pressure, pair stresses and yield of one automaton, from its neighbours: loops over its pairs that call the kernels.
#include "McaLaw.hpp"
#include "McaVec.hpp"
#include <kernels/automaton/force.hpp>
#include <kernels/automaton/limit.hpp>
#include <kernels/automaton/outline.hpp>

namespace yade {
using mca::nLinks;
using mca::Pair;
using mca::Vec;
using mca::VolumeRule;

namespace {
	Vec<Real>               vectorTo(const State& a, const State& b) { return vec(b.se3.position) - vec(a.se3.position); }
	Real      square(Vec<Real> r) { return mca::dot(r, r); }
	template <class F> auto byRule(int rule, F&& f) { return mca::dispatch(VolumeRule(rule), f); }
} // namespace

void McaLaw::contactVolume(Row& r)
{
	Real sum         = 0;
	r.nearestContact = 1;
	for (int c = r.firstContact; c < r.lastContact; c++) {
		const Side& s  = contacts[size_t(c)];
		McaPhys&    p  = *s.p;
		const Real  r2 = square(vectorTo(*r.state, *rows[size_t(s.other)].state)), rest = p.rest[s.side];
		if (p.pushes(s.side, r2)) {
			sum += byRule(r.l->rule, [&](auto rule) { return mca::volumeTerm<mca::ofContacts(rule.value)>(rest, r2); });
			r.nearestContact = std::min(r.nearestContact, r2 / (rest * rest));
		}
		p.rest[s.side] = mca::restAfter(rest, r2, p.d);
	}
	r.l->contactSum = sum;
}

void McaLaw::volume(Row& r, bool withContacts)
{
	mca::dispatch(r.material->eos.kind, [&](auto law) { volumeBy<law.value>(r, withContacts); });
}

template <mca::EosKind law> void McaLaw::volumeBy(Row& r, bool withContacts)
{
	McaLawState&                    l = *r.l;
	const mca::VolumeConstants<law> c(*r.material, r.d);
	const Real                 Jo = r.m->volumeRatio, contactSum = withContacts ? l.contactSum : 0.;
	const mca::PressureState        before { l.P, r.m->dissipated };
	mca::Tensor<Real>          F = {};
	mca::Symmetric<Real>       directions = {};
	const mca::Triangles       triangles  = mca::trianglesIn(l.flags);
	Real                       nearest2 = 1e300, J = 1;
	for (int k = 0; k < nLinks; k++) {
		const Vec<Real> x = r.link[k].p ? vectorTo(*r.state, *rows[size_t(r.link[k].other)].state) : Vec<Real> {};
		nearest2          = std::min(nearest2, r.link[k].p ? square(x) : c.d2);
		if (triangles) addSquare(directions, mca::outlineTable.of(triangles, k));
		else addDirection(directions, k, r.link[k].p ? 1. : 0.);
		addDyad(F, mca::outlineTable.of(triangles, k), x);
	}
	const auto         step = [&](bool ofLinks) { return mca::pressureStep(c, J, Jo, before, ofLinks); };
	mca::PressureState now  = before;
	byRule(l.rule, [&](auto rule) {
		if constexpr (rule.value == VolumeRule::affine) {
			J   = mca::affineRatio(c, F, l.factor, l.rest, contactSum);
			now = step(l.factor > 0);
			const auto push = mca::affinePush(c, F, l.factor);
			l.txx = push.xx, l.txy = push.xy, l.tyx = push.yx, l.tyy = push.yy;
			const Real slope = mca::volumeSlope(c, F, directions, l.factor);
			r.stiff          = mca::affineStiffness(c, J, slope, nearest2, triangles);
			if (lastMove > 0) {
				const mca::BulkViscosity viscosity(*r.material, r.d, 1. / lastMove);
				l.viscous = l.factor > 0 ? viscosity.pressure(mca::dilation(J, Jo), slope, mca::tangent<law>(c.eos, J - 1.)) : 0.;
			}
			if (!withContacts) return;
			const Real Jc = mca::contactRatio(contactSum), cell = mca::contactCell(r.d, l.cell, l.factor); // contacts have a volume of their own
			l.pressureShare = mca::pressureShare<mca::ofContacts(rule.value)>(mca::pressure<law>(c.eos, Jc - 1.), Jc, cell * (1. / nLinks));
			r.stiff         = std::max(r.stiff, mca::stiffness(c, Jc) * (cell / l.cell));
		} else {
			Real sum = 0;
			for (int k = 0; k < nLinks; k++)
				if (r.link[k].p)
					sum += mca::linkWeight(l.flags, k)
						* mca::volumeTerm<rule.value>(r.link[k].p->d, square(vectorTo(*r.state, *rows[size_t(r.link[k].other)].state)));
			J       = mca::volumeRatio<rule.value>((sum + contactSum - l.rest) * l.invN);
			now     = step(true);
			l.pressureShare = mca::pressureShare<rule.value>(now.P, J, l.cell * l.invN);
			r.stiff = mca::stiffness(c, J);
		}
	});
	l.dTheta         = mca::dilation(J, Jo);
	r.m->volumeRatio = J, l.P = now.P, r.m->dissipated = now.e;
	r.clampedNow  = mca::clamped(c.eos, J - 1.);
	r.bad         = !mca::validVolume(J);
	r.turning     = mca::trianglesIn(l.flags) && l.rule == int(VolumeRule::affine) ? mca::turningAtOutlines * J : J;
	r.nearestLink = nearest2 / c.d2;
	r.closing     = lastMove > 0 ? std::max(-l.dTheta, Real(0)) * r.d / lastMove : 0.;
}

/// (7)-(8): stresses of this side of a pair before yield; dilation: pairDilation().
Pair<Real> McaLaw::trial(const Row& r, const Side& s, Pair<Real> before, Real dilation) const
{
	const Row&      o = rows[size_t(s.other)];
	const Real      q = mca::arm(r.d, o.d), on = r.fresh || o.fresh ? 0. : lastMove, spin = mca::pairSpin(r.motion[2], o.motion[2], q, on);
	const Vec<Real> moved  = (vec(o.motion) - vec(r.motion)) * on;
	const auto      strain = mca::strainIncrement(vectorTo(*r.state, *o.state), moved, spin);
	const auto      now    = mca::trialStress(before, strain, dilation, s.p->twoG);
	s.p->s[s.side] = now.normal, s.p->tau[s.side] = now.shear;
	return now;
}

// Trial stresses (7)-(9) of this side of all pairs, radial return (10)-(11), friction, fracture criteria.
void McaLaw::stress(Row& r)
{
	McaLawState&         l = *r.l;
	McaState&            m = *r.m;
	const mca::Material& material = *r.material;
	const Real           J = m.volumeRatio, dt = lastMove, threeG = 3. * material.G, perOldJ = mca::perOldRatio(l.dTheta, J);
	const bool           affine = l.rule == int(VolumeRule::affine);
	mca::PairSums<Real>  sums;
	const auto dilationOf = [&](const Side& s, mca::DilationShares share) { return mca::pairDilation(l.dTheta, rows[size_t(s.other)].l->dTheta, share); };
	const auto           old   = [&](const Side& s) { return Pair<Real> { s.p->s[s.side] * perOldJ, s.p->tau[s.side] * perOldJ }; };
	for (int k = 0; k < nLinks; k++) {
		const Side& s = r.link[k];
		if (!s.p) continue;
		const Real weight = mca::linkWeight(l.flags, k);
		const auto before = old(s);
		const Real dilation = dilationOf(s, affine ? mca::ofOwn : mca::ofBoth);
		mca::add<true>(sums, before, trial(r, s, before, dilation), dilation, weight, weight);
	}
	sums.dilationLost = r.lost * l.dTheta * mca::ofOwn.own;
	vector<Pair<Real>> held; // stresses of the contacts before the step
	Real               ofContacts = 0, bothOfContacts = 0;
	for (int c = r.firstContact; c < r.lastContact; c++) {
		const Side& s = contacts[size_t(c)];
		held.push_back(old(s));
		if (!s.p->touching(square(vectorTo(*r.state, *rows[size_t(s.other)].state)))) {
			s.p->s[s.side] = s.p->tau[s.side] = 0;
			continue;
		}
		const auto now = trial(r, s, held.back(), dilationOf(s, mca::ofBoth));
		ofContacts += mca::square(now), bothOfContacts += mca::product(held.back(), now);
	}
	sums.square += ofContacts, sums.both += bothOfContacts;

	const Real before = m.stressZZ, szzTrial = mca::trialSzz(2. * material.G, l.dTheta, before),
		   sigma = mca::equivalentStress(sums.square * l.invN, szzTrial);
	mca::Return back { 1., 0. };
	mca::dispatch(material.yield.kind, [&](auto kind) {
		back = mca::radialReturn<kind.value>(material.yield, sigma, m.plasticStrain, m.temperature, threeG, dt);
	});
	m.stressZZ = szzTrial * back.scale;
	m.plasticStrain += back.dEqps;
	if (material.yield.heats()) m.temperature = mca::warmed(material.yield, m.temperature, sigma, back);
	r.heated = 0;
	if (material.eos.heats()) {
		const Real q = mca::plasticHeat(J, sigma, back, 1. / material.eos.rho0);
		m.dissipated += q;
		r.heated = q * l.cell * material.eos.rho0;
	}
	const auto work = mca::pairWork(
		sums, sigma, back, J, l.dTheta, before, szzTrial, m.stressZZ, threeG, mca::Lattice::cell(r.d) / nLinks, l.invN, affine && l.factor > 0);
	r.plastic = work.plastic, r.coupling = work.coupling, r.friction = 0;

	const Real scale = back.scale * J;
	for (const Side& s : r.link)
		if (s.p) s.p->s[s.side] *= scale, s.p->tau[s.side] *= scale;
	for (int c = r.firstContact; c < r.lastContact; c++)
		contactFriction(r, contacts[size_t(c)], held[size_t(c - r.firstContact)], scale);
	finishPressure(r);
	m.equivalentStress = mca::equivalentStressAfter(back.scale, sums.square * l.invN, m.stressZZ);
	if (material.fracture.active())
		l.criterion = mca::criterion(mca::Criteria(material.fracture), m.plasticStrain, m.pressure, m.equivalentStress, m.strength);
}

/// (5f), and the push of the affine rule with it and with the viscous pressure.
void McaLaw::finishPressure(Row& r) const
{
	McaLawState& l       = *r.l;
	Real         normals = 0;
	for (int k = 0; k < nLinks; k++)
		if (const Side& s = r.link[k]; s.p) normals += mca::linkWeight(l.flags, k) * s.p->s[s.side];
	const bool affine = l.rule == int(VolumeRule::affine) && l.factor > 0;
	const auto mean   = [&](Real bulk) {
		return mca::meanPressure(l.P, normals, r.m->volumeRatio, r.m->stressZZ, l.invN, mca::Lattice::cell(r.d), l.cell, bulk);
	};
	const Real acting = affine ? mean(r.material->eos.bulkModulus()) : l.P, sum = acting + l.viscous, all = sum * l.cell;
	r.m->pressure     = mca::shownPressure(l.P, acting, l.flags);
	l.viscousShare = sum != 0 ? l.viscous / sum : 0.;
	l.txx *= all, l.txy *= all, l.tyx *= all, l.tyy *= all;
}

// No tension, Coulomb friction; what this side dissipates.
void McaLaw::contactFriction(Row& r, const Side& s, Pair<Real> before, Real scale)
{
	McaPhys&    p     = *s.p;
	const Row&  o     = rows[size_t(s.other)];
	const Real  r2    = square(vectorTo(*r.state, *o.state));
	const auto  press = [&](const McaLawState& l, int side) {
                return p.pushes(side, r2)
			 ? l.pressureShare * byRule(l.rule, [&](auto rule) { return mca::pressureShape<mca::ofContacts(rule.value)>(p.rest[side], 1. / r2); })
			 : 0.;
	};
	const mca::ContactSide side {
		before,        { p.s[s.side], p.tau[s.side] }, press(*r.l, s.side) + press(*o.l, 1 - s.side), r2, p.d, p.friction, r.m->volumeRatio, scale,
		p.touching(r2)
	};
	const auto             after = mca::afterFriction(side);
	const auto             over  = [](Real a) { return a > 0 ? 1. / a : 0.; };
	const auto             work  = mca::contactWork(side, after, over(p.twoG), over(r.material->G), r.l->dTheta, o.l->dTheta);
	p.s[s.side] = after.normal, p.tau[s.side] = after.shear;
	r.friction += work.friction, r.coupling += work.coupling, r.plastic += work.plastic;
}
} // namespace yade
