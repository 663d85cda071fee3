// SPDX-License-Identifier: GPL-2.0-or-later
// Cost of the grid solver: ns per cell and step by size, threads and features, beside bandwidth and flop rate in the same run.
// Prints only; nothing is asserted. Arguments of each case: cells per side, threads.
#include "grid/grid.hpp"
#include "isa.hpp"
#include "roof.hpp"
#include <benchmark/benchmark.h>
#include <chrono>
#include <ctime>
#include <random>
using namespace mca;
using namespace mca::grid;

namespace {
enum class Feature { bare, plastic, account, johnsonCook, mieGrueneisen, edge };

std::unique_ptr<Grid> scene(Feature f, int n, int threads)
{
	Material m;
	m.eos       = { 7830., 4578., 1.33, 1.67 };
	m.G         = 80e9;
	m.viscosity = { 0.25, 1.2 };
	m.yield.kind = YieldKind::linearHardening, m.yield.yieldStress = 0.792e9, m.yield.hardeningModulus = 0.5e9;
	BlockOptions o;
	if (f == Feature::bare) m.yield.kind = YieldKind::elastic, m.viscosity = { 0., 0. }, o.hourglass = 0;
	if (f == Feature::johnsonCook) {
		Yield& y = m.yield;
		y.kind = YieldKind::johnsonCook, y.yieldStress = 0.792e9, y.hardeningModulus = 0.51e9, y.hardeningExponent = 0.26, y.rateCoefficient = 0.014,
		y.thermalSoftening = 1.03;
		y.meltTemperature = 1793., y.heatPerWork = 2.4e-7;
	}
	m.eos.kind = f == Feature::mieGrueneisen ? EosKind::mieGruneisen : EosKind::shockAdiabat;
	o.edgeViscosity     = f == Feature::edge;
	auto g = std::make_unique<Grid>(GridOptions { f == Feature::account, false, 0.9 });
	std::vector<double> x;
	for (int k = 0; k <= n; k++) x.push_back(1e-3 * k);
	g->addRectangle(m, x, x, o);
	std::mt19937                           r(1);
	std::uniform_real_distribution<double> u(-20, 20);
	g->setVelocity(0, [&](double a, double b) { return std::array<double, 2> { 200 * std::sin(40 * a) + u(r), 200 * std::cos(30 * b) + u(r) }; });
	g->setThreads(threads);
	return g;
}

template <Feature f> void step(benchmark::State& state)
{
	const int n = int(state.range(0));
	auto      g = scene(f, n, int(state.range(1)));
	double    dt = 0.3 * g->criticalTimeStep();
	const auto   start = std::chrono::steady_clock::now();
	const double clocks = double(std::clock());
	for (auto _ : state) {
		g->step(dt);
		dt = std::min(dt, 0.5 * g->criticalTimeStep());
	}
	const double cells = double(n) * n * double(state.iterations());
	state.counters["ns_per_cell"]     = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() / cells;
	state.counters["cpu_ns_per_cell"] = (double(std::clock()) - clocks) / CLOCKS_PER_SEC * 1e9 / cells; // of all threads: what a busy machine still tells
	state.SetLabel(isa());
}

void roof(benchmark::State& state)
{
	const int t = int(state.range(0));
	double    bytes = 0, flops = 0;
	for (auto _ : state) {
		bytes = std::max(bytes, measureTriad(t));
		flops = std::max(flops, measureFlops(t));
	}
	state.counters["GB/s"] = bytes * 1e-9;
	state.counters["GF/s"] = flops * 1e-9;
}

void sizes(benchmark::internal::Benchmark* b)
{
	for (int t : { 1, 2 })
		for (int n : { 64, 128, 256, 512, 1024 }) b->Args({ n, t });
}
}

BENCHMARK(roof)->Arg(1)->Arg(2)->Iterations(1)->UseRealTime();
BENCHMARK(step<Feature::plastic>)->Apply(sizes)->UseRealTime()->MinTime(0.2);
BENCHMARK(step<Feature::account>)->Apply(sizes)->UseRealTime()->MinTime(0.2);
BENCHMARK(step<Feature::bare>)->Args({ 256, 1 })->Args({ 256, 2 })->UseRealTime()->MinTime(0.2);
BENCHMARK(step<Feature::johnsonCook>)->Args({ 256, 1 })->Args({ 256, 2 })->UseRealTime()->MinTime(0.2);
BENCHMARK(step<Feature::mieGrueneisen>)->Args({ 256, 1 })->Args({ 256, 2 })->UseRealTime()->MinTime(0.2);
BENCHMARK(step<Feature::edge>)->Args({ 256, 1 })->Args({ 256, 2 })->UseRealTime()->MinTime(0.2);
BENCHMARK_MAIN();
