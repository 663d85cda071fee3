// SPDX-License-Identifier: GPL-2.0-or-later
// Made-up states: bytes of a saved state are changed at random, as by someone who also makes the checksum right again. Each is refused, and then nothing has
// changed, or it is a state, with which steps can be made; no byte reaches memory. Made to be run under the address sanitizer, too.
#include "../unit/automata_scene.hpp"
#include "../unit/grid_scene.hpp"
#include "interface/map.hpp"
#include <functional>

namespace {
constexpr int tries = 3000; ///< per scene

struct Dice {
	std::mt19937_64 random;
	explicit Dice(uint64_t seed)
		: random(seed)
	{
	}
	size_t below(size_t n) { return size_t(random() % n); }
	/// Bytes that have upset readers before: limits of integers, numbers that are none, lengths, indices just outside.
	uint64_t word()
	{
		static const double numbers[] = {
			0., -0., -1., 1e300, -1e300, 1e-300, 1e160, 1., std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()
		};
		static const int64_t integers[] = { -1,
			                            0,
			                            1,
			                            2,
			                            3,
			                            63,
			                            64,
			                            65,
			                            255,
			                            256,
			                            1 << 20,
			                            1 << 28,
			                            0x7fffffff,
			                            0x80000000,
			                            0xffffffff,
			                            int64_t(1) << 33,
			                            int64_t(1) << 40,
			                            INT64_MAX,
			                            INT64_MIN };
		uint64_t             w;
		switch (below(3)) {
			case 0: std::memcpy(&w, &numbers[below(10)], 8); return w;
			case 1: return uint64_t(integers[below(19)]);
			default: return random();
		}
	}
	template <class Bytes> void damage(Bytes& b)
	{
		const size_t kind = below(10);
		if (kind < 3) // a few bytes
			for (size_t k = 0, n = 1 + below(3); k < n; k++) b[below(b.size())] = char(random());
		else if (kind < 5)
			b[below(b.size())] ^= char(1 << below(8));
		else if (kind < 8) { // a word of 4 or 8 bytes where words stand
			const uint64_t w = word();
			const size_t   n = below(2) ? 8 : 4, at = below(b.size() / 4) * 4;
			std::memcpy(&b[std::min(at, b.size() - n)], &w, n);
		} else if (kind == 8)
			b.resize(below(b.size()));
		else
			b.insert(b.begin() + long(below(b.size())), 1 + below(16), char(random()));
	}
};

/// All damages of one state. run: steps with what was accepted; may throw.
template <class Bytes> void damages(const char* name, const Bytes& whole, uint64_t seed, const std::function<bool(const Bytes&)>& accept)
{
	Dice dice(seed);
	int  accepted = 0;
	for (int k = 0; k < tries; k++) {
		Bytes bytes = whole;
		dice.damage(bytes);
		accepted += accept(bytes);
	}
	std::printf("%-28s %6zu bytes, %d damages, %d accepted as states\n", name, whole.size(), tries, accepted);
	EXPECT_TRUE(accept(whole)) << "the undamaged state";
	EXPECT_LT(accepted, tries);
}
} // namespace

