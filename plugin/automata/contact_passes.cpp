// SPDX-License-Identifier: GPL-2.0-or-later
#include "contacts.hpp"
#include <algorithm>
#include <array>

namespace mca::automata {
namespace {
	constexpr long parallelFrom = 2048; ///< half-contacts below which waking a thread costs more than it brings
	/// The arrays as bare pointers: through the vectors their starts would be read again for each contact, and nothing would vectorise.
	struct View {
		const int32_t *owner, *other, *reverse;
		double *       s, *tau, *rest, *a, *b, *c, *dx, *dy, *r2, *pushing, *touch, *along, *press;
		const double * d, *twoG, *perTwoG, *perOwnG, *friction, *viscLinear, *viscQuadratic, *share;
		explicit View(Contacts& C)
		        : owner(C.owner.data()), other(C.other.data()), reverse(C.reverse.data()), s(C.s.data()), tau(C.tau.data()), rest(C.rest.data()), a(C.a.data()), b(C.b.data()), c(C.c.data())
		        , dx(C.dx.data()), dy(C.dy.data()), r2(C.r2.data()), pushing(C.pushing.data()), touch(C.touch.data()), along(C.along.data()), press(C.press.data()), d(C.d.data())
		        , twoG(C.twoG.data()), perTwoG(C.perTwoG.data()), perOwnG(C.perOwnG.data()), friction(C.friction.data()), viscLinear(C.viscLinear.data()), viscQuadratic(C.viscQuadratic.data()), share(C.share.data())
		{
		}
	};
	/// Sums of K quantities over each row, in the order of the row. All in one go: rows are short, and their ends cost more than the sums.
	template <size_t K> void addRows(const Contacts& C, const std::array<const double*, K>& from, const std::array<double*, K>& to)
	{
		const long n = long(C.rows());
#pragma omp parallel for schedule(static) if (long(C.size()) >= parallelFrom)
		for (long r = 0; r < n; r++) {
			double sum[K] = {};
			for (int32_t c = C.rowBegin[r]; c < C.rowBegin[r + 1]; c++)
				for (size_t k = 0; k < K; k++)
					sum[k] += from[k][c];
			for (size_t k = 0; k < K; k++)
				to[k][C.rowOwner[r]] = sum[k];
		}
	}
	/// volume rule of contacts: affine links leave it to (5)
	template <class F> void withRule(VolumeRule rule, F&& f)
	{
		if (rule == VolumeRule::meanDistance) f(std::integral_constant<VolumeRule, VolumeRule::meanDistance> {});
		else f(std::integral_constant<VolumeRule, VolumeRule::inversePower> {});
	}

	template <VolumeRule rule> void density(const Store& S, Contacts& C)
	{
		const long    n = long(C.size());
		const View    V(C);
		const double *x = S.x.data(), *y = S.y.data();
#pragma omp parallel for simd schedule(static) if (n >= parallelFrom)
		for (long c = 0; c < n; c++) {
			const int32_t i = V.owner[c], j = V.other[c];
			const double  dx = x[j] - x[i], dy = y[j] - y[i], rest = V.rest[c], d = V.d[c], r2 = fma(dx, dx, dy * dy);
			const double  on = pushes(r2, rest, d);
			V.dx[c] = dx, V.dy[c] = dy, V.r2[c] = r2;
			V.pushing[c] = on;
			V.a[c]       = on > 0. ? volumeTerm<rule, 2>(rest, r2) : 0.;
			// a pair that had come into contact already closer than d gets its rest distance back as it parts; no energy is in it then
			V.rest[c] = r2 < rest * rest ? rest : min(std::sqrt(r2), d);
			V.b[c]    = on > 0. ? r2 / (rest * rest) : 1.;
		}
	}

