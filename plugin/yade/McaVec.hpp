// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors of the solvers and those of YADE, which have three components always.
#pragma once
#include <automata/automata.hpp>
#include <core/State.hpp>
#include <kernels/vector.hpp>
#include <lib/base/Math.hpp>

namespace yade {

/// The components that the solvers know, from entry `first` on.
template <class V> mca::Vec<Real> vec(const V& v, int first = 0)
{
	mca::Vec<Real> r;
	for (int c = 0; c < mca::dim; c++)
		r[c] = v[first + c];
	return r;
}
/// v; components that the solvers do not know are those of `rest`.
inline Vector3r vector3(const mca::Vec<Real>& v, Vector3r rest = Vector3r::Zero())
{
	for (int c = 0; c < mca::dim; c++)
		rest[c] = v[c];
	return rest;
}
inline mca::Triple triple(const Vector3r& v) { return { v[0], v[1], v[2] }; }
inline Vector3r    vector3(const mca::Triple& t) { return Vector3r(t[0], t[1], t[2]); }
inline mca::Ways   freeWays(const State& s)
{
	return { !(s.blockedDOFs & State::DOF_X), !(s.blockedDOFs & State::DOF_Y), !(s.blockedDOFs & State::DOF_Z) };
}
inline mca::Ways freeTurns(const State& s)
{
	return { !(s.blockedDOFs & State::DOF_RX), !(s.blockedDOFs & State::DOF_RY), !(s.blockedDOFs & State::DOF_RZ) };
}
/// Angle about each axis of an orientation [rad]; in the plane about z alone.
inline Vector3r angleOf(const Quaternionr& q, int dimension)
{
	if (dimension == 2) return Vector3r(0, 0, 2. * std::atan2(q.z(), q.w()));
	const Vector3r v = q.vec();
	const Real     s = v.norm();
	return s > 0 ? Vector3r(v * (2. * std::atan2(s, q.w()) / s)) : Vector3r(Vector3r::Zero());
}
/// Orientation of such an angle. Turns about changing axes do not add up to one; nothing but the picture follows from it.
inline Quaternionr orientationOf(const Vector3r& angle, int dimension)
{
	const Real a = angle.norm();
	if (dimension == 2 || a == 0) return Quaternionr(AngleAxisr(angle[2], Vector3r::UnitZ()));
	return Quaternionr(AngleAxisr(a, Vector3r(angle / a)));
}
/// Pairs of ids that a script gives; throws Python's TypeError when they are none.
inline std::vector<std::pair<int32_t, int32_t>> idPairs(const boost::python::object& pairs, const std::string& call)
{
	namespace py = boost::python;
	std::vector<std::pair<int32_t, int32_t>> list;
	const bool                               sequence = PySequence_Check(pairs.ptr());
	bool                                     good     = sequence;
	for (long q = 0, n = sequence ? py::len(pairs) : 0; good && q < n; q++) {
		const py::object pair(pairs[q]);
		if (!(good = PySequence_Check(pair.ptr()) && py::len(pair) == 2)) break;
		const py::extract<int> a(pair[0]), b(pair[1]);
		if ((good = a.check() && b.check())) list.emplace_back(a(), b());
	}
	if (!good) {
		PyErr_SetString(PyExc_TypeError, (call + ": pairs must be a list of (id1, id2), as links() gives them.").c_str());
		py::throw_error_already_set();
	}
	return list;
}
/// nameX, nameY, ...: the components for scripts.
template <class Dict, class Vector> void putVector(Dict& to, const char* name, const Vector& v, int components = mca::dim)
{
	for (int c = 0; c < components; c++)
		to[std::string(name) + char('X' + c)] = v[c];
}
} // namespace yade
