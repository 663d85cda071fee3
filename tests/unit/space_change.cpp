// SPDX-License-Identifier: GPL-2.0-or-later
// Automata in space: unlike materials in one body, laws that heat, automata erased and added during a run.
#include "space_scene.hpp"
using namespace spacetest;

namespace {
Material copper()
{
	Material m  = steel();
	m.eos.rho0 = 8930., m.eos.c0 = 3940., m.G = 47e9, m.yield.yieldStress = 0.09e9;
	return m;
}
std::vector<Automaton> asInput(const Solver& s, const std::vector<int>& without = {})
{
	std::vector<Automaton> out;
	const Store&           S = s.store;
	for (int id : s.ids()) {
		if (std::count(without.begin(), without.end(), id)) continue;
		const size_t i = size_t(s.indexOf(id));
		Automaton    a;
		a.position = S.position.at(i), a.velocity = S.velocity.at(i), a.omega = S.omega.at(i), a.angle = S.angle.at(i);
		a.mass = S.mass[i], a.inertia = S.inertia[i], a.diameter = S.diameter[i], a.weight = S.weight[i], a.strength = S.strength[i];
		a.eqps     = S.eqps[i];
		a.material = S.species[S.speciesOf(i)].material, a.id = id, a.group = S.group[i];
		out.push_back(a);
	}
	return out;
}
double length(Vec<double> a) { return std::sqrt(plainSquare(a)); }
}

TEST(SpaceChange, UnlikeMaterialsInOneBodyKeepMomentumAndBookTheirEnergy)
{
	for (double viscosity : { 0., 0.5 }) {
		Material a = steel(), b = copper();
		a.viscosity = b.viscosity = { viscosity, 4. * viscosity };
		std::mt19937 r(3);
		auto         list = packing(1e-3, 7e-3, randomRotation(r), a, ellipsoid(5e-3, 4e-3, 3e-3));
		for (auto& q : list)
			if (q.position[0] > 0) q.material = 1, q.mass *= b.eos.rho0 / a.eos.rho0, q.inertia *= b.eos.rho0 / a.eos.rho0;
		shake(list, 60., 4);
		Options o;
		o.account = true, o.contacts = false;
		Solver s;
		s.build(list, { a, b }, o);
		const Account start = s.account();
		run(s, 400);
		const Account end = s.account();
		double        p   = 0;
		for (auto& q : list) p += q.mass * length(q.velocity);
		EXPECT_LT(length(end.momentum - start.momentum), 1e-13 * p);
		EXPECT_LT(length(end.angular - start.angular), 1e-13 * p * 5e-3);
		EXPECT_LT(std::fabs(end.bookedError()), 1e-12 * start.kinetic);
		EXPECT_LT(std::fabs(end.total() / start.kinetic - 1.), 0.02) << viscosity;
		EXPECT_GT(end.plastic, 0.);
		std::cout << "viscosity " << viscosity << ": independent sum " << end.total() / start.kinetic - 1. << ", booked "
		          << end.bookedError() / start.kinetic << ", plastic " << end.plastic / start.kinetic
		          << ", coupling " << end.coupling / start.kinetic << "\n";
	}
}

TEST(SpaceChange, HotMaterialsKeepTheirEnergy)
{
	Material m = steel();
	m.eos.kind = EosKind::mieGruneisen;
	m.yield.kind = YieldKind::johnsonCook, m.yield.hardeningModulus = 0.51e9, m.yield.hardeningExponent = 0.26, m.yield.rateCoefficient = 0.014,
	m.yield.thermalSoftening = 1.03, m.yield.meltTemperature = 1793., m.yield.heatPerWork = 0.9 / (7830. * 477.);
	m.fracture.strain = 0.5;
	auto list = packing(1e-3, 4e-3, straight(), m, ellipsoid(3.1e-3, 3.1e-3, 3.1e-3), 0, 0, 1);
	for (auto& q : list) q.position[2] += 6.2e-3, q.velocity[2] = -900.;
	append(list, packing(1e-3, 7e-3, axesTo({ 1, 1, 1 }, { 1, -1, 0 }), m, box(6e-3, 6e-3, 2.2e-3), 1000, 0, 2));
	Options o;
	o.account = true;
	Solver s;
	s.build(list, { m }, o);
	const Account start = s.account();
	double        drift = 0, dt = 0;
	for (int k = 0; k < 30; k++) {
		dt    = run(s, 10, 0.3, dt);
		drift = std::max(drift, std::fabs(s.account().total() / start.kinetic - 1.));
	}
	const Account end = s.account();
	EXPECT_GT(end.heated, 0.);
	EXPECT_LT(drift, 0.02);
	EXPECT_LT(std::fabs(end.bookedError()), 1e-12 * start.kinetic);
	double hottest = 0;
	for (double T : s.store.temperature) hottest = std::max(hottest, T);
	EXPECT_GT(hottest, 350.);
	std::cout << "independent sum " << drift << ", hottest " << hottest << " K, broken " << s.counters.brokenLinks << "\n";
}

