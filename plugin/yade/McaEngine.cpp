// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaEngine.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>
#include "McaGridEngine.hpp"
#include "McaTimeStepper.hpp"
#include <sdk/arrayView.hpp>

namespace yade {
YADE_PLUGIN((McaEngine));

using mca::automata::Automaton;
using mca::automata::Solver;
using mca::automata::Store;

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
	bool isAutomaton(const shared_ptr<Body>& b) { return b && b->material && dynamic_cast<McaMat*>(b->material.get()) && dynamic_cast<Sphere*>(b->shape.get()); }
} // namespace

Real McaEngine::drawStrength(const McaMat& m, int id) const
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

mca::automata::Options McaEngine::solverOptions(Scene* scene) const
{
	mca::automata::Options o;
	if (volumeRule == "affine") o.volumeRule = mca::VolumeRule::affine;
	else if (volumeRule == "inversePower") o.volumeRule = mca::VolumeRule::inversePower;
	else if (volumeRule == "meanDistance") o.volumeRule = mca::VolumeRule::meanDistance;
	else throw mca::Error("McaEngine: volumeRule = '" + volumeRule + "' is unknown; it must be 'affine', 'inversePower' or 'meanDistance'.");
	auto within = [](const char* name, Real v, Real lo, Real hi) {
		if (!(v >= lo && v <= hi)) throw mca::Error(string("McaEngine: ") + name + " = " + std::to_string(v) + " must be from " + std::to_string(lo) + " to " + std::to_string(hi) + ".");
	};
	within("linkFactor", linkFactor, 1.02, 1.5);
	within("skin", skin, 0.05, 1.);
	within("dtFactor", dtFactor, 1e-6, 1.);
	within("volumeFilter", volumeFilter, 0., 1.);
	o.volumeFilter = volumeFilter, o.linkFactor = linkFactor, o.skin = skin, o.sleeping = sleeping, o.contacts = contacts;
	o.account = account || scene->trackEnergy;
	return o;
}

void McaEngine::gather(Scene* scene, const Solver* old)
{
	vector<mca::Material>  materials;
	vector<const McaMat*>  known;
	vector<Automaton>      list;
	order.clear();
	for (const auto& b : scene->bodies->body) {
		if (!isAutomaton(b)) continue;
		const auto* m  = static_cast<const McaMat*>(b->material.get());
		auto        it = std::find(known.begin(), known.end(), m);
		if (it == known.end()) {
			materials.push_back(m->toMaterial());
			known.push_back(m);
			it = known.end() - 1;
		}
		const State& s  = *b->state;
		auto*        ms = dynamic_cast<McaState*>(b->state.get());
		if (!ms) throw mca::Error("body " + std::to_string(b->id) + " has material McaMat but not a McaState; make its state with material.newAssocState().");
		Automaton a;
		a.x = s.se3.position[0], a.y = s.se3.position[1];
		a.vx = s.vel[0], a.vy = s.vel[1], a.omega = s.angVel[2];
		a.angle    = 2. * std::atan2(s.se3.orientation.z(), s.se3.orientation.w());
		a.mass     = s.mass;
		a.inertia  = s.inertia[2];
		a.diameter = 2. * static_cast<Sphere*>(b->shape.get())->radius;
		const Real full = m->density * mca::Lattice<2>::cell(a.diameter);
		a.weight        = a.mass / full;
		if (std::fabs(a.weight - 1.) < 1e-9) a.weight = 1.;
		if (a.mass > 0 && (a.weight < 0.05 || a.weight > 2))
			throw mca::Error("body " + std::to_string(b->id) + ": mass " + std::to_string(a.mass) + " kg/m is " + std::to_string(a.weight) + " of the full cell (" + std::to_string(full)
			                 + " kg/m); it must be 0.05 to 2. In plane strain the mass is density times area per 1 m of thickness: make the bodies with packings.addBodies.");
		if (ms->strength == 0) ms->strength = drawStrength(*m, b->id);
		a.strength = ms->strength;
		a.eqps     = ms->plasticStrain;
		a.material = int(it - known.begin());
		a.id       = b->id;
		a.group    = b->groupMask;
		a.freeX = !(s.blockedDOFs & State::DOF_X), a.freeY = !(s.blockedDOFs & State::DOF_Y), a.freeR = !(s.blockedDOFs & State::DOF_RZ);
		list.push_back(a);
		order.push_back(b->id);
	}
	auto fresh = shared_ptr<Solver>(new Solver);
	fresh->build(list, materials, solverOptions(scene), old);
	solver      = fresh;
	forcesReady = false;
	for (auto& v : viscous) {
		const auto i = solver->indexOf(int(v[0]));
		if (i >= 0) solver->setDamping(i, v[1], v[2]);
	}
	writtenPos.clear();
	checkBodies = false;
}

