// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies whose broken pairs hold together: balances, threads, saving, erasing.
#include "automata_scene.hpp"
#include <omp.h>
using namespace automatatest;

namespace {
constexpr double d = 1e-3;
/// A block whose halves fly apart with a shake: pairs break, hold, part or close again.
void halves(Solver& s, VolumeRule rule = VolumeRule::affine, double energy = 5e3, double speed = 25., bool account = true)
{
	Material m            = steel();
	m.viscosity           = { 0.5, 0. };
	m.fracture.pairStress = 6e8, m.fracture.energy = energy;
	auto list = packing(d, 12, 12, m);
	for (auto& a : list) a.velocity[1] = a.position[1] > 4.9e-3 ? speed : -speed;
	shake(list, 0.2 * speed, 5);
	Options o;
	o.volumeRule = rule, o.account = account;
	s.build(list, { m }, o);
}
/// All that everything() shows, and the pairs that hold together.
std::vector<double> all(const Solver& s)
{
	std::vector<double> v = everything(s);
	const Bonds&        b = s.bonds;
	for (size_t q = 0; q < b.size(); q++)
		for (double x : { double(b.first[q]), double(b.second[q]), b.s[q], b.tau[q], b.rest[q], b.stiffness[q], b.from[q], b.until[q], b.most[q] })
			v.push_back(x);
	return v;
}
/// Steps until pairs have broken and hold together.
double untilOpen(Solver& s, size_t least = 10)
{
	double dt = 0;
	for (int k = 0; k < 1000 && s.bonds.size() < least; k++) dt = run(s, 1, 0.4, dt);
	EXPECT_GE(s.bonds.size(), least);
	return dt;
}
} // namespace

TEST(AutomataCohesion, BalancesHold)
{
	for (VolumeRule rule : { VolumeRule::affine, VolumeRule::inversePower, VolumeRule::meanDistance }) {
		Solver s;
		halves(s, rule);
		const Account start = s.account();
		const double  size = std::sqrt(2. * start.kinetic * 144 * steel().eos.rho0 * Lattice::cell(d)), turning = size * 10 * d;
		double        dt   = 0;
		size_t        most = 0;
		for (int k = 0; k < 200; k++) {
			dt              = run(s, 10, 0.2, dt);
			const Account a = s.account();
			most            = std::max(most, s.bonds.size());
			ASSERT_LT(std::sqrt(plainSquare(a.momentum - start.momentum)), 1e-13 * size) << int(rule) << ' ' << k;
			ASSERT_LT(std::fabs(a.angular - start.angular), 1e-12 * turning);
			ASSERT_LT(std::fabs(a.bookedError()), 1e-12 * start.kinetic);
			ASSERT_LT(std::fabs(a.total() - start.kinetic), 4e-3 * start.kinetic) << int(rule) << ' ' << k;
		}
		EXPECT_GT(most, 10u);
		EXPECT_GT(s.account().fracture, 0.02 * start.kinetic);
	}
}

TEST(AutomataCohesion, EnergySumConvergesWithTheStep)
{
	const auto drift = [](double factor) {
		Solver s;
		halves(s);
		return energyDrift(s, 8e-6, factor);
	};
	EXPECT_LT(drift(0.4), 4e-3);
	EXPECT_LT(drift(0.05), 1e-3);
}

// With nothing to hold them the halves part at once; with much energy they do not part.
TEST(AutomataCohesion, EnergyDecidesWhetherTheyPart)
{
	double apart[3];
	int    k = 0;
	for (double energy : { 0., 5e3, 1e6 }) {
		Solver s;
		halves(s, VolumeRule::affine, energy);
		double dt = 0;
		while (s.time < 30e-6) dt = run(s, 10, 0.4, dt);
		const Store& S    = s.store;
		double       high = 0, low = 0;
		for (int id = 0; id < 72; id++) low += S.velocity[1][size_t(s.indexOf(id))] / 72., high += S.velocity[1][size_t(s.indexOf(id + 72))] / 72.;
		apart[k++] = high - low;
		if (energy > 0) EXPECT_TRUE(s.bonds.size() > 0 || s.account().fracture > 10.);
		else EXPECT_EQ(s.bonds.size(), 0u);
	}
	EXPECT_GT(apart[0], apart[1] + 1.);
	EXPECT_GT(apart[1], apart[2] + 1.);
}

