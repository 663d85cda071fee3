// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaBodies.hpp"
#include "McaCast.hpp"
#include "McaVec.hpp"
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>

namespace yade {
namespace {
	/// A fixed function of (seed, id): the same strengths on any number of threads and in any order of bodies. SplitMix64 (Steele, Lea and Flood 2014).
	double uniform(uint64_t seed, uint64_t id, uint64_t draw)
	{
		uint64_t z = seed * 0x9e3779b97f4a7c15ULL + id * 0xbf58476d1ce4e5b9ULL + draw * 0x94d049bb133111ebULL + 0x9e3779b97f4a7c15ULL;
		z          = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
		z          = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
		z          = z ^ (z >> 31);
		return (double(z >> 11) + 0.5) / 9007199254740992.;
	}
	Real drawStrength(const McaMat& m, int seed, int id)
	{
		if (m.strengthSpread == 0) return 1.;
		const double u = uniform(seed, id, 0), s = m.strengthSpread;
		if (m.strengthDistribution == "uniform") return 1. + s * std::sqrt(3.) * (2. * u - 1.);
		if (m.strengthDistribution == "normal") {
			const double g = std::sqrt(-2. * std::log(u)) * std::cos(2. * M_PI * uniform(seed, id, 1));
			return 1. + s * std::min(std::max(g, -3.), 3.) * (s > 0.32 ? 0.32 / s : 1.);
		}
		// Weibull with mean 1: the shape k follows from the spread to 1 % by s = k^-0.926 (Dubey 1967), scale 1/Gamma(1 + 1/k)
		const double k = std::pow(s, -1. / 0.926);
		return std::pow(-std::log(u), 1. / k) / std::tgamma(1. + 1. / k);
	}
} // namespace

bool isAutomaton(const shared_ptr<Body>& b) { return b && b->material && castTo<McaMat>(b->material.get()) && castTo<Sphere>(b->shape.get()); }

void refuseBody(const Body& b, const string& what) { throw mca::Error("McaEngine: body " + std::to_string(b.id) + ": " + what); }

string numberText(Real v)
{
	std::ostringstream s;
	s << v;
	return s.str();
}

void checkMotion(const Body& b)
{
	const State& s = *b.state;
	const auto&  x = s.se3.position;
	const Real   reach = 2e9 * static_cast<const Sphere*>(b.shape.get())->radius;
	if (!(s.vel.cwiseAbs().maxCoeff() < 1e100 && s.angVel.cwiseAbs().maxCoeff() < 1e100))
		refuseBody(b, "vel or angVel is not finite; give finite numbers below 1e100 [m/s], [rad/s].");
	if (!(std::fabs(s.se3.orientation.coeffs().squaredNorm() - 1.) < 0.1)) refuseBody(b, "ori is no rotation; it must be a quaternion of norm 1.");
	if (!x.allFinite() || !s.vel.allFinite() || !s.angVel.allFinite() || !s.se3.orientation.coeffs().allFinite())
		refuseBody(b, "position, velocity, angular velocity or orientation is not finite; give finite numbers.");
	if (s.vel[2] != 0 || s.angVel[0] != 0 || s.angVel[1] != 0)
		refuseBody(
			b,
			"velocity z = " + numberText(s.vel[2]) + " m/s, angular velocity x, y = " + numberText(s.angVel[0]) + ", " + numberText(s.angVel[1])
				+ " rad/s; in plane strain (x, y) they must be 0.");
	if (!(std::fabs(x[0]) < reach && std::fabs(x[1]) < reach))
		refuseBody(b, "position (" + numberText(x[0]) + ", " + numberText(x[1]) + ") m must be within 1e9 diameters of the origin.");
}

size_t materialIndex(const McaMat* m, vector<const McaMat*>& known, vector<mca::Material>& materials)
{
	const auto it = std::find(known.begin(), known.end(), m);
	if (it != known.end()) return size_t(it - known.begin());
	materials.push_back(m->toMaterial());
	known.push_back(m);
	return known.size() - 1;
}

void checkNumbers(const Scene& scene)
{
	const auto& bodies = scene.bodies->body;
	for (size_t k = 0; k < bodies.size(); k++)
		if (bodies[k] && (bodies[k]->id < 0 || size_t(bodies[k]->id) != k))
			throw mca::Error(
				"body " + std::to_string(bodies[k]->id) + " stands in the place of body " + std::to_string(k)
				+ "; the saved scene is damaged or was edited.");
}

McaBodies::McaBodies(const Scene& scene, int seed)
{
	checkNumbers(scene);
	for (const auto& b : scene.bodies->body)
		if (isAutomaton(b)) add(*b, seed);
}

void McaBodies::add(const Body& b, int seed)
{
	const auto* m = static_cast<const McaMat*>(b.material.get());
	if (!b.state) throw mca::Error("body " + std::to_string(b.id) + ": state is None; give it a McaState (material.newAssocState()).");
	const State& s  = *b.state;
	auto*        ms = castTo<McaState>(b.state.get());
	if (!ms) throw mca::Error("body " + std::to_string(b.id) + " has material McaMat but not a McaState; make its state with material.newAssocState().");
	mca::automata::Automaton a;
	a.material = int(materialIndex(m, known, materials));
	a.position = vec(s.se3.position), a.velocity = vec(s.vel), a.omega = s.angVel[2];
	a.angle         = 2. * std::atan2(s.se3.orientation.z(), s.se3.orientation.w());
	a.mass          = s.mass;
	a.inertia       = s.inertia[2];
	a.diameter      = 2. * static_cast<Sphere*>(b.shape.get())->radius;
	const Real full = m->density * mca::Lattice::cell(a.diameter);
	a.weight        = a.mass / full;
	if (std::fabs(a.weight - 1.) < 1e-9) a.weight = 1.;
	if (a.mass > 0 && (a.weight < 0.05 || a.weight > 2))
		throw mca::Error(
			"body " + std::to_string(b.id) + ": mass " + std::to_string(a.mass) + " kg/m is " + std::to_string(a.weight) + " of the full cell ("
			+ std::to_string(full)
			+ " kg/m); it must be 0.05 to 2. In plane strain the mass is density times area per 1 m of thickness: make the bodies with "
		          "packings.addBodies.");
	if (ms->strength == 0) ms->strength = drawStrength(*m, seed, b.id);
	a.strength = ms->strength;
	a.eqps     = ms->plasticStrain;
	a.triangles = ms->triangles;
	a.id       = b.id;
	a.group    = b.groupMask;
	for (int c = 0; c < mca::dim; c++)
		a.free[c] = !(s.blockedDOFs & translation(c));
	a.freeR = !(s.blockedDOFs & State::DOF_RZ);
	automata.push_back(a);
	ids.push_back(b.id);
}
} // namespace yade
