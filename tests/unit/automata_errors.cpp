// SPDX-License-Identifier: GPL-2.0-or-later
// Bad input and broken runs end in one clear error that names the automaton; the state stays finite and can be saved.
#include "automata_scene.hpp"
using namespace automatatest;

namespace {
std::vector<Automaton> good() { return packing(1e-3, 8, 8, steel()); }
std::string            buildRefusal(const std::vector<Automaton>& list, const Material& m = steel())
{
	return refusal([&] {
		Solver s;
		s.build(list, { m }, {});
	});
}
}

TEST(AutomataErrors, InputOutOfRange)
{
	auto bad = [&](auto change) {
		auto list = good();
		change(list[37]);
		const std::string said = buildRefusal(list);
		EXPECT_SAYS(said, "automaton 37");
		return said;
	};
	const double nan = std::nan("");
	for (auto field : { &Automaton::position, &Automaton::velocity })
		for (int c = 0; c < dim; c++)
			for (double v : { nan, infinite, -infinite })
				EXPECT_SAYS(bad([&](Automaton& a) { (a.*field)[c] = v; }), "finite");
	for (auto field : { &Automaton::omega, &Automaton::angle, &Automaton::mass, &Automaton::inertia, &Automaton::diameter, &Automaton::strength })
		for (double v : { nan, infinite, -infinite })
			EXPECT_SAYS(bad([&](Automaton& a) { a.*field = v; }), "finite");
	EXPECT_SAYS(bad([](Automaton& a) { a.mass = 0; }), "mass 0 kg/m must be above zero");
	EXPECT_SAYS(bad([](Automaton& a) { a.mass = -1; }), "mass -1 kg/m");
	EXPECT_SAYS(bad([](Automaton& a) { a.inertia = 0; }), "block the rotation");
	EXPECT_SAYS(bad([](Automaton& a) { a.diameter = 0; }), "diameter 0 m");
	EXPECT_SAYS(bad([](Automaton& a) { a.material = 7; }), "unknown material number 7");
	EXPECT_SAYS(bad([](Automaton& a) { a.weight = 0; }), "weight 0");
	EXPECT_SAYS(bad([](Automaton& a) { a.strength = 0; }), "strength");
	auto twice  = good();
	twice[5].id = 9;
	EXPECT_SAYS(buildRefusal(twice), "9 is given twice");
}

TEST(AutomataErrors, NonFinitePlasticStrainIsRefused)
{
	auto list     = good();
	list[37].eqps = std::nan("");
	EXPECT_SAYS(buildRefusal(list), "automaton 37");
	list[37].eqps = -0.1;
	EXPECT_SAYS(buildRefusal(list), "automaton 37");
}

TEST(AutomataErrors, CoincidentAndWrongSpacing)
{
	auto list  = good();
	list[12].position[0] = list[13].position[0], list[12].position[1] = list[13].position[1];
	const std::string same = buildRefusal(list);
	EXPECT_SAYS(same, "12");
	EXPECT_SAYS(same, "13");
	EXPECT_SAYS(same, "0 rest distances");
	for (auto& a : list = good()) a.position[0] *= 0.5, a.position[1] *= 0.5; // packing twice as dense as the diameter says
	EXPECT_FALSE(buildRefusal(list).empty());
	for (auto& a : list = good()) a.position[0] *= 0.6, a.position[1] *= 0.6;
	EXPECT_SAYS(buildRefusal(list), "does not match the diameter");
	list = good();
	append(list, packing(1e-3, 8, 8, steel(), { 7.6e-3, 3e-3, 0.5 }, 100)); // another orientation, the same group
	EXPECT_FALSE(buildRefusal(list).empty());
}

TEST(AutomataErrors, MaterialOutOfRange)
{
	auto says = [](auto change) {
		Material m = steel(YieldKind::johnsonCook);
		change(m);
		return refusal([&] { validate(m, "steel"); });
	};
	EXPECT_EQ(says([](Material&) {}), "");
	EXPECT_SAYS(says([](Material& m) { m.eos.hugoniotSlope = -0.1; }), "material 'steel': hugoniotSlope [-] = -0.1");
	EXPECT_SAYS(says([](Material& m) { m.yield.yieldStress = -1; }), "yieldStress [Pa] = -1");
	EXPECT_SAYS(says([](Material& m) { m.eos.rho0 = 0; }), "density");
	EXPECT_SAYS(says([](Material& m) { m.eos.c0 = std::nan(""); }), "bulkSoundSpeed");
	EXPECT_SAYS(says([](Material& m) { m.G = -1; }), "shearModulus");
	EXPECT_SAYS(says([](Material& m) { m.yield.hardeningModulus = std::nan(""); }), "hardeningModulus");
	EXPECT_SAYS(says([](Material& m) { m.yield.hardeningExponent = 0; }), "hardeningExponent");
	EXPECT_SAYS(says([](Material& m) { m.yield.rateCoefficient = -1; }), "rateCoefficient");
	EXPECT_SAYS(says([](Material& m) { m.yield.meltTemperature = 200; }), "meltTemperature");
	EXPECT_SAYS(says([](Material& m) { m.fracture.strain = 0; }), "fractureStrain");
	EXPECT_SAYS(says([](Material& m) { m.fracture.ratio = 0.5; }), "strengthRatio");
	EXPECT_SAYS(says([](Material& m) { m.viscosity.linear = -1; }), "viscosityLinear");
	EXPECT_SAYS(says([](Material& m) { m.friction = -1; }), "friction");
	EXPECT_SAYS(says([](Material& m) { m.eos.clampAt = 0; }), "clampAt");
}

