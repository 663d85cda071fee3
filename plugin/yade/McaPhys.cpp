// SPDX-License-Identifier: GPL-2.0-or-later
#include "McaPhys.hpp"
#include "McaCast.hpp"
#include "McaVec.hpp"
#include <atomic>
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <kernels/automaton/contact.hpp>
#include <kernels/automaton/force.hpp>
#include <kernels/automaton/outline.hpp>
#include <kernels/automaton/volume.hpp>
#include <mutex>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/ScGeom.hpp>

namespace yade {
YADE_PLUGIN((McaPhys)(Ip2_McaMat_McaMat_McaPhys)(Ip2_FrictMat_McaMat_McaPhys)(Law2_ScGeom_McaPhys_Mca));

using mca::Lattice;
using mca::sqr;
using mca::VolumeRule;

bool McaPhys::linking = false;

bool McaPhys::pushes(int side, Real r2) const { return mca::pushes(r2, rest[side], d) > 0.; }

bool McaPhys::mayTouch(const Body& a, const McaLawState& la, const Body& b, const McaLawState& lb)
{
	return mca::mayTouch(la.flags, lb.flags, a.groupMask == b.groupMask);
}

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
	/// dx, dy from the first to the second body [m]
	Vector2r between(const Body& a, const Body& b)
	{
		return Vector2r(b.state->se3.position[0] - a.state->se3.position[0], b.state->se3.position[1] - a.state->se3.position[1]);
	}
	/// The pair overlaps though it was apart a step ago: it was looked for too late, and would start without push.
	void checkFound(const Scene& scene, const Body& a, const Body& b, Real d)
	{
		const Vector2r x = between(a, b), v(b.state->vel[0] - a.state->vel[0], b.state->vel[1] - a.state->vel[1]);
		if (a.iterBorn == scene.iter || b.iterBorn == scene.iter || !(x.norm() < d * (1. - 1e-9)) || (x - scene.dt * v).norm() < d) return;
		std::ostringstream s;
		s << "automata " << a.id << " and " << b.id << " were found only when they were " << x.norm() / d
		  << " diameters apart. Contacts must be known before they begin: Bo1_Sphere_Aabb needs aabbEnlargeFactor=1.4 and Ig2_Sphere_Sphere_ScGeom "
		     "interactionDetectionFactor=1.4 (scenes.law2Engines); "
		     "bodies faster than 0.4 diameters per step need a smaller O.dt.";
		McaPhys::leaveError(s.str());
	}
	mca::Tensor<Real> pushOf(const McaLawState& l) { return { l.txx, l.txy, l.tyx, l.tyy }; }
	mca::Vec<Real>    pushOfBoth(const mca::Tensor<Real>& A, const mca::Tensor<Real>& B, const McaLawState& a, const McaLawState& b, int slot)
	{
		return mca::pressurePush(A, B, mca::trianglesIn(a.flags), mca::trianglesIn(b.flags), slot);
	}
	std::mutex        errorLock;
	string            firstError;
	std::atomic<bool> anyError { false };
} // namespace

void McaPhys::postLoad(McaPhys&)
{
	if (slot < 0 || slot >= mca::nLinks)
		throw mca::Error(
			"McaPhys: slot = " + std::to_string(slot) + " in the file must be from 0 to " + std::to_string(mca::nLinks - 1)
			+ "; the file is damaged or was edited.");
}

