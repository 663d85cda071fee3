// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies whose outline runs through the centres of their outermost automata: volumes, balances, breaks, automata added and erased, saving.
#include "automata_scene.hpp"
using namespace automatatest;

namespace {
constexpr double d = 1e-3;

/// Gives each automaton the weight of the triangles that its links make; who has none keeps its own. From `first` on.
void endAtOutlines(std::vector<Automaton>& list, const std::vector<Material>& materials, size_t first = 0)
{
	Options o;
	o.contacts = false;
	Solver whole;
	whole.build(list, materials, o);
	const Store& S = whole.store;
	for (size_t q = first; q < list.size(); q++) {
		const size_t    i = size_t(whole.indexOf(list[q].id));
		const Triangles t = trianglesOf(S.flags[i], [&](int k) {
			const size_t j = size_t(S.neighbour[linkSlot(i, k)]);
			return holds(S.flags[j], (k + 2) % nLinks) && S.neighbour[linkSlot(j, (k + 2) % nLinks)] == S.neighbour[linkSlot(i, nextLink(k))];
		});
		if (!t) continue;
		const double w = outlineWeight(t);
		list[q].weight = w, list[q].mass *= w, list[q].inertia *= w, list[q].triangles = triangleCount(t);
	}
}
/// A body with a ragged outline: a random part of a packing at `angle`.
std::vector<Automaton> ragged(const Material& m, double angle, unsigned seed, double keep = 0.8, int n = 9)
{
	auto                                   all = packing(d, n, n, m, { 0.2e-3, -0.4e-3, angle });
	std::vector<Automaton>                 list;
	std::mt19937                           r(seed);
	std::uniform_real_distribution<double> u(0., 1.);
	for (auto& a : all)
		if (u(r) < keep) list.push_back(a);
	endAtOutlines(list, { m });
	return list;
}
int ending(const Solver& s)
{
	int n = 0;
	for (int32_t f : s.store.flags)
		n += trianglesIn(f) != 0;
	return n;
}
/// A tungsten block of triangles hits a steel block of triangles, a spacing above it.
void impactOfOutlines(Solver& s, double speed, YieldKind kind, const Options& o, double fractureStrain = infinite)
{
	Material a = tungsten(), b = steel(kind);
	a.fracture.strain = b.fracture.strain = fractureStrain;
	auto list = packing(d, 6, 18, a, { 9.2e-3, 0., 0. }, 0, 0, 1);
	append(list, packing(d, 24, 9, b, { 0.3e-3, -9 * d, 0.02 }, 200, 1, 2));
	endAtOutlines(list, { a, b });
	for (auto& q : list)
		if (q.material == 0) q.velocity[1] = -speed;
	s.build(list, { a, b }, o);
}
}

TEST(AutomataOutline, EverySetOfTrianglesMeasuresEveryHomogeneousDeformation)
{
	std::mt19937                           r(3);
	std::uniform_real_distribution<double> u(-0.3, 0.3);
	for (Triangles t = 1; t < 1u << nLinks; t++) {
		const Tensor<double> A { 1 + u(r), u(r), u(r), 1 + u(r) };
		Tensor<double>       F = {};
		int                  halves = 0;
		for (int k = 0; k < nLinks; k++) {
			const Vec<double> c = outlineDirection(t, k);
			addDyad(F, c, times(A, k));
			halves += trianglesBeside(t, k);
			if (!trianglesBeside(t, k)) { EXPECT_TRUE(isZero(c)) << t; }
		}
		for (auto [found, meant] : { std::pair(F.xx, A.xx), std::pair(F.xy, A.xy), std::pair(F.yx, A.yx), std::pair(F.yy, A.yy) })
			EXPECT_NEAR(found / Lattice::spread, meant, 1e-14) << t;
		EXPECT_EQ(halves, 2 * triangleCount(t)); // so the weights of the links make the number of triangles
		EXPECT_EQ(outlineWeight(t), triangleCount(t) * (1. / 6.));
		EXPECT_EQ(endsAtOutline(t, outlineWeight(t)), triangleCount(t) < nLinks);
		EXPECT_FALSE(endsAtOutline(t, outlineWeight(t) + 1e-5));
		const int32_t f = withTriangles(linkBits | exposedBit, t);
		EXPECT_EQ(trianglesIn(f), t);
		EXPECT_EQ(withoutTriangles(f), linkBits | exposedBit);
	}
	EXPECT_EQ(trianglesOf(0b000111, [](int) { return true; }), 0b000011u);
	EXPECT_EQ(trianglesOf(linkBits, [](int k) { return k != 4; }), 0b101111u);
	EXPECT_FALSE(endsAtOutline(0, 0.));
}

