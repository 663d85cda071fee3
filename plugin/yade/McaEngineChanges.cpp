// SPDX-License-Identifier: GPL-2.0-or-later
// McaEngine and the bodies: whenever a script can look, both hold the same; what it changes then is taken over or refused.
// Every look costs one comparison of all bodies, so the loops here are made for few cache misses.
#include "McaBodies.hpp"
#include "McaCast.hpp"
#include "McaEngine.hpp"
#include "McaVec.hpp"
#include <cstring>
#include <pkg/common/Sphere.hpp>
#include <unordered_set>

namespace yade {
/// What a script has changed in one body.
struct McaEngine::Change {
	size_t place; ///< in order
	bool   position, velocity, spin, angle, plasticStrain, damage, temperature, strength, mask, blocked;
	bool   motion() const { return position || velocity || spin; }
};

namespace {
	bool differs(Real a, Real b) { return !(a == b || (std::isnan(a) && std::isnan(b))); }

	/// In space about all axes, in the plane about z.
	bool otherInertia(const State& s, Real was, int dimension)
	{
		return differs(s.inertia[2], was) || (dimension == 3 && (differs(s.inertia[0], was) || differs(s.inertia[1], was)));
	}

	/// Zero when both have the same bits.
	template <class T> uint64_t unlike(const T& a, const T& b)
	{
		static_assert(sizeof(T) % 4 == 0, "compared by words");
		uint64_t d = 0;
		for (size_t k = 0; k < sizeof(T); k += sizeof(T) % 8 ? 4 : 8) {
			uint64_t x = 0, y = 0;
			std::memcpy(&x, reinterpret_cast<const char*>(&a) + k, sizeof(T) % 8 ? 4 : 8),
				std::memcpy(&y, reinterpret_cast<const char*>(&b) + k, sizeof(T) % 8 ? 4 : 8);
			d |= x ^ y;
		}
		return d;
	}
	template <class T> void soon(const T& what) { __builtin_prefetch(&what); }
	constexpr size_t ahead = 6; ///< bodies whose memory is asked for before it is needed
	void                    soon(const McaState& s)
	{
		soon(s.se3), soon(s.vel), soon(s.angVel), soon(s.inertia[2]), soon(s.blockedDOFs), soon(s.temperature), soon(s.brokenLinks);
	}
	/// An automaton on a plane of symmetry stays on it.
	void checkMirrors(const Body& b, const McaState& s, const Vector3r& was)
	{
		for (int c = 0; c < 3; c++) {
			if (!((s.mirrors >> c) & 1)) continue;
			mca::Ways turns = freeTurns(s);
			turns[size_t(c)] = false;
			if (s.se3.position[c] == was[c] && s.vel[c] == 0 && !freeWays(s)[size_t(c)] && !(turns[0] || turns[1] || turns[2])) continue;
			refuseBody(
				b,
				string("state.mirrors says that it lies on a plane of symmetry with its normal along ") + "xyz"[c]
					+ ", which it may not leave, nor turn out of; set position, velocity and blockedDOFs of that direction back.");
		}
	}
	void refuseEnds(const Body& b, const char* name, int now, int was)
	{
		if (now == was) return;
		refuseBody(
			b,
			string("state.") + name + " = " + std::to_string(now) + " was changed (from " + std::to_string(was)
				+ "); where a body ends is found when it is taken over for the first time. Set it back.");
	}
} // namespace

/// Its bits are those that body and engine had when they were last the same. Most bodies are, so nothing else is looked at then.
bool McaEngine::untouched(size_t q) const
{
	const Same& was = same[q];
	const Body& b   = *bodies[q];
	if (b.state.get() != was.state.get() || b.shape.get() != was.shape.get() || b.material.get() != was.material) return false;
	const auto& s = static_cast<const McaState&>(*was.state);
	uint64_t    d =
		unlike(s.se3.position, was.pos) | unlike(s.se3.orientation.coeffs(), was.ori.coeffs()) | unlike(s.vel, was.vel) | unlike(s.angVel, was.angVel);
	if (dimension == 3) d |= unlike(s.inertia[0], was.inertia) | unlike(s.inertia[1], was.inertia);
	d |= unlike(s.mass, was.mass) | unlike(s.inertia[2], was.inertia) | unlike(s.blockedDOFs, was.blocked) | unlike(b.groupMask, was.mask);
	d |= unlike(s.pressure, was.pressure) | unlike(s.volumeRatio, was.volumeRatio) | unlike(s.equivalentStress, was.equivalentStress)
		| unlike(s.plasticStrain, was.plasticStrain) | unlike(s.damage, was.damage);
	d |= unlike(s.temperature, was.temperature) | unlike(s.stressZZ, was.stressZZ) | unlike(s.dissipated, was.dissipated)
		| unlike(s.strength, was.strength);
	d |= unlike(s.links, was.links) | unlike(s.brokenLinks, was.brokenLinks) | unlike(s.triangles, was.triangles) | unlike(s.mirrors, was.mirrors);
	d |= unlike(static_cast<const Sphere&>(*was.shape).radius, was.radius);
	return d == 0;
}

bool McaEngine::sameBodies(const Scene& scene) const
{
	const auto&     all     = scene.bodies->body;
	const Material* foreign = nullptr; ///< of the body before, which is no automaton
	size_t          q       = 0;
	for (size_t k = 0; k < all.size(); k++) {
		const auto& b = all[k];
		if (!b) continue;
		if (q < bodies.size() && b.get() == bodies[q].get()) {
			if (int(k) != order[q] || b->clumpId != Body::ID_NONE) return false; // made rigid: it leaves
			q++;
		} else if (b->material.get() != foreign || !foreign) {
			if (movesAlone(b)) return false;
			const auto* m = b->material.get();
			foreign       = m && castTo<const McaMat>(m) ? nullptr : m;
		}
	}
	return q == bodies.size();
}

bool McaEngine::sameMaterials() const
{
	for (size_t k = 0; k < known.size(); k++)
		if (known[k]) {
			const mca::Material now = static_cast<const McaMat&>(*known[k]).toMaterial();
			if (!mca::same(now, solver->materials()[k])) return false;
		}
	return true;
}

/// What scripts have changed since body and engine were the same. rebuild: a body has another material. Throws before anything is taken over.
vector<McaEngine::Change> McaEngine::changes(bool& rebuild)
{
	vector<Change> list;
	for (size_t q = 0; q < order.size(); q++) {
		if (const size_t p = q + ahead; p < order.size() && bodies[p] && same[p].state && same[p].shape) {
			soon(bodies[p]->groupMask), soon(bodies[p]->shape), soon(static_cast<const McaState&>(*same[p].state)),
				soon(static_cast<const Sphere&>(*same[p].shape).radius);
		}
		if (!bodies[q] || untouched(q) || bodies[q]->clumpId != Body::ID_NONE) continue;
		const Change c = changeOf(q, rebuild);
		if (c.motion() || c.angle || c.plasticStrain || c.damage || c.temperature || c.strength || c.mask || c.blocked) list.push_back(c);
	}
	return list;
}

McaEngine::Change McaEngine::changeOf(size_t q, bool& rebuild)
{
	const Body& b = *bodies[q];
	if (!movesAlone(bodies[q])) refuseBody(b, "it is an automaton no more (its material or shape was replaced); erase it and add another body instead.");
	const auto* m = b.state ? castTo<const McaState>(b.state.get()) : nullptr;
	if (!m) refuseBody(b, "its state was replaced by one that is no McaState; make it with material.newAssocState().");
	const McaState& s    = *m;
	Same&           was  = same[q];
	const auto      a    = solver->fixed(order[q]);
	const bool      tied = a.tied;
	Change          c;
	c.place         = q;
	c.position      = s.se3.position != was.pos;
	c.velocity      = s.vel != was.vel;
	c.spin          = s.angVel != was.angVel;
	c.angle         = !((s.se3.orientation.coeffs() - was.ori.coeffs()).norm() < 1e-12); // a quaternion is normalised anew on its way through a file
	c.plasticStrain = differs(s.plasticStrain, was.plasticStrain), c.damage = differs(s.damage, was.damage);
	c.temperature   = differs(s.temperature, was.temperature), c.strength = differs(s.strength, was.strength);
	c.mask          = b.groupMask != was.mask;
	const mca::Ways free = freeWays(s), turns = freeTurns(s);
	bool            sameFree = true;
	for (size_t k = 0; k < 3; k++)
		sameFree &= (k >= size_t(dimension) || free[k] == a.free[k]) && ((dimension == 2 && k < 2) || turns[k] == a.freeSpin[k]);
	c.blocked = !tied && !sameFree;
	if (dimension == 2 && leavesPlane(s)) refuseBody(b, "blockedDOFs lets it leave the plane (x, y) of plane strain; block z, X and Y ('zXY') again.");
	if (c.position || c.velocity || c.spin || c.angle) checkMotion(b, dimension);
	if (tied && (c.position || c.velocity))
		refuseBody(b, "it is tied to a grid, which moves it; its position and velocity cannot be set. Set those of the grid before the first step.");
	if (c.velocity) checkDriven(b, was.vel);
	if (c.plasticStrain && !(s.plasticStrain >= 0 && s.plasticStrain <= 1e6))
		refuseBody(b, "state.plasticStrain = " + numberText(s.plasticStrain) + " must be from 0 to 1e6.");
	if (c.damage) checkDamage(b, s);
	if (c.temperature && !(s.temperature > 0 && s.temperature <= 1e9))
		refuseBody(b, "state.temperature = " + numberText(s.temperature) + " K must be above 0 and at most 1e9.");
	if (c.strength && !(s.strength > 0 && s.strength <= 1e9))
		refuseBody(b, "state.strength = " + numberText(s.strength) + " must be above 0 and at most 1e9.");
	refuseEnds(b, "triangles", s.triangles, was.triangles), refuseEnds(b, "mirrors", s.mirrors, was.mirrors);
	checkMirrors(b, s, was.pos);
	const Real radius = static_cast<const Sphere*>(b.shape.get())->radius;
	if (differs(s.mass, was.mass) || otherInertia(s, was.inertia, dimension) || differs(radius, was.radius))
		refuseBody(
			b,
			"mass " + numberText(s.mass) + ", inertia " + numberText(s.inertia[2]) + " or radius " + numberText(radius)
				+ " m was changed (from " + numberText(was.mass) + ", " + numberText(was.inertia) + ", " + numberText(was.radius)
				+ "); they are read when a body is taken over for the first time. Erase it and add another body.");
	const auto result = [&](const char* name, Real now, Real before) {
		if (differs(now, before))
			refuseBody(
				b,
				string("state.") + name + " was set to " + numberText(now) + " (it was " + numberText(before)
					+ "); it is a result of the law and cannot be prescribed. Set it back.");
	};
	result("pressure", s.pressure, was.pressure), result("volumeRatio", s.volumeRatio, was.volumeRatio), result("stressZZ", s.stressZZ, was.stressZZ),
		result("dissipated", s.dissipated, was.dissipated);
	result("links", s.links, was.links), result("brokenLinks", s.brokenLinks, was.brokenLinks),
		result("equivalentStress", s.equivalentStress, was.equivalentStress);
	rebuild |= b.material.get() != was.material;
	was.state = b.state, was.shape = b.shape; // others of the same content
	if (!c.angle) was.ori = s.se3.orientation;
	if (!c.blocked) was.blocked = s.blockedDOFs;
	return c;
}

void McaEngine::apply(const vector<Change>& list)
{
	bool motion = false, masks = false;
	for (const auto& c : list)
		motion |= c.motion(), masks |= c.mask;
	if (motion && !forcesReady) stale = true, solver->computeForces(); // the strain of the last step belongs to the motion before the change
	for (const auto& c : list) {
		const Body& b = *bodies[c.place];
		const auto& s = static_cast<const McaState&>(*b.state);
		Same&       now = same[c.place];
		mca::AutomatonChange to;
		if (c.position) now.pos = s.se3.position, to.position = triple(now.pos);
		if (c.velocity) now.vel = s.vel, to.velocity = triple(s.vel);
		if (c.spin) now.angVel = s.angVel, to.spin = triple(s.angVel);
		if (c.angle) now.ori = s.se3.orientation, now.angle.setConstant(NaN), to.angle = triple(angleOf(now.ori, dimension));
		if (c.plasticStrain) to.plasticStrain = now.plasticStrain = s.plasticStrain;
		if (c.damage) to.damage = now.damage = s.damage;
		if (c.temperature) to.temperature = now.temperature = s.temperature;
		if (c.strength) to.strength = now.strength = s.strength;
		if (c.mask) now.mask = b.groupMask, to.group = groupOf(b.groupMask, linkAcrossMasks);
		if (c.blocked) now.blocked = s.blockedDOFs, to.free = freeWays(s), to.freeSpin = freeTurns(s);
		solver->set(order[c.place], to);
	}
	if (motion) {
		solver->moved();
		forcesReady = false;
	}
	if (masks) solver->searchAnew();
}

void McaEngine::adoptChanges(Scene* scene)
{
	const bool set     = !sameBodies(*scene);
	bool       rebuild = false;
	const auto list    = changes(rebuild);
	rebuild |= !sameMaterials();
	apply(list);
	if (!set && !rebuild) return;
	// The strain of the last step belongs to those that made it. Where bodies were only erased it goes on with those that are left.
	std::unordered_set<const Body*> mine;
	for (const auto& b : bodies)
		mine.insert(b.get());
	const bool joined = std::any_of(
		scene->bodies->body.begin(), scene->bodies->body.end(), [&](const shared_ptr<Body>& b) { return movesAlone(b) && !mine.count(b.get()); });
	if ((joined || rebuild) && !forcesReady) { // not twice where the change is refused below
		solver->computeForces();
		forcesReady = true;
	}
	if (stale) writeBodies(scene);             // the others are gathered from what they hold
	gather(scene);
	if (joined || rebuild) solver->moved();
}

/// What the engine holds of one body; `was` remembers it. False when a script has changed what is written over.
bool McaEngine::writeBody(State& s, Same& was, const mca::AutomatonNow& now) const
{
	auto*        m    = castTo<McaState>(&s);
	bool         kept = s.se3.position == was.pos && s.vel == was.vel && s.angVel == was.angVel;
	kept &= unlike(s.se3.orientation.coeffs(), was.ori.coeffs()) == 0 || (s.se3.orientation.coeffs() - was.ori.coeffs()).norm() < 1e-12;
	if (m) kept &= !differs(m->plasticStrain, was.plasticStrain) && !differs(m->damage, was.damage) && !differs(m->temperature, was.temperature);
	was.pos = place(now, s), was.vel = vector3(now.velocity), was.angVel = vector3(now.spin);
	if (const Vector3r angle = vector3(now.angle); angle != was.angle) was.angle = angle, was.ori = orientationOf(angle, dimension);
	s.se3.position = was.pos, s.se3.orientation = was.ori, s.vel = was.vel, s.angVel = was.angVel;
	if (!m) return kept;
	m->pressure = was.pressure = now.pressure, m->volumeRatio = was.volumeRatio = now.volumeRatio;
	m->plasticStrain = was.plasticStrain = now.plasticStrain, m->damage = was.damage = now.damage;
	m->temperature = was.temperature = now.temperature;
	m->stressZZ = was.stressZZ = now.stressZZ, m->equivalentStress = was.equivalentStress = now.equivalentStress;
	m->links = was.links = now.links, m->brokenLinks = was.brokenLinks = now.brokenLinks;
	if (now.dissipated) m->dissipated = *now.dissipated;
	was.dissipated = m->dissipated;
	return kept;
}

void McaEngine::writeBodies(Scene* scene)
{
	Real lowest = 0;
	vector<Real> bulk; // modulus of each material [Pa]
	for (const auto& m : solver->materials()) bulk.push_back(m.eos.rho0 * m.eos.c0 * m.eos.c0);
	for (size_t q = 0; q < order.size(); q++) {
		if (const size_t p = q + ahead; p < order.size() && same[p].state) soon(static_cast<const McaState&>(*same[p].state));
		const auto& b = bodies[q];
		if (!b || !b->state) continue; // erased since loading; told by the next step
		const mca::AutomatonNow now = solver->now(order[q]);
		if (!writeBody(*b->state, same[q], now) && stale) lost = b->id;
		if (now.tension < 0) lowest = std::min(lowest, now.tension / bulk[size_t(solver->fixed(order[q]).material)]);
	}
	stale       = false;
	looked      = true;
	wrote       = true;
	lastWritten = lastMoved == scene->iter ? scene->iter : scene->iter - 1; // between two steps, the next one is counted already
	if (lowest < -0.25 && !warnedTension) {
		warnedTension = true;
		LOG_WARN(
			"McaEngine: the tensile pressure is " << -lowest
							      << " of the bulk modulus. Links hold any tension unless the material has a strength "
		                                                 "(spallStrength, fractureStrain, pairStrength or fractureStress).");
	}
	if (scene->trackEnergy) writeEnergies(scene);
	if (lost < 0) return;
	LOG_ERROR(
		"McaEngine: body " << lost
				   << " was changed by a script while the loop ran in the background, when the bodies are not up to date. The change is lost.");
}

void McaEngine::bringUpToDate()
{
	locked([&] {
		const auto scene = home.lock();
		if (!solver || !stale || !scene || (solver->counters().steps == 0 && !wrote)) return;
		writeBodies(scene.get());
	});
}
} // namespace yade
