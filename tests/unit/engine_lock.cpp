// SPDX-License-Identifier: GPL-2.0-or-later
// Reading while the loop runs: the lock of the engines around steps of the solver in one thread and around reading in others, with a lock that stands for the
// interpreter's. Under the thread sanitizer (plugin/CONTRIBUTING.md) it shows every access that the lock does not cover.
#include "automata_scene.hpp"
#include "yade/McaLock.hpp"
#include <atomic>
#include <thread>

namespace {
using namespace automatatest;

/// As Python's global lock.
struct Interpreter {
	static inline std::mutex mutex;
	static inline thread_local bool mine = false;
	static void take() { mutex.lock(), mine = true; }
	static void give() { mine = false, mutex.unlock(); }
	struct Held {
		Held() { take(); }
		~Held() { give(); }
	};
};
struct GiveUp {
	const bool had = Interpreter::mine;
	GiveUp()
	{
		if (had) Interpreter::give();
	}
	~GiveUp()
	{
		if (had) Interpreter::take();
	}
};

/// What a script sees at one moment.
struct Seen {
	int64_t steps = 0;
	double  px = 0, sum = 0, scale = 0;
	size_t  links = 0, broken = 0;
};

struct Engine : yade::McaLock<GiveUp> {
	Solver solver;
	Engine()
	{
		Material m              = steel(YieldKind::perfect);
		m.fracture.strain      = 0.02;
		auto a = packing(1e-3, 12, 8, m), b = packing(1e-3, 8, 8, m, { 2.3e-3, 7.1e-3 }, 96, 0, 2);
		for (auto& p : b) p.velocity[0] = 40, p.velocity[1] = -400;
		append(a, b);
		Options o;
		o.account = true;
		solver.build(a, { m }, o);
	}
	void step(int k)
	{
		locked([&] {
			solver.computeForces();
			if (k % 16 == 0) Interpreter::Held asks; // within a step, as an engine that looks at another one through Python
			solver.integrate(0.3 * solver.criticalStep());
		});
	}
	Seen see() const
	{
		return locked([&] {
			Seen        s;
			const auto& S = solver.store;
			s.steps       = solver.counters.steps;
			for (int id = 0; solver.indexOf(id) >= 0; id++) {
				const size_t i = size_t(solver.indexOf(id));
				s.sum += S.mass[i] * S.velocity[0][i], s.scale += S.mass[i] * std::fabs(S.velocity[0][i]);
				s.broken += __builtin_popcount((S.flags[i] >> hadShift) & linkBits) - __builtin_popcount(S.flags[i] & linkBits);
			}
			s.px    = solver.account().momentum[0];
			s.links = locked([&] { return solver.links().size(); }); // as a call within a call
			EXPECT_EQ(s.steps, solver.counters.steps);
			return s;
		});
	}
};

TEST(EngineLock, ReadersSeeWholeSteps)
{
	const Engine      untouched;
	Engine            engine;
	const size_t      pairs = untouched.see().links;
	std::atomic<bool> done { false };
	std::atomic<long> reads { 0 };
	int               made = 0;
	std::thread loop([&] {
		for (int k = 0; k < 400 || (reads <= 20 && k < 100000); k++) { // a busy machine lets readers in late
			made++;
			engine.step(k);
			if (k % 10 == 0) { // a PyRunner
				Interpreter::Held runs;
				engine.see();
			}
		}
		done = true;
	});
	std::vector<std::thread> readers;
	for (int r = 0; r < 3; r++)
		readers.emplace_back([&] {
			int64_t last = 0;
			do {
				Interpreter::Held prompt;
				const Seen s = engine.see();
				EXPECT_TRUE(Interpreter::mine);
				EXPECT_NEAR(s.px, s.sum, 1e-12 * s.scale);
				EXPECT_EQ(s.links + s.broken / 2, pairs); // each link holds or is broken
				EXPECT_GE(s.steps, last);
				last = s.steps, reads++;
			} while (!done);
		});
	loop.join();
	for (auto& r : readers)
		r.join();
	EXPECT_EQ(engine.see().steps, made);
	EXPECT_GT(engine.see().broken, 0u);
	EXPECT_GT(reads.load(), 20);
}

TEST(EngineLock, IsGivenBackWhenAReaderThrows)
{
	Engine engine;
	{
		Interpreter::Held prompt;
		EXPECT_THROW(engine.locked([] { throw std::runtime_error("refused"); }), std::runtime_error);
		EXPECT_TRUE(Interpreter::mine);
	}
	std::thread other([&] { engine.step(0); });
	other.join();
	EXPECT_EQ(engine.see().steps, 1);
}
}
