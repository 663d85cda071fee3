// SPDX-License-Identifier: GPL-2.0-or-later
// The end of the law's step: sums of the pair forces in a fixed order, energies.
#include "../McaBodies.hpp"
#include "../McaCast.hpp"
#include "McaLawRows.hpp"
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>

namespace yade {
namespace MCA_SPACE {
using mca::nLinks;

namespace {
	/// Force [N/m], torque [N], viscous share of the force [N/m] and viscous heat of the links over the last move [J/m] on one body, links in the
	/// order of their slots, then the others by id.
	struct Sum {
		Vector3r force = Vector3r::Zero(), torque = Vector3r::Zero(), viscous = Vector3r::Zero();
		Real     linkHeat = 0;
		bool     any = false;
		void     add(const Body& b, const McaLawState* l, Real dt)
		{
			const McaPhys* linked[nLinks] = {};
			Vector3r       others = Vector3r::Zero(), otherTorque = Vector3r::Zero();
			for (const auto& entry : b.intrs) {
				const auto* p = castTo<const McaPhys>(entry.second->phys.get());
				if (!p) continue;
				any             = true;
				const int side = entry.second->getId1() == b.id ? 0 : 1;
				viscous += side ? Vector3r(-p->viscousForce) : p->viscousForce;
				if (p->linked && l) {
					linked[side ? mca::Lattice::opposite(p->slot) : p->slot] = p;
					continue;
				}
				others += side ? Vector3r(-p->force) : p->force;
				otherTorque += side ? p->torqueOther : p->torque;
			}
			for (int k = 0; k < nLinks; k++) {
				if (!linked[k]) continue;
				const bool first = linked[k]->slot == k;
				force += first ? linked[k]->force : Vector3r(-linked[k]->force);
				torque += first ? linked[k]->torque : linked[k]->torqueOther;
				linkHeat += 0.5 * linked[k]->heatRate * dt;
			}
			force += others, torque += otherTorque;
		}
	};
	Vector3r free(const mca::Ways& ways) { return Vector3r(ways[0], ways[1], ways[2]); }
	/// What moves and turns: in the plane x, y and about z.
	Vector3r freeMotion(const State& s) { return vector3(vec(free(freeWays(s)))); }
	Vector3r freeSpin(const State& s) { return turn3(turnOf(free(freeTurns(s)))); }
	/// Change of the spin per step by the torque, of what turns freely [rad/s].
	Vector3r spinUp(Scene& scene, int id, const State& s)
	{
		Vector3r change = Vector3r::Zero(), may = freeSpin(s), torque = scene.forces.getTorque(id);
		for (int axis = 0; axis < 3; axis++)
			if (may[axis] > 0 && s.inertia[axis] > 0) change[axis] = scene.dt * torque[axis] / s.inertia[axis];
		return change;
	}
	/// Velocity half a step (share 0.5 before, -0.5 after NewtonIntegrator) towards the time of the forces [m/s].
	Vector3r meanVelocity(Scene& scene, int id, const State& s, Real share)
	{
		const Vector3r v = vector3(vec(s.vel));
		if (!(s.mass > 0)) return v;
		return v + share * scene.dt * freeMotion(s).cwiseProduct(scene.forces.getForce(id)) / s.mass;
	}
	/// Before anything is added: a force that is not finite must not get into the bodies.
	void checkSums(const vector<Sum>& sums, long steps)
	{
		for (size_t i = 0; i < sums.size(); i++) {
			const Sum& s = sums[i];
			if (std::fabs(s.force[0]) + std::fabs(s.force[1]) + std::fabs(s.force[2]) + s.torque.cwiseAbs().maxCoeff() < 1e100) continue;
			std::ostringstream o;
			o << "body " << i << ": force " << vec(s.force) << perThickness(" N/m", " N") << " in step " << steps
			  << " is not finite, or beyond 1e100. Positions are those before the step; save and look, or use a "
			     "smaller time step. Check positions, "
			     "velocities, and kn and ks of contacts with walls, that a script has set.";
			throw mca::Error(o.str());
		}
	}
} // namespace

void Loop::addForces(Scene* scene)
{
	for (const Row& r : rows)
		if (const auto& b = scene->bodies->body[size_t(r.id)]; !b || b->state.get() != r.state)
			throw mca::Error(
				"McaForces: body " + std::to_string(r.id)
				+ " was erased or got another state between McaLaw and McaForces; put the engine that does it before McaLaw or after "
			          "NewtonIntegrator.");
	const auto& bodies = scene->bodies->body;
	const long  n      = long(bodies.size());
	vector<Sum> sums(bodies.size());
#pragma omp parallel for schedule(static)
	for (long i = 0; i < n; i++)
		if (const auto& b = bodies[size_t(i)]) {
			auto* m = castTo<McaState>(b->state.get());
			sums[size_t(i)].add(*b, m ? m->law.get() : nullptr, law.lastMove);
		}
	checkSums(sums, law.steps);
	for (long i = 0; i < n; i++) {
		const Sum& s = sums[size_t(i)];
		if (s.any) scene->forces.addForce(int(i), s.force), scene->forces.addTorque(int(i), s.torque);
		if (size_t(i) >= place.size() || place[size_t(i)] < 0) continue;
		const Row& r = rows[size_t(place[size_t(i)])];
		r.l->moved   = scene->dt;
		if (r.material->eos.heats()) { // the heat of the viscosity of links goes into the internal energy
			const Real heat = mca::viscousWork(r.l->viscous, r.l->dTheta, r.m->volumeRatio) * r.l->cell + s.linkHeat;
			r.m->dissipated += heat * (1. / r.material->eos.rho0) / r.l->cell;
			if (scene->trackEnergy) law.heated += heat;
		}
	}
	if (scene->trackEnergy) {
		scene->forces.sync();
		law.lastViscous = 0;
		for (const Row& r : rows) // the work of this step: with the mean of the velocities before and after it
			law.lastViscous -= sums[size_t(r.id)].viscous.dot(meanVelocity(*scene, r.id, *r.state, 0.5)) * scene->dt;
		law.viscous += law.lastViscous;
		bookEnergies(scene);
	}
	law.members.clear();
	scene->forces.sync();
	for (const Row& r : rows) {
		law.members.push_back(r.id);
		r.m->links = mca::linkCount(flagsOf(*r.l));
		const State& s    = *r.state;
		r.l->from         = s.se3.position, r.l->fromOri = s.se3.orientation;
		r.l->expected     = vector3(vec(s.vel)) + freeMotion(s).cwiseProduct(scene->forces.getForce(r.id)) * (scene->dt / s.mass);
		r.l->expectedSpin = turn3(turnOf(s.angVel)) + spinUp(*scene, r.id, s);
	}
	law.lastMove = scene->dt;
	if (law.pushedAt != scene->iter) law.steps++; // not twice when something has stopped the step before NewtonIntegrator
	law.pushedAt = scene->iter;
}

McaLawLoop::Energies Loop::energies(Scene& scene) const
{
	Energies e;
	e.centre = -0.5 * law.lastViscous;
	scene.forces.sync();
	vector<const McaMat*> seen;
	vector<mca::Material> constants;
	for (const auto& b : scene.bodies->body) {
		auto* m = isAutomaton(b) ? castTo<McaState>(b->state.get()) : nullptr;
		if (!m || !m->law) continue;
		const auto& c = constants[materialIndex(static_cast<const McaMat*>(b->material.get()), seen, constants)];
		const auto& l = *m->law;
		e.volumetric += mca::volumeEnergy(c, l.cell, m->volumeRatio, m->dissipated);
		if (l.rule == int(mca::VolumeRule::affine) && l.factor > 0)
			e.volumetric += mca::coldEnergy( // contacts have a volume of their own
				c, mca::contactCell(l.diameter, l.cell, l.factor), mca::contactRatio(l.contactSum));
		const auto     ofSpin = [&](const Vector3r& w) { return 0.5 * m->inertia.dot(turn3(turnOf(w.cwiseProduct(w)))); };
		const Vector3r v = vector3(vec(m->vel));
		e.kinetic += 0.5 * m->mass * v.squaredNorm() + ofSpin(m->angVel);
		e.centre += 0.5 * m->mass * (meanVelocity(scene, b->id, *m, -0.5).squaredNorm() - v.squaredNorm());
		e.centre += ofSpin(m->angVel - 0.5 * spinUp(scene, b->id, *m)) - ofSpin(m->angVel);
		Real pairs = 0;
		for (const auto& entry : b->intrs) {
			const auto* p = castTo<const McaPhys>(entry.second->phys.get());
			if (!p || p->wall) continue;
			const int  side   = entry.second->getId1() == b->id ? 0 : 1, k = side ? mca::Lattice::opposite(p->slot) : p->slot;
			const Real weight = p->linked ? mca::linkWeight(flagsOf(l), k) : 1.;
			if (p->bonded() && side == 0) {
				const State& other = *scene.bodies->body[size_t(entry.first)]->state;
				e.deviatoric += mca::heldNow(bondOf(*p), openingOf(*p), vec(other.se3.position) - vec(m->se3.position));
			}
			pairs += weight * mca::pairEnergy(stressOf(*p, side), m->volumeRatio, p->twoG);
		}
		e.deviatoric += deviatorEnergyOf(*m, l, c.G, pairs);
	}
	e.volumetric -= law.heated;
	return e;
}

void Loop::bookEnergies(Scene* scene)
{
	const Energies e     = energies(*scene);
	const Real     total = e.kinetic + e.centre + e.volumetric + e.deviatoric + law.plastic + law.viscous + law.frictional + law.fracture + law.coupling;
	// bodies were added or erased since the last step: the sum is kept over a step, so what is missing or more is theirs
	const auto is      = [](const Row& r, int id) { return r.id == id; };
	const bool changed = law.members.size() != rows.size() || !std::equal(rows.begin(), rows.end(), law.members.begin(), is);
	if (changed && !law.members.empty() && law.bookedAt == scene->iter - 1) law.joined += total - law.lastTotal;
	law.lastTotal = total, law.bookedAt = scene->iter;
	const char* names[]  = { "mcaVolumetric", "mcaDeviatoric", "mcaPlastic", "mcaViscous", "mcaFriction", "mcaFracture", "mcaCoupling", "mcaJoined" };
	const Real  values[] = { e.volumetric, e.deviatoric, law.plastic, law.viscous, law.frictional, law.fracture, law.coupling, -law.joined };
	for (int k = 0; k < (law.joined != 0 ? 8 : 7); k++)
		scene->energy->set(values[k], names[k], energyIndex[k]);
}

} // namespace MCA_SPACE
} // namespace yade
