// SPDX-License-Identifier: GPL-2.0-or-later
// McaDensity: volume, pressure, pair stresses and yield of one automaton, from its neighbours. The formulas of plugin/automata, one automaton at a time.
#include "McaDensity.hpp"

namespace yade {
using mca::fma;
using mca::Lattice;
using mca::sqr;
using mca::VolumeRule;
using mca::automata::halfShift;
using mca::automata::nLinks;

namespace {
	/// f(rule as a compile-time constant)
	template <class F> Real withRule(int rule, F&& f)
	{
		if (rule == int(VolumeRule::meanDistance)) return f(std::integral_constant<VolumeRule, VolumeRule::meanDistance>());
		return f(std::integral_constant<VolumeRule, VolumeRule::inversePower>());
	}
	Real volumeTerm(int rule, Real d, Real r2)
	{
		return withRule(rule, [&](auto r) { return mca::volumeTerm<r.value, 2>(d, r2); });
	}
	Real pressureShape(int rule, Real d, Real inv)
	{
		return withRule(rule, [&](auto r) { return mca::pressureShape<r.value, 2>(d, inv); });
	}
	Real pressureShare(int rule, Real P, Real J, Real omegaPerN)
	{
		return withRule(rule, [&](auto r) { return mca::pressureShare<r.value, 2>(P, J, omegaPerN); });
	}
	Vector2r vectorTo(const State& a, const State& b) { return Vector2r(b.se3.position[0] - a.se3.position[0], b.se3.position[1] - a.se3.position[1]); }
} // namespace

// Volume terms of the contacts; a pair that had come into contact already closer than d gets its rest distance back as it parts.
void McaDensity::contactVolume(Row& r)
{
	Real sum         = 0;
	r.nearestContact = 1;
	for (int c = r.firstContact; c < r.lastContact; c++) {
		const Side& s  = contacts[size_t(c)];
		McaPhys&    p  = *s.p;
		const Real  r2 = vectorTo(*r.state, *rows[size_t(s.other)].state).squaredNorm(), rest = p.rest[s.side];
		if (p.pushes(s.side, r2)) {
			sum += volumeTerm(r.l->rule, rest, r2);
			r.nearestContact = std::min(r.nearestContact, r2 / sqr(rest));
		}
		if (!(r2 < sqr(rest))) p.rest[s.side] = std::min(std::sqrt(r2), p.d);
	}
	r.l->contactSum = sum;
}

void McaDensity::volume(Row& r, bool withContacts)
{
	McaLawState&     l      = *r.l;
	const mca::Eos&  eos    = r.material->eos;
	const bool       affine = l.rule == int(VolumeRule::affine);
	const Real       d2 = sqr(r.d), perArea = 1. / (9. * d2), G43 = r.material->G * (4. / 3.), Jo = r.m->volumeRatio;
	Real             Fxx = 0, Fxy = 0, Fyx = 0, Fyy = 0, r2min = 1e300, exx = 0, exy = 0, eyy = 0, sum = 0;
	for (int k = 0; k < nLinks; k++) {
		if (!r.link[k].p) {
			r2min = std::min(r2min, d2);
			continue;
		}
		const Vector2r x  = vectorTo(*r.state, *rows[size_t(r.link[k].other)].state);
		const Real     r2 = x.squaredNorm(), ex = mca::linkX[k], ey = mca::linkY[k], w = (l.flags >> (halfShift + k)) & 1 ? 0.5 : 1.;
		r2min             = std::min(r2min, r2);
		Fxx += ex * x[0], Fyx += ex * x[1], Fxy += ey * x[0], Fyy += ey * x[1];
		exx += ex * ex, exy += ex * ey, eyy += ey * ey;
		if (!affine) sum += w * volumeTerm(l.rule, r.link[k].p->d, r2);
	}
	Real Jn;
	if (affine) {
		const Real det = (Fxx * Fyy - Fxy * Fyx) * perArea;
		Jn             = l.offset > 0 ? l.offset * det : 1. / (1. + (withContacts ? l.contactSum * (1. / nLinks) : 0.));
	} else {
		const Real mean = ((withContacts ? sum + l.contactSum : sum) - l.rest) * l.invN;
		Jn              = withRule(l.rule, [&](auto rule) { return mca::volumeRatio<rule.value, 2>(mean); });
	}
	const Real eps = Jn - 1.;
	l.dTheta       = 2. * (Jn - Jo) / (Jn + Jo);
	Real P         = mca::pressure(eos, eps);
	if (eos.heats()) { // contacts push by the cold curve alone: so does an automaton without links work, and its internal energy keeps the rest
		if (!affine || l.offset > 0) P = mca::pressureWithWork(eos, eps, Jn - Jo, r.m->pressure, r.m->dissipated);
		else r.m->dissipated -= 0.5 * (r.m->pressure + P) * (Jn - Jo) / eos.rho0;
	}
	r.m->volumeRatio = Jn, r.m->pressure = P;
	r.clampedNow  = mca::clamped(eos, eps);
	r.bad         = !(Jn > 0. && Jn < 1e6);
	r.nearestLink = r2min / d2;
	Real stiff    = (mca::tangent(eos, eps) + G43) / (eos.rho0 * Jn);
	if (affine) {
		const Real a = l.offset * perArea * P * l.cell; // push on link k: a cof(F) e_k
		l.txx = a * Fyy, l.txy = -a * Fyx, l.tyx = -a * Fxy, l.tyy = a * Fxx;
		// stiffer than in the perfect packing: the volume by the sum of (dJ/dx_k)^2, the pair law by the closest link
		const Real spread = exx * (sqr(Fyy) + sqr(Fyx)) - 2. * exy * (Fyy * Fxy + Fyx * Fxx) + eyy * (sqr(Fxy) + sqr(Fxx));
		const Real one = std::max(l.offset * l.offset * spread * perArea * (1. / 6.), 1.), bulk = std::max(std::min(one * one, 4.), one);
		stiff          = (mca::tangent(eos, eps) * bulk + G43 * std::max(0.5 * d2 / r2min, 1.)) / (eos.rho0 * Jn);
		if (withContacts) { // contacts have a volume of their own
			const Real Jc = 1. / (1. + l.contactSum * (1. / nLinks)), ec = Jc - 1.;
			l.share       = pressureShare(int(VolumeRule::inversePower), mca::pressure(eos, ec), Jc, l.cell * (1. / nLinks));
			stiff         = std::max(stiff, (mca::tangent(eos, ec) + G43) / (eos.rho0 * Jc));
		}
	} else
		l.share = pressureShare(l.rule, P, Jn, l.cell * l.invN);
	r.stiff = stiff, r.closing = lastMove > 0 ? std::max(-l.dTheta, Real(0)) * r.d / lastMove : 0.;
}

// Trial stresses (7)-(9) of this side of all pairs, radial return (10)-(11), fracture criteria, friction.
void McaDensity::stress(Row& r)
{
	McaLawState&         l = *r.l;
	McaState&            m = *r.m;
	const mca::Material& material = *r.material;
	const Real           J = m.volumeRatio, dt = lastMove, threeG = 3. * material.G, perOldJ = (2. + l.dTheta) / ((2. - l.dTheta) * J);
	Real                 square = 0, squareOld = 0, oldNew = 0, coupleOld = 0, coupleNew = 0, fromContacts = 0;
	r.plastic = r.coupling = r.friction = r.heated = 0;

	const auto trial = [&](const Side& s, Real twoG) { // this side's stresses before yield; returns dtheta of the pair
		const Row&     o = rows[size_t(s.other)];
		const Vector2r x = vectorTo(*r.state, *o.state);
		const Real     q = s.side ? 1. - s.p->share : s.p->share, on = r.fresh || o.fresh ? 0. : dt, spin = (r.motion[2] * q + o.motion[2] * (1. - q)) * on;
		const auto     e = mca::strainIncrement(x[0], x[1], (o.motion[0] - r.motion[0]) * on, (o.motion[1] - r.motion[1]) * on, spin);
		const Real     dth   = (l.dTheta + o.l->dTheta) * (1. / 6.);
		s.p->s[s.side]       = fma(twoG, e.normal - dth, s.p->s[s.side] * perOldJ);
		s.p->tau[s.side]     = fma(twoG, e.shear, s.p->tau[s.side] * perOldJ);
		return dth;
	};
	for (int k = 0; k < nLinks; k++) {
		const Side& s = r.link[k];
		if (!s.p) continue;
		const Real w = (l.flags >> (halfShift + k)) & 1 ? 0.5 : 1., so = s.p->s[s.side] * perOldJ, to = s.p->tau[s.side] * perOldJ, dth = trial(s, s.p->twoG);
		const Real sn = s.p->s[s.side], tn = s.p->tau[s.side];
		square += w * fma(sn, sn, tn * tn);
		squareOld += w * fma(so, so, to * to), oldNew += w * fma(so, sn, to * tn), coupleOld += w * so * dth, coupleNew += w * sn * dth;
	}
	vector<Vector2r> heldBefore; // stresses of the contacts before the step [Pa]
	for (int c = r.firstContact; c < r.lastContact; c++) {
		const Side& s = contacts[size_t(c)];
		McaPhys&    p = *s.p;
		const Real  r2 = vectorTo(*r.state, *rows[size_t(s.other)].state).squaredNorm();
		heldBefore.emplace_back(p.s[s.side] * perOldJ, p.tau[s.side] * perOldJ);
		if (p.touching(r2)) {
			trial(s, p.twoG);
			fromContacts += fma(p.s[s.side], p.s[s.side], p.tau[s.side] * p.tau[s.side]);
			oldNew += heldBefore.back().dot(Vector2r(p.s[s.side], p.tau[s.side]));
		} else
			p.s[s.side] = p.tau[s.side] = 0;
	}
	square += fromContacts;

	const Real zo = m.stressZZ, zn = fma(-2. * material.G * (1. / 3.), l.dTheta, zo);
	const Real sigma = std::sqrt(mca::equivalentStress2<2>(square * l.invN, zn));
	mca::Return back { 1., 0. };
	mca::dispatch(material.yield.kind, [&](auto kind) { back = mca::radialReturn<kind.value>(material.yield, sigma, m.plasticStrain, m.temperature, threeG, dt); });
	m.stressZZ = zn * back.scale;
	m.plasticStrain += back.dEqps;
	if (material.yield.heats()) m.temperature = fma(material.yield.heatPerWork * back.scale * sigma, back.dEqps, m.temperature);
	if (material.eos.heats()) {
		const Real q = J * back.scale * sigma * back.dEqps / material.eos.rho0;
		m.dissipated += q;
		r.heated = q * l.cell * material.eos.rho0;
	}
	const Real before = std::sqrt(mca::equivalentStress2<2>(squareOld * l.invN, zo));
	// the stress before the step along the direction of flow: the two need not be parallel
	const Real along  = sigma > 0 ? (3. * oldNew * l.invN + 1.5 * zo * zn) / sigma : 0.;
	const Real pairs  = Lattice<2>::cell(r.d) / (nLinks * l.invN); // volume the pairs stand for: the cell, but on weighted rims
	r.plastic         = pairs * J * 0.5 * (along + sigma * back.scale) * back.dEqps;
	const Real vol    = (coupleOld + back.scale * coupleNew) * l.invN + 0.5 * (zo + m.stressZZ) * l.dTheta * (1. / 3.);
	r.coupling        = pairs * J * (vol - (threeG > 0 ? l.dTheta * before * before / (2. * threeG) : 0.));

	const Real scale = back.scale * J;
	for (const Side& s : r.link)
		if (s.p) s.p->s[s.side] *= scale, s.p->tau[s.side] *= scale;
	for (int c = r.firstContact; c < r.lastContact; c++) { // contacts: no tension, Coulomb friction
		const Side& s   = contacts[size_t(c)];
		McaPhys&    p   = *s.p;
		const Row&  o   = rows[size_t(s.other)];
		const Real  r2  = vectorTo(*r.state, *o.state).squaredNorm(), inv = 1. / r2, a = p.rest[s.side], b = p.rest[1 - s.side];
		const Real  pr  = (p.pushes(s.side, r2) ? l.share * pressureShape(l.rule, a, inv) : 0.) + (p.pushes(1 - s.side, r2) ? o.l->share * pressureShape(l.rule, b, inv) : 0.);
		const Real  most = pr * r2 / (Lattice<2>::width(p.d) * p.d), st = p.s[s.side] * J, tt = p.tau[s.side] * J, s0 = p.s[s.side] * scale, t0 = p.tau[s.side] * scale;
		const Real  sn = std::min(s0, most), tMax = p.friction * (most - sn), tn = std::min(std::max(t0, -tMax), tMax);
		p.s[s.side] = sn, p.tau[s.side] = tn;
		// account, this side's half: taken out at the mean of the stresses before and after the step; a pair that parts loses what it still held
		const Real area = 0.5 * Lattice<2>::width(p.d) * p.d, perG = p.twoG > 0 ? 0.5 * area / p.twoG / J : 0.;
		const Real so = heldBefore[size_t(c - r.firstContact)][0] * J, to = heldBefore[size_t(c - r.firstContact)][1] * J, held = perG * fma(so, so, to * to);
		const bool on = p.touching(r2);
		r.friction += on ? perG * ((so + sn) * (s0 - sn) + (to + tn) * (t0 - tn)) : held;
		// the radial return took (so + sn)(st - s0) with the stiffness of the pair; booked as plastic with the links: (so + s0)(st - s0) with the owner's own
		const Real perOwn = material.G > 0 ? 0.25 * area / material.G / J : 0.;
		if (on) r.plastic += (perG * (so + sn) - perOwn * (so + s0)) * (st - s0) + (perG * (to + tn) - perOwn * (to + t0)) * (tt - t0);
		if (on) r.coupling += area * 0.5 * (so + sn) * (l.dTheta + o.l->dTheta) * (1. / 6.) - l.dTheta * held;
	}
	const Real eq2     = fma(3. * sqr(back.scale), square * l.invN, 1.5 * sqr(m.stressZZ));
	m.equivalentStress = std::sqrt(eq2);
	const auto& f      = material.fracture;
	if (!f.active()) return;
	const Real two = 0.5 * (f.ratio + 1.) * std::sqrt(eq2) - 1.5 * (f.ratio - 1.) * m.pressure;
	l.criterion    = std::max({ m.plasticStrain / f.strain, -m.pressure / f.spall, two / f.mises }) / m.strength;
}
} // namespace yade
