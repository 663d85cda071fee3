// SPDX-License-Identifier: GPL-2.0-or-later
// The end of the law's step: sums of the pair forces in a fixed order, energies.
#include "McaBodies.hpp"
#include "McaCast.hpp"
#include "McaLaw.hpp"
#include "McaGuarded.hpp"
#include <pkg/common/Sphere.hpp>
#include <core/Omega.hpp>
#include <kernels/automaton/energy.hpp>
#include <core/Scene.hpp>

namespace yade {
YADE_PLUGIN((McaForces));
using mca::sqr;
using mca::nLinks;

namespace {
	/// Force [N/m], torque about z [N], viscous share of the force [N/m] and viscous heat of the links over the last move [J/m] on one body, links in the
	/// order of their slots, then the others by id.
	struct Sum {
		Vector3r force = Vector3r::Zero();
		Vector2r viscous = Vector2r::Zero();
		Real     torque = 0, linkHeat = 0;
		bool     any = false;
		void     add(const Body& b, const McaLawState* l, Real dt)
		{
			const McaPhys* linked[nLinks] = {};
			Vector3r       others         = Vector3r::Zero();
			Real           otherTorque    = 0;
			for (const auto& entry : b.intrs) {
				const auto* p = castTo<const McaPhys>(entry.second->phys.get());
				if (!p) continue;
				any             = true;
				const int side = entry.second->getId1() == b.id ? 0 : 1;
				viscous += side ? Vector2r(-p->viscousForce) : p->viscousForce;
				if (p->linked && l) {
					linked[side ? mca::Lattice::opposite(p->slot) : p->slot] = p;
					continue;
				}
				others += side ? Vector3r(-p->force) : p->force;
				otherTorque += p->torque[side];
			}
			for (int k = 0; k < nLinks; k++) {
				if (!linked[k]) continue;
				const int side = linked[k]->slot == k ? 0 : 1;
				force += side ? Vector3r(-linked[k]->force) : linked[k]->force;
				torque += linked[k]->torque[side];
				linkHeat += 0.5 * linked[k]->heatRate * dt;
			}
			force += others, torque += otherTorque;
		}
	};
	/// Velocity half a step (share 0.5 before, -0.5 after NewtonIntegrator) towards the time of the forces [m/s].
	Vector2r meanVelocity(Scene& scene, int id, const State& s, Real share)
	{
		const Vector3r& f = scene.forces.getForce(id);
		Vector2r        v(s.vel[0], s.vel[1]);
		for (int axis = 0; axis < 2; axis++)
			if (!(s.blockedDOFs & (axis ? State::DOF_Y : State::DOF_X)) && s.mass > 0) v[axis] += share * scene.dt * f[axis] / s.mass;
		return v;
	}
	/// Before anything is added: a force that is not finite must not get into the bodies.
	void checkSums(const vector<Sum>& sums, long steps)
	{
		for (size_t i = 0; i < sums.size(); i++) {
			const Sum& s = sums[i];
			if (std::fabs(s.force[0]) + std::fabs(s.force[1]) + std::fabs(s.force[2]) + std::fabs(s.torque) < 1e100) continue;
			std::ostringstream o;
			o << "body " << i << ": force (" << s.force[0] << ", " << s.force[1] << ") N/m in step " << steps
			  << " is not finite, or beyond 1e100. Positions are those before the step; save and look, or use a "
			     "smaller time step. Check positions, "
			     "velocities, and kn and ks of contacts with walls, that a script has set.";
			throw mca::Error(o.str());
		}
	}
} // namespace

void McaForces::action()
{
	guarded([&] {
		for (const auto& e : scene->engines)
			if (auto* d = e && !e->dead ? dynamic_cast<McaLaw*>(e.get()) : nullptr) return d->addForces(scene);
		throw mca::Error("McaForces: there is no McaLaw in O.engines, or it is dead; it must come before InteractionLoop.");
	});
}

void McaLaw::addForces(Scene* scene)
{
	if (doneAt != scene->iter) throw mca::Error("McaForces: McaLaw has not run in this step; it must come before InteractionLoop and run in every step.");
	if (const string error = McaPhys::takeError(); !error.empty()) throw mca::Error(error);
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
			sums[size_t(i)].add(*b, m ? m->law.get() : nullptr, lastMove);
		}
	checkSums(sums, steps);
	for (long i = 0; i < n; i++) {
		const Sum& s = sums[size_t(i)];
		if (s.any) scene->forces.addForce(int(i), s.force), scene->forces.addTorque(int(i), Vector3r(0, 0, s.torque));
		if (size_t(i) >= place.size() || place[size_t(i)] < 0) continue;
		const Row& r = rows[size_t(place[size_t(i)])];
		r.l->moved   = scene->dt;
		if (r.material->eos.heats()) { // the heat of the viscosity of links goes into the internal energy
			const Real heat = mca::viscousWork(r.l->viscous, r.l->dTheta, r.m->volumeRatio) * r.l->cell + s.linkHeat;
			r.m->dissipated += heat * (1. / r.material->eos.rho0) / r.l->cell;
			if (scene->trackEnergy) heated += heat;
		}
	}
	if (scene->trackEnergy) {
		scene->forces.sync();
		lastViscous = 0;
		for (const Row& r : rows) // the work of this step: with the mean of the velocities before and after it
			lastViscous -= sums[size_t(r.id)].viscous.dot(meanVelocity(*scene, r.id, *r.state, 0.5)) * scene->dt;
		viscous += lastViscous;
		bookEnergies(scene);
	}
	members.clear();
	scene->forces.sync();
	for (const Row& r : rows) {
		members.push_back(r.id);
		r.m->links = mca::linkCount(r.l->flags);
		const State&    s = *r.state;
		const Vector3r &f = scene->forces.getForce(r.id), &t = scene->forces.getTorque(r.id);
		const auto      free = [&](unsigned dof) { return s.blockedDOFs & dof ? 0. : scene->dt; };
		r.l->from     = Vector3r(s.se3.position[0], s.se3.position[1], 2. * std::atan2(s.se3.orientation.z(), s.se3.orientation.w()));
		r.l->expected        = Vector3r(
			       s.vel[0] + free(State::DOF_X) * f[0] / s.mass, s.vel[1] + free(State::DOF_Y) * f[1] / s.mass,
			       s.angVel[2] + (s.inertia[2] > 0 ? free(State::DOF_RZ) * t[2] / s.inertia[2] : 0.));
	}
	lastMove = scene->dt;
	if (pushedAt != scene->iter) steps++; // not twice when something has stopped the step before NewtonIntegrator
	pushedAt = scene->iter;
}

