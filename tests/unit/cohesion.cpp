// SPDX-License-Identifier: GPL-2.0-or-later
// Broken pairs that hold together, (11f)-(11h), pair by pair: energy, direction, turn, start. Compiled for the plane and for space.
#include "kernels/automaton/cohesion.hpp"
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>
#include <vector>
using namespace mca;

namespace {
constexpr double d = 1e-3;

/// A side of a pair along the first axis, with this part along the pair and this one across it.
Side<double> along(double normal, double shear)
{
#if MCA_DIM == 2
	return { normal, shear };
#else
	return { normal, 0.6 * shear, 0.8 * shear };
#endif
}
Vec<double> firstAxis(double length)
{
	Vec<double> r {};
	r[0] = length;
	return r;
}
/// The same side as a vector of the laboratory; r: along the pair.
Vec<double> inLaboratory(Side<double> w, Vec<double> r)
{
#if MCA_DIM == 2
	const Vec<double> n = r * (1. / std::sqrt(plainSquare(r)));
	return n * w.normal + turned(n) * w.shear;
#else
	(void)r;
	return w;
#endif
}
#if MCA_DIM == 2
double lengthOf(double turn) { return std::fabs(turn); }
#endif
double lengthOf(Vec<double> v) { return std::sqrt(plainSquare(v)); }

Material steel(double energy)
{
	Material m;
	m.eos             = { 7830., 4578., 1.33, 1.67 };
	m.G               = 80e9;
	m.fracture.energy = energy;
	return m;
}
constexpr double area = d; ///< of a pair: any number will do
/// A link that pulls with these stresses [Pa].
Breaking pulling(double normal, double shear, double energy = 5e3)
{
	return breakingPair(scaled(along(normal, shear), area), firstAxis(d), 0., area, d, steel(energy), steel(energy), 0.);
}
struct Path {
	Bond         bond;
	Side<double> at;
	Vec<double>  r    = firstAxis(d);
	double       work = 0;
	Vec<double>  force() { return pullOf(bond, at, r, 0.5).force; }
	void         to(Side<double> next, int steps)
	{
		const Vec<double> a = inLaboratory(at, r), move = (inLaboratory(next, r) - a) * (1. / steps);
		for (int k = 1; k <= steps; k++) {
			const Vec<double> before = force();
			const double      f      = double(k) / steps;
			at                       = k == steps ? next : between(f, next);
			work += 0.5 * plainDot(before + force(), move);
		}
		from = next;
	}
	Side<double> from; ///< where the present leg starts
	explicit Path(const Breaking& b)
		: bond(startBond(b))
		, at(scaled(b.pull, 1. / bond.stiffness))
		, from(at)
	{
	}

private:
	Side<double> between(double f, Side<double> next) const
	{
		const Side<double> a = scaled(from, 1. - f), b = scaled(next, f);
#if MCA_DIM == 2
		return { a.normal + b.normal, a.shear + b.shear };
#else
		return a + b;
#endif
	}
};
} // namespace

TEST(Cohesion, AreaUnderTheLineIsTheFractureEnergy)
{
	for (auto [normal, shear] : std::vector<std::pair<double, double>> { { 8e8, 0. }, { 3e8, 5e8 }, { 0., -7e8 }, { -2e9, 6e8 } }) {
		const Breaking b = pulling(normal, shear);
		Path           p(b);
		ASSERT_GT(p.bond.last, p.bond.first);
		const double start = heldAtStart(p.bond);
		p.to(scaled(b.pull, p.bond.last / (p.bond.first * p.bond.stiffness)), 2000);
		EXPECT_NEAR(start + p.work, 5e3 * area / Lattice::facets, 1e-6 * 5e3 * area) << normal << ' ' << shear;
		EXPECT_NEAR(spent(p.bond), 5e3 * area / Lattice::facets, 1e-9 * 5e3 * area);
		EXPECT_LT(lengthOf(p.force()), 1e-12 * lengthOf(inLaboratory(b.pull, p.r)));
		EXPECT_DOUBLE_EQ(shareSpent(p.bond), 1.);
	}
}

TEST(Cohesion, GoesOnWithThePullOfTheLinkAndIsContinuous)
{
	const Breaking b = pulling(6e8, 4e8);
	Path           p(b);
	const double   pull = std::hypot(6e8, 4e8) * area;
	EXPECT_NEAR(lengthOf(p.force()), pull, 1e-12 * pull);
	EXPECT_NEAR(lengthOf(p.force() - inLaboratory(b.pull, p.r)), 0., 1e-12 * pull);
	EXPECT_DOUBLE_EQ(p.bond.stiffness, steel(0).eos.rho0 * sqr(steel(0).cP()) * area / d);
	EXPECT_NEAR(p.bond.rest, d - 6e8 * area / p.bond.stiffness, 1e-15 * d); // opening and distance say the same
	Bond wider = p.bond;
	wider.most = wider.first * (1. + 1e-9);
	EXPECT_NEAR(secant(wider), secant(p.bond), 1e-8 * p.bond.stiffness);
	EXPECT_DOUBLE_EQ(secant(p.bond), p.bond.stiffness);
	double last = pull * (1 + 1e-12);
	for (double w = p.bond.first; w < 1.1 * p.bond.last; w += 0.01 * p.bond.last) { // falls along a straight line
		Bond         q    = p.bond;
		const double f    = lengthOf(pullOf(q, scaled(b.pull, w / pull), p.r, 0.5).force);
		const double line = pull * std::max(0., (q.last - w) / (q.last - q.first));
		EXPECT_NEAR(f, line, 1e-12 * pull);
		EXPECT_LE(f, last);
		last = f;
	}
}

