// SPDX-License-Identifier: GPL-2.0-or-later
// Random grids, materials, meshes and boundaries: what must hold for all of them.
#include "../unit/grid_scene.hpp"
#include <omp.h>
#include <rapidcheck/gtest.h>
using namespace gridtest;

namespace {

struct Scene {
	int      ni, nj, blocks;
	unsigned seed;
	int      kind, loads;
	bool     mie, edge, hourglass, viscosity;
	double   skew, speed;
};

void showValue(const Scene& s, std::ostream& o)
{
	o << s.blocks << " blocks of " << s.ni << " x " << s.nj << ", seed " << s.seed << ", yield " << s.kind << ", loads " << s.loads
	  << (s.mie ? ", mieGrueneisen" : "") << (s.edge ? ", edge" : "") << (s.hourglass ? ", hourglass" : "") << (s.viscosity ? ", viscosity" : "")
	  << ", skew " << s.skew << ", speed " << s.speed;
}

rc::Gen<Scene> scenes()
{
	const auto share = [](int n) { return rc::gen::map(rc::gen::inRange(0, n + 1), [n](int k) { return double(k) / n; }); };
	return rc::gen::build<Scene>(rc::gen::set(&Scene::ni, rc::gen::inRange(1, 40)), rc::gen::set(&Scene::nj, rc::gen::inRange(1, 60)),
	                             rc::gen::set(&Scene::blocks, rc::gen::inRange(1, 4)), rc::gen::set(&Scene::seed, rc::gen::inRange(1u, 100000u)),
	                             rc::gen::set(&Scene::kind, rc::gen::inRange(0, 4)), rc::gen::set(&Scene::loads, rc::gen::inRange(0, 32)),
	                             rc::gen::set(&Scene::mie, rc::gen::arbitrary<bool>()), rc::gen::set(&Scene::edge, rc::gen::arbitrary<bool>()),
	                             rc::gen::set(&Scene::hourglass, rc::gen::arbitrary<bool>()), rc::gen::set(&Scene::viscosity, rc::gen::arbitrary<bool>()),
	                             rc::gen::set(&Scene::skew, rc::gen::map(share(20), [](double s) { return 0.25 * s; })),
	                             rc::gen::set(&Scene::speed, rc::gen::map(share(20), [](double s) { return 200. * s * s; })));
}

/// Blocks side by side along x, each skew inside; bit k of loads switches one boundary condition on.
void make(Grid& g, const Scene& s)
{
	Material m          = steel(YieldKind(s.kind));
	m.eos.kind = s.mie ? EosKind::mieGruneisen : EosKind::shockAdiabat;
	m.viscosity         = s.viscosity ? Viscosity { 0.2, 1.2 } : Viscosity { 0., 0. };
	BlockOptions o;
	o.edgeViscosity = s.edge;
	o.hourglass     = s.hourglass ? 1. : 0.;
	const double h  = 1e-3;
	for (int k = 0; k < s.blocks; k++) {
		std::mt19937                           r(s.seed + unsigned(k));
		std::uniform_real_distribution<double> u(-s.skew, s.skew);
		std::vector<double>                    x, y;
		for (int j = 0; j <= s.nj; j++)
			for (int i = 0; i <= s.ni; i++) {
				const bool edge = i == 0 || j == 0 || i == s.ni || j == s.nj;
				x.push_back((k * s.ni + i + (edge ? 0 : u(r))) * h);
				y.push_back((j + (edge ? 0 : u(r))) * h);
			}
		g.addBlock(m, s.ni, s.nj, x, y, o);
	}
	std::mt19937                           r(s.seed);
	std::uniform_real_distribution<double> v(-s.speed, s.speed);
	if (s.speed > 0)
		for (int k = 0; k < s.blocks; k++) g.setVelocity(k, [&](double, double) { return std::array<double, 2> { v(r), v(r) }; });
	const int last = s.blocks - 1;
	if (s.loads & 1) g.symmetry(0, Side::bottom);
	if (s.loads & 2) g.prescribe(g.sideNodes(0, Side::left), 1, 0, Table({ 0., 1e-6 }, { 10., 60. }));
	if (s.loads & 4) g.pressureLoad(last, Side::top, Table(5e8));
	if (s.loads & 8) g.viscous(last, Side::right);
	if (s.loads & 16) g.traction(0, Side::top, Table(2e8), Table(0.), 0, s.ni);
}
}

