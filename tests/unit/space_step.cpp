// SPDX-License-Identifier: GPL-2.0-or-later
// Bodies of automata in space: waves, steps, vibration, rotation, shocks, balances, threads, saving, refusals.
#include "space_scene.hpp"
#include <omp.h>
using namespace spacetest;

namespace {
/// Force and torque on the automaton in the middle of a block, over the displacement, of a plane wave of displacements along `a` or of turns about `b`.
struct Response {
	double force, torque;
};
Response waveResponse(const Material& m, const Rotation& R, Vec<double> n, double k, Vec<double> a, Vec<double> b, bool turning, double phase)
{
	const double size = 1e-7;
	auto         list = packing(1., 4.6, R, m, [](Vec<double> p) { return plainSquare(p) < 4.5 * 4.5; });
	int          middle = -1;
	for (auto& q : list) {
		const double wave = turning ? size * std::sin(k * plainDot(n, q.position) + phase) : size * std::cos(k * plainDot(n, q.position) + phase);
		(turning ? q.omega : q.velocity) = (turning ? b : a) * wave;
		if (plainSquare(q.position) < 1e-6) middle = q.id;
	}
	Options o;
	o.contacts = false;
	Solver s;
	s.build(list, { m }, o);
	s.computeForces();
	s.integrate(1.); // all that was given as velocity is displacement now
	s.computeForces();
	const size_t i = size_t(s.indexOf(middle));
	return { plainDot(s.store.force.at(i), a) / size, plainDot(s.store.torque.at(i), b) / size };
}
/// Phase speed of a wave along n, in units of the continuum's; the packing as it stands.
double phaseSpeed(double nu, Vec<double> n, double length, Vec<double> a)
{
	const double   G = 3. * (1. - 2. * nu) / (2. * (1. + nu)), k = 2. * M_PI / length, mass = Lattice::cell(1.), inertia = Lattice::inertia(mass, 1.);
	const Material m     = plain(G);
	const bool     shear = std::fabs(plainDot(n, a)) < 0.5;
	const Vec<double> b  = shear ? plainCross(n, a) : a;
	const double uu = -waveResponse(m, straight(), n, k, a, b, false, 0.).force / mass;
	double       w2 = uu;
	if (shear) {
		const double uw = -waveResponse(m, straight(), n, k, a, b, true, 0.).force / mass,
			     wu = -waveResponse(m, straight(), n, k, a, b, false, 0.5 * M_PI).torque / inertia,
			     ww = -waveResponse(m, straight(), n, k, a, b, true, 0.5 * M_PI).torque / inertia, half = 0.5 * (uu + ww);
		w2 = half - std::sqrt(half * half - uu * ww + uw * wu); // the lower branch
	}
	return std::sqrt(w2) / k / (shear ? std::sqrt(G) : std::sqrt(1. + 4. * G / 3.));
}
}

TEST(SpaceWaves, PhaseSpeedsAreThoseOfTheLattice)
{
	const double      h = std::sqrt(0.5);
	const Vec<double> n100 { 1., 0., 0. }, n110 { h, h, 0. }, n111 = unit({ 1., 1., 1. });
	struct Row {
		double length, p100, p110, p111, s100, s110a, s110b, s111;
	};
	for (const Row& r : { Row { 6, .9495, .9381, .9334, .9777, .9803, .9890, .9876 }, Row { 10, .9814, .9769, .9753, .9919, .9929, .9960, .9954 },
	                      Row { 20, .9953, .9942, .9938, .9980, .9982, .9990, .9988 }, Row { 40, .9988, .9985, .9984, .9995, .9996, .9998, .9997 } }) {
		EXPECT_NEAR(phaseSpeed(0.3, n100, r.length, n100), r.p100, 1e-4) << r.length;
		EXPECT_NEAR(phaseSpeed(0.3, n110, r.length, n110), r.p110, 1e-4) << r.length;
		EXPECT_NEAR(phaseSpeed(0.3, n111, r.length, n111), r.p111, 1e-4) << r.length;
		EXPECT_NEAR(phaseSpeed(0.3, n100, r.length, { 0., 1., 0. }), r.s100, 1e-4) << r.length;
		const double one = phaseSpeed(0.3, n110, r.length, { h, -h, 0. }), two = phaseSpeed(0.3, n110, r.length, { 0., 0., 1. });
		EXPECT_NEAR(std::min(one, two), r.s110a, 1e-4) << r.length;
		EXPECT_NEAR(std::max(one, two), r.s110b, 1e-4) << r.length;
		EXPECT_NEAR(phaseSpeed(0.3, n111, r.length, { h, -h, 0. }), r.s111, 1e-4) << r.length;
	}
	EXPECT_NEAR(phaseSpeed(0.28, n100, 10, n100), .9824, 1e-4);
	EXPECT_NEAR(phaseSpeed(0.35, n111, 10, n111), .9718, 1e-4);
	EXPECT_NEAR(phaseSpeed(0.3, n111, 200., n111), 1., 1e-3);
}

