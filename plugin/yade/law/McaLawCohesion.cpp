// SPDX-License-Identifier: GPL-2.0-or-later
// McaLaw: broken pairs that hold together until their fracture energy is spent (11f)-(11h), as in plugin/automata/cohesion.cpp.
#include "McaLawRows.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>

namespace yade {
namespace MCA_SPACE {

/// Throws Error where strengths are too much for a fracture energy, as the fast solver does.
void Loop::checkCohesion() const
{
	std::map<std::pair<int, Real>, const Row*> kinds;
	for (const Row& r : rows)
		if (r.material->fracture.energy > 0) kinds.emplace(std::make_pair(materialOf(r), r.d), &r);
	for (const auto& a : kinds)
		for (const auto& b : kinds)
			mca::checkCohesion(*a.second->material, *b.second->material, 0.5 * (a.second->d + b.second->d), ruleOf(*a.second, *b.second));
}

/// What a link does as it breaks, by the stresses of both ends; from its first end.
mca::Breaking Loop::breaking(const Row& r, int k) const
{
	const Side&  s    = r.link[k];
	const Row&   o    = rows[size_t(s.other)];
	const Vec    x    = between(r, s);
	const Real   d = s.p->d, weight = mca::linkWeight(flagsOf(*r.l), k), area = weight * mca::Lattice::area(d) / d;
	const auto   whole = [&](const Row& a, int side, Vec to) {
		return mca::scaled(wholeStress(*a.m, *a.l, stressOf(*s.p, side), to), 1. / a.m->volumeRatio);
	};
	const auto pressing = [](const Row& a) { return a.l->rule != int(mca::VolumeRule::affine) || a.l->factor > 0 ? a.m->pressure : 0.; };
	const auto lost     = [&](const Row& a, int side, Vec to) {
		const Stress held = stressOf(*s.p, side);
		const auto   e    = [&](Stress of) { return mca::pairEnergy(of, a.m->volumeRatio, s.p->twoG); };
		return mca::lostToBond(a.d, weight, e(held), e(mca::pushOnly(held, to)));
	};
	return mca::breakingPair(
		mca::ofBothSides(0.5 * area, whole(r, s.side, x), whole(o, 1 - s.side, -x)), x, 0.5 * area * (pressing(r) + pressing(o)), area, d,
		*r.material, *o.material, lost(r, s.side, x) + lost(o, 1 - s.side, -x));
}

/// A pair whose link breaks may hold together; returns whether it does. mayHold: no script has cut it.
bool Loop::bond(const Row& first, int k, bool mayHold)
{
	const Side&         s    = first.link[k];
	const mca::Breaking b    = breaking(first, k);
	const mca::Bond     bond = mayHold && mayHoldOn(first, k) ? mca::startBond(b) : mca::Bond {};
	const bool          holdsOn = bond.first > 0, affine = first.l->rule == int(mca::VolumeRule::affine);
	if (holdsOn) {
		setBond(*s.p, bond), setOpening(*s.p, mca::scaled(b.pull, 1. / bond.stiffness));
		bonds.push_back({ int(&first - rows.data()), s, true });
	}
	if (Omega::instance().getScene()->trackEnergy)
		law.fracture += mca::workAtBreak(b, between(first, s), moved(first, s).distance, affine, holdsOn) + (holdsOn ? b.lost - heldAtStart(bond) : 0.);
	return holdsOn;
}

/// What they pull in this step; those that have parted hold nothing from then on.
void Loop::pullTogether(bool account)
{
	for (const Bonded& q : bonds) {
		McaPhys&        p    = *q.side.p;
		const Row &     a = rows[size_t(q.row)], &o = rows[size_t(q.side.other)];
		const Vec       r = between(a, q.side);
		mca::Bond       bond = bondOf(p);
		const Real      before = spent(bond);
		const Moved     did  = q.isNew ? Moved {} : moved(a, q.side); // those that broke in this step start where they are
		const Stress    w = mca::opened(openingOf(p), bond.rest, r, did.distance, did.spin);
		const mca::Pull pull = mca::pullOf(bond, w, r, mca::arm(a.d, o.d));
		setOpening(p, w), setBond(p, bond);
		p.pull = vector3(pull.force), p.pullTorque = turn3(pull.torque), p.pullTorqueOther = turn3(pull.other);
		if (account) law.fracture += spent(bond) - before;
		if (bond.most >= bond.last) setBond(p, {}), p.pull = p.pullTorque = p.pullTorqueOther = Vector3r::Zero();
	}
}
} // namespace MCA_SPACE
} // namespace yade
