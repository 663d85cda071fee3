// SPDX-License-Identifier: GPL-2.0-or-later
// Homogeneous deformation: pressure, deviator and forces of an interior automaton against the continuum, in any orientation of the rows.
#include "automata_scene.hpp"
#include <array>
using namespace automatatest;

namespace {
constexpr double d = 1e-3;

struct Field {
	double P, Mises, szz;
	double sxx, sxy, syx, syy; ///< Cauchy stress across a row, from the forces alone
	double worst;              ///< largest force on an interior automaton / (stress times diameter)
};

/// Block of nx columns deformed in one step from rest by x -> (1 + H) x. The lower half of its rows pulls the upper half.
Field deform(const std::array<double, 4>& H, double angle, const Material& m, VolumeRule rule, int nx, double spin, double J0 = 1)
{
	const int  ny = 16;
	const auto list = packing(d, nx, ny, m, { 0, 0, angle });
	Material   still = m;
	still.viscosity  = { 0., 0. }; // the steps here are jumps
	Options o;
	o.volumeRule = rule, o.contacts = false, o.sleeping = false;
	Solver s;
	s.build(list, { still }, o);
	Store& S = s.store;
	s.computeForces();
	const double dt = 1e-3 * s.criticalStep();
	if (J0 != 1) { // first a pure compression to J0
		for (size_t i = 0; i < S.size(); i++)
			S.velocity[0][i] = (std::sqrt(J0) - 1) * S.position[0][i] / dt, S.velocity[1][i] = (std::sqrt(J0) - 1) * S.position[1][i] / dt;
		for (size_t i = 0; i < S.size(); i++) S.perMass[0][i] = S.perMass[1][i] = S.perInertia[i] = 0;
		s.integrate(dt);
		s.computeForces();
	}
	for (size_t i = 0; i < S.size(); i++) {
		S.velocity[0][i] = (H[0] * S.position[0][i] + H[1] * S.position[1][i]) / dt,
		S.velocity[1][i] = (H[2] * S.position[0][i] + H[3] * S.position[1][i]) / dt;
		S.omega[i] = spin * 0.5 * (H[2] - H[1]) / dt;
		S.perMass[0][i] = S.perMass[1][i] = S.perInertia[i] = 0;
	}
	s.integrate(dt);
	s.computeForces();
	const size_t c = size_t(s.indexOf((ny / 2) * nx + nx / 2));
	Field        f {};
	f.P = S.P[c], f.Mises = s.equivalentStress(c), f.szz = S.szz[c];
	double fx = 0, fy = 0;
	for (int j = 0; j < ny; j++)
		for (int i = 0; i < nx; i++) {
			const size_t q = size_t(s.indexOf(j * nx + i));
			if (j >= ny / 2) fx += S.force[0][q], fy += S.force[1][q]; // force of the lower half on the upper
			if (i > 3 && i < nx - 4 && j > 3 && j < ny - 4)
				f.worst = std::max(f.worst, std::hypot(S.force[0][q], S.force[1][q]) / (d * (std::fabs(f.P) + f.Mises)));
		}
	f.sxx = fx, f.sxy = fy;
	return f;
}

/// Cauchy traction of the lower on the upper half per length of the row, from blocks of two widths: the ends cancel.
std::array<double, 2> traction(const std::array<double, 4>& H, double angle, const Material& m, VolumeRule rule, double J0 = 1)
{
	const Field a = deform(H, angle, m, rule, 16, 1, J0), b = deform(H, angle, m, rule, 24, 1, J0);
	return { (b.sxx - a.sxx) / (8 * d), (b.sxy - a.sxy) / (8 * d) };
}

/// Value at h -> 0 of an expression that is even in h, by Richardson's scheme from h, h/2, h/4, h/8.
template <class F> double limit(F&& even)
{
	double t[4];
	for (int k = 0; k < 4; k++) {
		const double h = 8e-3 / (1 << k);
		t[k]           = even(h);
	}
	for (int m = 1; m < 4; m++)
		for (int k = 3; k >= m; k--) t[k] += (t[k] - t[k - 1]) / (std::pow(4., m) - 1);
	return t[3];
}
std::array<double, 4> scaled(const std::array<double, 4>& H, double h) { return { h * H[0], h * H[1], h * H[2], h * H[3] }; }

const double                angles[] = { 0., 0.2, M_PI / 6, 0.5 * M_PI, 2.3 };
const std::array<double, 4> modes[]  = {
	 { 1, 0, 0, 1 }, { 1, 0, 0, -1 }, { 0, 1, 1, 0 }, { 1, 0, 0, 0 }, { 0, 0, 0, 1 }, { 0, 1, 0, 0 }, { 0.4, -0.7, 0.2, 0.9 }
};
}