TEST(AutomataCohesion, SameBitsOnAnyNumberOfThreads)
{
	std::vector<double> one;
	const int           before = omp_get_max_threads();
	for (int n : { 1, 2, 3 }) {
		omp_set_num_threads(n);
		Solver s;
		halves(s);
		run(s, 300);
		EXPECT_GT(s.bonds.size(), 0u);
		if (one.empty()) one = all(s);
		EXPECT_TRUE(sameBits(one, all(s))) << n;
	}
	omp_set_num_threads(before);
}

TEST(AutomataCohesion, TheAccountChangesNoBit)
{
	Solver with, without;
	halves(with), halves(without, VolumeRule::affine, 5e3, 25., false);
	run(with, 300), run(without, 300);
	EXPECT_TRUE(sameBits(all(with), all(without)));
}

TEST(AutomataCohesion, SaveAndLoadGoOnBitIdentically)
{
	for (VolumeRule rule : { VolumeRule::affine, VolumeRule::inversePower, VolumeRule::meanDistance })
		for (bool integrated : { true, false }) {
			Solver a, b;
			halves(a, rule);
			const double dt = untilOpen(a);
			if (!integrated) a.computeForces();
			const std::string bytes = a.save();
			b.load(bytes);
			EXPECT_EQ(b.save(), bytes);
			run(a, 200, 0.4, dt), run(b, 200, 0.4, dt);
			ASSERT_TRUE(sameBits(all(a), all(b))) << int(rule);
			EXPECT_EQ(a.account().total(), b.account().total());
		}
}

// Who is erased takes its bonds along; the others keep theirs, and momentum stays what it was without what left.
TEST(AutomataCohesion, ErasedOnesTakeTheirBondsAlong)
{
	Solver a;
	halves(a);
	const double           dt   = untilOpen(a);
	const int32_t          gone = a.bonds.first[3];
	std::vector<Automaton> rest;
	const Store&           S = a.store;
	for (int id = 0; id < 144; id++) {
		if (id == gone) continue;
		const size_t i = size_t(a.indexOf(id));
		Automaton    q;
		q.position = S.position.at(i), q.velocity = S.velocity.at(i), q.omega = S.omega[i], q.angle = S.angle[i];
		q.mass = S.mass[i], q.inertia = S.inertia[i], q.diameter = S.diameter[i], q.strength = S.strength[i], q.id = id, q.group = S.group[i];
		rest.push_back(q);
	}
	size_t mine = 0;
	for (size_t q = 0; q < a.bonds.size(); q++) mine += a.bonds.first[q] == gone || a.bonds.second[q] == gone;
	Solver b;
	b.build(rest, a.store.materials, a.options, &a);
	EXPECT_EQ(b.bonds.size(), a.bonds.size() - mine);
	const Account start = b.account();
	run(b, 200, 0.4, dt);
	EXPECT_LT(std::sqrt(plainSquare(b.account().momentum - start.momentum)), 1e-12 * std::sqrt(plainSquare(start.leftMomentum)) + 1e-12);
	EXPECT_LT(std::fabs(b.account().bookedError()), 1e-11 * start.kinetic);
	EXPECT_NEAR(b.account().total(), a.account().kineticStart, 5e-3 * a.account().kineticStart);
}

// Cut by a script: nothing holds on.
TEST(AutomataCohesion, CutPairsHoldNothing)
{
	Solver s;
	halves(s, VolumeRule::affine, 5e3, 1.);
	std::vector<std::pair<int32_t, int32_t>> across;
	for (auto [i, j] : s.links())
		if ((i < 72) != (j < 72)) across.emplace_back(i, j);
	EXPECT_EQ(s.cut(across), across.size());
	run(s, 100);
	EXPECT_EQ(s.counters.brokenLinks, int64_t(across.size()));
	EXPECT_EQ(s.bonds.size(), 0u);
}
