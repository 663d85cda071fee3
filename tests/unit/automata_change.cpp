// SPDX-License-Identifier: GPL-2.0-or-later
// Automata erased and added during a run; saving and loading.
#include "automata_scene.hpp"
using namespace automatatest;

namespace {
constexpr double d = 1e-3;
/// The automata of a solver as input for another, in the order of their numbers; those of `without` left out.
std::vector<Automaton> asInput(const Solver& s, std::vector<int32_t> without = {})
{
	std::vector<Automaton> out;
	const Store&           S = s.store;
	for (int32_t id = 0; id < 1000; id++) {
		const int64_t i = s.indexOf(id);
		if (i < 0 || std::count(without.begin(), without.end(), id)) continue;
		Automaton a;
		a.position[0] = S.position[0][i], a.position[1] = S.position[1][i], a.velocity[0] = S.velocity[0][i], a.velocity[1] = S.velocity[1][i],
		a.omega = S.omega[i], a.angle = S.angle[i];
		a.mass = S.mass[i], a.inertia = S.inertia[i], a.diameter = S.diameter[i], a.weight = S.weight[i], a.strength = S.strength[i],
		a.eqps     = S.eqps[i];
		a.material = S.species[S.speciesOf(i)].material, a.id = id, a.group = S.group[i];
		out.push_back(a);
	}
	return out;
}
Solver rebuilt(const Solver& old, const std::vector<Automaton>& list)
{
	Solver s;
	s.build(list, old.store.materials, old.options, &old);
	return s;
}
double energy(const Solver& s) { return s.account().kinetic + s.account().volumetric + s.account().deviatoric; }
/// A vibrating, pre-compressed block.
Solver block(VolumeRule rule, int nx = 10, int ny = 10)
{
	Material m  = steel();
	m.viscosity = { 0., 0. };
	auto list   = packing(d, nx, ny, m);
	for (auto& a : list) a.velocity[0] = -20e3 * (a.position[0] - 5e-3), a.velocity[1] = 15e3 * (a.position[1] - 4e-3);
	Options o;
	o.volumeRule = rule;
	Solver s;
	s.build(list, { m }, o);
	run(s, 40, 0.2);
	return s;
}
}

TEST(AutomataChange, RebuildingTheSameSetChangesNothing)
{
	for (VolumeRule rule : { VolumeRule::affine, VolumeRule::inversePower, VolumeRule::meanDistance }) {
		Solver a = block(rule);
		Solver b = rebuilt(a, asInput(a));
		run(a, 20, 0.2, 1e-9), run(b, 20, 0.2, 1e-9);
		const auto x = everything(a), y = everything(b);
		ASSERT_EQ(x.size(), y.size());
		double worst = 0;
		for (size_t i = 0; i < a.store.size(); i++)
			if (a.store.id[i] >= 0)
				worst = std::max(worst, std::fabs(a.store.velocity[0][i] - b.store.velocity[0][size_t(b.indexOf(a.store.id[i]))]));
		EXPECT_LT(worst, 1e-9 * 200) << int(rule);
	}
}

TEST(AutomataChange, RebuildingKeepsTheStateMidFracture)
{
	Solver a;
	impact(a, 800.);
	run(a, 120);
	ASSERT_GT(a.counters.brokenLinks, 10);
	Solver b = rebuilt(a, asInput(a));
	EXPECT_EQ(a.links(), b.links());
	run(a, 8, 0.2, 1e-9), run(b, 8, 0.2, 1e-9);
	double worst = 0;
	for (size_t i = 0; i < a.store.size(); i++)
		if (a.store.id[i] >= 0) worst = std::max(worst, std::fabs(a.store.velocity[1][i] - b.store.velocity[1][size_t(b.indexOf(a.store.id[i]))]));
	EXPECT_LT(worst, 1e-3 * 800);
}

// Erasing is a free surface that appears: the volume of those that lose a link must go on, not jump.
TEST(AutomataChange, ErasingKeepsTheVolumeOfItsNeighbours)
{
	for (VolumeRule rule : { VolumeRule::affine, VolumeRule::inversePower, VolumeRule::meanDistance }) {
		Solver       a      = block(rule);
		const double before = energy(a);
		Solver       b      = rebuilt(a, asInput(a, { 44, 45 }));
		b.computeForces();
		for (int32_t id : { 34, 35, 43, 46, 54, 55 })
			EXPECT_NEAR(b.store.J[size_t(b.indexOf(id))], a.store.J[size_t(a.indexOf(id))], 2e-3) << int(rule) << ' ' << id;
		EXPECT_LT(energy(b), before * 1.001) << int(rule);
		run(b, 200, 0.2, 1e-9);
		EXPECT_LT(energy(b), before * 1.01) << int(rule);
	}
}

// A new automaton that continues the packing links to its neighbours like one that was there from the start.
TEST(AutomataChange, AddedAutomatonLinksInItsPlace)
{
	Material m = steel();
	for (VolumeRule rule : { VolumeRule::affine, VolumeRule::inversePower, VolumeRule::meanDistance })
		for (double angle : { 0., 0.7 }) {
			auto    whole = packing(d, 6, 6, m, { 0, 0, angle });
			Options o;
			o.volumeRule = rule;
			for (int32_t missing : { 0, 5, 14, 33 }) {
				auto part = whole;
				part.erase(part.begin() + missing);
				Solver a;
				a.build(part, { m }, o);
				run(a, 2, 0.2, 1e-9);
				Solver b = rebuilt(a, whole);
				Solver c;
				c.build(whole, { m }, o);
				run(c, 2, 0.2, 1e-9); // at rest like a: both go on from the same step
				EXPECT_EQ(b.links(), c.links());
				for (Solver* s : { &b, &c }) { // the same kick to both
					for (size_t i = 0; i < s->store.size(); i++)
						s->store.velocity[0][i] = 10 * std::sin(3e3 * s->store.position[1][i] + s->store.id[i]),
						s->store.velocity[1][i] = 10 * std::cos(2e3 * s->store.position[0][i]);
					s->moved();
					run(*s, 50, 0.2, 1e-9);
				}
				EXPECT_NEAR(energy(b) / energy(c), 1., 1e-6) << int(rule) << ' ' << missing;
				const auto A = b.account();
				EXPECT_NEAR(std::hypot(A.momentum[0] - c.account().momentum[0], A.momentum[1] - c.account().momentum[1]), 0., 1e-6) << missing;
			}
		}
}

TEST(AutomataChange, SaveAndLoadGoOnBitIdentically)
{
	for (VolumeRule rule : { VolumeRule::affine, VolumeRule::inversePower, VolumeRule::meanDistance })
		for (YieldKind kind : { YieldKind::linearHardening, YieldKind::johnsonCook })
			for (bool account : { false, true })
				for (int half : { 1, 37, 120 }) {
					Options o;
					o.volumeRule = rule, o.account = account;
					Solver a, b;
					impact(a, 600., kind, o);
					const double dt = run(a, half);
					const std::string bytes = a.save();
					b.load(bytes);
					EXPECT_EQ(b.save().size(), bytes.size());
					run(a, 60, 0.4, dt), run(b, 60, 0.4, dt);
					ASSERT_TRUE(sameBits(everything(a), everything(b))) << int(rule) << int(kind) << half;
					EXPECT_EQ(a.counters.brokenLinks, b.counters.brokenLinks);
					EXPECT_EQ(a.account().total(), b.account().total());
					if (half == 120) {
						EXPECT_GT(a.counters.brokenLinks, 0);
						EXPECT_GT(a.contacts.size(), 0u);
					}
				}
}
