// SPDX-License-Identifier: GPL-2.0-or-later
// The whole state of a grid as bytes, and back. One function lists the fields for both directions; what they must be like to be let in: check_state.cpp.
#include "grid.hpp"
#include <cstring>
#include <type_traits>

namespace mca::grid {

namespace {
	[[noreturn]] void damaged() { throw Error("grid: the saved state is damaged; it cannot be restored."); }

	/// The kinds and names of all that is saved, as one number: a state belongs to this plugin when it has the same.
	struct Layout {
		static constexpr bool reading = false, describing = true;
		uint64_t              hash = lawsVersion();
		void                  names(const char* text) { hash = nameHash(text, hash); }
		void                  raw(const void*, size_t n) { hash = (hash ^ n) * 1099511628211ULL; }
	};
	struct Writer {
		static constexpr bool reading = false, describing = false;
		void                  names(const char*) { }
		std::vector<char>     bytes;
		void raw(const void* p, size_t n)
		{
			const char* c = static_cast<const char*>(p);
			bytes.insert(bytes.end(), c, c + n);
		}
	};
	struct Reader {
		static constexpr bool    reading = true, describing = false;
		void                     names(const char*) { }
		const std::vector<char>& bytes;
		size_t                   at = 0;
		size_t                   left() const { return bytes.size() - at; }
		void raw(void* p, size_t n)
		{
			if (n > left()) throw Error("grid: the saved state is cut short; it cannot be restored.");
			if (n) std::memcpy(p, bytes.data() + at, n); // the address of an empty array may be null
			at += n;
		}
	};

