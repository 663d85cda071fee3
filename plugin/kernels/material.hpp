// SPDX-License-Identifier: GPL-2.0-or-later
// All constants of one material, as automata and grid use them.
#pragma once
#include "error.hpp"
#include "eos.hpp"
#include "yield.hpp"
#include <cmath>
#include <sstream>

namespace mca {

/// Artificial viscosity q = rho (linear c |dv| + quadratic dv^2), zero in expansion (formulation, section 2.7 and 3).
struct Viscosity {
	double linear    = 0.25; ///< c1 [-]
	double quadratic = 1.2;  ///< c2 [-]
	bool   active() const { return linear > 0 || quadratic > 0; }
};

/// Criteria at which a link breaks; infinite = never tested (section 2.5).
struct Fracture {
	double strain        = std::numeric_limits<double>::infinity(); ///< equivalent plastic strain of the pair [-]
	double spall         = std::numeric_limits<double>::infinity(); ///< tensile pressure [Pa]
	double pairStress    = std::numeric_limits<double>::infinity(); ///< tensile normal stress of the pair [Pa]
	double mises         = std::numeric_limits<double>::infinity(); ///< sigma_eq [Pa], or sigma_c of the two-parameter criterion
	double ratio         = 1;                                       ///< a = sigma_c/sigma_t of the two-parameter criterion; 1 = Mises [-]
	bool   active() const { return std::isfinite(strain) || std::isfinite(spall) || std::isfinite(pairStress) || std::isfinite(mises); }
};

struct Material {
	Eos       eos;
	double    G = 0; ///< shear modulus [Pa]
	Yield     yield;
	Fracture  fracture;
	Viscosity viscosity;
	double    friction = 0; ///< Coulomb coefficient of unlinked contacts [-]