namespace {
using namespace automatatest;

void automata(const char* name, Solver& s, uint64_t seed)
{
	const std::string whole = s.save();
	Solver            other;
	impact(other, 100.);
	const std::string kept = other.save();
	int               left = 20; // the comparison costs more than the load
	damages<std::string>(name, whole, seed, [&](const std::string& bytes) {
		Solver t;
		try {
			t.load(bytes);
		} catch (const Error&) {
			if (left-- > 0) {
				EXPECT_THROW(other.load(bytes), Error);
				EXPECT_EQ(other.save(), kept);
			}
			return false;
		}
		try {
			t.checkOrder(t.ids());
			t.account();
			t.links();
			for (size_t i = 0; i < t.store.size(); i += 7) t.equivalentStress(i);
			for (int k = 0; k < 6; k++) {
				t.computeForces();
				t.integrate(std::min(0.4 * t.criticalStep(), 1.));
			}
			t.moved(); // a search, too
			t.computeForces();
		} catch (const Error&) { // a wrong number may end the run
		}
		t.save();
		return true;
	});
}

TEST(Damage, AutomataWithContactsAndBrokenLinks)
{
	Solver  s;
	Options o;
	o.account = true;
	impact(s, 600., YieldKind::linearHardening, o, 0.02);
	run(s, 60);
	ASSERT_GT(s.contacts.size(), 0u);
	ASSERT_GT(s.counters.brokenLinks, 0);
	automata("contacts, broken links", s, 1);
}
TEST(Damage, AutomataOfAllKinds)
{
	Material a = steel(YieldKind::johnsonCook), b = tungsten();
	a.eos.kind                  = EosKind::mieGruneisen;
	std::vector<Automaton> list = packing(1e-3, 9, 9, a, {}, 0, 0, 1);
	append(list, packing(1e-3, 6, 6, b, { 1e-3, -6e-3, 0. }, 100, 1, 2));
	shake(list, 50., 3);
	list[0].free[0] = list[0].freeR = false;
	Solver s;
	s.build(list, { a, b }, {});
	s.setDamping(size_t(s.indexOf(5)), { 1e5, 1e4 });
	s.tie(size_t(s.indexOf(8)), true), s.tie(size_t(s.indexOf(9)));
	s.addForce(size_t(s.indexOf(20)), { 1e3, 1e3 }, 0.);
	run(s, 20);
	automata("damping, ties, heat", s, 2);
}
TEST(Damage, AutomataBeforeTheFirstStepAndAfterAChange)
{
	Material m = steel();
	Solver   s, t;
	Options  o;
	o.volumeRule = VolumeRule::meanDistance;
	auto list    = packing(1e-3, 8, 8, m);
	s.build(list, { m }, o);
	automata("before the first step", s, 3);
	shake(list, 300., 1);
	s.build(list, { m }, o);
	run(s, 40);
	list.pop_back();
	t.build(list, { m }, o, &s);
	automata("after an automaton was erased", t, 4);
}
TEST(Damage, AutomataThatWereStopped)
{
	Solver s;
	impact(s, 300.);
	run(s, 5);
	s.store.force[0][3] = std::numeric_limits<double>::quiet_NaN();
	EXPECT_THROW(s.integrate(1e-9), Error);
	automata("stopped by a number", s, 5);
	Solver t;
	t.load(s.save());
	EXPECT_THROW(t.integrate(1e-9), Error) << "the file of a run that was stopped is stopped as well";
}
TEST(Damage, OrderOfBodiesBelongsToTheSolver)
{
	Solver s;
	impact(s, 300.);
	std::vector<int> order = s.ids();
	EXPECT_NO_THROW(s.checkOrder(order));
	order[10] = 500000;
	EXPECT_SAYS(refusal([&] { s.checkOrder(order); }), "damaged or was edited");
	order.pop_back();
	EXPECT_THROW(s.checkOrder(order), Error);
}
} // namespace

