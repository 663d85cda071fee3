// SPDX-License-Identifier: GPL-2.0-or-later
// A whole step: conservation, independence of threads, skipping, bands and features, several blocks, saving.
#include "grid_scene.hpp"
#include <omp.h>
using namespace gridtest;

namespace {
/// Two blocks side by side, rough initial velocities, loads and constraints on the sides.
void scene(Grid& g, YieldKind kind, bool mie = false, bool edge = false, int n = 40)
{
	Material m          = steel(kind), w = steel(kind);
	m.eos.kind = mie ? EosKind::mieGruneisen : EosKind::shockAdiabat;
	w.eos               = { 17600., 4030., 1.237, 1.54 };
	w.G                 = 124e9;
	BlockOptions o;
	o.edgeViscosity = edge;
	g.addRectangle(m, line(0, 0.02, n), gradedLine(0, 0.03, 0.4e-3, 1e-3), o);
	g.addRectangle(w, line(0.02, 0.05, n + 7), gradedLine(0, 0.03, 0.4e-3, 1e-3), o);
	g.build();
}

void shake(Grid& g, double v = 150.)
{
	std::mt19937                           r(11);
	std::uniform_real_distribution<double> u(-v, v);
	for (int b = 0; b < g.blocks(); b++) g.setVelocity(b, [&](double, double) { return std::array<double, 2> { u(r), u(r) }; });
}

void hold(Grid& g)
{
	g.fix(g.sideNodes(0, Side::left), true, false);
	g.symmetry(0, Side::bottom);
	g.prescribe(g.sideNodes(1, Side::right, 3), 1, 0, Table({ 0., 1e-6, 2e-6 }, { 0., -40., -10. }));
	g.pressureLoad(0, Side::top, Table(2e9));
	g.traction(1, Side::top, Table(1e8), Table({ 0., 3e-6 }, { 0., -1e9 }));
	g.viscous(1, Side::bottom);
}
}

class GridStep : public ::testing::TestWithParam<std::tuple<YieldKind, bool, bool>> { };

TEST_P(GridStep, EnergyAndMomentumCloseToRoundOff)
{
	Grid g({ true, true, 0.9 });
	scene(g, std::get<0>(GetParam()), std::get<1>(GetParam()), std::get<2>(GetParam()));
	shake(g);
	hold(g);
	const Energy e0 = g.energy();
	double       scale = e0.kinetic, force = 0;
	for (int k = 0; k < 200; k++) {
		const double dt = (k % 3 ? 0.4 : 0.25) * g.criticalTimeStep(); // the step may change
		g.computeForces(dt);
		g.addNodeForce(5, 1e5, -2e5);
		g.integrate(dt);
		const Energy e = g.energy();
		scale = std::max(scale, std::fabs(e.kinetic) + std::fabs(e.workLoads) + std::fabs(e.workConstraints));
		force = std::max(force, std::fabs(e.impulseX) + std::fabs(e.impulseY));
	}
	const Energy e = g.energy();
	EXPECT_LT(std::fabs(e.total() - e0.total()), 1e-12 * scale);
	EXPECT_LT(std::fabs(e.momentumX - e0.momentumX - e.impulseX), 1e-12 * force);
	EXPECT_LT(std::fabs(e.momentumY - e0.momentumY - e.impulseY), 1e-12 * force);
	EXPECT_GT(std::fabs(e.workViscous), 0.);
	EXPECT_GT(std::fabs(e.workExternal), 0.);
}

TEST_P(GridStep, SameBitsForAnyNumberOfThreadsAndWithSkipping)
{
	std::vector<double> reference;
	for (const int threads : { 1, 2, 5 })
		for (const bool skip : { false, true }) {
			omp_set_num_threads(threads);
			Grid g({ true, skip, 0.9 });
			scene(g, std::get<0>(GetParam()), std::get<1>(GetParam()), std::get<2>(GetParam()), 90);
			hold(g);
			for (int k = 0; k < 60; k++) g.step(0.5 * g.criticalTimeStep());
			EXPECT_TRUE(!skip || g.awakeFraction() < 1.); // there is something to skip
			const auto now = everything(g);
			if (reference.empty()) reference = now;
			EXPECT_TRUE(sameBits(reference, now)) << threads << " threads, skip " << skip;
		}
	omp_set_num_threads(omp_get_num_procs());
}

TEST_P(GridStep, ContinuingFromASavedStateIsBitIdentical)
{
	Grid a({ true, true, 0.9 });
	scene(a, std::get<0>(GetParam()), std::get<1>(GetParam()), std::get<2>(GetParam()));
	hold(a);
	a.addGauge(0.01, 0.01, 3);
	a.addNodeMass(2, 0.5);
	for (int k = 0; k < 31; k++) a.step(0.5 * a.criticalTimeStep());
	Grid b;
	b.restore(a.save());
	EXPECT_EQ(b.steps(), 31);
	for (int k = 0; k < 31; k++) {
		a.step(0.5 * a.criticalTimeStep());
		b.step(0.5 * b.criticalTimeStep());
	}
	EXPECT_TRUE(sameBits(everything(a), everything(b)));
	EXPECT_EQ(a.gauge(0).history.size(), b.gauge(0).history.size());
	EXPECT_EQ(a.gauge(0).history.back().vx, b.gauge(0).history.back().vx);
	EXPECT_EQ(a.energy().total(), b.energy().total());
	EXPECT_TRUE(a.save() == b.save());
}

