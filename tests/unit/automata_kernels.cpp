// SPDX-License-Identifier: GPL-2.0-or-later
// Every function of the pair law, the equation of state and the return mapping against its formula in plain arithmetic.
#include "automata_scene.hpp"
#include "kernels/automaton/limit.hpp"
#include <functional>
using namespace automatatest;

namespace {
Eos copper()
{
	Eos e = { 8930., 3940., 1.489, 2.02 };
	return e;
}
/// Integral of P d(-eps) by Gauss-Legendre of order 5 on many pieces.
double work(const Eos& e, double eps)
{
	const double node[5]     = { -0.9061798459386640, -0.5384693101056831, 0., 0.5384693101056831, 0.9061798459386640 },
		     weight[5]   = { 0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665, 0.2369268850561891 };
	std::vector<double> ends = { 0. };
	if (eps < e.clampStrain()) ends.push_back(e.clampStrain()); // the tangent bends there
	ends.push_back(eps);
	double sum = 0;
	const int n = 400;
	for (size_t part = 0; part + 1 < ends.size(); part++)
		for (int k = 0; k < n; k++) {
			const double h = (ends[part + 1] - ends[part]) / n, m = ends[part] + (k + 0.5) * h;
			for (int q = 0; q < 5; q++)
				sum -= 0.5 * h * weight[q] * pressure(e, m + 0.5 * h * node[q]);
		}
	return sum;
}
}

TEST(AutomataEos, AdiabatFulfilsTheHugoniotRelations)
{
	const Eos e = copper();
	for (double U : { 1e-3, 1., 100., 500., 1500., 3000. }) {
		const double D = e.c0 + e.hugoniotSlope * U, eps = -U / D;
		ASSERT_GT(eps, e.clampStrain());
		EXPECT_NEAR(pressure(e, eps), e.rho0 * D * U, 1e-12 * e.rho0 * D * U + 1e-16 * e.bulkModulus()) << U;
	}
	EXPECT_DOUBLE_EQ(pressure(e, 0.01), -e.bulkModulus() * 0.01);
	EXPECT_EQ(pressure(e, 0.), 0.);
}

TEST(AutomataEos, TangentIsTheDerivativeAndEnergyTheIntegral)
{
	for (double b : { 0., 1.489 }) {
		Eos e = copper();
		e.hugoniotSlope   = b;
		const double K = e.bulkModulus();
		for (double eps : { -0.62, -0.57, -0.5, -0.3, -0.1, -0.03, -0.02, -1e-3, -1e-6, 1e-6, 0.02, 0.3 }) {
			const double h = 1e-3 * std::min(std::fabs(eps), 0.03);
			const auto   D = [&](auto f) { return (8. * (f(eps + h) - f(eps - h)) - (f(eps + 2 * h) - f(eps - 2 * h))) / (12. * h); };
			EXPECT_NEAR(-D([&](double x) { return pressure(e, x); }) / tangent(e, eps), 1., 1e-9) << b << ' ' << eps;
			EXPECT_NEAR(-D([&](double x) { return storedEnergy(e, x); }) / pressure(e, eps), 1., 1e-8) << b << ' ' << eps; // W' = -P
			EXPECT_NEAR(storedEnergy(e, eps) / work(e, eps), 1., 1e-12) << b << ' ' << eps;
			EXPECT_GT(tangent(e, eps), 0.99 * (eps < 0 ? K : 0.)) << eps;
		}
		EXPECT_EQ(storedEnergy(e, 0.), 0.);
	}
}

TEST(AutomataEos, ClampIsContinuousCountedAndFinite)
{
	const Eos    e = copper();
	const double c = e.clampStrain();
	EXPECT_NEAR(1. + e.hugoniotSlope * c, e.clampAt, 1e-15);
	EXPECT_NEAR(pressure(e, c * (1 + 1e-12)), pressure(e, c), 1e-10 * pressure(e, c));
	EXPECT_FALSE(clamped(e, c * (1 - 1e-12)));
	EXPECT_TRUE(clamped(e, c * (1 + 1e-12)));
	EXPECT_EQ(tangent(e, -0.9), tangent(e, c));
	for (double eps : { -1., -0.99, -0.7 })
		EXPECT_TRUE(std::isfinite(pressure(e, eps)) && pressure(e, eps) > pressure(e, c) && std::isfinite(storedEnergy(e, eps)));
}