TEST(Cohesion, UnloadsToTheOriginAndReloadsOnTheSameLine)
{
	const Breaking b = pulling(6e8, 4e8);
	Path           p(b);
	const double   per = 1. / std::hypot(6e8, 4e8) / area, widest = 0.4 * p.bond.last;
	p.to(scaled(b.pull, widest * per), 100);
	const double cost = spent(p.bond), k = secant(p.bond), force = lengthOf(p.force());
	for (double f : { 0.9, 0.5, 1e-3, 0., 0.3, 0.7, 1. }) {
		p.at = scaled(b.pull, f * widest * per);
		EXPECT_NEAR(lengthOf(p.force()), f * force, 1e-12 * force) << f;
		EXPECT_NEAR(heldNow(p.bond, p.at, p.r), 0.5 * k * sqr(f * widest), 1e-12 * k * sqr(widest));
		EXPECT_EQ(spent(p.bond), cost);
	}
	p.at = along(-0.1 * d, 0.); // pressed together: no more than a contact
	EXPECT_LT(lengthOf(p.force()), 1e-12 * force);
	EXPECT_LT(heldNow(p.bond, p.at, p.r), 1e-24 * k * sqr(widest));
	p.at = along(-0.1 * d, 0.5 * widest); // slip is held all the same
	EXPECT_NEAR(lengthOf(p.force() - inLaboratory(along(0., 0.5 * widest * k), p.r)), 0., 1e-12 * force);
}

// What has been done against the pair is what it holds and what is spent, whatever the way.
TEST(Cohesion, WorkIsHeldOrSpentOnAnyPath)
{
	std::mt19937                           random(7);
	std::uniform_real_distribution<double> u(-1., 1.);
	for (int path = 0; path < 20; path++) {
		const Breaking b = pulling(8e8 * std::fabs(u(random)) + 1e8, 8e8 * u(random));
		Path           p(b);
		const double   start = heldAtStart(p.bond), all = 0.5 * p.bond.stiffness * p.bond.first * p.bond.last;
		for (int leg = 0; leg < 8; leg++) {
			p.to(along(0.7 * p.bond.last * u(random), 0.7 * p.bond.last * u(random)), 2000);
			EXPECT_NEAR(start + p.work, spent(p.bond) + heldNow(p.bond, p.at, p.r), 1e-3 * all) << path << ' ' << leg;
		}
		EXPECT_GT(spent(p.bond), 0.);
	}
}

TEST(Cohesion, PullsAlongItsOpeningAndKeepsAngularMomentum)
{
	std::mt19937                           random(3);
	std::uniform_real_distribution<double> u(-1., 1.);
	for (int k = 0; k < 100; k++) {
		Vec<double> r {};
		for (int c = 0; c < dim; c++) r[c] = d * u(random);
		Bond         b = startBond(pulling(6e8, 4e8));
		Side<double> w {};
#if MCA_DIM == 2
		w = { std::fabs(u(random)) * b.last, u(random) * b.last };
#else
		for (int c = 0; c < dim; c++) w[c] = u(random) * b.last;
		w = withNormal(w, r, std::fabs(normalStress(w, r)));
#endif
		w                 = scaled(w, 0.5);
		const double arm  = 0.5 + 0.3 * u(random);
		const Pull   p    = pullOf(b, w, r, arm);
		const double size = secant(b) * wide(w, r);
		EXPECT_DOUBLE_EQ(b.most, std::max(b.first, wide(w, r)));
		EXPECT_NEAR(lengthOf(p.force), size, 1e-12 * size);
		EXPECT_NEAR(lengthOf(p.force - inLaboratory(w, r) * secant(b)), 0., 1e-12 * size);
		// the forces on both ends turn the pair the other way round
		EXPECT_NEAR(lengthOf(p.torque + p.other - cross(r, p.force)), 0., 1e-12 * size * d);
		EXPECT_NEAR(lengthOf(p.torque - cross(r, p.force) * arm), 0., 1e-12 * size * d);
	}
}