RC_GTEST_PROP(GridRandom, EnergyAndMomentumClose, ())
{
	const Scene s = *scenes();
	Grid        g({ true, true, 0.9 });
	make(g, s);
	const Energy e0 = g.energy();
	double       work = 0, impulse = 0, mv = 0;
	for (int k = 0; k < 60; k++) {
		g.step((0.2 + 0.1 * (k % 4)) * g.criticalTimeStep());
		const Energy e = g.energy();
		work = std::max(work, e.kinetic + std::fabs(e.internal) + std::fabs(e.workLoads) + std::fabs(e.workConstraints) + std::fabs(e.workViscous));
		impulse        = std::max(impulse, std::fabs(e.impulseX) + std::fabs(e.impulseY));
	}
	double mass = 0;
	for (int b = 0; b < g.blocks(); b++) mass += 7830. * s.ni * s.nj * 1e-6;
	mv             = std::sqrt(2 * mass * work); // the largest momentum so much energy could carry
	const Energy e = g.energy();
	RC_ASSERT(std::fabs(e.total() - e0.total()) <= 1e-12 * work);
	RC_ASSERT(std::fabs(e.momentumX - e0.momentumX - e.impulseX) <= 1e-12 * (impulse + mv));
	RC_ASSERT(std::fabs(e.momentumY - e0.momentumY - e.impulseY) <= 1e-12 * (impulse + mv));
}

RC_GTEST_PROP(GridRandom, ThreadsSkippingAndSavingDoNotChangeABit, ())
{
	const Scene s     = *scenes();
	const int   steps = 25, cut = *rc::gen::inRange(0, 25);
	Grid        a({ true, false, 0.9 }), b({ true, true, 0.9 });
	make(a, s);
	make(b, s);
	a.setThreads(1);
	b.setThreads(*rc::gen::inRange(1, 5));
	auto c = std::make_unique<Grid>();
	for (int k = 0; k < steps; k++) {
		const double dt = 0.45 * a.criticalTimeStep();
		a.step(dt);
		if (k == cut) c->restore(b.save());
		b.step(dt);
		if (k >= cut) c->step(dt);
	}
	RC_ASSERT(sameBits(everything(a), everything(b)));
	RC_ASSERT(sameBits(everything(b), everything(*c)));
}

RC_GTEST_PROP(GridRandom, MirroredGridsMoveMirrored, ())
{
	Scene s  = *scenes();
	s.blocks = 1, s.loads = 0;
	RC_PRE(s.speed > 0.);
	Grid a({ true, true, 0.9 });
	make(a, s);
	const Block&        p = a.block(0);
	std::vector<double> x, y;
	for (int j = 0; j <= s.nj; j++)
		for (int i = s.ni; i >= 0; i--) {
			x.push_back(-p.x[p.node(i, j)]);
			y.push_back(p.y[p.node(i, j)]);
		}
	Grid b({ true, true, 0.9 });
	b.addBlock(p.material, s.ni, s.nj, x, y, p.options);
	size_t k = 0;
	b.setVelocity(0, [&](double, double) {
		const int i = s.ni - int(k % size_t(s.ni + 1)), j = int(k / size_t(s.ni + 1));
		k++;
		return std::array<double, 2> { -p.vx[p.node(i, j)], p.vy[p.node(i, j)] };
	});
	for (int n = 0; n < 20; n++) {
		const double dt = 0.4 * a.criticalTimeStep();
		a.step(dt);
		b.step(dt);
	}
	const Block& q = b.block(0);
	double       worst = 0;
	for (int j = 0; j <= s.nj; j++)
		for (int i = 0; i <= s.ni; i++) {
			worst = std::max(worst, std::fabs(p.vx[p.node(i, j)] + q.vx[q.node(s.ni - i, j)]));
			worst = std::max(worst, std::fabs(p.vy[p.node(i, j)] - q.vy[q.node(s.ni - i, j)]));
		}
	RC_ASSERT(worst <= 1e-7 * s.speed);
}