TEST(AutomataEos, MieGrueneisenOnTheHugoniotIsTheHugoniot)
{
	const Eos e = copper(); // on the shock adiabat the internal energy is P (V0 - V)/2, and the pressure must be P_H again
	for (double eps : { -1e-3, -0.05, -0.2 }) {
		const double energy = 0.5 * pressure(e, eps) * -eps / e.rho0;
		EXPECT_NEAR(hotPressure<EosKind::mieGruneisen>(e, eps, energy), pressure(e, eps), 1e-12 * pressure(e, eps));
	}
	EXPECT_DOUBLE_EQ(hotPressure<EosKind::mieGruneisen>(e, 0.01, 0.), pressure(e, 0.01));
	EXPECT_DOUBLE_EQ(hotPressure<EosKind::mieGruneisen>(e, 0., 1e5), e.gruneisen * e.rho0 * 1e5);
}

TEST(AutomataYield, StaticYieldStressIsJohnsonCook)
{
	const Yield y = steel(YieldKind::johnsonCook).yield;
	for (double ep : { 1e-4, 1e-3, 0.1, 1., 5. })
		for (double T : { 298., 600., 1500., 1793., 3000. }) {
			const double hom = std::min(std::max((T - 298.) / (1793. - 298.), 0.), 1.), soft = 1 - std::pow(hom, 1.03);
			const auto   s = staticYield<YieldKind::johnsonCook>(y, ep, T);
			EXPECT_NEAR(s.stress, (y.yieldStress + y.hardeningModulus * std::pow(ep, y.hardeningExponent)) * soft, 1e-13 * y.yieldStress);
			const double slope = y.hardeningModulus * y.hardeningExponent * std::pow(ep, y.hardeningExponent - 1);
			EXPECT_NEAR(s.slope, slope * soft, 1e-12 * slope);
		}
	EXPECT_EQ(staticYield<YieldKind::johnsonCook>(y, 0., 298.).stress, y.yieldStress);
	Yield h = y;
	h.kind = YieldKind::linearHardening, h.hardeningModulus = 2e9;
	EXPECT_DOUBLE_EQ(staticYield<YieldKind::linearHardening>(h, 0.25, 0.).stress, h.yieldStress + 0.5e9);
	EXPECT_EQ(staticYield<YieldKind::perfect>(h, 7., 0.).stress, h.yieldStress);
	EXPECT_TRUE(std::isinf(staticYield<YieldKind::elastic>(h, 7., 0.).stress));
}

TEST(AutomataYield, ReturnMappingAgreesWithABisection)
{
	const double threeG = 3 * 80e9;
	for (double dt : { 1e-12, 1e-10, 2e-8, 1e-6, 1. })
	for (YieldKind kind : { YieldKind::perfect, YieldKind::linearHardening, YieldKind::johnsonCook })
		for (double ep : { 0., 1e-3, 0.1, 1. })
			for (double T : { 298., 900. })
				for (double over : { 0.5, 0.999999, 1. + 1e-9, 1.000001, 1.01, 1.05, 1.1, 1.15, 1.3, 3., 100. }) {
					const Yield y = steel(kind).yield;
					Return      r { 0, 0 };
					double      Y0 = 0, slope = 0;
					dispatch(kind, [&](auto k) {
						const auto s = staticYield<k.value>(y, ep, T);
						Y0 = s.stress, slope = s.slope;
						r = radialReturn<k.value>(y, over * Y0, ep, T, threeG, dt);
					});
					const double trial = over * Y0;
					if (over < 1) {
						EXPECT_EQ(r.scale, 1.);
						EXPECT_EQ(r.dEqps, 0.);
						continue;
					}
					// consistency trial - 3G e = (Y0 + slope e)(1 + C ln max(rate, 1)), hardening linear over one step
					const auto gap = [&](double e) {
						const double f = kind == YieldKind::johnsonCook
							? 1 + y.rateCoefficient * std::log(std::max(e / (dt * y.referenceRate), 1.))
							: 1.;
						return trial - threeG * e - (Y0 + slope * e) * f;
					};
					double lo = 0, hi = trial / threeG;
					if (gap(0.) <= 0) hi = 0;
					for (int k = 0; k < 200 && hi > lo; k++)
						(gap(0.5 * (lo + hi)) > 0 ? lo : hi) = 0.5 * (lo + hi);
					const double tolerance = kind == YieldKind::johnsonCook ? 1e-10 * Y0 / threeG + 1e-14 : 1e-12 * trial / threeG;
					EXPECT_NEAR(r.dEqps, 0.5 * (lo + hi), tolerance) << int(kind) << ' ' << ep << ' ' << T << ' ' << over;
					EXPECT_NEAR(r.scale, (trial - threeG * r.dEqps) / trial, 1e-14);
					EXPECT_TRUE(r.scale >= 0 && r.scale <= 1);
				}
}

