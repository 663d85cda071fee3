// SPDX-License-Identifier: GPL-2.0-or-later
// In space: a traction of each side in the frame of the laboratory, faces of weighted links (S8).
#pragma once
#include "../McaPhysSides.hpp"
#include <kernels/space/stiffness.hpp>

namespace yade {
namespace MCA_SPACE {

inline Stress stressOf(const McaPhys& p, int side) { return vec(side ? p.tractionOther : p.traction); }
inline void   setStress(McaPhys& p, int side, Stress v) { (side ? p.tractionOther : p.traction) = vector3(v); }
inline Stress openingOf(const McaPhys& p) { return vec(p.opening); }
inline void   setOpening(McaPhys& p, Stress w) { p.opening = vector3(w); }
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

inline mca::Symmetric<Real> symmetricOf(const Matrix3r& m) { return { m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(2, 0), m(0, 1) }; }
inline Matrix3r             matrixOf(const mca::Symmetric<Real>& s)
{
	Matrix3r m;
	m << s.xx, s.xy, s.zx, s.xy, s.yy, s.yz, s.zx, s.yz, s.zz;
	return m;
}

/// What of the strain of a pair is left out of its traction.
using Apart = mca::Symmetric<Real>;
inline Apart apartOf(Real dilation) { return mca::isotropic(dilation); }
/// Traction of a side before yield; that of the step before, as it was and in the frame of now; what was left out, along the pair.
struct Trial {
	Stress old, before, trial;
	Vec    apart;
};
inline Trial trialOf(Stress old, Vec r, Vec moved, Turn spin, const Apart& apart, Real twoG)
{
	const auto motion = mca::pairMotion(r, moved, spin);
	const Vec  along  = times(apart, motion.normal);
	const auto step   = mca::advance(old, motion, along, twoG);
	return { old, step.before, step.trial, along };
}
inline void add(mca::PairSums<Real>& to, const Trial& t, Real weight, Real holds)
{
	mca::add<true>(to, t.old, mca::Advance<Real> { t.trial, t.before }, t.apart, weight, holds);
}
/// What counts as the stress before the step of a contact that does not touch.
inline Stress untouched(const Trial& t) { return t.old; }

/// (S3)-(S5): deviator of an automaton in a step, from what its links measure.
class Deviator {
	mca::DeformationSums<Real> sums;
	mca::Symmetric<Real>       strain {}, old {};
	mca::DeviatorAdvance<Real> step {};

public:
	/// What a link does in a step.
	void link(int k, Vec r, Vec moved, Turn spin, Turn own, Real weight) { sums.add(k, moved, mca::pairMotion(r, moved, spin), spin - own, weight); }
	void advance(const McaState&, const McaLawState& l, Real G, Real dilation)
	{
		old = symmetricOf(l.deviator);
		mca::Deformation<Real> own { apartOf(l.factor > 0 ? 0. : mca::pairDilation(dilation, Real(0), mca::ofOwn)), {} };
		// links that have moved span a volume: not where neighbours are new
		const bool spans = l.factor > 0 && determinant(sums.middle) * mca::Lattice::perVolume(l.diameter) * l.factor > 1e-9;
		if (spans) own = mca::deformation(sums, mca::Lattice::cell(l.diameter) / (mca::Lattice::spread * l.cell));
		strain = own.strain, step = mca::advance(old, own, 2. * G);
	}
	/// What links leave out of their tractions: what the deviator sees, or a dilation where they span no volume.
	Apart apart(Real) const { return strain; }
	void  addTo(mca::PairSums<Real>& to, Real invN) const { mca::add<true>(to, old, step, invN); }
	Real equivalent(Real meanSquare) const { return mca::equivalentStress(meanSquare); }
	void scale(McaState& m, McaLawState& l, Real by) const
	{
		l.deviator = matrixOf(step.trial * by);
		m.stressZZ = l.deviator(2, 2);
	}
	Real equivalentAfter(const McaState&, Real by, Real meanSquare) const { return by * mca::equivalentStress(meanSquare); }
	mca::PairWork work(
		const McaState& m, const mca::PairSums<Real>& all, Real sigma, const mca::Return& back, Real dilation, Real threeG, Real share, Real invN,
		bool conjugate) const
	{
		return mca::pairWork(all, sigma, back, m.volumeRatio, dilation, threeG, share, invN, conjugate);
	}
};
/// All that acts along a pair, J times: the traction of its side and that of the deviator; r: to its other end.
inline Stress wholeStress(const McaState& m, const McaLawState& l, Stress side, Vec r)
{
	return side + times(symmetricOf(l.deviator) * m.volumeRatio, mca::Lattice::bearing(r));
}
inline void clearDeviator(McaLawState& l) { l.deviator.setZero(); }
inline Real deviatorEnergyOf(const McaState& m, const McaLawState& l, Real G, Real pairs)
{
	return mca::deviatorEnergy(G, l.diameter, l.cell, m.volumeRatio, symmetricOf(l.deviator), pairs);
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
/// Sums over the links for (S6).
struct SideSums {
	mca::Symmetric<Real> sides {}; ///< of weight J traction (x) n
	void add(Real weight, Stress side, Vec r) { sides += symmetricDyad(side, mca::Lattice::bearing(r)) * weight; }
	mca::Symmetric<Real> own(const McaState& m, const McaLawState& l, Real bulk) const
	{
		return mca::ownPush(symmetricOf(l.deviator), sides, m.volumeRatio, mca::Lattice::cell(l.diameter), l.cell, bulk);
	}
	Real meanPressure(const McaState& m, const McaLawState& l, Real bulk) const { return mca::meanPressure(l.P, own(m, l, bulk)); }
	void finishPush(const McaState& m, McaLawState& l, Real, Real bulk) const
	{
		const Real sum = l.P + l.viscous;
		l.viscousShare = sum != 0 ? l.viscous / sum : 0.;
		l.push *= l.cell / (starShare(l) * m.volumeRatio);
		l.pushPressure = m.volumeRatio * (l.P + l.viscous), l.pushStress = matrixOf(own(m, l, bulk) * (l.factor > 0 ? m.volumeRatio : 0.));
	}
};
/// What both ends push the first end of a link with, as its negative.
struct LinkPush {
	Vec                force;
	mca::Pushes<Real> mine, theirs; ///< for the couple
	Real               weight = 0, dMine = 0, dTheirs = 0;
};
inline mca::Pushes<Real> pushesOf(const McaLawState& l) { return mca::pushes(tensorOf(l.push), l.pushPressure, symmetricOf(l.pushStress)); }
inline LinkPush          pushOnLink(const McaLawState& a, const McaLawState& b, int slot)
{
	const auto A = pushesOf(a), B = pushesOf(b);
	const Real w = mca::linkWeight(mca::Flags(a.flags), slot);
	return { mca::linkPush(A, B, slot) * w, A, B, w, a.diameter, b.diameter };
}
/// Its viscous share.
inline Vec viscousPushOnLink(const McaLawState& a, const McaLawState& b, int slot)
{
	const auto share = [](const McaLawState& l) { return l.viscousShare * l.pushPressure; };
	return (times(tensorOf(a.push), slot) * share(a) + times(tensorOf(b.push), slot) * share(b)) * mca::linkWeight(mca::Flags(a.flags), slot);
}
inline LinkPush pushOf(Vec push) { return { push, {}, {} }; }

inline Vec linkForceOf(Vec r, Stress both, Real inv, Real viscous, const LinkPush& push)
{
	return mca::linkForce(r, both, mca::root(inv), viscous, push.force);
}
/// first: whether it is that of the first end; arm: of that end.
inline Turn linkTorque(Real arm, Vec r, Real inv, Stress both, const LinkPush& push, bool first)
{
	const Real mine = first ? arm : 1. - arm, share = push.weight / mca::Lattice::spread;
	const Real ofMine = share * (1. - mine) * mca::Lattice::cell(push.dMine), ofTheirs = share * mine * mca::Lattice::cell(push.dTheirs);
	const Vec  couple = mca::linkCouple(push.mine, push.theirs, r * mca::root(inv), ofMine, ofTheirs);
	return cross(r, both) * (mca::root(inv) * arm) + (first ? couple : -couple);
}
template <mca::EosKind kind>
Real stiffnessOf(const mca::VolumeConstants<kind>& c, Real J, const LinkSums& sums, Real factor, Real, Real nearest2, bool)
{
	return mca::affineStiffness(c, J, sums.F, sums.directions, factor, nearest2);
}
inline mca::ContactSide contactSideOf(Stress before, Stress trial, Vec r, Real pressure, Real r2, Real d, Real friction, Real J, Real scale, bool touches)
{
	return { before, trial, mca::Lattice::bearing(r), pressure, r2, d, friction, J, scale, touches };
}
} // namespace MCA_SPACE
} // namespace yade
