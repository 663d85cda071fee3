// SPDX-License-Identifier: GPL-2.0-or-later
// The law of automata in space against its formulas: packing, volume, pair stress, turn, yield, friction, frames.
#include "kernels/automaton/limit.hpp"
#include "kernels/automaton/filter.hpp"
#include "space_scene.hpp"
using namespace spacetest;

namespace {
/// Tractions of the twelve links after a step of the displacement gradient e + turn, at its middle turned by R.
struct Star {
	Vec<double> n[nLinks], t[nLinks];
	Star(const Rotation& R, const Tensor<double>& gradient, Vec<double> turn, double dilation, double G)
	{
		for (int k = 0; k < nLinks; k++) {
			n[k]                = times(R, k);
			const Vec<double> u = apply(gradient, n[k]) + plainCross(turn, n[k]), r = n[k] + u * 0.5;
			t[k]                = advanced<double>({}, r, u, chord(turn), dilation / 3., 2. * G);
		}
	}
};
Tensor<double> symmetric(const Tensor<double>& A)
{
	Tensor<double> S {};
	for (int c = 0; c < dim; c++)
		for (int q = 0; q < dim; q++) S.column[c][q] = 0.5 * (A.column[c][q] + A.column[q][c]);
	return S;
}
double trace(const Tensor<double>& A) { return A.column[0][0] + A.column[1][1] + A.column[2][2]; }
}

TEST(SpaceLattice, DirectionsAreThoseOfTheFaceCentredCube)
{
	Tensor<double> sum {};
	for (int k = 0; k < nLinks; k++) {
		const Vec<double> e = Lattice::direction(k);
		EXPECT_NEAR(plainSquare(e), 1., 1e-15);
		EXPECT_TRUE(isZero(e + Lattice::direction(Lattice::opposite(k))));
		addDyad(sum, k, e);
		for (int l = 0; l < k; l++) EXPECT_LT(plainDot(e, Lattice::direction(l)), 0.51);
	}
	for (int c = 0; c < dim; c++)
		for (int q = 0; q < dim; q++) EXPECT_NEAR(sum.column[c][q], c == q ? Lattice::spread : 0., 1e-15);
	for (double d : { 1e-6, 1e-3, 2. }) EXPECT_NEAR(Lattice::cell(d) / (12 * Lattice::width(d) * d / 6), 1., 1e-15); // Omega0 = N0 S0 d/(2 dim)
	const double r = std::cbrt(0.75 * Lattice::cell(1.) / M_PI);
	EXPECT_NEAR(Lattice::inertia(3., 1.), 0.4 * 3. * r * r, 1e-14);
}

TEST(SpaceVolume, IsTheDeterminantForAnySetOfLinks)
{
	std::mt19937 r(1);
	double       worst = 0;
	int          sets  = 0;
	for (int trial = 0; trial < 1000; trial++) {
		const Rotation       R = randomRotation(r);
		Tensor<double>       F = randomTensor(r, 0.3), rest {}, now {};
		const unsigned       on = trial < 100 ? 0xfffu : r() & 0xfffu;
		for (int c = 0; c < dim; c++) F.column[c][c] += 1.;
		for (int k = 0; k < nLinks; k++) {
			if (!((on >> k) & 1)) continue;
			addDyad(rest, k, times(R, k)), addDyad(now, k, apply(F, times(R, k)));
		}
		const VolumeConstants<EosKind::linear> c(plain(0.48), 1.);
		const AffineRest a = affineRest(c, rest);
		if (a.factor == 0.) continue;
		sets++;
		EXPECT_NEAR(affineRatio(c, rest, a.factor, a.rest, 0.), 1., 0.);
		worst = std::max(worst, std::fabs(affineRatio(c, now, a.factor, a.rest, 0.) - determinant(F)));
	}
	EXPECT_GT(sets, 500);
	EXPECT_LT(worst, 1e-14);
	RecordProperty("worst", std::to_string(worst));
}

