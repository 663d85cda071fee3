// SPDX-License-Identifier: GPL-2.0-or-later
// The search for contacts: who is found, and when it is due.
#include "automata_scene.hpp"
#include "automata/cell_grid.hpp"

using namespace automatatest;

namespace {
/// A block at rest, fragments of one automaton each that fly at it, and one that flies away from all.
std::vector<Automaton> cloud(unsigned seed, int fragments, double speed)
{
	const Material                         m = steel(YieldKind::perfect);
	auto                                   list = packing(1e-3, 12, 6, m);
	std::mt19937                           r(seed);
	std::uniform_real_distribution<double> u(0., 1.);
	for (int k = 0; k < fragments; k++) {
		auto one = packing(1e-3, 1, 1, m, { 1e-3 * (1.3 * k), 1e-3 * (7. + 3. * u(r)), 0. }, int(list.size()), 0, 2 + k);
		one[0].velocity[0] = 0.2 * speed * (u(r) - 0.5), one[0].velocity[1] = -speed * (0.5 + u(r));
		append(list, one);
	}
	auto away = packing(1e-3, 1, 1, m, { -0.2, 0.1, 0. }, int(list.size()), 0, 99);
	away[0].velocity[0] = -8. * speed;
	append(list, away);
	return list;
}
/// The list of contacts, and all else.
std::vector<double> listed(const Solver& s)
{
	const Contacts&     C = s.contacts;
	std::vector<double> v = everything(s);
	for (auto list : { &C.owner, &C.other, &C.reverse, &C.rowOwner, &C.rowBegin }) v.insert(v.end(), list->begin(), list->end());
	for (auto list : { &C.d, &C.twoG, &C.friction, &C.viscLinear, &C.viscQuadratic, &C.arm, &C.perTwoG, &C.perOwnG })
		v.insert(v.end(), list->begin(), list->end());
	v.push_back(double(s.counters.searches)), v.push_back(double(s.counters.localSearches)), v.push_back(s.criticalStep());
	return v;
}
/// Pairs closer than their rest distance that may touch, are not linked and not listed.
int overlooked(const Solver& s)
{
	const Store& S = s.store;
	std::vector<std::pair<int32_t, int32_t>> known;
	for (size_t c = 0; c < s.contacts.size(); c++) known.push_back({ s.contacts.owner[c], s.contacts.other[c] });
	for (size_t i = 0; i < S.size(); i++)
		for (int k = 0; k < nLinks; k++)
			if (holds(S.flags[i], k)) known.push_back({ int32_t(i), S.neighbour[linkSlot(i, k)] });
	std::sort(known.begin(), known.end());
	int missing = 0;
	for (int32_t i = 0; i < int32_t(S.size()); i++)
		for (int32_t j = 0; j < int32_t(S.size()); j++)
			if (i != j && S.id[i] >= 0 && S.id[j] >= 0 && S.distance2(i, j) < sqr(S.restDistance(i, j))
			    && mayTouch(S.flags[i], S.flags[j], S.group[i] == S.group[j]))
				missing += !std::binary_search(known.begin(), known.end(), std::pair<int32_t, int32_t>(i, j));
	return missing;
}
Solver of(const std::vector<Automaton>& list, double skin)
{
	Options o;
	o.skin = skin;
	Solver s;
	s.build(list, { steel(YieldKind::perfect) }, o);
	return s;
}
}

// What has got inside a body meets the automata there, though they are no rim and the rim is far away.
TEST(AutomataSearch, WhatIsInsideABodyIsFound)
{
	const Material m = steel(YieldKind::perfect);
	auto           list = packing(1e-3, 30, 30, m);
	const double   between = 15.5e-3, height = (14. + 1. / 3.) * 0.86602540378443864676e-3; // among three automata
	auto           shot = packing(1e-3, 1, 1, m, { between, height, 0. }, int(list.size()), 0, 2);
	shot[0].velocity[0] = 300.;
	append(list, shot);
	double found[2];
	for (double skin : { 0.4, 4. }) {
		Solver s = of(list, skin);
		run(s, 400, 0.4, 4e-8);
		const size_t i   = size_t(s.indexOf(shot[0].id));
		found[skin > 1.] = s.store.position[0][i];
		EXPECT_LT(found[skin > 1.], between + 1e-3); // 5 mm, if nothing stopped it
	}
	EXPECT_NEAR(found[0], found[1], 1e-12);
}

