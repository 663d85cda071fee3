// SPDX-License-Identifier: GPL-2.0-or-later
// Pass 2 in space: trial tractions of the links, radial return, what the account books, fracture criteria.
#include "../passes.hpp"
#include "../returns.hpp"

namespace mca::automata {
namespace {
	/// Sums over the links (and contacts) of each automaton of a block.
	struct Sums {
		alignas(64) double square[blockSize], before[blockSize], both[blockSize], dilationBefore[blockSize], dilationTrial[blockSize],
			dilationLost[blockSize], normals[blockSize]; ///< normals: of the trial tractions along the pairs as they stand now
		PairSums<double> of(int l) const { return { square[l], before[l], both[l], dilationBefore[l], dilationTrial[l], dilationLost[l] }; }
	};
	void storeSums(const PairSums<v8>& from, v8 normals, bool account, int g, Sums& to)
	{
		store(to.square + g, from.square), store(to.normals + g, normals);
		if (account)
			store(to.before + g, from.squareBefore), store(to.both + g, from.both), store(to.dilationBefore + g, from.dilationBefore),
				store(to.dilationTrial + g, from.dilationTrial), store(to.dilationLost + g, from.dilationLost);
	}

	/// J times the tractions of the step before become those before yield. Not inlined: once for all laws.
	template <bool intact, bool mixed, bool account> __attribute__((noinline)) void trialStresses(const BlockView& V, const Store& S, double dt, Sums& to)
	{
		const v8 none {};
		for (int g = 0; g < blockSize; g += lanes) {
			const Vec<v8> x = load(V.position, g), v = load(V.velocity, g), w = load(V.omega, g);
			const v8      th = load(V.dTheta + g), perOldJ = perOldRatio(th, load(V.J + g)), dth = pairDilation(th, none, ofOwn);
			const m8      bits = intact ? m8 {} : widen(V.flags + g);
			PairSums<v8>  sums;
			v8            normals {};
#pragma GCC unroll 12
			for (int k = 0; k < nLinks; k++) {
				const int32_t* j     = V.others(k, g);
				const Motion   other = gatherMotion(V.node, j);
				double*        at    = V.tractions(k, g);
				const Vec<v8>  old   = gatherTraction(at, inRow) * perOldJ;
				const m8       on    = holding(bits, k);
				// a link that has just broken still has its traction: the account asks along which line it lay
				const m8       lies  = account && !intact ? on | (dot(old, old) > 0.) : on;
				const Vec<v8>  r     = choose<intact>(lies, other.position - x, ofLength(splat(V.d)));
				Vec<v8>        spin  = chord((w + other.omega) * splat(0.5 * dt));
				v8             stiff = splat(2. * V.material.G);
				if (mixed) // unlike arms; series rule for the stiffness
					for (int l = 0; l < lanes; l++) {
						const double q = arm(V.d, V.diameterOfAll[j[l]]);
						const auto   s = pairSpin(laneOf(w, l), laneOf(other.omega, l), q, dt);
						for (int c = 0; c < dim; c++) spin[c][l] = s[c];
						stiff[l] = S.pairTwoG(V.block.species, j[l], q);
					}
				const auto    motion = pairMotion(r, (other.velocity - v) * splat(dt), spin);
				const auto    step   = advance(old, motion, dth, stiff);
				const Vec<v8> now    = choose<intact>(on, step.trial, Vec<v8> {});
				scatter4(at, tractionSize, now[0], now[1], now[2], none);
				const v8 weight = weights<intact>(bits, k);
				add<account>(
					sums, old, Advance<v8> { now, step.before }, motion.normal, dth, choose<intact>(lies, weight, none),
					choose<intact>(on, weight, none));
				normals += weight * dot(now, r) * (1. / root(dot(r, r)));
			}
			storeSums(sums, normals, account, g, to);
		}
	}
	template <YieldKind kind> MCA_INLINE void radialReturns(const BlockView& V, const Sums& sums, double dt, Returns& to)
	{
		double most = 0, hottest = 0;
#pragma omp simd reduction(max : most, hottest)
		for (int l = 0; l < blockSize; l++) {
			to.trial[l] = equivalentStress(sums.square[l] * V.invN[l]);
			most        = max(most, to.trial[l]);
			if (LawOf<kind>::heats) hottest = max(hottest, V.temperature[l]);
		}
		returnAll<kind>(V, most, hottest, dt, to);
	}
	/// State after the return; fills factor = J times its scale.
	template <YieldKind kind, bool account>
	MCA_INLINE void yieldBlock(const BlockView& V, const Sums& sums, const Returns& R, double* factor, BlockWork* work)
	{
		const Yield  yield = V.material.yield;
		const double threeG = 3. * V.material.G, perRho = 1. / V.material.eos.rho0, share = Lattice::cell(V.d) / nLinks;
		double*      heat   = V.material.eos.heats() ? V.heat : nullptr;
		double       plastic = 0, coupling = 0, heated = 0;
#pragma omp simd reduction(+ : plastic, coupling, heated)
		for (int l = 0; l < blockSize; l++) {
			const Return r = R.of(l);
			factor[l]      = r.scale * V.J[l];
			if (LawOf<kind>::yields) V.eqps[l] += r.dEqps;
			if (LawOf<kind>::heats) V.temperature[l] = warmed(yield, V.temperature[l], R.trial[l], r);
			if (heat) {
				const double q = plasticHeat(V.J[l], R.trial[l], r, perRho);
				heat[l] += q, heated += q * V.cell[l];
			}
			if (account) {
				const PairWork w = pairWork(sums.of(l), R.trial[l], r, V.J[l], V.dTheta[l], threeG, share, V.invN[l], V.factor[l] > 0.);
				plastic += w.plastic, coupling += w.coupling;
			}
		}
		if (account) work->plastic += plastic, work->coupling += coupling, work->heated += heated * V.material.eos.rho0;
	}
	MCA_INLINE void scaleLinks(const BlockView& V, const double* factor)
	{
		for (int k = 0; k < nLinks; k++) {
			double* t = V.tractions(k, 0);
			for (int l = 0; l < blockSize; l++)
				for (int c = 0; c < tractionSize; c++) t[l * tractionSize + c] *= factor[l];
		}
	}
	/// Sum of weight times J times the tractions along the pairs, as they are now.
	void sumNormals(const BlockView& V, double* normals)
	{
		for (int l = 0; l < blockSize; l++) {
			normals[l] = 0.;
			for (int k = 0; k < nLinks; k++) {
				const size_t slot = linkSlot(V.base + size_t(l), k);
				if (!holds(V.flags[l], k)) continue;
				const Vec<double> r = V.store.between(V.base + size_t(l), size_t(V.store.neighbour[slot]));
				normals[l] += linkWeight(V.flags[l], k) * normalStress(V.store.stressAt(slot), r);
			}
		}
	}
	/// The pushes with meanPressure() and with the viscous pressure; account: the share of that in them, too.
	void meanPressures(const BlockView& V, const double* normals, bool account)
	{
		const double       full = Lattice::cell(V.d), bulk = V.material.eos.bulkModulus();
		alignas(64) double acting[blockSize];
#pragma omp simd
		for (int l = 0; l < blockSize; l++) {
			const double all = meanPressure(V.P[l], normals[l], V.J[l], full, V.cell[l], bulk);
			V.mean[l]        = V.factor[l] > 0. ? all : V.P[l];
			acting[l]        = V.mean[l] + V.viscous[l];
		}
		for (int l = 0; l < blockSize; l++) // factor = 0: the push is zero
			for (int c = 0; c < pushSize; c++) V.push[pushSize * l + c] *= acting[l] * (V.cell[l] / shareOfStar(V.flags[l], V.weight[l]));
		for (int l = 0; account && l < blockSize; l++)
			V.record[nodeSize * l + viscousShareAt] = acting[l] != 0. ? V.viscous[l] / acting[l] : 0.;
	}
	double fractureCriteria(const BlockView& V, const Sums& sums, const Returns& R)
	{
		const Criteria c(V.material.fracture);
		double         worst = 0;
#pragma omp simd reduction(max : worst)
		for (int l = 0; l < blockSize; l++) {
			const double one = criterion(c, V.eqps[l], V.mean[l], R.scale[l] * equivalentStress(sums.square[l] * V.invN[l]), V.strength[l]);
			V.criterion[l]   = one;
			worst            = max(worst, V.flags[l] & linkBits ? one : 0.);
		}
		return worst;
	}

