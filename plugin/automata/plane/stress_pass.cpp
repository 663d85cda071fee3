// SPDX-License-Identifier: GPL-2.0-or-later
// Pass 2: trial stresses of the links, radial return, what the account books, fracture criteria.
#include "../passes.hpp"
#include "../returns.hpp"

namespace mca::automata {
namespace {
	/// Sums over the links (and contacts) of each automaton of a block.
	struct Sums {
		alignas(64) double square[blockSize], before[blockSize], both[blockSize], dilationBefore[blockSize], dilationTrial[blockSize],
			dilationLost[blockSize];
		PairSums<double> of(int l) const { return { square[l], before[l], both[l], dilationBefore[l], dilationTrial[l], dilationLost[l] }; }
	};
	struct PlaneReturns : Returns {
		alignas(64) double szz[blockSize];
	};

	/// (7)-(8): (J s), (J tau) of the step before become those before yield.
	template <bool intact, bool mixed, bool account>
	MCA_INLINE void trialStresses(const BlockView& V, const Store& S, DilationShares share, double dt, Sums& to)
	{
		const double twoG = 2. * V.material.G, halfDt = 0.5 * dt, d = V.d;
		for (int g = 0; g < blockSize; g += lanes) {
			const Vec<v8> x = load(V.position, g), v = load(V.velocity, g);
			const v8      w = load(V.omega + g), th = load(V.dTheta + g), perOldJ = perOldRatio(th, load(V.J + g));
			const m8      bits = intact ? m8 {} : widen(V.flags + g);
			PairSums<v8>  sums;
#pragma GCC unroll 6
			for (int k = 0; k < nLinks; k++) {
				const int32_t* j     = V.others(k, g);
				const Motion   other = gatherMotion(V.node, j);
				v8             wj, thj;
				gather2(V.node + spinAt, nodeSize, j, wj, thj);
				Vec<v8>       r = other.position - x;
				const Vec<v8> u = (other.velocity - v) * splat(dt);
				v8            spin = chord((w + wj) * halfDt), stiff = splat(twoG);
				if (mixed) // (8) with unlike arms; series rule for the stiffness
					for (int l = 0; l < lanes; l++) {
						const double q = arm(d, V.diameterOfAll[j[l]]);
						spin[l]        = pairSpin(w[l], wj[l], q, dt);
						stiff[l]       = S.pairTwoG(V.block.species, j[l], q);
					}
				const m8 on   = holding(bits, k);
				r             = choose<intact>(on, r, ofLength(splat(d)));
				const v8 dth  = pairDilation(th, thj, share);
				Pair<v8> old  = V.stress(k, g);
				old           = { old.normal * perOldJ, old.shear * perOldJ };
				Pair<v8> now  = trialStress(old, strainIncrement(r, u, spin), dth, stiff);
				now           = { choose<intact>(on, now.normal, splat(0.)), choose<intact>(on, now.shear, splat(0.)) };
				store(V.s + k * blockSize + g, now.normal), store(V.tau + k * blockSize + g, now.shear);
				const v8 weight = weights<intact>(bits, k);
				add<account>(sums, old, now, dth, weight, choose<intact>(on, weight, splat(0.)));
			}
			store(to.square + g, sums.square);
			if (account)
				store(to.before + g, sums.squareBefore), store(to.both + g, sums.both), store(to.dilationBefore + g, sums.dilationBefore),
					store(to.dilationTrial + g, sums.dilationTrial), store(to.dilationLost + g, sums.dilationLost);
		}
	}

	/// (9)-(11)
	template <YieldKind kind> MCA_INLINE void radialReturns(const BlockView& V, const Sums& sums, double dt, PlaneReturns& to)
	{
		const double twoG = 2. * V.material.G;
		double       most = 0, hottest = 0;
#pragma omp simd reduction(max : most, hottest)
		for (int l = 0; l < blockSize; l++) {
			to.szz[l]   = trialSzz(twoG, V.dTheta[l], V.szz[l]);
			to.trial[l] = equivalentStress(sums.square[l] * V.invN[l], to.szz[l]);
			most        = max(most, to.trial[l]);
			if (LawOf<kind>::heats) hottest = max(hottest, V.temperature[l]);
		}
		returnAll<kind>(V, most, hottest, dt, to);
	}

