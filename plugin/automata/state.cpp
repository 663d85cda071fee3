// SPDX-License-Identifier: GPL-2.0-or-later
// The whole state as bytes, and sorting of the arrays in space.
#include "solver.hpp"
#include "space_order.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>

namespace mca::automata {
namespace {
	constexpr uint64_t magic = 0x4d43413041303033ULL ^ lawsVersion(); // layout of this file; change it with every change of the arrays

	struct Writer {
		std::string out;
		void        raw(const void* p, size_t n) { out.append(static_cast<const char*>(p), n); }
		template <class T> void operator()(std::vector<T>& v)
		{
			static_assert(std::is_trivially_copyable<T>::value, "bytes only");
			const uint64_t n = v.size();
			raw(&n, sizeof n);
			raw(v.data(), n * sizeof(T));
		}
		template <class T> void value(T& v) { raw(&v, sizeof v); }
	};
	struct Reader {
		const std::string& in;
		size_t             at = 0;
		void               raw(void* p, size_t n)
		{
			if (n > in.size() - at) throw Error("the saved state of the automata ends too early: the file is damaged or from another version.");
			if (n) std::memcpy(p, in.data() + at, n);
			at += n;
		}
		template <class T> void operator()(std::vector<T>& v)
		{
			uint64_t n = 0;
			raw(&n, sizeof n);
			if (n > (in.size() - at) / sizeof(T)) throw Error("the saved state of the automata is damaged: an array is longer than the file.");
			v.resize(n);
			raw(v.data(), n * sizeof(T));
		}
		template <class T> void value(T& v) { raw(&v, sizeof v); }
	};
	uint64_t checksum(const char* p, size_t n)
	{
		uint64_t h = 1469598103934665603ULL; // FNV-1a over 8-byte words: finds any damaged word
		for (size_t i = 0; i + 8 <= n; i += 8) {
			uint64_t w;
			std::memcpy(&w, p + i, 8);
			h = (h ^ w) * 1099511628211ULL;
		}
		for (size_t i = n - n % 8; i < n; i++)
			h = (h ^ uint8_t(p[i])) * 1099511628211ULL;
		return h;
	}
}

template <class F> void Solver::archive(F&& f)
{
	store.eachArray(f);
	f(store.neighbour), f(store.s), f(store.tau), f(store.blocks), f(store.species), f(store.materials);
	contacts.each(f);
	for (auto v : { &scratch.sum, &scratch.square, &scratch.old, &scratch.scale, &scratch.fx, &scratch.fy, &scratch.torque, &scratch.volX, &scratch.volY, &scratch.visX, &scratch.visY,
	                &accountForce.volX, &accountForce.volY, &accountForce.visX, &accountForce.visY, &searchX, &searchY, &tiedVx, &tiedVy, &tiedW })
		f(*v);
	for (auto v : { &place, &exposed, &adjacentBegin, &adjacent, &awake, &tied })
		f(*v);
	f(results);
	f.value(options), f.value(counters), f.value(time), f.value(lastDt), f.value(lastMove), f.value(dtLimit), f.value(contactSpeed2), f.value(topologyChanged), f.value(searchDue), f.value(sums), f.value(lastSort), f.value(filterTime), f.value(flows);
}

std::string Solver::save() const
{
	Writer w;
	const_cast<Solver*>(this)->archive(w);
	const uint64_t head[2] = { magic, checksum(w.out.data(), w.out.size()) };
	return std::string(reinterpret_cast<const char*>(head), sizeof head) + w.out;
}

void Solver::load(const std::string& bytes)
{
	uint64_t head[2] = { 0, 0 };
	if (bytes.size() < sizeof head) throw Error("the saved state of the automata is empty or damaged.");
	std::memcpy(head, bytes.data(), sizeof head);
	if (head[0] != magic) throw Error("the saved state of the automata has another layout: it was written by another version of the plugin.");
	const std::string body = bytes.substr(sizeof head);
	if (head[1] != checksum(body.data(), body.size())) throw Error("the saved state of the automata is damaged: its checksum does not fit.");
	Solver fresh; // nothing of this solver changes unless all could be read
	Reader r { body };
	fresh.archive(r);
	if (r.at != body.size()) throw Error("the saved state of the automata is damaged: bytes are left over.");
	fresh.timing = timing;
	fresh.works.assign(fresh.store.blocks.size(), {});
	fresh.contacts.sizeScratch();
	contactReciprocals(fresh.store, fresh.contacts);
	fresh.contactAdjacent.clear();
	fresh.store.packAll();
	*this = std::move(fresh);
	for (size_t c = 0; c < contacts.size(); c++) {
		const int32_t a = contacts.owner[c] / blockSize, b = contacts.other[c] / blockSize;
		if (a < b) contactAdjacent.push_back({ a, b });
	}
}

// Bodies come in any order and debris moves: entries that are near in space are brought near in memory. The order of each
// automaton's links stays, so no result changes by a bit.
void Solver::sortInSpace()
{
	Store&       S = store;
	const size_t n = S.size();
	lastSort       = counters.steps;
	std::vector<SpaceKey> keys;
	for (size_t i = 0; i < n; i++)
		if (S.id[i] >= 0) keys.emplace_back(S.speciesOf(i), S.x[i], S.y[i], S.diameter[i], S.id[i], int32_t(i));
	std::sort(keys.begin(), keys.end());
	// the same blocks with the same counts: only lanes change hands, padding stays where it is
	std::vector<int32_t> source(n), target(n);
	size_t               q = 0;
	for (size_t b = 0; b < S.blocks.size(); b++)
		for (int l = 0; l < blockSize; l++) {
			const size_t i = b * blockSize + l;
			source[i]      = l < S.blocks[b].count ? keys[q++].place : int32_t(i);
		}
	for (size_t i = 0; i < n; i++)
		target[source[i]] = int32_t(i);
	S.eachArray([&](auto& v) {
		if (v.empty()) return;
		auto old = v;
		for (size_t i = 0; i < n; i++)
			v[i] = old[source[i]];
	});
	auto permuteLinks = [&](auto& v, auto map) {
		auto old = v;
		for (size_t i = 0; i < n; i++)
			for (int k = 0; k < nLinks; k++)
				v[linkSlot(i, k)] = map(old[linkSlot(source[i], k)]);
	};
	permuteLinks(S.neighbour, [&](int32_t j) { return target[j]; });
	permuteLinks(S.s, [](double v) { return v; });
	permuteLinks(S.tau, [](double v) { return v; });
	for (auto v : { &contacts.owner, &contacts.other, &contacts.rowOwner, &tied })
		for (auto& i : *v)
			i = target[i];
	for (auto v : { &scratch.sum, &scratch.square, &scratch.old, &scratch.scale, &scratch.fx, &scratch.fy, &scratch.torque, &scratch.volX, &scratch.volY, &scratch.visX, &scratch.visY,
	                &accountForce.volX, &accountForce.volY, &accountForce.visX, &accountForce.visY })
		if (!v->empty()) {
			auto old = *v;
			for (size_t i = 0; i < n; i++)
				(*v)[i] = old[source[i]];
		}
	for (size_t i = 0; i < n; i++)
		if (S.id[i] >= 0) place[S.id[i]] = int32_t(i);
	for (auto& B : S.blocks)
		B.moving = B.awake = true, B.ringsAwake = false; // motion has mixed the blocks; at rest nothing is ever sorted
	makeAdjacency();
	classify();
	counters.sorts++;
}
}
