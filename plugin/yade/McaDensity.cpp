// SPDX-License-Identifier: GPL-2.0-or-later
// McaDensity: set-up, the order of a step, checks.
#include "McaDensity.hpp"
#include <automata/volume_filter.hpp>
#include "McaBodies.hpp"
#include "McaCast.hpp"
#include <core/InteractionLoop.hpp>
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>

namespace yade {
YADE_PLUGIN((McaDensity));

namespace automata = mca::automata;
using automata::nLinks;

mca::VolumeRule McaDensity::rule() const
{
	if (volumeRule == "affine") return mca::VolumeRule::affine;
	if (volumeRule == "inversePower") return mca::VolumeRule::inversePower;
	if (volumeRule == "meanDistance") return mca::VolumeRule::meanDistance;
	throw mca::Error("McaDensity: volumeRule = '" + volumeRule + "' is unknown; it must be 'affine', 'inversePower' or 'meanDistance'.");
}

void McaDensity::checkEngines(Scene* scene) const
{
	const char* order[]  = { "McaDensity", "InteractionLoop", "McaForces", "NewtonIntegrator" };
	size_t      expected = 0;
	for (const auto& e : scene->engines)
		if (e->getClassName() == "McaEngine" && !e->dead) throw mca::Error("O.engines has McaEngine and McaDensity; an automaton can be moved by one of them only.");
		else if (expected < 4 && e->getClassName() == order[expected]) expected++;
	if (expected < 4)
		throw mca::Error(string("McaDensity: O.engines must hold McaDensity, InteractionLoop, McaForces and NewtonIntegrator in this order; ") + order[expected] + " is missing or misplaced.");
}

// Links, slots, weights and the state of rest are those of the fast solver; its checks of the input are made here too.
void McaDensity::build(Scene* scene)
{
	const McaBodies bodies(*scene, seed);
	automata::Options o;
	o.volumeRule = rule(), o.contacts = false;
	if (!(linkFactor >= 1.02 && linkFactor <= 1.5)) throw mca::Error("McaDensity: linkFactor = " + std::to_string(linkFactor) + " must be from 1.02 to 1.5.");
	o.linkFactor = linkFactor;
	automata::Solver solver;
	solver.build(bodies.automata, bodies.materials, o);
	const automata::Store& S    = solver.store;
	const auto             body = [&](int id) -> Body& { return *scene->bodies->body[size_t(id)]; };
	for (int id : bodies.ids) {
		const size_t i = size_t(solver.indexOf(id));
		auto&        m = static_cast<McaState&>(*body(id).state);
		m.law          = shared_ptr<McaLawState>(new McaLawState);
		auto& l        = *m.law;
		l.flags = S.flags[i], l.cell = S.cell[i], l.invN = S.invN[i], l.rest = S.rest[i], l.offset = S.jOff[i], l.rule = int(o.volumeRule);
		m.volumeRatio = S.J[i], m.pressure = S.P[i], m.temperature = S.temperature[i];
		l.partner.assign(nLinks, -1);
		for (int k = 0; k < nLinks; k++)
			if ((l.flags >> k) & 1) l.partner[size_t(k)] = S.id[S.neighbour[automata::linkSlot(i, k)]];
	}
	for (int id : bodies.ids) {
		const auto& l = *static_cast<McaState&>(*body(id).state).law;
		for (int k = 0; k < nLinks; k++) {
			const int other = ((l.flags >> k) & 1) ? l.partner[size_t(k)] : -1;
			if (other < id) continue;
			const auto old = scene->interactions->find(id, other);
			if (old && !old->isReal()) scene->interactions->erase(id, other, old->linIx); // the collider has seen it coming
			const auto I = old && old->isReal() ? old : InteractionLoop::createExplicitInteraction(id, other, true, false);
			auto*      p = castTo<McaPhys>(I->phys.get());
			if (!p) throw mca::Error("bodies " + std::to_string(id) + " and " + std::to_string(other) + ": their interaction has no McaPhys; InteractionLoop needs Ip2_McaMat_McaMat_McaPhys, and no other for McaMat.");
			p->linked = true, p->active = false;
			p->slot = I->getId1() == id ? k : (k + 3) % nLinks;
			p->half = (l.flags >> (automata::halfShift + k)) & 1;
		}
	}
}

void McaDensity::gather(Scene* scene)
{
	const auto& bodies = scene->bodies->body;
	rows.clear(), known.clear(), materials.clear();
	place.assign(bodies.size(), -1);
	bool fresh = false, old = false;
	for (const auto& b : bodies) {
		if (!isAutomaton(b)) continue;
		auto* m = castTo<McaState>(b->state.get());
		(m && m->law ? old : fresh) = true;
		Row r;
		r.id = b->id, r.state = b->state.get(), r.m = m, r.l = m ? m->law.get() : nullptr, r.d = 2. * static_cast<Sphere*>(b->shape.get())->radius;
		place[size_t(b->id)] = int(rows.size());
		rows.push_back(r);
	}
	if (fresh && !old) {
		build(scene);
		return gather(scene);
	}
	if (fresh) { // added to a running simulation: checked as all, but linked to nothing
		const McaBodies checked(*scene, seed);
		for (auto& r : rows) {
			if (r.l) continue;
			r.m->law  = shared_ptr<McaLawState>(new McaLawState);
			r.l       = r.m->law.get();
			auto& l   = *r.l;
			l.flags   = automata::exposedBit, l.invN = 1. / nLinks, l.rule = int(rule());
			l.cell    = r.state->mass / static_cast<McaMat*>(bodies[size_t(r.id)]->material.get())->density;
			l.partner.assign(nLinks, -1);
			r.m->volumeRatio = 1., r.m->pressure = 0.;
		}
	}
	vector<size_t> which;
	for (auto& r : rows)
		which.push_back(materialIndex(static_cast<McaMat*>(bodies[size_t(r.id)]->material.get()), known, materials));
	for (size_t i = 0; i < rows.size(); i++)
		rows[i].material = &materials[which[i]];
}

void McaDensity::findLinks(Scene* scene)
{
	for (auto& r : rows) {
		int found = 0;
		for (const auto& [id, I] : scene->bodies->body[size_t(r.id)]->intrs) {
			auto* p = castTo<McaPhys>(I->phys.get());
			if (!p || !p->linked || place[size_t(id)] < 0) continue;
			const int side = I->getId1() == r.id ? 0 : 1, k = side ? (p->slot + 3) % nLinks : p->slot;
			r.link[k]      = { p, side, place[size_t(id)] };
			found |= 1 << k;
		}
		const int missing = (r.l->flags & automata::linkBits) & ~found;
		if (!missing) continue;
		for (int k = 0; k < nLinks; k++) {
			const int other = r.l->partner[size_t(k)];
			if (!((missing >> k) & 1)) continue;
			if (other >= 0 && size_t(other) < place.size() && place[size_t(other)] >= 0)
				throw mca::Error("automata " + std::to_string(r.id) + " and " + std::to_string(other) + " are linked, but their interaction is gone in step " + std::to_string(steps)
				                 + ". Something has erased it (O.interactions.clear?); load the last saved state.");
			r.l->flags = (r.l->flags & ~(1 << k)) | automata::exposedBit; // its partner was erased
		}
	}
}

void McaDensity::findContacts(Scene* scene)
{
	contacts.clear();
	for (auto& r : rows) {
		r.firstContact = int(contacts.size());
		for (const auto& [id, I] : scene->bodies->body[size_t(r.id)]->intrs) { // ascending ids
			auto* p = castTo<McaPhys>(I->phys.get());
			if (!p || p->linked || p->wall || place[size_t(id)] < 0) continue;
			const Side s { p, I->getId1() == r.id ? 0 : 1, place[size_t(id)] };
			if (!p->active) { // a link that broke has given one of them a free side
				if (!McaPhys::mayTouch(*scene->bodies->body[size_t(r.id)], *r.l, *scene->bodies->body[size_t(id)], *rows[size_t(s.other)].l)) continue;
				p->startContact(distance(r, s));
			}
			contacts.push_back(s);
		}
		r.lastContact = int(contacts.size());
	}
}

Real McaDensity::distance(const Row& r, const Side& s) const
{
	const auto &a = r.state->se3.position, &b = rows[size_t(s.other)].state->se3.position;
	return std::sqrt(mca::sqr(b[0] - a[0]) + mca::sqr(b[1] - a[1]));
}

void McaDensity::overlapError(const Row& r, const Side& s, Real ratio) const
{
	std::ostringstream o;
	const Row&         q = rows[size_t(s.other)];
	o << "automata " << r.id << " at (" << r.state->se3.position[0] << ", " << r.state->se3.position[1] << ") m and " << q.id << " at (" << q.state->se3.position[0] << ", "
	  << q.state->se3.position[1] << ") m are " << ratio << " rest distances apart in step " << steps
	  << "; the least allowed is 0.5 (0.2 if linked). Remedy: a smaller time step, a smaller impact speed, or no overlap in the packing.";
	throw mca::Error(o.str());
}

void McaDensity::checkResults()
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
	for (auto& r : rows) {
		const Real  cP = std::sqrt(meets(r) ? 0.5 * (r.stiff + std::max(r.stiff, pressed / r.material->eos.rho0)) : r.stiff);
		const auto& q  = r.material->viscosity;
		r.limit        = mca::stableStep(r.d, cP, r.material->cS() * std::sqrt(std::max(r.m->volumeRatio, Real(1))), q.active() ? q.linear + q.quadratic * r.closing / cP : 0.);
	}
	for (auto& r : rows) {
		if (r.bad) {
			std::ostringstream o;
			o << "automaton " << r.id << ": volume ratio " << r.m->volumeRatio << " in step " << steps << " is not in (0, 1e6). Remedy: a smaller time step (the limit was " << dtLimit << " s, the step " << lastMove << " s).";
			throw mca::Error(o.str());
		}
		clamped += r.clampedNow;
		deepest = std::min(deepest, std::sqrt(std::min(r.nearestLink, r.nearestContact)));
		if (r.nearestContact < 0.25)
			for (int c = r.firstContact; c < r.lastContact; c++)
				if (mca::sqr(distance(r, contacts[size_t(c)]) / contacts[size_t(c)].p->rest[contacts[size_t(c)].side]) <= r.nearestContact * 1.0001) overlapError(r, contacts[size_t(c)], std::sqrt(r.nearestContact));
		if (r.nearestLink < 0.04)
			for (const Side& s : r.link)
				if (s.p && mca::sqr(distance(r, s) / s.p->d) <= r.nearestLink * 1.0001) overlapError(r, s, std::sqrt(r.nearestLink));
		if (r.limit < limit) limit = r.limit, stiffest = r.id;
		dMin = std::min(dMin, r.d);
		for (int c = r.firstContact; c < r.lastContact; c++)
			speed2 = std::max(speed2, (rows[size_t(contacts[size_t(c)].other)].state->vel - r.state->vel).squaredNorm());
	}
	if (speed2 > 0) limit = std::min(limit, 0.125 * dMin / std::sqrt(speed2)); // pairs that meet: no more than an eighth of their distance in a step
	dtLimit = limit;
}

