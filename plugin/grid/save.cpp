// SPDX-License-Identifier: GPL-2.0-or-later
// The whole state of a grid as bytes, and back. One function lists the fields for both directions; what they must be like to be let in: check_state.cpp.
#include "grid.hpp"
#include <cstring>
#include <type_traits>

namespace mca::grid {

namespace {
	constexpr uint64_t formatVersion = 2 ^ lawsVersion(); // changes with the laws and their constants

	[[noreturn]] void damaged() { throw Error("grid: the saved state is damaged; it cannot be restored."); }

	struct Writer {
		static constexpr bool reading = false;
		std::vector<char>     bytes;
		void raw(const void* p, size_t n)
		{
			const char* c = static_cast<const char*>(p);
			bytes.insert(bytes.end(), c, c + n);
		}
	};
	struct Reader {
		static constexpr bool    reading = true;
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
	}
	template <class A> void io(A& a, std::string& s)
	{
		resize(a, s, 1);
		a.raw(s.data(), s.size());
	}
	template <class A, class T> void io(A& a, std::vector<T>& v);
	template <class A> void          io(A& a, Table& t) { io(a, t.time), io(a, t.value); }
	template <class A> void          io(A& a, Range& r) { io(a, r.lo), io(a, r.hi); }
	template <class A> void          io(A& a, Constraint& c) { io(a, c.node), io(a, c.nx), io(a, c.ny), io(a, c.table); }
	template <class A> void          io(A& a, NodeLoad& l) { io(a, l.node), io(a, l.tableX), io(a, l.tableY); }
	template <class A> void          io(A& a, EdgeLoad& l)
	{
		io(a, l.kind), io(a, l.a), io(a, l.b), io(a, l.tableX), io(a, l.tableY), io(a, l.restLength), io(a, l.zP), io(a, l.zS), io(a, l.block), io(a, l.i),
		        io(a, l.j);
	}
	template <class A> void io(A& a, Sample& s)
	{
		for (double* p : { &s.time, &s.x, &s.y, &s.vx, &s.vy, &s.pressure, &s.sxx, &s.syy, &s.sxy, &s.eqps }) io(a, *p);
	}
	template <class A> void io(A& a, Gauge& g)
	{
		io(a, g.at.block), io(a, g.at.i), io(a, g.at.j), io(a, g.at.u), io(a, g.at.v), io(a, g.period), io(a, g.history);
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
		io(a, b.material), io(a, b.options.name), io(a, b.options.hourglass), io(a, b.options.edgeViscosity), io(a, b.account);
		int ni = b.ni, nj = b.nj;
		io(a, ni), io(a, nj);
		if constexpr (A::reading) {
			// at least twelve arrays of all nodes follow, rows of whole cache lines
			if (ni < 1 || nj < 1 || (uint64_t(ni) + 8) / 8 * 8 * (uint64_t(nj) + 1) > a.left() / (12 * sizeof(double))) damaged();
			b.allocate(ni, nj);
		}
		io(a, b.arena), io(a, b.awake), io(a, b.moving), io(a, b.allAwake), io(a, b.firstCopy), io(a, b.nCopies), io(a, b.interiorOpen),
		        io(a, b.interiorOpenRowStart), io(a, b.bandWorst);
	}
	template <class A> void io(A& a, OpenNodes& o)
	{
		for (auto* v : { &o.x, &o.y, &o.vx, &o.vy, &o.mass, &o.addedMass, &o.fx, &o.fy, &o.lx, &o.ly, &o.ex, &o.ey, &o.wx, &o.wy, &o.copyMass, &o.copyVx, &o.copyVy })
			io(a, *v);
		for (auto& c : o.corner) io(a, c);
		io(a, o.copyMaster), io(a, o.copyBlock), io(a, o.copyNode), io(a, o.repeats), io(a, o.firstCopy);
	}
}

template <class A> void Boundary::fields(A& a) { io(a, tables_), io(a, constraints_), io(a, edgeLoads_), io(a, nodeLoads_); }

template <class A> void Grid::fields(A& a)
{
	uint64_t version = formatVersion, count = blocks_.size();
	io(a, version);
	if (version != formatVersion)
		throw Error("grid: the state was saved in format " + std::to_string(version) + ", this version reads format " + std::to_string(formatVersion) + ": the version that wrote it must load it.");
	io(a, options_.account), io(a, options_.skip), io(a, options_.safety), io(a, count);
	if constexpr (A::reading) {
		if (count > a.left() / (12 * 4 * sizeof(double))) damaged();
		for (uint64_t k = 0; k < count; k++) blocks_.push_back(std::make_unique<Block>());
	}
	for (auto& b : blocks_) io(a, *b);
	io(a, open_);
	boundary_.fields(a);
	for (double* p : { &account_.loads, &account_.external, &account_.constraints, &account_.viscous, &account_.impulseX, &account_.impulseY, &time_, &dtPrevious_,
	                   &dtNow_, &restSpeed_, &maxRate_, &restRate_ })
		io(a, *p);
	io(a, gauges_), io(a, built_), io(a, between_), io(a, ratesKnown_), io(a, steps_), io(a, failure_);
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
