// SPDX-License-Identifier: GPL-2.0-or-later
// The deviator in space at any strain: uniform fields, flow stress, surfaces in compression, vibration of what has been deformed.
#include "space_scene.hpp"
using namespace spacetest;

namespace {
/// A body whose automata are all held, moved by F and turned with it.
struct HeldBody {
	Solver solver;
	double volume = 0;
	HeldBody(const Material& m, const Rotation& R, bool contacts)
	{
		auto list = packing(1., 4.4, R, m, ellipsoid(4.2, 3.7, 3.4));
		for (size_t before = 0; before != list.size();) { // those whose links span a volume
			before         = list.size();
			const auto all = list;
			list.erase(std::remove_if(list.begin(), list.end(), [&](auto& a) {
				return std::count_if(all.begin(), all.end(), [&](auto& b) { return plainSquare(a.position - b.position) < 1.1; }) < 6;
			}), list.end());
		}
		for (auto& a : list)
			for (int c = 0; c < dim; c++) a.free[c] = a.freeR[c] = false;
		Options o;
		o.contacts = contacts, o.account = true, o.sleeping = false, o.volumeFilter = 0.;
		solver.build(list, { m }, o);
		volume = double(list.size()) * Lattice::cell(1.);
	}
	/// Angle of the turn of a shear.
	static Vec<double> turn(const Tensor<double>& F) { return { 0., 0., -2. * std::atan(0.25 * F.column[1][0]) }; }
	void               step(const Tensor<double>& F, double dt = 0.01)
	{
		solver.computeForces();
		Store& S = solver.store;
		for (size_t i = 0; i < S.size(); i++)
			if (S.id[i] >= 0) S.velocity.set(i, (apply(F, S.position.at(i)) - S.position.at(i)) * (1. / dt)), S.omega.set(i, turn(F) * (1. / dt));
		solver.integrate(dt);
	}
};
Material ideal(double strength) { return plain(0.4615, strength); }
double largestTraction(const Store& S)
{
	double most = 0;
	for (size_t q = 0; q < S.stresses(); q++) most = std::max(most, std::sqrt(plainSquare(S.stressAt(q))));
	return most;
}
struct Path {
	const char*    name;
	Tensor<double> step;
	double         strain; ///< equivalent, of a step
};
std::vector<Path> paths(double e)
{
	const auto along = [](double a, double b, double c) { return Tensor<double> { { { a, 0., 0. }, { 0., b, 0. }, { 0., 0., c } } }; };
	const double s = std::exp(0.5 * e), f = std::exp(-e);
	Tensor<double> shear = straight();
	shear.column[1][0] = e * std::sqrt(3.);
	return { { "compression", along(s, s, f), e }, { "extension", along(1. / s, 1. / s, 1. / f), e }, { "shear", shear, e } };
}
}

TEST(SpaceStrain, UniformFieldsOfAnySizeLeaveNoTractions)
{
	std::mt19937 r(21);
	for (const Path& p : paths(0.01)) {
		HeldBody  body(ideal(0.), randomRotation(r), false);
		for (int k = 0; k < 60; k++) body.step(p.step);
		body.solver.computeForces();
		const Store& S = body.solver.store;
		double       low = 1e300, high = 0;
		for (size_t i = 0; i < S.size(); i++)
			if (S.id[i] >= 0) low = std::min(low, body.solver.equivalentStress(i)), high = std::max(high, body.solver.equivalentStress(i));
		EXPECT_LT(largestTraction(S), 1e-13) << p.name;
		EXPECT_GT(low, 0.7) << p.name; // 2G/sqrt(2/3) times 0.6, but for the turn of stresses in shear
		EXPECT_LT(high / low - 1., 1e-11) << p.name; // inside, at surfaces and at corners
	}
}

TEST(SpaceStrain, FlowStressDependsNeitherOnStrainNorOnThePacking)
{
	std::mt19937 r(22);
	const double strength = 0.002;
	for (const Rotation& R : { straight(), axesTo({ 1., 1., 0. }, { 0., 0., 1. }), axesTo({ 1., 1., 1. }, { 1., -1., 0. }), randomRotation(r) })
		for (const Path& p : paths(0.005)) {
			HeldBody body(ideal(strength), R, false);
			double   strain = 0, before = 0;
			for (int k = 0; k < 300; k++) {
				if (k == 150) before = settled(body.solver).external;
				body.step(p.step), strain += p.strain;
			}
			const double work = settled(body.solver).external - before; // of strains from 0.75 to 1.5
			EXPECT_NEAR(work / (strength * 0.5 * strain * body.volume), 1., 5e-3) << p.name;
		}
}

TEST(SpaceStrain, SurfacesInCompressionDoNotTouchThemselves)
{
	double work[2];
	for (bool contacts : { false, true }) {
		HeldBody body(ideal(0.002), straight(), contacts);
		for (int k = 0; k < 180; k++) body.step(paths(0.005)[0].step); // second neighbours at 0.57 d
		const Account a = settled(body.solver);
		work[contacts] = a.external;
	}
	EXPECT_EQ(work[0], work[1]);
}

