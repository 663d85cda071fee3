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
bool movesAlone(const shared_ptr<Body>& b) { return isAutomaton(b) && b->clumpId == Body::ID_NONE; }

void refuseBody(const Body& b, const string& what) { throw mca::Error("McaEngine: body " + std::to_string(b.id) + ": " + what); }

string numberText(Real v)
{
	std::ostringstream s;
	s << v;
	return s.str();
}

bool leavesPlane(const State& s) { return (s.blockedDOFs & (State::DOF_Z | State::DOF_RX | State::DOF_RY)) != (State::DOF_Z | State::DOF_RX | State::DOF_RY); }

namespace {
	constexpr Real lightest = 0.05, heaviest = 2; ///< weight
	/// Mass over that of a full cell.
	Real weightIn(int dimension, const Body& b)
	{
		return b.state->mass / (b.material->density * mca::cellIn(dimension, 2. * static_cast<const Sphere*>(b.shape.get())->radius));
	}
	bool fits(int dimension, const Body& b)
	{
		const Real w = weightIn(dimension, b);
		return w >= lightest && w <= heaviest;
	}
} // namespace

int dimensionOf(const Scene& scene)
{
	const Body* first = nullptr;
	for (const auto& b : scene.bodies->body) {
		if (!movesAlone(b) || !b->state) continue;
		if (leavesPlane(*b->state)) return 3;
		if (!first) first = b.get();
	}
	return first && fits(3, *first) && !fits(2, *first) ? 3 : 2;
}

int dimensionByMass(const Scene& scene)
{
	for (const auto& b : scene.bodies->body) {
		if (!movesAlone(b) || !b->state) continue;
		if (fits(2, *b) != fits(3, *b)) return fits(3, *b) ? 3 : 2;
		break;
	}
	return dimensionOf(scene);
}

