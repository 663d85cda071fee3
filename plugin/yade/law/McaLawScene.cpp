// SPDX-License-Identifier: GPL-2.0-or-later
// McaLaw: which bodies and pairs there are in this step. Links are made when an automaton is first seen, and follow bodies that are added and erased.
#include "../McaBodies.hpp"
#include "../McaCast.hpp"
#include "../McaPairRules.hpp"
#include "McaLawRows.hpp"
#include "automata/start.hpp"
#include <atomic>
#include <core/InteractionLoop.hpp>
#include <kernels/automaton/outline.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>

namespace yade {
namespace MCA_SPACE {
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
	bool sameLinks(const McaLawState& l, mca::Flags flags, const vector<int>& partner)
	{
		if (mca::trianglesIn(flagsOf(l)) != mca::trianglesIn(flags)) return false;
		for (int k = 0; k < nLinks; k++)
			if (mca::holds(flagsOf(l), k) != mca::holds(flags, k)
			    || (mca::holds(flags, k) && l.partner[size_t(k)] != partner[size_t(k)]))
				return false;
		return true;
	}
} // namespace

// A scene of its own: nothing goes on from what this engine did before.
void Loop::forget()
{
	law.filterTime = law.lastMove = 0, law.steps = law.brokenLinks = law.clamped = 0, law.doneAt = law.bookedAt = law.pushedAt = -1, law.deepest = 1;
	law.plastic = law.viscous = law.lastViscous = law.frictional = law.fracture = law.coupling = law.heated = law.joined = 0;
	law.members.clear();
}

// Links, slots, weights and the state of rest are those of the fast solver, when automata are added as well: new links form with those that are new only.
void Loop::takeIn(Scene* scene)
{
	for (const Row& r : rows)
		if (!r.l) checkUntouched(r);
	const McaBodies   bodies(*scene, law.seed, mca::dim, law.linkAcrossMasks);
	vector<automata::Automaton> all;
	for (const auto& a : bodies.automata) all.push_back(automata::startOf(a));
	automata::Options o;
	o.volumeRule = rule(), o.contacts = false, o.linkFactor = law.linkFactor;
	vector<automata::Automaton>  known;
	vector<automata::LinkRecord> records;
	for (const auto& a : all) {
		const auto* l = rows[size_t(place[size_t(a.id)])].l;
		if (!l) continue;
		known.push_back(a);
		automata::LinkRecord record;
		record.id = a.id, record.flags = flagsOf(*l), record.invN = l->invN;
		std::copy(l->partner.begin(), l->partner.end(), record.partner);
		records.push_back(record);
	}
	automata::Solver solver;
	if (known.empty()) {
		solver.build(all, bodies.materials, o);
		forget();
	} else {
		const auto old = automata::Solver::knowing(known, bodies.materials, records);
		solver.build(all, bodies.materials, o, &old);
	}
	law.linkFactorUsed           = law.linkFactor;
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
		l.triangles = r.m->triangles, l.dimension = mca::dim, l.acrossMasks = law.linkAcrossMasks;
		l.cell = S.cell[i], l.rest = S.rest[i], l.factor = S.factor[i], l.rule = int(o.volumeRule), l.diameter = r.d;
		r.m->volumeRatio = S.J[i], l.P = S.P[i], r.m->pressure = S.mean[i];
	}
	McaPhys::linking = true;
	try {
		for (const Row& r : rows)
			for (int k = 0; k < nLinks; k++)
				if (mca::holds(flagsOf(*r.l), k) && r.l->partner[size_t(k)] > r.id)
					makeLink(*scene, r.id, r.l->partner[size_t(k)], k, mca::linkWeight(flagsOf(*r.l), k) < 1.);
	} catch (...) { // they stay new
		McaPhys::linking = false;
		for (int id : newcomers)
			rows[size_t(place[size_t(id)])].m->law.reset();
		throw;
	}
	McaPhys::linking = false;
}

