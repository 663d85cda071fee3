// SPDX-License-Identifier: GPL-2.0-or-later
#include "passes.hpp"

namespace mca::automata {
namespace {
	/// Radial return of eight automata by a law that is dear, if any of them is above its static yield stress; else shrink and flow stay as they are.
	template <YieldKind kind>
	void returnWhereAbove(const Yield& yield, const double* trial, const double* eqps, const double* temperature, double threeG, double dt, double* shrink, double* flow)
	{
		alignas(64) double stress[lanes], slope[lanes];
		double             over = 0;
#pragma omp simd reduction(max : over)
		for (int l = 0; l < lanes; l++) {
			const StaticYield s = staticYield<kind>(yield, eqps[l], temperature[l]);
			stress[l] = s.stress, slope[l] = s.slope;
			over = max(over, trial[l] - s.stress);
		}
		if (!(over > 0.)) return;
#pragma omp simd
		for (int l = 0; l < lanes; l++) {
			const Return r = radialReturn<kind>(yield, StaticYield { stress[l], slope[l] }, trial[l], eqps[l], temperature[l], threeG, dt);
			shrink[l] = r.scale, flow[l] = r.dEqps;
		}
	}
	/// (J s), (J tau) of the step before come in, those of this step go out.
	template <YieldKind kind, bool intact, bool mixed, bool account>
	void run(Store& S, size_t b, double dt, const double* contactSq, const double* contactOld, double* scaleOut, BlockResult& out, BlockWork* work)
	{
		const Block&    B = S.blocks[b];
		const Material& m = S.materialOf(B);
		const Yield     yield = m.yield;
		using Law = LawOf<kind>;
		const double    twoG = 2. * m.G, threeG = 3. * m.G, halfDt = 0.5 * dt, d = S.species[B.species].d;
		const size_t    base = b * blockSize, slots = b * nLinks * blockSize;
		const double*   node = S.node.data();
		const double *  xi = S.x.data() + base, *yi = S.y.data() + base, *vxi = S.vx.data() + base, *vyi = S.vy.data() + base, *wi = S.omega.data() + base, *ti = S.dTheta.data() + base, *J = S.J.data() + base, *invN = S.invN.data() + base,
		             *cell = S.cell.data() + base;
		const int32_t * nb = S.neighbour.data() + slots, *flags = S.flags.data() + base;
		double *        s = S.s.data() + slots, *tau = S.tau.data() + slots, *szz = S.szz.data() + base, *eqps = S.eqps.data() + base, *temp = S.temperature.data() + base;
		alignas(64) double square[blockSize], factor[blockSize], old2[blockSize], oldNew[blockSize], coupleOld[blockSize], coupleNew[blockSize];
		double          plastic = 0, couple = 0, heated = 0;
		double*         heat   = m.eos.heats() ? S.heat.data() + base : nullptr;
		const double    perRho = 1. / m.eos.rho0, sixth = Lattice<2>::cell(d) / nLinks;
		for (int g = 0; g < blockSize; g += lanes) {
			const v8 X = load(xi + g), Y = load(yi + g), VX = load(vxi + g), VY = load(vyi + g), W = load(wi + g), th = load(ti + g);
			const v8 perOldJ = (2. + th) / ((2. - th) * load(J + g)); // 1/J of the step before
			const m8 bits    = intact ? m8 {} : widen(flags + g);
			v8       sum = {}, sumOld = {}, sumBoth = {}, co = {}, cn = {};
#pragma GCC unroll 6
			for (int k = 0; k < nLinks; k++) {
				const int32_t* j = nb + k * blockSize + g;
				v8             dx, dy, ux, uy, Wj, Tj;
				gather4(node, 8, j, dx, dy, ux, uy);
				gather2(node + 4, 8, j, Wj, Tj);
				dx -= X, dy -= Y, ux = (ux - VX) * dt, uy = (uy - VY) * dt;
				v8 spin = (W + Wj) * halfDt, stiff = splat(twoG);
				if (mixed) // (8) with unlike arms; series rule for the stiffness
					for (int l = 0; l < lanes; l++) {
						const double q = d / (d + S.diameter[j[l]]);
						spin[l]        = fma(W[l], q, Wj[l] * (1. - q)) * dt;
						stiff[l]       = S.pairTwoG(B.species, j[l], q);
					}
				const m8 on = intact ? m8 {} : ((bits >> k) & 1) != 0;
				if (!intact) dx = on ? dx : splat(d), dy = on ? dy : splat(0.);
				const auto e   = strainIncrement(dx, dy, ux, uy, spin);
				const v8   dth = (th + Tj) * (1. / 6.);
				double *   sk = s + k * blockSize + g, *tk = tau + k * blockSize + g;
				const v8   so = load(sk) * perOldJ, to = load(tk) * perOldJ;
				v8         sn = fma(stiff, e.normal - dth, so), tn = fma(stiff, e.shear, to);
				if (!intact) sn = on ? sn : splat(0.), tn = on ? tn : splat(0.);
				store(sk, sn), store(tk, tn);
				v8 q2 = fma(sn, sn, tn * tn), w = splat(1.);
				if (!intact) {
					w = ((bits >> (halfShift + k)) & 1) != 0 ? splat(0.5) : splat(1.);
					q2 *= w;
				}
				sum += q2;
				if (account) {
					const v8 holds = intact ? w : on ? w : splat(0.); // what a link that has just broken held goes on in its contact
					sumOld += holds * fma(so, so, to * to), sumBoth += w * fma(so, sn, to * tn), co += holds * so * dth, cn += w * sn * dth;
				}
			}
			store(square + g, sum);
			if (account) store(old2 + g, sumOld), store(oldNew + g, sumBoth), store(coupleOld + g, co), store(coupleNew + g, cn);
		}
		if (contactSq)
			for (int l = 0; l < blockSize; l++)
				square[l] += contactSq[base + l];
		alignas(64) double trials[blockSize], zNew[blockSize];
		double             most = 0, hottest = 0;
#pragma omp simd reduction(max : most, hottest)
		for (int l = 0; l < blockSize; l++) {
			zNew[l]   = fma(-twoG * (1. / 3.), ti[l], szz[l]); // (9)
			trials[l] = std::sqrt(equivalentStress2<2>(square[l] * invN[l], zNew[l]));
			most      = max(most, trials[l]);
			if (Law::heats) hottest = max(hottest, temp[l]);
		}
		alignas(64) double shrink[blockSize], flow[blockSize]; // of the radial return
		const auto returnAll = [&](int from, int to) {
#pragma omp simd
			for (int l = from; l < to; l++) {
				const Return r = radialReturn<kind>(yield, trials[l], eqps[l], Law::heats ? temp[l] : 0., threeG, dt);
				shrink[l] = r.scale, flow[l] = r.dEqps;
			}
		};
		// logarithms and powers are most of the cost: not where nobody reaches the yield stress of unstrained material at the highest temperature
		if constexpr (Law::isDear) {
			std::fill(shrink, shrink + blockSize, 1.), std::fill(flow, flow + blockSize, 0.);
			if (most > staticYield<kind>(yield, 0., hottest).stress)
				for (int g = 0; g < blockSize; g += lanes)
					returnWhereAbove<kind>(yield, trials + g, eqps + g, temp + g, threeG, dt, shrink + g, flow + g);
		} else
			returnAll(0, blockSize);
#pragma omp simd reduction(+ : plastic, couple, heated)
		for (int l = 0; l < blockSize; l++) {
			const double zo = szz[l], zn = zNew[l], trial = trials[l];
			const Return r  = { shrink[l], flow[l] };
			factor[l]       = r.scale * J[l];
			szz[l]          = zn * r.scale;
			if (Law::yields) eqps[l] += r.dEqps;
			if (Law::heats) temp[l] = fma(yield.heatPerWork * r.scale * trial, r.dEqps, temp[l]);
			if (heat) {
				const double q = J[l] * r.scale * trial * r.dEqps * perRho;
				heat[l] += q, heated += q * cell[l];
			}
			if (account) {
				const double before = std::sqrt(equivalentStress2<2>(old2[l] * invN[l], zo));
				// the stress before the step along the direction of flow: the two need not be parallel
				const double both  = (3. * (oldNew[l] + (contactOld ? contactOld[base + l] : 0.)) * invN[l] + 1.5 * zo * zn);
				const double along = trial > 0. ? both / trial : 0.;
				const double pairs = sixth / invN[l]; // volume the pairs stand for: the cell, but on weighted rims
				plastic += pairs * J[l] * 0.5 * (along + trial * r.scale) * r.dEqps;
				// pair work that goes into volume change rather than into the stored deviatoric energy J sigma_eq^2/(6G); zero in a uniform field
				const double vol = (coupleOld[l] + r.scale * coupleNew[l]) * invN[l] + 0.5 * (zo + szz[l]) * ti[l] * (1. / 3.);
				couple += pairs * J[l] * (vol - (threeG > 0 ? ti[l] * before * before / (2. * threeG) : 0.));
			}
		}
		if (scaleOut)
			for (int l = 0; l < blockSize; l++)
				scaleOut[base + l] = factor[l];
		for (int k = 0; k < nLinks; k++) {
			double *sk = s + k * blockSize, *tk = tau + k * blockSize;
#pragma omp simd
			for (int l = 0; l < blockSize; l++)
				sk[l] *= factor[l], tk[l] *= factor[l];
		}
		if (account) work->plastic += plastic, work->coupling += couple, work->heated += heated * m.eos.rho0;
		if (m.fracture.active()) {
			const Fracture& f    = m.fracture;
			const double *  P    = S.P.data() + base, *strength = S.strength.data() + base;
			double*         crit = S.criterion.data() + base;
			const double    invStrain = 1. / f.strain, invSpall = 1. / f.spall, invMises = 1. / f.mises, ca = 0.5 * (f.ratio + 1.), cb = 1.5 * (f.ratio - 1.);
			double worst = 0;
#pragma omp simd reduction(max : worst)
			for (int l = 0; l < blockSize; l++) {
				const double M  = factor[l] / J[l];
				const double eq = std::sqrt(fma(3. * M * M, square[l] * invN[l], 1.5 * szz[l] * szz[l]));
				double       c  = max(eqps[l] * invStrain, -P[l] * invSpall);
				c               = max(c, fma(ca, eq, -cb * P[l]) * invMises) / strength[l];
				crit[l]         = c;
				worst           = max(worst, flags[l] & linkBits ? c : 0.);
			}
			out.criterion = worst;
		}
	}
	template <YieldKind kind, bool account> void choose(Store& S, size_t b, double dt, const double* c, const double* co, double* o, BlockResult& out, BlockWork* w)
	{
		const Block& B = S.blocks[b];
		if (B.mixed) B.intact ? run<kind, true, true, account>(S, b, dt, c, co, o, out, w) : run<kind, false, true, account>(S, b, dt, c, co, o, out, w);
		else B.intact ? run<kind, true, false, account>(S, b, dt, c, co, o, out, w) : run<kind, false, false, account>(S, b, dt, c, co, o, out, w);
	}
}

void stressPass(Store& S, size_t b, double dt, const Extra& X, BlockResult& out, BlockWork* work)
{
	const Block&  B = S.blocks[b];
	const double* c = B.contact ? X.contactSq : nullptr;
	const double* co = B.contact ? X.contactOld : nullptr;
	double*       o = B.contact ? X.scale : nullptr;
	dispatch(S.materialOf(B).yield.kind, [&](auto kind) {
		if (work) choose<kind.value, true>(S, b, dt, c, co, o, out, work);
		else choose<kind.value, false>(S, b, dt, c, co, o, out, nullptr);
	});
}
}
