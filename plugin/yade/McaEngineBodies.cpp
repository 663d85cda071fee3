// SPDX-License-Identifier: GPL-2.0-or-later
// McaEngine and the bodies: which it moves. What scripts change in them: McaEngineChanges.cpp.
#include "McaBodies.hpp"
#include "McaCast.hpp"
#include "McaEngine.hpp"
#include "McaPairRules.hpp"
#include "McaVec.hpp"
#include <core/Omega.hpp>
#include <pkg/common/Sphere.hpp>
#include <unordered_set>

namespace yade {
using mca::AutomatonStart;

namespace {
	/// A body that an engine takes for the first time brings no results of another one: they could not go on.
	void checkFresh(const Body& b, const McaState& s)
	{
		if (s.law)
			refuseBody(
				b, "McaLaw has moved it, with stresses that cannot be taken over; go on with the law in YADE's own loop, or make new bodies.");
		const auto within = [&](const char* name, Real v, Real lo, Real hi, const char* unit) {
			if (!(v >= lo && v <= hi))
				refuseBody(
					b,
					string("state.") + name + " = " + numberText(v) + unit + " must be from " + numberText(lo) + " to " + numberText(hi)
						+ ".");
		};
		within("plasticStrain", s.plasticStrain, 0, 1e6, ""), within("temperature", s.temperature, 0, 1e9, " K"),
			within("strength", s.strength, 0, 1e9, ""), checkDamage(b, s);
		if (s.brokenLinks != 0 || s.pressure != 0 || s.volumeRatio != 1 || s.equivalentStress != 0 || s.stressZZ != 0 || s.dissipated != 0)
			refuseBody(
				b,
				"its state holds results (brokenLinks = " + std::to_string(s.brokenLinks) + ", pressure = " + numberText(s.pressure)
					+ " Pa, stressZZ = " + numberText(s.stressZZ) + " Pa, dissipated = " + numberText(s.dissipated)
					+ " J/kg, volumeRatio = " + numberText(s.volumeRatio) + ", equivalentStress = " + numberText(s.equivalentStress)
					+ " Pa): broken links would heal and stress be dropped. An engine starts from rest: keep the engine that made them in "
			                  "O.engines, or give the body the state of "
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
		throw mca::Error(
			string("McaEngine.") + call
			+ ": the bodies of this engine are those of another scene, which is gone (O.reset, O.load) or not the present one (O.switchToScene); "
		          "take the engine of the present scene from "
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
		if (!bodies.empty()) // what was given for bodies that are gone; what was given before the first step stays
			viscous.clear(), viscousZ.clear(), forgetLoads(), letGo(pairMaterials, pairNumbers);
		solver.reset();
		letGo(bodies, same, known, walls), order.clear(), wallStarts.clear();
		lost  = -1;
		stale = forcesReady = stressGiven = false, looked = true, warnedEmpty = warnedTension = wrote = false, lastWritten = -1;
		std::fill(std::begin(energyIndex), std::end(energyIndex), -1);
	} else bind(scene);
	home = present;
}

/// Bodies of a loaded engine.
void McaEngine::bind(Scene* scene)
{
	checkNumbers(*scene);
	vector<shared_ptr<Body>> found;
	for (int id : order) {
		if (!solver->holds(id))
			throw mca::Error(
				"McaEngine: body " + std::to_string(id)
				+ " stands in the saved engine's list, but not in its state; the file is damaged or was changed.");
		found.push_back(scene->bodies->exists(id) ? scene->bodies->body[size_t(id)] : nullptr); // erased since it was loaded
		if (found.back() && (!movesAlone(found.back()) || !castTo<McaState>(found.back()->state.get())))
			throw mca::Error(
				"McaEngine: the saved engine moves body " + std::to_string(id)
				+ ", which is no automaton (material McaMat, shape Sphere, state McaState); the file is damaged, or the body was changed since "
			          "it was loaded.");
	}
	known.assign(solver->materials().size(), nullptr);
	for (size_t q = 0; q < order.size(); q++)
		if (found[q]) known[size_t(solver->fixed(order[q]).material)] = found[q]->material;
	bodies = found;
	same.assign(order.size(), Same());
	for (size_t q = 0; q < order.size(); q++)
		takeConstants(q), takeResults(q);
	givePairRules(true);
	looked = true;
	if (!bodiesSaved) writeBodies(scene);
}

Vector3r McaEngine::place(const mca::AutomatonNow& a, const State& s) const
{
	return Vector3r(a.position[0], a.position[1], dimension == 2 ? s.se3.position[2] : a.position[2]);
}

/// Of the materials that its bodies have.
void McaEngine::givePairRules(bool loaded)
{
	vector<const Material*> materials;
	for (const auto& m : known) materials.push_back(m.get());
	solver->setPairRules(pairRulesOf(pairMaterials, pairNumbers, materials), loaded);
	for (const auto& m : pairMaterials)
		if (std::find(materials.begin(), materials.end(), m.get()) == materials.end())
			LOG_WARN("McaEngine.setPair: no automaton has the material '" << m->label << "' now; its rule waits for one.");
}

/// What is read when a body is taken over.
void McaEngine::takeConstants(size_t q)
{
	const mca::AutomatonFixed a = solver->fixed(order[q]);
	Same&                     was = same[q];
	was.mass = a.mass, was.inertia = a.inertia, was.radius = 0.5 * a.diameter, was.strength = a.strength;
	was.mask     = linkAcrossMasks && bodies[q] ? bodies[q]->groupMask : a.group;
	was.material = known[size_t(a.material)].get();
	if (!bodies[q]) return;
	was.state = bodies[q]->state, was.shape = bodies[q]->shape;
	if (!was.state) return;
	const auto& s = static_cast<const McaState&>(*was.state);
	was.blocked = s.blockedDOFs, was.triangles = s.triangles, was.mirrors = s.mirrors;
}

/// The body of a loaded engine held what the engine holds when both were saved; a script may have changed it since.
void McaEngine::takeResults(size_t q)
{
	if (!bodies[q]) return;
	const mca::AutomatonNow a = solver->now(order[q]);
	const McaState& s   = static_cast<const McaState&>(*bodies[q]->state);
	Same&           was = same[q];
	was.pos = place(a, s), was.vel = vector3(a.velocity), was.angVel = vector3(a.spin);
	was.angle = vector3(a.angle), was.ori = orientationOf(was.angle, dimension);
	was.blocked = ~0u; // to be compared with what the solver has
	was.pressure = a.pressure, was.volumeRatio = a.volumeRatio, was.plasticStrain = a.plasticStrain, was.damage = a.damage,
	was.temperature = a.temperature;
	was.stressZZ = a.stressZZ, was.dissipated = a.dissipated.value_or(0.);
	was.equivalentStress = s.equivalentStress, was.links = s.links, was.brokenLinks = s.brokenLinks; // follow from the rest
}

/// Throws Error when a body cannot be an automaton, or would be passed through.
void McaEngine::checkBodies(const Scene& scene, int dimensionNow) const
{
	for (const auto& b : scene.bodies->body) {
		if (!b) continue;
		if (!movesAlone(b)) {
			if (!wallsAreOthers(scene) && mayBeTouched(*b)) wallOf(scene, *b); // refuses what they cannot touch
			continue;
		}
		if (!b->state || !castTo<McaState>(b->state.get()))
			throw mca::Error(
				"McaEngine: body " + std::to_string(b->id)
				+ " has material McaMat but not a McaState; make its state with material.newAssocState().");
		checkMotion(*b, dimensionNow);
	}
}

template <class F> void McaEngine::dropDampers(F&& goes)
{
	size_t kept = 0;
	for (size_t k = 0; k < viscous.size(); k++)
		if (!goes(int(viscous[k][0]))) viscous[kept] = viscous[k], viscousZ[kept] = viscousZ[k], kept++;
	viscous.resize(kept), viscousZ.resize(kept);
}

void McaEngine::gather(Scene* scene)
{
	const int dimensionNow = dimensionOf(*scene);
	checkBodies(*scene, dimensionNow);
	std::unordered_set<const Body*> mine;
	for (const auto& b : bodies)
		if (b) mine.insert(b.get());
	McaBodies now(*scene, seed, dimensionNow, linkAcrossMasks);
	vector<shared_ptr<Body>> list;
	for (auto& a : now.automata) {
		const auto& b = scene->bodies->body[size_t(a.id)];
		const auto& s = static_cast<const McaState&>(*b->state);
		a.isNew       = !mine.count(b.get());
		if (a.isNew) checkFresh(*b, s);
		a.temperature = s.temperature;
		list.push_back(b);
	}
	shared_ptr<mca::Automata> fresh(mca::automataIn(dimensionNow));
	// no automaton goes on: a new start, as in the next case of a sweep
	const bool goesOn = solver && std::any_of(now.automata.begin(), now.automata.end(), [](const AutomatonStart& a) { return !a.isNew; });
	if (!goesOn && solver && carriesRows())
		throw mca::Error("McaEngine: all automata are gone, and with them rows that are tied to a grid; they cannot be erased. Make a new McaEngine, "
		                 "grid and coupler for the new bodies.");
	if (goesOn && dimensionNow != dimension)
		throw mca::Error(
			string("McaEngine: the automata are in ") + (dimension == 2 ? "plane strain" : "space")
			+ ", and a script has blocked or freed motion along z or about x or y since they were gathered; set blockedDOFs back.");
	fresh->build(now.automata, now.materials, solverOptions(scene), goesOn ? solver.get() : nullptr);
	// what rules of pairs refuse is refused before anything changes
	fresh->setPairRules(pairRulesOf(pairMaterials, pairNumbers, { now.known.begin(), now.known.end() }), false);
	std::unordered_set<int> newIds;
	for (auto& a : now.automata)
		if (a.isNew) newIds.insert(a.id);
	const auto goes = [&](int id) { return !fresh->holds(id) || newIds.count(id); };
	if (solver) dropDampers(goes), dropLoads(goes); // with the bodies
	if (goesOn) fresh->setWallTouches(solver->wallTouches());
	wallStarts.clear();
	solver      = fresh;
	dimension   = dimensionNow;
	order       = now.ids;
	bodies.swap(list);
	forcesReady = false;
	letGo(list, known, same);
	for (const auto* m : now.known)
		for (const auto& b : bodies)
			if (b->material.get() == m) {
				known.push_back(b->material);
				break;
			}
	for (size_t k = 0; k < viscous.size(); k++)
		if (solver->holds(int(viscous[k][0]))) solver->setDamping(int(viscous[k][0]), { viscous[k][1], viscous[k][2], viscousZ[k] });
	givePairRules();
	same.assign(order.size(), Same());
	for (size_t q = 0; q < order.size(); q++)
		takeConstants(q);
	writeBodies(scene); // numbers of links and the like follow from who is there
}

void McaEngine::ensureBuilt(Scene* scene)
{
	settleIn(scene);
	if (lost >= 0) {
		const int id = lost;
		lost         = -1;
		throw mca::Error(
			"McaEngine: body " + std::to_string(id)
			+ " was changed by a script while the loop ran in the background, when the bodies are not up to date; the change is lost. Pause first "
		          "(O.pause()), or call reload() of the "
			  "engine right after the change. The next step goes on without it.");
	}
	if (!solver) {
		gather(scene);
	} else if (looked) {
		takeOptions(scene);
		adoptChanges(scene);
	}
	solver->options().account = account || scene->trackEnergy;
	solver->setTiming(TimingInfo::enabled);
}
} // namespace yade