void Loop::gather(Scene* scene)
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
	if (!old) clearStale(*scene); // before InteractionLoop looks at them, if nobody is left, too
	checkMasks(masks, otherMasks);
	if (old && law.linkFactorUsed > 0 && law.linkFactor != law.linkFactorUsed)
		throw mca::Error(
			"McaLaw: linkFactor = " + std::to_string(law.linkFactor) + ", but links were made with " + std::to_string(law.linkFactorUsed)
			+ "; it can be chosen before the first step only. Set it back.");
	if (fresh) takeIn(scene);
	readMaterials(scene);
	for (const Row& r : rows)
		checkState(r);
	if (law.steps == 0 && law.lastMove == 0) // an engine that goes on with what another McaLaw has moved
		for (const Row& r : rows)
			law.lastMove = std::max(law.lastMove, r.l->moved);
}

void Loop::readMaterials(Scene* scene)
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
	const vector<const Material*> names(all.begin(), all.end());
	const mca::PairRules          now = pairRulesOf(law.pairMaterials, law.pairNumbers, names);
	same &= now == rules;
	if (!same) revision = ++revisions;
	known = all, materials = constants, rules = now;
	for (size_t i = 0; i < rows.size(); i++)
		rows[i].material = &materials[which[i]];
	checkCohesion();
}

// Constants of a pair from its materials: when it is new, when it was loaded, and when a script has changed a material or given a body another one.
void Loop::pairConstants(const Row& r, const Side& s) const
{
	McaPhys&   p = *s.p;
	const Row &a = s.side ? rows[size_t(s.other)] : r, &b = s.side ? r : rows[size_t(s.other)];
	if (p.revision == revision && p.madeOf[0] == a.mat && p.madeOf[1] == b.mat) return;
	p.revision = revision, p.madeOf[0] = a.mat, p.madeOf[1] = b.mat;
	p.twoG       = mca::seriesTwoG(a.material->G, b.material->G, p.arm);
	const auto& rule = ruleOf(a, b);
	p.friction   = mca::frictionOf(*a.material, *b.material, rule);
	const auto v = mca::viscosityOf(*a.material, *b.material, rule);
	p.viscLinear = v.linear, p.viscQuadratic = v.quadratic;
}

void Loop::findLinks(Scene* scene)
{
	bonds.clear();
	for (auto& r : rows) {
		mca::Flags found = 0;
		for (const auto& [id, I] : scene->bodies->body[size_t(r.id)]->intrs) {
			auto* p = castTo<McaPhys>(I->phys.get());
			// InteractionLoop aborts where a functor has its materials the other way round: Ip2_FrictMat_McaMat_McaPhys wants the automaton second
			if (!I->phys && !I->geom && place[size_t(id)] < 0 && I->getId1() == r.id) I->swapOrder();
			if (p && p->bonded() && I->getId1() == r.id && place[size_t(id)] >= 0)
				bonds.push_back({ int(&r - rows.data()), { p, 0, place[size_t(id)] } });
			if (!p || !p->linked) continue;
			if (p->slot >= nLinks)
				throw mca::Error(
					"bodies " + std::to_string(r.id) + " and " + std::to_string(id) + ": slot = " + std::to_string(p->slot)
					+ " of their link must be below " + std::to_string(nLinks) + "; the saved file was edited or damaged.");
			if (place[size_t(id)] < 0) continue;
			const int side = I->getId1() == r.id ? 0 : 1, k = side ? mca::Lattice::opposite(p->slot) : p->slot;
			r.link[k]      = { p, side, place[size_t(id)] };
			pairConstants(r, r.link[k]);
			found |= mca::Flags(1) << k;
		}
		const mca::Flags missing = (flagsOf(*r.l) & mca::linkBits) & ~found;
		if (!missing) continue;
		for (int k = 0; k < nLinks; k++) {
			const int other = r.l->partner[size_t(k)];
			if (!((missing >> k) & 1)) continue;
			if (other >= 0 && size_t(other) < place.size() && place[size_t(other)] >= 0)
				throw mca::Error(
					"automata " + std::to_string(r.id) + " and " + std::to_string(other)
					+ " are linked, but their interaction is gone in step " + std::to_string(law.steps)
					+ ". Something has erased it (O.interactions.clear?); load the last saved state.");
			if (other >= 0 && size_t(other) < place.size() && scene->bodies->body[size_t(other)])
				throw mca::Error(
					"body " + std::to_string(other) + " is linked to automaton " + std::to_string(r.id)
					+ " but is no automaton any more; give it back its McaMat, Sphere and state, or erase it.");
			r.l->flags = mca::withoutTriangles(flagsOf(*r.l) & ~mca::slotBits(k)) | mca::exposedBit; // its partner was erased
			r.l->partner[size_t(k)] = -1;
			relinked.push_back(r.id);
		}
	}
}