TEST(SpaceVolume, PushIsTheDerivativeOfTheVolumeAndItsSlopeThatOfTheTable)
{
	std::mt19937                           r(2);
	const VolumeConstants<EosKind::linear> c(plain(0.48), 1.);
	for (int trial = 0; trial < 20; trial++) {
		Tensor<double> sum = randomTensor(r, 1.);
		for (int q = 0; q < dim; q++) sum.column[q][q] += 4.;
		const Tensor<double> T = affinePush(c, sum, 1.3);
		for (int k = 0; k < nLinks; k++)
			for (int q = 0; q < dim; q++) {
				const auto J = [&](double h) {
					Tensor<double> s = sum;
					Vec<double>    u {};
					u[q] = h;
					addDyad(s, k, u);
					return 1.3 * linkDeterminant(s, c.perVolume);
				};
				EXPECT_NEAR((J(1e-4) - J(-1e-4)) / 2e-4, times(T, k)[q], 1e-9);
			}
	}
	// how much stiffer surfaces are: trace of the inverse of their sum of directions, over 3
	const auto slope = [&](std::function<bool(Vec<double>)> on) {
		Tensor<double>    sum {};
		Symmetric<double> e {};
		for (int k = 0; k < nLinks; k++) {
			addDirection(e, k, on(Lattice::direction(k)) ? 1. : 0.);
			if (on(Lattice::direction(k))) addDyad(sum, k, Lattice::direction(k));
		}
		return volumeSlope(c, sum, e, affineRest(c, sum).factor);
	};
	EXPECT_NEAR(slope([](Vec<double>) { return true; }), 1., 1e-14);
	EXPECT_NEAR(slope([](Vec<double> e) { return e[0] < 0.1; }), 1.56, 0.005);               // face 100: 8 links
	EXPECT_NEAR(slope([](Vec<double> e) { return e[0] + e[1] + e[2] < 0.1; }), 1.43, 0.005); // face 111: 9
	EXPECT_NEAR(slope([](Vec<double> e) { return e[0] + e[1] < 0.1; }), 1.78, 0.005);        // face 110: 7
	EXPECT_NEAR(slope([](Vec<double> e) { return e[0] < 0.1 && e[1] < 0.1; }), 2.67, 0.005); // edge 100/010: 5
}

TEST(SpaceDeviator, HookeAndMisesAreExactInAnyOrientation)
{
	std::mt19937 r(3);
	const double G = 0.48;
	double       hooke = 0, mises = 0, net = 0;
	for (int trial = 0; trial < 100; trial++) {
		std::uniform_real_distribution<double> u(-1e-14, 1e-14);
		const Tensor<double>                   e = symmetric(randomTensor(r, 1e-14));
		const Star                             star(randomRotation(r), e, { u(r), u(r), u(r) }, trace(e), G);
		Tensor<double>                         s {}, exact = e * (2. * G);
		Vec<double>                            force {};
		double                                 square = 0, norm = 0;
		for (int c = 0; c < dim; c++) exact.column[c][c] -= 2. * G * trace(e) / 3.;
		for (int k = 0; k < nLinks; k++) {
			force += star.t[k], square += plainSquare(star.t[k]) / nLinks;
			for (int c = 0; c < dim; c++) s.column[c] += star.t[k] * (3. / nLinks * star.n[k][c]);
		}
		for (int c = 0; c < dim; c++) norm += plainSquare(exact.column[c]);
		for (int c = 0; c < dim; c++) hooke = std::max(hooke, std::sqrt(plainSquare(s.column[c] - exact.column[c]) / norm));
		mises = std::max(mises, std::fabs(equivalentStress(square) / std::sqrt(1.5 * norm) - 1.));
		net   = std::max(net, std::sqrt(plainSquare(force) / norm));
	}
	EXPECT_LT(hooke, 1e-12);
	EXPECT_LT(mises, 1e-12);
	EXPECT_LT(net, 1e-12);
	std::cout << "Hooke " << hooke << ", Mises " << mises << ", net force " << net << "\n";
}

TEST(SpaceDeviator, TractionsTurnWithABodyThatTurns)
{
	std::mt19937      r(4);
	const Vec<double> axis = unit({ 0.3, -0.5, 0.8 });
	const auto        error = [&](double step) { // after ten turns
		double            worst = 0;
		const int         n     = int(std::round(20. * M_PI / step));
		const Vec<double> w     = axis * (20. * M_PI / n);
		std::mt19937      random(5);
		for (int k = 0; k < nLinks; k++) {
			Vec<double>       x = Lattice::direction(k), t = apply(randomTensor(random, 1.), x);
			const Vec<double> start = t;
			const Vec<double> half  = w * (2. * std::tan(0.5 * std::sqrt(plainSquare(w))) / std::sqrt(plainSquare(w)));
			for (int q = 0; q < n; q++) {
				const Vec<double> now = rotated(x, half);
				t = advanced(t, now, now - x, chord(w), 0., 0.96), x = now;
			}
			worst = std::max(worst, std::sqrt(plainSquare(t - start) / plainSquare(start)));
		}
		return worst;
	};
	EXPECT_LT(error(0.1), 9.7e-5);
	EXPECT_LT(error(0.05), 6.0e-6);
	EXPECT_LT(error(0.01), 9.6e-9);
	std::cout << "ten turns at 0.1, 0.05, 0.01 a step: " << error(0.1) << ", " << error(0.05) << ", " << error(0.01) << "\n";
}

