// SPDX-License-Identifier: GPL-2.0-or-later
// McaEngine and the rigid bodies of the scene: walls, boxes, facets and spheres of other materials that automata touch. YADE moves them; their forces go to
// O.forces.
#include "McaBodies.hpp"
#include "McaCast.hpp"
#include "McaEngine.hpp"
#include "McaVec.hpp"
#include <core/Omega.hpp>
#include <map>
#include <core/Scene.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/Sphere.hpp>

namespace yade {
using mca::WallForm;
using mca::WallKind;

namespace {
	mca::Point point(const Vector3r& v) { return { { v[0], v[1], v[2] } }; }
	Vector3r   vector3(const mca::Point& p) { return Vector3r(p[0], p[1], p[2]); }

	/// Under Python's lock: the declarations of these shapes are not among ours.
	WallForm readForm(const shared_ptr<Shape>& shape, const string& name)
	{
		const py::object o(shape);
		WallForm         w;
		if (name == "Wall") w.axis = py::extract<int>(o.attr("axis")), w.side = py::extract<int>(o.attr("sense"));
		else if (name == "Box") w.kind = WallKind::box, w.half = point(py::extract<Vector3r>(o.attr("extents")));
		else {
			w.kind = WallKind::facet;
			const py::object corners = o.attr("vertices");
			for (int k = 0; k < 3; k++) w.corner[k] = point(py::extract<Vector3r>(corners[k]));
		}
		return w;
	}
	WallForm formOf(const Body& b, const string& name)
	{
		WallForm w;
		if (const auto* sphere = castTo<Sphere>(b.shape.get())) {
			w.kind = WallKind::ball, w.radius = sphere->radius;
			return w;
		}
		const PyGILState_STATE state = PyGILState_Ensure();
		bool                   known = true;
		try {
			w = readForm(b.shape, name);
		} catch (const py::error_already_set&) {
			PyErr_Clear();
			known = false;
		}
		PyGILState_Release(state);
		Real size = length(w.half);
		for (const mca::Point& p : w.corner) size += length(p);
		if (!(known && w.axis >= 0 && w.axis < 3 && w.side >= -1 && w.side <= 1 && std::isfinite(size)))
			refuseBody(b, "its shape, a " + name + ", has no axis and sense, extents or vertices that are finite; make it with yade.utils.");
		return w;
	}
	bool sameWall(const mca::WallStart& a, const mca::WallStart& b)
	{
		bool equal = a.id == b.id && a.friction == b.friction && a.mass == b.mass && a.form.kind == b.form.kind && a.form.axis == b.form.axis
			&& a.form.side == b.form.side && a.form.radius == b.form.radius;
		for (int c = 0; c < 3; c++) {
			equal &= a.form.half[c] == b.form.half[c];
			for (int k = 0; k < 3; k++) equal &= a.form.corner[k][c] == b.form.corner[k][c];
		}
		return equal;
	}
	/// That resists what touches the body [kg]; 0: it moves as it is told.
	Real movingMass(const Scene& scene, const Body& b)
	{
		const State& s = b.isClumpMember() ? *scene.bodies->body[size_t(b.clumpId)]->state : *b.state;
		return s.blockedDOFs == State::DOF_ALL ? 0. : s.mass;
	}
	/// was: its place a step of dt ago. A velocity alone moves nothing, and friction would take it for motion.
	void checkMoved(const Body& b, const mca::WallPlace& was, const Quaternionr& turned, Real dt)
	{
		if (length(was.spin) * dt > 1e-12 && b.state->se3.orientation.coeffs() == turned.coeffs())
			refuseBody(
				b, "its angVel of " + numberText(length(was.spin))
					+ " rad/s has not turned it in the last step: put NewtonIntegrator(damping=0, mask=...) last in O.engines, with a "
					  "mask of this body that no automaton has, or set angVel to 0.");
		const Vector3r x = b.state->se3.position, before = vector3(was.position);
		if (x != before || !(length(was.velocity) * dt > 1e-12 * (x.norm() + length(was.velocity) * dt))) return;
		refuseBody(
			b, "its velocity of " + numberText(length(was.velocity))
				+ " m/s has not moved it in the last step: in YADE a NewtonIntegrator moves what TranslationEngine or a script has given "
				  "a velocity. Put NewtonIntegrator(damping=0, mask=...) last in O.engines, with a mask of this body that no automaton has, or "
				  "set vel to 0.");
	}
	bool hasEngine(const Scene& scene, const char* name)
	{
		const auto is = [&](const shared_ptr<Engine>& e) { return !e->dead && e->getClassName() == name; };
		return std::any_of(scene.engines.begin(), scene.engines.end(), is);
	}
} // namespace

/// Whether another engine makes the forces between automata and rigid bodies.
bool McaEngine::wallsAreOthers(const Scene& scene) const { return readForces && hasEngine(scene, "InteractionLoop"); }

/// By automata, or refused: a body that is no automaton.
bool McaEngine::mayBeTouched(const Body& b) { return b.shape && b.state && b.groupMask != 0 && !b.isClump(); }

mca::WallStart McaEngine::wallOf(const Scene& scene, const Body& b) const
{
	const string name = b.shape->getClassName();
	if (name != "Wall" && name != "Box" && name != "Facet" && name != "Sphere")
		refuseBody(
			b, "it is a " + name
				+ ", which automata would pass through: walls, boxes, facets and spheres they touch. Use these, or give a body "
				  "that is only looked at mask=0.");
	const auto* m = b.material ? dynamic_cast<const FrictMat*>(b.material.get()) : nullptr;
	if (!m || !(m->frictionAngle >= 0 && m->frictionAngle <= 1.57))
		refuseBody(
			b, "automata that touch it need its friction: give it a FrictMat with frictionAngle from 0 to 1.57 [rad], or mask=0 if "
			   "it is only looked at.");
	mca::WallStart w;
	w.id = b.id, w.form = formOf(b, name), w.friction = std::tan(m->frictionAngle), w.mass = movingMass(scene, b);
	return w;
}

namespace {
	/// Of the automata of a clump: their masses, and those of their spheres.
	struct Members {
		Real mass = 0, spheres = 0;
	};
	/// YADE makes the mass of a clump from the volumes of spheres: in plane strain not per m of thickness, in space less than that of the packing.
	void checkClump(const Scene& scene, int id, const Members& m)
	{
		const auto& clump = scene.bodies->body[size_t(id)];
		if (!clump || !clump->state || clump->state->blockedDOFs == State::DOF_ALL) return;
		if (std::fabs(clump->state->mass - m.spheres) > 1e-3 * m.spheres) return;
		refuseBody(
			*clump,
			"it is a clump of automata with a mass of " + numberText(clump->state->mass) + ", and that of its members is " + numberText(m.mass)
				+ ": YADE takes the volume of spheres. Make it with packings.clump(ids), or set its state.mass and state.inertia.");
	}
} // namespace

/// What a script may have changed in them counts from the next step on.
void McaEngine::gatherWalls(Scene* scene)
{
	vector<shared_ptr<Body>>    found;
	vector<mca::WallStart> starts;
	std::map<int, Members> clumps; ///< of automata
	if (!wallsAreOthers(*scene) && !order.empty())
		for (const auto& b : scene->bodies->body) {
			if (!b || !mayBeTouched(*b) || movesAlone(b)) continue;
			starts.push_back(wallOf(*scene, *b)), found.push_back(b);
			if (!isAutomaton(b)) continue;
			const Real r = static_cast<const Sphere&>(*b->shape).radius;
			clumps[b->clumpId].mass += b->state->mass, clumps[b->clumpId].spheres += b->material->density * (4. / 3.) * M_PI * r * r * r;
		}
	for (const auto& [id, members] : clumps) checkClump(*scene, id, members);
	const bool equal = starts.size() == wallStarts.size() && std::equal(starts.begin(), starts.end(), wallStarts.begin(), sameWall);
	walls.swap(found);
	letGo(found);
	if (!equal) wallStarts = starts, solver->setWalls(starts);
	wallPlaces.clear(); // a script may have moved them
	if (walls.empty()) return;
	if (coupled) refuseBody(*walls[0], "the grid that automata are tied to would pass through it; drive or hold the grid's sides, or give it mask=0.");
	forcesAreReset = hasEngine(*scene, "ForceResetter");
}

/// Forces of walls on automata. Those on the walls are kept for tellWalls().
void McaEngine::pushWalls(Real lastStep)
{
	if (walls.empty()) return;
	const bool before = wallPlaces.size() == walls.size();
	wallPlaces.resize(walls.size()), wallTurns.resize(walls.size());
	for (size_t w = 0; w < walls.size(); w++) {
		const State& s = *walls[w]->state;
		auto&        p = wallPlaces[w];
		if (before) checkMoved(*walls[w], p, wallTurns[w], lastStep);
		if (!(s.se3.position.allFinite() && s.vel.allFinite() && s.angVel.allFinite() && std::fabs(s.se3.orientation.norm() - 1.) < 1e-3))
			refuseBody(*walls[w], "its position, velocity or orientation is not finite, or the orientation is no rotation.");
		p.velocity = point(s.vel), p.spin = point(s.angVel);
		p.moved    = !before || s.se3.position != vector3(p.position) || s.se3.orientation.coeffs() != wallTurns[w].coeffs();
		if (!p.moved) continue;
		p.position = point(s.se3.position), wallTurns[w] = s.se3.orientation;
		if (wallStarts[w].form.kind != WallKind::box && wallStarts[w].form.kind != WallKind::facet) continue;
		const Matrix3r turn = s.se3.orientation.toRotationMatrix();
		for (int k = 0; k < 3; k++) p.axis[k] = point(turn.col(k));
	}
	wallPushes = &solver->pushWalls(wallPlaces, bodies[0]->state->se3.position[2]);
}

/// Once a step, of scene->dt. NewtonIntegrator kicks what is free by that, automata are kicked by half of the step before and half of this one: free bodies
/// get the force that has the same impulse, so that momentum is kept whatever the steps.
void McaEngine::tellWalls(Scene* scene)
{
	const Real kick = solver->kick(scene->dt) / scene->dt;
	bool       some = false;
	for (size_t w = 0; w < walls.size(); w++) {
		const mca::WallPush& p = (*wallPushes)[w];
		if (dot(p.force, p.force) == 0 && dot(p.torque, p.torque) == 0) continue;
		if (!forcesAreReset)
			refuseBody(
				*walls[w],
				"automata touch it, and its forces would add up from step to step: put a ForceResetter first in O.engines, as YADE asks.");
		const Real share = wallStarts[w].mass > 0 ? kick : 1.;
		scene->forces.addForce(walls[w]->id, vector3(p.force) * share), scene->forces.addTorque(walls[w]->id, vector3(p.torque) * share);
		some = true;
	}
	// YADE's ForceResetter clears what has been summed over the threads, and its ServoPIDController reads the sums
	if (some) scene->forces.sync();
}

/// Contacts with walls, for the file.
void McaEngine::saveWalls()
{
	wallPairs.clear(), wallShears.clear();
	for (const auto& t : solver->wallTouches())
		wallPairs.push_back(t.automaton), wallPairs.push_back(t.wall), wallShears.push_back(vector3(t.shear));
}

/// From the file; throws mca::Error when they are none.
void McaEngine::loadWalls(mca::Automata& to) const
{
	vector<mca::WallTouch> list;
	bool                   good = wallPairs.size() == 2 * wallShears.size();
	for (size_t k = 0; good && k < wallShears.size(); k++) {
		list.push_back({ wallPairs[2 * k], wallPairs[2 * k + 1], point(wallShears[k]) });
		good = wallShears[k].allFinite() && list[k].wall >= 0 && to.holds(list[k].automaton);
		if (k) good &= list[k - 1].automaton < list[k].automaton || (list[k - 1].automaton == list[k].automaton && list[k - 1].wall < list[k].wall);
	}
	if (!good) throw mca::Error("McaEngine: the contacts with walls in the file are no pairs of its bodies; the file is damaged or was edited.");
	to.setWallTouches(list);
}
} // namespace yade
