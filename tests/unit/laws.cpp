// SPDX-License-Identifier: GPL-2.0-or-later
// Laws of plugin/kernels/laws: each flow stress and equation of state against its equation written here independently, and what every law must fulfil.
#include "kernels/material.hpp"
#include <functional>
#include <gtest/gtest.h>
#include <vector>
using namespace mca;

namespace {
Yield flow(YieldKind kind, std::function<void(Yield&)> set)
{
	Yield y;
	y.kind = kind, y.meltTemperature = 1356.;
	set(y);
	return y;
}
Yield copper(YieldKind kind)
{
	if (kind == YieldKind::zerilliArmstrong)
		return flow(kind, [](Yield& y) { y.yieldStress = 65e6, y.thermalHardening = 890e6, y.thermalDecay = 0.0028, y.rateDecay = 1.15e-4; });
	if (kind == YieldKind::steinbergGuinan)
		return flow(kind, [](Yield& y) {
			y.yieldStress = 0.12e9, y.strainFactor = 36, y.hardeningExponent = 0.45, y.largestYieldStress = 0.64e9, y.softeningPerKelvin = 3.77e-4;
		});
	return flow(kind, [](Yield& y) {
		y.yieldStress = 90e6, y.hardeningModulus = 292e6, y.hardeningExponent = 0.31, y.rateCoefficient = 0.025, y.thermalSoftening = 1.09;
	});
}
Yield iron()
{
	return flow(YieldKind::zerilliArmstrong, [](Yield& y) {
		y.yieldStress = 65e6, y.thermalStress = 1033e6, y.thermalDecay = 0.00698, y.rateDecay = 4.15e-4, y.hardeningModulus = 266e6,
		y.hardeningExponent = 0.289;
	});
}
Eos copperEos(EosKind kind)
{
	Eos e;
	e.kind = kind, e.rho0 = 8930., e.c0 = 3940., e.hugoniotSlope = 1.489, e.gruneisen = 2.02;
	if (kind == EosKind::polynomial) e.quadraticModulus = 134.2e9, e.cubicModulus = -41.9e9, e.gruneisenSlope = 2.02;
	return e;
}
std::vector<Yield> allFlows()
{
	std::vector<Yield> all { iron() };
	for (int k = 0; k < yieldKinds; k++) all.push_back(copper(YieldKind(k)));
	return all;
}
const double strains[] = { 0., 3e-5, 1e-3, 0.01, 0.1, 1.5 }, temperatures[] = { 150., 298., 700., 1300., 1500. };
} // namespace

TEST(Laws, ZerilliArmstrongIsItsEquation)
{
	for (double ep : { 1e-4, 0.01, 0.3, 1. })
		for (double T : temperatures)
			for (double rate : { 1., 1e2, 1e5 }) {
				const double fcc = 65e6 + 890e6 * std::sqrt(ep) * std::exp(-0.0028 * T + 1.15e-4 * T * std::log(rate));
				const double bcc = 65e6 + 1033e6 * std::exp(-0.00698 * T + 4.15e-4 * T * std::log(rate)) + 266e6 * std::pow(ep, 0.289);
				EXPECT_NEAR(flowStress(copper(YieldKind::zerilliArmstrong), ep, rate, T) / fcc, 1., 1e-13);
				EXPECT_NEAR(flowStress(iron(), ep, rate, T) / bcc, 1., 1e-13);
			}
	EXPECT_EQ(flowStress(iron(), 0.1, 1e-3, 298.), flowStress(iron(), 0.1, 1., 298.)); // slower than the reference rate counts as that
}

TEST(Laws, SteinbergGuinanIsItsEquation)
{
	const Yield y = copper(YieldKind::steinbergGuinan);
	for (double ep : strains)
		for (double T : { 298., 700., 1300. })
			EXPECT_NEAR(
				flowStress(y, ep, 1e4, T) / (std::min(0.12e9 * std::pow(1 + 36 * ep, 0.45), 0.64e9) * (1 - 3.77e-4 * (T - 298.))), 1., 1e-13);
	EXPECT_EQ(flowStress(y, 0.1, 1., 1400.), 0.); // molten
}

