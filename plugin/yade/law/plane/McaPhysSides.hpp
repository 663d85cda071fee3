// SPDX-License-Identifier: GPL-2.0-or-later
// In plane strain: normal and shear stress of each side, an out-of-plane deviator beside them, outlines of triangles.
#pragma once
#include "../McaPhysSides.hpp"

namespace yade {
namespace MCA_SPACE {

inline Stress stressOf(const McaPhys& p, int side) { return { p.s[side], p.tau[side] }; }
inline void   setStress(McaPhys& p, int side, Stress v) { p.s[side] = v.normal, p.tau[side] = v.shear; }
inline mca::Tensor<Real> tensorOf(const Matrix3r& m) { return { m(0, 0), m(0, 1), m(1, 0), m(1, 1) }; }
inline Matrix3r          matrixOf(const mca::Tensor<Real>& t)
{
	Matrix3r m = Matrix3r::Zero();
	m(0, 0) = t.xx, m(0, 1) = t.xy, m(1, 0) = t.yx, m(1, 1) = t.yy;
	return m;
}
inline Turn     turnOf(const Vector3r& v) { return v[2]; }
inline Vector3r turn3(Turn t) { return Vector3r(0, 0, t); }

/// Stress of a side before yield, and that of the step before.
struct Trial {
	Stress before, trial;
};
inline Trial trialOf(Stress old, Vec r, Vec moved, Turn spin, Real dilation, Real twoG)
{
	return { old, mca::trialStress(old, mca::strainIncrement(r, moved, spin), dilation, twoG) };
}
inline void add(mca::PairSums<Real>& to, const Trial& t, Real dilation, Real weight, Real holds)
{
	mca::add<true>(to, t.before, t.trial, dilation, weight, holds);
}
/// What counts as the stress before the step of a contact that does not touch.
inline Stress untouched(const Trial& t) { return t.before; }

/// (9)-(11): deviator of an automaton in a step.
class Deviator {
	Real before, trial; ///< out of the plane [Pa]

public:
	Deviator(const McaState& m, Real G, Real dilation)
		: before(m.stressZZ)
		, trial(mca::trialSzz(2. * G, dilation, m.stressZZ))
	{
	}
	Real equivalent(Real meanSquare) const { return mca::equivalentStress(meanSquare, trial); }
	void scale(McaState& m, Real by) const { m.stressZZ = trial * by; }
	Real equivalentAfter(const McaState& m, Real by, Real meanSquare) const { return mca::equivalentStressAfter(by, meanSquare, m.stressZZ); }
	mca::PairWork work(
		const McaState& m, const mca::PairSums<Real>& sums, Real sigma, const mca::Return& back, Real dilation, Real threeG, Real share, Real invN,
		bool conjugate) const
	{
		return mca::pairWork(sums, sigma, back, m.volumeRatio, dilation, before, trial, m.stressZZ, threeG, share, invN, conjugate);
	}
};
inline Real deviatorEnergyOf(const McaState& m, const McaLawState& l, Real G, Real pairs)
{
	return mca::deviatorEnergy(G, l.diameter, pairs, m.volumeRatio, m.stressZZ, l.invN);
}
/// (5f); normals: sum of weight J s over the links.
inline Real meanPressureOf(const McaState& m, const McaLawState& l, Real normals, Real bulk)
{
	return mca::meanPressure(l.P, normals, m.volumeRatio, m.stressZZ, l.invN, mca::Lattice::cell(l.diameter), l.cell, bulk);
}
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
/// What the pressures of both ends push the first end of a link with, as its negative; A, B: theirs.
inline Vec pushOnLink(const mca::Tensor<Real>& A, const mca::Tensor<Real>& B, const McaLawState& a, const McaLawState& b, int slot)
{
	return mca::pressurePush(A, B, mca::trianglesIn(mca::Flags(a.flags)), mca::trianglesIn(mca::Flags(b.flags)), slot);
}
inline Real pushShare(const McaLawState&) { return 1.; }

inline Vec  linkForceOf(Vec r, Stress both, Real inv, Real viscous, Vec push) { return mca::linkForce(r, both.normal * inv + viscous, both.shear * inv, push); }
inline Turn linkTorque(Real arm, Vec, Real, Stress both) { return arm * both.shear; }
inline mca::ContactSide contactSideOf(Stress before, Stress trial, Vec, Real pressure, Real r2, Real d, Real friction, Real J, Real scale, bool touches)
{
	return { before, trial, pressure, r2, d, friction, J, scale, touches };
}
} // namespace MCA_SPACE
} // namespace yade