	/// Longitudinal sound speed at rest [m/s].
	double cP() const { return longitudinalSpeed(eos, G, 0.); }
	/// Shear wave speed at rest [m/s].
	double cS() const { return std::sqrt(G / eos.rho0); }
};

/// f(constant) for every constant, in a fixed order: numbers, truth values and YieldKind. What saves or compares materials goes by this list.
template <class F> void eachConstant(Material& m, F&& f)
{
	f(m.eos.rho0), f(m.eos.c0), f(m.eos.b), f(m.eos.gamma0), f(m.eos.mieGrueneisen), f(m.eos.clampAt), f(m.G);
	f(m.yield.kind), f(m.yield.A), f(m.yield.B), f(m.yield.n), f(m.yield.C), f(m.yield.rate0), f(m.yield.m), f(m.yield.Tm), f(m.yield.T0), f(m.yield.heatPerWork);
	f(m.fracture.strain), f(m.fracture.spall), f(m.fracture.pairStress), f(m.fracture.mises), f(m.fracture.ratio);
	f(m.viscosity.linear), f(m.viscosity.quadratic), f(m.friction);
}
constexpr int yieldKinds = 4;

/// Throws mca::Error naming the first constant that is out of range. name: how the user calls the material.
inline void validate(const Material& m, const std::string& name)
{
	auto need = [&](bool ok, const char* what, double value, const char* range) {
		if (ok) return;
		std::ostringstream s;
		s << "material '" << name << "': " << what << " = " << value << " is not allowed; it must be " << range << ".";
		throw Error(s.str());
	};
	const double inf = 1e100; // no constant is as large in any system of units, and products of larger ones are not finite
	need(m.eos.rho0 > 0 && m.eos.rho0 < inf, "density [kg/m3]", m.eos.rho0, "finite and above zero");
	need(m.eos.c0 > 0 && m.eos.c0 < inf, "bulkSoundSpeed [m/s]", m.eos.c0, "finite and above zero");
	need(m.eos.b >= 0 && m.eos.b < inf, "hugoniotSlope [-]", m.eos.b, "finite and not negative (0: linear law)");
	need(m.eos.gamma0 >= 0 && m.eos.gamma0 < inf, "gruneisen [-]", m.eos.gamma0, "finite and not negative");
	need(m.eos.clampAt > 0 && m.eos.clampAt < 1, "clampAt [-]", m.eos.clampAt, "between 0 and 1");
	need(m.G >= 0 && m.G < inf, "shearModulus [Pa]", m.G, "finite and not negative");
	need(m.yield.A >= 0, "yieldStress [Pa]", m.yield.A, "not negative (infinite: elastic)");
	need(m.yield.B >= 0 && m.yield.B < inf, "hardeningModulus [Pa]", m.yield.B, "finite and not negative");
	// those of Johnson and Cook must be numbers for any law: nobody means NaN
	need(std::fabs(m.yield.n) < inf, "hardeningExponent [-]", m.yield.n, "finite");
	need(std::fabs(m.yield.C) < inf, "rateCoefficient [-]", m.yield.C, "finite");
	need(std::fabs(m.yield.rate0) < inf, "referenceRate [1/s]", m.yield.rate0, "finite");
	need(std::fabs(m.yield.m) < inf, "thermalSoftening [-]", m.yield.m, "finite");
	need(m.yield.Tm > 0, "meltTemperature [K]", m.yield.Tm, "above zero (infinite: never)");
	need(m.yield.T0 >= 0 && m.yield.T0 < inf, "referenceTemperature [K]", m.yield.T0, "finite and not negative");
	if (m.yield.kind == YieldKind::johnsonCook) {
		need(m.yield.A < inf, "yieldStress [Pa]", m.yield.A, "finite for johnsonCook");
		need(m.yield.n > 0 && m.yield.n <= 1, "hardeningExponent [-]", m.yield.n, "in (0, 1]");
		need(m.yield.C >= 0 && m.yield.C < 1, "rateCoefficient [-]", m.yield.C, "in [0, 1)");
		need(m.yield.rate0 > 0 && m.yield.rate0 < inf, "referenceRate [1/s]", m.yield.rate0, "finite and above zero");
		need(m.yield.m > 0 && m.yield.m < inf, "thermalSoftening [-]", m.yield.m, "finite and above zero");
		need(m.yield.Tm > m.yield.T0, "meltTemperature [K]", m.yield.Tm, "above referenceTemperature");
	}
	need(m.yield.heatPerWork >= 0 && m.yield.heatPerWork < inf, "taylorQuinney/(density heatCapacity) [K m3/J]", m.yield.heatPerWork, "finite and not negative");
	need(m.fracture.strain > 0, "fractureStrain [-]", m.fracture.strain, "above zero (infinite: never)");
	need(m.fracture.spall > 0, "spallStrength [Pa]", m.fracture.spall, "above zero (infinite: never)");
	need(m.fracture.pairStress > 0, "pairStrength [Pa]", m.fracture.pairStress, "above zero (infinite: never)");
	need(m.fracture.mises > 0, "fractureStress [Pa]", m.fracture.mises, "above zero (infinite: never)");
	need(m.fracture.ratio >= 1 && m.fracture.ratio < inf, "strengthRatio [-]", m.fracture.ratio, "finite and at least 1");
	need(m.viscosity.linear >= 0 && m.viscosity.linear < inf, "viscosityLinear [-]", m.viscosity.linear, "finite and not negative");
	need(m.viscosity.quadratic >= 0 && m.viscosity.quadratic < inf, "viscosityQuadratic [-]", m.viscosity.quadratic, "finite and not negative");
	need(m.friction >= 0 && m.friction <= 1300, "friction [-]", m.friction, "from 0 to 1300 (an angle below pi/2)");
}

/// Equal in every constant.
inline bool same(const Material& a, const Material& b)
{
	const Eos &e = a.eos, &f = b.eos;
	const Yield &y = a.yield, &z = b.yield;
	const Fracture &p = a.fracture, &q = b.fracture;
	return e.rho0 == f.rho0 && e.c0 == f.c0 && e.b == f.b && e.gamma0 == f.gamma0 && e.mieGrueneisen == f.mieGrueneisen && e.clampAt == f.clampAt && a.G == b.G && y.kind == z.kind && y.A == z.A && y.B == z.B && y.n == z.n
	        && y.C == z.C && y.rate0 == z.rate0 && y.m == z.m && y.Tm == z.Tm && y.T0 == z.T0 && y.heatPerWork == z.heatPerWork && p.strain == q.strain && p.spall == q.spall && p.pairStress == q.pairStress && p.mises == q.mises
	        && p.ratio == q.ratio && a.viscosity.linear == b.viscosity.linear && a.viscosity.quadratic == b.viscosity.quadratic && a.friction == b.friction;
}
}
