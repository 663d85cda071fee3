// SPDX-License-Identifier: GPL-2.0-or-later
#include "roof.hpp"
#include "kernels/math.hpp"
#include <algorithm>
#include <chrono>
#include <memory>
#include <omp.h>

namespace mca {

namespace {
	double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }
}

double measureTriad(int threads)
{
	const long                      n = 12L << 20; // 96 MB per array
	const std::unique_ptr<double[]> a(new double[size_t(n)]), b(new double[size_t(n)]), c(new double[size_t(n)]);
	double* const                   pa = a.get();
	double* const                   pb = b.get();
	double* const                   pc = c.get();
#pragma omp parallel for schedule(static) num_threads(threads)
	for (long i = 0; i < n; i++) pa[i] = 0., pb[i] = 1., pc[i] = 2.;
	double best = 1e300;
	for (int pass = 0; pass < 5; pass++) {
		const double t = now();
#pragma omp parallel for simd schedule(static) num_threads(threads)
		for (long i = 0; i < n; i++) pa[i] = pb[i] + 3. * pc[i];
		best = std::min(best, now() - t);
		pb[pass] = pa[n - 1 - pass]; // the passes depend on one another
	}
	return 3. * sizeof(double) * double(n) / best;
}

double measureFlops(int threads)
{
	constexpr int  lanes  = 96; // enough independent chains to fill the pipelines of the widest units
	constexpr long rounds = 400000;
	double         best = 1e300, sink = 0;
	for (int pass = 0; pass < 5; pass++) {
		const double t = now();
#pragma omp parallel num_threads(threads) reduction(+ : sink)
		{
			alignas(64) double x[lanes];
			for (int k = 0; k < lanes; k++) x[k] = k + pass;
			const double f = 1. - 1e-9, g = 1e-9;
			for (long r = 0; r < rounds; r++)
#pragma GCC unroll 12
				for (int k = 0; k < lanes; k++) x[k] = fma(x[k], f, g);
			for (int k = 0; k < lanes; k++) sink += x[k];
		}
		best = std::min(best, now() - t);
	}
	// the sum is used, so that the work is done
	return sink == -1. ? 0. : 2. * lanes * double(rounds) * threads / best;
}
} // namespace mca
