// SPDX-License-Identifier: GPL-2.0-or-later
// Which link of an automaton leads to which neighbour, in space.
#include "../../kernels/space/frame.hpp"
#include "../solver.hpp"
#include <algorithm>
#include <cmath>
#include <sstream>

namespace mca::automata {
namespace {
	/// Frames of automata; known: those that have one.
	struct Frames {
		std::vector<Frame> of;
		std::vector<char>  known;
		explicit Frames(size_t n) : of(n), known(n, 0) { }
		void set(size_t i, const Frame& f) { of[i] = f, known[i] = 1; }
	};
	/// From the links that an automaton has kept: two that are not in a line, then all of them.
	void frameOfLinks(const Store& S, size_t i, Frames& frames)
	{
		int first = -1, second = -1;
		const auto bearing = [&](int k) { return Lattice::bearing(S.between(i, size_t(S.neighbour[linkSlot(i, k)]))); };
		for (int k = 0; k < nLinks && second < 0; k++) {
			if (!holds(S.flags[i], k)) continue;
			if (first < 0) first = k;
			else if (spanFrame(bearing(first), bearing(k))) second = k;
		}
		if (second < 0) return;
		frames.set(i, frameOf(first, second, bearing(first), bearing(second)));
		Vec<double> off {};
		for (int k = 0; k < nLinks; k++)
			if (holds(S.flags[i], k)) off += plainCross(times(frames.of[i], k), bearing(k));
		frames.of[i] = turnedFrame(frames.of[i], off * (1.5 / linkCount(S.flags[i])));
	}
	[[noreturn]] void strange(const Store& S, size_t i, double cosine)
	{
		std::ostringstream s;
		s << "automaton " << S.id[i] << " at " << S.position.at(i) << " m: its neighbours do not stand in directions of the " << Lattice::name
		  << " packing (one is off by " << std::acos(std::max(-1., std::min(cosine, 1.))) * (180. / 3.14159265358979323846)
		  << " degrees). Link packings of one orientation only; give bodies of another orientation another mask.";
		throw Error(s.str());
	}
}

// The frame of the packing is found from the automaton of each linked body that has most neighbours, and handed on from neighbour to neighbour, so that bodies
// of any orientation and slightly irregular packings get consistent slots.
void Solver::placeLinks(const std::vector<Near>& near, const Solver* old)
{
	Store&               S = store;
	Frames               frames(S.size());
	std::vector<int32_t> queue, seeds;
	for (size_t i = 0; old && i < S.size(); i++) // automata that were there before know their frame from the links they have
		frameOfLinks(S, i, frames);
	for (size_t i = 0; i < S.size(); i++)
		if (S.id[i] >= 0 && near[i].count > 0) seeds.push_back(int32_t(i));
	std::stable_sort(seeds.begin(), seeds.end(), [&](int32_t a, int32_t b) { // bodies that go on first
		return std::make_pair(frames.known[b], near[b].count) < std::make_pair(frames.known[a], near[a].count);
	});
	std::vector<char> done(S.size(), 0);
	for (size_t seed : seeds) {
		if (done[seed]) continue;
		if (!frames.known[seed]) frames.set(seed, bestFrame(near[seed].bearing, near[seed].count));
		done[seed] = 1;
		queue.assign(1, int32_t(seed));
		for (size_t q = 0; q < queue.size(); q++) {
			const size_t i   = queue[q];
			Vec<double>  off {};
			for (int f = 0; f < near[i].count; f++) {
				const Vec<double> n = near[i].bearing[f];
				const Match       m = match(frames.of[i], n);
				if (m.cosine < farthestMatch || holds(S.flags[i], m.link)) strange(S, i, m.cosine);
				off += plainCross(times(frames.of[i], m.link), n);
				S.neighbour[linkSlot(i, m.link)] = near[i].other[f];
				S.flags[i] |= (Flags(1) << m.link) | (Flags(1) << (hadShift + m.link));
			}
			frames.of[i] = turnedFrame(frames.of[i], off * (1.5 / near[i].count)); // whole stars: exactly the turn that is left
			for (int f = 0; f < near[i].count; f++) {
				const int32_t j = near[i].other[f];
				if (done[j]) continue;
				if (!frames.known[j]) frames.set(size_t(j), frames.of[i]);
				done[j] = 1, queue.push_back(j);
			}
		}
	}
}
}
