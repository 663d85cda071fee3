// SPDX-License-Identifier: GPL-2.0-or-later
// Materials, packings and runs the automata tests share.
#pragma once
#include "automata/solver.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

namespace automatatest {
using namespace mca;
using namespace mca::automata;

constexpr double infinite = std::numeric_limits<double>::infinity();

inline Material steel(YieldKind kind = YieldKind::elastic)
{
	Material m;
	m.eos        = { 7830., 4578., 1.33, 1.67 };
	m.G          = 80e9;
	m.yield.kind = kind;
	if (kind != YieldKind::elastic) m.yield.yieldStress = 0.792e9;
	if (kind == YieldKind::linearHardening) m.yield.hardeningModulus = 0.5e9;
	if (kind == YieldKind::johnsonCook) {
		m.yield.hardeningModulus = 0.51e9, m.yield.hardeningExponent = 0.26, m.yield.rateCoefficient = 0.014, m.yield.thermalSoftening = 1.03,
		m.yield.meltTemperature = 1793., m.yield.heatPerWork = 0.9 / (7830. * 477.);
	}
	m.friction = 0.1;
	return m;
}
inline Material tungsten()
{
	Material m   = steel(YieldKind::perfect);
	m.eos        = { 17600., 4030., 1.237, 1.54 };
	m.G          = 124e9;
	m.yield.yieldStress    = 1.5e9;
	return m;
}

struct Place {
	double x = 0, y = 0, angle = 0;
};
/// nx x ny hexagonal packing of full cells, rows at `angle`, first automaton at `at`; numbers from `id` on.
inline std::vector<Automaton> packing(double d, int nx, int ny, const Material& m, Place at = {}, int id = 0, int material = 0, int group = 1)
{
	std::vector<Automaton> out;
	const double           c = std::cos(at.angle), s = std::sin(at.angle);
	for (int j = 0; j < ny; j++)
		for (int i = 0; i < nx; i++) {
			Automaton    a;
			const double u = (i + 0.5 * (j & 1)) * d, v = 0.86602540378443864676 * j * d;
			a.position[0] = at.x + c * u - s * v, a.position[1] = at.y + s * u + c * v;
			a.mass = m.eos.rho0 * Lattice::cell(d), a.inertia = 0.125 * a.mass * d * d, a.diameter = d;
			a.id = id++, a.material = material, a.group = group;
			out.push_back(a);
		}
	return out;
}
inline void append(std::vector<Automaton>& to, const std::vector<Automaton>& more) { to.insert(to.end(), more.begin(), more.end()); }

/// Random velocities up to `speed` [m/s] on all.
inline void shake(std::vector<Automaton>& list, double speed, unsigned seed)
{
	std::mt19937                           r(seed);
	std::uniform_real_distribution<double> u(-speed, speed);
	for (auto& a : list) a.velocity[0] += u(r), a.velocity[1] += u(r), a.omega += u(r) / a.diameter;
}

/// n steps with `factor` of the largest stable one, growing at most 10 % a step; returns the last.
inline double run(Solver& s, int n, double factor = 0.4, double dt = 0)
{
	for (int k = 0; k < n; k++) {
		s.computeForces();
		dt = dt > 0 ? std::min(factor * s.criticalStep(), 1.1 * dt) : factor * s.criticalStep();
		s.integrate(dt);
	}
	return dt;
}

/// State of all automata in the order of their numbers, and of all contacts, for comparison bit by bit.
inline std::vector<double> everything(const Solver& s)
{
	std::vector<double>  v;
	const Store&         S = s.store;
	std::vector<int32_t> ids;
	for (int32_t i : S.id)
		if (i >= 0) ids.push_back(i);
	std::sort(ids.begin(), ids.end());
	for (int32_t id : ids) {
		const size_t i = size_t(s.indexOf(id));
		for (auto a :
		     { &S.position[0], &S.position[1], &S.velocity[0], &S.velocity[1], &S.omega, &S.angle, &S.J, &S.P, &S.szz, &S.eqps, &S.temperature })
			v.push_back((*a)[i]);
		if (!S.heat.empty()) v.push_back(S.heat[i]);
		for (int k = 0; k < nLinks; k++)
			v.push_back(S.s[linkSlot(i, k)]), v.push_back(S.tau[linkSlot(i, k)]);
		v.push_back(S.flags[i] & (linkBits | halfBits | (linkBits << hadShift)));
	}
	for (size_t c = 0; c < s.contacts.size(); c++)
		v.push_back(s.contacts.s[c]), v.push_back(s.contacts.tau[c]), v.push_back(s.contacts.rest[c]);
	v.push_back(s.time);
	return v;
}
inline bool sameBits(const std::vector<double>& a, const std::vector<double>& b)
{
	return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}
inline bool finite(const std::vector<double>& v)
{
	return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}

/// A tungsten block hits a steel block at `speed`; both may yield and break: links, broken links, contacts, two species.
inline void impact(Solver& s, double speed, YieldKind kind = YieldKind::linearHardening, const Options& o = {}, double fractureStrain = 0.3, unsigned seed = 1)
{
	Material a = tungsten(), b = steel(kind);
	a.fracture.strain = b.fracture.strain = fractureStrain;
	const double           d    = 1e-3;
	std::vector<Automaton> list = packing(d, 6, 18, a, { 9.2e-3, 0., 0. }, 0, 0, 1);
	for (auto& q : list) q.velocity[1] = -speed;
	append(list, packing(d, 24, 9, b, { 0.3e-3, -9 * d, 0.02 }, 200, 1, 2));
	std::mt19937                           r(seed);
	std::uniform_real_distribution<double> u(0.9, 1.1);
	for (auto& q : list)
		q.strength = u(r);
	s.build(list, { a, b }, o);
}

/// Change of the independent energy sum over its start, when the solver has run to `end` [s] with `factor` of the stable step.
inline double energyDrift(Solver& s, double end, double factor)
{
	const double start = s.account().kinetic;
	double       dt    = 0;
	while (s.time < end) dt = run(s, 10, factor, dt);
	return std::fabs(s.account().total() - start) / start;
}

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
