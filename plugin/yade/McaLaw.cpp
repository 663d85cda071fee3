// SPDX-License-Identifier: GPL-2.0-or-later
// McaLaw as an engine: its options, its place among O.engines, the time step, what it tells scripts. The law itself is in law/.
#include "McaLaw.hpp"
#include "McaBodies.hpp"
#include "McaCast.hpp"
#include "McaGuarded.hpp"
#include "McaPairRules.hpp"
#include "law/McaLawLoop.hpp"
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>

namespace yade {
YADE_PLUGIN((McaLaw)(McaDensity)(McaForces));

namespace {
	template <class... Part> [[noreturn]] void refuse(const Part&... part)
	{
		std::ostringstream s;
		(s << ... << part);
		throw mca::Error(s.str());
	}
} // namespace

mca::VolumeRule McaLaw::rule() const
{
	if (volumeRule == "affine") return mca::VolumeRule::affine;
	if (volumeRule == "inversePower") return mca::VolumeRule::inversePower;
	if (volumeRule == "meanDistance") return mca::VolumeRule::meanDistance;
	throw mca::Error("McaLaw: volumeRule = '" + volumeRule + "' is unknown; it must be 'affine', 'inversePower' or 'meanDistance'.");
}

void McaLaw::checkOptions(const Scene& scene) const
{
	rule();
	if (!(linkFactor >= 1.02 && linkFactor <= 1.5)) refuse("McaLaw: linkFactor = ", linkFactor, " must be from 1.02 to 1.5.");
	if (!(volumeFilter >= 0 && volumeFilter <= 1)) refuse("McaLaw: volumeFilter = ", volumeFilter, " must be from 0 (off) to 1.");
	if (scene.isPeriodic) refuse("McaLaw: O.periodic = True, but automata know no periodic cell; set O.periodic = False.");
	if (scene.subdomain > 0) refuse("McaLaw: this is subdomain ", scene.subdomain, " of a run of yade.mpy; automata run in one process only.");
}

void McaLaw::checkEngines(const Scene& scene)
{
	bool same = seen.size() == scene.engines.size();
	for (size_t i = 0; same && i < seen.size(); i++)
		same = seen[i].first == scene.engines[i].get() && seen[i].second == scene.engines[i]->dead;
	if (same) return;
	seen.clear(), newtons.clear();
	const char* order[] = { "McaLaw", "InteractionLoop", "McaForces", "NewtonIntegrator" };
	int         at[4] = { -1, -1, -1, -1 }, resetter = -1, place = 0;
	bool        collides = false;
	for (const auto& e : scene.engines) {
		place++;
		if (!e || e->dead) continue;
		const string name = dynamic_cast<const McaLaw*>(e.get()) ? "McaLaw" : e->getClassName(); // by whichever of its names
		if (name == "McaEngine") refuse("O.engines has McaEngine and McaLaw; an automaton can be moved by one of them only.");
		if (name == "ForceResetter") resetter = place;
		if (name == "NewtonIntegrator") newtons.push_back(e.get());
		collides = collides || Omega::instance().isInheritingFrom_recursive(name, "Collider");
		for (int k = 0; k < 4; k++) {
			if (name != order[k]) continue;
			if (k < 3 && at[k] > 0) refuse("McaLaw: O.engines has ", name, " twice; each automaton would be computed twice. Leave one.");
			at[k] = place;
		}
	}
	for (int k = 0; k < 4; k++)
		if (at[k] < 0 || (k > 0 && at[k] < at[k - 1]))
			refuse("McaLaw: O.engines must hold McaLaw, InteractionLoop, McaForces and NewtonIntegrator in this order, none of them dead; ",
			       order[k], " is missing or misplaced.");
	if (resetter < 0 || (resetter > at[2] && resetter < at[3]))
		refuse("McaLaw: O.engines needs ForceResetter, not dead, before McaForces (it stands first); without it forces add up from step to step.");
	if (!collides)
		refuse("McaLaw: O.engines needs a collider, not dead (InsertionSortCollider with Bo1_Sphere_Aabb(aabbEnlargeFactor=1.4)); without it automata "
		       "pass through each other.");
	for (const auto& e : scene.engines)
		seen.emplace_back(e.get(), e && e->dead);
}

/// In the dimension of the automata of the scene: that of those which the law has taken in, else what their masses say.
McaLawLoop& McaLaw::loopOf(const Scene& scene)
{
	int known = 0;
	for (const auto& b : scene.bodies->body) {
		const auto* s = isAutomaton(b) ? castTo<const McaState>(b->state.get()) : nullptr;
		if (s && s->law) known = s->law->dimension;
		if (known) break;
	}
	const int now = known ? known : dimensionByMass(scene);
	if (!loop || loop->dimension() != now) loop = now == 3 ? space::makeLoop(*this) : plane::makeLoop(*this);
	return *loop;
}

void McaLaw::step()
{
	if (PyGILState_Check()) refuseWhileRunning("__call__"); // a script's call beside the loop's thread
	worker = std::this_thread::get_id();
	McaPhys::takeError(); // of a step that another error has ended
	checkOptions(*scene);
	checkEngines(*scene);
	loopOf(*scene).step(scene);
	dimension = loop->dimension();
	if (scene->dt > 0 && scene->dt <= dtLimit && std::isfinite(scene->dt)) return;
	if (scene->dt > dtLimit && shortenStep(scene, dtLimit)) return;
	std::ostringstream o;
	if (scene->dt > dtLimit) o << "McaLaw: O.dt = " << scene->dt << " s is above the largest stable step " << dtLimit << " s of body " << stiffest;
	else o << "McaLaw: O.dt = " << scene->dt << " s must be finite and above zero; the largest stable step is " << dtLimit << " s";
	o << ". Set O.dt below it, or put McaTimeStepper first in O.engines.";
	throw mca::Error(o.str());
}

// For who asks before the step: automata that are not taken in yet at their state of rest, and all when this engine has computed none.
void McaLaw::prepare(Scene* scene)
{
	const bool never = !std::isfinite(dtLimit);
	bool       known = false;
	Real       limit = std::numeric_limits<Real>::infinity();
	int        who   = -1;
	const auto& own  = loopOf(*scene);
	for (const auto& b : scene->bodies->body) {
		if (!isAutomaton(b)) continue;
		const auto* s = castTo<const McaState>(b->state.get());
		const bool  done = s && s->law;
		known |= done;
		if (done && !never) continue;
		const auto m = static_cast<McaMat*>(b->material.get())->toMaterial();
		const Real J = done ? s->volumeRatio : 1., t = own.stepAtRest(m, 2. * static_cast<Sphere*>(b->shape.get())->radius, J);
		if (t < limit) limit = t, who = b->id;
	}
	if (!known) dtLimit = std::numeric_limits<Real>::infinity(); // of another scene
	if (limit < dtLimit) dtLimit = limit, stiffest = who;
}

void McaLaw::addForces(Scene* scene)
{
	if (doneAt != scene->iter || !loop)
		throw mca::Error("McaForces: McaLaw has not run in this step; it must come before InteractionLoop and run in every step.");
	if (const string error = McaPhys::takeError(); !error.empty()) throw mca::Error(error);
	loop->addForces(scene);
}

void McaForces::action()
{
	guarded([&] {
		for (const auto& e : scene->engines)
			if (auto* d = e && !e->dead ? dynamic_cast<McaLaw*>(e.get()) : nullptr) return d->addForces(scene);
		throw mca::Error("McaForces: there is no McaLaw in O.engines, or it is dead; it must come before InteractionLoop.");
	});
}

void McaLaw::refuseWhileRunning(const char* what) const
{
	if (Omega::instance().isRunning() && worker != std::this_thread::get_id())
		throw std::runtime_error(
			string("McaLaw.") + what
			+ "(): the simulation is running in the background and changes what is asked for; O.pause() and O.wait() first, or ask from a "
		          "PyRunner.");
}

py::dict McaLaw::energies()
{
	refuseWhileRunning("energies");
	Scene&                     scene = *Omega::instance().getScene();
	const McaLawLoop::Energies e     = loopOf(scene).energies(scene);
	py::dict                   d;
	d["kinetic"] = e.kinetic, d["volumetric"] = e.volumetric, d["deviatoric"] = e.deviatoric, d["plastic"] = plastic, d["viscous"] = viscous,
	d["friction"] = frictional, d["fracture"] = fracture;
	d["coupling"] = coupling, d["total"] = e.kinetic + e.centre + e.volumetric + e.deviatoric + plastic + viscous + frictional + fracture + coupling,
	d["joined"] = joined;
	return d;
}

py::dict McaLaw::counters() const
{
	py::dict d;
	d["steps"] = steps, d["brokenLinks"] = brokenLinks, d["clamped"] = clamped, d["deepest"] = deepest;
	return d;
}

long McaLaw::cut(py::object pairs)
{
	refuseWhileRunning("cut");
	const auto& now  = Omega::instance().getScene()->interactions;
	long        hold = 0;
	for (const auto& [a, b] : idPairs(pairs, "McaLaw.cut")) {
		const auto& I = now->find(a, b);
		const auto* p = I ? castTo<const McaPhys>(I->phys.get()) : nullptr;
		if (!p || !p->linked) continue;
		asked.push_back(a), asked.push_back(b);
		hold++;
	}
	return hold;
}

void McaLaw::setPair(py::object first, py::object second, Real strength, Real pairStrength, py::object frictionAngle, Real viscosity)
{
	auto materials = pairMaterials; // wrong arguments are told first
	auto numbers   = pairNumbers;
	addPairRule(materials, numbers, "McaLaw.setPair", first, second, strength, pairStrength, frictionAngle, viscosity);
	refuseWhileRunning("setPair");
	pairMaterials.swap(materials), pairNumbers.swap(numbers);
}

void McaLaw::postLoad(McaLaw&) { checkPairRules(pairMaterials, pairNumbers, "McaLaw"); }

py::list McaLaw::links() const
{
	refuseWhileRunning("links");
	py::list out;
	for (const auto& b : Omega::instance().getScene()->bodies->body)
		if (b)
			for (const auto& entry : b->intrs)
				if (const auto* p = castTo<const McaPhys>(entry.second->phys.get()); p && p->linked && b->id < entry.first)
					out.append(py::make_tuple(b->id, entry.first));
	return out;
}
} // namespace yade
