// SPDX-License-Identifier: GPL-2.0-or-later
#include "passes.hpp"

namespace mca::automata {
namespace {
	template <VolumeRule rule, bool intact, bool mixed, EosKind law> void run(Store& S, size_t b, const double* contactSum, bool init, BlockResult& out)
	{
		const Block&    B    = S.blocks[b];
		const Eos       eos  = S.materialOf(B).eos;
		constexpr bool  hot  = LawOf<law>::heats;
		const double    d    = S.species[B.species].d, G43 = S.materialOf(B).G * (4. / 3.), invRho = 1. / eos.rho0;
		const size_t    base = b * blockSize;
		const double *  X = S.x.data(), *Y = S.y.data(), *D = S.diameter.data();
		const int32_t*  nb    = S.neighbour.data() + b * nLinks * blockSize;
		const int32_t*  flags = S.flags.data() + base;
		const double *  xi = X + base, *yi = Y + base, *cell = S.cell.data() + base, *invN = S.invN.data() + base;
		double*         heat = hot ? S.heat.data() + base : nullptr;
		double *        rest = S.rest.data() + base, *J = S.J.data() + base, *dTheta = S.dTheta.data() + base, *P = S.P.data() + base, *h = S.h.data() + base;
		alignas(64) double sums[blockSize], stiff[blockSize];
		double          nearest = 1e300;
#pragma omp simd reduction(min : nearest)
		for (int l = 0; l < blockSize; l++) {
			double sum = 0;
#pragma GCC unroll 6
			for (int k = 0; k < nLinks; k++) {
				const int32_t j  = nb[k * blockSize + l];
				const double  dx = X[j] - xi[l], dy = Y[j] - yi[l];
				const double  dij = mixed ? 0.5 * (d + D[j]) : d;
				double        r2  = fma(dx, dx, dy * dy);
				if (!intact) r2 = (flags[l] >> k) & 1 ? r2 : dij * dij;
				nearest     = min(nearest, r2 / (dij * dij));
				double term = volumeTerm<rule, 2>(dij, r2);
				if (!intact) {
					term = (flags[l] >> (halfShift + k)) & 1 ? 0.5 * term : term;
					term = (flags[l] >> k) & 1 ? term : 0.;
				}
				sum += term;
			}
			sums[l] = sum;
		}
		if (init)
			for (int l = 0; l < blockSize; l++)
				rest[l] = sums[l];
		if (contactSum)
			for (int l = 0; l < blockSize; l++)
				sums[l] += contactSum[base + l];
		double stiffest = 0, closing = 0, widest = 1.;
		const double clampAt = LawOf<law>::clampStrain(eos);
		int clampCount = 0, badCount = 0;
#pragma omp simd reduction(max : stiffest, closing, widest) reduction(+ : clampCount, badCount)
		for (int l = 0; l < blockSize; l++) {
			const double Jn  = volumeRatio<rule, 2>((sums[l] - rest[l]) * invN[l]);
			const double Jo  = init ? Jn : J[l];
			const double eps = Jn - 1.;
			dTheta[l]        = 2. * (Jn - Jo) / (Jn + Jo);
			double       p   = 0;
			if constexpr (hot) p = pressureWithWork<law>(eos, eps, Jn - Jo, P[l], heat[l]);
			else p = pressure<law>(eos, eps);
			J[l]             = Jn;
			P[l]             = p;
			h[l]             = pressureShare<rule, 2>(p, Jn, cell[l] * invN[l]);
			stiff[l]         = (tangent<law>(eos, eps) + G43) * invRho / Jn;
			stiffest         = max(stiffest, stiff[l]);
			closing          = max(closing, -dTheta[l]);
			widest           = max(widest, Jn);
			clampCount += eps < clampAt ? 1 : 0;
			badCount += (Jn > 0. && Jn < 1e6) ? 0 : 1; // also catches NaN
		}
		for (int l = 0; l < blockSize; l++)
			S.node[(base + l) * 8 + 5] = dTheta[l];
		out.nearest = nearest, out.stiffest = stiffest, out.closing = closing, out.widest = widest, out.clamped = clampCount;
		if (badCount)
			for (int l = 0; l < B.count && out.bad < 0; l++)
				if (!(J[l] > 0. && J[l] < 1e6)) out.bad = int64_t(base) + l;
	}
	/// The affine rule: F = sum r (x) e_k / (3 d), J = jOff det F, exact in any homogeneous deformation of any arrangement of two or more links,
	/// and without geometric stiffness under pressure. Contacts have a volume of their own, by rule (5): it pushes from the first touch, whatever
	/// the links hold; an automaton without links has no other.
	template <bool intact, EosKind law> void runAffine(Store& S, size_t b, const double* contactSum, bool init, BlockResult& out)
	{
		const Block&    B    = S.blocks[b];
		const Eos       eos  = S.materialOf(B).eos;
		constexpr bool  hot  = LawOf<law>::heats;
		const double    d = S.species[B.species].d, G43 = S.materialOf(B).G * (4. / 3.), invRho = 1. / eos.rho0, d2 = d * d, scale = 1. / (9. * d2);
		const size_t    base = b * blockSize;
		const double *  node = S.node.data(), *xi = S.x.data() + base, *yi = S.y.data() + base;
		const int32_t * nb = S.neighbour.data() + b * nLinks * blockSize, *flags = S.flags.data() + base;
		const double*   cell = S.cell.data() + base;
		double*         heat = hot ? S.heat.data() + base : nullptr;
		double *        J = S.J.data() + base, *dTheta = S.dTheta.data() + base, *P = S.P.data() + base, *h = S.h.data() + base, *jOff = S.jOff.data() + base;
		double *        rest = S.rest.data() + base, *record = S.node.data() + base * 8, *push = S.push.data() + base * 4;
		double          nearest = 1e300, stiffest = 0, closing = 0, widest = 1.;
		const double    clampAt = LawOf<law>::clampStrain(eos);
		int             clampCount = 0, badCount = 0;
		alignas(64) double txx[blockSize], txy[blockSize], tyx[blockSize], tyy[blockSize], near[blockSize], spanX[blockSize], spanXY[blockSize], spanY[blockSize];
		for (int g = 0; g < blockSize; g += lanes) {
			const v8 X = load(xi + g), Y = load(yi + g);
			const m8 bits = intact ? m8 {} : widen(flags + g);
			v8       Fxx = {}, Fxy = {}, Fyx = {}, Fyy = {}, r2min = splat(1e300), ex = {}, exy = {}, ey = {};
#pragma GCC unroll 6
			for (int k = 0; k < nLinks; k++) {
				v8 dx, dy; // zero without a link: the slot leads to itself
				gather2(node, 8, nb + k * blockSize + g, dx, dy);
				dx -= X, dy -= Y;
				v8 r2 = fma(dx, dx, dy * dy);
				if (!intact) {
					const m8 on = ((bits >> k) & 1) != 0;
					r2 = on ? r2 : splat(d2), dx = on ? dx : splat(0.), dy = on ? dy : splat(0.);
					ex += on ? splat(linkX[k] * linkX[k]) : splat(0.), exy += on ? splat(linkX[k] * linkY[k]) : splat(0.), ey += on ? splat(linkY[k] * linkY[k]) : splat(0.);
				}
				r2min = min(r2min, r2);
				Fxx = fma(linkX[k], dx, Fxx), Fyx = fma(linkX[k], dy, Fyx);
				if (linkY[k] != 0.) Fxy = fma(linkY[k], dx, Fxy), Fyy = fma(linkY[k], dy, Fyy);
			}
			store(txx + g, Fxx), store(txy + g, Fxy), store(tyx + g, Fyx), store(tyy + g, Fyy), store(near + g, r2min);
			if (!intact) store(spanX + g, ex), store(spanXY + g, exy), store(spanY + g, ey);
		}
		if (init)
			for (int l = 0; l < blockSize; l++) {
				const double det = (txx[l] * tyy[l] - txy[l] * tyx[l]) * scale;
				jOff[l]          = det > minVolume ? 1. / det : 0.;
				rest[l]          = jOff[l] > 0. ? 1. - jOff[l] * det : 0.; // last bit of J = 1 at rest: no pressure, whether asleep or awake
			}
#pragma omp simd reduction(max : stiffest, closing, widest) reduction(+ : clampCount, badCount) reduction(min : nearest)
		for (int l = 0; l < blockSize; l++) {
			const double Fxx = txx[l], Fxy = txy[l], Fyx = tyx[l], Fyy = tyy[l], off = jOff[l];
			const double det = (Fxx * Fyy - Fxy * Fyx) * scale;
			const double c   = contactSum && !(off > 0.) ? contactSum[base + l] * (1. / nLinks) : 0.;
			const double Jn  = off > 0. ? off * det + rest[l] : 1. / (1. + c);
			const double Jo = init ? Jn : J[l], eps = Jn - 1.;
			dTheta[l]      = 2. * (Jn - Jo) / (Jn + Jo);
			double p = pressure<law>(eos, eps);
			if constexpr (hot) { // contacts push by the cold curve alone: so does an automaton without links work, and its internal energy keeps the rest
				double       e = heat[l];
				const double inner = pressureWithWork<law>(eos, eps, Jn - Jo, P[l], e), work = 0.5 * (P[l] + p) * (Jn - Jo) * invRho;
				heat[l] = off > 0. ? e : heat[l] - work;
				p       = off > 0. ? inner : p;
			}
			J[l] = Jn;
			P[l]           = p;
			const double a = off * scale * p * cell[l]; // push on link k: a cof(F) e_k
			txx[l] = a * Fyy, txy[l] = -a * Fyx, tyx[l] = -a * Fxy, tyy[l] = a * Fxx;
			// how much stiffer than in the perfect packing: the volume by the sum of (dJ/dx_k)^2, the pair law by the closest link
			const double exx = intact ? 3. : spanX[l], exy = intact ? 0. : spanXY[l], eyy = intact ? 3. : spanY[l];
			const double spread = exx * (Fyy * Fyy + Fyx * Fyx) - 2. * exy * (Fyy * Fxy + Fyx * Fxx) + eyy * (Fxy * Fxy + Fxx * Fxx);
			const double one = max(off * off * spread * scale * (1. / 6.), 1.), bulk = max(min(one * one, 4.), one); // covers edges and corners of free surfaces up to nu = 0.49, measured; beyond 4 what is torn and sheared
			stiffest          = max(stiffest, (tangent<law>(eos, eps) * bulk + G43 * max(0.5 * d2 / near[l], 1.)) * invRho / Jn);
			closing  = max(closing, -dTheta[l]);
			widest   = max(widest, Jn);
			nearest  = min(nearest, near[l] / d2);
			clampCount += eps < clampAt ? 1 : 0;
			badCount += (Jn > 0. && Jn < 1e6) ? 0 : 1;
		}
		for (int g = 0; g < blockSize; g += lanes)
			scatter4(push + 4 * g, 4, load(txx + g), load(txy + g), load(tyx + g), load(tyy + g));
		for (int l = 0; l < blockSize; l++)
			record[8 * l + 5] = dTheta[l];
		if (contactSum) {
#pragma omp simd reduction(max : stiffest) reduction(+ : clampCount)
			for (int l = 0; l < blockSize; l++) {
				const double Jc = 1. / fma(contactSum[base + l], 1. / nLinks, 1.), eps = Jc - 1.;
				h[l]            = pressureShare<VolumeRule::inversePower, 2>(pressure<law>(eos, eps), Jc, cell[l] * (1. / nLinks));
				stiffest        = max(stiffest, (tangent<law>(eos, eps) + G43) * invRho / Jc);
				clampCount += eps < clampAt ? 1 : 0;
			}
		}
		out.nearest = nearest, out.stiffest = stiffest, out.closing = closing, out.widest = widest, out.clamped = clampCount;
		if (badCount)
			for (int l = 0; l < B.count && out.bad < 0; l++)
				if (!(J[l] > 0. && J[l] < 1e6)) out.bad = int64_t(base) + l;
	}
	template <VolumeRule rule, EosKind law> void choose(Store& S, size_t b, const double* c, bool init, BlockResult& out)
	{
		const Block& B = S.blocks[b];
		if (B.mixed) B.intact ? run<rule, true, true, law>(S, b, c, init, out) : run<rule, false, true, law>(S, b, c, init, out);
		else B.intact ? run<rule, true, false, law>(S, b, c, init, out) : run<rule, false, false, law>(S, b, c, init, out);
	}
}

void densityPass(Store& S, size_t b, VolumeRule rule, const Extra& X, bool init, BlockResult& out)
{
	const double* c = S.blocks[b].contact ? X.contactSum : nullptr;
	dispatch(S.materialOf(S.blocks[b]).eos.kind, [&](auto law) {
		if (rule == VolumeRule::affine) S.blocks[b].intact ? runAffine<true, law.value>(S, b, c, init, out) : runAffine<false, law.value>(S, b, c, init, out);
		else if (rule == VolumeRule::inversePower) choose<VolumeRule::inversePower, law.value>(S, b, c, init, out);
		else choose<VolumeRule::meanDistance, law.value>(S, b, c, init, out);
	});
}
}