TEST(SpaceChange, RebuildingTheSameSetChangesNothing)
{
	Solver a, b;
	impact(a, 800.);
	const double dt = run(a, 100);
	ASSERT_GT(a.counters.brokenLinks, 10);
	a.computeForces(); // the strain of the last move
	b.build(asInput(a), a.store.materials, a.options, &a);
	EXPECT_EQ(a.links(), b.links());
	for (int k = 0; k < 20; k++)
		for (Solver* s : { &a, &b }) s->computeForces(), s->integrate(0.5 * dt);
	double worst = 0;
	for (int id : a.ids()) {
		const size_t i = size_t(a.indexOf(id)), j = size_t(b.indexOf(id));
		worst = std::max(worst, length(a.store.velocity.at(i) - b.store.velocity.at(j)));
	}
	EXPECT_LT(worst, 1e-6 * 800.);
	std::cout << "largest difference of velocities " << worst << " m/s\n";
}

TEST(SpaceChange, ErasingMostOfABodyKeepsTheSumOfEnergies)
{
	Material m = plain(0.48);
	auto     list = packing(1., 5., straight(), m, box(3., 3., 3.));
	shake(list, 1e-3, 2);
	Options o;
	o.account = true, o.contacts = false;
	Solver a, b;
	a.build(list, { m }, o);
	run(a, 50);
	std::vector<int> gone;
	for (auto& q : list)
		if (q.id % 3 != 0) gone.push_back(q.id);
	b.build(asInput(a, gone), { m }, o, &a);
	int without = 0; // of those that had a volume by their links
	for (size_t i = 0; i < b.store.size(); i++) without += b.store.id[i] >= 0 && !(b.store.factor[i] > 0.);
	EXPECT_GT(without, 10);
	EXPECT_NEAR(b.account().total() - b.account().kineticStart, a.account().total() - a.account().kineticStart, 1e-12 * a.account().kinetic);
}

TEST(SpaceChange, ErasingWhereOthersAreInContactKeepsTheSumOfEnergies)
{
	Options o;
	o.account = true;
	Solver a, b;
	impact(a, 500., o, 1e9);
	run(a, 150);
	const size_t far = size_t(std::max_element(a.store.position[0].begin(), a.store.position[0].end()) - a.store.position[0].begin());
	b.build(asInput(a, { a.store.id[far] }), a.store.materials, o, &a);
	EXPECT_GT(a.contacts.size(), 20u);
	const auto   sum = [](const Solver& s) { return s.account().total() - s.account().kineticStart; };
	const double small = 1e-5 * a.account().kineticStart;
	EXPECT_NEAR(sum(b), sum(a), 1e-9 * small);
	run(a, 1), run(b, 1);
	EXPECT_NEAR(sum(b), sum(a), small);
}

TEST(SpaceChange, ErasingAndAddingKeepsTheRest)
{
	Material m = plain(0.48);
	auto     list = packing(1., 5., axesTo({ 1, 2, 3 }, { 2, -1, 0 }), m, box(3., 3., 3.));
	shake(list, 1e-4, 2);
	Options o;
	o.account = true;
	Solver a, b, c;
	a.build(list, { m }, o);
	run(a, 50);
	std::vector<int> gone;
	for (auto& q : list)
		if (q.position[0] > 2.) gone.push_back(q.id);
	b.build(asInput(a, gone), { m }, o, &a);
	EXPECT_LT(b.links().size(), a.links().size());
	run(b, 50);
	auto back = asInput(b);
	for (auto& q : list)
		if (std::count(gone.begin(), gone.end(), q.id)) back.push_back(q), back.back().isNew = true, back.back().velocity = back.back().omega = {};
	c.build(back, { m }, o, &b);
	EXPECT_EQ(c.links().size(), a.links().size()); // new ones are linked in the frame of the old
	run(c, 50);
	EXPECT_LT(std::fabs(c.account().bookedError()), 1e-12 * a.account().kinetic);
}