void McaEngine::ensureBuilt(Scene* scene)
{
	if (loaded) {
		loaded = false;
		checkBodies = true;
	} else if (!solver)
		gather(scene, nullptr);
	else if (checkBodies)
		adoptChanges(scene);
	checkBodies             = false;
	solver->options.account = account || scene->trackEnergy;
	solver->timing          = TimingInfo::enabled;
}

// After a run the script may have changed bodies: those that differ from what was written are taken over.
void McaEngine::adoptChanges(Scene* scene)
{
	if (writtenPos.empty() && !order.empty()) return;
	vector<int> now;
	for (const auto& b : scene->bodies->body)
		if (isAutomaton(b)) now.push_back(b->id);
	if (now != order) {
		changeBodies(scene);
		return;
	}
	bool changed = false;
	for (size_t q = 0; q < order.size(); q++) {
		const State& s = *scene->bodies->body[order[q]]->state;
		changed |= s.se3.position != writtenPos[q] || s.vel != writtenVel[q] || s.angVel[2] != writtenSpin[q];
	}
	if (changed) solver->computeForces(); // the strain of the last step belongs to the motion before the change
	bool   moved = false;
	Store& S     = solver->store;
	for (size_t q = 0; q < order.size(); q++) {
		const State& s = *scene->bodies->body[order[q]]->state;
		const size_t i = solver->indexOf(order[q]);
		if (s.se3.position != writtenPos[q]) {
			if (!s.se3.position.allFinite()) throw mca::Error("body " + std::to_string(order[q]) + ": position is not finite; give finite numbers.");
			S.x[i] = s.se3.position[0], S.y[i] = s.se3.position[1];
			moved = true;
		}
		if (s.vel != writtenVel[q]) {
			if (!s.vel.allFinite()) throw mca::Error("body " + std::to_string(order[q]) + ": velocity is not finite; give finite numbers.");
			S.vx[i] = s.vel[0], S.vy[i] = s.vel[1];
			moved = true;
		}
		if (s.angVel[2] != writtenSpin[q]) {
			if (!std::isfinite(s.angVel[2])) throw mca::Error("body " + std::to_string(order[q]) + ": angular velocity is not finite; give finite numbers.");
			S.omega[i] = s.angVel[2];
			moved = true;
		}
		if (S.flags[i] & mca::automata::tiedBit) continue;
		S.ax[i] = s.blockedDOFs & State::DOF_X ? 0. : 1. / S.mass[i];
		S.ay[i] = s.blockedDOFs & State::DOF_Y ? 0. : 1. / S.mass[i];
		S.ar[i] = s.blockedDOFs & State::DOF_RZ ? 0. : 1. / S.inertia[i];
	}
	if (moved) solver->moved();
}

// Bodies were added or erased: the others keep their links, stresses and history.
void McaEngine::changeBodies(Scene* scene)
{
	const auto before = order;
	writeBodies(scene);
	try {
		gather(scene, solver.get());
	} catch (...) {
		order = before;
		throw;
	}
}

void McaEngine::readExternal(Scene* scene)
{
	Store& S = solver->store;
	if (!readForces && gravity == Vector2r::Zero()) {
		if (!S.ex.empty()) solver->clearForces();
		return;
	}
	solver->clearForces();
	if (gravity != Vector2r::Zero())
		for (size_t i = 0; i < S.size(); i++)
			if (S.id[i] >= 0) solver->addForce(i, S.mass[i] * gravity[0], S.mass[i] * gravity[1], 0.);
	if (!readForces) return;
	scene->forces.sync();
	for (int id : order) {
		const Vector3r &f = scene->forces.getForce(id), &t = scene->forces.getTorque(id);
		if (!f.allFinite() || !t.allFinite()) throw mca::Error("body " + std::to_string(id) + ": an engine has put a force on it that is not finite.");
		if (f[0] != 0 || f[1] != 0 || t[2] != 0) solver->addForce(solver->indexOf(id), f[0], f[1], t[2]);
	}
}