// State energies: volume and deviator of all automata [J/m].
void McaLaw::stateEnergies(Scene& scene, Real& volumetric, Real& deviatoric, Real& kinetic, Real& centre) const
{
	volumetric = deviatoric = kinetic = 0;
	centre = -0.5 * lastViscous; // velocities stand half a step after stresses
	scene.forces.sync();
	vector<const McaMat*> seen;
	vector<mca::Material> constants;
	for (const auto& b : scene.bodies->body) {
		auto* m = isAutomaton(b) ? castTo<McaState>(b->state.get()) : nullptr;
		if (!m || !m->law) continue;
		const auto* mat = static_cast<const McaMat*>(b->material.get());
		auto        it  = std::find(seen.begin(), seen.end(), mat);
		if (it == seen.end()) seen.push_back(mat), constants.push_back(mat->toMaterial()), it = seen.end() - 1;
		const auto& c = constants[size_t(it - seen.begin())];
		const auto& l = *m->law;
		volumetric += mca::volumeEnergy(c, l.cell, m->volumeRatio, m->dissipated);
		if (l.rule == int(mca::VolumeRule::affine) && l.factor > 0)
			volumetric += mca::coldEnergy( // contacts have a volume of their own
				c, mca::contactCell(l.diameter, l.cell, l.factor), mca::contactRatio(l.contactSum));
		kinetic += 0.5 * (m->mass * m->vel.squaredNorm() + m->inertia[2] * sqr(m->angVel[2]));
		centre += 0.5 * m->mass * (meanVelocity(scene, b->id, *m, -0.5).squaredNorm() - m->vel.squaredNorm());
		if (!(m->blockedDOFs & State::DOF_RZ) && m->inertia[2] > 0)
			centre += 0.5 * m->inertia[2]
				* (sqr(m->angVel[2] - 0.5 * scene.dt * scene.forces.getTorque(b->id)[2] / m->inertia[2]) - sqr(m->angVel[2]));
		Real pairs = 0;
		for (const auto& entry : b->intrs) {
			const auto* p = castTo<const McaPhys>(entry.second->phys.get());
			if (!p || p->wall) continue;
			const int side = entry.second->getId1() == b->id ? 0 : 1;
			pairs += (p->linked && p->half ? 0.5 : 1.) * mca::pairEnergy(p->s[side], p->tau[side], m->volumeRatio, p->twoG);
		}
		deviatoric += mca::deviatorEnergy(c.G, l.diameter, pairs, m->volumeRatio, m->stressZZ, l.invN);
	}
	volumetric -= heated;
}

void McaLaw::bookEnergies(Scene* scene)
{
	Real volumetric, deviatoric, kinetic, centre;
	stateEnergies(*scene, volumetric, deviatoric, kinetic, centre);
	const Real total = kinetic + centre + volumetric + deviatoric + plastic + viscous + frictional + fracture + coupling;
	// bodies were added or erased since the last step: the sum is kept over a step, so what is missing or more is theirs
	const bool changed =
		members.size() != rows.size() || !std::equal(rows.begin(), rows.end(), members.begin(), [](const Row& r, int id) { return r.id == id; });
	if (changed && !members.empty() && bookedAt == scene->iter - 1) joined += total - lastTotal;
	lastTotal = total, bookedAt = scene->iter;
	const char* names[]  = { "mcaVolumetric", "mcaDeviatoric", "mcaPlastic", "mcaViscous", "mcaFriction", "mcaFracture", "mcaCoupling", "mcaJoined" };
	const Real  values[] = { volumetric, deviatoric, plastic, viscous, frictional, fracture, coupling, -joined };
	for (int k = 0; k < (joined != 0 ? 8 : 7); k++)
		scene->energy->set(values[k], names[k], energyIndex[k]);
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
	Real volumetric, deviatoric, kinetic, centre;
	stateEnergies(*Omega::instance().getScene(), volumetric, deviatoric, kinetic, centre);
	py::dict d;
	d["kinetic"] = kinetic, d["volumetric"] = volumetric, d["deviatoric"] = deviatoric, d["plastic"] = plastic, d["viscous"] = viscous,
	d["friction"] = frictional, d["fracture"] = fracture;
	d["coupling"] = coupling, d["total"] = kinetic + centre + volumetric + deviatoric + plastic + viscous + frictional + fracture + coupling,
	d["joined"] = joined;
	return d;
}

py::dict McaLaw::counters() const
{
	py::dict d;
	d["steps"] = steps, d["brokenLinks"] = brokenLinks, d["clamped"] = clamped, d["deepest"] = deepest;
	return d;
}

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
