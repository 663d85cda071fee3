// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors of the solvers and those of YADE, which have three components always.
#pragma once
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
/// State::blockedDOFs of a translation
inline unsigned translation(int c) { return unsigned(State::DOF_X) << c; }
/// nameX, nameY, ...: the components for scripts.
template <class Dict> void putVector(Dict& to, const char* name, const mca::Vec<Real>& v)
{
	for (int c = 0; c < mca::dim; c++)
		to[std::string(name) + char('X' + c)] = v[c];
}
} // namespace yade
