// SPDX-License-Identifier: GPL-2.0-or-later
// In plane strain: normal and shear stress of each side, an out-of-plane deviator beside them, outlines of triangles.
#pragma once
#include "../McaPhysSides.hpp"

namespace yade {
namespace MCA_SPACE {

inline Stress stressOf(const McaPhys& p, int side) { return { p.s[side], p.tau[side] }; }
inline void   setStress(McaPhys& p, int side, Stress v) { p.s[side] = v.normal, p.tau[side] = v.shear; }
inline Stress openingOf(const McaPhys& p) { return { p.opening[0], p.opening[1] }; }
inline void   setOpening(McaPhys& p, Stress w) { p.opening = Vector3r(w.normal, w.shear, 0); }
inline mca::Tensor<Real> tensorOf(const Matrix3r& m) { return { m(0, 0), m(0, 1), m(1, 0), m(1, 1) }; }
inline Matrix3r          matrixOf(const mca::Tensor<Real>& t)
{
	Matrix3r m = Matrix3r::Zero();
	m(0, 0) = t.xx, m(0, 1) = t.xy, m(1, 0) = t.yx, m(1, 1) = t.yy;
	return m;
}
inline Turn     turnOf(const Vector3r& v) { return v[2]; }
inline Vector3r turn3(Turn t) { return Vector3r(0, 0, t); }

/// What of the strain of a pair is left out of its stress: of a dilation.
using Apart = Real;
inline Apart apartOf(Real dilation) { return dilation; }
/// Stress of a side before yield, and that of the step before.
struct Trial {
	Stress before, trial;
	Apart  apart;
};
inline Trial trialOf(Stress old, Vec r, Vec moved, Turn spin, Apart apart, Real twoG)
{
	return { old, mca::trialStress(old, mca::strainIncrement(r, moved, spin), apart, twoG), apart };
}
inline void add(mca::PairSums<Real>& to, const Trial& t, Real weight, Real holds) { mca::add<true>(to, t.before, t.trial, t.apart, weight, holds); }
/// What counts as the stress before the step of a contact that does not touch.
inline Stress untouched(const Trial& t) { return t.before; }

/// (9)-(11): deviator of an automaton in a step, out of the plane.
class Deviator {
	Real before = 0, trial = 0; ///< [Pa]

public:
	/// What a link does in a step; nothing follows from it here.
	void link(int, Vec, Vec, Turn, Turn, Real) { }
	void advance(const McaState& m, const McaLawState&, Real G, Real dilation) { before = m.stressZZ, trial = mca::trialSzz(2. * G, dilation, m.stressZZ); }
	/// What links leave out of their stress of a dilation.
	Apart apart(Real dilation) const { return dilation; }
	void  addTo(mca::PairSums<Real>&, Real) const { }
	Real equivalent(Real meanSquare) const { return mca::equivalentStress(meanSquare, trial); }
	void scale(McaState& m, McaLawState&, Real by) const { m.stressZZ = trial * by; }
	Real equivalentAfter(const McaState& m, Real by, Real meanSquare) const { return mca::equivalentStressAfter(by, meanSquare, m.stressZZ); }
	mca::PairWork work(
		const McaState& m, const mca::PairSums<Real>& sums, Real sigma, const mca::Return& back, Real dilation, Real threeG, Real share, Real invN,
		bool conjugate) const
	{
		return mca::pairWork(sums, sigma, back, m.volumeRatio, dilation, before, trial, m.stressZZ, threeG, share, invN, conjugate);
	}
};
/// All that acts along a pair, J times: the stress of its side.
inline Stress wholeStress(const McaState&, const McaLawState&, Stress side, Vec) { return side; }
inline void   clearDeviator(McaLawState&) { }
inline Real deviatorEnergyOf(const McaState& m, const McaLawState& l, Real G, Real pairs)
{
	return mca::deviatorEnergy(G, l.diameter, pairs, m.volumeRatio, m.stressZZ, l.invN);
}
/// Sums over the links for (5f).
struct SideSums {
	Real normals = 0; ///< of weight J s
	void add(Real weight, Stress side, Vec r) { normals += weight * mca::normalStress(side, r); }
	Real meanPressure(const McaState& m, const McaLawState& l, Real bulk) const
	{
		return mca::meanPressure(l.P, normals, m.volumeRatio, m.stressZZ, l.invN, mca::Lattice::cell(l.diameter), l.cell, bulk);
	}
	/// acting: meanPressure(), or P where links have no volume.
	void finishPush(const McaState&, McaLawState& l, Real acting, Real) const
	{
		const Real sum = acting + l.viscous;
		l.viscousShare = sum != 0 ? l.viscous / sum : 0.;
		l.push *= sum * l.cell;
	}
};
inline Real shownPressureOf(const McaLawState& l, Real mean) { return mca::shownPressure(l.P, mean, mca::Flags(l.flags)); }

/// What the links of an automaton measure of its deformation.
struct LinkSums {
	mca::Tensor<Real>    F {};
	mca::Symmetric<Real> directions {};
	/// Of every link, in their order; r: to the other end, nothing where it does not hold.
	void add(mca::Flags flags, int k, Vec r)
	{
		const mca::Triangles triangles = mca::trianglesIn(flags);
		if (triangles) addSquare(directions, mca::outlineTable.of(triangles, k));
		else addDirection(directions, k, mca::holds(flags, k) ? 1. : 0.);
		addDyad(F, mca::outlineTable.of(triangles, k), r);
	}
	void complete(const McaLawState&) { }
};
/// What the pressures of both ends push the first end of a link with, as its negative.
using LinkPush = Vec;
inline Vec pushBy(const McaLawState& a, const McaLawState& b, const mca::Tensor<Real>& A, const mca::Tensor<Real>& B, int slot)
{
	return mca::pressurePush(A, B, mca::trianglesIn(mca::Flags(a.flags)), mca::trianglesIn(mca::Flags(b.flags)), slot);
}
inline LinkPush pushOnLink(const McaLawState& a, const McaLawState& b, int slot) { return pushBy(a, b, tensorOf(a.push), tensorOf(b.push), slot); }
/// Its viscous share.
inline Vec viscousPushOnLink(const McaLawState& a, const McaLawState& b, int slot)
{
	return pushBy(a, b, tensorOf(a.push) * a.viscousShare, tensorOf(b.push) * b.viscousShare, slot);
}
inline LinkPush pushOf(Vec push) { return push; }

inline Vec  linkForceOf(Vec r, Stress both, Real inv, Real viscous, LinkPush push)
{
	return mca::linkForce(r, both.normal * inv + viscous, both.shear * inv, push);
}
inline Turn linkTorque(Real arm, Vec, Real, Stress both, LinkPush, bool) { return arm * both.shear; }
template <mca::EosKind kind>
Real stiffnessOf(const mca::VolumeConstants<kind>& c, Real J, const LinkSums&, Real, Real slope, Real nearest2, bool outline)
{
	return mca::affineStiffness(c, J, slope, nearest2, outline);
}
inline mca::ContactSide contactSideOf(Stress before, Stress trial, Vec, Real pressure, Real r2, Real d, Real friction, Real J, Real scale, bool touches)
{
	return { before, trial, pressure, r2, d, friction, J, scale, touches };
}
} // namespace MCA_SPACE
} // namespace yade
