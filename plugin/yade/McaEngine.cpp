// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaEngine.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include "McaLook.hpp"
#include "McaVec.hpp"
#include <automata/automata.hpp>

namespace yade {
YADE_PLUGIN((McaEngine));

mca::AutomataOptions McaEngine::solverOptions(Scene* scene) const
{
	mca::AutomataOptions o;
	if (volumeRule == "affine") o.volumeRule = mca::VolumeRule::affine;
	else if (volumeRule == "inversePower") o.volumeRule = mca::VolumeRule::inversePower;
	else if (volumeRule == "meanDistance") o.volumeRule = mca::VolumeRule::meanDistance;
	else throw mca::Error("McaEngine: volumeRule = '" + volumeRule + "' is unknown; it must be 'affine', 'inversePower' or 'meanDistance'.");
	auto within = [](const char* name, Real v, Real lo, Real hi) {
		if (v >= lo && v <= hi) return;
		std::ostringstream s;
		s << "McaEngine: " << name << " = " << v << " must be from " << lo << " to " << hi << ".";
		throw mca::Error(s.str());
	};
	within("linkFactor", linkFactor, 1.02, 1.5);
	within("skin", skin, 0.05, 1.);
	within("dtFactor", dtFactor, 1e-6, 1.);
	within("volumeFilter", volumeFilter, 0., 1.);
	within("writePeriod", writePeriod, 0, 2147483647.);
	within("damping", damping, 0., 0.95);
	within("gravity x [m/s2]", gravity[0], -1e15, 1e15), within("gravity y [m/s2]", gravity[1], -1e15, 1e15);
	within("gravityZ [m/s2]", gravityZ, -1e15, 1e15);
	o.volumeFilter = volumeFilter, o.linkFactor = linkFactor, o.skin = skin, o.sleeping = sleeping, o.contacts = contacts, o.acrossMasks = linkAcrossMasks;
	if (coupled && damping > 0)
		throw mca::Error("McaEngine: damping acts on automata only, and the grid that they are tied to would not be damped; set damping = 0.");
	o.account = account || scene->trackEnergy;
	return o;
}

/// What may change during a run; what may not is refused.
void McaEngine::takeOptions(Scene* scene)
{
	const auto now  = solverOptions(scene);
	auto&      mine = solver->options();
	const auto kept = [](const char* name, bool same) {
		if (!same)
			throw mca::Error(
				string("McaEngine: ") + name
				+ " was changed after the bodies were gathered, when it is read; set it back, or make a new engine with new bodies.");
	};
	kept("volumeRule", now.volumeRule == mine.volumeRule), kept("linkFactor", now.linkFactor == mine.linkFactor);
	kept("linkAcrossMasks", now.acrossMasks == mine.acrossMasks);
	kept("sleeping", now.sleeping == mine.sleeping), kept("contacts", now.contacts == mine.contacts);
	if (now.skin != mine.skin) solver->searchAnew();
	mine.skin = now.skin, mine.volumeFilter = now.volumeFilter;
}

/// Other engines of the scene that would move automata, too, or expect that this one does what it does not.
void McaEngine::checkScene(Scene* scene) const
{
	if (coupled && acceleration() != Vector3r::Zero())
		throw mca::Error("McaEngine: gravity acts on automata only, and the grid that they are tied to would not fall; set gravity = (0, 0).");
	const Engine* newton = nullptr;
	for (const auto& e : scene->engines) {
		if (e->dead || e.get() == this) continue;
		if (dynamic_cast<const McaEngine*>(e.get()))
			throw mca::Error("McaEngine: there are two in O.engines, and each would move all automata; leave one.");
		const auto* other = dynamic_cast<const McaSolverEngine*>(e.get());
		if (other && other->movesAutomata())
			throw mca::Error("O.engines has McaEngine and McaLaw; an automaton can be moved by one of them only.");
		if (e->getClassName() == "NewtonIntegrator") newton = e.get();
	}
	if (!newton || order.empty()) return;
	const PyGILState_STATE state = PyGILState_Ensure(); // its declaration is not among ours: asked through Python
	int                    mask  = 0;
	Vector3r               g     = Vector3r::Zero();
	try {
		for (const auto& e : scene->engines)
			if (e.get() == newton) {
				const py::object o(e);
				mask = py::extract<int>(o.attr("mask")), g = py::extract<Vector3r>(o.attr("gravity"));
			}
	} catch (const py::error_already_set&) {
		PyErr_Clear();
	}
	PyGILState_Release(state);
	for (const auto& b : bodies)
		if (mask <= 0 || (b->groupMask & mask))
			throw mca::Error(
				"McaEngine: NewtonIntegrator (mask " + std::to_string(mask) + ") would move body " + std::to_string(b->id) + " (mask "
				+ std::to_string(b->groupMask) + ") a second time; give it a mask that no automaton has, or leave it out.");
	if (g != Vector3r::Zero() && acceleration() == Vector3r::Zero() && !warnedGravity) {
		warnedGravity = true;
		LOG_WARN("McaEngine: the gravity of NewtonIntegrator acts on the bodies of its mask only, not on automata; theirs is McaEngine.gravity.");
	}
}

void McaEngine::readExternal(Scene* scene)
{
	const Vector3r g = acceleration();
	const bool     loaded = !loadRows.empty();
	if (dimension == 2 && gravityZ != 0) throw mca::Error("McaEngine: gravityZ is for bodies in space; these are in plane strain: set it to 0.");
	if (!readForces && g == Vector3r::Zero() && !loaded) {
		if (solver->hasForces()) solver->clearForces();
		return;
	}
	solver->clearForces();
	if (g != Vector3r::Zero()) solver->addGravity(triple(g));
	if (loaded) pushLoads(*scene);
	if (!readForces) return;
	scene->forces.sync();
	for (int id : order) {
		const Vector3r &f = scene->forces.getForce(id), &t = scene->forces.getTorque(id);
		if (!f.allFinite() || !t.allFinite()) throw mca::Error("body " + std::to_string(id) + ": an engine has put a force on it that is not finite.");
		if (f != Vector3r::Zero() || t != Vector3r::Zero()) solver->addForce(id, triple(f), triple(t));
	}
}

mca::automata::Solver& McaEngine::automata()
{
	if (auto* plane = solver->asPlane()) return *plane;
	throw mca::Error("McaEngine: its automata are in space, and a grid is in plane strain: rows in space cannot be tied.");
}

Real McaEngine::criticalTimeStep() const { return solver ? solver->criticalStep() : std::numeric_limits<Real>::infinity(); }

void McaEngine::computeForces(Scene* scene)
{
	const bool check = looked || !solver;
	ensureBuilt(scene);
	if (check) checkScene(scene), gatherWalls(scene);
	looked = false; // a refusal above is asked again by the next step
	if (!loadRows.empty()) heatLoads(*scene);
	if (!forcesReady) { // not twice when something has stopped the step half-way: stresses would grow twice
		stale = true;
		solver->computeForces();
	}
	forcesReady = true;
	readExternal(scene);
	pushWalls(scene->dt);
	if (damping == 0) return;
	if (coupled || !(damping > 0 && damping <= 0.95)) solverOptions(scene); // refuses it
	solver->resist(damping); // of all forces
}

void McaEngine::forget()
{
	locked([&] {
		if (!solver || solver->counters().steps > 0 || stressGiven) return;
		solver.reset();
		letGo(bodies, same, known, walls), order.clear(), wallStarts.clear();
		home.reset();
		forcesReady = false;
	});
}

void McaEngine::prepare(Scene* scene)
{
	locked([&] {
		ensureBuilt(scene);
		if (solver->criticalStep() == 0) computeForces(scene);
	});
}

void McaEngine::checkStep(Scene* scene) const
{
	const Real limit = solver->criticalStep();
	if (scene->dt > limit && !shortenStep(scene, limit)) {
		std::ostringstream s;
		s << "McaEngine: O.dt = " << scene->dt << " s is above the largest stable step " << limit << " s of body " << solver->stiffest()
		  << ". Set O.dt below it, or adaptive=True, or put a McaTimeStepper before it.";
		throw mca::Error(s.str());
	}
}

void McaEngine::integrate(Scene* scene)
{
	checkStep(scene);
	if (!loadRows.empty()) driveLoads(*scene);
	solver->integrate(scene->dt);
	forcesReady = false;
	stale       = true;
	lastMoved   = scene->iter;
}

void McaEngine::step()
{
	findCoupler(scene);
	locked([&] {
		computeForces(scene);
		if (coupled) return checkStep(scene); // before anything moves; the coupler integrates
		if (!(dtFactor >= 1e-6 && dtFactor <= 1)) solverOptions(scene); // refuses it
		if (adaptive && !order.empty()) {
			const Real limit = dtFactor * solver->criticalStep();
			scene->dt        = solver->counters().steps > 0 && scene->dt > 0 ? std::min(limit, 1.1 * scene->dt) : limit;
		}
		if (!walls.empty()) checkStep(scene), tellWalls(scene);
		integrate(scene);
		finish(scene);
	});
}

/// The end of a step, coupled or not: the bodies are told if anybody may look before the next one.
void McaEngine::finish(Scene* scene)
{
	if (order.empty() && !warnedEmpty) {
		warnedEmpty = true;
		LOG_WARN("McaEngine: O.bodies holds no automaton (material McaMat, shape Sphere); nothing moves and O.dt is left alone.");
	}
	const bool due = writePeriod > 0 && (scene->iter + 1) % writePeriod == 0;
	if (due || runEndsHere(*scene) || anotherLooks(*scene, this, [&](int id) { return isMine(id); })) {
		writeBodies(scene);
	}
	if (!TimingInfo::enabled) return;
	const auto&  c     = solver->counters();
	const Real   ns[]  = { c.nsSearch, c.nsDensity, c.nsStress, c.nsContact, c.nsForce, c.nsFracture, c.nsIntegrate };
	const char*  names[] = { "contact search", "density", "stress", "contacts", "forces", "fracture", "integration" };
	auto&        D     = *timingDeltas;
	D.data.resize(7), D.labels.resize(7);
	for (int k = 0; k < 7; k++)
		D.labels[size_t(k)] = names[k], D.data[size_t(k)].nsec = (unsigned long long)(ns[k]), D.data[size_t(k)].nExec = c.steps;
}
} // namespace yade
