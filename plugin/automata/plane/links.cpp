// SPDX-License-Identifier: GPL-2.0-or-later
// Which link of an automaton leads to which neighbour, in the plane.
#include "../solver.hpp"
#include <cmath>
#include <sstream>

namespace mca::automata {

// Link k points at 60 k degrees in the frame of the packing. The frame is found from one automaton of each linked body and handed on from
// neighbour to neighbour, so that bodies of any orientation and slightly irregular packings get consistent slots.
void Solver::placeLinks(const std::vector<Near>& near, const Solver* old)
{
	Store&               S     = store;
	std::vector<double>  frame(S.size(), 1e9);
	std::vector<int32_t> queue;
	// automata that were there before know their frame from the links they have
	for (size_t i = 0; old && i < S.size(); i++) {
		double c = 0, s = 0;
		for (int k = 0; k < nLinks; k++)
			if ((S.flags[i] >> k) & 1) {
				const int32_t j = S.neighbour[linkSlot(i, k)];
				const double  turn = Lattice::bearing(S.between(i, j)) - k * Lattice::turn;
				c += std::cos(turn), s += std::sin(turn);
			}
		if (c != 0 || s != 0) frame[i] = std::atan2(s, c);
	}
	std::vector<char> done(S.size(), 0);
	std::vector<int32_t> seeds;
	for (int pass = 0; pass < 2; pass++) // bodies that go on first
		for (size_t i = 0; i < S.size(); i++)
			if (S.id[i] >= 0 && near[i].count > 0 && (frame[i] < 1e8) == (pass == 0)) seeds.push_back(int32_t(i));
	for (size_t seed : seeds) {
		if (done[seed]) continue;
		if (frame[seed] > 1e8) frame[seed] = std::remainder(near[seed].bearing[0], Lattice::turn);
		done[seed] = 1;
		queue.assign(1, int32_t(seed));
		for (size_t q = 0; q < queue.size(); q++) {
			const size_t i   = queue[q];
			double       off = 0;
			for (int f = 0; f < near[i].count; f++) {
				const double turn = (near[i].bearing[f] - frame[i]) / Lattice::turn, slot = std::round(turn);
				const int    k = ((int(slot) % nLinks) + nLinks) % nLinks;
				off += turn - slot;
				if (std::fabs(turn - slot) > 0.42 || ((S.flags[i] >> k) & 1)) {
					std::ostringstream s;
					s << "automaton " << S.id[i] << " at " << S.position.at(i)
					  << " m: its neighbours do not stand at multiples of 60 degrees (one is off by " << 60. * std::fabs(turn - slot)
					  << " degrees). Link hexagonal packings of one orientation only; give bodies of another orientation another mask.";
					throw Error(s.str());
				}
				S.neighbour[linkSlot(i, k)] = near[i].other[f];
				S.flags[i] |= (1 << k) | (1 << (hadShift + k));
			}
			frame[i] += Lattice::turn * off / near[i].count;
			for (int f = 0; f < near[i].count; f++) {
				const int32_t j = near[i].other[f];
				if (done[j]) continue;
				if (frame[j] > 1e8) frame[j] = frame[i];
				done[j] = 1, queue.push_back(j);
			}
		}
	}
}
}
