// SPDX-License-Identifier: GPL-2.0-or-later
// Force of a pair of automata from the pressures and stresses that the law has found. Compiled for the plane and for space.
#include "McaPhysSides.hpp"
#include <kernels/automaton/links.hpp>

namespace yade {
using mca::VolumeRule;

namespace MCA_SPACE {
namespace {
	class PairLaw : public McaPairLaw {
	public:
		void force(McaPhys& p, const State& sa, const McaLawState& a, const State& sb, const McaLawState& b) const override;
		bool mayTouch(const Body& a, const McaLawState& la, const Body& b, const McaLawState& lb) const override
		{
			const auto A = mca::Flags(la.flags), B = mca::Flags(lb.flags);
			const auto of = [](const McaLawState& l) { return [&l](int k) { return l.partner[size_t(k)]; }; };
			const bool sameBody = (la.acrossMasks && lb.acrossMasks) || a.groupMask == b.groupMask;
			return mca::mayTouch(A, B, sameBody) && !mca::heldByNeighbour(a.id, A, la.factor, of(la), b.id, B, lb.factor, of(lb));
		}
		Real width(Real diameter) const override { return mca::Lattice::width(diameter); }
		int  links() const override { return mca::nLinks; }
		bool fits(const McaLawState& l) const override;
	};

	/// Repulsion of the pressures over the vector to the other automaton: of a contact, or of a link by the rules that add up distances.
	template <VolumeRule rule> Real pressing(const McaPhys& p, const McaLawState& a, const McaLawState& b, Real r2, Real weight)
	{
		const auto shape = [&](Real d) { return mca::pressureShape<mca::ofContacts(rule)>(d, 1. / r2); };
		if (p.linked) return weight * (a.pressureShare + b.pressureShare) * shape(p.d);
		return (p.pushes(0, r2) ? a.pressureShare * shape(p.rest[0]) : 0.) + (p.pushes(1, r2) ? b.pressureShare * shape(p.rest[1]) : 0.);
	}
}

bool PairLaw::fits(const McaLawState& l) const
{
	const auto flags  = mca::Flags(l.flags);
	const auto known  = mca::linkBits | mca::halfBits | mca::linkBits << mca::hadShift | mca::exposedBit | mca::edgeBits | mca::Flags(mca::outlineBits);
	bool       linked = true; // the triangles between links that hold
	for (int k = 0; k < mca::nLinks; k++)
		linked &= mca::holds(flags, k) || !mca::trianglesBeside(mca::trianglesIn(flags), k);
	return l.partner.size() == size_t(mca::nLinks) && long(flags) == l.flags && !(flags & ~known) && linked;
}

void PairLaw::force(McaPhys& p, const State& sa, const McaLawState& a, const State& sb, const McaLawState& b) const
{
	const Vec  r = vec(sb.se3.position) - vec(sa.se3.position);
	const Real r2 = dot(r, r), inv = 1. / r2, along = dot(r, vec(sb.vel) - vec(sa.vel));
	const auto rule   = VolumeRule(a.rule);
	const bool affine = p.linked && rule == VolumeRule::affine;
	const Real w      = p.linked ? mca::linkWeight(mca::Flags(a.flags), p.slot) : 1.;
	const auto both   = mca::ofBothSides(mca::pairArea(w, p.d), stressOf(p, 0), stressOf(p, 1));
	const mca::PairViscosity whole { p.viscLinear, p.viscQuadratic }, c = p.linked ? mca::ofLink(whole, rule) : whole;
	const Real q = w * mca::viscousCoefficient(along, inv, c.linear, c.quadratic, mca::Lattice::width(p.d));
	LinkPush   push {};
	const Vec  f = mca::dispatch(rule, [&](auto known) {
                constexpr VolumeRule by = known.value;
                if (!p.linked) return mca::contactForce(r, both, inv, q, pressing<by>(p, a, b, r2, w));
                push = by == VolumeRule::affine ? pushOnLink(a, b, p.slot) : pushOf(r * pressing<by>(p, a, b, r2, w));
                return linkForceOf(r, both, inv, q, push);
        });
	const auto torque = [&](Real arm, bool first) { return p.linked ? linkTorque(arm, r, inv, both, push, first) : mca::contactTorque(arm, r, both, f); };
	p.force           = vector3(f);
	p.torque          = turn3(torque(mca::arm(a.diameter, b.diameter), true));
	p.torqueOther     = turn3(torque(mca::arm(b.diameter, a.diameter), false));
	p.heatRate = q * along, p.viscousForce = vector3(r * q);
	if (affine) p.viscousForce -= vector3(viscousPushOnLink(a, b, p.slot));
	const Vector3r n = vector3(r * std::sqrt(inv));
	p.normalForce    = -p.force.dot(n) * n;
	p.shearForce     = -p.force - p.normalForce;
}

const McaPairLaw& pairLaw()
{
	static const PairLaw law;
	return law;
}
} // namespace MCA_SPACE
} // namespace yade