void McaDensity::step()
{
	if (!ready) checkEngines(scene);
	ready = true;
	gather(scene);
	findLinks(scene);
	if (doneAt != scene->iter) {
		unsettled.clear();
		if (steps % automata::breakPeriod == 0) breakLinks();
		findContacts(scene);
		settleVolumes(scene->trackEnergy);
		filterTime += lastMove;
		if (volumeFilter > 0 && rule() == mca::VolumeRule::affine && steps % automata::filterPeriod == 0) filterVolumes(scene->trackEnergy);
		const long n = long(rows.size());
#pragma omp parallel for schedule(static)
		for (long i = 0; i < n; i++)
			contactVolume(rows[size_t(i)]);
#pragma omp parallel for schedule(static)
		for (long i = 0; i < n; i++)
			volume(rows[size_t(i)], rows[size_t(i)].lastContact > rows[size_t(i)].firstContact);
		checkResults();
		doneAt = scene->iter;
		if (lastMove > 0) {
#pragma omp parallel for schedule(static)
			for (long i = 0; i < n; i++)
				stress(rows[size_t(i)]);
		}
		if (scene->trackEnergy)
			for (const Row& r : rows)
				plastic += r.plastic, coupling += r.coupling, frictional += r.friction, heated += r.heated;
	}
	if (scene->dt > dtLimit) {
		std::ostringstream o;
		o << "McaDensity: O.dt = " << scene->dt << " s is above the largest stable step " << dtLimit << " s of body " << stiffest << ". Set O.dt below it, or put McaTimeStepper first in O.engines.";
		throw mca::Error(o.str());
	}
}

void McaDensity::prepare(Scene* scene)
{
	if (std::isfinite(dtLimit)) return;
	// before the first step: the state of rest
	for (const auto& b : scene->bodies->body) {
		if (!isAutomaton(b)) continue;
		const auto m = static_cast<McaMat*>(b->material.get())->toMaterial();
		const Real t = mca::stableStep(2. * static_cast<Sphere*>(b->shape.get())->radius, m.cP(), m.cS(), m.viscosity.linear);
		if (t < dtLimit) dtLimit = t, stiffest = b->id;
	}
}
} // namespace yade