TEST(AutomataOutline, VolumesAreThoseOfAnyHomogeneousDeformation)
{
	const Material m = steel();
	for (double angle : { 0., 0.35, 1.5707963267948966 })
		for (unsigned seed : { 1u, 2u, 3u }) {
			auto list = ragged(m, angle, seed);
			for (auto& a : list)
				a.velocity = { 0.3 * a.position[0] + 0.15 * a.position[1], -0.2 * a.position[0] - 0.25 * a.position[1] };
			Options o;
			o.contacts = false;
			Solver s;
			s.build(list, { m }, o);
			EXPECT_GT(ending(s), 10);
			s.integrate(1.), s.computeForces();
			const double J = 1.3 * 0.75 + 0.15 * 0.2;
			for (size_t i = 0; i < s.store.size(); i++)
				if (trianglesIn(s.store.flags[i]) || linkCount(s.store.flags[i]) == nLinks) { EXPECT_NEAR(s.store.J[i], J, 1e-12) << i; }
		}
}

TEST(AutomataOutline, MomentaAreKeptThroughImpactAndFracture)
{
	for (YieldKind kind : { YieldKind::elastic, YieldKind::linearHardening, YieldKind::johnsonCook }) {
		Solver s;
		impactOfOutlines(s, 700., kind, {}, 0.1);
		const Account start = s.account();
		double        dt = 0, force = 0, turn = 0;
		for (int k = 0; k < 40; k++) {
			dt = run(s, 10, 0.4, dt);
			s.computeForces();
			const Store& S = s.store;
			Vec<double>  f {};
			double       T = 0, F = 0, M = 0;
			for (size_t i = 0; i < S.size(); i++) {
				if (S.id[i] < 0) continue;
				f += S.force.at(i), F += std::sqrt(plainSquare(S.force.at(i)));
				const double t = plainCross(S.position.at(i), S.force.at(i));
				T += t + S.torque[i], M += std::fabs(t) + std::fabs(S.torque[i]);
			}
			if (F > 0) force = std::max(force, std::sqrt(plainSquare(f)) / F), turn = std::max(turn, std::fabs(T) / M);
			s.integrate(dt);
		}
		EXPECT_GT(s.contacts.size(), 0u);
		EXPECT_LT(force, 1e-14) << int(kind);
		EXPECT_LT(turn, 1e-14) << int(kind);
		const Account end   = s.account();
		const double  scale = std::fabs(start.momentum[1]);
		EXPECT_LT(std::sqrt(plainSquare(end.momentum - start.momentum)), 1e-13 * scale) << int(kind);
		EXPECT_LT(std::fabs(end.angular - start.angular), 1e-12 * scale * 24e-3) << int(kind);
	}
}

TEST(AutomataOutline, EnergiesClose)
{
	for (YieldKind kind : { YieldKind::elastic, YieldKind::perfect, YieldKind::johnsonCook }) {
		double error[2];
		for (int k = 0; k < 2; k++) {
			Options o;
			o.account = true;
			Solver s;
			impactOfOutlines(s, 300., kind, o);
			const double start = s.account().kinetic;
			error[k] = energyDrift(s, 6e-6, k ? 0.1 : 0.4);
			EXPECT_GT(s.contacts.size(), 0u);
			EXPECT_LT(std::fabs(s.account().bookedError()), 1e-10 * start);
		}
		EXPECT_LT(error[0], 1e-3) << int(kind);
		EXPECT_LT(error[1], 2e-4) << int(kind);
	}
	// links of half weight break, and who has lost its volume gets it from contacts: what is lost is booked
	for (double speed : { 200., 400. }) {
		Options o;
		o.account = true;
		Solver s;
		impactOfOutlines(s, speed, YieldKind::perfect, o, 0.1);
		EXPECT_LT(energyDrift(s, 12e-6, 0.1), 3e-3) << speed;
		EXPECT_GT(s.counters.brokenLinks, 10);
	}
}

TEST(AutomataOutline, NoRaggedOutlineFeedsEnergyIn)
{
	Material m  = steel();
	m.viscosity = { 0., 0. };
	for (double angle : { 0., 0.35 })
		for (unsigned seed : { 1u, 2u, 3u, 4u }) {
			auto list = ragged(m, angle, seed, 0.75);
			shake(list, 0.1, seed);
			Options o;
			o.account = true, o.contacts = false;
			Solver s;
			s.build(list, { m }, o);
			const double start = s.account().kinetic;
			for (int k = 0; k < 10; k++) {
				run(s, 1000, 0.9);
				ASSERT_LT(s.account().total(), 1.5 * start) << angle << " " << seed; // single samples: velocities are half a step off
			}
		}
}