TEST(SpaceStep, LimitIsThatOfTheTurningAutomaton)
{
	// all automata held in place, free to turn: the fastest motion of the packing
	for (double factor : { 0.98, 1.04 }) {
		auto list = packing(1., 7., straight(), plain(0.48), box(6., 6., 6.));
		shake(list, 1e-6, 2);
		for (auto& a : list) a.velocity = {}, a.free = { false, false, false };
		Options o;
		o.contacts = false;
		Solver s;
		s.build(list, { plain(0.48) }, o);
		s.computeForces();
		const double dt = factor * s.criticalStep(), start = s.account().kinetic;
		EXPECT_NEAR(s.criticalStep(), 0.3495 / std::sqrt(0.48), 1e-6);
		for (int k = 0; k < (factor < 1 ? 1500 : 15); k++) s.computeForces(), s.integrate(dt);
		EXPECT_TRUE(factor < 1 ? s.account().kinetic < 3. * start : s.account().kinetic > 1e3 * start) << factor << ' ' << s.account().kinetic / start;
	}
}

TEST(SpaceBody, FreeVibrationKeepsItsEnergy)
{
	std::mt19937   r(11);
	const Material m = plain(0.4615);
	auto           list = packing(1., 8., randomRotation(r), m, ellipsoid(6.4, 4.4, 3.1));
	const double size = 0.1; // strains of 1e-4: more of them changes the energy by their cubes
	for (auto& a : list) {
		const double x = a.position[0];
		a.velocity     = Vec<double> { 2e-3 * std::sin(0.5 * x), 1e-3 * a.position[2] / 3., -1e-3 * std::sin(0.4 * x) } * size;
	}
	shake(list, 1e-3 * size, 12);
	Options o;
	o.contacts = false, o.account = true;
	Solver s;
	s.build(list, { m }, o);
	const int    steps = std::getenv("MCA_LONG") ? 100000 : 20000;
	double       first = 0, last = 0;
	const auto   start = s.account();
	s.computeForces();
	const double dt    = 0.4 * s.criticalStep();
	for (int k = 0; k < steps; k++) {
		s.computeForces();
		s.integrate(dt);
		if (k % 20 != 0 || (k >= steps / 10 && k < steps - steps / 10)) continue;
		const Account a = s.account(); // velocities and stresses of one time
		(k < steps / 10 ? first : last) += a.kinetic + a.volumetric + a.deviatoric + a.centre;
	}
	const Account end = s.account();
	EXPECT_LT(std::fabs(last / first - 1.), 3e-4);
	const double speed = std::sqrt(2. * start.kinetic * list.size() * Lattice::cell(1.));
	EXPECT_LT(std::sqrt(plainSquare(end.momentum - start.momentum)), 1e-13 * speed);
	EXPECT_LT(std::sqrt(plainSquare(end.angular - start.angular)), 1e-13 * speed * 6.4);
	EXPECT_LT(std::fabs(end.bookedError()), 1e-12 * start.kinetic);
	std::cout << list.size() << " automata, " << steps << " steps: energy " << last / first - 1. << ", momentum "
	          << std::sqrt(plainSquare(end.momentum - start.momentum)) / speed << ", angular "
	          << std::sqrt(plainSquare(end.angular - start.angular)) / speed / 6.4 << ", booked " << end.bookedError() / start.kinetic << ", total "
	          << end.total() / start.kinetic - 1. << "\n";
}