// Who has lost or got links because bodies were erased or added keeps the volume that it had, measured by the links that it has now.
void Loop::keepVolumes(Scene* scene)
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
	if (law.doneAt == scene->iter)
		law.doneAt = -1, law.lastMove = 0; // a step that was stopped half-way: its strain is in the stresses, pressures are not those of the links now
}

namespace {
	/// The turn that leads from one orientation to another, the shorter way round [rad].
	Vector3r turnBetween(const Quaternionr& from, const Quaternionr& to)
	{
		Quaternionr q = to * from.conjugate();
		if (q.w() < 0) q.coeffs() *= -1.;
		return angleOf(q, 3);
	}
	/// Whether two vectors agree, but for a share of their lengths and for round-off.
	bool same(const Vector3r& a, const Vector3r& b, Real share, Real round) { return (a - b).norm() <= share * (a.norm() + b.norm()) + round; }
	/// What the last move was made with: `now` as always, or put elsewhere by a script with the velocity it had; else what was expected, or made if the
	/// place was set as well.
	Vector3r lastOf(const Vector3r& now, const Vector3r& made, const Vector3r& expected, Real round)
	{
		if (same(made, now, 1e-9, round) || same(now, expected, 1e-6, round)) return now;
		return same(made, expected, 1e-6, round) ? made : expected;
	}
	Vector3r inDimension(Vector3r x)
	{
		if (mca::dim == 2) x[2] = 0;
		return x;
	}
	Vector3r turning(const Vector3r& w) { return mca::dim == 2 ? Vector3r(0, 0, w[2]) : w; }
}

/// NewtonIntegrator has moved the bodies since they got the forces of this step.
bool Loop::hasMoved() const
{
	return std::any_of(rows.begin(), rows.end(), [&](const Row& r) { // not a script
		const Vector3r meant = r.l->expected * law.lastMove, turn = r.l->expectedSpin * law.lastMove;
		if (meant != Vector3r::Zero()) return (inDimension(r.state->se3.position - r.l->from) - meant).norm() <= 1e-6 * meant.norm();
		const Vector3r turned = turning(turnBetween(r.l->fromOri, r.state->se3.orientation));
		return turn.norm() > 1e-9 && (turned - turn).norm() <= 1e-6 * turn.norm();
	});
}

/// The velocity with which the last move was made. It is that of the state unless a script has set another one since, or another place.
void Loop::lastMotion(Row& r) const
{
	const State&       s = *r.state;
	const McaLawState& l = *r.l;
	r.velocity = inDimension(s.vel), r.spin = turning(s.angVel);
	r.fresh    = !(l.moved > 0);
	if (r.fresh || !(law.lastMove > 0)) return;
	const Vector3r at = inDimension(s.se3.position);
	r.velocity = lastOf(r.velocity, inDimension(at - l.from) / law.lastMove, l.expected, 1e-15 * (at.norm() + 1e-3 * r.d) / law.lastMove);
	r.spin     = lastOf(r.spin, turning(turnBetween(l.fromOri, s.se3.orientation)) / law.lastMove, l.expectedSpin, 4e-15 / law.lastMove);
}

void Loop::findContacts(Scene* scene)
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
					p->setWall(*r.mat, other->frictionAngle, r.d, mca::dim);
					p->revision = revision, p->madeOf[0] = r.mat, p->madeOf[1] = other;
				}
				continue;
			}
			if (place[size_t(id)] < 0) continue;
			const Side s { p, I->getId1() == r.id ? 0 : 1, place[size_t(id)] };
			if (!p->active) { // a link that broke has given one of them a free side
				if (!McaPairLaw::in(mca::dim).mayTouch(*bodies[size_t(r.id)], *r.l, *bodies[size_t(id)], *rows[size_t(s.other)].l)) continue;
				p->startContact(distance(r, s));
			}
			pairConstants(r, s);
			contacts.push_back(s);
		}
		r.lastContact = int(contacts.size());
	}
}
} // namespace MCA_SPACE
} // namespace yade