void checkMotion(const Body& b, int dimension)
{
	const State& s = *b.state;
	const auto&  x = s.se3.position;
	const Real   reach = 2e9 * static_cast<const Sphere*>(b.shape.get())->radius;
	if (!(s.vel.cwiseAbs().maxCoeff() < 1e100 && s.angVel.cwiseAbs().maxCoeff() < 1e100))
		refuseBody(b, "vel or angVel is not finite; give finite numbers below 1e100 [m/s], [rad/s].");
	if (!(std::fabs(s.se3.orientation.coeffs().squaredNorm() - 1.) < 0.1)) refuseBody(b, "ori is no rotation; it must be a quaternion of norm 1.");
	if (!x.allFinite() || !s.vel.allFinite() || !s.angVel.allFinite() || !s.se3.orientation.coeffs().allFinite())
		refuseBody(b, "position, velocity, angular velocity or orientation is not finite; give finite numbers.");
	if (dimension == 2 && (s.vel[2] != 0 || s.angVel[0] != 0 || s.angVel[1] != 0))
		refuseBody(
			b,
			"velocity z = " + numberText(s.vel[2]) + " m/s, angular velocity x, y = " + numberText(s.angVel[0]) + ", " + numberText(s.angVel[1])
				+ " rad/s; in plane strain (x, y) they must be 0.");
	if (std::fabs(x[0]) < reach && std::fabs(x[1]) < reach && (dimension == 2 || std::fabs(x[2]) < reach)) return;
	refuseBody(
		b,
		"position (" + numberText(x[0]) + ", " + numberText(x[1]) + (dimension == 2 ? string() : ", " + numberText(x[2]))
			+ ") m must be within 1e9 diameters of the origin.");
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

const Body& automatonOf(const Scene& scene, int id, const string& call)
{
	const auto refuse = [&](const string& what) { throw std::runtime_error("McaEngine." + call + ": ids: " + what); };
	if (!scene.bodies->exists(id)) refuse("there is no body " + std::to_string(id) + "; each must be the id of an automaton.");
	const auto& b = scene.bodies->body[size_t(id)];
	if (!movesAlone(b) || !b->state)
		refuse("body " + std::to_string(id) + " is no automaton; it must have material McaMat, shape Sphere and a state.");
	if (!b->state->se3.position.allFinite()) refuse("the position of body " + std::to_string(id) + " must be finite.");
	return *b;
}

void checkDamage(const Body& b, const McaState& s)
{
	if (!(s.damage >= 0 && s.damage <= 1e6)) refuseBody(b, "state.damage = " + numberText(s.damage) + " must be from 0 to 1e6.");
	if (s.damage != 0 && static_cast<const McaMat&>(*b.material).damageModel == "none")
		refuseBody(
			b,
			"state.damage = " + numberText(s.damage)
				+ " has no meaning: the damageModel of its material is 'none'. Set damageModel='johnsonCook', or damage to 0.");
}

McaBodies::McaBodies(const Scene& scene, int seed, int dimension, bool acrossMasks)
{
	checkNumbers(scene);
	for (const auto& b : scene.bodies->body)
		if (movesAlone(b)) add(*b, seed, dimension, acrossMasks);
}

namespace {
	[[noreturn]] void refuseMass(const Body& b, int dimension)
	{
		const string mass = "mass " + (dimension == 2 ? std::to_string(b.state->mass) + " kg/m" : numberText(b.state->mass) + " kg");
		string       other;
		if (fits(5 - dimension, b))
			other = dimension == 2 ? "It is that of an automaton in space, which is taken in a scene of such only. "
					       : "It is that of an automaton in plane strain. ";
		const Real   w = weightIn(dimension, b);
		throw mca::Error(
			"body " + std::to_string(b.id) + ": " + mass + " is " + std::to_string(w) + " of the full cell (" + numberText(b.state->mass / w)
			+ "); it must be 0.05 to 2. " + other
			+ (dimension == 2
		                   ? "In plane strain the mass is density times area per 1 m of thickness, and z and the rotations about x and y are blocked"
		                   : "In space the mass is density times volume, and every automaton of the scene is in space as soon as one may leave the "
				     "plane (z, or a rotation about x or y, is not blocked)")
			+ ": make the bodies with packings.addBodies.");
	}
} // namespace

void McaBodies::add(const Body& b, int seed, int dimension, bool acrossMasks)
{
	const auto* m = static_cast<const McaMat*>(b.material.get());
	if (!b.state) throw mca::Error("body " + std::to_string(b.id) + ": state is None; give it a McaState (material.newAssocState()).");
	const State& s  = *b.state;
	auto*        ms = castTo<McaState>(b.state.get());
	if (!ms) throw mca::Error("body " + std::to_string(b.id) + " has material McaMat but not a McaState; make its state with material.newAssocState().");
	mca::AutomatonStart a;
	a.material = int(materialIndex(m, known, materials));
	a.position = triple(s.se3.position), a.velocity = triple(s.vel), a.spin = triple(s.angVel);
	a.angle    = triple(angleOf(s.se3.orientation, dimension));
	a.mass     = s.mass;
	a.inertia  = s.inertia[2];
	a.diameter = 2. * static_cast<Sphere*>(b.shape.get())->radius;
	a.weight   = weightIn(dimension, b);
	if (std::fabs(a.weight - 1.) < 1e-9) a.weight = 1.;
	if (a.mass > 0 && !fits(dimension, b)) refuseMass(b, dimension);
	if (dimension == 3 && !(s.inertia[0] == s.inertia[2] && s.inertia[1] == s.inertia[2]))
		throw mca::Error(
			"body " + std::to_string(b.id) + ": inertia (" + numberText(s.inertia[0]) + ", " + numberText(s.inertia[1]) + ", "
			+ numberText(s.inertia[2]) + ") kg m2 must be the same about all axes, that of a sphere.");
	if (ms->strength == 0) ms->strength = drawStrength(*m, seed, b.id);
	a.strength  = ms->strength;
	a.eqps      = ms->plasticStrain;
	a.damage    = ms->damage;
	a.triangles = ms->triangles;
	if (ms->mirrors < 0 || ms->mirrors > 7)
		throw mca::Error("body " + std::to_string(b.id) + ": state.mirrors = " + std::to_string(ms->mirrors) + " must be from 0 to 7.");
	for (size_t c = 0; c < 3; c++)
		a.mirror[c] = (ms->mirrors >> c) & 1;
	a.id        = b.id;
	a.group     = groupOf(b.groupMask, acrossMasks);
	a.free = freeWays(s), a.freeSpin = freeTurns(s);
	automata.push_back(a);
	ids.push_back(b.id);
}
} // namespace yade
