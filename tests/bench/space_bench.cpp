// SPDX-License-Identifier: GPL-2.0-or-later
// Cost of the automata solver in space: the passes of a step by the solver's own timers, and whole steps. Prints only; nothing is asserted.
// Arguments of each case: cells of the packing per side (four automata each), threads. Compiled with MCA_DIM = 3.
#include "../unit/space_scene.hpp"
#include "isa.hpp"
#include <benchmark/benchmark.h>
#include <ctime>
#include <memory>
#include <omp.h>
using namespace spacetest;

namespace {
/// A cube in a shear flow with noise, so that all are strained.
std::unique_ptr<Solver> scene(YieldKind kind, int cells)
{
	const double d = 1e-3, half = 0.5 * unitCell * d * cells;
	Material     m = steel();
	m.yield.kind   = kind;
	auto list      = packing(d, half, straight(), m, [=](Vec<double> p) {
                for (double c : p.component)
                        if (c < -half + 1e-9 || c > half + 1e-9) return false;
                return true;
        });
	shake(list, 10., 1);
	for (auto& a : list) a.velocity[0] += 48 * std::sin(314. * a.position[1]), a.velocity[1] += 48 * std::sin(314. * a.position[2]);
	Options o;
	o.sleeping = false;
	auto s     = std::make_unique<Solver>();
	s->build(list, { m }, o);
	s->timing = true;
	return s;
}
void advanceBy(Solver& s, double dt)
{
	s.computeForces();
	s.integrate(dt);
}
template <YieldKind kind> void step(benchmark::State& state)
{
	omp_set_num_threads(int(state.range(1)));
	auto         s = scene(kind, int(state.range(0)));
	const double n = double(s->ids().size());
	for (int k = 0; k < 20; k++) advanceBy(*s, 1e-8);
	const Counters before = s->counters;
	const double   clocks = double(std::clock());
	for (auto _ : state) advanceBy(*s, 1e-8);
	const double each = 1. / (n * double(state.iterations()));
	const auto&  c    = s->counters;
	state.counters["automata"]             = n;
	state.counters["ns_per_automaton"]     = benchmark::Counter(n * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
	state.counters["cpu_ns_per_automaton"] = (double(std::clock()) - clocks) / CLOCKS_PER_SEC * 1e9 * each;
	state.counters["density"]              = (c.nsDensity - before.nsDensity) * each;
	state.counters["stress"]               = (c.nsStress - before.nsStress) * each;
	state.counters["force"]                = (c.nsForce - before.nsForce) * each;
	state.counters["integration"]          = (c.nsIntegrate - before.nsIntegrate) * each;
	state.SetLabel(isa());
}
void sizes(benchmark::internal::Benchmark* b)
{
	for (int t : { 1, 2 })
		for (int cells : { 7, 14, 29 }) // 1.4e3, 1.1e4, 1e5 automata
			b->Args({ cells, t });
	b->UseRealTime()->MinTime(0.2);
}
}

BENCHMARK(step<YieldKind::elastic>)->Apply(sizes);
BENCHMARK(step<YieldKind::linearHardening>)->Apply(sizes);
BENCHMARK_MAIN();
