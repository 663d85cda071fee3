// SPDX-License-Identifier: GPL-2.0-or-later
// Bad input ends in one clear error that names the place, and nothing is lost.
#include "grid_scene.hpp"
#include <algorithm>
#include <cstring>
using namespace gridtest;

namespace {
template <class F> std::string refusal(F&& f)
{
	try {
		f();
	} catch (const Error& e) {
		return e.what();
	}
	return "";
}
#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)
}

TEST(GridErrors, TooLargeStepNamesBlockCellAndLimitAndNothingMoves)
{
	Grid g;
	BlockOptions o;
	o.name = "plate";
	g.addRectangle(steel(), gradedLine(0, 0.02, 1e-3, 0.5e-3), line(0, 0.01, 10), o);
	g.setVelocity(0, [](double x, double) { return std::array<double, 2> { 10 * x, 0 }; });
	const auto        before = everything(g);
	const double      limit  = g.criticalTimeStep();
	const std::string s      = refusal([&] { g.step(1.1 * limit); });
	EXPECT_SAYS(s, "plate");
	EXPECT_SAYS(s, "cell (");
	std::ostringstream number;
	number.precision(9);
	number << limit;
	EXPECT_SAYS(s, number.str());
	EXPECT_TRUE(sameBits(before, everything(g)));
	g.step(limit); // and it goes on
	for (const double dt : { 0., -1e-9, std::nan(""), double(INFINITY) }) EXPECT_SAYS(refusal([&] { g.step(dt); }), "time step");
	EXPECT_EQ(g.steps(), 1);
}

TEST(GridErrors, BadBlocks)
{
	Grid g;
	EXPECT_SAYS(refusal([&] { g.build(); }), "no block");
	EXPECT_SAYS(refusal([&] { g.addRectangle(steel(), { 0., 1. }, { 1., 0. }); }), "cell (0, 0)");
	EXPECT_SAYS(refusal([&] { g.addRectangle(steel(), { 0., 1., 1. }, { 0., 1. }); }), "cell (1, 0)");
	EXPECT_SAYS(refusal([&] { g.addRectangle(steel(), { 0. }, { 0., 1. }); }), "at least 1 x 1");
	EXPECT_SAYS(refusal([&] { g.addRectangle(steel(), { 0., std::nan("") }, { 0., 1. }); }), "node (1, 0)");
	EXPECT_SAYS(refusal([&] { g.addBlock(steel(), 2, 2, { 0. }, { 0. }); }), "9 nodes");
	Material m = steel();
	m.eos.rho0 = -1;
	EXPECT_SAYS(refusal([&] { g.addRectangle(m, { 0., 1. }, { 0., 1. }); }), "density");
	EXPECT_EQ(g.blocks(), 0);
	g.addRectangle(steel(), line(0, 1, 4), line(0, 1, 4));
	g.addRectangle(steel(), line(1, 2, 4), line(0, 1, 5));
	EXPECT_SAYS(refusal([&] { g.build(); }), "share their nodes");
}

TEST(GridErrors, OverlappingBoundaryConditions)
{
	Grid g;
	g.addRectangle(steel(), line(0, 1, 4), line(0, 1, 4));
	g.fix(g.sideNodes(0, Side::left), true, true);
	g.fix(g.sideNodes(0, Side::bottom), true, true); // the same at the corner: fine
	EXPECT_SAYS(refusal([&] { g.prescribe(g.sideNodes(0, Side::left), 1, 0, Table(3.)); }), "overlapping");
	EXPECT_SAYS(refusal([&] { g.viscous(0, Side::left); }), "overlapping");
	g.viscous(0, Side::right, 1);
	EXPECT_SAYS(refusal([&] { g.traction(0, Side::right, Table(1.), Table(0.)); }), "overlapping");
	EXPECT_SAYS(refusal([&] { g.fix(g.sideNodes(0, Side::right), true, false); }), "cell (3,");
	g.pressureLoad(0, Side::top, Table(1.));
	EXPECT_SAYS(refusal([&] { g.pressureLoad(0, Side::top, Table(2.)); }), "overlapping");
	EXPECT_SAYS(refusal([&] { g.sideNodes(0, Side::top, 2, 9); }), "nodes 0 to 4");
	EXPECT_SAYS(refusal([&] { g.fix({ 999 }, true, false); }), "no open node 999");
	EXPECT_SAYS(refusal([&] { g.prescribe({ 0 }, 1, 0, Table({ 0., 0. }, { 1., 2. })); }), "times must rise");
	EXPECT_SAYS(refusal([&] { g.pressureLoad(0, Side::bottom, Table(std::nan(""))); }), "not finite");
	EXPECT_SAYS(refusal([&] { g.addNodeMass(0, -1.); }), "not negative");
	EXPECT_SAYS(refusal([&] { g.addGauge(5, 5); }), "outside");
	EXPECT_SAYS(refusal([&] { g.sideNodes(7, Side::top); }), "no block 7");
}

TEST(GridErrors, CellTurnedInsideOutIsNamedAndTheStateStaysFiniteAndSavable)
{
	Grid g;
	BlockOptions o;
	o.name = "soft";
	g.addRectangle(steel(YieldKind::perfect), line(0, 0.01, 10), line(0, 0.01, 10), o);
	// a jump of the prescribed velocity carries a node across its neighbours within one step, which no limit on the step can foresee
	g.prescribe(g.sideNodes(0, Side::left, 5, 5), 1, 0, Table({ 0., 1e-6, 1.001e-6 }, { 0., 0., 1e6 }));
	std::string s;
	for (int k = 0; k < 100 && s.empty(); k++) s = refusal([&] { g.step(0.3 * g.criticalTimeStep()); });
	EXPECT_SAYS(s, "soft");
	EXPECT_SAYS(s, "cell (");
	for (const double v : everything(g)) ASSERT_TRUE(std::isfinite(v));
	EXPECT_SAYS(refusal([&] { g.step(1e-12); }), "stopped");
	Grid h;
	h.restore(g.save());
	EXPECT_TRUE(sameBits(everything(g), everything(h)));
	EXPECT_SAYS(refusal([&] { h.step(1e-12); }), "stopped");
}

TEST(GridErrors, NonFiniteForceFromOutsideAndDamagedState)
{
	Grid g;
	g.addRectangle(steel(), line(0, 1, 4), line(0, 1, 4));
	g.build();
	const double dt = g.criticalTimeStep();
	g.computeForces(dt);
	g.addNodeForce(3, std::nan(""), 0);
	EXPECT_SAYS(refusal([&] { g.integrate(dt); }), "node (3, 0)");
	auto       bytes = g.save(), longName = bytes;
	const auto before = everything(g);
	bytes.resize(bytes.size() / 2);
	EXPECT_SAYS(refusal([&] { g.restore(bytes); }), "cannot be restored");
	const char name[] = "block";
	const auto at     = std::search(longName.begin(), longName.end(), name, name + 5) - longName.begin();
	ASSERT_GE(size_t(at), sizeof(uint64_t));
	ASSERT_LT(size_t(at), longName.size());
	std::memset(&longName[at - sizeof(uint64_t)], 0x7f, sizeof(uint64_t)); // the length of the name
	EXPECT_SAYS(refusal([&] { g.restore(longName); }), "cannot be restored");
	EXPECT_TRUE(sameBits(before, everything(g)));
	EXPECT_SAYS(refusal([&] { Grid({ true, true, 2. }); }), "safety");
}
