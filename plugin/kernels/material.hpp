// SPDX-License-Identifier: GPL-2.0-or-later
// All constants of one material, as automata and grid use them.
#pragma once
#include "damage.hpp"
#include "error.hpp"
#include "eos.hpp"
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

namespace mca {

/// Artificial viscosity q = rho (linear c |dv| + quadratic dv^2), zero in expansion (formulation, equation (12)).
struct Viscosity {
	double linear    = 0.25; ///< c1 [-]
	double quadratic = 1.2;  ///< c2 [-]
	bool   active() const { return linear > 0 || quadratic > 0; }
};

/// Criteria at which a link breaks; infinite = never tested (formulation, page Material, and equation (11b)).
struct Fracture {
	double strain        = std::numeric_limits<double>::infinity(); ///< equivalent plastic strain of the pair [-]
	double spall         = std::numeric_limits<double>::infinity(); ///< tensile pressure [Pa]
	double pairStress    = std::numeric_limits<double>::infinity(); ///< tensile normal stress of the pair [Pa]
	double mises         = std::numeric_limits<double>::infinity(); ///< sigma_eq [Pa], or sigma_c of the two-parameter criterion
	double ratio         = 1;                                       ///< a = sigma_c/sigma_t of the two-parameter criterion; 1 = Mises [-]
	double energy        = 0;                                       ///< G_f, spent while a broken pair opens [J/m2]; 0: none, it parts at once
	DuctileDamage damage;
	bool          active() const
	{
		return std::isfinite(strain) || std::isfinite(spall) || std::isfinite(pairStress) || std::isfinite(mises) || damage.active();
	}
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

/// What is given for the pairs of two unlike materials (an interface, glue) beside what follows from both.
struct PairRule {
	int    first = -1, second = -1;                              ///< places of the materials
	double strength = 1;                                         ///< factor on the criteria of their links [-]
	double tension  = std::numeric_limits<double>::infinity();   ///< normal stress at which their links break [Pa]
	double friction = -1;                                        ///< Coulomb coefficient [-]; below zero: the smaller of both
	double viscosity = 1;                                        ///< factor on the smaller coefficients of both [-], 0 ... 1
	bool   names(int a, int b) const { return (a == first && b == second) || (a == second && b == first); }
};
inline bool operator==(const PairRule& a, const PairRule& b)
{
	return a.first == b.first && a.second == b.second && a.strength == b.strength && a.tension == b.tension && a.friction == b.friction
		&& a.viscosity == b.viscosity;
}
/// f(constant) for every constant, in a fixed order: numbers, EosKind, YieldKind and DamageKind. What saves or compares materials goes by this list.
template <class M, class F> void eachConstant(M& m, F&& f)
{
	f(m.eos.rho0), f(m.eos.c0), f(m.eos.kind), f(m.eos.clampAt), f(m.G);
	eachEosConstant(m.eos, f);
	f(m.yield.kind), f(m.yield.referenceTemperature), f(m.yield.heatPerWork);
	eachFlowConstant(m.yield, f);
	f(m.fracture.strain), f(m.fracture.spall), f(m.fracture.pairStress), f(m.fracture.mises), f(m.fracture.ratio), f(m.fracture.energy);
	f(m.fracture.damage.kind), f(m.fracture.damage.D1), f(m.fracture.damage.D2), f(m.fracture.damage.D3), f(m.fracture.damage.D4), f(m.fracture.damage.D5);
	f(m.viscosity.linear), f(m.viscosity.quadratic), f(m.friction);
}

/// in(range, what, value) for each constant that the chosen law uses, then what the law itself demands.
#define MCA_USE(name, range) in(range, laws::label::name, c.name);
#define MCA_EOS_USES(name, law, text) \
	case EosKind::name: MCA_USES_##name(MCA_USE) return eos::law::check(c, need);
#define MCA_FLOW_USES(name, law, text) \
	case YieldKind::name: MCA_USES_##name(MCA_USE) return flow::law::check(c, need);
template <class In, class Need> void checkChosen(const Eos& c, In&& in, Need&& need)
{
	switch (c.kind) { MCA_EOS_LAWS(MCA_EOS_USES) }
}
template <class In, class Need> void checkChosen(const Yield& c, In&& in, Need&& need)
{
	switch (c.kind) { MCA_FLOW_LAWS(MCA_FLOW_USES) }
}

template <class In, class Need> void validate(const DuctileDamage& c, const Yield& y, In&& in, Need&& need)
{
	in(laws::finite, "damageD1 [-]", c.D1), in(laws::notNegative, "damageD2 [-]", c.D2), in(laws::finite, "damageD3 [-]", c.D3);
	need(c.D4 >= -0.01 && c.D4 < laws::huge, "damageD4 [-]", c.D4, "at least -0.01 and finite", "the factor of the rate must stay above zero");
	need(c.D5 > -1 && c.D5 < laws::huge, "damageD5 [-]", c.D5, "above -1 and finite");
	if (!c.active()) return;
	need(c.D1 + c.D2 > 0, "damageD1 + damageD2 [-]", c.D1 + c.D2, "above zero", "the fracture strain without mean stress; damageModel 'none': no damage");
	need(c.D5 == 0 || y.meltTemperature > y.referenceTemperature, "meltTemperature [K]", y.meltTemperature, "above referenceTemperature (damageD5)");
}

/// Throws mca::Error naming the first constant that is out of range. name: how the user calls the material.
inline void validate(const Material& m, const std::string& name)
{
	const auto need = [&](bool ok, const char* what, double value, const char* range, const char* note = "") {
		if (ok) return;
		std::ostringstream s;
		s << "material '" << name << "': " << what << " = " << value << " is not allowed; it must be " << range;
		if (*note) s << " (" << note << ")";
		throw Error(s.str() + ".");
	};
	const auto in = [&](const Range& r, const char* what, double value) { need(r.holds(value), what, value, r.words, r.note); };
	const Eos&   e = m.eos;
	const Yield& y = m.yield;
	in(laws::positive, "density [kg/m3]", e.rho0);
	in(laws::positive, "bulkSoundSpeed [m/s]", e.c0);
	// constants must be sound for any law, also where the one chosen does not use them: nobody means NaN
#define MCA_CHECK(name, unit, start, range, text) in(range, laws::label::name, from.name);
#define MCA_CHECK_ROWS(name, law, text) MCA_CONSTANTS_##name(MCA_CHECK)
	{
		const Eos& from = e;
		MCA_EOS_LAWS(MCA_CHECK_ROWS)
	}
	need(e.clampAt > 0 && e.clampAt < 1, "clampAt [-]", e.clampAt, "between 0 and 1");
	in(laws::notNegative, "shearModulus [Pa]", m.G);
	{
		const Yield& from = y;
		MCA_FLOW_LAWS(MCA_CHECK_ROWS)
	}
	in(laws::notNegative, "referenceTemperature [K]", y.referenceTemperature);
	checkChosen(e, in, need), checkChosen(y, in, need);
	in(laws::notNegative, "taylorQuinney/(density heatCapacity) [K m3/J]", y.heatPerWork);
	in(laws::aboveZero.with("infinite: never"), "fractureStrain [-]", m.fracture.strain);
	in(laws::aboveZero.with("infinite: never"), "spallStrength [Pa]", m.fracture.spall);
	in(laws::aboveZero.with("infinite: never"), "pairStrength [Pa]", m.fracture.pairStress);
	in(laws::aboveZero.with("infinite: never"), "fractureStress [Pa]", m.fracture.mises);
	need(m.fracture.ratio >= 1 && m.fracture.ratio < laws::huge, "strengthRatio [-]", m.fracture.ratio, "finite and at least 1");
	in(laws::notNegative, "fractureEnergy [J/m2]", m.fracture.energy);
	validate(m.fracture.damage, y, in, need);
	in(laws::notNegative, "viscosityLinear [-]", m.viscosity.linear);
	in(laws::notNegative, "viscosityQuadratic [-]", m.viscosity.quadratic);
	need(m.friction >= 0 && m.friction <= 1300, "friction [-]", m.friction, "from 0 to 1300 (an angle below pi/2)");
}

/// Equal in every constant.
inline bool same(const Material& a, const Material& b)
{
	std::array<double, sizeof(Material) / sizeof(double)> values; // at least as many as there are constants
	size_t                                                n = 0, k = 0;
	eachConstant(a, [&](auto v) { values[n++] = double(v); });
	bool equal = true;
	eachConstant(b, [&](auto v) { equal = equal && values[k++] == double(v); });
	return equal;
}
}