TEST(Cohesion, PartsAtOnceWithoutEnergyPullOrRoom)
{
	const auto parts = [](const Breaking& b) { return startBond(b).first == 0. && startBond(b).last == 0.; };
	EXPECT_FALSE(parts(pulling(6e8, 0.)));
	EXPECT_TRUE(parts(pulling(6e8, 0., 0.)));
	EXPECT_TRUE(parts(pulling(-6e8, 0.))); // what pushes is a contact
	EXPECT_TRUE(parts(pulling(0., 0.)));
	const Material m       = steel(5e3);
	const double   modulus = m.eos.rho0 * sqr(m.cP()), strongest = std::sqrt(2. * modulus * 5e3 / (Lattice::facets * d));
	EXPECT_FALSE(parts(pulling(0.999 * strongest, 0.)));
	EXPECT_TRUE(parts(pulling(1.001 * strongest, 0.)));
	EXPECT_NEAR(longestSpacing(modulus, 5e3, strongest), d, 1e-12 * d);
	const Breaking mixed = breakingPair(along(1e5, 0.), firstAxis(d), 0., area, d, steel(5e3), steel(2e3), 0.);
	EXPECT_EQ(mixed.energy, 2e3); // the smaller of both
	// the pressure of both counts as the stress of the pair does: 1 MN - 0.4 MN pulls 0.6
	EXPECT_NEAR(breakingPair(along(1e6, 0.), firstAxis(d), 4e5, area, d, m, m, 0.).normal, 6e5, 1e-6);
	EXPECT_FALSE(isCohesive(BreakCause::cut) || isCohesive(BreakCause::collapsed));
	EXPECT_TRUE(isCohesive(BreakCause::spall) && isCohesive(BreakCause::plasticStrain) && isCohesive(BreakCause::pairStress));
}

TEST(Cohesion, OnesThatPullLittlePartAtHalfADiameter)
{
	const Bond b = startBond(pulling(1e4, 0.));
	EXPECT_DOUBLE_EQ(b.last, 0.5 * d);
	EXPECT_LT(0.5 * b.stiffness * b.first * b.last, 1e-3 * 5e3 * area);
}

TEST(Cohesion, RefusesAStrengthForWhichPairsWouldPartAtOnce)
{
	const auto refusal = [](Material m) -> std::string {
		try {
			checkCohesion(m, m, d);
		} catch (const Error& e) {
			return e.what();
		}
		return "";
	};
	Material     m         = steel(5e3);
	const double strongest = std::sqrt(2. * m.eos.rho0 * sqr(m.cP()) * 5e3 / (Lattice::facets * d));
	EXPECT_EQ(refusal(m), "");
	m.fracture.pairStress = 0.999 * strongest;
	EXPECT_EQ(refusal(m), "");
	m.fracture.pairStress = 1.001 * strongest;
	EXPECT_NE(refusal(m).find("pairStrength"), std::string::npos) << refusal(m);
	m.fracture.pairStress = std::numeric_limits<double>::infinity(), m.fracture.spall = 1.001 * strongest;
	EXPECT_NE(refusal(m).find("spallStrength"), std::string::npos) << refusal(m);
	m.fracture.energy = 0.;
	EXPECT_EQ(refusal(m), "");
}

// A pair that turns with the spins of its ends opens no further, over one move and over a whole turn.
TEST(Cohesion, ARigidTurnDoesNotOpenIt)
{
	constexpr int    steps = 400;
	constexpr double angle = 2. * M_PI / steps;
	Vec<double>      r     = firstAxis(d);
	Side<double>     w     = along(2e-5, 3e-5);
	const double     rest = d - 2e-5, before = wide(w, r);
#if MCA_DIM == 2
	const Turn<double> omega = angle;
	const auto         after = [&](Vec<double> v) { return v * std::cos(angle) + turned(v) * std::sin(angle); };
#else
	const Vec<double>  axis { 2. / 3., -1. / 3., 2. / 3. };
	const Turn<double> omega = axis * angle;
	const auto         after = [&](Vec<double> v) {
                return v * std::cos(angle) + plainCross(axis, v) * std::sin(angle) + axis * (plainDot(axis, v) * (1. - std::cos(angle)));
	};
#endif
	const Side<double> start = w;
	for (int k = 0; k < steps; k++) {
		const Vec<double> next = after(r);
		w                      = opened(w, rest, next, next - r, pairSpin(omega, omega, 0.4, 1.));
		r                      = next;
		EXPECT_NEAR(wide(w, r), before, 1e-9 * before) << k;
	}
	EXPECT_NEAR(lengthOf(inLaboratory(w, firstAxis(d)) - inLaboratory(start, firstAxis(d))), 0., 1e-6 * before);
}

TEST(Cohesion, OpensByDistanceAndSlip)
{
	const Side<double> closed = along(0., 0.);
	const Vec<double>  wider  = firstAxis(1.05 * d);
	const Side<double> w      = opened(closed, d, wider, wider - firstAxis(d), Turn<double> {});
	EXPECT_NEAR(lengthOf(inLaboratory(w, wider) - firstAxis(0.05 * d)), 0., 1e-15);
	Vec<double> slip {};
	slip[1]                 = 1e-4 * d; // short against the pair: it hardly turns
	const Vec<double>  r    = firstAxis(d) + slip;
	const Side<double> slid = opened(closed, d, r, slip, Turn<double> {});
	EXPECT_NEAR(wide(slid, r), 1e-4 * d, 1e-7 * d);
	EXPECT_NEAR(plainDot(inLaboratory(slid, r), slip), sqr(1e-4 * d), 1e-3 * sqr(1e-4 * d));
}
