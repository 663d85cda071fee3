// SPDX-License-Identifier: GPL-2.0-or-later
// Random coupled blocks: any direction, edge length, velocities, materials, changing time step. Momentum, angular momentum and energy to round-off.
#include "automata/solver.hpp"
#include "grid/grid.hpp"
#include "interface/transfer.hpp"
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <rapidcheck/gtest.h>

using namespace mca;

namespace {
struct Coupled {
	automata::Solver                A;
	grid::Grid                      G;
	std::vector<interface::Carried> row;
	std::vector<size_t>             place;

	Coupled(const Material& m, double angle, int h, int cells, unsigned seed)
	{
		std::mt19937                           random(seed);
		std::uniform_real_distribution<double> u(-1., 1.);
		const double d = 1e-3, c = std::cos(angle), s = std::sin(angle), pitch = 0.86602540378443864676 * d;
		std::vector<automata::Automaton> list;
		const int                        n = h * cells, columns = 7;
		for (int i = 0; i < columns; i++)
			for (int j = 0; j <= n - i % 2; j++) {
				automata::Automaton a;
				const double        x = -i * pitch, y = (j + 0.5 * (i % 2)) * d;
				a.position[0] = c * x - s * y, a.position[1] = s * x + c * y;
				a.weight   = (i == 0 ? 0.5 : 1.) * (i % 2 == 0 && (j == 0 || j == n) ? 0.5 : 1.);
				a.diameter = d, a.mass = a.weight * m.eos.rho0 * Lattice::cell(d), a.inertia = a.mass * d * d / 8.;
				a.velocity[0] = 20. * u(random), a.velocity[1] = 20. * u(random), a.omega = 1e4 * u(random);
				a.id = int(list.size());
				list.push_back(a);
			}
		automata::Options o;
		o.account = true;
		A.build(list, { m }, o);
		std::vector<double> x, y;
		for (int j = 0; j <= cells; j++)
			for (int i = 0; i <= 5; i++) {
				const double px = i * h * d, py = j * h * d;
				x.push_back(c * px - s * py), y.push_back(s * px + c * py);
			}
		G.addBlock(m, 5, cells, x, y);
		G.setVelocity(0, [&](double, double) { return std::array<double, 2> { 20. * u(random), 20. * u(random) }; });
		interface::SideNodes side;
		side.block = "grid", side.material = &m, side.node = G.sideNodes(0, grid::Side::left);
		for (int k : side.node)
			side.x.push_back(G.open().x[size_t(k)]), side.y.push_back(G.open().y[size_t(k)]);
		side.inX = x[1], side.inY = y[1];
		std::vector<interface::RowPoint> points;
		for (auto& a : list) points.push_back({ a.id, a.position[0], a.position[1], a.diameter, a.mass, a.weight, &m });
		row = interface::makeMap(points, side, {});
		RC_ASSERT(row.size() == size_t(n + 1));
		for (auto& p : interface::nodeMasses(row))
			G.addNodeMass(p.first, p.second);
		for (auto& q : row) {
			place.push_back(A.tie(size_t(A.indexOf(q.id)), true));
			carry(place.size() - 1);
		}
	}
	void carry(size_t k)
	{
		const auto v = interface::motion(row[k], G.open());
		A.setTiedVelocity(place[k], v.velocity, 0.);
	}
	void step(double factor)
	{
		A.computeForces();
		const double dt = factor * std::min(A.criticalStep(), G.criticalTimeStep());
		G.computeForces(dt);
		RC_ASSERT(A.kick(dt) == G.kick(dt));
		for (auto& q : row) {
			const size_t i = size_t(A.indexOf(q.id));
			interface::addForce(q, A.store.force.at(i), G.open());
		}
		G.integrate(dt);
		for (size_t k = 0; k < row.size(); k++) carry(k);
		A.integrate(dt);
		for (auto& q : row) {
			const auto   v = interface::motion(q, G.open());
			const size_t i = size_t(A.indexOf(q.id));
			A.store.position.set(i, v.position);
		}
	}
	struct Sums {
		double energy, kinetic, px, py, turn;
	};
	Sums sums() const
	{
		const auto a = A.account();
		const auto g = G.energy();
		Sums        s { a.bookedError() + g.total(), a.kinetic + g.kinetic, a.momentum[0] + g.momentumX, a.momentum[1] + g.momentumY, a.angular };
		const auto& b = G.block(0);
		for (int j = 1; j < b.nj; j++)
			for (int i = 1; i < b.ni; i++) {
				const size_t k = b.node(i, j);
				s.turn += (b.x[k] * b.vy[k] - b.y[k] * b.vx[k]) / b.invMass[k];
			}
		const auto& n = G.open();
		for (size_t k = 0; k < size_t(n.size()); k++) s.turn += n.mass[k] * (n.x[k] * n.vy[k] - n.y[k] * n.vx[k]);
		return s;
	}
};
}

RC_GTEST_PROP(InterfaceProperty, balancesAreExact, ())
{
	Material m;
	m.eos               = { 7830., 4578., 1.33, 1.67 };
	m.G                 = 80e9;
	m.yield.kind        = *rc::gen::element(YieldKind::elastic, YieldKind::perfect, YieldKind::linearHardening);
	m.yield.yieldStress           = m.yield.kind == YieldKind::elastic ? m.yield.yieldStress : 0.5e9;
	m.yield.hardeningModulus           = m.yield.kind == YieldKind::linearHardening ? 0.5e9 : 0.;
	m.viscosity         = *rc::gen::arbitrary<bool>() ? Viscosity { 0.25, 1.2 } : Viscosity { 0., 0. };
	const double angle  = *rc::gen::inRange(0, 628) * 0.01;
	const int    h = *rc::gen::inRange(1, 5), cells = *rc::gen::inRange(2, 6);
	Coupled      C(m, angle, h, cells, *rc::gen::arbitrary<unsigned>());
	C.step(0.1);
	const auto start = C.sums();
	const double energy = start.kinetic, momentum = std::sqrt(2. * start.kinetic * 7830. * 1e-6 * (6 * h * cells + 5 * h * h * cells)),
		     length = 1e-3 * (h * cells + 5 * h + 6);
	double       factor = 0.1;
	for (int k = 0; k < 150; k++) {
		factor = std::min(0.5, factor * (1. + 0.001 * *rc::gen::inRange(0, 100)));
		if (k % 37 == 36) factor *= 0.3;
		C.step(factor);
	}
	const auto end = C.sums();
	RC_ASSERT(std::fabs(end.energy - start.energy) < 1e-11 * energy);
	RC_ASSERT(std::hypot(end.px - start.px, end.py - start.py) < 1e-12 * momentum);
	RC_ASSERT(std::fabs(end.turn - start.turn) < 1e-11 * momentum * length);
}
