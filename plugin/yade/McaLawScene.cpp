// SPDX-License-Identifier: GPL-2.0-or-later
// McaLaw: which bodies and pairs there are in this step. Links are made when an automaton is first seen, and follow bodies that are added and erased.
#include "McaBodies.hpp"
#include "McaCast.hpp"
#include "McaLaw.hpp"
#include "automata/start.hpp"
#include <atomic>
#include <core/InteractionLoop.hpp>
#include <kernels/automaton/outline.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>

namespace yade {
namespace automata = mca::automata;
using mca::nLinks;

namespace {
	std::atomic<long> revisions { 0 }; // of the materials, one count for all engines: pairs outlive them
	void makeLink(Scene& scene, int id, int other, int k, bool half)
	{
		const auto old = scene.interactions->find(id, other);
		const auto real = old && old->isReal();
		if (const auto* p = real ? castTo<McaPhys>(old->phys.get()) : nullptr; p && p->linked) return;
		if (old && !real) scene.interactions->erase(id, other, old->linIx); // the collider has seen it coming
		const auto I = real ? old : InteractionLoop::createExplicitInteraction(id, other, true, false);
		auto*      p = castTo<McaPhys>(I->phys.get());
		if (p) {
			p->linked = true, p->active = false;
			p->slot = I->getId1() == id ? k : mca::Lattice::opposite(k);
			p->half = half;
			return;
		}
		scene.interactions->erase(id, other, I->linIx);
		throw mca::Error(
			"bodies " + std::to_string(id) + " and " + std::to_string(other)
			+ ": their interaction has no McaPhys; InteractionLoop needs Ip2_McaMat_McaMat_McaPhys, and no other for McaMat.");
	}
	/// O.bodies.clear() leaves the interactions of the old bodies, which YADE would go on with under the numbers of new ones, and the collider's order.
	void clearStale(Scene& scene)
	{
		const auto& bodies = scene.bodies->body;
		const auto  holds  = [&](int id, int other, const shared_ptr<Interaction>& I) {
                        if (id < 0 || size_t(id) >= bodies.size() || !bodies[size_t(id)]) return false;
                        const auto& own = bodies[size_t(id)]->intrs;
                        const auto  it  = own.find(other);
                        return it != own.end() && it->second == I;
		};
		for (const auto& I : *scene.interactions)
			if (!holds(I->getId1(), I->getId2(), I) && !holds(I->getId2(), I->getId1(), I)) {
				scene.interactions->clear();
				scene.interactions->dirty = true; // the collider sorts anew
				return;
			}
	}
	bool sameLinks(const McaLawState& l, int32_t flags, const vector<int>& partner)
	{
		if (mca::trianglesIn(l.flags) != mca::trianglesIn(flags)) return false;
		for (int k = 0; k < nLinks; k++)
			if (((l.flags ^ flags) >> k) & 1 || (((flags >> k) & 1) && l.partner[size_t(k)] != partner[size_t(k)])) return false;
		return true;
	}
} // namespace

// A scene of its own: nothing goes on from what this engine did before.
void McaLaw::forget()
{
	filterTime = lastMove = 0, steps = brokenLinks = clamped = 0, doneAt = bookedAt = pushedAt = -1, deepest = 1;
	plastic = viscous = lastViscous = frictional = fracture = coupling = heated = joined = 0;
	members.clear();
}

// Links, slots, weights and the state of rest are those of the fast solver, when automata are added as well: new links form with those that are new only.
void McaLaw::takeIn(Scene* scene)
{
	for (const Row& r : rows)
		if (!r.l) checkUntouched(r);
	const McaBodies   bodies(*scene, seed, 2);
	vector<automata::Automaton> all;
	for (const auto& a : bodies.automata) all.push_back(automata::startOf(a));
	automata::Options o;
	o.volumeRule = rule(), o.contacts = false, o.linkFactor = linkFactor;
	vector<automata::Automaton>  known;
	vector<automata::LinkRecord> records;
	for (const auto& a : all) {
		const auto* l = rows[size_t(place[size_t(a.id)])].l;
		if (!l) continue;
		known.push_back(a);
		automata::LinkRecord record;
		record.id = a.id, record.flags = l->flags, record.invN = l->invN;
		std::copy(l->partner.begin(), l->partner.end(), record.partner);
		records.push_back(record);
	}
	automata::Solver solver;
	if (known.empty()) {
		solver.build(all, bodies.materials, o);
		forget();
		clearStale(*scene);
	} else {
		const auto old = automata::Solver::knowing(known, bodies.materials, records);
		solver.build(all, bodies.materials, o, &old);
	}
	linkFactorUsed           = linkFactor;
	vector<int>            newcomers;
	const automata::Store& S = solver.store;
	for (int id : bodies.ids) {
		const size_t i = size_t(solver.indexOf(id));
		Row&         r = rows[size_t(place[size_t(id)])];
		const bool   fresh = !r.l;
		if (fresh) newcomers.push_back(id), r.m->law = shared_ptr<McaLawState>(new McaLawState), r.l = r.m->law.get();
		auto&       l = *r.l;
		vector<int> partner(nLinks, -1);
		for (int k = 0; k < nLinks; k++)
			if (mca::hasHeld(S.flags[i], k)) partner[size_t(k)] = S.id[S.neighbour[automata::linkSlot(i, k)]];
		if (!fresh && !sameLinks(l, S.flags[i], partner)) relinked.push_back(id);
		l.flags = S.flags[i], l.partner = partner, l.invN = S.invN[i];
		if (!fresh) continue;
		l.triangles = r.m->triangles;
		l.cell = S.cell[i], l.rest = S.rest[i], l.factor = S.factor[i], l.rule = int(o.volumeRule), l.diameter = r.d;
		r.m->volumeRatio = S.J[i], l.P = S.P[i], r.m->pressure = S.mean[i];
	}
	McaPhys::linking = true;
	try {
		for (const Row& r : rows)
			for (int k = 0; k < nLinks; k++)
				if (mca::holds(r.l->flags, k) && r.l->partner[size_t(k)] > r.id)
					makeLink(*scene, r.id, r.l->partner[size_t(k)], k, mca::linkWeight(r.l->flags, k) < 1.);
	} catch (...) { // they stay new
		McaPhys::linking = false;
		for (int id : newcomers)
			rows[size_t(place[size_t(id)])].m->law.reset();
		throw;
	}
	McaPhys::linking = false;
}

void McaLaw::gather(Scene* scene)
{
	const auto& bodies = scene->bodies->body;
	checkNumbers(*scene);
	rows.clear();
	place.assign(bodies.size(), -1);
	bool      fresh = false, old = false;
	MaskTable masks, otherMasks;
	const auto note = [](MaskTable& table, const Body& b, int& last) {
		if (b.groupMask != last || table.empty()) table.emplace(last = b.groupMask, b.id);
	};
	int last = 0, lastOther = 0, wall = -1, grain = -1; // of McaMat, of another material
	for (const auto& b : bodies) {
		if (!b) continue;
		if (!isAutomaton(b)) {
			checkOther(*b);
			if (b->material && castTo<const McaMat>(b->material.get())) wall = b->id;
			else if (b->shape && castTo<Sphere>(b->shape.get())) grain = b->id;
			if (b->shape) note(otherMasks, *b, lastOther);
			continue;
		}
		Row r;
		r.m = &checkBody(*scene, *b);
		r.id = b->id, r.mask = b->groupMask, r.state = r.m, r.l = r.m->law.get(), r.d = 2. * static_cast<Sphere*>(b->shape.get())->radius;
		(r.l ? old : fresh) = true;
		note(masks, *b, last);
		place[size_t(b->id)] = int(rows.size());
		rows.push_back(r);
	}
	if (wall >= 0 && grain >= 0) // their functor would have the materials the other way round, where InteractionLoop aborts
		throw mca::Error(
			"body " + std::to_string(wall) + " is a wall of McaMat and body " + std::to_string(grain)
			+ " a sphere of another material; there is no law for the two. Give the wall a FrictMat.");
	checkMasks(masks, otherMasks);
	if (old && linkFactorUsed > 0 && linkFactor != linkFactorUsed)
		throw mca::Error(
			"McaLaw: linkFactor = " + std::to_string(linkFactor) + ", but links were made with " + std::to_string(linkFactorUsed)
			+ "; it can be chosen before the first step only. Set it back.");
	if (fresh) takeIn(scene);
	readMaterials(scene);
	for (const Row& r : rows)
		checkState(r);
	if (steps == 0 && lastMove == 0) // an engine that goes on with what another McaLaw has moved
		for (const Row& r : rows)
			lastMove = std::max(lastMove, r.l->moved);
}

void McaLaw::readMaterials(Scene* scene)
{
	vector<const McaMat*> all;
	vector<mca::Material> constants;
	vector<size_t>        which;
	for (auto& r : rows) {
		r.mat = static_cast<const McaMat*>(scene->bodies->body[size_t(r.id)]->material.get());
		which.push_back(materialIndex(r.mat, all, constants));
	}
	bool same = all == known;
	for (size_t i = 0; same && i < all.size(); i++)
		same = mca::samePairs(constants[i], materials[i]);
	if (!same) revision = ++revisions;
	known = all, materials = constants;
	for (size_t i = 0; i < rows.size(); i++)
		rows[i].material = &materials[which[i]];
}

// Constants of a pair from its materials: when it is new, when it was loaded, and when a script has changed a material or given a body another one.
void McaLaw::pairConstants(const Row& r, const Side& s) const
{
	McaPhys&   p = *s.p;
	const Row &a = s.side ? rows[size_t(s.other)] : r, &b = s.side ? r : rows[size_t(s.other)];
	if (p.revision == revision && p.madeOf[0] == a.mat && p.madeOf[1] == b.mat) return;
	p.revision = revision, p.madeOf[0] = a.mat, p.madeOf[1] = b.mat;
	p.twoG       = mca::seriesTwoG(a.material->G, b.material->G, p.arm);
	p.friction   = std::min(a.material->friction, b.material->friction);
	const auto v = mca::viscosityOf(*a.material, *b.material);
	p.viscLinear = v.linear, p.viscQuadratic = v.quadratic;
}

void McaLaw::findLinks(Scene* scene)
{
	for (auto& r : rows) {
		int found = 0;
		for (const auto& [id, I] : scene->bodies->body[size_t(r.id)]->intrs) {
			auto* p = castTo<McaPhys>(I->phys.get());
			// InteractionLoop aborts where a functor has its materials the other way round: Ip2_FrictMat_McaMat_McaPhys wants the automaton second
			if (!I->phys && !I->geom && place[size_t(id)] < 0 && I->getId1() == r.id) I->swapOrder();
			if (!p || !p->linked || place[size_t(id)] < 0) continue;
			const int side = I->getId1() == r.id ? 0 : 1, k = side ? mca::Lattice::opposite(p->slot) : p->slot;
			r.link[k]      = { p, side, place[size_t(id)] };
			pairConstants(r, r.link[k]);
			found |= 1 << k;
		}
		const int missing = (r.l->flags & mca::linkBits) & ~found;
		if (!missing) continue;
		for (int k = 0; k < nLinks; k++) {
			const int other = r.l->partner[size_t(k)];
			if (!((missing >> k) & 1)) continue;
			if (other >= 0 && size_t(other) < place.size() && place[size_t(other)] >= 0)
				throw mca::Error(
					"automata " + std::to_string(r.id) + " and " + std::to_string(other)
					+ " are linked, but their interaction is gone in step " + std::to_string(steps)
					+ ". Something has erased it (O.interactions.clear?); load the last saved state.");
			if (other >= 0 && size_t(other) < place.size() && scene->bodies->body[size_t(other)])
				throw mca::Error(
					"body " + std::to_string(other) + " is linked to automaton " + std::to_string(r.id)
					+ " but is no automaton any more; give it back its McaMat, Sphere and state, or erase it.");
			r.l->flags = mca::withoutTriangles(r.l->flags & ~mca::slotBits(k)) | mca::exposedBit; // its partner was erased
			r.l->partner[size_t(k)] = -1;
			relinked.push_back(r.id);
		}
	}
}

// Who has lost or got links because bodies were erased or added keeps the volume that it had, measured by the links that it has now.
void McaLaw::keepVolumes(Scene* scene)
{
	if (relinked.empty()) return;
	std::sort(relinked.begin(), relinked.end());
	relinked.erase(std::unique(relinked.begin(), relinked.end()), relinked.end());
	for (int id : relinked) {
		const int i = size_t(id) < place.size() ? place[size_t(id)] : -1;
		if (i < 0) continue;
		auto&     l = *rows[size_t(i)].l;
		if (l.rule == int(mca::VolumeRule::affine) && l.factor == 0) l.factor = 1;
		keepVolume(i, rows[size_t(i)].m->volumeRatio);
	}
	relinked.clear();
	if (doneAt == scene->iter)
		doneAt = -1, lastMove = 0; // a step that was stopped half-way: its strain is in the stresses, pressures are not those of the links now
}

namespace {
	Vector3r placeOf(const State& s)
	{
		return Vector3r(s.se3.position[0], s.se3.position[1], 2. * std::atan2(s.se3.orientation.z(), s.se3.orientation.w()));
	}
	/// From one place to another, the shorter way round.
	Vector3r way(const Vector3r& from, const Vector3r& to)
	{
		return Vector3r(to[0] - from[0], to[1] - from[1], std::remainder(to[2] - from[2], 2. * M_PI));
	}
}

/// NewtonIntegrator has moved the bodies since they got the forces of this step.
bool McaLaw::hasMoved() const
{
	return std::any_of(rows.begin(), rows.end(), [&](const Row& r) { // not a script
		const Vector3r meant = r.l->expected * lastMove;
		return meant != Vector3r::Zero() && (way(r.l->from, placeOf(*r.state)) - meant).norm() <= 1e-6 * meant.norm();
	});
}

/// The velocity with which the last move was made. It is that of the state unless a script has set another one since, or another place.
void McaLaw::lastMotion(Row& r) const
{
	const State&       s = *r.state;
	const McaLawState& l = *r.l;
	r.motion = Vector3r(s.vel[0], s.vel[1], s.angVel[2]);
	r.fresh  = !(l.moved > 0);
	if (r.fresh || !(lastMove > 0)) return;
	const Vector3r at = placeOf(s), made = way(l.from, at) / lastMove;
	const auto     part = [&](int first, int n) { // both components of the velocity, or the spin
		const auto norm  = [&](const Vector3r& a) { return a.segment(first, n).norm(); };
		const Real round = 1e-15 * (norm(at) + 1e-3 * r.d) / lastMove;
		const auto same  = [&](const Vector3r& a, const Vector3r& b, Real share) { return norm(a - b) <= share * (norm(a) + norm(b)) + round; };
		if (same(made, r.motion, 1e-9) || same(r.motion, l.expected, 1e-6)) return; // as always, or put elsewhere with the velocity it had
		const Vector3r& other = same(made, l.expected, 1e-6) ? made : l.expected; // the place was set as well
		r.motion.segment(first, n) = other.segment(first, n);
	};
	part(0, 2);
	part(2, 1);
}

void McaLaw::findContacts(Scene* scene)
{
	contacts.clear();
	const auto& bodies = scene->bodies->body;
	for (auto& r : rows) {
		r.firstContact = int(contacts.size());
		for (const auto& [id, I] : bodies[size_t(r.id)]->intrs) { // ascending ids
			auto* p = castTo<McaPhys>(I->phys.get());
			if (!p || p->linked) continue;
			if (p->wall) {
				const auto* other = castTo<const FrictMat>(bodies[size_t(id)]->material.get());
				if (other && (p->revision != revision || p->madeOf[0] != r.mat || p->madeOf[1] != other)) {
					p->setWall(*r.mat, other->frictionAngle, r.d);
					p->revision = revision, p->madeOf[0] = r.mat, p->madeOf[1] = other;
				}
				continue;
			}
			if (place[size_t(id)] < 0) continue;
			const Side s { p, I->getId1() == r.id ? 0 : 1, place[size_t(id)] };
			if (!p->active) { // a link that broke has given one of them a free side
				if (!McaPhys::mayTouch(*bodies[size_t(r.id)], *r.l, *bodies[size_t(id)], *rows[size_t(s.other)].l)) continue;
				p->startContact(distance(r, s));
			}
			pairConstants(r, s);
			contacts.push_back(s);
		}
		r.lastContact = int(contacts.size());
	}
}
} // namespace yade
