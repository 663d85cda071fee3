// SPDX-License-Identifier: GPL-2.0-or-later
// What a law of the material is: a file that names its constants (macros of rows, so that the classes of YADE can be made of them, too) and a struct of traits
// and pure functions. list.hpp names all laws; dispatch, validation, saved states, the attributes of McaMat and yade_mca.materials follow from it.
//
//     MCA_CONSTANTS_name(C): a row C(name, unit, default, range, sentence) for each constant the law brings; the range holds whatever law is chosen.
//     MCA_USES_name(U):      a row U(name, range) for each constant it reads, its own and those of laws before it; the range holds when it is chosen.
//
// The functions are templates over the struct of constants, which is made of all laws' rows after this (list.hpp).
#pragma once
#include "../math.hpp"
#include <limits>

namespace mca {

/// What values a constant may have.
struct Range {
	double      least, most;
	bool        withLeast, withMost, infinite; ///< whether the ends, and infinity, belong to it
	const char* words;                         ///< for messages: 'it must be ...'
	const char* note = "";                     ///< what an end means, in messages in brackets
	constexpr Range with(const char* text) const { return { least, most, withLeast, withMost, infinite, words, text }; }
	constexpr bool  holds(double v) const
	{
		return (infinite && v == std::numeric_limits<double>::infinity())
			|| ((withLeast ? v >= least : v > least) && (withMost ? v <= most : v < most));
	}
};

namespace laws {
	// no constant is as large in any system of units, and products of larger ones are not finite
	constexpr double huge = 1e100, endless = std::numeric_limits<double>::max();
	constexpr Range  finite { -huge, huge, false, false, false, "finite" };
	constexpr Range  notNegative { 0, huge, true, false, false, "finite and not negative" };
	constexpr Range  positive { 0, huge, false, false, false, "finite and above zero" };
	constexpr Range  aboveZero { 0, endless, false, true, true, "above zero" };
	constexpr Range  zeroOrMore { 0, endless, true, true, true, "not negative" };
	constexpr Range  upToOne { 0, 1, false, true, false, "in (0, 1]" };
	constexpr Range  belowOne { 0, 1, true, false, false, "in [0, 1)" };
}

// ---- equations of state

/// Pressure as a line in the internal energy per rest volume E [J/m3]: P = A + B E, at constant volume and near the present energy.
struct Thermal {
	double A; ///< [Pa]
	double B; ///< [-]
};

/// Traits and functions of an equation of state; eps = J - 1 is the volume strain. A law offers clampStrain, pressure, tangent and storedEnergy, and thermal
/// when it heats.
struct EosLaw {
	/// the pressure depends on the internal energy, which solvers then keep; contacts push by pressure(eps) all the same
	static constexpr bool heats = false;
	/// What the ranges of single constants cannot say: need(ok, constant, value, range in words).
	template <class E, class Need> static void check(const E&, Need&&) { }
};

// ---- flow stress

/// Static yield stress [Pa] and its slope dY/d eps_p [Pa] at fixed temperature.
struct StaticYield {
	double stress, slope;
};

/// Traits of a flow stress. A law offers staticYield; when it depends on the rate, flowStress and increment besides.
struct FlowLaw {
	/// false: elastic, no plastic code runs
	static constexpr bool yields = true;
	/// the yield stress depends on the temperature: plastic work heats, and solvers keep the temperature
	static constexpr bool heats = false;
	/// worth a test whether anybody yields before it is computed; its static yield stress must then not fall with strain nor rise with temperature
	static constexpr bool isDear = false;
	/// the yield stress grows with the strain rate, above the static one
	static constexpr bool dependsOnRate = false;
	template <class Y, class Need> static void check(const Y&, Need&&) { }
};

/// factor x^n of a hardening that is vertical at zero strain: a straight line replaces it below a strain of 1e-4.
struct PowerHardening {
	double power; ///< factor max(eps_p, 1e-4)^n [Pa]
	double near;  ///< share of it that holds: the stress is power * near
	double slope; ///< its slope [Pa]
};
MCA_INLINE PowerHardening powerHardening(double factor, double exponent, double eqps)
{
	const double ep = max(eqps, 1e-4), slope = factor * fastPow(ep, exponent - 1.); // not power / ep: divisions are dear
	const double near = min(eqps * 1e4, 1.);
	return { slope * ep, near, (near < 1. ? 1. : exponent) * slope };
}
}
