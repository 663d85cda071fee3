// SPDX-License-Identifier: GPL-2.0-or-later
#include "contacts.hpp"
#include <algorithm>

namespace mca::automata {
namespace {
	constexpr long parallelFrom = 2048; ///< half-contacts below which waking a thread costs more than it brings
	/// Sum of a quantity over each row, in the order of the row.
	void addRows(const Contacts& C, const std::vector<double>& from, std::vector<double>& to)
	{
		const long n = long(C.rows());
#pragma omp parallel for schedule(static) if (long(C.size()) >= parallelFrom)
		for (long r = 0; r < n; r++) {
			double sum = 0;
			for (int32_t c = C.rowBegin[r]; c < C.rowBegin[r + 1]; c++)
				sum += from[c];
			to[C.rowOwner[r]] = sum;
		}
	}
	bool touching(const Contacts& C, size_t c, double r2) { return pushes(C, c, r2) || pushes(C, C.reverse[c], r2); }
	/// (6) of both sides, each with its own rest distance: push over the vector from owner to other [N/m2]
	double push(const Store& S, const Contacts& C, size_t c, VolumeRule rule, double r2)
	{
		const size_t r = C.reverse[c];
		const double inv = 1. / r2, a = C.rest[c], b = C.rest[r];
		const double sa = rule == VolumeRule::meanDistance ? pressureShape<VolumeRule::meanDistance, 2>(a, inv) : pressureShape<VolumeRule::inversePower, 2>(a, inv);
		const double sb = rule == VolumeRule::meanDistance ? pressureShape<VolumeRule::meanDistance, 2>(b, inv) : pressureShape<VolumeRule::inversePower, 2>(b, inv);
		return (pushes(C, c, r2) ? S.h[C.owner[c]] * sa : 0.) + (pushes(C, r, r2) ? S.h[C.other[c]] * sb : 0.);
	}
	double distance2(const Store& S, const Contacts& C, size_t c, double& dx, double& dy)
	{
		dx = S.x[C.other[c]] - S.x[C.owner[c]], dy = S.y[C.other[c]] - S.y[C.owner[c]];
		return fma(dx, dx, dy * dy);
	}
}

double contactDensity(const Store& S, Contacts& C, VolumeRule rule, ContactScratch& out, size_t& closest)
{
	const long n = long(C.size());
#pragma omp parallel for simd schedule(static) if (n >= parallelFrom)
	for (long c = 0; c < n; c++) {
		double       dx, dy;
		const double d = C.d[c], rest = C.rest[c], r2 = distance2(S, C, c, dx, dy);
		const double term = rule == VolumeRule::meanDistance ? volumeTerm<VolumeRule::meanDistance, 2>(rest, r2) : volumeTerm<VolumeRule::inversePower, 2>(rest, r2);
		const bool   on   = pushes(C, c, r2);
		C.a[c]            = on ? term : 0.;
		// a pair that had come into contact already closer than d gets its rest distance back as it parts; no energy is in it then
		C.rest[c] = r2 < rest * rest ? rest : min(std::sqrt(r2), d);
		C.b[c]            = on ? r2 / (rest * rest) : 1.;
	}
	addRows(C, C.a, out.sum);
	double nearest = 1e300;
	closest        = 0;
	for (long c = 0; c < n; c++)
		if (C.b[c] < nearest) nearest = C.b[c], closest = size_t(c);
	return nearest;
}

double contactTrial(const Store& S, Contacts& C, double dt, ContactScratch& out, bool account)
{
	const long n      = long(C.size());
	double     speed2 = 0;
#pragma omp parallel for simd schedule(static) reduction(max : speed2) if (n >= parallelFrom)
	for (long c = 0; c < n; c++) {
		const int32_t i = C.owner[c], j = C.other[c];
		double        dx, dy;
		const double  r2 = distance2(S, C, c, dx, dy), vx = S.vx[j] - S.vx[i], vy = S.vy[j] - S.vy[i];
		const double  q = C.share[c], spin = fma(S.omega[i], q, S.omega[j] * (1. - q)) * dt;
		const bool    on  = touching(C, c, r2);
		const auto    e   = strainIncrement(dx, dy, vx * dt, vy * dt, spin);
		const double  ti = S.dTheta[i], perOldJ = (2. + ti) / ((2. - ti) * S.J[i]);
		C.b[c] = C.s[c] * perOldJ, C.c[c] = C.tau[c] * perOldJ; // before the step [Pa], for the account
		const double sn = fma(C.twoG[c], e.normal - (ti + S.dTheta[j]) * (1. / 6.), C.b[c]), tn = fma(C.twoG[c], e.shear, C.c[c]);
		C.s[c]   = on ? sn : 0.;
		C.tau[c] = on ? tn : 0.;
		C.a[c]   = on ? fma(sn, sn, tn * tn) : 0.;
		speed2   = max(speed2, fma(vx, vx, vy * vy));
	}
	addRows(C, C.a, out.square);
	if (account) {
		for (long c = 0; c < n; c++)
			C.a[c] = fma(C.b[c], C.s[c], C.c[c] * C.tau[c]);
		addRows(C, C.a, out.old);
	}
	return speed2;
}

void contactFriction(const Store& S, Contacts& C, VolumeRule rule, const ContactScratch& in, ContactWork* work)
{
	const long n = long(C.size());
#pragma omp parallel for simd schedule(static) if (n >= parallelFrom)
	for (long c = 0; c < n; c++) {
		const int32_t i = C.owner[c];
		double        dx, dy;
		const double  d = C.d[c], r2 = distance2(S, C, c, dx, dy);
		// normal pair force S s/r - push <= 0: each side keeps within it, so their mean does
		const double sMax = push(S, C, c, rule, r2) * r2 / (Lattice<2>::width(d) * d);
		const double st = C.s[c] * S.J[i], tt = C.tau[c] * S.J[i], s0 = C.s[c] * in.scale[i], t0 = C.tau[c] * in.scale[i];
		const double s = min(s0, sMax), tMax = C.friction[c] * (sMax - s), t = min(max(t0, -tMax), tMax);
		C.s[c]   = s;
		C.tau[c] = t;
		if (!work) continue;
		// this side's half, area S0 d/2; stress/(2G) = elastic strain. Taken out at the mean of the stresses before and after the step, as the forces
		// do their work; a pair that parts loses what it still held.
		const double area = 0.5 * Lattice<2>::width(d) * d, perG = C.twoG[c] > 0. ? 0.5 * area / C.twoG[c] / S.J[i] : 0.;
		const double so = C.b[c] * S.J[i], to = C.c[c] * S.J[i], held = perG * fma(so, so, to * to);
		const bool   on = touching(C, c, r2);
		// (so + s)(st - s) in all; the plastic work has (so + s0)(st - s0) of it
		C.a[c] = on ? perG * ((so + s) * (s0 - s) + (to + t) * (t0 - t) + (s - s0) * (st - s0) + (t - t0) * (tt - t0)) : held;
		// as for links: pair work that goes into volume change
		C.b[c] = on ? area * 0.5 * (so + s) * (S.dTheta[i] + S.dTheta[C.other[c]]) * (1. / 6.) - S.dTheta[i] * held : 0.;
	}
	if (work)
		for (long c = 0; c < n; c++)
			work->friction += C.a[c], work->coupling += C.b[c];
}

void contactForces(const Store& S, Contacts& C, VolumeRule rule, ContactScratch& out, bool account)
{
	const long          n = long(C.size());
	std::vector<double> t;
	t.resize(account ? n * 5 : n);
#pragma omp parallel for schedule(static) if (n >= parallelFrom)
	for (long c = 0; c < n; c++) {
		const int32_t i = C.owner[c], j = C.other[c], r = C.reverse[c];
		double        dx, dy;
		const double  d = C.d[c], r2 = distance2(S, C, c, dx, dy), inv = 1. / r2;
		const bool    on = touching(C, c, r2);
		const double  area = 0.5 * Lattice<2>::width(d) * d, Sn = area * (C.s[c] + C.s[r]), St = area * (C.tau[c] + C.tau[r]);
		const double  along = fma(dx, S.vx[j] - S.vx[i], dy * (S.vy[j] - S.vy[i]));
		const double  q  = viscousCoefficient(along, inv, C.viscLinear[c], C.viscQuadratic[c], Lattice<2>::width(d));
		const double  pr = push(S, C, c, rule, r2), al = on ? Sn * inv - pr + q : 0., ac = on ? St * inv : 0.;
		C.a[c] = fma(al, dx, -ac * dy);
		C.b[c] = fma(al, dy, ac * dx);
		t[c]   = on ? C.share[c] * St : 0.;
		if (account) {
			const double p = on ? pr : 0., v = on ? q : 0.;
			t[n + c] = -p * dx, t[2 * n + c] = -p * dy, t[3 * n + c] = v * dx, t[4 * n + c] = v * dy;
		}
	}
	addRows(C, C.a, out.fx);
	addRows(C, C.b, out.fy);
	addRows(C, t, out.torque);
	if (!account) return;
	std::vector<double> part(n);
	std::vector<double>* to[4] = { &out.volX, &out.volY, &out.visX, &out.visY };
	for (int k = 0; k < 4; k++) {
		std::copy(t.begin() + (k + 1) * n, t.begin() + (k + 2) * n, part.begin());
		addRows(C, part, *to[k]);
	}
}
}
