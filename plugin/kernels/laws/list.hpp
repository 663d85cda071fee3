// SPDX-License-Identifier: GPL-2.0-or-later
// All laws: an include and a row each, L(name, struct, what it is). The name is that of scripts. All else follows: kinds, constants, dispatch, saved states,
// McaMat, one file of row kernels per flow stress (plugin/grid/CMakeLists.txt).
#pragma once
#include "eos/linear.hpp"
#include "eos/mieGruneisen.hpp"
#include "eos/polynomial.hpp"
#include "eos/shockAdiabat.hpp"
#include "flow/elastic.hpp"
#include "flow/johnsonCook.hpp"
#include "flow/linearHardening.hpp"
#include "flow/perfect.hpp"
#include "flow/steinbergGuinan.hpp"
#include "flow/zerilliArmstrong.hpp"
#include <cstdint>
#include <type_traits>

/// Equations of state.
#define MCA_EOS_LAWS(L) \
	L(shockAdiabat, ShockAdiabat, "shock adiabat D = c0 + b U, without energy") \
	L(linear, Linear, "pressure linear in the volume strain") \
	L(mieGruneisen, MieGruneisen, "Mie-Grueneisen about the shock adiabat") \
	L(polynomial, Polynomial, "polynomial in the compression, linear in the internal energy")

/// Flow stresses.
#define MCA_FLOW_LAWS(L) \
	L(elastic, Elastic, "never yields") \
	L(perfect, Perfect, "constant yield stress") \
	L(linearHardening, LinearHardening, "yield stress linear in the plastic strain") \
	L(johnsonCook, JohnsonCook, "Johnson and Cook 1983: strain, strain rate, temperature") \
	L(zerilliArmstrong, ZerilliArmstrong, "Zerilli and Armstrong 1987, bcc and fcc: strain, strain rate, temperature") \
	L(steinbergGuinan, SteinbergGuinan, "Steinberg, Cochran and Guinan 1980 at constant shear modulus: strain, temperature")

// ---- what follows from the list

#define MCA_KIND(name, law, text) name,
#define MCA_COUNT(name, law, text) +1
#define MCA_MEMBER(name, unit, start, range, text) double name = start;

namespace mca {

enum class EosKind { MCA_EOS_LAWS(MCA_KIND) };
enum class YieldKind { MCA_FLOW_LAWS(MCA_KIND) };
constexpr int eosKinds = 0 MCA_EOS_LAWS(MCA_COUNT), yieldKinds = 0 MCA_FLOW_LAWS(MCA_COUNT);

/// The law of a kind: LawOf<kind>.
template <auto kind> struct LawOfKind;
template <auto kind> using LawOf = typename LawOfKind<kind>::type;
#define MCA_EOS_OF(name, law, text) \
	template <> struct LawOfKind<EosKind::name> { \
		using type = eos::law; \
	};
#define MCA_FLOW_OF(name, law, text) \
	template <> struct LawOfKind<YieldKind::name> { \
		using type = flow::law; \
	};
MCA_EOS_LAWS(MCA_EOS_OF)
MCA_FLOW_LAWS(MCA_FLOW_OF)

/// f(kind as a compile-time constant): the branch is taken once per block of automata or cells, not per element.
#define MCA_EOS_CASE(name, law, text) \
	case EosKind::name: return f(std::integral_constant<EosKind, EosKind::name> {});
#define MCA_FLOW_CASE(name, law, text) \
	case YieldKind::name: return f(std::integral_constant<YieldKind, YieldKind::name> {});
template <class F> inline decltype(auto) dispatch(EosKind k, F&& f)
{
	switch (k) { MCA_EOS_LAWS(MCA_EOS_CASE) }
	__builtin_unreachable();
}
template <class F> inline decltype(auto) dispatch(YieldKind k, F&& f)
{
	switch (k) { MCA_FLOW_LAWS(MCA_FLOW_CASE) }
	__builtin_unreachable();
}

/// Constants of the equation of state; bulkSoundSpeed and density are those of all.
struct Eos {
	double rho0 = 0; ///< density at rest [kg/m3]
	double c0   = 0; ///< bulk sound speed [m/s]; bulk modulus K = rho0 c0^2, the stiffness at rest of every law
#define MCA_ROWS(name, law, text) MCA_CONSTANTS_##name(MCA_MEMBER)
	MCA_EOS_LAWS(MCA_ROWS)
	EosKind kind    = EosKind::shockAdiabat;
	double  clampAt = 0.15; ///< shock adiabat: smallest 1 + b eps; beyond it the tangent stays constant

	double bulkModulus() const { return rho0 * c0 * c0; }
	/// volume strain at which the law ends [-]; beyond it goes on with the tangent there
	double clampStrain() const { return dispatch(kind, [&](auto k) { return LawOf<k.value>::clampStrain(*this); }); }
	/// the pressure depends on the internal energy
	bool heats() const { return dispatch(kind, [](auto k) { return LawOf<k.value>::heats; }); }
};

/// Constants of the flow stress.
struct Yield {
	YieldKind kind = YieldKind::elastic;
	MCA_FLOW_LAWS(MCA_ROWS)
	double referenceTemperature = 298; ///< initial temperature [K]
	double heatPerWork          = 0;   ///< temperature rise per plastic work: beta/(rho0 cp) [K m3/J]

	bool yields() const { return dispatch(kind, [](auto k) { return LawOf<k.value>::yields; }); }
	/// the yield stress depends on the temperature
	bool heats() const { return dispatch(kind, [](auto k) { return LawOf<k.value>::heats; }); }
};

/// What messages call a constant.
#define MCA_LABEL(name, unit, start, range, text) constexpr const char* name = #name " [" unit "]";
#define MCA_LABELS(name, law, text) MCA_CONSTANTS_##name(MCA_LABEL)
namespace laws::label {
	MCA_EOS_LAWS(MCA_LABELS)
	MCA_FLOW_LAWS(MCA_LABELS)
}

/// f(constant) for the constants of all laws, in the order of the list.
#define MCA_VISIT(name, unit, start, range, text) f(e.name);
#define MCA_VISIT_ROWS(name, law, text) MCA_CONSTANTS_##name(MCA_VISIT)
template <class E, class F> void eachEosConstant(E& e, F&& f) { MCA_EOS_LAWS(MCA_VISIT_ROWS) }
template <class Y, class F> void eachFlowConstant(Y& e, F&& f) { MCA_FLOW_LAWS(MCA_VISIT_ROWS) }

/// Names of all laws and constants in their order, as one number: saved states are of the same layout where it is the same.
#define MCA_NAME(name, unit, start, range, text) #name " "
#define MCA_NAMES(name, law, text) #name ": " MCA_CONSTANTS_##name(MCA_NAME)
constexpr uint64_t lawsVersion() { return nameHash(MCA_EOS_LAWS(MCA_NAMES) MCA_FLOW_LAWS(MCA_NAMES)); }
}
