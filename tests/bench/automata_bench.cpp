// SPDX-License-Identifier: GPL-2.0-or-later
// Cost of the automata solver: kernels over an array, the passes of a step by the solver's own timers, whole steps, the contact search.
// Prints only; nothing is asserted. Arguments of each case: automata per side, threads (passes and steps are of one block without holes).
#include "automata/solver.hpp"
#include "isa.hpp"
#include <benchmark/benchmark.h>
#include <cmath>
#include <ctime>
#include <memory>
#include <omp.h>
#include <random>
using namespace mca;
using namespace mca::automata;

namespace {
constexpr double d = 1e-3;

Material steel(YieldKind kind)
{
	Material m;
	m.eos       = { 7830., 4578., 1.33, 1.67 };
	m.G         = 80e9;
	m.viscosity = { 0.25, 1.2 };
	m.yield.kind = kind, m.yield.yieldStress = 0.792e9, m.yield.hardeningModulus = 0.5e9;
	if (kind == YieldKind::johnsonCook) {
		Yield& y = m.yield;
		y.kind = YieldKind::johnsonCook, y.yieldStress = 0.792e9, y.hardeningModulus = 0.51e9, y.hardeningExponent = 0.26, y.rateCoefficient = 0.014,
		y.thermalSoftening = 1.03;
		y.meltTemperature = 1793., y.heatPerWork = 2.4e-7;
	}
	return m;
}

/// n x n automata in a shear flow with noise, so that all are strained; at a spacing above 1.2 d they are not linked.
std::unique_ptr<Solver> scene(YieldKind kind, int n, double spacing = d)
{
	const Material                         m = steel(kind);
	std::vector<Automaton>                 list;
	std::mt19937                           r(1);
	std::uniform_real_distribution<double> u(-10, 10);
	for (int j = 0; j < n; j++)
		for (int i = 0; i < n; i++) {
			Automaton a;
			a.position[0] = (i + 0.5 * (j & 1)) * spacing, a.position[1] = 0.86602540378443864676 * j * spacing;
			a.velocity[0] = 48 * std::sin(314. * a.position[1]) + u(r), a.velocity[1] = 48 * std::sin(314. * a.position[0]) + u(r);
			a.mass = m.eos.rho0 * Lattice::cell(d), a.inertia = 0.125 * a.mass * d * d, a.diameter = d, a.id = int(list.size()), a.group = 1;
			list.push_back(a);
		}
	Options o;
	o.sleeping = false;
	auto s = std::make_unique<Solver>();
	s->build(list, { m }, o);
	s->timing = true;
	return s;
}

void advance(Solver& s, double dt)
{
	s.computeForces();
	s.integrate(dt);
}

/// Nanoseconds per automaton and step of each pass, and of the whole step by wall clock and processor time of all threads.
template <YieldKind kind> void step(benchmark::State& state)
{
	const int n = int(state.range(0));
	omp_set_num_threads(int(state.range(1)));
	auto s = scene(kind, n);
	for (int k = 0; k < 30; k++)
		advance(*s, 1e-8);
	const Counters before = s->counters;
	const double   clocks = double(std::clock());
	for (auto _ : state)
		advance(*s, 1e-8);
	const double each = 1. / (double(n) * n * double(state.iterations()));
	const auto&  c    = s->counters;
	state.counters["ns_per_automaton"] =
		benchmark::Counter(double(n) * n * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
	state.counters["cpu_ns_per_automaton"] = (double(std::clock()) - clocks) / CLOCKS_PER_SEC * 1e9 * each;
	state.counters["density"]              = (c.nsDensity - before.nsDensity) * each;
	state.counters["stress"]               = (c.nsStress - before.nsStress) * each;
	state.counters["force"]                = (c.nsForce - before.nsForce) * each;
	state.counters["integration"]          = (c.nsIntegrate - before.nsIntegrate) * each;
	state.SetLabel(isa());
}

/// A search among automata that are all loose: placed beyond the range of links, within that of contacts.
void contactSearch(benchmark::State& state)
{
	const int n = int(state.range(0));
	omp_set_num_threads(int(state.range(1)));
	auto s = scene(YieldKind::perfect, n, 1.3 * d);
	double   spent = 0;
	for (auto _ : state) {
		s->moved(); // asks for a new search
		const double before = s->counters.nsSearch;
		s->computeForces();
		state.SetIterationTime((s->counters.nsSearch - before) * 1e-9);
		spent += s->counters.nsSearch - before;
	}
	state.counters["ns_per_automaton"] = spent / (double(n) * n * double(state.iterations()));
	state.counters["contacts_per_automaton"] = double(s->contacts.size()) / (double(n) * n);
	state.SetLabel(isa());
}

constexpr int many = 4096;

void kernelPressure(benchmark::State& state)
{
	const Eos           e = steel(YieldKind::elastic).eos;
	std::vector<double> strain(many), P(many);
	for (int k = 0; k < many; k++)
		strain[k] = -0.2 + 0.25 * k / many;
	for (auto _ : state) {
#pragma omp simd
		for (int k = 0; k < many; k++)
			P[k] = pressure<EosKind::shockAdiabat>(e, strain[k]);
		benchmark::DoNotOptimize(P.data());
		benchmark::ClobberMemory();
	}
	state.counters["ns_per_call"] = benchmark::Counter(many * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <YieldKind kind> void kernelReturn(benchmark::State& state)
{
	const Yield         y = steel(kind).yield;
	std::vector<double> trial(many), eqps(many), temperature(many), scale(many);
	for (int k = 0; k < many; k++)
		trial[k] = 0.3e9 + 1.5e9 * k / many, eqps[k] = 0.3 * k / many, temperature[k] = 300. + 400. * k / many;
	const double *t = trial.data(), *e = eqps.data(), *T = temperature.data();
	double*       to = scale.data();
	for (auto _ : state) {
#pragma omp simd
		for (int k = 0; k < many; k++)
			to[k] = radialReturn<kind>(y, t[k], e[k], T[k], 240e9, 1e-8).scale;
		benchmark::DoNotOptimize(scale.data());
		benchmark::ClobberMemory();
	}
	state.counters["ns_per_call"] = benchmark::Counter(many * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void sizes(benchmark::internal::Benchmark* b)
{
	for (int t : { 1, 2 })
		for (int n : { 32, 128, 512 })
			b->Args({ n, t });
	b->UseRealTime()->MinTime(0.2);
}
}

BENCHMARK(kernelPressure)->MinTime(0.1);
BENCHMARK(kernelReturn<YieldKind::perfect>)->MinTime(0.1);
BENCHMARK(kernelReturn<YieldKind::linearHardening>)->MinTime(0.1);
BENCHMARK(kernelReturn<YieldKind::johnsonCook>)->MinTime(0.1);
BENCHMARK(step<YieldKind::elastic>)->Apply(sizes);
BENCHMARK(step<YieldKind::perfect>)->Apply(sizes);
BENCHMARK(step<YieldKind::johnsonCook>)->Apply(sizes);
BENCHMARK(contactSearch)->ArgsProduct({ { 32, 128, 512 }, { 1, 2 } })->UseManualTime()->MinTime(0.1);
BENCHMARK_MAIN();
