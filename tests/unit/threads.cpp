// SPDX-License-Identifier: GPL-2.0-or-later
// The team of threads: every part once, whoever computes it.
#include "threads.hpp"
#include <atomic>
#include <gtest/gtest.h>
#include <omp.h>
#include <random>
#include <stdexcept>
#include <thread>
#include <unistd.h>
#include <vector>

using namespace mca;

namespace {
/// Threads that this thread may use, for as long as it lives.
struct Width {
	int before = omp_get_max_threads();
	explicit Width(int n) { omp_set_num_threads(n); }
	~Width() { omp_set_num_threads(before); }
};
}

TEST(Threads, ThereIsAThread) { EXPECT_GE(threads(), 1); }

TEST(Threads, EveryPartOnceAtAnyWidth)
{
	std::mt19937 r(3);
	for (int k = 0; k < 3000; k++) {
		const Width                   w(1 + int(r() % 5));
		const int                     parts = int(r() % 40);
		std::vector<std::atomic<int>> done(size_t(parts) + 1);
		eachPart(parts, [&](int part) { done[size_t(part)]++; });
		for (int p = 0; p < parts; p++) ASSERT_EQ(done[size_t(p)], 1) << k;
		if (k % 500 == 0) usleep(300); // the team falls asleep
	}
}

TEST(Threads, PartsOfARangeCoverItOnce)
{
	for (int n : { 0, 1, 2, 7, 100, 12345 })
		for (long least : { 0L, 50L, 1L << 40 }) {
			const Width                   w(4);
			std::vector<std::atomic<int>> done(size_t(n) + 1);
			inParts(n, least, [&](long first, long last) {
				for (long q = first; q < last; q++) done[size_t(q)]++;
			});
			for (int q = 0; q < n; q++) ASSERT_EQ(done[size_t(q)], 1);
		}
}

TEST(Threads, AnExceptionOfAPartReachesTheCallerAndTheTeamGoesOn)
{
	const Width w(3);
	for (int k = 0; k < 50; k++) {
		EXPECT_THROW(eachPart(6, [&](int part) { if (part == k % 6) throw std::runtime_error("part"); }), std::runtime_error);
		std::atomic<int> sum { 0 };
		eachPart(6, [&](int part) { sum += part; });
		EXPECT_EQ(sum, 15);
	}
}

// YADE runs steps in a thread of its own while the prompt looks at the same engine or another one.
TEST(Threads, CallersOfSeveralThreadsAndLoopsInLoops)
{
	std::atomic<long>        sum { 0 };
	std::vector<std::thread> callers;
	for (int c = 0; c < 4; c++)
		callers.emplace_back([&] {
			const Width w(3);
			for (int k = 0; k < 400; k++)
				eachPart(5, [&](int) { eachPart(2, [&](int part) { sum += part + 1; }); });
		});
	for (auto& c : callers) c.join();
	EXPECT_EQ(sum, 4 * 400 * 5 * 3);
}