TEST(AutomataPair, LatticeIdentityAndVolumeRules)
{
	for (double d : { 1e-6, 1e-3, 2. }) {
		EXPECT_NEAR(Lattice::cell(d) / (6 * Lattice::width(d) * d / 4), 1., 1e-15); // Omega0 = N0 S0 d/(2 dim)
		for (double q : { 0.7, 1., 1.2 }) { // equal stretch q of all pairs: J = q^dim
			const double r2 = q * q * d * d, inverse = volumeTerm<VolumeRule::inversePower>(d, r2),
				     mean = volumeTerm<VolumeRule::meanDistance>(d, r2);
			EXPECT_NEAR((volumeRatio<VolumeRule::inversePower>(inverse)), q * q, 1e-14);
			EXPECT_NEAR((volumeRatio<VolumeRule::meanDistance>(mean)), q * q, 1e-14);
		}
	}
	for (int k = 0; k < 6; k++) {
		EXPECT_NEAR(Lattice::x[k], std::cos(k * M_PI / 3), 1e-15);
		EXPECT_NEAR(Lattice::y[k], std::sin(k * M_PI / 3), 1e-15);
	}
}

TEST(AutomataPair, PressureForceIsTheDerivativeOfTheEnergy)
{
	// one automaton with six pairs of length r: dW/dr of one pair, the others held, against share * shape * r
	const Eos    e = copper();
	const double d = 1e-3, cell = Lattice::cell(d);
	const auto   check = [&](auto rule, double r) {
                constexpr VolumeRule R = decltype(rule)::value;
                const auto           J = [&](double one) { return volumeRatio<R>((5 * volumeTerm<R>(d, r * r) + volumeTerm<R>(d, one * one)) / 6); };
                const auto           W = [&](double one) { return cell * storedEnergy(e, J(one) - 1); };
                const double         h = 1e-4 * d, slope = (8 * (W(r + h) - W(r - h)) - (W(r + 2 * h) - W(r - 2 * h))) / (12 * h);
                const double         force = pressureShare<R>(pressure(e, J(r) - 1), J(r), cell / 6) * pressureShape<R>(d, 1 / (r * r)) * r;
                EXPECT_NEAR(-slope / force, 1., 1e-7) << r / d;
	};
	for (double q : { 0.85, 0.95, 1.05 }) {
		check(std::integral_constant<VolumeRule, VolumeRule::inversePower> {}, q * d);
		check(std::integral_constant<VolumeRule, VolumeRule::meanDistance> {}, q * d);
	}
}

TEST(AutomataPair, StrainIncrementAtMidStep)
{
	// a pair that turns by a finite angle about its contact and stretches: no strain from the turn when the spin goes with it
	for (double angle : { 0., 1e-3, 0.3, 1.5 })
		for (double stretch : { 1., 1.01, 0.7 }) {
			const double x0 = 1.1, y0 = -0.4, c = std::cos(angle) * stretch, s = std::sin(angle) * stretch;
			const double x = c * x0 - s * y0, y = s * x0 + c * y0;
			if (stretch == 1.) {
				const auto e = strainIncrement(Vec<double> { x, y }, Vec<double> { x - x0, y - y0 }, 2 * std::tan(0.5 * angle));
				EXPECT_NEAR(e.normal, 0., 1e-15);
				EXPECT_NEAR(e.shear, 0., 1e-15);
			} else if (angle == 0) {
				const auto e = strainIncrement(Vec<double> { x, y }, Vec<double> { x - x0, y - y0 }, 0.);
				EXPECT_NEAR(e.normal, 2 * (stretch - 1) / (stretch + 1), 1e-15);
				EXPECT_NEAR(e.shear, 0., 1e-15);
			}
		}
	const auto e = strainIncrement(Vec<double> { 1., 0.005 }, Vec<double> { 0., 0.01 }, 0.002); // pure transverse motion
	EXPECT_NEAR(e.shear, 0.01 - 0.002, 1e-15);
	EXPECT_NEAR(e.normal, 0., 1e-15);
}