TEST(AutomataOutline, ABreakTakesTheTrianglesOfBothEndsAndKeepsTheirVolumes)
{
	Solver s;
	impactOfOutlines(s, 500., YieldKind::perfect, {}, 0.05);
	const int before = ending(s);
	run(s, 400);
	ASSERT_GT(s.counters.brokenLinks, 20);
	EXPECT_LT(ending(s), before);
	for (int32_t f : s.store.flags)
		if (brokenCount(f)) { EXPECT_EQ(trianglesIn(f), 0u); }
}

TEST(AutomataOutline, OfAnotherWeightItIsNoOutline)
{
	const Material m    = steel();
	auto           list = packing(d, 8, 8, m);
	Solver         whole, most;
	whole.build(list, { m }, {});
	EXPECT_EQ(ending(whole), 0);
	endAtOutlines(list, { m });
	for (auto& a : list)
		if (a.position[1] < 0.5 * d) a.weight *= 1.01, a.mass *= 1.01, a.triangles = 0;
	most.build(list, { m }, {});
	EXPECT_EQ(ending(most), 28 - 8);
}

TEST(AutomataOutline, WhatWasMadeToEndAtAnOutlineDoesOrIsRefused)
{
	const Material m    = steel();
	auto           list = packing(d, 8, 8, m);
	endAtOutlines(list, { m });
	const auto says = [&](auto&& change) {
		auto changed = list;
		change(changed);
		return refusal([&] {
			Solver s;
			s.build(changed, { m }, {});
		});
	};
	EXPECT_EQ(says([](auto&) {}), "");
	EXPECT_SAYS(says([](auto& l) { l[9].weight *= 1.001; }), "automaton 9 at");
	EXPECT_SAYS(says([](auto& l) { l.erase(l.begin() + 9); }), "its neighbours make");                          // a hole
	EXPECT_SAYS(says([](auto& l) { l.resize(32); }), "its neighbours make");                                    // a part
	EXPECT_SAYS(says([&](auto& l) { append(l, packing(d, 8, 8, m, { 0, -6.92820323e-3, 0 }, 100)); }), "mask"); // linked to another body
	EXPECT_SAYS(says([](auto& l) { l[3].triangles = 7; }), "must be from 0 to 6");
	EXPECT_EQ(says([](auto& l) {
			  l.resize(32);
			  for (auto& a : l) a.triangles = 0;
		  }),
		  "");
}

TEST(AutomataOutline, WhoseLinksChangeGoesOnWithThem)
{
	Material m  = steel();
	m.viscosity = { 0., 0. };
	auto list = packing(d, 8, 8, m);
	endAtOutlines(list, { m });
	auto part = list;
	part.erase(std::remove_if(part.begin(), part.end(), [](const Automaton& a) { return a.id == 3; }), part.end());
	Solver a, b, c;
	a.build(list, { m }, {});
	const auto triangles = [](const Solver& s, int id) { return trianglesIn(s.store.flags[size_t(s.indexOf(id))]); };
	EXPECT_NE(triangles(a, 2), 0u);
	b.build(part, { m }, {}, &a); // one of the lowest row is erased
	for (int id : { 2, 4 }) EXPECT_EQ(triangles(b, id), 0u) << id;
	EXPECT_EQ(triangles(b, 7), triangles(a, 7));
	c.build(list, { m }, {}, &b); // and comes back
	EXPECT_EQ(triangles(c, 2), 0u);
	EXPECT_EQ(triangles(c, 7), triangles(a, 7));
	const Store& S = c.store;
	for (size_t i = 0; i < S.size(); i++)
		for (int k = 0; k < nLinks; k++)
			if (holds(S.flags[i], k)) { // a link counts the same at both ends
				const size_t j = size_t(S.neighbour[linkSlot(i, k)]);
				EXPECT_EQ(linkWeight(S.flags[i], k), linkWeight(S.flags[j], Lattice::opposite(k))) << S.id[i] << " " << S.id[j];
			}
	c.computeForces();
	for (int id = 0; id < 64; id++) EXPECT_NEAR(c.store.J[size_t(c.indexOf(id))], 1., 1e-14) << id;
}

TEST(AutomataOutline, IsSavedAndLoaded)
{
	Solver s, t;
	impactOfOutlines(s, 500., YieldKind::linearHardening, {}, 0.1);
	run(s, 300);
	t.load(s.save());
	EXPECT_GT(ending(t), 10);
	run(s, 50, 0.4, 1e-9), run(t, 50, 0.4, 1e-9);
	EXPECT_TRUE(sameBits(everything(s), everything(t)));
}
