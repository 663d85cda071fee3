// SPDX-License-Identifier: GPL-2.0-or-later
// The order of a step of the law, checks of its results.
#include "McaLawRows.hpp"
#include <kernels/automaton/filter.hpp>
#include <kernels/automaton/limit.hpp>
#include <core/Scene.hpp>

namespace yade {
namespace MCA_SPACE {

Vec Loop::between(const Row& r, const Side& s) const { return vec(rows[size_t(s.other)].state->se3.position) - vec(r.state->se3.position); }
Real Loop::distance2(const Row& r, const Side& s) const
{
	const Vec x = between(r, s);
	Real      sum = 0; // every product rounded
	for (int c = 0; c < mca::dim; c++)
		sum += mca::sqr(x[c]);
	return sum;
}

void Loop::overlapError(const Row& r, const Side& s, Real ratio) const
{
	std::ostringstream o;
	const Row&         q = rows[size_t(s.other)];
	o << "automata " << r.id << " at " << vec(r.state->se3.position) << " m and " << q.id << " at " << vec(q.state->se3.position) << " m are " << ratio
	  << " rest distances apart in step " << law.steps << "; the least allowed is 0.5 (0.2 if linked). Remedy: a smaller time step, "
	     "a smaller impact speed, or no overlap in the packing.";
	throw mca::Error(o.str());
}

void Loop::checkResults()
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
			o << "automaton " << r.id << ": volume ratio " << r.m->volumeRatio << " in step " << law.steps
			  << " is not in (0, 1e6). Remedy: a smaller time step (the limit was " << law.dtLimit << " s, the step " << law.lastMove << " s).";
			throw mca::Error(o.str());
		}
		law.clamped += r.clampedNow;
		law.deepest = std::min(law.deepest, std::sqrt(std::min(r.nearestLink, r.nearestContact)));
		if (r.nearestContact < mca::deepestContact)
			for (int c = r.firstContact; c < r.lastContact; c++)
				if (mca::sqr(distance(r, contacts[size_t(c)]) / contacts[size_t(c)].p->rest[contacts[size_t(c)].side])
				    <= r.nearestContact * 1.0001)
					overlapError(r, contacts[size_t(c)], std::sqrt(r.nearestContact));
		if (r.nearestLink < mca::deepestLink)
			for (const Side& s : r.link)
				if (s.p && mca::sqr(distance(r, s) / s.p->d) <= r.nearestLink * 1.0001) overlapError(r, s, std::sqrt(r.nearestLink));
		if (r.limit < limit) limit = r.limit, law.stiffest = r.id;
		dMin = std::min(dMin, r.d);
		for (int c = r.firstContact; c < r.lastContact; c++)
			speed2 = std::max(speed2, (rows[size_t(contacts[size_t(c)].other)].state->vel - r.state->vel).squaredNorm());
	}
	if (speed2 > 0) limit = std::min(limit, mca::stepLimitOfContacts(dMin, speed2));
	law.dtLimit = limit;
}

void Loop::step(Scene* scene)
{
	gather(scene);
	unsettled.clear();
	findLinks(scene);
	if (law.doneAt == scene->iter && law.pushedAt == scene->iter && hasMoved())
		law.doneAt = law.pushedAt = -1; // stopped behind NewtonIntegrator: the next step, though O.iter is the same
	keepVolumes(scene);
	for (Row& r : rows)
		lastMotion(r);
	if (law.doneAt != scene->iter) {
		if (!law.asked.empty() || law.steps % mca::breakPeriod == 0) breakLinks();
		findContacts(scene);
		settleVolumes(scene->trackEnergy);
		law.filterTime += law.lastMove;
		if (law.volumeFilter > 0 && rule() == mca::VolumeRule::affine && law.steps % mca::filterPeriod == 0) filterVolumes(scene->trackEnergy);
		const long n = long(rows.size());
#pragma omp parallel for schedule(static)
		for (long i = 0; i < n; i++)
			contactVolume(rows[size_t(i)]);
#pragma omp parallel for schedule(static)
		for (long i = 0; i < n; i++)
			volume(rows[size_t(i)], rows[size_t(i)].lastContact > rows[size_t(i)].firstContact);
		checkResults();
		law.doneAt = scene->iter;
#pragma omp parallel for schedule(static)
		for (long i = 0; i < n; i++) law.lastMove > 0 ? stress(rows[size_t(i)]) : finishPressure(rows[size_t(i)]);
		pullTogether(scene->trackEnergy);
		for (const Row& r : rows)
			r.l->results = Vector3r(r.m->pressure, r.m->volumeRatio, r.m->stressZZ);
		if (scene->trackEnergy)
			for (const Row& r : rows)
				law.plastic += r.plastic, law.coupling += r.coupling, law.frictional += r.friction, law.heated += r.heated;
	}
}

Real Loop::stepAtRest(const mca::Material& m, Real diameter, Real J) const { return mca::stepLimitAtRest(m, diameter, J); }

shared_ptr<McaLawLoop> makeLoop(McaLaw& law) { return shared_ptr<McaLawLoop>(new Loop(law)); }
} // namespace MCA_SPACE
} // namespace yade