	template <bool account> double trial(const Store& S, Contacts& C, double dt)
	{
		const long    n = long(C.size());
		const View    V(C);
		const double *velX = S.vx.data(), *velY = S.vy.data(), *omega = S.omega.data(), *dTheta = S.dTheta.data(), *J = S.J.data();
		double        speed2 = 0;
#pragma omp parallel for simd schedule(static) reduction(max : speed2) if (n >= parallelFrom)
		for (long c = 0; c < n; c++) {
			const int32_t i = V.owner[c], j = V.other[c];
			const double  dx = V.dx[c], dy = V.dy[c], vx = velX[j] - velX[i], vy = velY[j] - velY[i];
			const double  q = V.share[c], spin = fma(omega[i], q, omega[j] * (1. - q)) * dt;
			const double  touch = max(V.pushing[c], V.pushing[V.reverse[c]]);
			V.touch[c] = touch, V.along[c] = fma(dx, vx, dy * vy);
			const auto   e  = strainIncrement(dx, dy, vx * dt, vy * dt, spin);
			const double ti = dTheta[i], perOldJ = (2. + ti) / ((2. - ti) * J[i]);
			const double so = V.s[c] * perOldJ, to = V.tau[c] * perOldJ; // before the step [Pa], for the account
			const double st = fma(V.twoG[c], e.normal - (ti + dTheta[j]) * (1. / 6.), so), tt = fma(V.twoG[c], e.shear, to);
			const double sn = touch > 0. ? st : 0., tn = touch > 0. ? tt : 0.;
			V.b[c] = so, V.c[c] = to;
			V.s[c]   = sn;
			V.tau[c] = tn;
			V.a[c]   = fma(sn, sn, tn * tn);
			if (account) V.press[c] = fma(so, sn, to * tn); // place for the sums; the pressure comes later
			speed2 = max(speed2, fma(vx, vx, vy * vy));
		}
		return speed2;
	}

	template <bool account> void friction(const Store& S, Contacts& C, const double* scale)
	{
		const long    n = long(C.size());
		const View    V(C);
		const double *J = S.J.data(), *dTheta = S.dTheta.data();
#pragma omp parallel for simd schedule(static) if (n >= parallelFrom)
		for (long c = 0; c < n; c++) {
			const int32_t i = V.owner[c];
			const double  d = V.d[c], Ji = J[i];
			// normal pair force S s/r - push <= 0: each side keeps within it, so their mean does
			const double sMax = V.press[c] * V.r2[c] / (Lattice<2>::width(d) * d);
			const double st = V.s[c] * Ji, tt = V.tau[c] * Ji, s0 = V.s[c] * scale[i], t0 = V.tau[c] * scale[i];
			const double s = min(s0, sMax), tMax = V.friction[c] * (sMax - s), t = min(max(t0, -tMax), tMax);
			V.s[c]   = s;
			V.tau[c] = t;
			if (account) {
				// this side's half, area S0 d/2; stress/(2G) = elastic strain. Taken out at the mean of the stresses before and after the step, as the forces
				// do their work; a pair that parts loses what it still held.
				const double area = 0.5 * Lattice<2>::width(d) * d, perJ = area / Ji, perG = 0.5 * perJ * V.perTwoG[c], perOwn = 0.25 * perJ * V.perOwnG[c];
				const double so = V.b[c] * Ji, to = V.c[c] * Ji, held = perG * fma(so, so, to * to), ti = dTheta[i];
				const bool   on = V.touch[c] > 0.;
				// the radial return took (so + s)(st - s0) with the stiffness of the pair; booked as plastic with the links: (so + s0)(st - s0) with the owner's own
				const double plastic = (perG * (so + s) - perOwn * (so + s0)) * (st - s0) + (perG * (to + t) - perOwn * (to + t0)) * (tt - t0);
				// as for links: pair work that goes into volume change
				const double coupling = area * 0.5 * (so + s) * (ti + dTheta[V.other[c]]) * (1. / 6.) - ti * held, rubbed = perG * ((so + s) * (s0 - s) + (to + t) * (t0 - t));
				V.a[c] = on ? rubbed : held;
				V.b[c] = on ? coupling : 0.;
				V.c[c] = on ? plastic : 0.;
			}
		}
	}

	template <VolumeRule rule> void pressure(const double* h, Contacts& C)
	{
		const long n = long(C.size());
		const View V(C);
#pragma omp parallel for simd schedule(static) if (n >= parallelFrom)
		for (long c = 0; c < n; c++) {
			const int32_t r   = V.reverse[c];
			const double  inv = 1. / V.r2[c], mine = h[V.owner[c]] * pressureShape<rule, 2>(V.rest[c], inv), theirs = h[V.other[c]] * pressureShape<rule, 2>(V.rest[r], inv);
			V.press[c] = (V.pushing[c] > 0. ? mine : 0.) + (V.pushing[r] > 0. ? theirs : 0.);
		}
	}