	/// State after the return; fills factor = J times its scale.
	template <YieldKind kind, bool account>
	MCA_INLINE void yieldBlock(const BlockView& V, const Sums& sums, const PlaneReturns& R, bool conjugate, double* factor, BlockWork* work)
	{
		const Yield  yield = V.material.yield;
		const double threeG = 3. * V.material.G, perRho = 1. / V.material.eos.rho0, sixth = Lattice::cell(V.d) / nLinks;
		double*      heat   = V.material.eos.heats() ? V.heat : nullptr;
		double       plastic = 0, coupling = 0, heated = 0;
#pragma omp simd reduction(+ : plastic, coupling, heated)
		for (int l = 0; l < blockSize; l++) {
			const Return r      = R.of(l);
			const double before = V.szz[l], szz = R.szz[l] * r.scale;
			factor[l]           = r.scale * V.J[l];
			V.szz[l]            = szz;
			if (LawOf<kind>::yields) V.eqps[l] += r.dEqps;
			if (LawOf<kind>::heats) V.temperature[l] = warmed(yield, V.temperature[l], R.trial[l], r);
			if (heat) {
				const double q = plasticHeat(V.J[l], R.trial[l], r, perRho);
				heat[l] += q, heated += q * V.cell[l];
			}
			if (account) {
				const PairWork w = pairWork(
					sums.of(l), R.trial[l], r, V.J[l], V.dTheta[l], before, R.szz[l], szz, threeG, sixth, V.invN[l],
					conjugate && V.factor[l] > 0.);
				plastic += w.plastic, coupling += w.coupling;
			}
		}
		if (account) work->plastic += plastic, work->coupling += coupling, work->heated += heated * V.material.eos.rho0;
	}
	MCA_INLINE void scaleLinks(const BlockView& V, const double* factor)
	{
		for (int k = 0; k < nLinks; k++) {
			double *sk = V.s + k * blockSize, *tk = V.tau + k * blockSize;
#pragma omp simd
			for (int l = 0; l < blockSize; l++)
				sk[l] *= factor[l], tk[l] *= factor[l];
		}
	}
	/// (5f), and the pushes of the affine rule with it and with the viscous pressure; account: the share of that in them, too.
	void meanPressures(const BlockView& V, bool account)
	{
		const double       full = Lattice::cell(V.d), bulk = V.material.eos.bulkModulus();
		alignas(64) double normals[blockSize], acting[blockSize];
		for (int l = 0; l < blockSize; l++) normals[l] = 0.;
		for (int k = 0; k < nLinks; k++) {
			const double* sk = V.s + k * blockSize;
#pragma omp simd
			for (int l = 0; l < blockSize; l++) {
				const double weight = (V.flags[l] >> (halfShift + k)) & 1 ? 0.5 : 1.;
				normals[l] += (V.flags[l] >> k) & 1 ? weight * sk[l] : 0.;
			}
		}
#pragma omp simd
		for (int l = 0; l < blockSize; l++) {
			const double all = meanPressure(V.P[l], normals[l], V.J[l], V.szz[l], V.invN[l], full, V.cell[l], bulk);
			const double mean = V.factor[l] > 0. ? all : V.P[l];
			V.mean[l]         = shownPressure(V.P[l], mean, V.flags[l]);
			acting[l]         = mean + V.viscous[l];
		}
		for (int l = 0; l < blockSize; l++) // factor = 0: the push is zero
			for (int c = 0; c < pushSize; c++)
				V.push[pushSize * l + c] *= acting[l] * V.cell[l];
		for (int l = 0; account && l < blockSize; l++)
			V.record[nodeSize * l + viscousShareAt] = acting[l] != 0. ? V.viscous[l] / acting[l] : 0.;
	}
	double fractureCriteria(const BlockView& V, const Sums& sums, const PlaneReturns& R, double dt)
	{
		const Criteria     c(V.material.fracture);
		double             worst = 0;
		alignas(64) double sigma[blockSize];
#pragma omp simd reduction(max : worst)
		for (int l = 0; l < blockSize; l++) {
			sigma[l]         = equivalentStressAfter(R.scale[l], sums.square[l] * V.invN[l], V.szz[l]);
			const double one = criterion(c, V.eqps[l], V.mean[l], sigma[l], V.strength[l]);
			V.criterion[l]   = one;
			worst            = max(worst, V.flags[l] & linkBits ? one : 0.);
		}
		return V.material.fracture.damage.active() ? growDamage(V, R, sigma, dt) : worst;
	}

	template <YieldKind kind, bool intact, bool mixed, bool account>
	void run(const BlockView& V, const Store& S, bool affine, double dt, const Extra& X, BlockResult& out, BlockWork* work)
	{
		const bool         contacts = V.block.contact && X.contactSq;
		Sums               sums;
		PlaneReturns       R;
		alignas(64) double factor[blockSize];
		trialStresses<intact, mixed, account>(V, S, affine ? ofOwn : ofBoth, dt, sums);
		if (contacts)
			for (int l = 0; l < blockSize; l++)
				sums.square[l] += X.contactSq[V.base + l];
		if (contacts && account)
			for (int l = 0; l < blockSize; l++)
				sums.both[l] += X.contactOld[V.base + l];
		radialReturns<kind>(V, sums, dt, R);
		yieldBlock<kind, account>(V, sums, R, affine, factor, work);
		if (contacts) std::copy(factor, factor + blockSize, X.scale + V.base);
		scaleLinks(V, factor);
		if (affine)
			meanPressures(V, account);
		else
			std::copy(V.P, V.P + blockSize, V.mean);
		if (V.material.fracture.active()) out.criterion = fractureCriteria(V, sums, R, dt);
	}
}

void stressPass(Store& S, size_t b, VolumeRule rule, double dt, const Extra& X, BlockResult& out, BlockWork* work)
{
	prefetchLinks(S, b);
	const BlockView V(S, b);
	const bool      affine = rule == VolumeRule::affine;
	if (!(dt > 0.)) return affine ? meanPressures(V, work != nullptr) : void(std::copy(V.P, V.P + blockSize, V.mean));
	dispatch(V.material.yield.kind, [&](auto kind) {
		choices([&](auto intact, auto mixed,
		            auto account) { run<kind.value, intact.value, mixed.value, account.value>(V, S, affine, dt, X, out, work); },
		        V.block.intact, V.block.mixed, work != nullptr);
	});
}
}
