// SPDX-License-Identifier: GPL-2.0-or-later
// Materials, packings and runs the tests of automata in space share. Compiled with MCA_DIM = 3.
#pragma once
#include "automata/solver.hpp"
#include "kernels/space/frame.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace spacetest {
using namespace mca;
using namespace mca::automata;
static_assert(dim == 3, "compile with MCA_DIM = 3");

constexpr double unitCell = 1.4142135623730950488; ///< edge of the cubic cell [diameters]

/// Density, bulk modulus and diameter are one.
inline Material plain(double G, double strength = 0., double slope = 0.)
{
	Material m;
	m.eos = { 1., 1., slope, 0. };
	m.G   = G;
	if (strength > 0.) m.yield.kind = YieldKind::perfect, m.yield.yieldStress = strength;
	m.viscosity = { 0., 0. };
	return m;
}
inline Material steel()
{
	Material m;
	m.eos        = { 7830., 4578., 1.33, 1.67 };
	m.G          = 80e9;
	m.yield.kind = YieldKind::linearHardening, m.yield.yieldStress = 0.792e9, m.yield.hardeningModulus = 0.5e9;
	m.viscosity  = { 0.5, 2. };
	m.friction   = 0.1;
	return m;
}

using Rotation = Frame;
inline Vec<double> apply(const Tensor<double>& A, Vec<double> v) { return A.column[0] * v[0] + A.column[1] * v[1] + A.column[2] * v[2]; }
/// Rows of the result: a, b, c along the first, second, third axis of the laboratory.
inline Rotation axesTo(Vec<double> a, Vec<double> b)
{
	const Frame t = triad(unit(a), unit(b));
	Frame       r {};
	for (int c = 0; c < dim; c++)
		for (int q = 0; q < dim; q++) r.column[c][q] = t.column[q][c];
	return r;
}
inline Rotation randomRotation(std::mt19937& r)
{
	std::normal_distribution<double> n;
	return axesTo({ n(r), n(r), n(r) }, { n(r), n(r), n(r) });
}
inline Tensor<double> randomTensor(std::mt19937& r, double size)
{
	std::uniform_real_distribution<double> u(-size, size);
	Tensor<double>                         A {};
	for (int c = 0; c < dim; c++)
		for (int q = 0; q < dim; q++) A.column[c][q] = u(r);
	return A;
}

/// Automata of the packing, turned by R, that f(position) accepts; half: half the edge of the box that is looked through [m].
template <class F>
std::vector<Automaton> packing(double d, double half, const Rotation& R, const Material& m, F&& f, int id = 0, int material = 0, int group = 1)
{
	std::vector<Automaton> out;
	const double           a = unitCell * d;
	const int              n = int(std::ceil(std::sqrt(3.) * half / (0.5 * a))) + 1;
	for (int x = -n; x <= n; x++)
		for (int y = -n; y <= n; y++)
			for (int z = -n; z <= n; z++) {
				if ((x + y + z) & 1) continue;
				Automaton q;
				q.position = apply(R, Vec<double> { x * 0.5 * a, y * 0.5 * a, z * 0.5 * a });
				if (!f(q.position)) continue;
				q.mass = m.eos.rho0 * Lattice::cell(d), q.inertia = Lattice::inertia(q.mass, d), q.diameter = d;
				q.id = id++, q.material = material, q.group = group;
				out.push_back(q);
			}
	return out;
}
inline Rotation straight() { return { { { 1., 0., 0. }, { 0., 1., 0. }, { 0., 0., 1. } } }; }
inline std::function<bool(Vec<double>)> box(double x, double y, double z)
{
	return [=](Vec<double> p) { return std::fabs(p[0]) < x && std::fabs(p[1]) < y && std::fabs(p[2]) < z; };
}
inline std::function<bool(Vec<double>)> ellipsoid(double x, double y, double z)
{
	return [=](Vec<double> p) { return std::pow(p[0] / x, 2) + std::pow(p[1] / y, 2) + std::pow(p[2] / z, 2) < 1.; };
}
inline void append(std::vector<Automaton>& to, const std::vector<Automaton>& more) { to.insert(to.end(), more.begin(), more.end()); }
inline void shake(std::vector<Automaton>& list, double speed, unsigned seed)
{
	std::mt19937                           r(seed);
	std::uniform_real_distribution<double> u(-speed, speed);
	for (auto& a : list)
		for (int c = 0; c < dim; c++) a.velocity[c] += u(r), a.omega[c] += u(r) / a.diameter;
}
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
	std::vector<double> v;
	const Store&        S = s.store;
	for (int id : s.ids()) {
		const size_t i = size_t(s.indexOf(id));
		for (const Vectors* a : { &S.position, &S.velocity, &S.omega, &S.force, &S.torque })
			for (int c = 0; c < dim; c++) v.push_back((*a)[c][i]);
		for (double x : { S.J[i], S.P[i], S.mean[i], S.eqps[i], S.temperature[i], S.factor[i], double(S.flags[i]) }) v.push_back(x);
		for (const double* x : deviators(S).entry) v.push_back(x[i]);
		for (int k = 0; k < nLinks; k++)
			for (int c = 0; c < dim; c++) v.push_back(S.stressAt(linkSlot(i, k))[c]);
	}
	for (size_t c = 0; c < s.contacts.size(); c++)
		for (int q = 0; q < dim; q++) v.push_back(sideOf(s.contacts, c)[q]);
	v.push_back(s.time);
	return v;
}
inline bool sameBits(const std::vector<double>& a, const std::vector<double>& b)
{
	return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}
inline Account settled(Solver& s)
{
	s.computeForces();
	return s.account();
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

/// A ball hits a plate; both may yield and break: links, broken links, contacts, two species.
inline void impact(Solver& s, double speed, const Options& o = {}, double fractureStrain = 0.3, unsigned seed = 1)
{
	Material a = steel(), b = steel();
	a.eos.rho0 = 17600., a.eos.c0 = 4030., a.G = 124e9, a.yield.yieldStress = 1.5e9;
	a.fracture.strain = b.fracture.strain = fractureStrain;
	const double d    = 1e-3;
	auto         list = packing(d, 4 * d, straight(), a, ellipsoid(3.1 * d, 3.1 * d, 3.1 * d), 0, 0, 1);
	for (auto& q : list) q.position[2] += 6.2 * d, q.velocity[2] = -speed, q.velocity[0] = 0.3 * speed;
	const Rotation R = axesTo({ 1., 0.1, 0. }, { 0., 1., 0.2 });
	append(list, packing(d, 8 * d, R, b, box(8. * d, 8. * d, 2.3 * d), 1000, 1, 2));
	std::mt19937                           r(seed);
	std::uniform_real_distribution<double> u(0.9, 1.1);
	for (auto& q : list) q.strength = u(r);
	s.build(list, { a, b }, o);
}
}