TEST(SpaceBody, RoughSurfacesAreStableNearTheLargestStep)
{
	std::mt19937 r(1);
	for (double nu : { 0.3, 0.45 }) {
		const Material m    = plain(3. * (1. - 2. * nu) / (2. * (1. + nu)));
		auto           list = packing(1., 7., randomRotation(r), m, ellipsoid(5.1, 3.7, 2.6));
		shake(list, 1e-5, 6);
		Options o;
		o.contacts = false;
		Solver s;
		s.build(list, { m }, o);
		s.computeForces();
		const double dt = 0.95 * s.criticalStep(), start = s.account().kinetic;
		double       most = 0;
		for (int k = 0; k < 4000; k++) {
			s.computeForces(), s.integrate(dt);
			if (k % 10 == 0) most = std::max(most, s.account().kinetic);
		}
		EXPECT_LT(most, 1.5 * start) << nu;
	}
}

TEST(SpaceBody, TurnsRigidlyAboutAGeneralAxis)
{
	std::mt19937      r(13);
	const Material    m = plain(0.4615);
	const Vec<double> w = unit({ 0.4, -0.3, 0.86 }) * 0.01;
	auto              list = packing(1., 6., randomRotation(r), m, box(4.1, 2.6, 2.1));
	Vec<double>       centre {};
	for (auto& a : list) centre += a.position * (1. / double(list.size()));
	for (auto& a : list) a.velocity = plainCross(w, a.position - centre), a.omega = w;
	Options o;
	o.contacts = false, o.account = true;
	Solver s;
	s.build(list, { m }, o);
	const Account start = s.account();
	s.computeForces();
	const double  dt    = 0.4 * s.criticalStep();
	const int     steps = int(2. * 2. * M_PI / (0.01 * dt)); // two turns
	double        most  = 0;
	for (int k = 0; k < steps; k++) {
		s.computeForces();
		s.integrate(dt);
		if (k % 100 != 0) continue;
		const Account a = s.account();
		most = std::max(most, std::fabs((a.kinetic + a.volumetric + a.deviatoric + a.centre) / start.kinetic - 1.));
	}
	const Account end = s.account();
	EXPECT_LT(most, 1e-4); // the spring of the sudden stretch
	EXPECT_LT(std::sqrt(plainSquare(end.angular - start.angular) / plainSquare(start.angular)), 1e-12);
	std::cout << list.size() << " automata, " << steps << " steps: energy within " << most << ", angular momentum "
	          << std::sqrt(plainSquare(end.angular - start.angular) / plainSquare(start.angular)) << "\n";
}

