// SPDX-License-Identifier: GPL-2.0-or-later
#include "contacts.hpp"
#include <algorithm>

namespace mca::automata {
namespace {
	constexpr long parallelFrom = 2048; ///< half-contacts below which waking a thread costs more than it brings
	/// Sum of a quantity over each row, in the order of the row.
	void addRows(const Contacts& C, const double* from, std::vector<double>& to)
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
	double shape(VolumeRule rule, double rest, double inv)
	{
		return rule == VolumeRule::meanDistance ? pressureShape<VolumeRule::meanDistance, 2>(rest, inv) : pressureShape<VolumeRule::inversePower, 2>(rest, inv);
	}
}

double contactDensity(const Store& S, Contacts& C, VolumeRule rule, ContactScratch& out, size_t& closest)
{
	const long n = long(C.size());
#pragma omp parallel for simd schedule(static) if (n >= parallelFrom)
	for (long c = 0; c < n; c++) {
		const int32_t i = C.owner[c], j = C.other[c];
		const double  dx = S.x[j] - S.x[i], dy = S.y[j] - S.y[i], rest = C.rest[c], r2 = fma(dx, dx, dy * dy);
		const double  term = rule == VolumeRule::meanDistance ? volumeTerm<VolumeRule::meanDistance, 2>(rest, r2) : volumeTerm<VolumeRule::inversePower, 2>(rest, r2);
		const bool    on   = pushes(C, c, r2);
		C.dx[c] = dx, C.dy[c] = dy, C.r2[c] = r2;
		C.pushing[c] = on ? 1. : 0.;
		C.a[c]       = on ? term : 0.;
		// a pair that had come into contact already closer than d gets its rest distance back as it parts; no energy is in it then
		C.rest[c] = r2 < rest * rest ? rest : min(std::sqrt(r2), C.d[c]);
		C.b[c]    = on ? r2 / (rest * rest) : 1.;
	}
	addRows(C, C.a.data(), out.sum);
	double nearest = 1e300;
	for (long c = 0; c < n; c++)
		nearest = min(nearest, C.b[c]);
	closest = size_t(std::find(C.b.begin(), C.b.end(), nearest) - C.b.begin());
	return nearest;
}

double contactTrial(const Store& S, Contacts& C, double dt, ContactScratch& out, bool account)
{
	const long n      = long(C.size());
	double     speed2 = 0;
#pragma omp parallel for simd schedule(static) reduction(max : speed2) if (n >= parallelFrom)
	for (long c = 0; c < n; c++) {
		const int32_t i = C.owner[c], j = C.other[c];
		const double  dx = C.dx[c], dy = C.dy[c], vx = S.vx[j] - S.vx[i], vy = S.vy[j] - S.vy[i];
		const double  q = C.share[c], spin = fma(S.omega[i], q, S.omega[j] * (1. - q)) * dt;
		const double  touch = max(C.pushing[c], C.pushing[C.reverse[c]]);
		const bool    on    = touch > 0.;
		C.touch[c] = touch, C.along[c] = fma(dx, vx, dy * vy);
		const auto    e   = strainIncrement(dx, dy, vx * dt, vy * dt, spin);
		const double  ti = S.dTheta[i], perOldJ = (2. + ti) / ((2. - ti) * S.J[i]);
		C.b[c] = C.s[c] * perOldJ, C.c[c] = C.tau[c] * perOldJ; // before the step [Pa], for the account
		const double sn = fma(C.twoG[c], e.normal - (ti + S.dTheta[j]) * (1. / 6.), C.b[c]), tn = fma(C.twoG[c], e.shear, C.c[c]);
		C.s[c]   = on ? sn : 0.;
		C.tau[c] = on ? tn : 0.;
		C.a[c]   = on ? fma(sn, sn, tn * tn) : 0.;
		speed2   = max(speed2, fma(vx, vx, vy * vy));
	}
	addRows(C, C.a.data(), out.square);
	if (account) {
		for (long c = 0; c < n; c++)
			C.a[c] = fma(C.b[c], C.s[c], C.c[c] * C.tau[c]);
		addRows(C, C.a.data(), out.old);
	}
	return speed2;
}

void contactFriction(const Store& S, Contacts& C, const ContactScratch& in, ContactWork* work)
{
	const long n = long(C.size());
#pragma omp parallel for simd schedule(static) if (n >= parallelFrom)
	for (long c = 0; c < n; c++) {
		const int32_t i = C.owner[c];
		const double  d = C.d[c];
		// normal pair force S s/r - push <= 0: each side keeps within it, so their mean does
		const double sMax = C.press[c] * C.r2[c] / (Lattice<2>::width(d) * d);
		const double st = C.s[c] * S.J[i], tt = C.tau[c] * S.J[i], s0 = C.s[c] * in.scale[i], t0 = C.tau[c] * in.scale[i];
		const double s = min(s0, sMax), tMax = C.friction[c] * (sMax - s), t = min(max(t0, -tMax), tMax);
		C.s[c]   = s;
		C.tau[c] = t;
		if (!work) continue;
		// this side's half, area S0 d/2; stress/(2G) = elastic strain. Taken out at the mean of the stresses before and after the step, as the forces
		// do their work; a pair that parts loses what it still held.
		const double area = 0.5 * Lattice<2>::width(d) * d, perG = C.twoG[c] > 0. ? 0.5 * area / C.twoG[c] / S.J[i] : 0.;
		const double so = C.b[c] * S.J[i], to = C.c[c] * S.J[i], held = perG * fma(so, so, to * to);
		const bool   on = C.touch[c] > 0.;
		C.a[c] = on ? perG * ((so + s) * (s0 - s) + (to + t) * (t0 - t)) : held;
		// the radial return took (so + s)(st - s0) with the stiffness of the pair; booked as plastic with the links: (so + s0)(st - s0) with the owner's own
		const double G = S.materials[S.species[S.speciesOf(i)].material].G, perOwn = G > 0. ? 0.25 * area / G / S.J[i] : 0.;
		C.c[c] = on ? (perG * (so + s) - perOwn * (so + s0)) * (st - s0) + (perG * (to + t) - perOwn * (to + t0)) * (tt - t0) : 0.;
		// as for links: pair work that goes into volume change
		C.b[c] = on ? area * 0.5 * (so + s) * (S.dTheta[i] + S.dTheta[C.other[c]]) * (1. / 6.) - S.dTheta[i] * held : 0.;
	}
	if (work)
		for (long c = 0; c < n; c++)
			work->friction += C.a[c], work->coupling += C.b[c], work->plastic += C.c[c];
}

// (6) of both sides, each with its own rest distance.
void contactPressure(const Store& S, Contacts& C, VolumeRule rule)
{
	const long n = long(C.size());
#pragma omp parallel for simd schedule(static) if (n >= parallelFrom)
	for (long c = 0; c < n; c++) {
		const int32_t r   = C.reverse[c];
		const double  inv = 1. / C.r2[c], mine = S.h[C.owner[c]] * shape(rule, C.rest[c], inv), theirs = S.h[C.other[c]] * shape(rule, C.rest[r], inv);
		C.press[c] = (C.pushing[c] > 0. ? mine : 0.) + (C.pushing[r] > 0. ? theirs : 0.);
	}
}

void contactForces(Contacts& C, ContactScratch& out, bool account)
{
	const long n = long(C.size());
	out.terms.resize(account ? n * 5 : n);
	double* t = out.terms.data();
#pragma omp parallel for simd schedule(static) if (n >= parallelFrom)
	for (long c = 0; c < n; c++) {
		const int32_t r  = C.reverse[c];
		const double  dx = C.dx[c], dy = C.dy[c], d = C.d[c], inv = 1. / C.r2[c], on = C.touch[c];
		const double  area = 0.5 * Lattice<2>::width(d) * d, Sn = area * (C.s[c] + C.s[r]), St = area * (C.tau[c] + C.tau[r]);
		const double  q  = on * viscousCoefficient(C.along[c], inv, C.viscLinear[c], C.viscQuadratic[c], Lattice<2>::width(d));
		const double  pr = on * C.press[c], al = fma(on * Sn, inv, q - pr), ac = on * St * inv;
		C.a[c] = fma(al, dx, -ac * dy);
		C.b[c] = fma(al, dy, ac * dx);
		t[c]   = on * C.share[c] * St;
		if (account) t[n + c] = -pr * dx, t[2 * n + c] = -pr * dy, t[3 * n + c] = q * dx, t[4 * n + c] = q * dy;
	}
	addRows(C, C.a.data(), out.fx);
	addRows(C, C.b.data(), out.fy);
	addRows(C, t, out.torque);
	if (!account) return;
	std::vector<double>* to[4] = { &out.volX, &out.volY, &out.visX, &out.visY };
	for (int k = 0; k < 4; k++)
		addRows(C, t + (k + 1) * n, *to[k]);
}
}