TEST(AutomataPair, ViscosityStepAndEquivalentStress)
{
	const double r = 0.9e-3, v = -30., rho = 8930., c = 3940., S0 = 1e-3, c1 = 0.25, c2 = 1.2;
	const double q = viscousCoefficient(r * v, 1 / (r * r), rho * c1 * c, rho * c2, S0) * r; // force along n
	EXPECT_NEAR(-q, S0 * rho * (c1 * c * std::fabs(v) + c2 * v * v), 1e-9 * -q);
	EXPECT_EQ(viscousCoefficient(r * -v, 1 / (r * r), rho * c1 * c, rho * c2, S0), 0.);
	EXPECT_NEAR(equivalentStress2(2., 3.), 3 * 2. + 1.5 * 9., 1e-14);
	EXPECT_NEAR(stableStep(1., 2., 1e-9, 0.), 1.65 / 2., 1e-15);
	EXPECT_NEAR(stableStep(1., 2., 1e-9, 0.75), 1.65 / 2. * 0.5, 1e-15);
	EXPECT_NEAR(stableStep(1., 2., 1.9, 0.), 1 / (std::sqrt(8.) * 1.9), 1e-15); // 2/omega, omega^2 = 32 G/(rho d^2)
}

TEST(AutomataPair, RigidTurnMakesNoStrain)
{
	for (double a : { 1e-6, 0.01, 0.05, 0.2 }) {
		EXPECT_NEAR(chord(a), 2 * std::tan(0.5 * a), 1.01 * 17. / 20160. * std::pow(a, 7) + 1e-16 * a) << a;
		const Vec<double> old { 1., 0.3 }, now { std::cos(a) * old[0] - std::sin(a) * old[1], std::sin(a) * old[0] + std::cos(a) * old[1] };
		const auto        e = strainIncrement(now, now - old, pairSpin(a, a, 0.4, 1.));
		EXPECT_NEAR(e.normal, 0., 1e-15) << a;
		EXPECT_NEAR(e.shear, 0., std::pow(a, 7) * 1e-3 + 1e-15) << a;
	}
}

// (5f) is minus the derivative of the energy of the sides by the own dilation, and nothing in a uniform field of a whole star.
TEST(AutomataPair, MeanPressureIsTheConjugateOfTheOwnDilation)
{
	std::mt19937                           r(7);
	std::uniform_real_distribution<double> u(-1e-3, 1e-3);
	const double                           G = 80e9, twoG = 2 * G;
	for (int trial = 0; trial < 50; trial++) {
		const int    holding = trial % 2 ? nLinks : 4;
		const double invN = 1. / nLinks, exx = u(r), eyy = u(r), exy = u(r);
		double       e[nLinks] = {};
		for (int k = 0; k < holding; k++) {
			const double x = Lattice::x[k], y = Lattice::y[k];
			e[k] = trial % 4 == 3 ? x * x * exx + 2 * x * y * exy + y * y * eyy : u(r);
		}
		const auto energy = [&](double theta, double& normals, double& szz) {
			double squares = 0;
			normals = 0, szz = -twoG / 3. * theta;
			for (int k = 0; k < holding; k++) {
				const auto s = trialStress(Pair<double> { 0., 0. }, Pair<double> { e[k], 0. }, pairDilation(theta, 12345., ofOwn), twoG);
				normals += s.normal, squares += square(s);
			}
			return equivalentStress2(squares * invN, szz) / (6. * G);
		};
		const double theta = trial % 4 == 3 ? exx + eyy : u(r), h = 1e-7;
		double       normals, szz, a, b;
		const double slope = (energy(theta + h, a, b) - energy(theta - h, a, b)) / (2. * h);
		energy(theta, normals, szz);
		const double found = meanPressure(1e9, normals, 1., szz, invN, 0.7, 0.7, G) - 1e9;
		EXPECT_NEAR(found, -slope, 1e-6 * G * 1e-3) << trial;
		if (trial % 4 == 3) EXPECT_NEAR(found, 0., 1e-12 * G) << trial;
	}
}

