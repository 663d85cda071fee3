// SPDX-License-Identifier: GPL-2.0-or-later
// Pass 2 in space: trial tractions of the links, radial return, what the account books, fracture criteria.
#include "../passes.hpp"
#include "../returns.hpp"

namespace mca::automata {
namespace {
	/// Sums over the links (and contacts) of each automaton of a block.
	struct Sums {
		alignas(64) double square[blockSize], before[blockSize], both[blockSize], dilationBefore[blockSize], dilationTrial[blockSize],
			dilationLost[blockSize];
		SymmetricLanes<blockSize> sides; ///< of the trial tractions (x) the pairs as they stand now
		PairSums<double> of(int l) const { return { square[l], before[l], both[l], dilationBefore[l], dilationTrial[l], dilationLost[l] }; }
	};
	void storeSums(const PairSums<v8>& from, const Symmetric<v8>& sides, bool account, int g, Sums& to)
	{
		store(to.square + g, from.square), to.sides.setLanes(g, sides);
		if (account)
			store(to.before + g, from.squareBefore), store(to.both + g, from.both), store(to.dilationBefore + g, from.dilationBefore),
				store(to.dilationTrial + g, from.dilationTrial), store(to.dilationLost + g, from.dilationLost);
	}

	/// What the links of eight automata do in a step.
	struct LinkMotions {
		PairMotion<v8> of[nLinks];
		Vec<v8>        r[nLinks]; ///< as they stand now
		DeformationSums<v8> sums;
	};
	/// Normal of a plane of symmetry in the laboratory; normal: in the packing, zero where there is no such plane.
	Vec<double> normalOf(int axis, Vec<double> normal)
	{
		Vec<double> n {};
		n[axis] = isZero(normal) ? 0. : 1.;
		return n;
	}
	/// The sums of those at planes of symmetry made those of full stars (S9).
	__attribute__((noinline)) void completeStars(const BlockView& V, int g, LinkMotions& m)
	{
		for (int l = 0; l < lanes; l++) {
			const size_t i = V.base + size_t(g + l);
			if (!isMirrored(V.store, i)) continue;
			Tensor<double>    moved = laneOf(m.sums.moved, l), middle = laneOf(m.sums.middle, l);
			Symmetric<double> spun = laneOf(m.sums.spun, l);
			eachMirror(V.store, i, [&](int axis, Vec<double> normal) {
				mirror(moved, axis, normal), mirror(middle, axis, normal), mirror(spun, normalOf(axis, normal));
			});
			setLane(m.sums.moved, l, moved), setLane(m.sums.middle, l, middle), setLane(m.sums.spun, l, spun);
		}
	}
	template <bool intact, bool mixed, bool account> MCA_INLINE void linkMotions(const BlockView& V, double dt, int g, LinkMotions& to)
	{
		const Vec<v8> x = load(V.position, g), v = load(V.velocity, g), w = load(V.omega, g), own = chord(w * splat(dt));
		const m8      bits = intact ? m8 {} : widen(V.flags + g);
#pragma GCC unroll 12
		for (int k = 0; k < nLinks; k++) {
			const int32_t* j     = V.others(k, g);
			const Motion   other = gatherMotion(V.node, j);
			const m8       on    = holding(bits, k);
			m8             lies  = on;
			if (account && !intact) { // a link that has just broken still has its traction: the account asks along which line it lay
				const Vec<v8> held = gatherTraction(V.tractions(k, g), inRow);
				lies |= dot(held, held) > 0.;
			}
			const Vec<v8> r = choose<intact>(lies, other.position - x, ofLength(splat(V.d))), u = (other.velocity - v) * splat(dt);
			Vec<v8>       spin  = chord((w + other.omega) * splat(0.5 * dt));
			if (mixed) // unlike arms
				for (int l = 0; l < lanes; l++) {
					const auto s = pairSpin(laneOf(w, l), laneOf(other.omega, l), arm(V.d, V.diameterOfAll[j[l]]), dt);
					for (int c = 0; c < dim; c++) spin[c][l] = s[c];
				}
			to.of[k] = pairMotion(r, u, spin), to.r[k] = r;
			if (intact) to.sums.add(k, u, to.of[k], spin - own);
			else to.sums.add(k, u, to.of[k], spin - own, on ? weights<intact>(bits, k) : v8 {});
		}
		if (V.block.weighted && hasMirrors(V.store)) completeStars(V, g, to);
	}
	/// Deviators, and J times the tractions, of the step before become those before yield. Not inlined: once for all laws.
	template <bool intact, bool mixed, bool account> __attribute__((noinline)) void trialStresses(const BlockView& V, const Store& S, double dt, Sums& to)
	{
		const v8 none {};
		for (int g = 0; g < blockSize; g += lanes) {
			const v8      th = load(V.dTheta + g), perOldJ = perOldRatio(th, load(V.J + g)), invN = load(V.invN + g);
			const m8      bits = intact ? m8 {} : widen(V.flags + g);
			LinkMotions   motions;
			linkMotions<intact, mixed, account>(V, dt, g, motions);
			Deformation<v8> own = deformation(motions.sums, Lattice::cell(V.d) / (Lattice::spread * load(V.cell + g)));
			PairSums<v8>    sums;
			Symmetric<v8>   sides {};
			if (!intact) { // where links span no volume, they hold all of the stress
				const m8 spans = load(V.factor + g) > 0.;
				own.strain     = either(spans, own.strain, isotropic(pairDilation(th, none, ofOwn)));
				for (int c = 0; c < dim; c++) own.turn[c] = spans ? own.turn[c] : none;
			}
			const Symmetric<v8> before = load(V.deviator, size_t(g));
			const auto          deviator = advance(before, own, splat(2. * V.material.G));
			store(V.deviator, size_t(g), deviator.trial);
			add<account>(sums, before, deviator, invN);
#pragma GCC unroll 1
			for (int k = 0; k < nLinks; k++) {
				const int32_t* j     = V.others(k, g);
				double*        at    = V.tractions(k, g);
				const Vec<v8>  old   = gatherTraction(at, inRow) * perOldJ, apart = times(own.strain, motions.of[k].normal);
				const m8       on    = holding(bits, k);
				v8             stiff = splat(2. * V.material.G);
				if (mixed) // series rule for the stiffness
					for (int l = 0; l < lanes; l++) stiff[l] = S.pairTwoG(V.block.species, j[l], arm(V.d, V.diameterOfAll[j[l]]));
				const auto    step   = advance(old, motions.of[k], apart, stiff);
				const Vec<v8> now    = choose<intact>(on, step.trial, Vec<v8> {});
				scatter4(at, tractionSize, now[0], now[1], now[2], none);
				const v8 weight = weights<intact>(bits, k), held = choose<intact>(on, weight, none);
				const m8 lies = account && !intact ? on | (dot(old, old) > 0.) : on;
				add<account>(sums, old, Advance<v8> { now, step.before }, apart, choose<intact>(lies, weight, none), held);
				const Vec<v8> r = motions.r[k];
				sides += symmetricDyad(now, r) * (held / root(dot(r, r)));
			}
			storeSums(sums, sides, account, g, to);
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
	MCA_INLINE void scaleDeviators(const BlockView& V, const Returns& R)
	{
		for (double* s : V.deviator.entry)
			for (int l = 0; l < blockSize; l++) s[l] *= R.scale[l];
	}
	/// Sums of weight times J times the tractions (x) the pairs, as they are now.
	void sumSides(const BlockView& V, SymmetricLanes<blockSize>& to)
	{
		for (int l = 0; l < blockSize; l++) {
			Symmetric<double> sum {};
			for (int k = 0; k < nLinks; k++) {
				const size_t slot = linkSlot(V.base + size_t(l), k);
				if (!holds(V.flags[l], k)) continue;
				const Vec<double> r = V.store.between(V.base + size_t(l), size_t(V.store.neighbour[slot]));
				sum += symmetricDyad(V.store.stressAt(slot), Lattice::bearing(r)) * linkWeight(V.flags[l], k);
			}
			to.set(l, sum);
		}
	}
	/// Those at planes of symmetry made those of full stars (S9): images have the opposite of what couples the normal to the plane.
	void completeSides(const BlockView& V, SymmetricLanes<blockSize>& sides)
	{
		for (int l = 0; hasMirrors(V.store) && l < blockSize; l++) {
			const size_t i = V.base + size_t(l);
			if (!isMirrored(V.store, i)) continue;
			Symmetric<double> sum = sides.at(l);
			eachMirror(V.store, i, [&](int axis, Vec<double> normal) { mirror(sum, normalOf(axis, normal)); });
			sides.set(l, sum);
		}
	}
	/// The pushes with P, the viscous pressure, the deviators and what the sides do; account: pressures apart, too.
	void makePushes(const BlockView& V, SymmetricLanes<blockSize>& sides, bool account)
	{
		const double              full = Lattice::cell(V.d), bulk = V.material.eos.bulkModulus();
		const SymmetricPlanes     deviator = V.deviator; // through the view nothing would vectorise
		SymmetricLanes<blockSize> own;
		alignas(64) double        acting[blockSize], cell[blockSize];
		if (V.block.weighted) completeSides(V, sides);
#pragma omp simd
		for (int l = 0; l < blockSize; l++) {
			const Symmetric<double> push = ownPush(deviator.at(size_t(l)), sides.at(l), V.J[l], full, V.cell[l], bulk);
			V.mean[l] = V.factor[l] > 0. ? meanPressure(V.P[l], push) : V.P[l];
			acting[l] = V.J[l] * (V.P[l] + V.viscous[l]);
			own.set(l, push * (V.factor[l] > 0. ? V.J[l] : 0.));
		}
		for (int l = 0; l < blockSize; l++) cell[l] = V.cell[l] / (shareOfStar(V.flags[l], V.weight[l]) * V.J[l]);
		for (int g = 0; g < blockSize; g += lanes) { // factor = 0: nothing pushes
			double*          at     = V.push + pushSize * g;
			const Tensor<v8> volume = gatherPushes(at, inRow).force * load(cell + g); // from the volume pass
			const Pushes<v8> p      = pushes(volume, load(acting + g), own.lanes(g));
			scatter(at, pushSize, p.force, p.own);
			const v8 J = load(V.J + g);
			if (account) scatter(V.shares + sharesSize * g, sharesSize, volume, J * load(V.mean + g), J * load(V.viscous + g));
		}
	}
	double fractureCriteria(const BlockView& V, const Sums& sums, const Returns& R, double dt)
	{
		const Criteria     c(V.material.fracture);
		double             worst = 0;
		alignas(64) double sigma[blockSize];
#pragma omp simd reduction(max : worst)
		for (int l = 0; l < blockSize; l++) {
			sigma[l]         = R.scale[l] * equivalentStress(sums.square[l] * V.invN[l]);
			const double one = criterion(c, V.eqps[l], V.mean[l], sigma[l], V.strength[l]);
			V.criterion[l]   = one;
			worst            = max(worst, V.flags[l] & linkBits ? one : 0.);
		}
		return V.material.fracture.damage.active() ? growDamage(V, R, sigma, dt) : worst;
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
		scaleLinks(V, factor), scaleDeviators(V, R);
		for (int l = 0; l < blockSize; l++) sums.sides.set(l, sums.sides.at(l) * factor[l]);
		makePushes(V, sums.sides, account);
		if (V.material.fracture.active()) out.criterion = fractureCriteria(V, sums, R, dt);
	}
}

void stressPass(Store& S, size_t b, VolumeRule, double dt, const Extra& X, BlockResult& out, BlockWork* work)
{
	prefetchLinks(S, b);
	const BlockView V(S, b);
	if (!(dt > 0.)) {
		SymmetricLanes<blockSize> sides;
		sumSides(V, sides);
		return makePushes(V, sides, work != nullptr);
	}
	dispatch(V.material.yield.kind, [&](auto kind) {
		const bool mixed = V.block.mixed; // rare: without a version for whole blocks
		choices([&](auto whole, auto unlike,
		            auto account) { run<kind.value, whole.value && !unlike.value, unlike.value, account.value>(V, S, dt, X, out, work); },
		        V.block.intact, mixed, work != nullptr);
	});
}
}
