// SPDX-License-Identifier: GPL-2.0-or-later
// What scripts give for the pairs of two materials: the same for McaEngine and for the law in YADE's loop.
#pragma once
#include "McaMat.hpp"
#include "automata/pair_rules.hpp"
#include <core/Material.hpp>

namespace yade {
/// Adds a rule to what an engine keeps, or replaces that of the same two materials: two materials and four numbers each. Under Python's lock. Throws
/// std::runtime_error that names the call and the argument.
void addPairRule(
	vector<shared_ptr<Material>>& materials, vector<Real>& numbers, const string& call, const py::object& first, const py::object& second, Real strength,
	Real pairStrength, const py::object& frictionAngle, Real viscosity);
/// As the solvers take them; known: their materials. Rules of others are left out.
mca::PairRules pairRulesOf(const vector<shared_ptr<Material>>& materials, const vector<Real>& numbers, const vector<const Material*>& known);
/// Of a file: throws mca::Error when they are none.
void checkPairRules(const vector<shared_ptr<Material>>& materials, const vector<Real>& numbers, const string& engine);
} // namespace yade
