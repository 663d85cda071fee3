// SPDX-License-Identifier: GPL-2.0-or-later
// The whole state as bytes, and sorting of the arrays in space. What a state must be like to be let in: check_state.cpp.
#include "solver.hpp"
#include "space_order.hpp"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>
#include <type_traits>

namespace mca::automata {
namespace {
	[[noreturn]] void damaged(const char* what) { throw Error(std::string("the saved state of the automata is damaged: ") + what + "."); }

	/// The kinds and names of all that is saved, as one number: a state belongs to this plugin when it has the same.
	struct Layout {
		uint64_t hash = lawsVersion();
		void     raw(const void*, size_t) { }
		void     names(const char* text) { hash = nameHash(text, hash); }
		void     size(size_t n) { hash = (hash ^ n) * 1099511628211ULL; }
		template <class T> void number(T& v) { size(sizeof v); }
		void                    truth(bool&) { size(1); }
		template <class T> void choice(T&, int n) { size(size_t(n)); }
		/// one entry, so that those of structs are seen
		template <class T> void resize(std::vector<T>& v, size_t)
		{
			size(sizeof(T));
			v.resize(1);
		}
	};
	struct Writer {
		std::string out;
		void        names(const char*) { }
		void        raw(const void* p, size_t n) { out.append(static_cast<const char*>(p), n); }
		template <class T> void number(T& v) { raw(&v, sizeof v); }
		void        truth(bool& v) { out.push_back(v ? 1 : 0); }
		template <class T> void choice(T& v, int) { out.push_back(char(v)); }
		template <class T> void resize(std::vector<T>& v, size_t)
		{
			const uint64_t n = v.size();
			raw(&n, sizeof n);
		}
	};
	struct Reader {
		const std::string& in;
		size_t             at = 0;
		void               names(const char*) { }
		void               raw(void* p, size_t n)
		{
			if (n > in.size() - at) damaged("it ends too early");
			if (n) std::memcpy(p, in.data() + at, n);
			at += n;
		}
		template <class T> void number(T& v) { raw(&v, sizeof v); }
		unsigned char byte()
		{
			unsigned char c;
			raw(&c, 1);
			return c;
		}
		void truth(bool& v)
		{
			const unsigned char c = byte();
			if (c > 1) damaged("a truth value is neither true nor false");
			v = c == 1;
		}
		template <class T> void choice(T& v, int n)
		{
			const int c = byte();
			if (c >= n) damaged("a choice is none of those there are");
			v = T(c);
		}
		/// least: bytes of an entry; no more room is made than the bytes that follow can fill
		template <class T> void resize(std::vector<T>& v, size_t least)
		{
			uint64_t n = 0;
			raw(&n, sizeof n);
			if (n > (in.size() - at) / least) damaged("an array is longer than the file");
			v.resize(size_t(n));
		}
	};
	// truth values and choices one by one: in raw bytes they could be anything
#define MCA_TEXT(...) #__VA_ARGS__
#define MCA_EACH(...) each(MCA_TEXT(__VA_ARGS__), __VA_ARGS__)
	template <class F> struct Fields {
		F& f;
		template <class T> std::enable_if_t<std::is_arithmetic_v<T>> operator()(T& v)
		{
			if constexpr (std::is_same_v<T, bool>) f.truth(v);
			else f.number(v);
		}
		void operator()(YieldKind& v) { f.choice(v, yieldKinds); }
		void operator()(DamageKind& v) { f.choice(v, damageKinds); }
		void operator()(EosKind& v) { f.choice(v, eosKinds); }
		void operator()(VolumeRule& v) { f.choice(v, 3); }
		void operator()(Block& b)
		{
			MCA_EACH(b.species, b.count, b.intact, b.outline, b.mixed, b.weighted, b.contact, b.awake, b.moving, b.ringsAwake);
		}
		void operator()(Species& s) { MCA_EACH(s.material, s.d); }
		void operator()(Material& m) { eachConstant(m, *this); }
		void operator()(BlockResult& r) { MCA_EACH(r.stiffest, r.closing, r.widest, r.nearest, r.criterion, r.clamped, r.bad); }
		void operator()(Options& o)
		{
			MCA_EACH(o.volumeRule, o.linkFactor, o.skin, o.sleeping, o.account, o.contacts, o.volumeFilter, o.acrossMasks, o.fullLinks);
		}
		void operator()(Counters& c) { f.number(c); }
		void operator()(Account& a) { f.number(a); }
		template <class T> void operator()(std::vector<T>& v)
		{
			constexpr bool plain = std::is_arithmetic_v<T>;
			f.resize(v, plain ? sizeof(T) : sizeof(T) * 3 / 4); // field by field there are no gaps
			if constexpr (plain) f.raw(v.data(), v.size() * sizeof(T));
			else
				for (T& e : v)
					(*this)(e);
		}
		template <class... T> void each(const char* names, T&... v)
		{
			f.names(names);
			((*this)(v), ...);
		}
		void operator()(Vectors& v)
		{
			for (auto& plane : v)
				(*this)(plane);
		}
		template <class T> void operator()(std::vector<T>& v, Presence p)
		{
			if (p != Presence::scratch) (*this)(v);
		}
	};
	static_assert(sizeof(Account) % sizeof(double) == 0 && sizeof(Counters) % sizeof(double) == 0, "numbers only, no gaps");
}

template <class F> void Solver::archive(F&& to)
{
	Fields<std::remove_reference_t<F>> f { to };
	for (auto name : automatonFieldNames)
		to.names(name), to.names(" ");
	for (auto name : contactFieldNames)
		to.names(name), to.names(" ");
	for (auto name : bondFieldNames)
		to.names(name), to.names(" ");
	store.eachArray(f);
	contacts.eachArray(f);
	bonds.eachArray(f);
	f.MCA_EACH(store.neighbour, MCA_LINK_STRESSES, store.blocks, store.species, store.materials, contacts.rowOwner, contacts.rowBegin);
	for (auto& name : contactSumNames)
		to.names(&name == contactSumNames ? "scratch." : ", scratch."), to.names(name);
	scratch.eachArray(f);
	f.each(solverVectorNames, accountForce.volumetric, accountForce.viscous, searched, tiedVelocity, tiedSpin);
	f.MCA_EACH(
		place, watch, adjacentBegin, adjacent, awake, tied, results, options, counters, time, lastDt, lastMove, dtLimit, contactSpeed2,
		topologyChanged, searchDue, sums);
	f.MCA_EACH(lastSort, filterTime, flows);
	f.MCA_EACH(asked, broken.time, broken.first, broken.second, broken.cause, broken.middle, broken.normal);
}

uint64_t Solver::layout()
{
	static const uint64_t version = [] {
		Layout l;
		Solver().archive(l);
		return l.hash;
	}();
	return version;
}

std::string Solver::save() const
{
	Writer         w;
	const uint64_t version = layout();
	w.raw(&version, sizeof version);
	const_cast<Solver*>(this)->archive(w);
	return std::move(w.out);
}

void Solver::load(const std::string& bytes)
{
	Reader   r { bytes };
	uint64_t version = 0;
	r.number(version);
	if (version != layout())
		throw Error(
			"the saved state of the automata has another layout: it is damaged, or another version of the plugin has written it and must load it.");
	Solver fresh; // nothing of this solver changes unless all could be read
	fresh.archive(r);
	if (r.at != bytes.size()) damaged("bytes are left over");
	fresh.checkState();
	fresh.knownBonds = fresh.bonds.size();
	fresh.timing = timing, fresh.wholeLists = wholeLists;
	fresh.works.assign(fresh.store.blocks.size(), {});
	fresh.contacts.sizeScratch();
	contactReciprocals(fresh.store, fresh.contacts);
	fresh.contactAdjacent.clear();
	if (!fresh.searched.empty()) fresh.nearCells.cells = Cells(fresh.searched, nearCell * fresh.store.largestDiameter()), fresh.readyWatch();
	fresh.store.packAll();
	*this = std::move(fresh);
	pushed.assign(store.outside.empty() ? 0 : store.blocks.size(), 1);
	for (size_t c = 0; c < contacts.size(); c++) {
		const int32_t a = contacts.owner[c] / blockSize, b = contacts.other[c] / blockSize;
		if (a < b) contactAdjacent.push_back({ a, b });
	}
}

std::vector<int> Solver::ids() const
{
	std::vector<int> v;
	for (size_t q = 0; q < place.size(); q++)
		if (place[q] >= 0) v.push_back(int(q));
	return v;
}

void Solver::checkOrder(const std::vector<int>& order) const
{
	if (order != ids())
		throw Error(
			"the list of bodies in the file (" + std::to_string(order.size()) + " ids) is not that of the saved automata ("
			+ std::to_string(ids().size()) + "): the file is damaged or was edited; bodies are added and erased after loading.");
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
		if (S.id[i] >= 0) keys.emplace_back(S.speciesOf(i), S.position.at(i), S.diameter[i], S.id[i], int32_t(i));
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
	const auto permute = [&](auto& v, Presence) {
		if (v.empty()) return;
		auto old = v;
		for (size_t i = 0; i < n; i++)
			v[i] = old[source[i]];
	};
	S.eachArray(permute);
	scratch.eachArray(permute);
	eachPlane([&](auto& v) { permute(v, Presence::whenUsed); }, accountForce.volumetric, accountForce.viscous);
	const std::vector<int32_t> others = S.neighbour;
	for (size_t i = 0; i < n; i++)
		for (int k = 0; k < nLinks; k++) S.neighbour[linkSlot(i, k)] = target[others[linkSlot(source[i], k)]];
	LinkStresses before = S;
	for (size_t i = 0; i < n; i++)
		for (int k = 0; k < nLinks; k++) S.setStress(linkSlot(i, k), before.stressAt(linkSlot(source[i], k)));
	for (auto v : { &contacts.owner, &contacts.other, &contacts.rowOwner, &tied })
		for (auto& i : *v)
			i = target[i];
	for (size_t i = 0; i < n; i++)
		if (S.id[i] >= 0) place[S.id[i]] = int32_t(i);
	for (auto& B : S.blocks)
		B.moving = B.awake = true, B.ringsAwake = false; // motion has mixed the blocks; at rest nothing is ever sorted
	makeAdjacency();
	classify();
	counters.sorts++;
	pushed.assign(S.outside.empty() ? 0 : S.blocks.size(), 1);
}
}