// How far beyond touching pairs are listed changes how often they are searched, and nothing else.
TEST(AutomataSearch, ContactsDoNotDependOnTheRangeOfTheSearch)
{
	for (unsigned seed : { 1u, 2u, 3u }) {
		const auto list = cloud(seed, 8, 300.);
		Solver     narrow = of(list, 0.1), usual = of(list, 0.4), wide = of(list, 2.);
		double     moved = 0;
		for (int k = 0; k < 1500; k++)
			for (Solver* s : { &narrow, &usual, &wide }) run(*s, 1, 0.4, 4e-8);
		EXPECT_GT(narrow.counters.searches, usual.counters.searches);
		EXPECT_GT(usual.counters.searches, wide.counters.searches);
		for (const Automaton& a : list) {
			const size_t i = size_t(usual.indexOf(a.id));
			for (const Solver* s : { &narrow, &wide }) {
				const size_t j = size_t(s->indexOf(a.id));
				for (int c = 0; c < dim; c++) {
					EXPECT_NEAR(s->store.position[c][j], usual.store.position[c][i], 1e-15) << seed << ' ' << a.id;
					EXPECT_NEAR(s->store.velocity[c][j], usual.store.velocity[c][i], 1e-9) << seed << ' ' << a.id;
				}
			}
			if (a.group == 1) moved = std::max(moved, std::fabs(usual.store.velocity[1][i]));
		}
		EXPECT_GT(moved, 10.); // they have hit
	}
}

TEST(AutomataSearch, OneFastFragmentMakesNoNewSearchForAll)
{
	auto   list = cloud(1, 0, 300.); // 2400 m/s away from a block at rest
	Solver s    = of(list, 0.4);
	run(s, 500, 0.4, 4e-8);
	const double flown = std::fabs(s.store.position[0][size_t(s.indexOf(list.back().id))] + 0.2);
	EXPECT_GT(flown, 30e-3);
	EXPECT_LT(double(s.counters.searches), 3. + flown / 2.9e-3); // every 3 diameters, where 0.4 are the range
}

TEST(AutomataSearch, CellsHoldWhoIsInThem)
{
	std::mt19937                           r(5);
	std::uniform_real_distribution<double> u(-1., 1.);
	Vectors                                points;
	std::vector<int32_t>                   names;
	for (int k = 0; k < 300; k++) {
		Vec<double> x {};
		for (int c = 0; c < dim; c++) x[c] = u(r);
		points.push_back(x), names.push_back(1000 + k);
	}
	const CellGrid grid(points, names, 0.2);
	EXPECT_LE(grid.inv, 5.);
	for (int k = 0; k < 300; k++) {
		std::vector<int32_t> near, found;
		for (int j = 0; j < 300; j++)
			if (plainSquare(points.at(j) - points.at(k)) < sqr(0.2)) near.push_back(1000 + j);
		grid.eachRunAround(points.at(k), [&](size_t first, size_t last) {
			for (int32_t p = grid.begin[first]; p < grid.begin[last + 1]; p++)
				if (plainSquare(grid.position.at(p) - points.at(k)) < sqr(0.2)) found.push_back(grid.item[p]);
			return false;
		});
		std::sort(found.begin(), found.end());
		EXPECT_EQ(found, near);
	}
	Vec<double> far {};
	far[0] = 1.5;
	EXPECT_TRUE(grid.away(far));
	EXPECT_FALSE(grid.away(Vec<double> {}));
}

// What breaks adds its own pairs to the list: the same list and the same motion, bit by bit, as when all rows are made anew, also from a saved state.
TEST(AutomataSearch, BreaksAddWhatAWholeListWouldHold)
{
	for (int scene = 0; scene < 4; scene++) {
		Options o;
		o.account = scene == 1, o.sleeping = scene != 2;
		if (scene == 3) o.volumeRule = VolumeRule::inversePower;
		Solver local, whole, loaded;
		for (Solver* s : { &local, &whole }) impact(*s, 900. + 300. * scene, YieldKind::linearHardening, o, 0.15, 7 + unsigned(scene));
		whole.wholeLists = true;
		double dt = 0;
		for (int k = 0; k < 600; k++) {
			if (k == 300) loaded.load(local.save()), loaded.wholeLists = scene == 1;
			for (Solver* s : { &local, &whole, &loaded })
				if (s != &loaded || k >= 300) s->computeForces();
			if (k % 40 == 0) { EXPECT_EQ(overlooked(local), 0) << scene << ' ' << k; }
			ASSERT_TRUE(sameBits(listed(local), listed(whole))) << scene << ' ' << k;
			if (k >= 300) { ASSERT_TRUE(sameBits(listed(local), listed(loaded))) << scene << ' ' << k; }
			dt = dt > 0 ? std::min(0.4 * local.criticalStep(), 1.1 * dt) : 0.4 * local.criticalStep();
			for (Solver* s : { &local, &whole, &loaded })
				if (s != &loaded || k >= 300) s->integrate(dt);
		}
		EXPECT_GT(local.counters.localSearches, 20) << scene;
		EXPECT_GT(local.counters.brokenLinks, 100) << scene;
	}
}