void McaLawState::postLoad(McaLawState&)
{
	const auto known = mca::linkBits | mca::halfBits | mca::linkBits << mca::hadShift | mca::exposedBit | int(mca::outlineBits);
	bool       linked = true; // the triangles between links that hold
	for (int k = 0; k < mca::nLinks; k++)
		linked &= mca::holds(flags, k) || !mca::trianglesBeside(mca::trianglesIn(flags), k);
	if (!(partner.size() == size_t(mca::nLinks) || (partner.empty() && flags == 0)) || (flags & ~known) || !linked || rule < 0 || rule > 2)
		throw mca::Error("McaLawState: flags = " + std::to_string(flags) + ", rule = " + std::to_string(rule) + " and " + std::to_string(partner.size())
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

void McaPhys::setWall(const McaMat& m, Real otherAngle, Real diameter)
{
	const Real K = m.density * sqr(m.bulkSoundSpeed), width = Lattice::width(diameter);
	wall         = true;
	d            = diameter;
	kn           = (K + m.shearModulus * (4. / 3.)) * width * 2. / d;
	ks           = m.shearModulus * width * 2. / d;
	friction     = std::tan(std::min(m.frictionAngle, otherAngle));
}

// The functors' own pointer to the scene is stale where McaLaw makes the first links of a loaded scene: InteractionLoop has not run yet.
void Ip2_McaMat_McaMat_McaPhys::go(const shared_ptr<Material>& m1, const shared_ptr<Material>& m2, const shared_ptr<Interaction>& I)
{
	if (I->phys) return;
	const Scene&              now = *Omega::instance().getScene();
	const Body &              A = *now.bodies->body[size_t(I->getId1())], &B = *now.bodies->body[size_t(I->getId2())];
	const auto *              sa = castTo<Sphere>(A.shape.get()), *sb = castTo<Sphere>(B.shape.get());
	const shared_ptr<McaPhys> p(new McaPhys);
	I->phys = p;
	if (!sa || !sb) {
		const auto &a = static_cast<const McaMat&>(*m1), &b = static_cast<const McaMat&>(*m2);
		if (sa || sb) p->setWall(sa ? a : b, (sa ? b : a).frictionAngle, 2. * (sa ? sa : sb)->radius);
		return;
	}
	const Real da = 2. * sa->radius, db = 2. * sb->radius;
	p->d     = 0.5 * (da + db);
	p->arm = da / (da + db);
	const auto *la = lawState(A), *lb = lawState(B);
	if (!la || !lb || McaPhys::linking || !McaPhys::mayTouch(A, *la, B, *lb)) return; // McaLaw takes it from here, and gives the pair its constants
	checkFound(now, A, B, p->d);
	p->startContact(between(A, B).norm());
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
	if (sphere) p->setWall(*m, static_cast<const FrictMat&>(first ? *m2 : *m1).frictionAngle, 2. * sphere->radius);
}

namespace {
	bool wallForce(const ScGeom& g, McaPhys& p, const Body& A, const Body& B)
	{
		const bool touches = g.penetrationDepth > 0;
		p.force            = Vector3r::Zero();
		p.torque           = Vector2r::Zero();
		p.normalForce      = p.kn * std::max(g.penetrationDepth, Real(0)) * g.normal;
		g.rotate(p.shearForce);
		p.shearForce -= p.ks * g.shearInc;
		const Real most = p.friction * p.normalForce.norm(), now = p.shearForce.norm();
		if (now > most) p.shearForce *= most / now;
		if (!touches) {
			p.shearForce = Vector3r::Zero();
			return false;
		}
		p.force = -p.normalForce - p.shearForce;
		for (int side = 0; side < 2; side++) {
			const Vector3r arm = g.contactPoint - (side ? B : A).state->se3.position, f = side ? Vector3r(-p.force) : p.force;
			p.torque[side]     = arm[0] * f[1] - arm[1] * f[0];
		}
		return true;
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
	const McaLawState &a = *la, &b = *lb;
	const State &      sa = *A.state, &sb = *B.state;
	const mca::Vec<Real> r  = vec(sb.se3.position) - vec(sa.se3.position);
	const Real           r2 = dot(r, r), inv = 1. / r2;
	p.force = p.normalForce = p.shearForce = Vector3r::Zero();
	p.torque = Vector2r::Zero(), p.heatRate = 0, p.viscousForce = Vector2r::Zero();
	if (!p.linked && !(p.active && p.touching(r2))) return p.linked || r2 < sqr(range * p.d); // returning false erases the pair

	const Real            w = p.linked && p.half ? 0.5 : 1., area = mca::pairArea(w, p.d), along = dot(r, vec(sb.vel) - vec(sa.vel));
	const mca::Pair<Real> both { area * (p.s[0] + p.s[1]), area * (p.tau[0] + p.tau[1]) };
	const auto c = p.linked ? mca::ofLink({ p.viscLinear, p.viscQuadratic }, VolumeRule(a.rule)) : mca::PairViscosity { p.viscLinear, p.viscQuadratic };
	const Real q = w * mca::viscousCoefficient(along, inv, c.linear, c.quadratic, Lattice::width(p.d));
	mca::Vec<Real>        f = mca::dispatch(VolumeRule(a.rule), [&](auto rule) {
                const auto shape = [&](Real d) { return mca::pressureShape<mca::ofContacts(rule.value)>(d, inv); };
                if (!p.linked) {
                        const Real mine = p.pushes(0, r2) ? a.pressureShare * shape(p.rest[0]) : 0.;
                        const Real theirs = p.pushes(1, r2) ? b.pressureShare * shape(p.rest[1]) : 0.;
                        return mca::contactForce(r, both, inv, q, mine + theirs);
                }
                mca::Vec<Real> push; // of the pressures, to the first body its negative
                if (rule.value == VolumeRule::affine) push = pushOfBoth(pushOf(a), pushOf(b), a, b, p.slot);
                else push = r * (w * (a.pressureShare + b.pressureShare) * shape(p.d));
                return mca::linkForce(r, both.normal * inv + q, both.shear * inv, push);
        });
	p.force                 = vector3(f);
	p.torque      = Vector2r(mca::arm(a.diameter, b.diameter), mca::arm(b.diameter, a.diameter)) * both.shear;
	p.heatRate = q * along, p.viscousForce = vector3(r * q).head<2>();
	if (p.linked && VolumeRule(a.rule) == VolumeRule::affine) {
		p.viscousForce -= vector3(pushOfBoth(pushOf(a) * a.viscousShare, pushOf(b) * b.viscousShare, a, b, p.slot)).head<2>();
	}
	const Vector3r n = vector3(r * std::sqrt(inv));
	p.normalForce = -p.force.dot(n) * n;
	p.shearForce  = -p.force - p.normalForce;
	return true;
}
} // namespace yade
