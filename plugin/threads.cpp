// SPDX-License-Identifier: GPL-2.0-or-later
#include "threads.hpp"
#include <atomic>
#include <chrono>
#include <climits>
#include <exception>
#include <immintrin.h>
#include <linux/futex.h>
#include <omp.h>
#include <sched.h>
#include <sys/syscall.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

namespace mca {
namespace {
	constexpr int most = 64, largest = 0xffff; ///< threads; parts of a job
	/// How long a thread without work looks for some before it sleeps: longer than what lies between two loops of a step.
	constexpr std::chrono::microseconds patience { 50 };

	/// Processors of this process. With OMP_PROC_BIND or OMP_PLACES OpenMP binds the thread that calls to a part of them.
	cpu_set_t processors()
	{
		cpu_set_t set;
		CPU_ZERO(&set);
		for (int p = 0; p < omp_get_num_places(); p++) {
			std::vector<int> ids(size_t(omp_get_place_num_procs(p)));
			omp_get_place_proc_ids(p, ids.data());
			for (int id : ids)
				if (id < CPU_SETSIZE) CPU_SET(id, &set);
		}
		if (CPU_COUNT(&set) == 0) sched_getaffinity(0, sizeof set, &set);
		return set;
	}
	/// Until done() holds, or patience ends; returns whether it holds.
	template <class F> bool spin(F&& done)
	{
		const auto end = std::chrono::steady_clock::now() + patience;
		do
			for (int k = 0; k < 16; k++) {
				if (done()) return true;
				_mm_pause();
			}
		while (std::chrono::steady_clock::now() < end);
		return done();
	}

	/// Parts of a job that begin with one thread, in one word, so that who takes one knows of which job it is: job, end, next.
	struct alignas(64) Share {
		std::atomic<uint64_t> word { 0 };
		void open(uint32_t job, int first, int last)
		{
			word.store(uint64_t(job) << 32 | uint64_t(last) << 16 | uint64_t(first), std::memory_order_release);
		}
		/// The next part, or -1.
		int take()
		{
			const uint64_t now = word.load(std::memory_order_acquire);
			if ((now & 0xffff) >= (now >> 16 & 0xffff)) return -1;
			const uint64_t w = word.fetch_add(1, std::memory_order_acq_rel);
			return (w & 0xffff) < (w >> 16 & 0xffff) ? int(w & 0xffff) : -1;
		}
	};

	class Team {
		Share                 shares[most];
		std::atomic<uint32_t> jobs { 0 };
		std::atomic<int>      asleep { 0 }, width { 0 }, done { 0 };
		std::atomic<bool>     failed { false };
		void (*call)(const void*, int) = nullptr;
		const void*        context = nullptr;
		std::exception_ptr error;
		int                started = 0; ///< threads besides the caller
		std::atomic<bool>  inUse { false };

		/// Takes parts until there are none, those of thread t first.
		void work(int t)
		{
			const int n = width.load(std::memory_order_acquire);
			for (int k = 0; k < n; k++)
				for (int part; (part = shares[(t + k) % n].take()) >= 0;) {
					try {
						call(context, part);
					} catch (...) {
						if (!failed.exchange(true)) error = std::current_exception();
					}
					done.fetch_add(1, std::memory_order_release);
				}
		}
		void serve(int t)
		{
			sched_setaffinity(0, sizeof here, &here);
			for (uint32_t seen = 0;;) {
				const auto changed = [&] { return jobs.load(std::memory_order_acquire) != seen; };
				// who has no part in such jobs, or waits where threads are more than processors, would take one from who works
				const int n = width.load(std::memory_order_relaxed);
				if (!(t < n && n <= CPU_COUNT(&here) && spin(changed)) && !changed()) {
					asleep.fetch_add(1);
					while (!changed())
						syscall(SYS_futex, &jobs, FUTEX_WAIT_PRIVATE, seen, nullptr, nullptr, 0);
					asleep.fetch_sub(1);
				}
				seen = jobs.load(std::memory_order_acquire);
				if (t < width.load(std::memory_order_acquire)) work(t);
			}
		}
		const cpu_set_t here = processors();

	public:
		void run(int threads, int parts, void (*f)(const void*, int), const void* c)
		{
			threads = std::min({ threads, parts, most });
			if (threads < 2 || parts > largest || inUse.exchange(true)) { // another loop has the team, or this is one in a loop
				for (int part = 0; part < parts; part++) f(c, part);
				return;
			}
			const struct Leave {
				std::atomic<bool>& inUse;
				~Leave() { inUse.store(false); }
			} leave { inUse };
			try {
				for (; started < threads - 1; started++)
					std::thread([this, t = started + 1] { serve(t); }).detach();
			} catch (const std::system_error&) { // the system gives no more threads: the caller takes all parts
			}
			call = f, context = c, error = nullptr;
			failed.store(false), done.store(0);
			width.store(threads, std::memory_order_release);
			const uint32_t job = jobs.load(std::memory_order_relaxed) + 1;
			for (int t = 0; t < threads; t++)
				shares[t].open(job, parts * t / threads, parts * (t + 1) / threads);
			jobs.store(job);
			if (asleep.load() > 0) syscall(SYS_futex, &jobs, FUTEX_WAKE_PRIVATE, INT_MAX, nullptr, nullptr, 0);
			work(0);
			const auto all = [&] { return done.load(std::memory_order_acquire) == parts; };
			while (!spin(all))
				std::this_thread::yield();
			if (failed.load()) std::rethrow_exception(error);
		}
	};
	Team& team()
	{
		static Team* one = new Team; // never deleted: its threads may wait in it when the process ends
		return *one;
	}
}

int threads() { return std::max(1, std::min(omp_get_max_threads(), most)); }

void runParts(int threads, int parts, void (*call)(const void*, int), const void* context) { team().run(threads, parts, call, context); }
}
