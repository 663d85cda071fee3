// SPDX-License-Identifier: GPL-2.0-or-later
// In space: a traction of each side in the frame of the laboratory, faces of weighted links (S8).
#pragma once
#include "../McaPhysSides.hpp"

namespace yade {
namespace MCA_SPACE {

inline Stress stressOf(const McaPhys& p, int side) { return vec(side ? p.tractionOther : p.traction); }
inline void   setStress(McaPhys& p, int side, Stress v) { (side ? p.tractionOther : p.traction) = vector3(v); }
inline mca::Tensor<Real> tensorOf(const Matrix3r& m) { return { vec(m.col(0)), vec(m.col(1)), vec(m.col(2)) }; }
inline Matrix3r          matrixOf(const mca::Tensor<Real>& t)
{
	Matrix3r m;
	for (int c = 0; c < mca::dim; c++)
		m.col(c) = vector3(t.column[c]);
	return m;
}
inline Turn     turnOf(const Vector3r& v) { return vec(v); }
inline Vector3r turn3(Turn t) { return vector3(t); }

/// Traction of a side before yield; that of the step before, as it was and in the frame of now; direction of the pair at the middle of the step.
struct Trial {
	Stress old, before, trial;
	Vec    normal;
};
inline Trial trialOf(Stress old, Vec r, Vec moved, Turn spin, Real dilation, Real twoG)
{
	const auto motion = mca::pairMotion(r, moved, spin);
	const auto step   = mca::advance(old, motion, dilation, twoG);
	return { old, step.before, step.trial, motion.normal };
}
inline void add(mca::PairSums<Real>& to, const Trial& t, Real dilation, Real weight, Real holds)
{
	mca::add<true>(to, t.old, mca::Advance<Real> { t.trial, t.before }, t.normal, dilation, weight, holds);
}
/// What counts as the stress before the step of a contact that does not touch.
inline Stress untouched(const Trial& t) { return t.old; }

/// Deviator of an automaton in a step: that of its pairs.
class Deviator {
public:
	Deviator(const McaState&, Real, Real) { }
	Real equivalent(Real meanSquare) const { return mca::equivalentStress(meanSquare); }
	void scale(McaState&, Real) const { }
	Real equivalentAfter(const McaState&, Real by, Real meanSquare) const { return by * mca::equivalentStress(meanSquare); }
	mca::PairWork work(
		const McaState& m, const mca::PairSums<Real>& sums, Real sigma, const mca::Return& back, Real dilation, Real threeG, Real share, Real invN,
		bool conjugate) const
	{
		return mca::pairWork(sums, sigma, back, m.volumeRatio, dilation, threeG, share, invN, conjugate);
	}
};
inline Real deviatorEnergyOf(const McaState&, const McaLawState& l, Real G, Real pairs) { return mca::deviatorEnergy(G, l.diameter, pairs); }
/// normals: sum of weight J times the tractions along the links.
inline Real meanPressureOf(const McaState& m, const McaLawState& l, Real normals, Real bulk)
{
	return mca::meanPressure(l.P, normals, m.volumeRatio, mca::Lattice::cell(l.diameter), l.cell, bulk);
}
inline Real shownPressureOf(const McaLawState&, Real mean) { return mean; }
/// (S8): share of the full star that the links make.
inline Real starShare(const McaLawState& l) { return mca::shareOfStar(mca::Flags(l.flags), l.cell / mca::Lattice::cell(l.diameter)); }

/// What the links of an automaton measure of its deformation.
struct LinkSums {
	mca::Tensor<Real>    F {};
	mca::Symmetric<Real> directions {};
	/// Of every link, in their order; r: to the other end, nothing where it does not hold.
	void add(mca::Flags flags, int k, Vec r)
	{
		const Real w = mca::linkWeight(flags, k);
		addDirection(directions, k, mca::holds(flags, k) ? w : 0.);
		addDyad(F, k, r * w);
	}
	void complete(const McaLawState& l)
	{
		const Real per = 1. / starShare(l);
		F = F * per, directions = directions * per;
	}
};
/// What the pressures of both ends push the first end of a link with, as its negative; A, B: theirs.
inline Vec pushOnLink(const mca::Tensor<Real>& A, const mca::Tensor<Real>& B, const McaLawState& a, const McaLawState&, int slot)
{
	return times(A + B, slot) * mca::linkWeight(mca::Flags(a.flags), slot);
}
inline Real pushShare(const McaLawState& l) { return starShare(l); }

inline Vec  linkForceOf(Vec r, Stress both, Real inv, Real viscous, Vec push) { return mca::linkForce(r, both, mca::root(inv), viscous, push); }
inline Turn linkTorque(Real arm, Vec r, Real inv, Stress both) { return cross(r, both) * (mca::root(inv) * arm); }
inline mca::ContactSide contactSideOf(Stress before, Stress trial, Vec r, Real pressure, Real r2, Real d, Real friction, Real J, Real scale, bool touches)
{
	return { before, trial, mca::Lattice::bearing(r), pressure, r2, d, friction, J, scale, touches };
}
} // namespace MCA_SPACE
} // namespace yade