	template <class A, class T> std::enable_if_t<std::is_arithmetic_v<T> && !std::is_same_v<T, bool>> io(A& a, T& v) { a.raw(&v, sizeof v); }
	/// a byte of a file may be neither true nor false, and a number none of the choices
	template <class A> void io(A& a, bool& v)
	{
		unsigned char c = v ? 1 : 0;
		a.raw(&c, 1);
		if (c > 1) damaged();
		v = c == 1;
	}
	template <class A, class T> void choice(A& a, T& v, int n)
	{
		int k = int(v);
		a.raw(&k, sizeof k);
		if (k < 0 || k >= n) damaged();
		v = T(k);
	}
	template <class A> void io(A& a, YieldKind& v) { choice(a, v, yieldKinds); }
	template <class A> void io(A& a, EosKind& v) { choice(a, v, eosKinds); }
	template <class A> void io(A& a, DamageKind& v) { choice(a, v, damageKinds); }
	template <class A> void io(A& a, LoadKind& v) { choice(a, v, 3); }
	/// no more room is made than what follows can fill
	template <class A, class C> void resize(A& a, C& v, size_t bytesEach)
	{
		uint64_t n = v.size();
		a.raw(&n, sizeof n);
		if constexpr (A::reading) {
			if (n > a.left() / bytesEach) damaged();
			v.resize(size_t(n));
		}
		if constexpr (A::describing) v.resize(1); // so that the members of an entry are seen
	}
	template <class A> void io(A& a, std::string& s)
	{
		resize(a, s, 1);
		a.raw(s.data(), s.size());
	}
	template <class A, class T> void io(A& a, std::vector<T>& v);
	template <class A, class... T> void each(A& a, const char* names, T&... v);
#define MCA_EACH(a, ...) each(a, #__VA_ARGS__, __VA_ARGS__)
	template <class A> void          io(A& a, Table& t) { MCA_EACH(a, t.time, t.value); }
	template <class A> void          io(A& a, Range& r) { MCA_EACH(a, r.lo, r.hi); }
	template <class A> void          io(A& a, Constraint& c) { MCA_EACH(a, c.node, c.nx, c.ny, c.table); }
	template <class A> void          io(A& a, NodeLoad& l) { MCA_EACH(a, l.node, l.tableX, l.tableY); }
	template <class A> void          io(A& a, EdgeLoad& l)
	{
		MCA_EACH(a, l.kind, l.a, l.b, l.tableX, l.tableY, l.restLength, l.zP, l.zS, l.block, l.i, l.j);
	}
	template <class A> void io(A& a, Sample& s)
	{
		MCA_EACH(a, s.time, s.x, s.y, s.vx, s.vy, s.pressure, s.sxx, s.syy, s.sxy, s.eqps);
	}
	template <class A> void io(A& a, Gauge& g)
	{
		MCA_EACH(a, g.at.block, g.at.i, g.at.j, g.at.u, g.at.v, g.period, g.history);
	}
	template <class A> void io(A& a, Material& m)
	{
		eachConstant(m, [&](auto& v) { io(a, v); });
	}
	template <class A, class T> void io(A& a, std::vector<T>& v)
	{
		resize(a, v, std::is_same_v<T, Table> ? 16 : std::is_same_v<T, Gauge> ? 40 : sizeof(T) * 3 / 4);
		if constexpr (std::is_arithmetic_v<T>) a.raw(v.data(), v.size() * sizeof(T));
		else
			for (T& e : v) io(a, e);
	}
	template <class A> void io(A& a, Arena& arena)
	{
		for (size_t k = 0; k < arena.arrays(); k++) a.raw(arena.array(k), arena.length() * sizeof(double));
	}
	template <class A> void io(A& a, Block& b)
	{
		MCA_EACH(a, b.material, b.options.name, b.options.hourglass, b.options.edgeViscosity, b.account);
		int ni = b.ni, nj = b.nj;
		MCA_EACH(a, ni, nj);
		if constexpr (A::reading) {
			// at least twelve arrays of all nodes follow, rows of whole cache lines
			if (ni < 1 || nj < 1 || (uint64_t(ni) + 8) / 8 * 8 * (uint64_t(nj) + 1) > a.left() / (12 * sizeof(double))) damaged();
			b.allocate(ni, nj);
		}
		MCA_EACH(a, b.arena, b.awake, b.moving, b.allAwake, b.firstCopy, b.nCopies, b.interiorOpen, b.interiorOpenRowStart, b.bandWorst);
	}
	template <class A, class... T> void each(A& a, const char* names, T&... v)
	{
		a.names(names);
		(io(a, v), ...);
	}
	template <class A> void io(A& a, OpenNodes& o)
	{
		MCA_EACH(a, o.x, o.y, o.vx, o.vy, o.mass, o.addedMass, o.fx, o.fy, o.lx, o.ly, o.ex, o.ey, o.wx, o.wy, o.copyMass, o.copyVx, o.copyVy);
		for (auto& c : o.corner) io(a, c);
		MCA_EACH(a, o.copyMaster, o.copyBlock, o.copyNode, o.repeats, o.firstCopy);
	}
}

template <class A> void Boundary::fields(A& a) { MCA_EACH(a, tables_, constraints_, edgeLoads_, nodeLoads_); }

template <class A> void Grid::fields(A& a)
{
	uint64_t version = 0, count = blocks_.size();
	if constexpr (!A::describing) version = layout();
	io(a, version);
	if (!A::describing && version != layout())
		throw Error("grid: the saved state has another layout: another version of the plugin has written it and must load it.");
	MCA_EACH(a, options_.account, options_.skip, options_.safety, count);
	if constexpr (A::reading) {
		if (count > a.left() / (12 * 4 * sizeof(double))) damaged();
		for (uint64_t k = 0; k < count; k++) blocks_.push_back(std::make_unique<Block>());
	}
	if constexpr (A::describing) { // a grid without blocks would not show their members
		Block one;
		one.allocate(1, 1);
		io(a, one);
	}
	for (auto& b : blocks_) io(a, *b);
	io(a, open_);
	boundary_.fields(a);
	MCA_EACH(a, account_.loads, account_.external, account_.constraints, account_.viscous, account_.impulseX, account_.impulseY);
	MCA_EACH(a, time_, dtPrevious_, dtNow_, restSpeed_, maxRate_, restRate_);
	MCA_EACH(a, gauges_, built_, between_, ratesKnown_, steps_, failure_);
}

uint64_t Grid::layout()
{
	static const uint64_t version = [] {
		Layout l;
		Grid().fields(l);
		return l.hash;
	}();
	return version;
}

std::vector<char> Grid::save() const
{
	Writer w;
	const_cast<Grid*>(this)->fields(w); // writing changes nothing
	return std::move(w.bytes);
}

void Grid::restore(const std::vector<char>& state)
{
	Grid   fresh; // a damaged state must not cost the present one
	Reader r { state };
	fresh.fields(r);
	if (r.at != state.size()) throw Error("grid: the saved state has " + std::to_string(state.size() - r.at) + " bytes too many; it cannot be restored.");
	fresh.checkState();
	fresh.boundary_.indexAll();
	fresh.threads_ = threads_;
	*this          = std::move(fresh);
}
}
