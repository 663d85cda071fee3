// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaMat.hpp"

namespace yade {
YADE_PLUGIN((McaLawState)(McaState)(McaMat));

mca::Material McaMat::toMaterial() const
{
	const string name = label.empty() ? "McaMat " + std::to_string(id) : label;
	auto         pick = [&](const string& what, const string& value, std::initializer_list<const char*> names) {
                string list;
                int    k = 0;
                for (auto n : names) {
                        if (value == n) return k;
                        list += string(k++ ? ", '" : "'") + n + "'";
                }
                throw mca::Error("material '" + name + "': " + what + " = '" + value + "' is unknown; it must be one of " + list + ".");
	};
	// what the laws chosen do not use must be sound all the same: the next choice would use it
	auto need = [&](const char* what, Real value, bool ok, const char* range) {
		if (ok) return;
		std::ostringstream s;
		s << "material '" << name << "': " << what << " = " << value << " is not allowed; it must be " << range << ".";
		throw mca::Error(s.str());
	};
	const auto notNegative = [](Real v) { return v >= 0 && v < 1e100; };
	need("heatCapacity [J/kg/K]", heatCapacity, notNegative(heatCapacity), "finite and not negative (0: no heating)");
	need("taylorQuinney [-]", taylorQuinney, taylorQuinney >= 0 && taylorQuinney <= 1, "from 0 to 1");
	need("frictionAngle [rad]", frictionAngle, frictionAngle >= 0 && frictionAngle <= 1.57, "from 0 to 1.57, below pi/2");
	mca::Material m;
#define MCA_NAME_OF(name, law, text) #name,
#define MCA_TAKE(name, unit, start, range, text) to.name = name;
#define MCA_TAKE_ALL(name, law, text) MCA_CONSTANTS_##name(MCA_TAKE)
	{
		mca::Eos& to = m.eos;
		to.rho0 = density, to.c0 = bulkSoundSpeed;
		to.kind = mca::EosKind(pick("eos", eos, { MCA_EOS_LAWS(MCA_NAME_OF) }));
		MCA_EOS_LAWS(MCA_TAKE_ALL)
	}
	m.G = shearModulus;
	{
		mca::Yield& to = m.yield;
		to.kind        = mca::YieldKind(pick("yieldModel", yieldModel, { MCA_FLOW_LAWS(MCA_NAME_OF) }));
		MCA_FLOW_LAWS(MCA_TAKE_ALL)
		// an infinite yield stress is the elastic material: no plastic code runs
		if (std::isinf(yieldStress) || shearModulus == 0) to.kind = mca::YieldKind::elastic;
		to.referenceTemperature = referenceTemperature;
		to.heatPerWork          = heatCapacity > 0 ? taylorQuinney / (density * heatCapacity) : 0.;
	}
	m.fracture.strain = fractureStrain, m.fracture.spall = spallStrength, m.fracture.pairStress = pairStrength, m.fracture.mises = fractureStress,
	m.fracture.ratio = strengthRatio, m.fracture.energy = fractureEnergy;
	m.fracture.damage = { mca::DamageKind(pick("damageModel", damageModel, { "none", "johnsonCook" })), damageD1, damageD2, damageD3, damageD4, damageD5 };
	m.viscosity = { viscosityLinear, viscosityQuadratic };
	m.friction  = std::tan(frictionAngle);
	mca::validate(m, name);
	pick("strengthDistribution", strengthDistribution, { "uniform", "normal", "weibull" });
	if (!(strengthSpread >= 0 && strengthSpread < 0.5))
		throw mca::Error("material '" + name + "': strengthSpread = " + std::to_string(strengthSpread) + " must be in [0, 0.5).");
	return m;
}

Real McaMat::yieldAt(Real eqps, Real rate, Real temperature) const
{
	const auto need = [](const char* what, Real v, bool ok, const char* range) {
		if (!ok) throw mca::Error(string("McaMat.flowStress: ") + what + " = " + std::to_string(v) + " must be " + range + ".");
	};
	need("plasticStrain", eqps, eqps >= 0 && eqps <= 1e6, "from 0 to 1e6");
	need("rate", rate, rate > 0 && rate <= 1e30, "above 0 and at most 1e30 [1/s]");
	need("temperature", temperature, temperature > 0 && temperature <= 1e9, "above 0 and at most 1e9 [K]");
	return mca::flowStress(toMaterial().yield, eqps, rate, temperature);
}

Real McaMat::pressureAt(Real volumeRatio) const 
{
	if (!(volumeRatio > 0 && volumeRatio <= 1e6))
		throw mca::Error("McaMat.pressure: volumeRatio = " + std::to_string(volumeRatio) + " must be above 0 and at most 1e6.");
	return mca::pressure(toMaterial().eos, volumeRatio - 1.);
}

shared_ptr<State> McaMat::newAssocState() const
{
	const shared_ptr<McaState> s(new McaState);
	s->temperature = referenceTemperature;
	return s;
}

bool McaMat::derive()
{
	const Real K = density * bulkSoundSpeed * bulkSoundSpeed, G = shearModulus;
	if (!(K > 0 && G >= 0 && std::isfinite(K + G))) return false;
	young = 9. * K * G / (3. * K + G), poisson = (3. * K - 2. * G) / (2. * (3. * K + G));
	return true;
}

void McaMat::refuseElastic(const char* what, Real asked, Real derived) const
{
	if (std::fabs(asked - derived) <= 1e-9 * std::fabs(derived)) return; // a copy of what stands there
	std::ostringstream s;
	s << "McaMat" << (label.empty() ? "" : " '" + label + "'") << ": " << what << " = " << asked
	  << " cannot be set: it follows from density, bulkSoundSpeed and shearModulus (";
	(std::isfinite(derived) ? s << derived : s << "not all given yet") << "). Set those: G = E/(2(1+nu)), K = E/(3(1-2nu)) = density bulkSoundSpeed^2.";
	throw std::invalid_argument(s.str());
}

// young and poisson among the keywords are compared with what the others give, once all are set
void McaMat::pyHandleCustomCtorArgs(py::tuple&, py::dict& keywords)
{
	for (const char* name : { "young", "poisson" })
		if (keywords.has_key(name)) {
			asked[name] = py::extract<Real>(keywords[name]);
			keywords[name].del();
		}
	if (!asked.empty() && py::len(keywords) == 0) postLoad(*this);
}

void McaMat::postLoad(McaMat&)
{
	const bool derived = derive();
	const auto given   = std::move(asked);
	asked.clear();
	for (const auto& [name, value] : given)
		refuseElastic(name.c_str(), value, derived ? (name == "young" ? young : poisson) : std::numeric_limits<Real>::quiet_NaN());
}
} // namespace yade