Real McaEngine::criticalTimeStep() const { return solver ? solver->criticalStep() : std::numeric_limits<Real>::infinity(); }

void McaEngine::computeForces(Scene* scene)
{
	ensureBuilt(scene);
	if (!forcesReady) solver->computeForces(); // not twice when something has stopped the step half-way: stresses would grow twice
	forcesReady = true;
	readExternal(scene);
}

void McaEngine::forget()
{
	if (!solver || solver->counters.steps > 0) return;
	solver.reset();
	forcesReady = false;
}

void McaEngine::prepare(Scene* scene)
{
	ensureBuilt(scene);
	if (solver->criticalStep() == 0) computeForces(scene);
}

// Breaking links and first contacts can halve the stable step at once. Nothing has moved yet, so a time stepper that comes before this engine may
// still choose a shorter one, unless something between the two has already used the longer.
bool McaEngine::shortenStep(Scene* scene, Real limit) const
{
	McaTimeStepper* stepper = nullptr;
	for (const auto& e : scene->engines) {
		if (e.get() == this) break;
		if (e->dead) continue;
		if (auto* t = dynamic_cast<McaTimeStepper*>(e.get())) stepper = t->active ? t : nullptr;
		else if (dynamic_cast<McaGridEngine*>(e.get()) || e->getClassName() == "NewtonIntegrator") stepper = nullptr;
	}
	if (!stepper) return false;
	stepper->shorten(scene, limit, getClassName() + (label.empty() ? "" : " " + label));
	return true;
}

void McaEngine::checkStep(Scene* scene) const
{
	const Real limit = solver->criticalStep();
	if (scene->dt > limit && !shortenStep(scene, limit)) {
		const auto& S = solver->store;
		std::ostringstream s;
		s << "McaEngine: O.dt = " << scene->dt << " s is above the largest stable step " << limit << " s of body " << S.id[solver->stiffestAutomaton()]
		  << ". Set O.dt below it, or adaptive=True, or put a McaTimeStepper before it.";
		throw mca::Error(s.str());
	}
}

void McaEngine::integrate(Scene* scene)
{
	checkStep(scene);
	solver->integrate(scene->dt);
	forcesReady = false;
	stale       = true;
	finish(scene);
}

void McaEngine::action()
{
	findCoupler(scene);
	computeForces(scene);
	if (coupled) return checkStep(scene); // before anything moves; the coupler integrates
	if (adaptive) {
		const Real limit = dtFactor * solver->criticalStep();
		scene->dt        = solver->counters.steps > 0 ? std::min(limit, 1.1 * scene->dt) : limit;
	}
	integrate(scene);
}

void McaEngine::finish(Scene* scene)
{
	// a step of O.step() is a run of its own
	const bool last = (scene->stopAtIter > 0 && scene->iter + 1 >= scene->stopAtIter) || !Omega::instance().isRunning();
	if (last || (writePeriod > 0 && (scene->iter + 1) % writePeriod == 0)) {
		writeBodies(scene);
		checkBodies = true;
	}
	if (!TimingInfo::enabled) return;
	const auto&  c     = solver->counters;
	const Real   ns[]  = { c.nsSearch, c.nsDensity, c.nsStress, c.nsContact, c.nsForce, c.nsFracture, c.nsIntegrate };
	const char*  names[] = { "contact search", "density", "stress", "contacts", "forces", "fracture", "integration" };
	auto&        D     = *timingDeltas;
	D.data.resize(7), D.labels.resize(7);
	for (int k = 0; k < 7; k++)
		D.labels[k] = names[k], D.data[k].nsec = (unsigned long long)(ns[k]), D.data[k].nExec = c.steps;
}
} // namespace yade