TEST(SpaceBody, ImpactKeepsMomentumAndBooksItsEnergy)
{
	Options o;
	o.account = true;
	Solver s;
	impact(s, 900., o);
	const Account start = s.account();
	double        drift = 0, dt = 0;
	for (int k = 0; k < 40; k++) {
		dt = run(s, 10, 0.4, dt);
		const Account a = s.account();
		drift = std::max(drift, std::fabs(a.total() / start.kinetic - 1.));
		ASSERT_LT(std::fabs(a.bookedError()), 1e-12 * start.kinetic);
	}
	const Account end = s.account();
	EXPECT_GT(s.counters.brokenLinks, 100);
	EXPECT_GT(s.contacts.size(), 100u);
	EXPECT_GT(end.plastic, 0.);
	EXPECT_GT(end.friction, 0.);
	const double p = std::sqrt(plainSquare(start.momentum)), L = p * 8e-3;
	EXPECT_LT(std::sqrt(plainSquare(end.momentum - start.momentum)), 1e-13 * p);
	EXPECT_LT(std::sqrt(plainSquare(end.angular - start.angular)), 1e-13 * L);
	EXPECT_LT(drift, 0.02);
	std::cout << "broken " << s.counters.brokenLinks << ", contacts " << s.contacts.size() << ", momentum "
	          << std::sqrt(plainSquare(end.momentum - start.momentum)) / p << ", angular " << std::sqrt(plainSquare(end.angular - start.angular)) / L
	          << ", booked " << end.bookedError() / start.kinetic << ", independent sum " << drift << ", plastic " << end.plastic / start.kinetic
	          << ", viscous " << end.viscous / start.kinetic << ", friction " << end.friction / start.kinetic << ", fracture "
	          << end.fracture / start.kinetic << ", coupling " << end.coupling / start.kinetic << "\n";
}

TEST(SpaceBody, SameBitsOnAnyNumberOfThreadsAndAfterSaving)
{
	std::vector<std::vector<double>> all;
	for (int t : { 1, 2, 3 }) {
		omp_set_num_threads(t);
		Solver s;
		impact(s, 900.);
		run(s, 120);
		all.push_back(everything(s));
	}
	omp_set_num_threads(2);
	EXPECT_TRUE(sameBits(all[0], all[1]));
	EXPECT_TRUE(sameBits(all[0], all[2]));
	Options o;
	o.account = true;
	Solver a, b;
	impact(a, 900., o);
	const double dt = run(a, 70);
	b.load(a.save());
	EXPECT_EQ(a.save(), b.save());
	run(a, 60, 0.4, dt), run(b, 60, 0.4, dt);
	EXPECT_TRUE(sameBits(everything(a), everything(b)));
	EXPECT_EQ(a.save(), b.save());
	std::string cut = a.save();
	cut.resize(cut.size() / 2);
	EXPECT_SAYS(refusal([&] { b.load(cut); }), "damaged");
}

TEST(SpaceBody, SleepingChangesNothing)
{
	std::vector<std::vector<double>> all;
	for (bool sleeping : { true, false }) {
		Options o;
		o.sleeping = sleeping;
		Material m = steel();
		auto     list = packing(1e-3, 20e-3, straight(), m, box(30e-3, 3.1e-3, 3.1e-3));
		for (auto& a : list)
			if (a.position[0] < -15e-3) a.velocity[0] = 50.;
		Solver s;
		s.build(list, { m }, o);
		run(s, 30);
		all.push_back(everything(s));
		EXPECT_EQ(s.counters.blockSteps < 30 * int64_t(s.store.blocks.size()), sleeping);
	}
	EXPECT_TRUE(sameBits(all[0], all[1]));
}

TEST(SpaceBody, DrivenFacesStretchABarWithItsModulus)
{
	// ends are driven slowly; faces are free, of whole automata: they have the stress of the body
	const Material m  = [] { Material q = plain(0.4615); q.viscosity = { 0.5, 2. }; return q; }();
	auto           list = packing(1., 16., straight(), m, box(14.2, 4.1, 4.1));
	for (auto& a : list)
		if (std::fabs(a.position[0]) > 13.) a.free[0] = false, a.velocity[0] = a.position[0] > 0 ? 1e-5 : -1e-5;
	Options o;
	o.contacts = false;
	Solver s;
	s.build(list, { m }, o);
	for (int k = 0; k < 6000; k++) {
		s.computeForces();
		for (int c = 0; c < dim; c++)
			for (size_t i = 0; i < s.store.size(); i++)
				if (s.store.perMass[c][i] > 0) s.store.velocity[c][i] *= 0.995;
		s.integrate(0.4 * s.criticalStep());
	}
	s.computeForces();
	double force = 0, low = 0, high = 0;
	int    nl = 0, nh = 0;
	for (size_t i = 0; i < s.store.size(); i++) {
		if (s.store.id[i] < 0) continue;
		const double x = s.store.position[0][i], at = list[size_t(s.store.id[i])].position[0];
		if (at > 13.) force -= s.store.force[0][i];
		if (std::fabs(at + 7.) < 0.8) low += x - at, nl++;
		if (std::fabs(at - 7.) < 0.8) high += x - at, nh++;
	}
	const double strain = (high / nh - low / nl) / 14.1421, E = 9. * 0.4615 / (3. + 0.4615);
	const double section = double(list.size()) * Lattice::cell(1.) / (41. * std::sqrt(0.5)); // volume over length
	std::cout << "modulus over the continuum's " << force / strain / section / E << ", strain " << strain << "\n";
	EXPECT_NEAR(force / strain / section / E, 1., 0.005);
}