	template <bool account> void forces(Contacts& C, double* t)
	{
		const long n = long(C.size());
		const View V(C);
#pragma omp parallel for simd schedule(static) if (n >= parallelFrom)
		for (long c = 0; c < n; c++) {
			const int32_t r  = V.reverse[c];
			const double  dx = V.dx[c], dy = V.dy[c], d = V.d[c], inv = 1. / V.r2[c], on = V.touch[c];
			const double  area = 0.5 * Lattice<2>::width(d) * d, Sn = area * (V.s[c] + V.s[r]), St = area * (V.tau[c] + V.tau[r]);
			const double  q  = on * viscousCoefficient(V.along[c], inv, V.viscLinear[c], V.viscQuadratic[c], Lattice<2>::width(d));
			const double  pr = on * V.press[c], al = fma(on * Sn, inv, q - pr), ac = on * St * inv;
			V.a[c] = fma(al, dx, -ac * dy);
			V.b[c] = fma(al, dy, ac * dx);
			t[c]   = on * V.share[c] * St;
			if (account) t[n + c] = -pr * dx, t[2 * n + c] = -pr * dy, t[3 * n + c] = q * dx, t[4 * n + c] = q * dy;
		}
	}
}

void contactReciprocals(const Store& S, Contacts& C)
{
	C.perTwoG.resize(C.size()), C.perOwnG.resize(C.size());
	for (size_t c = 0; c < C.size(); c++) {
		const double G = S.materials[S.species[S.speciesOf(C.owner[c])].material].G;
		C.perTwoG[c] = C.twoG[c] > 0. ? 1. / C.twoG[c] : 0., C.perOwnG[c] = G > 0. ? 1. / G : 0.;
	}
}

double contactDensity(const Store& S, Contacts& C, VolumeRule rule, ContactScratch& out, size_t& closest)
{
	withRule(rule, [&](auto r) { density<r.value>(S, C); });
	addRows<1>(C, { C.a.data() }, { out.sum.data() });
	const long    n       = long(C.size());
	const double* b       = C.b.data();
	double        nearest = 1e300;
#pragma omp simd reduction(min : nearest)
	for (long c = 0; c < n; c++)
		nearest = min(nearest, b[c]);
	closest = nearest < deepest ? size_t(std::find(C.b.begin(), C.b.end(), nearest) - C.b.begin()) : 0;
	return nearest;
}

double contactTrial(const Store& S, Contacts& C, double dt, ContactScratch& out, bool account)
{
	const double speed2 = account ? trial<true>(S, C, dt) : trial<false>(S, C, dt);
	if (!account) addRows<1>(C, { C.a.data() }, { out.square.data() });
	else addRows<2>(C, { C.a.data(), C.press.data() }, { out.square.data(), out.old.data() });
	return speed2;
}

void contactFriction(const Store& S, Contacts& C, const ContactScratch& in, ContactWork* work)
{
	work ? friction<true>(S, C, in.scale.data()) : friction<false>(S, C, in.scale.data());
	for (size_t c = 0; work && c < C.size(); c++)
		work->friction += C.a[c], work->coupling += C.b[c], work->plastic += C.c[c];
}

// (6) of both sides, each with its own rest distance.
void contactPressure(const Store& S, Contacts& C, VolumeRule rule)
{
	withRule(rule, [&](auto r) { pressure<r.value>(S.h.data(), C); });
}

void contactForces(Contacts& C, ContactScratch& out, bool account)
{
	const long n = long(C.size());
	out.terms.resize(account ? n * 5 : n);
	double* t = out.terms.data();
	account ? forces<true>(C, t) : forces<false>(C, t);
	if (!account) addRows<3>(C, { C.a.data(), C.b.data(), t }, { out.fx.data(), out.fy.data(), out.torque.data() });
	else
		addRows<7>(C, { C.a.data(), C.b.data(), t, t + n, t + 2 * n, t + 3 * n, t + 4 * n },
		           { out.fx.data(), out.fy.data(), out.torque.data(), out.volX.data(), out.volY.data(), out.visX.data(), out.visY.data() });
}
}