TEST(AutomataPair, ViscousPressureAndItsStep)
{
	Material m;
	m.eos                 = copper();
	m.G                   = 48e9;
	m.viscosity           = { 0.25, 1.2 };
	const double        d = 1e-3, dt = 1e-8, theta = -2e-4, rate = theta / dt;
	const BulkViscosity v(m, d, 1. / dt);
	const double        q = m.eos.rho0 * (0.25 * m.eos.c0 * d * std::fabs(rate) + 1.2 * d * d * rate * rate);
	const double        rest = m.eos.bulkModulus(), stiff = tangent(m.eos, -0.15), linear = 0.25 * std::sqrt(m.eos.rho0 * stiff) * d * std::fabs(rate);
	EXPECT_NEAR(v.pressure(theta, 1., rest), q, 1e-12 * q);
	EXPECT_NEAR(v.pressure(theta, 1., stiff), linear + m.eos.rho0 * 1.2 * d * d * rate * rate, 1e-12 * q);
	EXPECT_NEAR(v.pressure(theta, 4., rest), m.eos.rho0 * (0.25 * m.eos.c0 * 0.5 * d * std::fabs(rate) + 1.2 * 0.25 * d * d * rate * rate), 1e-12 * q);
	EXPECT_NEAR(v.pressure(theta, 1., -rest), m.eos.rho0 * 1.2 * d * d * rate * rate, 1e-12 * q); // beyond a spinodal there is no sound
	EXPECT_EQ(v.pressure(1e-4, 1., rest), 0.);
	EXPECT_EQ(BulkViscosity(m, d, 0.).pressure(theta, 1., rest), 0.); // nothing has moved
	const double J = 0.9, Jo = J * (2. - theta) / (2. + theta);
	EXPECT_NEAR(viscousWork(q, theta, J), q * (Jo - J), 1e-12 * q);
	EXPECT_EQ(ofLink({ 3., 4. }, VolumeRule::affine).quadratic, 0.);
	EXPECT_EQ(ofLink({ 3., 4. }, VolumeRule::inversePower).quadratic, 4.);
	const auto zeta = [&](double stiffer, double approach) { return dampingRatio(m, VolumeRule::affine, stiffer * m.cP(), approach); };
	EXPECT_GT(zeta(1., 0.), 0.25);
	const double ofVolume = 0.25 * 1.377 / (2. * 1.212); // with the present speed of sound
	EXPECT_NEAR(zeta(2., 0.) - ofVolume, 0.5 * (zeta(1., 0.) - ofVolume), 1e-15);
	EXPECT_GT(zeta(1., 100.), zeta(1., 0.));
	m.viscosity = { 0., 0. };
	EXPECT_EQ(zeta(1., 100.), 0.);
}

TEST(AutomataMath, LogExpPowAgainstTheLibrary)
{
	std::mt19937                           r(4);
	std::uniform_real_distribution<double> u(-300, 300);
	for (int k = 0; k < 20000; k++) {
		const double x = u(r), y = std::exp(x);
		EXPECT_NEAR(fastExp(x) / y, 1., 4e-16 + 1e-18 * std::fabs(x));
		EXPECT_NEAR(fastLog(y), std::log(y), 4e-16 * std::max(1., std::fabs(x)));
		EXPECT_NEAR(fastPow(y, 0.26) / std::pow(y, 0.26), 1., 1e-13);
	}
	for (int k = 0; k < 20000; k++) {
		const float x = float(u(r) / 4.), y = std::exp(x);
		EXPECT_NEAR(roughLog(y), x, 2e-6 * std::max(1.f, std::fabs(x)));
		EXPECT_NEAR(roughExp(-std::fabs(x)) / std::exp(-double(std::fabs(x))), 1., 1e-4);
	}
	EXPECT_EQ(fastPow(0., 0.26), 0.);
	EXPECT_EQ(fastLog(1.), 0.);
	EXPECT_EQ(fastExp(0.), 1.);
}