// The three volume rules are the same medium in small deformations: exactly (K, G), isotropic.
TEST(AutomataUniform, HookeIsExactInEveryOrientation)
{
	const Material m = steel();
	const double   K = m.eos.bulkModulus(), G = m.G;
	for (VolumeRule rule : { VolumeRule::affine, VolumeRule::inversePower, VolumeRule::meanDistance })
		for (double angle : angles)
			for (auto& H : modes) {
				const double exx = H[0], eyy = H[3], exy = 0.5 * (H[1] + H[2]), tr = exx + eyy, dxx = exx - tr / 3, dyy = eyy - tr / 3,
					     dzz   = -tr / 3;
				const double mises = 2 * G * std::sqrt(1.5 * (dxx * dxx + dyy * dyy + dzz * dzz + 2 * exy * exy)), scale = K + 2 * G;
				Material     lin = m;
				lin.eos.hugoniotSlope = 0; // in compression and tension the same, so that the expression is even
				const auto at = [&](double h) { return deform(scaled(H, h), angle, lin, rule, 16, 1); };
				const auto odd = [&](auto pick) { return limit([&](double h) { return (pick(at(h)) - pick(at(-h))) / (2 * h); }); };
				EXPECT_NEAR(odd([](const Field& f) { return f.P; }), -K * tr, 2e-12 * scale) << angle;
				EXPECT_NEAR(odd([](const Field& f) { return f.szz; }), 2 * G * dzz, 2e-12 * scale) << angle;
				EXPECT_NEAR(limit([&](double h) { return (at(h).Mises + at(-h).Mises) / (2 * h); }), mises, 2e-12 * scale) << angle;
				if (rule != VolumeRule::affine && angle > 0) continue;
				// traction on the upper half across a row with unit normal n: the force of what lies below is -sigma n
				const double nx = -std::sin(angle), ny = std::cos(angle), sxx = K * tr + 2 * G * dxx, syy = K * tr + 2 * G * dyy,
					     sxy = 2 * G * exy;
				const auto pull  = [&](int k) {
                                        return limit([&](double h) {
                                                return (traction(scaled(H, h), angle, lin, rule)[k] - traction(scaled(H, -h), angle, lin, rule)[k]) / (2 * h);
                                        });
				};
				EXPECT_NEAR(pull(0), -(sxx * nx + sxy * ny), 3e-12 * scale) << angle;
				EXPECT_NEAR(pull(1), -(sxy * nx + syy * ny), 3e-12 * scale) << angle;
			}
}

TEST(AutomataUniform, InteriorStaysInEquilibriumAtAnyStrain)
{
	for (VolumeRule rule : { VolumeRule::affine, VolumeRule::inversePower, VolumeRule::meanDistance })
		for (YieldKind kind : { YieldKind::elastic, YieldKind::perfect, YieldKind::linearHardening, YieldKind::johnsonCook })
			for (double angle : { 0., 0.2, 2.3 })
				for (auto H : { std::array<double, 4> { -0.1, 0.05, 0.02, -0.05 }, std::array<double, 4> { 0.03, 0.3, 0., 0.02 } })
					EXPECT_LT(deform(H, angle, steel(kind), rule, 16, 1).worst, 1e-12) << int(rule) << int(kind) << angle;
}

// Only the affine rule is exact beyond small strain: J = det F, and the traction of a hydrostatic state is P in any direction of rows.
TEST(AutomataUniform, AffineRuleIsExactAtFiniteStrain)
{
	const Material m = steel();
	for (double angle : angles)
		for (auto H : { std::array<double, 4> { -0.1, 0.05, 0.02, -0.05 }, std::array<double, 4> { 0.03, 0.3, 0., 0.02 },
		                std::array<double, 4> { -0.2, 0., 0., 0. } }) {
			const double J = (1 + H[0]) * (1 + H[3]) - H[1] * H[2];
			EXPECT_NEAR(deform(H, angle, m, VolumeRule::affine, 16, 1).P / pressure(m.eos, J - 1), 1., 1e-12);
		}
	Material fluid = m;
	fluid.G        = 0;
	for (double angle : angles) {
		const std::array<double, 4> H = { -0.1, 0.05, 0.02, -0.05 };
		const double                P = deform(H, angle, fluid, VolumeRule::affine, 16, 1).P;
		// force on the deformed row of unit length: P times its normal
		const double tx = std::cos(angle), ty = std::sin(angle), ux = tx + H[0] * tx + H[1] * ty, uy = ty + H[2] * tx + H[3] * ty;
		const auto   t = traction(H, angle, fluid, VolumeRule::affine);
		EXPECT_NEAR(t[0] / P, -uy, 1e-11);
		EXPECT_NEAR(t[1] / P, ux, 1e-11);
	}
}

