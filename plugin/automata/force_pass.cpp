// SPDX-License-Identifier: GPL-2.0-or-later
#include "passes.hpp"

namespace mca::automata {
namespace {
	template <VolumeRule rule, bool intact, bool mixed, bool viscous, bool account> void run(Store& S, size_t b, const Extra& E)
	{
		const Block&    B = S.blocks[b];
		const Material& m = S.materialOf(B);
		const double    d = S.species[B.species].d;
		const size_t    base = b * blockSize, slots = b * nLinks * blockSize;
		const double *  node = S.node.data(), *push = S.push.data(), *H = S.h.data(), *s = S.s.data(), *tau = S.tau.data();
		const double *  xi = S.x.data() + base, *yi = S.y.data() + base, *vxi = S.vx.data() + base, *vyi = S.vy.data() + base, *hi = H + base, *si = s + slots, *taui = tau + slots;
		const int32_t * nb = S.neighbour.data() + slots, *flags = S.flags.data() + base;
		int32_t         own[blockSize];
		for (int l = 0; l < blockSize; l++)
			own[l] = int32_t(base) + l;
		double *        fx = S.fx.data() + base, *fy = S.fy.data() + base, *tq = S.torque.data() + base;
		const bool      contact = B.contact && E.contactFx;
		const double    lin = m.viscosity.linear * m.eos.rho0 * m.eos.c0, quad = m.viscosity.quadratic * m.eos.rho0;
		for (int g = 0; g < blockSize; g += lanes) {
			const v8 X = load(xi + g), Y = load(yi + g), VX = load(vxi + g), VY = load(vyi + g);
			const m8 bits = intact ? m8 {} : widen(flags + g);
			v8       Fx = {}, Fy = {}, Tq = {}, Vx = {}, Vy = {}, Qx = {}, Qy = {}, mxx, mxy, myx, myy;
			if (rule == VolumeRule::affine) gather4(push, 4, own + g, mxx, mxy, myx, myy);
#pragma GCC unroll 6
			for (int k = 0; k < nLinks; k++) {
				const int32_t* j = nb + k * blockSize + g;
				int32_t        r[lanes]; // the same link at the other end: plane (k + 3) % 6 of block j / 64
				for (int l = 0; l < lanes; l++)
					r[l] = j[l] + (j[l] / blockSize) * ((nLinks - 1) * blockSize) + ((k + 3) % nLinks) * blockSize;
				v8 dx, dy, ux, uy, sj, tj;
				gather4(node, 8, j, dx, dy, ux, uy);
				for (int l = 0; l < lanes; l++)
					sj[l] = s[r[l]], tj[l] = tau[r[l]];
				dx -= X, dy -= Y;
				v8 dij = splat(d);
				if (mixed)
					for (int l = 0; l < lanes; l++)
						dij[l] = 0.5 * (d + S.diameter[j[l]]);
				const m8 on = intact ? m8 {} : ((bits >> k) & 1) != 0;
				v8       r2 = fma(dx, dx, dy * dy), w = splat(1.);
				if (!intact) {
					r2 = on ? r2 : dij * dij;
					w  = ((bits >> (halfShift + k)) & 1) != 0 ? splat(0.5) : splat(1.);
					w  = on ? w : splat(0.);
				}
				const v8 inv = 1. / r2;
				// S r = S0 d J: the contact area that gives exactly the Cauchy stress in any homogeneous deformation
				const v8 area = 0.5 * w * (dij * Lattice<2>::width(1.)) * dij;
				const v8 Sn = area * (load(si + k * blockSize + g) + sj), St = area * (load(taui + k * blockSize + g) + tj);
				v8       px, py; // pressure pushes i by -(px, py)
				if (rule == VolumeRule::affine) {
					v8 nxx, nxy, nyx, nyy;
					gather4(push, 4, j, nxx, nxy, nyx, nyy);
					px = fma(linkX[k], mxx + nxx, linkY[k] * (mxy + nxy));
					py = fma(linkX[k], myx + nyx, linkY[k] * (myy + nyy));
					if (!intact) px = on ? px : splat(0.), py = on ? py : splat(0.);
				} else {
					v8 pr;
					for (int l = 0; l < lanes; l++)
						pr[l] = w[l] * (hi[g + l] + H[j[l]]) * pressureShape<rule, 2>(dij[l], inv[l]);
					px = pr * dx, py = pr * dy;
				}
				v8       al = Sn * inv;
				const v8 ac = St * inv;
				if (viscous) {
					const v8 along = fma(dx, ux - VX, dy * (uy - VY));
					v8       q;
					if (mixed)
						for (int l = 0; l < lanes; l++) {
							double c1 = lin, c2 = quad;
							S.pairViscosity(B.species, j[l], c1, c2);
							q[l] = w[l] * viscousCoefficient(along[l], inv[l], c1, c2, Lattice<2>::width(dij[l]));
						}
					else
						q = w * viscousCoefficient(along, inv, lin, quad, Lattice<2>::width(d));
					al += q;
					if (account) Qx = fma(q, dx, Qx), Qy = fma(q, dy, Qy);
				}
				if (account) Vx -= px, Vy -= py;
				Fx += fma(al, dx, fma(-ac, dy, -px));
				Fy += fma(al, dy, fma(ac, dx, -py));
				if (mixed)
					for (int l = 0; l < lanes; l++)
						Tq[l] = fma(d / (d + S.diameter[j[l]]), St[l], Tq[l]);
				else
					Tq = fma(0.5, St, Tq);
			}
			store(fx + g, Fx), store(fy + g, Fy), store(tq + g, Tq);
			if (account) store(E.volX + base + g, Vx), store(E.volY + base + g, Vy), store(E.visX + base + g, Qx), store(E.visY + base + g, Qy);
		}
		if (contact)
			for (int l = 0; l < blockSize; l++)
				fx[l] += E.contactFx[base + l], fy[l] += E.contactFy[base + l], tq[l] += E.contactT[base + l];
	}
	template <VolumeRule rule, bool viscous, bool account> void choose(Store& S, size_t b, const Extra& E)
	{
		const Block& B = S.blocks[b];
		if (B.mixed) B.intact ? run<rule, true, true, viscous, account>(S, b, E) : run<rule, false, true, viscous, account>(S, b, E);
		else B.intact ? run<rule, true, false, viscous, account>(S, b, E) : run<rule, false, false, viscous, account>(S, b, E);
	}
	template <VolumeRule rule> void chooseFeatures(Store& S, size_t b, const Extra& E)
	{
		const bool viscous = S.materialOf(S.blocks[b]).viscosity.active() || S.blocks[b].mixed;
		if (E.volX) viscous ? choose<rule, true, true>(S, b, E) : choose<rule, false, true>(S, b, E);
		else viscous ? choose<rule, true, false>(S, b, E) : choose<rule, false, false>(S, b, E);
	}
}

void forcePass(Store& S, size_t b, VolumeRule rule, const Extra& E)
{
	if (rule == VolumeRule::affine) chooseFeatures<VolumeRule::affine>(S, b, E);
	else if (rule == VolumeRule::inversePower) chooseFeatures<VolumeRule::inversePower>(S, b, E);
	else chooseFeatures<VolumeRule::meanDistance>(S, b, E);
}
}