TEST(AutomataErrors, TimeStepMustBePositive)
{
	Solver s;
	s.build(good(), { steel() }, {});
	s.computeForces();
	const auto before = everything(s);
	for (double dt : { 0., -1e-9, std::nan(""), infinite })
		EXPECT_SAYS(refusal([&] { s.integrate(dt); }), "time step");
	EXPECT_TRUE(sameBits(before, everything(s)));
}

TEST(AutomataErrors, OverlapBelowHalfADiameterNamesBothAndTheStep)
{
	Material m  = steel();
	m.viscosity = { 0., 0. };
	auto list   = packing(1e-3, 1, 1, m);
	append(list, packing(1e-3, 1, 1, m, { 1.3e-3, 0, 0 }, 100, 0, 2));
	list[1].velocity[0] = -3000;
	Solver s;
	s.build(list, { m }, {});
	s.computeForces();
	std::string said;
	for (int k = 0; k < 20 && said.empty(); k++)
		said = refusal([&] {
			s.integrate(3e-7); // far above the limit
			s.computeForces();
		});
	EXPECT_SAYS(said, "automata 0 at");
	EXPECT_SAYS(said, "100 at");
	EXPECT_SAYS(said, "rest distances apart in step");
	EXPECT_SAYS(said, "Remedy");
	EXPECT_TRUE(finite(everything(s)));
	Solver t;
	t.load(s.save());
	EXPECT_TRUE(sameBits(everything(s), everything(t)));
}

TEST(AutomataErrors, UnstableStepIsReportedBeforeAnythingIsNotFinite)
{
	Material m  = steel();
	m.viscosity = { 0., 0. };
	auto list   = packing(1e-3, 8, 8, m);
	shake(list, 1., 3);
	Solver s;
	s.build(list, { m }, {});
	s.computeForces();
	const double dt = 3 * s.criticalStep();
	std::string  said;
	int          k = 0;
	for (; k < 2000 && said.empty(); k++)
		said = refusal([&] {
			s.integrate(dt);
			s.computeForces();
		});
	EXPECT_LT(k, 2000);
	EXPECT_SAYS(said, "automat");
	EXPECT_TRUE(finite(everything(s)));
	Solver t;
	t.load(s.save()); // can still be saved
	EXPECT_TRUE(sameBits(everything(s), everything(t)));
}

TEST(AutomataErrors, NonFiniteForceFromOutsideStopsBeforeItMoves)
{
	Solver s;
	s.build(good(), { steel() }, {});
	s.computeForces();
	const auto before = everything(s);
	s.addForce(size_t(s.indexOf(20)), { std::nan(""), 0. }, 0.);
	EXPECT_SAYS(refusal([&] { s.integrate(1e-9); }), "automaton 20");
	EXPECT_TRUE(sameBits(before, everything(s)));
	EXPECT_SAYS(refusal([&] { s.setDamping(3, { -1., 0. }); }), "viscous boundary coefficient");
}

TEST(AutomataErrors, DamagedBytesAreRefusedAndTheSolverIsUnchanged)
{
	Solver s;
	impact(s, 800.);
	run(s, 40);
	const std::string bytes  = s.save();
	const auto        before = everything(s);
	EXPECT_SAYS(refusal([&] { s.load(""); }), "damaged");
	EXPECT_SAYS(refusal([&] { s.load(bytes.substr(0, bytes.size() / 2)); }), "damaged");
	EXPECT_SAYS(refusal([&] { s.load(bytes + "x"); }), "damaged");
	std::string other = bytes;
	other[0] ^= 1;
	EXPECT_SAYS(refusal([&] { s.load(other); }), "another");
	EXPECT_TRUE(sameBits(before, everything(s)));
	EXPECT_EQ(s.save(), bytes);
}

TEST(AutomataErrors, AccountMayBeSwitchedOnAmongContacts)
{
	Solver s, t;
	impact(s, 800.);
	run(s, 40);
	ASSERT_GT(s.contacts.size(), 0u);
	t.load(s.save());
	t.options.account = true;
	run(s, 2), run(t, 2);
	EXPECT_TRUE(sameBits(everything(s), everything(t)));
	EXPECT_TRUE(std::isfinite(t.account().total()));
}
