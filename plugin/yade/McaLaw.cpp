// SPDX-License-Identifier: GPL-2.0-or-later
// McaLaw: the order of a step, checks of its results.
#include "McaLaw.hpp"
#include "McaBodies.hpp"
#include "McaCast.hpp"
#include "McaGuarded.hpp"
#include <kernels/automaton/filter.hpp>
#include <kernels/automaton/limit.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>

namespace yade {
YADE_PLUGIN((McaLaw)(McaDensity));

namespace automata = mca::automata;
Real McaLaw::distance2(const Row& r, const Side& s) const
{
	const auto &a = r.state->se3.position, &b = rows[size_t(s.other)].state->se3.position;
	return mca::sqr(b[0] - a[0]) + mca::sqr(b[1] - a[1]);
}

void McaLaw::overlapError(const Row& r, const Side& s, Real ratio) const
{
	std::ostringstream o;
	const Row&         q = rows[size_t(s.other)];
	o << "automata " << r.id << " at (" << r.state->se3.position[0] << ", " << r.state->se3.position[1] << ") m and " << q.id << " at ("
	  << q.state->se3.position[0] << ", " << q.state->se3.position[1] << ") m are " << ratio << " rest distances apart in step " << steps
	  << "; the least allowed is 0.5 (0.2 if linked). Remedy: a smaller time step, a smaller impact speed, or no overlap in the packing.";
	throw mca::Error(o.str());
}

void McaLaw::checkResults()
{
	Real limit = std::numeric_limits<Real>::infinity(), speed2 = 0, dMin = limit, pressed = 0;
	// as in Solver::computeForces: the pressure of what meets something else moves lighter neighbours, too
	const auto meets = [&](const Row& r) {
		bool other = r.firstContact < r.lastContact;
		for (const Side& s : r.link)
			other |= s.p && rows[size_t(s.other)].material != r.material;
		return other;
	};
	for (auto& r : rows)
		if (meets(r)) pressed = std::max(pressed, r.stiff * r.material->eos.rho0);
	for (auto& r : rows)
		r.limit = mca::stepLimit(*r.material, mca::VolumeRule(r.l->rule), r.d, r.stiff, meets(r) ? pressed : 0., r.closing, r.turning);
	for (auto& r : rows) {
		if (r.bad) {
			std::ostringstream o;
			o << "automaton " << r.id << ": volume ratio " << r.m->volumeRatio << " in step " << steps
			  << " is not in (0, 1e6). Remedy: a smaller time step (the limit was " << dtLimit << " s, the step " << lastMove << " s).";
			throw mca::Error(o.str());
		}
		clamped += r.clampedNow;
		deepest = std::min(deepest, std::sqrt(std::min(r.nearestLink, r.nearestContact)));
		if (r.nearestContact < mca::deepestContact)
			for (int c = r.firstContact; c < r.lastContact; c++)
				if (mca::sqr(distance(r, contacts[size_t(c)]) / contacts[size_t(c)].p->rest[contacts[size_t(c)].side])
				    <= r.nearestContact * 1.0001)
					overlapError(r, contacts[size_t(c)], std::sqrt(r.nearestContact));
		if (r.nearestLink < mca::deepestLink)
			for (const Side& s : r.link)
				if (s.p && mca::sqr(distance(r, s) / s.p->d) <= r.nearestLink * 1.0001) overlapError(r, s, std::sqrt(r.nearestLink));
		if (r.limit < limit) limit = r.limit, stiffest = r.id;
		dMin = std::min(dMin, r.d);
		for (int c = r.firstContact; c < r.lastContact; c++)
			speed2 = std::max(speed2, (rows[size_t(contacts[size_t(c)].other)].state->vel - r.state->vel).squaredNorm());
	}
	if (speed2 > 0) limit = std::min(limit, mca::stepLimitOfContacts(dMin, speed2));
	dtLimit = limit;
}

void McaLaw::step()
{
	worker = std::this_thread::get_id();
	McaPhys::takeError(); // of a step that another error has ended
	checkOptions(*scene);
	checkEngines(*scene);
	gather(scene);
	unsettled.clear();
	findLinks(scene);
	if (doneAt == scene->iter && pushedAt == scene->iter && hasMoved())
		doneAt = pushedAt = -1; // stopped behind NewtonIntegrator: the next step, though O.iter is the same
	keepVolumes(scene);
	for (Row& r : rows)
		lastMotion(r);
	if (doneAt != scene->iter) {
		if (steps % mca::breakPeriod == 0) breakLinks();
		findContacts(scene);
		settleVolumes(scene->trackEnergy);
		filterTime += lastMove;
		if (volumeFilter > 0 && rule() == mca::VolumeRule::affine && steps % mca::filterPeriod == 0) filterVolumes(scene->trackEnergy);
		const long n = long(rows.size());
#pragma omp parallel for schedule(static)
		for (long i = 0; i < n; i++)
			contactVolume(rows[size_t(i)]);
#pragma omp parallel for schedule(static)
		for (long i = 0; i < n; i++)
			volume(rows[size_t(i)], rows[size_t(i)].lastContact > rows[size_t(i)].firstContact);
		checkResults();
		doneAt = scene->iter;
#pragma omp parallel for schedule(static)
		for (long i = 0; i < n; i++) lastMove > 0 ? stress(rows[size_t(i)]) : finishPressure(rows[size_t(i)]);
		for (const Row& r : rows)
			r.l->results = Vector3r(r.m->pressure, r.m->volumeRatio, r.m->stressZZ);
		if (scene->trackEnergy)
			for (const Row& r : rows)
				plastic += r.plastic, coupling += r.coupling, frictional += r.friction, heated += r.heated;
	}
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
	for (const auto& b : scene->bodies->body) {
		if (!isAutomaton(b)) continue;
		const auto* s = castTo<const McaState>(b->state.get());
		const bool  done = s && s->law;
		known |= done;
		if (done && !never) continue;
		const auto m = static_cast<McaMat*>(b->material.get())->toMaterial();
		const Real J = done ? s->volumeRatio : 1., t = mca::stepLimitAtRest(m, 2. * static_cast<Sphere*>(b->shape.get())->radius, J);
		if (t < limit) limit = t, who = b->id;
	}
	if (!known) dtLimit = std::numeric_limits<Real>::infinity(); // of another scene
	if (limit < dtLimit) dtLimit = limit, stiffest = who;
}
} // namespace yade
