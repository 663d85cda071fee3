// SPDX-License-Identifier: GPL-2.0-or-later
// What breaks adds to the list of contacts. With the places of the last search the list follows from who may touch whom and who is linked; a break changes both
// for its ends only, and only adds pairs. So the pairs of the ends are looked for, and all other rows stay as they are.
#include "contact_pairs.hpp"
#include <algorithm>

namespace mca::automata {

void BlockBoxes::make(const Store& S, const Vectors& at)
{
	low.resize(S.blocks.size()), high.resize(S.blocks.size());
	for (int c = 0; c < dim; c++)
		for (size_t b = 0; b < S.blocks.size(); b++) {
			const double* x     = at[c].data() + b * blockSize;
			double        least = 1e300, most = -1e300;
#pragma omp simd reduction(max : most) reduction(min : least)
			for (int l = 0; l < S.blocks[b].count; l++)
				least = min(least, x[l]), most = max(most, x[l]);
			low[c][b] = least, high[c][b] = most;
		}
}

namespace {
	struct Half {
		int32_t owner, other;
	};
	/// In the order of the list.
	struct Order {
		const Store& S;
		bool operator()(const Half& a, const Half& b) const { return a.owner != b.owner ? a.owner < b.owner : S.id[a.other] < S.id[b.other]; }
	};
	/// First and last half-contact of the row of an automaton, or where it would stand.
	std::pair<int32_t, int32_t> rowOf(const Contacts& C, int32_t i)
	{
		const auto   row = std::lower_bound(C.rowOwner.begin(), C.rowOwner.end(), i);
		const size_t r   = size_t(row - C.rowOwner.begin());
		return { C.rowBegin[r], row != C.rowOwner.end() && *row == i ? C.rowBegin[r + 1] : C.rowBegin[r] };
	}
	/// Both halves of all pairs of these automata that are not listed.
	std::vector<Half> missing(const Store& S, const Vectors& at, const BlockBoxes& boxes, const std::vector<int32_t>& ends, const Contacts& C, double skin)
	{
		std::vector<Half> more;
		const double      reach = longestReach(S, skin);
		for (int32_t i : ends) {
			const Vec<double> x   = at.at(size_t(i));
			const auto        row = rowOf(C, i);
			boxes.eachNear(x, reach, [&](size_t b) {
				for (int l = 0; l < S.blocks[b].count; l++) {
					const int32_t j = int32_t(b * blockSize) + l;
					if (plainSquare(at.at(size_t(j)) - x) >= reach2(S, i, j, skin)) continue;
					if (j == i || !touching(S, i, j) || heldApart(S, i, j)) continue;
					if (std::find(C.other.begin() + row.first, C.other.begin() + row.second, j) != C.other.begin() + row.second) continue;
					more.push_back({ i, j }), more.push_back({ j, i });
				}
			});
		}
		std::sort(more.begin(), more.end(), Order { S });
		const auto same = [](const Half& a, const Half& b) { return a.owner == b.owner && a.other == b.other; }; // both ends of a break have found it
		more.erase(std::unique(more.begin(), more.end(), same), more.end());
		return more;
	}
	/// Makes room for one entry before each of these places.
	template <class T> void spread(std::vector<T>& v, const std::vector<int32_t>& before)
	{
		auto end = v.size();
		v.resize(end + before.size());
		for (size_t k = before.size(); k-- > 0; end = size_t(before[k]))
			std::move_backward(v.begin() + before[k], v.begin() + long(end), v.begin() + long(end + k + 1));
	}
	void makeRoom(Contacts& C, const std::vector<int32_t>& before)
	{
		std::vector<int32_t> to(C.size());
		int32_t              c = 0, shift = 0;
		for (int32_t place : before) {
			for (; c < place; c++)
				to[size_t(c)] = c + shift;
			shift++;
		}
		for (; size_t(c) < to.size(); c++)
			to[size_t(c)] = c + shift;
		for (int32_t& r : C.reverse)
			r = to[size_t(r)];
		spread(C.perTwoG, before), spread(C.perOwnG, before); // they stay, too; other scratch is filled by the step
		C.eachArray([&](auto& v, Presence p) {
			if (p == Presence::scratch) v.resize(to.size() + before.size());
			else spread(v, before);
		});
	}
	void makeRows(Contacts& C)
	{
		C.rowOwner.clear(), C.rowBegin.clear();
		for (size_t c = 0; c < C.size(); c++)
			if (c == 0 || C.owner[c] != C.owner[c - 1]) C.rowOwner.push_back(C.owner[c]), C.rowBegin.push_back(int32_t(c));
		C.rowBegin.push_back(int32_t(C.size()));
	}
}

void addContacts(Store& S, const Vectors& at, const BlockBoxes& boxes, const std::vector<int32_t>& ends, Contacts& C, double skin)
{
	if (C.rowBegin.empty()) C.rowBegin.push_back(0);
	const std::vector<Half> more = missing(S, at, boxes, ends, C, skin);
	if (more.empty()) return;
	std::vector<int32_t> before;
	for (const Half& h : more) {
		const auto row   = rowOf(C, h.owner);
		const auto first = C.other.begin() + row.first, last = C.other.begin() + row.second;
		before.push_back(int32_t(std::lower_bound(first, last, h.other, [&](int32_t a, int32_t b) { return S.id[a] < S.id[b]; }) - C.other.begin()));
	}
	makeRoom(C, before);
	const auto table = pairConstants(S);
	for (size_t k = 0; k < more.size(); k++) {
		const size_t c    = size_t(before[k]) + k;
		const size_t back = size_t(std::lower_bound(more.begin(), more.end(), Half { more[k].other, more[k].owner }, Order { S }) - more.begin());
		C.owner[c] = more[k].owner, C.other[c] = more[k].other, C.reverse[c] = int32_t(size_t(before[back]) + back);
		start(S, table, C, c), takeLinkStress(S, C, c);
		S.blocks[size_t(more[k].owner) / blockSize].contact = true;
	}
	makeRows(C);
}
}
