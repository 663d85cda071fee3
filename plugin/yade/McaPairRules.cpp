// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaPairRules.hpp"
#include "McaBodies.hpp"
#include "McaCast.hpp"

namespace yade {
namespace {
	constexpr size_t perRule = 4; ///< strength, pairStrength, friction (below zero: not given), viscosity

	shared_ptr<Material> materialOf(const py::object& o, const string& call, const char* name)
	{
		const py::extract<shared_ptr<Material>> m(o);
		const shared_ptr<Material>              found = m.check() && !o.is_none() ? m() : nullptr;
		if (!found || !castTo<McaMat>(found.get())) throw std::runtime_error(call + ": " + name + " must be a McaMat, the material of bodies.");
		return found;
	}
	bool good(const Real* n)
	{
		return n[0] > 0 && n[0] < 1e9 && n[1] > 0 && (n[2] == -1 || (n[2] >= 0 && n[2] < 1e4)) && n[3] >= 0 && n[3] <= 1;
	}
} // namespace

void addPairRule(
	vector<shared_ptr<Material>>& materials, vector<Real>& numbers, const string& call, const py::object& first, const py::object& second, Real strength,
	Real pairStrength, const py::object& frictionAngle, Real viscosity)
{
	const auto a = materialOf(first, call, "material1"), b = materialOf(second, call, "material2");
	const auto refuse = [&](const string& name, const string& value, const char* range) {
		throw std::runtime_error(call + ": " + name + " = " + value + " must be " + range + ".");
	};
	if (a == b) throw std::runtime_error(call + ": material1 and material2 are the same object; they must be two. What holds within one material is set "
		    "in it.");
	if (!(strength > 0 && strength < 1e9)) refuse("strength [-]", numberText(strength), "above 0 and below 1e9");
	if (!(pairStrength > 0)) refuse("pairStrength [Pa]", numberText(pairStrength), "above 0; infinite: none of its own");
	if (!(viscosity >= 0 && viscosity <= 1)) refuse("viscosity [-]", numberText(viscosity), "from 0 to 1");
	const auto breaks = [](const shared_ptr<Material>& m) { return static_cast<const McaMat&>(*m).toMaterial().fracture.active(); };
	if (strength != 1 && !breaks(a) && !breaks(b))
		throw std::runtime_error(
			call + ": strength [-] = " + numberText(strength)
			+ " scales fracture criteria, and neither material has one; it must be 1, or give a material a criterion, or the pair a pairStrength.");
	Real friction = -1;
	if (!frictionAngle.is_none()) {
		const py::extract<Real> angle(frictionAngle);
		const Real              phi = angle.check() ? angle() : NaN;
		if (!(phi >= 0 && phi <= 1.57)) refuse("frictionAngle [rad]", angle.check() ? numberText(phi) : "no number", "from 0 to 1.57, or None");
		friction = std::tan(phi);
	}
	const Real rule[perRule] = { strength, pairStrength, friction, viscosity };
	for (size_t k = 0; 2 * k < materials.size(); k++) {
		const auto &p = materials[2 * k], &q = materials[2 * k + 1];
		if (!((p == a && q == b) || (p == b && q == a))) continue;
		std::copy(rule, rule + perRule, numbers.begin() + long(perRule * k));
		return;
	}
	materials.push_back(a), materials.push_back(b);
	numbers.insert(numbers.end(), rule, rule + perRule);
}

mca::PairRules pairRulesOf(const vector<shared_ptr<Material>>& materials, const vector<Real>& numbers, const vector<const Material*>& known)
{
	const auto at = [&](const shared_ptr<Material>& m) {
		const auto it = std::find(known.begin(), known.end(), m.get());
		return it == known.end() ? -1 : int(it - known.begin());
	};
	mca::PairRules rules;
	for (size_t k = 0; 2 * k < materials.size(); k++) {
		mca::PairRule r;
		r.first = at(materials[2 * k]), r.second = at(materials[2 * k + 1]);
		const Real* n = &numbers[perRule * k];
		r.strength = n[0], r.tension = n[1], r.friction = n[2], r.viscosity = n[3];
		if (r.first >= 0 && r.second >= 0) rules.list.push_back(r);
	}
	return rules;
}

void checkPairRules(const vector<shared_ptr<Material>>& materials, const vector<Real>& numbers, const string& engine)
{
	bool fit = numbers.size() == 2 * materials.size() && materials.size() % 2 == 0;
	for (size_t k = 0; fit && 2 * k < materials.size(); k++) fit = good(&numbers[perRule * k]);
	for (const auto& m : materials) fit &= m && castTo<McaMat>(m.get());
	if (!fit) throw mca::Error(engine + ": the rules for pairs of materials in the file are none; the file is damaged or was edited.");
}
} // namespace yade
