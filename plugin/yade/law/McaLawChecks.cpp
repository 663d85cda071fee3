// SPDX-License-Identifier: GPL-2.0-or-later
// McaLaw: what it refuses before it computes. A script may change anything between steps, so all of this is looked at in every step, by comparing with what was
// found good.
#include "../McaBodies.hpp"
#include "../McaCast.hpp"
#include "McaLawRows.hpp"
#include <core/Scene.hpp>
#include <lib/base/Logging.hpp>
#include <pkg/common/Sphere.hpp>
#include <sdk/newton.hpp>

namespace yade {
namespace MCA_SPACE {
namespace {
	bool moves(const sdk::NewtonFacts& n, int groupMask) { return n.mask <= 0 || (n.mask & groupMask); }
	/// The axes about which automata turn: z alone in the plane.
	constexpr int firstTurn = 3 - mca::turns;
} // namespace

// What a body must have to be an automaton of this loop at all.
McaState& Loop::checkBody(const Scene& scene, const Body& b) const
{
	if (b.clumpId != Body::ID_NONE)
		refuse("body ", b.id, ": an automaton cannot be a member of a clump; automata of one body are linked (O.bodies.releaseFromClump).");
	if (b.subdomain != scene.subdomain || (b.flags & Body::FLAG_SUBDOMAIN))
		refuse("body ", b.id, " belongs to subdomain ", b.subdomain, " of yade.mpy; automata run in one process only.");
	if (!b.state) refuse("body ", b.id, ": state is None; give it a McaState (material.newAssocState()).");
	auto* m = castTo<McaState>(b.state.get());
	if (!m) refuse("body ", b.id, " has material McaMat but not a McaState; make its state with material.newAssocState().");
	const Vector3r &x = m->se3.position, &v = m->vel, &w = m->angVel;
	const auto      size = [](const Vector3r& a) { return std::fabs(a[0]) + std::fabs(a[1]) + std::fabs(a[2]); };
	const auto      need = [&](const char* what, const Vector3r& a, const char* unit) {
                if (!(size(a) < 1e300))
                        refuse("body ", b.id, ": ", what, " (", a[0], ", ", a[1], ", ", a[2], ") ", unit, " is not finite in step ", law.steps,
			            "; no force can be computed from it. Give finite numbers.");
	};
	if (size(x) + size(v) + size(w) < 1e300) return *m;
	need("position", x, "m"), need("velocity", v, "m/s"), need("angular velocity", w, "rad/s");
	refuse("body ", b.id, ": position, velocity or angular velocity is beyond 1e300.");
}

// A body whose material, shape or state was taken away must not drop out of the bodies that it is linked to.
void Loop::checkOther(const Body& b) const
{
	const auto* m = b.state ? castTo<const McaState>(b.state.get()) : nullptr;
	const char* lacks = !b.material || !castTo<const McaMat>(b.material.get()) ? "no McaMat" : !b.shape ? "no shape" : "no Sphere as its shape";
	if (m && m->law) refuse("body ", b.id, " was an automaton and has now ", lacks, ". Give it back, or erase the body (O.bodies.erase).");
	if (!b.material && b.shape && b.isBounded())
		refuse("body ", b.id, " has a shape but no material: InteractionLoop aborts where something touches it. Give it one, or erase it.");
	if (b.material && !b.shape && castTo<const McaMat>(b.material.get()))
		refuse("body ", b.id, " has material McaMat but no shape; give it a Sphere, or another material.");
}

// An automaton that is new here has its state of rest computed from its neighbours: what another loop or the script has left in it would be lost.
void Loop::checkUntouched(const Row& r) const
{
	const McaState& m = *r.m;
	if (m.links > 0 || m.brokenLinks > 0)
		refuse("body ", r.id, ": state.links = ", m.links, ", brokenLinks = ", m.brokenLinks,
		       ", so McaEngine has moved it before; McaLaw would drop its stresses and heal its broken links. Go on with McaEngine, or make the bodies "
		       "anew.");
	const auto need = [&](const char* name, Real value, Real rest, const char* unit) {
		if (value != rest)
			refuse("body ", r.id, ": state.", name, " = ", value, unit,
			       " before its first step is a result of the law and cannot be given; set it to ", rest,
			       ". plasticStrain, temperature and strength can.");
	};
	if (m.mirrors != 0)
		refuse("body ", r.id, ": state.mirrors = ", m.mirrors, " must be 0: planes of symmetry are of bodies in space that McaEngine moves; McaLaw ",
		       mca::dim == 2 ? "has these in plane strain." : "takes whole bodies. Make them without mirror=, or use McaEngine.");
	if (!(std::fabs(m.se3.orientation.coeffs().squaredNorm() - 1.) < 0.1))
		refuse("body ", r.id, ": ori is no rotation; it must be a quaternion of norm 1.");
	need("pressure", m.pressure, 0, " Pa"), need("volumeRatio", m.volumeRatio, 1, ""), need("stressZZ", m.stressZZ, 0, " Pa"),
		need("equivalentStress", m.equivalentStress, 0, " Pa");
}

// What a script may have changed in an automaton that goes on.
void Loop::checkState(const Row& r) const
{
	const McaState&    m = *r.m;
	const McaLawState& l = *r.l;
	if (l.rule != int(rule())) {
		const char* names[] = { "affine", "inversePower", "meanDistance" };
		refuse("McaLaw: volumeRule = '", law.volumeRule, "', but the links of body ", r.id, " were made with '", names[l.rule],
		       "'; the rule can be chosen before the first step only. Set it back.");
	}
	if (r.d != l.diameter)
		refuse("body ", r.id, ": radius was ", 0.5 * l.diameter, " m when it was taken in and is now ", 0.5 * r.d,
		       "; links keep their rest distance. Set it back, or erase the body and add another.");
	// heavier is slower, lighter would be beyond the stable step
	const Real rho = r.material->eos.rho0, least = 0.999 * l.cell * rho, most = 2. * rho * mca::Lattice::cell(r.d);
	if (!(m.mass >= least && m.mass <= most))
		refuse("body ", r.id, ": mass ", m.mass, perThickness(" kg/m", " kg"), " must be from ", l.cell * rho, " (density times the ",
		       perThickness("area", "volume"), " it stands for) to ", most,
		       " (two full cells); a lighter one is not stable at the step that its links allow.");
	if (mca::dim == 3 && !(m.inertia[0] == m.inertia[2] && m.inertia[1] == m.inertia[2]))
		refuse("body ", r.id, ": inertia (", m.inertia[0], ", ", m.inertia[1], ", ", m.inertia[2],
		       ") kg m2 must be the same about all axes, that of a sphere.");
	for (int axis = firstTurn; axis < 3; axis++)
		if (freeTurns(m)[size_t(axis)] && !(m.inertia[axis] > 0 && std::isfinite(m.inertia[axis])))
			refuse("body ", r.id, ": inertia ", m.inertia[axis], perThickness(" kg m", " kg m2"),
			       " must be finite and above zero, or block the rotation.");
	const auto need = [&](const char* name, Real value, bool ok, const char* range) {
		if (!ok) refuse("body ", r.id, ": state.", name, " = ", value, " must be ", range, ".");
	};
	if (m.mirrors != 0) refuse("body ", r.id, ": state.mirrors = ", m.mirrors, " was changed; it must be 0: planes of symmetry are of McaEngine.");
	if (m.triangles != l.triangles)
		refuse("body ", r.id, ": state.triangles = ", m.triangles, " was changed (from ", l.triangles,
		       "); where a body ends is found when it is taken in. Set it back.");
	need("strength", m.strength, m.strength > 0 && m.strength <= 1e9, "above 0 and at most 1e9");
	need("plasticStrain", m.plasticStrain, m.plasticStrain >= 0 && m.plasticStrain <= 1e6, "from 0 to 1e6");
	need("damage", m.damage, m.damage >= 0 && m.damage <= 1e6, "from 0 to 1e6");
	need("damage", m.damage, m.damage == 0 || r.material->fracture.damage.active(), "0: its material has no damageModel");
	need("temperature", m.temperature, m.temperature >= 0 && m.temperature <= 1e9, "from 0 to 1e9 [K]");
	need("dissipated", m.dissipated, m.dissipated >= 0 && m.dissipated < 1e30, "not negative and below 1e30 [J/kg]");
	need("pressure", m.pressure, std::isfinite(m.pressure), "finite");
	need("volumeRatio", m.volumeRatio, m.volumeRatio > 0 && std::isfinite(m.volumeRatio), "finite and above zero");
	need("stressZZ", m.stressZZ, std::isfinite(m.stressZZ), "finite");
	const Real size = l.deviator.norm(), round = 1e-6 * size + 1e-12 * r.material->eos.bulkModulus();
	const bool symmetric = l.deviator == l.deviator.transpose() && std::fabs(l.deviator.trace()) <= round;
	need("law.deviator", size, std::isfinite(size) && symmetric, "finite, symmetric and without a trace");
	const auto result = [&](const char* name, Real value, Real was) {
		if (l.moved > 0 && value != was)
			refuse("body ", r.id, ": state.", name, " was set to ", value, " (it was ", was,
			       "); it is a result of the law and cannot be prescribed. Set it back.");
	};
	result("pressure", m.pressure, l.results[0]), result("volumeRatio", m.volumeRatio, l.results[1]), result("stressZZ", m.stressZZ, l.results[2]);
}

// The stock collider skips two bodies whose masks have no bit in common, and NewtonIntegrator those without a bit of its own mask.
void Loop::checkMasks(const MaskTable& automata, const MaskTable& others)
{
	vector<std::pair<Real, int>> facts;
	for (const Engine* n : law.integrators()) {
		const auto f = sdk::newtonFacts(*n);
		facts.emplace_back(f.damping, f.mask);
		if (f.damping == 0) continue;
		for (const Row& r : rows)
			if (r.m->isDamped && moves(f, r.mask))
				refuse("NewtonIntegrator.damping = ", f.damping, " would damp body ", r.id,
				       ", an automaton, against the motion of the whole; its law has viscosity of its own. Set damping=0, or "
				       "state.isDamped=False for automata.");
	}
	const auto same = [](const MaskTable& a, const MaskTable& b) {
		return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const auto& p, const auto& q) { return p.first == q.first; });
	};
	const bool sameMasks = same(automata, automataGood) && same(others, othersGood);
	if (facts == newtonsGood && sameMasks) return;
	for (const auto& [mask, id] : automata) {
		int n = 0;
		for (const auto& f : facts)
			n += moves({ f.first, f.second }, mask);
		if (n != 1)
			refuse("body ", id, ", an automaton of mask ", mask, ", is moved by ", n ? std::to_string(n) : "no", " NewtonIntegrator", n ? "s" : "",
			       "; it must be one. See NewtonIntegrator.mask (", facts[0].second, "; -1: all bodies).");
		if (mask == 0) refuse("body ", id, ", an automaton, has mask 0: YADE's collider finds no contact for it. Give it a mask, e.g. 1.");
		for (const auto& [mask2, id2] : automata)
			if (mask2 > mask && !(mask & mask2))
				refuse("bodies ", id, " (mask ", mask, ") and ", id2, " (mask ", mask2,
				       ") are automata whose masks have no bit in common: YADE's collider skips such pairs, and they would pass through each "
				       "other. "
				       "Give them masks that differ but share a bit, e.g. 1 and 3.");
	}
	for (const auto& [mask, id] : others)
		for (const auto& [mask2, id2] : automata)
			if (!(mask & mask2) && !sameMasks)
				LOG_WARN(
					"body " << id << " (mask " << mask << ") and automaton " << id2 << " (mask " << mask2
						<< ") have no bit in common in their masks: YADE lets them pass through each other.");
	newtonsGood = facts, automataGood = automata, othersGood = others;
}
} // namespace MCA_SPACE
} // namespace yade
