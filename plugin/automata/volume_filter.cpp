// SPDX-License-Identifier: GPL-2.0-or-later
#include "volume_filter.hpp"
#include "solver.hpp"

namespace mca::automata {

void Solver::filterVolumes()
{
	Store&     S = store;
	const long n = long(awake.size());
	curvature.resize(S.size(), 0.);
	change.resize(S.size(), 0.);
	const auto exchanges = [&](size_t i) { return S.id[i] >= 0 && exchangesVolume(S.eqps[i], S.flags[i], S.jOff[i]); };
	bool       any       = false;
#pragma omp parallel for schedule(static) reduction(|| : any) if (n >= 16)
	for (long q = 0; q < n; q++)
		for (int l = 0; l < blockSize; l++) {
			const size_t i   = size_t(awake[q]) * blockSize + l;
			double       sum = 0;
			if (exchanges(i)) {
				for (int k = 0; k < nLinks; k++)
					sum += S.J[S.neighbour[linkSlot(i, k)]] - S.J[i];
				any = true;
			}
			curvature[i] = sum;
		}
	if (any) {
#pragma omp parallel for schedule(static) if (n >= 16)
		for (long q = 0; q < n; q++) {
			const Block& B     = S.blocks[awake[q]];
			const double share = volumeExchange(options.volumeFilter, S.materialOf(B).eos.c0, filterTime, S.species[B.species].d);
			for (int l = 0; l < blockSize; l++) {
				const size_t i   = size_t(awake[q]) * blockSize + l;
				double       sum = 0;
				if (exchanges(i))
					for (int k = 0; k < nLinks; k++) {
						const size_t j = S.neighbour[linkSlot(i, k)];
						if (exchanges(j) && S.speciesOf(j) == B.species && S.blocks[j / blockSize].awake) sum += curvature[i] - curvature[j];
					}
				change[i] = share * sum;
			}
		}
		for (int32_t b : awake)
			for (size_t i = size_t(b) * blockSize; i < size_t(b + 1) * blockSize; i++)
				if (change[i] != 0.) shiftVolume(i, S.J[i] + change[i]);
	}
	filterTime = 0.;
}

// The same state at another volume: the factor in front of det F takes the change over, and the stresses stay.
void Solver::shiftVolume(size_t i, double J)
{
	Store&       S     = store;
	const Block& B     = S.blocks[i / blockSize];
	const double ratio = J / S.J[i];
	if (options.account) sums.coupling += (S.materialOf(B).eos.mieGrueneisen ? 0. : stateEnergy(i, S.J[i]) - stateEnergy(i, J)) + deviatoricEnergy(i) * (1. - ratio);
	S.J[i] = J;
	S.jOff[i] *= ratio;
	for (int k = 0; k < nLinks; k++)
		S.s[linkSlot(i, k)] *= ratio, S.tau[linkSlot(i, k)] *= ratio;
}
}
