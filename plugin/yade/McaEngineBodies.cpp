// SPDX-License-Identifier: GPL-2.0-or-later
// McaEngine and the bodies: whenever a script can look, both hold the same; what it changes then is taken over or refused.
#include "McaBodies.hpp"
#include "McaCast.hpp"
#include "McaEngine.hpp"
#include <core/Omega.hpp>
#include <pkg/common/Sphere.hpp>
#include <unordered_set>

namespace yade {
using mca::automata::Automaton;
using mca::automata::Solver;
using mca::automata::Store;

/// What a script has changed in one body.
struct McaEngine::Change {
	size_t place; ///< in order
	bool   position, velocity, spin, angle, plasticStrain, temperature, strength, mask, blocked;
	bool   motion() const { return position || velocity || spin; }
};

namespace {
	string nameOf(const Body& b) { return "body " + std::to_string(b.id); }
	string text(Real v)
	{
		std::ostringstream s;
		s << v;
		return s.str();
	}
	[[noreturn]] void refuse(const Body& b, const string& what) { throw mca::Error("McaEngine: " + nameOf(b) + ": " + what); }
	bool              differs(Real a, Real b) { return !(a == b || (std::isnan(a) && std::isnan(b))); }

	void checkMotion(const Body& b)
	{
		const State& s = *b.state;
		if (!(s.vel.cwiseAbs().maxCoeff() < 1e100 && s.angVel.cwiseAbs().maxCoeff() < 1e100)) refuse(b, "vel or angVel is not finite; give finite numbers below 1e100 [m/s], [rad/s].");
		if (!(std::fabs(s.se3.orientation.coeffs().squaredNorm() - 1.) < 0.1)) refuse(b, "ori is no rotation; it must be a quaternion of norm 1.");
		if (!s.se3.position.allFinite() || !s.vel.allFinite() || !s.angVel.allFinite() || !s.se3.orientation.coeffs().allFinite())
			refuse(b, "position, velocity, angular velocity or orientation is not finite; give finite numbers.");
		if (s.vel[2] != 0 || s.angVel[0] != 0 || s.angVel[1] != 0)
			refuse(b, "velocity z = " + text(s.vel[2]) + " m/s, angular velocity x, y = " + text(s.angVel[0]) + ", " + text(s.angVel[1]) + " rad/s; in plane strain (x, y) they must be 0.");
		if (!(std::fabs(s.se3.position[0]) < 1e9 * 2. * static_cast<const Sphere*>(b.shape.get())->radius && std::fabs(s.se3.position[1]) < 1e9 * 2. * static_cast<const Sphere*>(b.shape.get())->radius))
			refuse(b, "position (" + text(s.se3.position[0]) + ", " + text(s.se3.position[1]) + ") m must be within 1e9 diameters of the origin.");
	}
	/// A body that an engine takes for the first time brings no results of another one: they could not go on.
	void checkFresh(const Body& b, const McaState& s)
	{
		if (s.law) refuse(b, "McaDensity has moved it, with stresses that cannot be taken over; go on with the law in YADE's own loop, or make new bodies.");
		const auto within = [&](const char* name, Real v, Real lo, Real hi, const char* unit) {
			if (!(v >= lo && v <= hi)) refuse(b, string("state.") + name + " = " + text(v) + unit + " must be from " + text(lo) + " to " + text(hi) + ".");
		};
		within("plasticStrain", s.plasticStrain, 0, 1e6, ""), within("temperature", s.temperature, 0, 1e9, " K"), within("strength", s.strength, 0, 1e9, "");
		if (s.brokenLinks != 0 || s.pressure != 0 || s.volumeRatio != 1 || s.equivalentStress != 0 || s.stressZZ != 0 || s.dissipated != 0)
			refuse(b, "its state holds results (brokenLinks = " + std::to_string(s.brokenLinks) + ", pressure = " + text(s.pressure) + " Pa, stressZZ = " + text(s.stressZZ) + " Pa, dissipated = " + text(s.dissipated) + " J/kg, volumeRatio = " + text(s.volumeRatio)
			               + ", equivalentStress = " + text(s.equivalentStress) + " Pa): broken links would heal and stress be dropped. An engine starts from rest: keep the engine that made them in O.engines, or give the body the state of "
			                 "rest with packings.resetStates(ids).");
	}
}

bool McaEngine::standsIn(const Scene& scene) const
{
	return std::any_of(scene.engines.begin(), scene.engines.end(), [&](const shared_ptr<Engine>& e) { return e.get() == this; });
}

/// The present scene, if its bodies are those of this engine, or none are yet. YADE keeps scenes alive that O.reset has replaced.
shared_ptr<Scene> McaEngine::myScene(const char* call) const
{
	const auto present = Omega::instance().getScene();
	if (solver && !bodies.empty() && home.lock() != present)
		throw mca::Error(string("McaEngine.") + call + ": the bodies of this engine are those of another scene, which is gone (O.reset, O.load) or not the present one (O.switchToScene); take the engine of the present scene from "
		                 "O.engines, or switch back first.");
	return present;
}

/// Another scene than that of the bodies: nothing of the old one stays. A loaded engine finds its bodies there.
void McaEngine::settleIn(Scene* scene)
{
	const auto now = home.lock();
	if (now && now.get() == scene) return;
	const auto present = Omega::instance().getScene();
	if (present.get() != scene) throw mca::Error("McaEngine: it runs in a scene that is not the present one.");
	const bool loaded = solver && bodies.empty() && !order.empty() && home.expired();
	if (!loaded) {
		if (!bodies.empty()) viscous.clear(); // dampers of bodies that are gone; those given before the first step stay
		solver.reset();
		bodies.clear(), same.clear(), known.clear(), order.clear();
		lost  = -1;
		stale = forcesReady = false, looked = true, warnedEmpty = warnedTension = false, lastWritten = -1;
		std::fill(std::begin(energyIndex), std::end(energyIndex), -1);
	} else bind(scene);
	home = present;
}

/// Bodies of a loaded engine.
void McaEngine::bind(Scene* scene)
{
	vector<shared_ptr<Body>> found;
	for (int id : order) {
		if (solver->indexOf(id) < 0) throw mca::Error("McaEngine: body " + std::to_string(id) + " stands in the saved engine's list, but not in its state; the file is damaged or was changed.");
		found.push_back(scene->bodies->exists(id) ? scene->bodies->body[size_t(id)] : nullptr); // erased since it was loaded
		if (found.back() && (!isAutomaton(found.back()) || !castTo<McaState>(found.back()->state.get())))
			throw mca::Error("McaEngine: the saved engine moves body " + std::to_string(id) + ", which is no automaton (material McaMat, shape Sphere, state McaState); the file is damaged, or the body was changed since it was loaded.");
	}
	known.assign(solver->store.materials.size(), nullptr);
	const Store& S = solver->store;
	for (size_t q = 0; q < order.size(); q++)
		if (found[q]) known[size_t(S.species[size_t(S.speciesOf(size_t(solver->indexOf(order[q]))))].material)] = found[q]->material;
	bodies = found;
	same.resize(order.size());
	for (size_t q = 0; q < order.size(); q++)
		remember(q);
	looked = true;
	if (!bodiesSaved) writeBodies(scene);
}

/// The body holds what the engine holds.
void McaEngine::remember(size_t q)
{
	const Store& S = solver->store;
	const size_t i = size_t(solver->indexOf(order[q]));
	const Real   z = bodies[q] && bodies[q]->state ? bodies[q]->state->se3.position[2] : 0.;
	same[q]        = { Vector3r(S.x[i], S.y[i], z), Vector3r(S.vx[i], S.vy[i], 0), S.omega[i], S.angle[i], S.eqps[i], S.temperature[i], S.P[i], S.J[i] };
}

void McaEngine::gather(Scene* scene)
{
	for (const auto& b : scene->bodies->body) {
		if (!b) continue;
		const bool automaton = b->material && castTo<McaMat>(b->material.get()) && b->shape && castTo<Sphere>(b->shape.get());
		if (!automaton) {
			const string shape = b->shape ? b->shape->getClassName() : "";
			if (!readForces && b->groupMask != 0 && (shape == "Wall" || shape == "Box" || shape == "Facet"))
				throw mca::Error("McaEngine: body " + std::to_string(b->id) + " is a " + shape + ", which automata would pass through. Use the law in YADE's own loop (scenes.law2Engines), hold automata by blockedDOFs, or give a body "
				                 "that is only looked at mask=0.");
			continue;
		}
		if (b->clumpId != Body::ID_NONE) throw mca::Error("McaEngine: body " + std::to_string(b->id) + " belongs to a clump, whose motion automata cannot follow; append it without O.bodies.appendClumped.");
		if (!b->state || !castTo<McaState>(b->state.get())) throw mca::Error("McaEngine: body " + std::to_string(b->id) + " has material McaMat but not a McaState; make its state with material.newAssocState().");
		checkMotion(*b);
	}
	std::unordered_set<const Body*> mine;
	for (const auto& b : bodies)
		if (b) mine.insert(b.get());
	McaBodies now(*scene, seed);
	vector<shared_ptr<Body>> list;
	for (auto& a : now.automata) {
		const auto& b = scene->bodies->body[size_t(a.id)];
		const auto& s = static_cast<const McaState&>(*b->state);
		a.isNew       = !mine.count(b.get());
		if (a.isNew) checkFresh(*b, s);
		a.temperature = s.temperature;
		list.push_back(b);
	}
	auto fresh = shared_ptr<Solver>(new Solver);
	// no automaton goes on: a new start, as in the next case of a sweep
	const bool goesOn = solver && std::any_of(now.automata.begin(), now.automata.end(), [](const Automaton& a) { return !a.isNew; });
	if (!goesOn && solver && carriesRows()) throw mca::Error("McaEngine: all automata are gone, and with them rows that are tied to a grid; they cannot be erased. Make a new McaEngine, grid and coupler for the new bodies.");
	fresh->build(now.automata, now.materials, solverOptions(scene), goesOn ? solver.get() : nullptr);
	std::unordered_set<int> newIds;
	for (auto& a : now.automata)
		if (a.isNew) newIds.insert(a.id);
	if (solver) // the dampers of bodies that are gone go with them
		viscous.erase(std::remove_if(viscous.begin(), viscous.end(), [&](const Vector3r& v) { return fresh->indexOf(int(v[0])) < 0 || newIds.count(int(v[0])); }), viscous.end());
	solver      = fresh;
	order       = now.ids;
	bodies      = list;
	forcesReady = false;
	known.clear();
	for (const auto* m : now.known)
		for (const auto& b : bodies)
			if (b->material.get() == m) {
				known.push_back(b->material);
				break;
			}
	for (auto& v : viscous) {
		const auto i = solver->indexOf(int(v[0]));
		if (i >= 0) solver->setDamping(size_t(i), v[1], v[2]);
	}
	same.resize(order.size());
	for (size_t q = 0; q < order.size(); q++)
		remember(q);
	writeBodies(scene); // numbers of links and the like follow from who is there
}

void McaEngine::ensureBuilt(Scene* scene)
{
	settleIn(scene);
	if (lost >= 0) {
		const int id = lost;
		lost         = -1;
		throw mca::Error("McaEngine: body " + std::to_string(id) + " was changed by a script while the loop ran in the background, when the bodies are not up to date; the change is lost. Pause first (O.pause()), or call reload() of the "
		                 "engine right after the change. The next step goes on without it.");
	}
	if (!solver) {
		gather(scene);
	} else if (looked) {
		takeOptions(scene);
		adoptChanges(scene);
	}
	solver->options.account = account || scene->trackEnergy;
	solver->timing          = TimingInfo::enabled;
}

bool McaEngine::sameBodies(const Scene& scene) const
{
	size_t q = 0;
	if (std::any_of(bodies.begin(), bodies.end(), [](const shared_ptr<Body>& b) { return !b; })) return false;
	for (const auto& b : scene.bodies->body) {
		if (q < bodies.size() && b.get() == bodies[q].get() && b) {
			if (!isAutomaton(b)) refuse(*b, "it is an automaton no more (its material or shape was replaced); erase it and add another body instead.");
			if (b->id != order[q]) return false;
			q++;
		} else if (isAutomaton(b)) return false;
	}
	return q == bodies.size();
}

bool McaEngine::sameMaterials() const
{
	for (size_t k = 0; k < known.size(); k++)
		if (known[k]) {
			const mca::Material now = static_cast<const McaMat&>(*known[k]).toMaterial();
			if (!mca::same(now, solver->store.materials[k])) return false;
		}
	return true;
}

/// What scripts have changed since body and engine were the same. rebuild: a body has another material. Throws before anything is taken over.
vector<McaEngine::Change> McaEngine::changes(bool& rebuild) const
{
	vector<Change> list;
	const Store&   S = solver->store;
	for (size_t q = 0; q < order.size(); q++) {
		if (!bodies[q]) continue;
		const Body&  b = *bodies[q];
		const auto*  m = b.state ? castTo<const McaState>(b.state.get()) : nullptr;
		if (!m) refuse(b, "its state was replaced by one that is no McaState; make it with material.newAssocState().");
		const McaState& s   = *m;
		const Same&     was = same[q];
		const size_t    i   = size_t(solver->indexOf(order[q]));
		const bool      tied = S.flags[i] & mca::tiedBit;
		Change          c;
		c.place         = q;
		c.position      = s.se3.position != was.pos;
		c.velocity      = s.vel != was.vel;
		c.spin          = s.angVel != Vector3r(0, 0, was.spin);
		// a quaternion is normalised anew on its way through a file
		c.angle         = !((s.se3.orientation.coeffs() - Quaternionr(AngleAxisr(was.angle, Vector3r::UnitZ())).coeffs()).norm() < 1e-12);
		c.plasticStrain = differs(s.plasticStrain, was.plasticStrain);
		c.temperature   = differs(s.temperature, was.temperature);
		c.strength      = differs(s.strength, S.strength[i]);
		c.mask          = b.groupMask != S.group[i];
		const auto free = [&](unsigned dof, Real inverse) { return !(s.blockedDOFs & dof) == (inverse > 0); };
		c.blocked       = !tied && !(free(State::DOF_X, S.ax[i]) && free(State::DOF_Y, S.ay[i]) && free(State::DOF_RZ, S.ar[i]));
		if (c.position || c.velocity || c.spin || c.angle) checkMotion(b);
		if (tied && (c.position || c.velocity)) refuse(b, "it is tied to a grid, which moves it; its position and velocity cannot be set. Set those of the grid before the first step.");
		if (c.plasticStrain && !(s.plasticStrain >= 0 && s.plasticStrain <= 1e6)) refuse(b, "state.plasticStrain = " + text(s.plasticStrain) + " must be from 0 to 1e6.");
		if (c.temperature && !(s.temperature > 0 && s.temperature <= 1e9)) refuse(b, "state.temperature = " + text(s.temperature) + " K must be above 0 and at most 1e9.");
		if (c.strength && !(s.strength > 0 && s.strength <= 1e9)) refuse(b, "state.strength = " + text(s.strength) + " must be above 0 and at most 1e9.");
		const Real radius = static_cast<const Sphere*>(b.shape.get())->radius;
		if (differs(s.mass, S.mass[i]) || differs(s.inertia[2], S.inertia[i]) || differs(2. * radius, S.diameter[i]))
			refuse(b, "mass " + text(s.mass) + " kg/m, inertia " + text(s.inertia[2]) + " kg m or radius " + text(radius) + " m was changed (from " + text(S.mass[i]) + ", " + text(S.inertia[i]) + ", " + text(0.5 * S.diameter[i])
			               + "); they are read when a body is taken over for the first time. Erase it and add another body.");
		const auto result = [&](const char* name, Real now, Real before) {
			if (differs(now, before)) refuse(b, string("state.") + name + " was set to " + text(now) + " (it was " + text(before) + "); it is a result of the law and cannot be prescribed. Set it back.");
		};
		result("pressure", s.pressure, was.pressure), result("volumeRatio", s.volumeRatio, was.volumeRatio);
		if (!stale) {
			const int links = mca::linkCount(S.flags[i]), broken = mca::brokenCount(S.flags[i]);
			if (lastWritten >= 0) result("links", s.links, links), result("brokenLinks", s.brokenLinks, broken), result("equivalentStress", s.equivalentStress, solver->equivalentStress(i));
			result("stressZZ", s.stressZZ, S.szz[i]), result("dissipated", s.dissipated, S.heat.empty() ? 0. : S.heat[i]);
		}
		rebuild |= b.material.get() != known[size_t(S.species[size_t(S.speciesOf(i))].material)].get();
		if (c.motion() || c.angle || c.plasticStrain || c.temperature || c.strength || c.mask || c.blocked) list.push_back(c);
	}
	return list;
}

void McaEngine::apply(const vector<Change>& list)
{
	Store& S      = solver->store;
	bool   motion = false, masks = false;
	for (const auto& c : list)
		motion |= c.motion(), masks |= c.mask;
	if (motion && !forcesReady) stale = true, solver->computeForces(); // the strain of the last step belongs to the motion before the change
	for (const auto& c : list) {
		const Body&  b = *bodies[c.place];
		const auto&  s = static_cast<const McaState&>(*b.state);
		const size_t i = size_t(solver->indexOf(order[c.place])); // sorting may have moved it
		Same&        now = same[c.place];
		if (c.position) now.pos = s.se3.position, S.x[i] = now.pos[0], S.y[i] = now.pos[1];
		if (c.velocity) now.vel = s.vel, S.vx[i] = s.vel[0], S.vy[i] = s.vel[1];
		if (c.spin) S.omega[i] = now.spin = s.angVel[2];
		if (c.angle) S.angle[i] = now.angle = 2. * std::atan2(s.se3.orientation.z(), s.se3.orientation.w());
		if (c.plasticStrain) S.eqps[i] = now.plasticStrain = s.plasticStrain;
		if (c.temperature) S.temperature[i] = now.temperature = s.temperature;
		if (c.strength) S.strength[i] = s.strength;
		if (c.mask) S.group[i] = b.groupMask;
		if (c.blocked) {
			S.ax[i] = s.blockedDOFs & State::DOF_X ? 0. : 1. / S.mass[i];
			S.ay[i] = s.blockedDOFs & State::DOF_Y ? 0. : 1. / S.mass[i];
			S.ar[i] = s.blockedDOFs & State::DOF_RZ ? 0. : 1. / S.inertia[i];
		}
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
	const bool joined = std::any_of(scene->bodies->body.begin(), scene->bodies->body.end(), [&](const shared_ptr<Body>& b) { return isAutomaton(b) && !mine.count(b.get()); });
	if ((joined || rebuild) && !forcesReady) solver->computeForces();
	if (stale) writeBodies(scene);             // the others are gathered from what they hold
	gather(scene);
	if (joined || rebuild) solver->moved();
}

void McaEngine::writeBodies(Scene* scene)
{
	const Store& S = solver->store;
	const long   n = long(order.size());
	Real         lowest = 0;
	for (long q = 0; q < n; q++) {
		const auto&  b = bodies[size_t(q)];
		const size_t i = size_t(solver->indexOf(order[size_t(q)]));
		if (!b || !b->state) continue; // erased since loading; told by the next step
		State& s = *b->state;
		if (stale && (s.se3.position != same[size_t(q)].pos || s.vel != same[size_t(q)].vel || s.angVel[2] != same[size_t(q)].spin)) lost = b->id;
		s.se3.position[0] = S.x[i], s.se3.position[1] = S.y[i];
		s.vel             = Vector3r(S.vx[i], S.vy[i], 0);
		s.angVel          = Vector3r(0, 0, S.omega[i]);
		s.se3.orientation = Quaternionr(AngleAxisr(S.angle[i], Vector3r::UnitZ()));
		if (auto* m = castTo<McaState>(&s)) {
			m->pressure = S.P[i], m->volumeRatio = S.J[i], m->plasticStrain = S.eqps[i], m->temperature = S.temperature[i], m->stressZZ = S.szz[i];
			m->equivalentStress = solver->equivalentStress(i);
			m->links            = mca::linkCount(S.flags[i]);
			m->brokenLinks      = mca::brokenCount(S.flags[i]);
			if (!S.heat.empty()) m->dissipated = S.heat[i];
		}
		remember(size_t(q));
		const auto& m = S.materials[size_t(S.species[size_t(S.speciesOf(i))].material)];
		lowest        = std::min(lowest, S.P[i] / (m.eos.rho0 * m.eos.c0 * m.eos.c0));
	}
	stale       = false;
	looked      = true;
	lastWritten = scene->iter;
	if (lowest < -0.25 && !warnedTension) {
		warnedTension = true;
		LOG_WARN("McaEngine: the tensile pressure is " << -lowest << " of the bulk modulus. Links hold any tension unless the material has a strength (spallStrength, fractureStrain, pairStrength or fractureStress).");
	}
	if (scene->trackEnergy) writeEnergies(scene);
	if (lost < 0) return;
	LOG_ERROR("McaEngine: body " << lost << " was changed by a script while the loop ran in the background, when the bodies are not up to date. The change is lost.");
}


void McaEngine::bringUpToDate()
{
	locked([&] {
		const auto scene = home.lock();
		if (!solver || !stale || !scene || (solver->counters.steps == 0 && lastWritten < 0)) return;
		writeBodies(scene.get());
	});
}
} // namespace yade