TEST(SpaceDeviator, TurnKeepsLengthsAndAdvanceIsTheImplicitMidPoint)
{
	std::mt19937                           r(6);
	std::uniform_real_distribution<double> u(-1., 1.);
	for (int trial = 0; trial < 50; trial++) {
		const Vec<double> t { u(r), u(r), u(r) }, x { u(r), u(r), 2. }, move { 0.1 * u(r), 0.1 * u(r), 0.1 * u(r) }, w { u(r), u(r), u(r) };
		EXPECT_NEAR(plainSquare(rotated(t, w)), plainSquare(t), 1e-14);
		const auto        p    = pairMotion(x, move, w);
		const auto        a    = advance(t, p, p.normal * 0.02, 0.96);
		const Vec<double> rate = (p.strain - p.normal * 0.02) * 0.96; // t' = W x t + 2G de at the mean of both ends
		const Vec<double> residual = a.trial - t - plainCross(p.turn, (a.trial + t) * 0.5) - rate;
		EXPECT_LT(std::sqrt(plainSquare(residual)), 1e-14);
	}
}

TEST(SpaceContact, FrictionKeepsTheConeAndTheDirection)
{
	std::mt19937                           r(7);
	std::uniform_real_distribution<double> u(-1., 1.);
	for (int trial = 0; trial < 200; trial++) {
		const Vec<double> n = unit({ u(r), u(r), u(r) });
		const ContactSide c { {}, { u(r), u(r), u(r) }, n, 0.3 * std::fabs(u(r)), 1., 1., 0.2, 1., 1., true };
		const Vec<double> t = afterFriction(c), shear = t - n * plainDot(t, n), before = c.trial - n * plainDot(c.trial, n);
		const double      sMax = c.pressure / Lattice::area(1.), s = plainDot(t, n);
		EXPECT_LE(s, sMax + 1e-14);
		EXPECT_LE(std::sqrt(plainSquare(shear)), 0.2 * (sMax - s) + 1e-14);
		EXPECT_LT(plainSquare(plainCross(shear, before)), 1e-28);
		EXPECT_GE(plainDot(shear, before), -1e-15);
	}
}

TEST(SpaceContact, PushIsTheDerivativeOfTheEnergy)
{
	// one automaton with twelve contacts of length r: dW/dr of one, the others held
	const Material m = plain(0.48, 0., 1.49);
	const double   d = 1., cell = Lattice::cell(d);
	for (double q : { 0.85, 0.95, 0.99 }) {
		const auto   term = [&](double r) { return volumeTerm<VolumeRule::inversePower>(d, r * r); };
		const auto   J    = [&](double one) { return contactRatio(11 * term(q) + term(one)); };
		const auto   W = [&](double one) { return cell * storedEnergy(m.eos, J(one) - 1); };
		const double h = 1e-4, slope = (8 * (W(q + h) - W(q - h)) - (W(q + 2 * h) - W(q - 2 * h))) / (12 * h);
		const double force = pressureShare<VolumeRule::inversePower>(pressure(m.eos, J(q) - 1), J(q), cell / nLinks)
			* pressureShape<VolumeRule::inversePower>(d, 1 / (q * q)) * q;
		EXPECT_NEAR(-slope / force, 1., 1e-7) << q;
	}
}

TEST(SpaceContact, WhatHasSlidThroughAndDoesNotTouchHeldNothing)
{
	// near zero distance a small move is a large strain, which the account must not take for what the pair held
	const Vec<double> old { 3e8, -1e8, 2e8 }, r { 1e-6, 2e-6, 0. }, u { 0.01, -0.02, 0.03 }, spin { 0.1, 0.2, 0.3 };
	const auto        t = contactTrial(old, r, u, spin, 0.001, 2e11);
	EXPECT_GT(plainSquare(t.before), 100. * plainSquare(old));
	EXPECT_EQ(plainSquare(before(t, old, false) - old), 0.);
	EXPECT_EQ(plainSquare(before(t, old, true) - t.before), 0.);
}

TEST(SpaceFrame, IsFoundFromItsLinks)
{
	std::mt19937 r(8);
	for (int trial = 0; trial < 100; trial++) {
		const Rotation R = randomRotation(r);
		Vec<double>    bearing[nLinks];
		const int      n = 1 + int(r() % nLinks);
		for (int k = 0; k < n; k++) bearing[k] = times(R, (k * 5 + trial) % nLinks);
		const Frame f = bestFrame(bearing, n);
		EXPECT_NEAR(determinant(f), 1., 1e-13);
		for (int k = 0; k < n; k++) EXPECT_NEAR(match(f, bearing[k]).cosine, 1., 1e-13);
	}
}

TEST(SpaceKernels, LooseAutomataFillTheRoomOfThePackingAtRandom)
{
	EXPECT_EQ(meetsAt(2., 0.7), 2.);
	EXPECT_NEAR(std::pow(meetsAt(2., 0.) / 2., 3), 0.64 / (M_PI / std::sqrt(18.)), 2e-4); // random fill over that of the packing
	EXPECT_EQ(restAfter(1., 0.9, meetsAt(1., 0.)), 1.);                                   // it pushes: nothing changes
	EXPECT_EQ(restAfter(1., 1. - 1e-15, meetsAt(1., 0.)), meetsAt(1., 0.));               // at its rest distance but for round-off
	EXPECT_EQ(restAfter(0.9, 0.85, meetsAt(1., 0.)), std::sqrt(0.85));
}
