// SPDX-License-Identifier: GPL-2.0-or-later
// McaLaw: volume, pressure, pair stresses and yield of one automaton, from its neighbours: loops over its pairs that call the kernels.
#include "McaLawRows.hpp"
#include <kernels/automaton/limit.hpp>

namespace yade {
namespace MCA_SPACE {
using mca::nLinks;
using mca::VolumeRule;

namespace {
	Real square(Vec r) { return mca::dot(r, r); }
	template <class F> auto byRule(int rule, F&& f) { return mca::dispatch(VolumeRule(rule), f); }
} // namespace

void Loop::contactVolume(Row& r)
{
	Real sum         = 0;
	r.nearestContact = 1;
	for (int c = r.firstContact; c < r.lastContact; c++) {
		const Side& s  = contacts[size_t(c)];
		McaPhys&    p  = *s.p;
		const Real  r2 = square(between(r, s)), rest = p.rest[s.side];
		if (p.pushes(s.side, r2)) {
			sum += byRule(r.l->rule, [&](auto rule) { return mca::volumeTerm<mca::ofContacts(rule.value)>(rest, r2); });
			r.nearestContact = std::min(r.nearestContact, r2 / (rest * rest));
		}
		p.rest[s.side] = mca::restAfter(rest, r2, mca::meetsAt(p.d, r.l->factor));
	}
	r.l->contactSum = sum;
}

void Loop::volume(Row& r, bool withContacts)
{
	mca::dispatch(r.material->eos.kind, [&](auto kind) { volumeBy<kind.value>(r, withContacts); });
}

template <mca::EosKind kind> void Loop::volumeBy(Row& r, bool withContacts)
{
	McaLawState&                    l = *r.l;
	const mca::VolumeConstants<kind> c(*r.material, r.d);
	const Real                 Jo = r.m->volumeRatio, contactSum = withContacts ? l.contactSum : 0.;
	const mca::PressureState        before { l.P, r.m->dissipated };
	const bool                      outline = mca::trianglesIn(flagsOf(l)) != 0;
	LinkSums                        sums;
	Real                            nearest2 = 1e300, J = 1;
	for (int k = 0; k < nLinks; k++) {
		const Vec x = r.link[k].p ? between(r, r.link[k]) : Vec {};
		nearest2    = std::min(nearest2, r.link[k].p ? square(x) : c.d2);
		sums.add(flagsOf(l), k, x);
	}
	sums.complete(l);
	const auto         step = [&](bool ofLinks) { return mca::pressureStep(c, J, Jo, before, ofLinks); };
	mca::PressureState now  = before;
	byRule(l.rule, [&](auto rule) {
		if constexpr (rule.value == VolumeRule::affine) {
			J   = mca::affineRatio(c, sums.F, l.factor, l.rest, contactSum);
			now = step(l.factor > 0);
			l.push = matrixOf(mca::affinePush(c, sums.F, l.factor));
			const Real slope = mca::volumeSlope(c, sums.F, sums.directions, l.factor);
			r.stiff          = stiffnessOf(c, J, sums, l.factor, slope, nearest2, outline);
			if (law.lastMove > 0) {
				const mca::BulkViscosity viscosity(*r.material, r.d, 1. / law.lastMove);
				l.viscous = l.factor > 0 ? viscosity.pressure(mca::dilation(J, Jo), slope, mca::tangent<kind>(c.eos, J - 1.)) : 0.;
			}
			if (!withContacts) return;
			const Real Jc = mca::contactRatio(contactSum), cell = mca::contactCell(r.d, l.cell, l.factor); // contacts have a volume of their own
			l.pressureShare = mca::pressureShare<mca::ofContacts(rule.value)>(mca::pressure<kind>(c.eos, Jc - 1.), Jc, cell * (1. / nLinks));
			r.stiff         = std::max(r.stiff, mca::stiffness(c, Jc) * (cell / l.cell));
		} else {
			Real sum = 0;
			for (int k = 0; k < nLinks; k++)
				if (r.link[k].p)
					sum += mca::linkWeight(flagsOf(l), k) * mca::volumeTerm<rule.value>(r.link[k].p->d, square(between(r, r.link[k])));
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
	r.turning     = outline && l.rule == int(VolumeRule::affine) ? mca::turningAtOutlines * J : J;
	r.nearestLink = nearest2 / c.d2;
	r.closing     = law.lastMove > 0 ? std::max(-l.dTheta, Real(0)) * r.d / law.lastMove : 0.;
}

/// What the other end of a pair has done against this one in the last move.
Loop::Moved Loop::moved(const Row& r, const Side& s) const
{
	const Row& o  = rows[size_t(s.other)];
	const Real on = isFresh(r, s) ? 0. : law.lastMove;
	const auto spin = [&](const Row& other, Real arm) { return mca::pairSpin(turnOf(r.spin), turnOf(other.spin), arm, on); };
	return { (vec(o.velocity) - vec(r.velocity)) * on, spin(o, mca::arm(r.d, o.d)), spin(r, 0.5) };
}
/// (7)-(8): of this side of a pair, before yield.
Trial Loop::trial(const Row& r, const Side& s, Stress old, const Apart& apart) const
{
	const Moved m = moved(r, s);
	return trialOf(old, between(r, s), m.distance, m.spin, mca::dim == 3 && isFresh(r, s) ? Apart {} : apart, s.p->twoG);
}

/// Before yield.
Deviator Loop::deviatorOf(const Row& r) const
{
	Deviator deviator;
	for (int k = 0; mca::dim == 3 && k < nLinks; k++)
		if (const Side& s = r.link[k]; s.p && !isFresh(r, s)) {
			const Moved did = moved(r, s);
			deviator.link(k, between(r, s), did.distance, did.spin, did.own, mca::linkWeight(flagsOf(*r.l), k));
		}
	deviator.advance(*r.m, *r.l, r.material->G, r.l->dTheta);
	return deviator;
}

// Trial stresses (7)-(9) of this side of all pairs, radial return (10)-(11), friction, fracture criteria.
void Loop::stress(Row& r)
{
	McaLawState&         l = *r.l;
	McaState&            m = *r.m;
	const mca::Material& material = *r.material;
	const Real           J = m.volumeRatio, dt = law.lastMove, threeG = 3. * material.G, perOldJ = mca::perOldRatio(l.dTheta, J);
	const bool           affine = l.rule == int(VolumeRule::affine);
	mca::PairSums<Real>  sums;
	const auto dilationOf = [&](const Side& s, mca::DilationShares share) { return mca::pairDilation(l.dTheta, rows[size_t(s.other)].l->dTheta, share); };
	const auto           old = [&](const Side& s) { return mca::scaled(stressOf(*s.p, s.side), perOldJ); };
	const Deviator       deviator = deviatorOf(r);
	for (int k = 0; k < nLinks; k++) {
		const Side& s = r.link[k];
		if (!s.p) continue;
		const Real weight = mca::linkWeight(flagsOf(l), k);
		const auto now = trial(r, s, old(s), deviator.apart(dilationOf(s, affine ? mca::ofOwn : mca::ofBoth)));
		setStress(*s.p, s.side, now.trial);
		add(sums, now, weight, weight);
	}
	for (const Side& s : r.lost) { // what they held goes on in their contacts
		Trial gone = trial(r, s, old(s), deviator.apart(dilationOf(s, mca::ofOwn)));
		gone.trial = {};
		add(sums, gone, 1., 0.);
	}
	vector<Stress> held; // stresses of the contacts before the step
	Real ofContacts = 0, bothOfContacts = 0;
	for (int c = r.firstContact; c < r.lastContact; c++) {
		const Side& s     = contacts[size_t(c)];
		const auto  now   = trial(r, s, old(s), apartOf(dilationOf(s, mca::ofBoth)));
		const bool  touch = s.p->touching(square(between(r, s)));
		held.push_back(touch ? now.before : untouched(now));
		setStress(*s.p, s.side, touch ? now.trial : Stress {});
		if (touch) ofContacts += mca::square(now.trial), bothOfContacts += mca::product(now.before, now.trial);
	}
	sums.square += ofContacts, sums.both += bothOfContacts, deviator.addTo(sums, l.invN);

	const Real     sigma = deviator.equivalent(sums.square * l.invN);
	mca::Return back { 1., 0. };
	const mca::Yield& y = material.yield;
	mca::dispatch(y.kind, [&](auto k) { back = mca::radialReturn<k.value>(y, sigma, m.plasticStrain, m.temperature, threeG, dt); });
	deviator.scale(m, l, back.scale);
	m.plasticStrain += back.dEqps;
	if (y.heats()) m.temperature = mca::warmed(y, m.temperature, sigma, back);
	r.heated = 0;
	if (material.eos.heats()) {
		const Real q = mca::plasticHeat(J, sigma, back, 1. / material.eos.rho0);
		m.dissipated += q;
		r.heated = q * l.cell * material.eos.rho0;
	}
	const auto work = deviator.work(m, sums, sigma, back, l.dTheta, threeG, mca::Lattice::cell(r.d) / nLinks, l.invN, affine && l.factor > 0);
	r.plastic = work.plastic, r.coupling = work.coupling, r.friction = 0;

	const Real scale = back.scale * J;
	for (const Side& s : r.link)
		if (s.p) setStress(*s.p, s.side, mca::scaled(stressOf(*s.p, s.side), scale));
	for (int c = r.firstContact; c < r.lastContact; c++)
		contactFriction(r, contacts[size_t(c)], held[size_t(c - r.firstContact)], scale);
	finishPressure(r);
	m.equivalentStress = deviator.equivalentAfter(m, back.scale, sums.square * l.invN);
	if (material.fracture.active()) fractureCriterion(r, back.dEqps, dt);
}

/// (11b), (11e)
void Loop::fractureCriterion(Row& r, Real dEqps, Real dt) const
{
	McaState&            m = *r.m;
	const mca::Fracture& f = r.material->fracture;
	r.l->criterion = mca::criterion(mca::Criteria(f), m.plasticStrain, m.pressure, m.equivalentStress, m.strength);
	if (!f.damage.active()) return;
	m.damage += mca::damageGrowth(f.damage, r.material->yield, dEqps, m.pressure, m.equivalentStress, m.temperature, dt);
	r.l->criterion = mca::criterion(r.l->criterion, m.damage, m.strength);
}

/// (5f), (S6), and the push of the affine rule with it and with the viscous pressure.
void Loop::finishPressure(Row& r) const
{
	McaLawState& l = *r.l;
	SideSums     sides;
	for (int k = 0; k < nLinks; k++)
		if (const Side& s = r.link[k]; s.p) sides.add(mca::linkWeight(flagsOf(l), k), stressOf(*s.p, s.side), between(r, s));
	const bool affine = l.rule == int(VolumeRule::affine) && l.factor > 0;
	const Real bulk = r.material->eos.bulkModulus(), acting = affine ? sides.meanPressure(*r.m, l, bulk) : l.P;
	r.m->pressure     = shownPressureOf(l, acting);
	sides.finishPush(*r.m, l, acting, bulk);
}

// No tension, Coulomb friction; what this side dissipates.
void Loop::contactFriction(Row& r, const Side& s, Stress before, Real scale)
{
	McaPhys&    p     = *s.p;
	const Row&  o     = rows[size_t(s.other)];
	const Vec   x     = between(r, s);
	const Real  r2    = square(x);
	const auto  press = [&](const McaLawState& l, int side) {
                return p.pushes(side, r2)
			 ? l.pressureShare * byRule(l.rule, [&](auto rule) { return mca::pressureShape<mca::ofContacts(rule.value)>(p.rest[side], 1. / r2); })
			 : 0.;
	};
	const auto  side  = contactSideOf(
		before, stressOf(p, s.side), x, press(*r.l, s.side) + press(*o.l, 1 - s.side), r2, p.d, p.friction, r.m->volumeRatio, scale, p.touching(r2));
	const auto             after = mca::afterFriction(side);
	const auto             over  = [](Real a) { return a > 0 ? 1. / a : 0.; };
	const auto             work  = mca::contactWork(side, after, over(p.twoG), over(r.material->G), r.l->dTheta, o.l->dTheta);
	setStress(p, s.side, after);
	r.friction += work.friction, r.coupling += work.coupling, r.plastic += work.plastic;
}
} // namespace MCA_SPACE
} // namespace yade
