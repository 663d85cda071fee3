// SPDX-License-Identifier: GPL-2.0-or-later
// What callers give with three components, as the solver of this dimension takes it.
#pragma once
#include "automata.hpp"
#include "solver.hpp"

namespace mca::automata {

inline Vec<double> vectorOf(const Triple& t)
{
	Vec<double> v {};
	for (int c = 0; c < dim; c++) v[c] = t[size_t(c)];
	return v;
}
/// In the plane about z.
inline Turn<double> turnOf(const Triple& t)
{
	Turn<double> v {};
	for (int c = 0; c < turns; c++) turnComponent(v, c) = t[size_t(3 - turns + c)];
	return v;
}
inline Automaton startOf(const AutomatonStart& a)
{
	Automaton s;
	s.position = vectorOf(a.position), s.velocity = vectorOf(a.velocity), s.omega = turnOf(a.spin), s.angle = turnOf(a.angle);
	s.mass = a.mass, s.inertia = a.inertia, s.diameter = a.diameter, s.weight = a.weight, s.strength = a.strength, s.eqps = a.eqps, s.damage = a.damage;
	s.temperature = a.temperature, s.material = a.material, s.id = a.id, s.group = a.group, s.triangles = a.triangles, s.isNew = a.isNew;
	for (int c = 0; c < dim; c++) s.free[c] = a.free[size_t(c)], s.mirror[c] = a.mirror[size_t(c)];
	for (int c = 0; c < turns; c++) turnComponent(s.freeR, c) = a.freeSpin[size_t(3 - turns + c)];
	return s;
}
}