TEST(SpaceErrors, AreToldBeforeAnythingMoves)
{
	const Material m = plain(0.48);
	auto           list = packing(1., 3., straight(), m, box(2., 2., 2.));
	Solver         s;
	Options        o;
	o.volumeRule = VolumeRule::inversePower;
	EXPECT_SAYS(refusal([&] { s.build(list, { m }, o); }), "affine");
	auto bad = list;
	bad[3].position = bad[4].position + Vec<double> { 0.1, 0., 0. };
	EXPECT_SAYS(refusal([&] { s.build(bad, { m }, {}); }), "rest distances apart");
	bad = list, bad[2].triangles = 3;
	EXPECT_SAYS(refusal([&] { s.build(bad, { m }, {}); }), "triangles");
	bad = list, bad[2].velocity[2] = NAN;
	EXPECT_SAYS(refusal([&] { s.build(bad, { m }, {}); }), "not finite");
	bad = list, bad[2].inertia = 0;
	EXPECT_SAYS(refusal([&] { s.build(bad, { m }, {}); }), "inertia");
	bad.clear();
	for (int x = 0; x < 3; x++) // a simple cubic row does not fit
		for (int y = 0; y < 3; y++)
			for (int z = 0; z < 3; z++) {
				bad.push_back(list[0]);
				bad.back().position = { 1. * x, 1. * y, 1. * z }, bad.back().id = int(bad.size()) - 1;
			}
	EXPECT_SAYS(refusal([&] { s.build(bad, { m }, {}); }), "face-centred cubic");
	Solver fast; // two balls through each other in one step
	auto   two = list;
	for (auto& a : two) a.velocity[0] = 40.;
	auto other = packing(1., 3., straight(), m, box(2., 2., 2.), 1000, 0, 2);
	for (auto& a : other) a.position[0] += 5., a.velocity[0] = -40.;
	append(two, other);
	fast.build(two, { m }, {});
	EXPECT_SAYS(refusal([&] {
		            for (int k = 0; k < 20; k++) fast.computeForces(), fast.integrate(0.0075);
	            }),
	            "rest distances apart");
}

TEST(SpaceBody, ViscousBoundaryTakesAWaveAway)
{
	Material m = plain(0.48);
	m.viscosity = { 0.1, 0.5 };
	auto list = packing(1., 24., straight(), m, box(20., 3., 3.));
	for (auto& a : list) {
		a.free = { true, false, false }; // uniaxial
		if (a.position[0] < -14.) a.velocity[0] = 1e-3;
	}
	Options o;
	o.contacts = false;
	Solver s;
	s.build(list, { m }, o);
	const double face = std::sqrt(1. + 4. * 0.48 / 3.); // rho cP times the area of an automaton in the last plane: a^2/2 = 1
	for (auto& a : list)
		if (std::fabs(a.position[0]) > 19.) s.setDamping(size_t(s.indexOf(a.id)), { face, 0., 0. });
	const double start = s.account().kinetic;
	while (s.time < 60.) run(s, 1);
	EXPECT_LT(s.account().kinetic, 0.05 * start);
	std::cout << "kinetic energy left " << s.account().kinetic / start << "\n";
}