namespace {
using gridtest::addSkew;
using gridtest::line;
using mca::grid::BlockOptions;
using mca::grid::Grid;
using mca::grid::GridOptions;
using mca::grid::Side;
using mca::grid::Table;

void grids(const char* name, const Grid& g, uint64_t seed)
{
	const std::vector<char> whole = g.save();
	Grid                    other;
	other.addRectangle(gridtest::steel(), line(0, 1, 3), line(0, 1, 3));
	const std::vector<char> kept = other.save();
	int                     left = 20;
	damages<std::vector<char>>(name, whole, seed, [&](const std::vector<char>& bytes) {
		Grid t;
		try {
			t.restore(bytes);
		} catch (const mca::Error&) {
			if (left-- > 0) {
				EXPECT_THROW(other.restore(bytes), mca::Error);
				EXPECT_EQ(other.save(), kept);
			}
			return false;
		}
		try {
			t.energy(), t.awakeFraction(), t.criticalCell(), t.probeLine(0, 0, 1, 1, 5);
			for (int k = 0; k < 6; k++) t.step(std::min(0.5 * t.criticalTimeStep(), 1.));
		} catch (const mca::Error&) {
		}
		t.save();
		return true;
	});
}

TEST(Damage, GridWithBoundariesAndGauges)
{
	Grid     g;
	Material m = gridtest::steel(YieldKind::johnsonCook), n = gridtest::steel(YieldKind::linearHardening);
	m.eos.kind = EosKind::mieGruneisen;
	BlockOptions edges;
	edges.edgeViscosity = true;
	g.addRectangle(m, line(0, 0.02, 20), line(0, 0.01, 34));
	g.addRectangle(n, line(0.02, 0.03, 10), line(0, 0.01, 34), edges);
	g.openInteriorNode(0, 5, 6);
	g.openInteriorNode(0, 9, 6);
	g.symmetry(0, Side::bottom);
	g.viscous(1, Side::right);
	g.pressureLoad(0, Side::top, Table({ 0, 1e-6 }, { 0, 1e9 }));
	g.traction(1, Side::top, 1e6, 2e6);
	g.nodalForce({ g.openNode(0, 5, 6) }, 1e3, 0);
	g.fix({ g.openNode(0, 9, 6) }, true, true);
	g.setVelocity(0, [](double, double) { return std::array<double, 2> { 200., 10. }; });
	g.addGauge(0.0101, 0.005, 3);
	for (int k = 0; k < 12; k++) g.step(0.5 * g.criticalTimeStep());
	grids("grid, all boundaries", g, 1);
	g.computeForces(0.4 * g.criticalTimeStep());
	grids("grid, between the halves", g, 2);
}
TEST(Damage, GridBeforeBuildAndStopped)
{
	Grid g;
	addSkew(g, gridtest::steel(), 12, 8, 1, 1, 0.1, 1);
	g.openInteriorNode(0, 3, 3);
	grids("grid, not built", g, 3);
	g.build();
	grids("grid, at rest", g, 4);
	Grid h; // a node is carried across its neighbours
	h.addRectangle(gridtest::steel(YieldKind::perfect), line(0, 0.01, 10), line(0, 0.01, 10));
	h.prescribe(h.sideNodes(0, Side::left, 5, 5), 1, 0, Table({ 0., 1e-6, 1.001e-6 }, { 0., 0., 1e6 }));
	EXPECT_THROW(
		{
			for (int k = 0; k < 100; k++) h.step(0.3 * h.criticalTimeStep());
		},
		mca::Error);
	grids("grid, stopped", h, 5);
}
TEST(Damage, RowOfTheInterface)
{
	using mca::interface::Carried;
	std::vector<Carried> row;
	for (int k = 0; k < 9; k++) row.push_back({ k, k / 2, k / 2 + 1, 0.25, 0.75, 0., 0., 1. });
	EXPECT_NO_THROW(mca::interface::checkRow(row, 6));
	EXPECT_THROW(mca::interface::checkRow(row, 5), mca::Error);
	Dice dice(1);
	for (int k = 0; k < tries; k++) {
		auto           bad = row;
		auto*          p   = reinterpret_cast<char*>(bad.data());
		const uint64_t w   = dice.word();
		std::memcpy(p + dice.below(bad.size() * sizeof(Carried) / 8) * 8, &w, 8);
		try {
			mca::interface::checkRow(bad, 6);
		} catch (const mca::Error&) {
			continue;
		}
		for (const Carried& c : bad) {
			ASSERT_TRUE(c.a >= 0 && c.a < 6 && c.b >= 0 && c.b < 6 && c.id >= 0);
			ASSERT_TRUE(std::isfinite(c.Na + c.Nb + c.rx + c.ry + c.mass));
		}
	}
}
} // namespace