TEST(SpaceStrain, WhatHasBeenDeformedVibratesWithoutGainingEnergy)
{
	for (int n : { 80, 300 }) // strains of 0.4 and 1.5
	for (const Path& p : paths(0.005)) {
		HeldBody body(ideal(2e-4), straight(), false); // strains of 1e-4: more of them changes the energy by their cubes
		Solver&  s = body.solver;
		for (int k = 0; k < n; k++) body.step(p.step);
		s.computeForces();
		Store& S = s.store;
		for (size_t i = 0; i < S.size(); i++)
			if (S.id[i] >= 0) {
				S.velocity.set(i, {}), S.omega.set(i, {});
				S.perMass.set(i, { 1. / S.mass[i], 1. / S.mass[i], 1. / S.mass[i] });
				S.perInertia.set(i, { 1. / S.inertia[i], 1. / S.inertia[i], 1. / S.inertia[i] });
			}
		for (auto& m : S.materials) m.yield.yieldStress = 1e3; // from now on nothing may take energy away
		const double held = settled(s).deviatoric + settled(s).volumetric, start = settled(s).external;
		double       most = 0, last = 0;
		for (int k = 0; k < 4000; k++) {
			s.computeForces();
			s.integrate(0.97 * s.criticalStep());
			if (k % 10 == 0) {
				const Account a = s.account();
				const double  sum = (a.kinetic + a.volumetric + a.deviatoric + a.centre) / held;
				most = std::max(most, sum), last += k >= 3600 ? sum / 40. : 0.;
			}
		}
		const Account a = settled(s);
		EXPECT_EQ(a.external, start) << p.name;
		EXPECT_LT(most, 1.001) << p.name;
		EXPECT_GT(last, 0.96) << p.name;
		EXPECT_LT(std::sqrt(plainSquare(a.momentum)), 1e-13 * std::sqrt(2. * held * body.volume)) << p.name;
		EXPECT_LT(std::sqrt(plainSquare(a.angular)), 1e-12 * 4. * std::sqrt(2. * held * body.volume)) << p.name;
		std::cout << p.name << ": energy " << last << ", at most " << most << " of that held\n";
	}
}

TEST(SpaceStrain, ForcesAndTorquesAreThoseOfAnEnergy)
{
	// the stiffness matrix of a small body with surfaces, corners and loose links, at rest and deformed without stress, is symmetric
	const auto list = packing(1., 4., straight(), plain(0.4615), ellipsoid(2.5, 1.6, 1.1));
	const int  n    = int(list.size());
	const auto response = [&](int moved, double stretch) { // forces and torques on all by a small motion of one
		auto held = list;
		for (auto& a : held)
			for (int c = 0; c < dim; c++) a.free[c] = a.freeR[c] = false;
		Options o;
		o.contacts = o.sleeping = false;
		Solver s;
		s.build(held, { plain(0.4615) }, o);
		Store& S = s.store;
		const auto all = [&] {
			std::vector<double> f;
			for (int id = 0; id < n; id++)
				for (const Vectors* v : { &S.force, &S.torque })
					for (int c = 0; c < dim; c++) f.push_back((*v)[c][size_t(s.indexOf(id))]);
			return f;
		};
		const auto go = [&](auto&& set) {
			for (size_t i = 0; i < S.size(); i++)
				if (S.id[i] >= 0) set(i);
			s.integrate(1.), s.computeForces();
		};
		const auto rest = [&](size_t i) { S.velocity.set(i, {}), S.omega.set(i, {}); };
		s.computeForces();
		for (int k = 0; k < 10; k++)
			go([&](size_t i) { S.velocity.set(i, Vec<double> { S.position[0][i], -0.5 * S.position[1][i], -0.4 * S.position[2][i] } * stretch); });
		for (double* entry : deviators(S).entry) std::fill(entry, entry + S.size(), 0.);
		std::fill(S.traction.begin(), S.traction.end(), 0.);
		go(rest);
		const auto before = all();
		go([&](size_t i) {
			rest(i);
			if (S.id[i] == moved / 6) (moved % 6 < dim ? S.velocity : S.omega)[moved % dim][i] = 1e-7;
		});
		auto after = all();
		for (size_t k = 0; k < after.size(); k++) after[k] = (after[k] - before[k]) / 1e-7;
		return after;
	};
	for (double stretch : { 0., 0.05 }) {
		std::vector<std::vector<double>> K;
		for (int k = 0; k < 6 * n; k++) K.push_back(response(k, stretch));
		double worst = 0;
		for (int a = 0; a < 6 * n; a++)
			for (int b = 0; b < a; b++) worst = std::max(worst, std::fabs(K[size_t(a)][size_t(b)] - K[size_t(b)][size_t(a)]));
		EXPECT_LT(worst, 2e-6) << stretch; // entries are up to 6
	}
}
