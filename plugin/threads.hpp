// SPDX-License-Identifier: GPL-2.0-or-later
// The threads of the solvers. OpenMP keeps a team for each thread that calls it, and YADE calls from a new one in every O.run(): with more of
// them than processors its waiting threads sleep at every barrier, and waking one takes as long as a pass over ten thousand automata. Here one
// team serves all callers.
#pragma once
#include "kernels/api.hpp"
#include <algorithm>

namespace mca {

/// Threads that a loop of the solvers may use: as many as OpenMP's (yade -j, OMP_NUM_THREADS), up to 64.
MCA_API int threads();

/// call(context, part) for each part from 0 to parts - 1, once, on the calling thread and up to threads - 1 others; returns when all are done.
/// A part is taken by whoever comes first, so a thread that is late, or a busy machine, costs no more than having no such thread. An exception of
/// a part is thrown on here.
MCA_API void runParts(int threads, int parts, void (*call)(const void*, int), const void* context);

/// f(first, last) for parts of the range from 0 to n, on several threads when n is at least `least`. Results must not depend on who computes a
/// part, nor on where parts end.
template <class F> void inParts(long n, long least, const F& f)
{
	const int most = n >= least ? threads() : 1;
	if (most < 2) return n > 0 ? f(0L, n) : void();
	struct Job {
		const F& f;
		long     n, parts;
	};
	const Job job { f, n, std::min(4L * most, n) };
	runParts(most, int(job.parts), [](const void* c, int part) {
		const Job& j = *static_cast<const Job*>(c);
		j.f(j.n * part / j.parts, j.n * (part + 1) / j.parts);
	}, &job);
}

/// f(part) for each part from 0 to parts - 1, on as many threads.
template <class F> void eachPart(int parts, const F& f)
{
	if (parts < 2) return parts == 1 ? f(0) : void();
	runParts(parts, parts, [](const void* c, int part) { (*static_cast<const F*>(c))(part); }, &f);
}
}