INSTANTIATE_TEST_SUITE_P(Features, GridStep,
                         ::testing::Values(std::make_tuple(YieldKind::elastic, false, false), std::make_tuple(YieldKind::perfect, true, false),
                                           std::make_tuple(YieldKind::linearHardening, false, false), std::make_tuple(YieldKind::johnsonCook, true, false),
                                           std::make_tuple(YieldKind::linearHardening, false, true)));

TEST(GridStep, AccountOffGivesTheSameMotion)
{
	Grid a({ true, true, 0.9 }), b({ false, true, 0.9 });
	for (Grid* g : { &a, &b }) {
		scene(*g, YieldKind::linearHardening);
		shake(*g);
		for (int k = 0; k < 40; k++) g->step(0.4 * g->criticalTimeStep());
	}
	EXPECT_EQ(b.block(0).energy, nullptr);
	EXPECT_TRUE(sameBits(a.open().vx, b.open().vx));
}

TEST(GridStep, OneBlockAndFourJoinedBlocksMoveAlike)
{
	Grid one({ true, true, 0.9 }), four({ true, true, 0.9 });
	const Material m = steel(YieldKind::perfect);
	one.addRectangle(m, line(0, 0.04, 40), line(0, 0.02, 20));
	four.addRectangle(m, line(0, 0.02, 20), line(0, 0.01, 10));
	four.addRectangle(m, line(0.02, 0.04, 20), line(0, 0.01, 10));
	four.addRectangle(m, line(0, 0.02, 20), line(0.01, 0.02, 10));
	four.addRectangle(m, line(0.02, 0.04, 20), line(0.01, 0.02, 10));
	const auto v = [](double x, double y) {
		return std::array<double, 2> { 100 * std::sin(200 * x) * std::cos(100 * y), 80 * std::cos(150 * x + 90 * y) };
	};
	one.setVelocity(0, v);
	for (int b = 0; b < 4; b++) four.setVelocity(b, v);
	double t = 0;
	for (int k = 0; k < 100; k++, t += 4e-8) {
		one.step(4e-8);
		four.step(4e-8);
	}
	const Block &a = one.block(0), &b = four.block(3);
	double       worst = 0;
	for (int j = 0; j <= 10; j++)
		for (int i = 0; i <= 20; i++) worst = std::max(worst, std::fabs(a.vx[a.node(i + 20, j + 10)] - b.vx[b.node(i, j)]));
	EXPECT_LT(worst, 1e-8); // of 100 m/s; the sums run in another order
	EXPECT_NEAR(one.energy().total(), four.energy().total(), 1e-10 * one.energy().total());
	EXPECT_EQ(four.openNode(0, 20, 10), four.openNode(3, 0, 0));
}

TEST(GridStep, OpenInteriorNodeMovesAsAClosedOne)
{
	Grid a({ true, true, 0.9 }), b({ true, true, 0.9 });
	for (Grid* g : { &a, &b }) g->addRectangle(steel(YieldKind::perfect), line(0, 0.02, 20), line(0, 0.02, 40));
	b.openInteriorNode(0, 7, 11);
	b.openInteriorNode(0, 8, 11);
	b.openInteriorNode(0, 3, 20); // on a seam between bands
	for (Grid* g : { &a, &b }) {
		g->setVelocity(0, [](double x, double y) {
			return std::array<double, 2> { 100 * std::sin(200 * x) * std::cos(100 * y), 80 * std::cos(150 * x + 90 * y) };
		});
		for (int k = 0; k < 50; k++) g->step(3e-8);
	}
	double worst = 0;
	for (int j = 0; j <= 40; j++)
		for (int i = 0; i <= 20; i++) worst = std::max(worst, std::fabs(a.block(0).vx[a.block(0).node(i, j)] - b.block(0).vx[b.block(0).node(i, j)]));
	EXPECT_LT(worst, 1e-8);
	EXPECT_NEAR(b.energy().total(), a.energy().total(), 1e-11 * a.energy().total());
	EXPECT_GE(b.openNode(0, 7, 11), 0);
	EXPECT_EQ(a.openNode(0, 7, 11), -1);
}

TEST(GridStep, StableAtTheLimitWithAnyHourglassStiffness)
{
	Material m  = steel(YieldKind::elastic);
	m.viscosity = { 0., 0. };
	for (const double hourglass : { 0., 1., 2.5, 4. }) {
		BlockOptions o;
		o.hourglass = hourglass;
		Grid g({ true, false, 0.9 });
		g.addRectangle(m, line(0, 0.012, 12), line(0, 0.012, 12), o);
		std::mt19937                           r(3);
		std::uniform_real_distribution<double> u(-1e-3, 1e-3);
		g.setVelocity(0, [&](double, double) { return std::array<double, 2> { u(r), u(r) }; });
		const double start = g.energy().kinetic;
		for (int k = 0; k < 2000; k++) g.step(0.999 * g.criticalTimeStep());
		EXPECT_LT(g.energy().kinetic, 10 * start) << hourglass;
	}
}
