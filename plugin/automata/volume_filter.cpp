// SPDX-License-Identifier: GPL-2.0-or-later
#include "../kernels/automaton/filter.hpp"
#include "parallel.hpp"
#include <atomic>

namespace mca::automata {
namespace {
	/// Second differences of J of a block, zero for who takes no part; returns whether anybody does.
	bool curvatures(const Store& S, size_t b, double* takesPart, double* curvature)
	{
		const size_t   base = b * blockSize;
		const double * J = S.J.data(), *eqps = S.eqps.data() + base, *factor = S.factor.data() + base, *weight = S.weight.data() + base;
		const Flags*   flags = S.flags.data() + base;
		const int32_t* nb    = S.neighbour.data() + b * nLinks * blockSize;
		double         any = 0;
#pragma omp simd reduction(max : any)
		for (int l = 0; l < blockSize; l++) {
			takesPart[base + l] = exchangesVolume(eqps[l], flags[l], factor[l]) ? 1. : 0.;
			any                 = max(any, takesPart[base + l]);
		}
		for (int l = 0; l < blockSize; l++)
			curvature[base + l] = 0.;
		if (!(any > 0.)) return false;
		for (int k = 0; k < nLinks; k++)
#pragma omp simd
			for (int l = 0; l < blockSize; l++)
				curvature[base + l] += takesPart[base + l] * exchangeWeight(flags[l], weight[l], k) * (J[nb[k * blockSize + l]] - J[base + l]);
		return true;
	}
}

void Solver::filterVolumes()
{
	Store&     S = store;
	takesPart.assign(S.size(), 0.); // who sleeps takes no part
	for (auto v : { &curvature, &change })
		v->resize(S.size(), 0.);
	std::atomic<bool> any { false };
	eachAwake([&](size_t b) {
		if (curvatures(S, b, takesPart.data(), curvature.data())) any.store(true, std::memory_order_relaxed);
	});
	const double lasted = filterTime;
	filterTime          = 0.;
	if (!any) return;
	eachAwake([&](size_t b) { volumeChanges(b, lasted); });
	std::vector<double> booked(S.blocks.size(), 0.);
	eachAwake([&](size_t b) {
		for (size_t i = b * blockSize; i < (b + 1) * blockSize; i++)
			if (change[i] != 0.) booked[b] += shiftVolume(i, S.J[i] + change[i]);
	});
	for (double w : booked) sums.coupling += w;
}

/// What each automaton of a block gets from its neighbours in so long a time [s].
void Solver::volumeChanges(size_t b, double lasted)
{
	const Store&   S     = store;
	const size_t   base  = b * blockSize;
	const Block&   B     = S.blocks[b];
	const double   share = volumeExchange(options.volumeFilter, S.materialOf(B).eos.c0, lasted, S.species[B.species].d);
	const int32_t* nb    = S.neighbour.data() + b * nLinks * blockSize;
	double*        to    = change.data() + base;
	const double * part = takesPart.data(), *curve = curvature.data(), *weight = S.weight.data() + base;
	const Flags*   flags = S.flags.data() + base;
	for (int l = 0; l < blockSize; l++)
		to[l] = 0.;
	for (int k = 0; k < nLinks; k++)
		if (B.mixed)
			for (int l = 0; l < blockSize; l++) {
				const int32_t j = nb[k * blockSize + l];
				if (S.speciesOf(j) == B.species) to[l] += part[j] * exchangeWeight(flags[l], weight[l], k) * (curve[base + l] - curve[j]);
			}
		else
#pragma omp simd
			for (int l = 0; l < blockSize; l++) {
				const int32_t j = nb[k * blockSize + l];
				to[l] += part[j] * exchangeWeight(flags[l], weight[l], k) * (curve[base + l] - curve[j]);
			}
	for (int l = 0; l < blockSize; l++)
		to[l] *= share * part[base + l];
}

// The same state at another volume: the factor in front of det F takes the change over, and the stresses stay.
/// Returns the energy that it takes [J/m]; for the account.
double Solver::shiftVolume(size_t i, double J)
{
	Store&       S     = store;
	const double ratio = J / S.J[i];
	double       taken = 0.;
	if (options.account)
		taken = (S.materialOf(i).eos.heats() ? 0. : coldEnergyAt(i, S.J[i]) - coldEnergyAt(i, J)) + deviatorEnergyOf(i) * (1. - ratio);
	S.J[i] = J;
	S.factor[i] *= ratio;
	scaleStresses(i, ratio);
	return taken;
}
}