	template <YieldKind kind, bool intact, bool mixed, bool account>
	void run(const BlockView& V, const Store& S, double dt, const Extra& X, BlockResult& out, BlockWork* work)
	{
		const bool         contacts = V.block.contact && X.contactSq;
		Sums               sums;
		Returns            R;
		alignas(64) double factor[blockSize];
		trialStresses<intact, mixed, account>(V, S, dt, sums);
		for (int l = 0; contacts && l < blockSize; l++) sums.square[l] += X.contactSq[V.base + l];
		for (int l = 0; contacts && account && l < blockSize; l++) sums.both[l] += X.contactOld[V.base + l];
		radialReturns<kind>(V, sums, dt, R);
		yieldBlock<kind, account>(V, sums, R, factor, work);
		if (contacts) std::copy(factor, factor + blockSize, X.scale + V.base);
		scaleLinks(V, factor);
		for (int l = 0; l < blockSize; l++) sums.normals[l] *= factor[l];
		meanPressures(V, sums.normals, account);
		if (V.material.fracture.active()) out.criterion = fractureCriteria(V, sums, R);
	}
}

void stressPass(Store& S, size_t b, VolumeRule, double dt, const Extra& X, BlockResult& out, BlockWork* work)
{
	prefetchLinks(S, b);
	const BlockView V(S, b);
	if (!(dt > 0.)) {
		alignas(64) double normals[blockSize];
		sumNormals(V, normals);
		return meanPressures(V, normals, work != nullptr);
	}
	dispatch(V.material.yield.kind, [&](auto kind) {
		const bool mixed = V.block.mixed; // rare: without a version for whole blocks
		choices([&](auto whole, auto unlike,
		            auto account) { run<kind.value, whole.value && !unlike.value, unlike.value, account.value>(V, S, dt, X, out, work); },
		        V.block.intact, mixed, work != nullptr);
	});
}
}