TEST(Laws, PolynomialIsItsEquation)
{
	const Eos e = copperEos(EosKind::polynomial);
	for (double eps : { -0.4, -0.1, -1e-3, 0.02 })
		for (double energy : { 0., 1e5, 1e6 }) { // J/kg
			const double mu = 1 / (1 + eps) - 1, K = 8930. * 3940. * 3940.,
				     cold = eps < 0 ? K * mu + 134.2e9 * mu * mu - 41.9e9 * mu * mu * mu : -K * eps;
			const double hot  = (2.02 + (eps < 0 ? 2.02 * mu : 0.)) * 8930. * energy;
			EXPECT_NEAR(hotPressure(e, eps, energy), cold + hot, 1e-13 * (std::fabs(cold) + hot));
		}
	// the Hugoniot of (4c) is close to the adiabat it is the expansion of, and (4d) is its slope
	const auto hugoniot = [&](double x) {
		double P = 0; // the energy behind a shock is P eta/2: by iteration, not by the formula of the code
		for (int k = 0; k < 200; k++) P = hotPressure(e, x, 0.5 * P * -x / e.rho0);
		return P;
	};
	for (double eps : { -0.05, -0.1, -0.2 }) {
		EXPECT_NEAR(hugoniot(eps) / pressure(copperEos(EosKind::shockAdiabat), eps), 1., 0.3 * std::pow(-eps, 2));
		EXPECT_NEAR((hugoniot(eps - 1e-5) - hugoniot(eps + 1e-5)) / 2e-5 / tangent(e, eps), 1., 1e-7);
	}
}

TEST(Laws, SlopeOfEveryFlowStressIsItsDerivative)
{
	for (const Yield& y : allFlows())
		dispatch(y.kind, [&](auto kind) {
			using Law = LawOf<kind.value>;
			if constexpr (Law::yields)
				for (double ep : strains)
					for (double T : temperatures) {
						const double h = ep > 0 ? 1e-4 * ep : 1e-9, stress = staticYield<kind.value>(y, ep, T).stress;
						const auto   at    = [&](double x) { return staticYield<kind.value>(y, x, T).stress; };
						const double slope = ep > 0 ? (at(ep + h) - at(ep - h)) / (2 * h) : (at(h) - at(0.)) / h;
						EXPECT_NEAR(staticYield<kind.value>(y, ep, T).slope, slope, 1e-5 * std::fabs(slope) + 1e-9 * stress / h)
							<< int(y.kind) << ' ' << ep << ' ' << T;
						if (Law::isDear) { // what solvers take for granted when they leave the law out
							EXPECT_GE(at(ep + 0.01), stress);
							EXPECT_LE(staticYield<kind.value>(y, ep, T + 50.).stress, stress);
						}
						if (!Law::heats) {
							EXPECT_EQ(staticYield<kind.value>(y, ep, T + 50.).stress, stress);
						}
					}
		});
}

TEST(Laws, ReturnOfEveryFlowStressAgreesWithABisection)
{
	const double threeG = 3 * 47.7e9;
	for (const Yield& y : allFlows())
		dispatch(y.kind, [&](auto kind) {
			for (double dt : { 1e-10, 1e-8, 1e-6 })
				for (double ep : strains)
					for (double T : temperatures)
						for (double over : { 0.5, 0.999999, 1.000001, 1.01, 1.3, 3., 30. }) {
							const StaticYield s = staticYield<kind.value>(y, ep, T);
							if (!(s.stress > 1e3) || !LawOf<kind.value>::yields) continue; // molten
							const double trial = over * s.stress;
							const Return r     = radialReturn<kind.value>(y, trial, ep, T, threeG, dt);
							if (over < 1) {
								EXPECT_TRUE(r.scale == 1. && r.dEqps == 0.);
								continue;
							}
							// the rate at the strain before the step, hardening on a straight line: as formulated with (11)
							const double rest = flowStress(y, ep, 1e-30, T);
							const auto   gap  = [&](double d) {
                                                                const double grows =
                                                                        flowStress(y, ep, std::max(d / dt, 1e-30), T) / rest; // of Johnson-Cook a factor of all
                                                                const double hard = y.kind == YieldKind::johnsonCook ? s.slope * d * grows : s.slope * d;
                                                                return trial - threeG * d - rest * grows - hard;
							};
							double lo = 0, hi = trial / threeG;
							for (int k = 0; k < 200; k++) (gap(0.5 * (lo + hi)) > 0 ? lo : hi) = 0.5 * (lo + hi);
							EXPECT_NEAR(r.dEqps, lo, 2e-6 * s.stress / threeG)
								<< int(y.kind) << ' ' << dt << ' ' << ep << ' ' << T << ' ' << over;
							EXPECT_NEAR(r.scale, (trial - threeG * r.dEqps) / trial, 1e-12);
						}
		});
}