// Tangent moduli on top of a pressure: rho c_S^2 = G for the affine rule at any pressure; the published rule loses 3/4 P.
TEST(AutomataUniform, ShearStiffnessUnderPressure)
{
	const Material m = steel();
	for (double angle : angles) {
		const double P = deform({ 0, 0, 0, 0 }, angle, m, VolumeRule::affine, 16, 1, 0.9).P;
		// the compression has left a deviatoric stress s0 in all pairs, which turn with the material: they add s0/2
		const double q = std::sqrt(0.9), s0 = 2 * m.G * (2 * (q - 1) / (q + 1) - 2 * (0.9 - 1) / (0.9 + 1) / 3);
		const auto   stiffness = [&](VolumeRule rule) {
                        // simple shear along the rows: change of the shear traction per shear
                        const double c = std::cos(angle), s = std::sin(angle);
                        const auto   along = [&](double h) {
                                const std::array<double, 4> H = { -h * c * s, h * c * c, -h * s * s, h * c * s };
                                const auto                  t = traction(H, angle, m, rule, 0.9);
                                return -(t[0] * c + t[1] * s);
                        };
                        return limit([&](double h) { return (along(h) - along(-h)) / (2 * h); });
		};
		EXPECT_NEAR(stiffness(VolumeRule::affine) / ((m.G + 0.5 * s0) * q), 1., 1e-9) << P; // per rest length
		EXPECT_LT(stiffness(VolumeRule::meanDistance), stiffness(VolumeRule::affine) - 0.4 * P);
		EXPECT_GT(stiffness(VolumeRule::inversePower), stiffness(VolumeRule::affine) - 0.1 * P);
	}
}

TEST(AutomataUniform, YieldSurfaceIsMises)
{
	const Material m = steel(YieldKind::perfect);
	for (double angle : angles)
		for (auto& H : modes) {
			const Field f = deform(scaled(H, 0.02), angle, m, VolumeRule::affine, 16, 1);
			EXPECT_NEAR(f.Mises / m.yield.yieldStress, 1., 1e-12) << angle;
		}
}

TEST(AutomataUniform, RigidRotationLeavesStressUnchanged)
{
	// a strained block is turned by finite steps: invariants stay, forces turn with it
	const Material m    = steel();
	const auto     list = packing(d, 12, 12, m, { 0, 0, 0.1 });
	Options        o;
	o.contacts = false, o.sleeping = false;
	Solver s;
	s.build(list, { m }, o);
	Store& S = s.store;
	s.computeForces();
	const double dt = 1e-3 * s.criticalStep();
	for (size_t i = 0; i < S.size(); i++) {
		S.perMass[0][i] = S.perMass[1][i] = S.perInertia[i] = 0;
		S.velocity[0][i]                                    = (0.003 * S.position[0][i] + 0.004 * S.position[1][i]) / dt,
		S.velocity[1][i] = (0.002 * S.position[0][i] - 0.001 * S.position[1][i]) / dt, S.omega[i] = 0.;
	}
	s.integrate(dt);
	s.computeForces();
	const size_t c = size_t(s.indexOf(6 * 12 + 6));
	const double P = S.P[c], q = s.equivalentStress(c), szz = S.szz[c], f0 = std::hypot(S.force[0][s.indexOf(0)], S.force[1][s.indexOf(0)]);
	const int    perTurn = 720, turns = 15;
	const double a = 2 * M_PI / perTurn;
	double       worst = 0;
	const auto   x0 = S.position[0], y0 = S.position[1];
	for (int k = 1; k <= perTurn * turns; k++) {
		// to where the exact rotation has them: rounding errors of the path do not add up
		const double C = std::cos((k % perTurn) * a), D = std::sin((k % perTurn) * a);
		for (size_t i = 0; i < S.size(); i++) {
			S.velocity[0][i] = (C * x0[i] - D * y0[i] - S.position[0][i]) / dt, S.velocity[1][i] = (D * x0[i] + C * y0[i] - S.position[1][i]) / dt;
			S.omega[i] = a / dt;
		}
		s.integrate(dt);
		s.computeForces();
		const double f = std::hypot(S.force[0][s.indexOf(0)], S.force[1][s.indexOf(0)]);
		for (double error : { S.P[c] / P, s.equivalentStress(c) / q, S.szz[c] / szz, f / f0 })
			worst = std::max(worst, std::fabs(error - 1));
	}
	EXPECT_LT(worst, 1e-9);
}
