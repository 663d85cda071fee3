// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaPhys.hpp"
#include "McaCast.hpp"
#include "McaVec.hpp"
#include <atomic>
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <kernels/automaton/contact.hpp>
#include <kernels/automaton/links.hpp>
#include <kernels/wall.hpp>
#include <mutex>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/ScGeom.hpp>

namespace yade {
YADE_PLUGIN((McaPhys)(Ip2_McaMat_McaMat_McaPhys)(Ip2_FrictMat_McaMat_McaPhys)(Law2_ScGeom_McaPhys_Mca));

using mca::sqr;

namespace plane {
	const McaPairLaw& pairLaw();
}
namespace space {
	const McaPairLaw& pairLaw();
}
const McaPairLaw& McaPairLaw::in(int dimension) { return dimension == 3 ? space::pairLaw() : plane::pairLaw(); }

bool McaPhys::linking = false;

bool McaPhys::pushes(int side, Real r2) const { return mca::pushes(r2, rest[side], d) > 0.; }

void McaPhys::startContact(Real r)
{
	active = true;
	rest   = Vector2r::Constant(std::min(d, r));
}

namespace {
	/// The working state if the body is an automaton, else null.
	McaLawState* lawState(const Body& b)
	{
		auto* m = castTo<McaState>(b.state.get());
		return m && castTo<Sphere>(b.shape.get()) ? m->law.get() : nullptr;
	}
	/// Of the automaton of a pair.
	int dimensionOf(const McaLawState* a, const McaLawState* b) { return a ? a->dimension : b ? b->dimension : 2; }
	/// From the first to the second body [m], or the difference of their velocities; in the plane x, y.
	Vector3r inSpace(Vector3r x, int dimension)
	{
		if (dimension == 2) x[2] = 0;
		return x;
	}
	Vector3r between(const Body& a, const Body& b, int dimension) { return inSpace(b.state->se3.position - a.state->se3.position, dimension); }
	/// The pair overlaps though it was apart a step ago: it was looked for too late, and would start without push.
	void checkFound(const Scene& scene, const Body& a, const Body& b, Real d, int dimension)
	{
		const Vector3r x = between(a, b, dimension), v = inSpace(b.state->vel - a.state->vel, dimension);
		if (a.iterBorn == scene.iter || b.iterBorn == scene.iter || !(x.norm() < d * (1. - 1e-9)) || (x - scene.dt * v).norm() < d) return;
		std::ostringstream s;
		s << "automata " << a.id << " and " << b.id << " were found only when they were " << x.norm() / d
		  << " diameters apart. Contacts must be known before they begin: Bo1_Sphere_Aabb needs aabbEnlargeFactor=1.4 and Ig2_Sphere_Sphere_ScGeom "
		     "interactionDetectionFactor=1.4 (scenes.law2Engines); "
		     "bodies faster than 0.4 diameters per step need a smaller O.dt.";
		McaPhys::leaveError(s.str());
	}
	std::mutex        errorLock;
	string            firstError;
	std::atomic<bool> anyError { false };
} // namespace

void McaPhys::postLoad(McaPhys&)
{
	const int most = McaPairLaw::in(3).links() - 1;
	const bool holds = bondFirst > 0 && bondLast > bondFirst && bondMost >= bondFirst && bondStiffness > 0;
	if (bonded() && !(holds && std::isfinite(bondLast + bondStiffness + bondMost + bondRest)))
		throw mca::Error("McaPhys: the cohesion of a broken pair in the file is none; the file is damaged or was edited.");
	if (slot < 0 || slot > most)
		throw mca::Error(
			"McaPhys: slot = " + std::to_string(slot) + " in the file must be from 0 to " + std::to_string(most)
			+ "; the file is damaged or was edited.");
}

void McaLawState::postLoad(McaLawState&)
{
	const bool known = dimension == 2 || dimension == 3, none = partner.empty() && flags == 0;
	if (!known || !(none || McaPairLaw::in(dimension).fits(*this)) || rule < 0 || rule > 2)
		throw mca::Error("McaLawState: dimension = " + std::to_string(dimension) + ", flags = " + std::to_string(flags) + ", rule = "
		                 + std::to_string(rule) + " and " + std::to_string(partner.size())
		                 + " partners in the file are no links of an automaton; the file is damaged or was edited.");
}

void McaPhys::leaveError(const string& what)
{
	const std::lock_guard<std::mutex> lock(errorLock);
	if (!anyError) firstError = what;
	anyError = true;
}

string McaPhys::takeError()
{
	if (!anyError) return "";
	const std::lock_guard<std::mutex> lock(errorLock);
	anyError = false;
	return std::move(firstError);
}

void McaPhys::setWall(const McaMat& m, Real otherAngle, Real diameter, int dimension)
{
	const mca::WallStiffness k(m.density * sqr(m.bulkSoundSpeed), m.shearModulus, McaPairLaw::in(dimension).width(diameter), diameter);
	wall         = true;
	d            = diameter;
	kn           = k.normal;
	ks           = k.shear;
	friction     = std::tan(std::min(m.frictionAngle, otherAngle));
}

// The functors' own pointer to the scene is stale where McaLaw makes the first links of a loaded scene: InteractionLoop has not run yet.
void Ip2_McaMat_McaMat_McaPhys::go(const shared_ptr<Material>& m1, const shared_ptr<Material>& m2, const shared_ptr<Interaction>& I)
{
	if (I->phys) return;
	const Scene&              now = *Omega::instance().getScene();
	const Body &              A = *now.bodies->body[size_t(I->getId1())], &B = *now.bodies->body[size_t(I->getId2())];
	const auto *              sa = castTo<Sphere>(A.shape.get()), *sb = castTo<Sphere>(B.shape.get());
	const auto *              la = lawState(A), *lb = lawState(B);
	const shared_ptr<McaPhys> p(new McaPhys);
	I->phys = p;
	if (!sa || !sb) {
		const auto &a = static_cast<const McaMat&>(*m1), &b = static_cast<const McaMat&>(*m2);
		if (sa || sb) p->setWall(sa ? a : b, (sa ? b : a).frictionAngle, 2. * (sa ? sa : sb)->radius, dimensionOf(la, lb));
		return;
	}
	const Real da = 2. * sa->radius, db = 2. * sb->radius;
	p->d     = 0.5 * (da + db);
	p->arm = da / (da + db);
	// McaLaw takes it from here, and gives the pair its constants
	if (!la || !lb || McaPhys::linking || !McaPairLaw::in(la->dimension).mayTouch(A, *la, B, *lb)) return;
	checkFound(now, A, B, p->d, la->dimension);
	p->startContact(between(A, B, la->dimension).norm());
}

// The loop does not swap materials: it calls go() with the automaton first, too.
void Ip2_FrictMat_McaMat_McaPhys::go(const shared_ptr<Material>& m1, const shared_ptr<Material>& m2, const shared_ptr<Interaction>& I)
{
	if (I->phys) return;
	const Scene&              now   = *Omega::instance().getScene();
	const auto *              first = castTo<const McaMat>(m1.get()), *m = first ? first : castTo<const McaMat>(m2.get());
	const Body&               automaton = *now.bodies->body[size_t(now.bodies->body[size_t(I->getId1())]->material.get() == m ? I->getId1() : I->getId2())];
	const auto*               sphere    = castTo<Sphere>(automaton.shape.get());
	const shared_ptr<McaPhys> p(new McaPhys);
	I->phys = p;
	const Real angle = static_cast<const FrictMat&>(first ? *m2 : *m1).frictionAngle;
	if (sphere) p->setWall(*m, angle, 2. * sphere->radius, dimensionOf(lawState(automaton), nullptr));
}

namespace {
	bool wallForce(const ScGeom& g, McaPhys& p, const Body& A, const Body& B)
	{
		const auto torque = [&](const Body& b, const Vector3r& force) {
			const Vector3r whole = (g.contactPoint - b.state->se3.position).cross(force);
			return dimensionOf(lawState(A), lawState(B)) == 3 ? whole : Vector3r(0, 0, whole[2]);
		};
		const bool touches = g.penetrationDepth > 0;
		p.force            = Vector3r::Zero();
		p.torque = p.torqueOther = Vector3r::Zero();
		p.normalForce      = p.kn * std::max(g.penetrationDepth, Real(0)) * g.normal;
		g.rotate(p.shearForce);
		p.shearForce -= p.ks * g.shearInc;
		p.shearForce *= mca::frictionShare(p.shearForce.norm(), p.friction * p.normalForce.norm());
		if (!touches) {
			p.shearForce = Vector3r::Zero();
			return false;
		}
		p.force = -p.normalForce - p.shearForce;
		p.torque = torque(A, p.force), p.torqueOther = torque(B, -p.force);
		return true;
	}
} // namespace

namespace {
	/// Cohesion beside what the pair does as a contact; n: from the first to the second body.
	void addPull(McaPhys& p, const Vector3r& n)
	{
		p.force += p.pull, p.torque += p.pullTorque, p.torqueOther += p.pullTorqueOther;
		p.normalForce = -p.force.dot(n) * n;
		p.shearForce  = -p.force - p.normalForce;
	}
} // namespace

bool Law2_ScGeom_McaPhys_Mca::go(shared_ptr<IGeom>& geom, shared_ptr<IPhys>& phys, Interaction* I)
{
	auto& p = static_cast<McaPhys&>(*phys);
	if (!(range >= 1.1 && range <= 10)) {
		McaPhys::leaveError("Law2_ScGeom_McaPhys_Mca in O.engines: range = " + std::to_string(range) + " must be from 1.1 to 10.");
		return true;
	}
	const Body &A = *scene->bodies->body[I->getId1()], &B = *scene->bodies->body[I->getId2()];
	if (p.wall) return wallForce(static_cast<const ScGeom&>(*geom), p, A, B);

	const McaLawState *la = lawState(A), *lb = lawState(B);
	if (!la || !lb) { // a file that was edited
		McaPhys::leaveError(
			"bodies " + std::to_string(A.id) + " and " + std::to_string(B.id)
			+ " have the contact of two automata but are not both automata; the saved file was edited or damaged.");
		return true;
	}
	const Real r2 = between(A, B, la->dimension).squaredNorm();
	p.force = p.normalForce = p.shearForce = p.torque = p.torqueOther = p.viscousForce = Vector3r::Zero();
	p.heatRate = 0;
	const bool acts = p.linked || (p.active && p.touching(r2));
	if (acts) McaPairLaw::in(la->dimension).force(p, *A.state, *la, *B.state, *lb);
	if (p.pull != Vector3r::Zero()) addPull(p, between(A, B, la->dimension).normalized());
	return acts || p.bonded() || r2 < sqr(range * p.d); // returning false erases the pair
}
} // namespace yade