TEST(Laws, EnergyOfEveryEquationOfStateIsTheWorkOfItsPressure)
{
	for (int k = 0; k < eosKinds; k++) {
		const Eos e = copperEos(EosKind(k));
		for (double eps : { -0.6, -0.4, -0.2, -0.05, -1e-3, 0.03, 0.2 }) {
			const double h = 1e-4 * std::fabs(eps), P = pressure(e, eps);
			EXPECT_NEAR((storedEnergy(e, eps - h) - storedEnergy(e, eps + h)) / (2 * h) / P, 1., 1e-6) << k << ' ' << eps;
			EXPECT_GE(tangent(e, eps) * (1 + 1e-6), (pressure(e, eps - h) - pressure(e, eps + h)) / (2 * h)) << k << ' ' << eps;
		}
		EXPECT_EQ(pressure(e, 0.), 0.);
		EXPECT_EQ(storedEnergy(e, 0.), 0.);
		EXPECT_NEAR(tangent(e, 0.) / e.bulkModulus(), 1., 1e-15);
		// the internal energy grows by exactly the work of the pressure, in steps of any size
		double energy = 0, P = 0, J = 1, work = 0;
		for (double to : { 0.95, 0.9, 0.7, 0.8, 1.05, 1. }) {
			const double dEps = to - J, old = P;
			P = pressureWithWork(e, to - 1., dEps, old, energy), J = to;
			work -= 0.5 * (old + P) * dEps / e.rho0;
			if (e.heats()) {
				EXPECT_NEAR(P, hotPressure(e, to - 1., energy), 1e-12 * e.bulkModulus());
			}
		}
		EXPECT_NEAR(energy, e.heats() ? work : 0., 1e-12 * std::fabs(work));
	}
}

TEST(Laws, RefusalsNameTheConstantOfTheLawChosen)
{
	const auto says = [](std::function<void(Material&)> change) -> std::string {
		Material m;
		m.eos = copperEos(EosKind::polynomial), m.G = 47.7e9, m.yield = copper(YieldKind::steinbergGuinan);
		change(m);
		try {
			validate(m, "copper");
		} catch (const Error& e) {
			return e.what();
		}
		return "";
	};
	EXPECT_EQ(says([](Material&) {}), "");
	EXPECT_EQ(
		says([](Material& m) { m.yield.softeningPerKelvin = -1; }),
		"material 'copper': softeningPerKelvin [1/K] = -1 is not allowed; it must be finite and not negative.");
	EXPECT_EQ(
		says([](Material& m) { m.yield.largestYieldStress = 1e6; }),
		"material 'copper': largestYieldStress [Pa] = 1e+06 is not allowed; it must be at least yieldStress.");
	EXPECT_NE(says([](Material& m) { m.yield.thermalStress = std::nan(""); }), ""); // no law of NaN, chosen or not
	EXPECT_NE(says([](Material& m) { m.eos.cubicModulus = -400e9; }).find("twice the density"), std::string::npos);
	EXPECT_NE(says([](Material& m) { m.yield.kind = YieldKind::zerilliArmstrong, m.yield.referenceRate = 0; }), "");
}
