// SPDX-License-Identifier: GPL-2.0-or-later
// A state that was read from somewhere: whatever made it, no pass may index or divide by what it holds unless it was looked at here.
#include "solver.hpp"
#include <algorithm>
#include <cmath>

namespace mca::automata {
namespace {
	using Doubles = std::vector<double>;
	using Indices = std::vector<int32_t>;

	void need(bool ok, const char* what)
	{
		if (!ok) throw Error(std::string("the saved state of the automata is damaged: ") + what + ".");
	}
	/// beyond it squares overflow; NaN is not inside
	constexpr double        largest = 1e150;
	template <class F> bool all(const Doubles& v, F&& f)
	{
		bool ok = true;
		for (double x : v) ok &= f(x);
		return ok;
	}
	bool finite(const Doubles& v)
	{
		return all(v, [](double x) { return std::fabs(x) < largest; });
	}
	bool positive(const Doubles& v)
	{
		return all(v, [](double x) { return x > 0 && x < largest; });
	}
	bool notNegative(const Doubles& v)
	{
		return all(v, [](double x) { return x >= 0 && x < largest; });
	}
	template <class F> bool allOf(F&& f, const Vectors& v) { return std::all_of(v.begin(), v.end(), f); }
	template <class F> bool allOf(F&& f, const Doubles& v) { return f(v); }
	/// f(array) holds for each array of these quantities.
	template <class F, class... V> bool allOf(F&& f, const V&... v) { return (allOf(f, v) && ...); }
	bool                                sized(const Vectors& v, size_t n)
	{
		return allOf([&](const Doubles& plane) { return plane.size() == n; }, v);
	}
	bool within(const Indices& v, size_t end)
	{
		bool ok = true;
		for (int32_t i : v) ok &= i >= 0 && size_t(i) < end;
		return ok;
	}
	/// first, ..., last entry: 0, rising or level, end
	bool offsets(const Indices& v, size_t n, size_t end)
	{
		if (v.size() != n + 1 || v.front() != 0 || size_t(v.back()) != end) return false;
		for (size_t k = 0; k < n; k++)
			if (v[k] > v[k + 1]) return false;
		return true;
	}
	bool size(std::initializer_list<const Doubles*> list, size_t n)
	{
		bool ok = true;
		for (auto v : list) ok &= v->size() == n;
		return ok;
	}

	/// Whether the stresses of links or contacts are finite.
	template <class At> bool finiteSides(size_t n, At&& at)
	{
		bool ok = true;
		for (size_t q = 0; q < n; q++) ok &= plainSquare(at(q)) < largest * largest;
		return ok;
	}
	bool stressesFinite(const Store& S)
	{
		return finiteSides(S.stresses(), [&](size_t q) { return S.stressAt(q); })
#define MCA_FINITE(name, ...) &&finite(S.name)
			MCA_DEVIATORS(MCA_FINITE);
#undef MCA_FINITE
	}
	bool sidesFinite(const Contacts& C)
	{
		return finiteSides(C.size(), [&](size_t c) { return sideOf(C, c); });
	}

	void checkBlocks(const Store& S, const Indices& place)
	{
		const size_t n = S.size();
		need(n < size_t(1) << 31 && n == S.blocks.size() * blockSize, "the number of its blocks");
		for (size_t m = 0; m < S.materials.size(); m++) validate(S.materials[m], "of the saved automata, number " + std::to_string(m));
		for (const Species& s : S.species) need(s.material >= 0 && size_t(s.material) < S.materials.size() && s.d > 0 && s.d < largest, "a species");
		for (const Block& b : S.blocks) need(b.species >= 0 && size_t(b.species) < S.species.size() && b.count > 0 && b.count <= blockSize, "a block");
		need(S.flags.size() == n && S.id.size() == n && S.group.size() == n, "the length of an array");
		size_t known = 0;
		for (size_t i = 0; i < n; i++) {
			const bool there = int(i % blockSize) < S.blocks[i / blockSize].count;
			need(there ? S.id[i] >= 0 && size_t(S.id[i]) < place.size() && size_t(place[size_t(S.id[i])]) == i : S.id[i] == -1,
			     "the number of an automaton");
			need(there || S.flags[i] == 0, "padding");
			need(!(S.flags[i] & ~(linkBits | halfBits | linkBits << hadShift | exposedBit | tiedBit | edgeBits | Flags(outlineBits))), "flags");
			known += there;
		}
		size_t listed = 0;
		for (int32_t p : place) {
			need(p >= -1, "a place");
			listed += p >= 0;
		}
		need(known == listed, "the list of places");
	}

	/// stopped: a number was not finite and has ended the run; what follows from positions may be anything then, nothing goes on with it
	void checkArrays(const Store& S, bool stopped)
	{
		const size_t n = S.size();
		const_cast<Store&>(S).eachArray(
			[&](auto& v, Presence p) { need(v.size() == n || (p == Presence::whenUsed && v.empty()), "the length of an array"); });
		bool heats = false, damages = false;
		for (const Material& m : S.materials) heats |= m.eos.heats(), damages |= m.fracture.damage.active();
		const size_t given = turnPlane(S.outsideTorque, 0).size();
		need(S.heat.empty() != heats && S.damage.empty() != damages, "the length of an array");
		need(sized(S.outside, given) && sized(S.damp, S.damp.size()), "the length of an array");
		need(allOf(finite, S.position, S.velocity, S.omega, S.angle, S.rest, S.factor, S.inertia), "a position or velocity");
		need(allOf(positive, S.mass, S.diameter, S.cell, S.invN, S.strength, S.weight), "a mass or size");
		need(allOf(notNegative, S.perMass, S.perInertia, S.damp), "a mass or damping");
		for (size_t i = 0; i < n; i++) need(S.diameter[i] == S.species[size_t(S.speciesOf(i))].d, "a diameter");
		const size_t links = n * nLinks;
		need(S.neighbour.size() == links && S.stresses() == links, "the length of the links");
		if (stopped) return;
		need(allOf(finite, S.dTheta, S.P, S.mean, S.viscous, S.h, S.temperature, S.criterion, S.heat, S.force, S.torque, S.outside, S.outsideTorque)
		             && stressesFinite(S),
		     "a stress or force");
		need(positive(S.J) && allOf(notNegative, S.eqps, S.damage), "a volume, strain or damage");
	}

	void checkLinks(const Store& S)
	{
		need(within(S.neighbour, S.size()), "a link");
		need(mirrorsFit(S), "a plane of symmetry");
		for (size_t i = 0; i < S.size(); i++) {
			const Block& b = S.blocks[i / blockSize];
			need(!b.intact || (isWhole(S.flags[i]) && !b.outline), "a block with missing links");
			const Triangles t = trianglesIn(S.flags[i]);
			need(b.outline || !t, "the outline of a block");
			need(b.weighted || !(S.flags[i] & halfBits || isMirrored(S, i)), "the weights of a block");
			for (int k = 0; k < nLinks; k++) {
				need(!trianglesBeside(t, k) || holds(S.flags[i], k), "a triangle without links");
				if (!holds(S.flags[i], k)) continue;
				const size_t j    = size_t(S.neighbour[linkSlot(i, k)]);
				const int    back = Lattice::opposite(k);
				need(j != i && S.id[j] >= 0 && ((S.flags[j] >> back) & 1) && size_t(S.neighbour[linkSlot(j, back)]) == i,
				     "a link that holds at one end only");
				need(linkWeight(S.flags[i], k) == linkWeight(S.flags[j], back), "a link of two weights");
				need(b.mixed || S.speciesOf(j) == b.species, "a link between two species");
				need(b.outline || !trianglesIn(S.flags[j]), "an outline beside a block");
			}
		}
	}

	/// waiting: a search comes before the next use of the list, which then holds only what the search takes over
	void checkContacts(const Contacts& C, const Store& S, bool stopped, bool waiting)
	{
		const size_t m = C.size();
		need(m < size_t(1) << 31 && C.other.size() == m && sidesAre(C, m) && size({ &C.rest, &C.twoG }, m), "the length of the contacts");
		need(waiting || (C.reverse.size() == m && size({ &C.d, &C.friction, &C.viscLinear, &C.viscQuadratic, &C.arm }, m)),
		     "the length of the contacts");
		need(C.rows() == 0 && C.rowBegin.empty() ? m == 0 : offsets(C.rowBegin, C.rows(), m), "the rows of the contacts");
		need(within(C.owner, S.size()) && within(C.other, S.size()) && within(C.rowOwner, S.size()) && within(C.reverse, m), "a contact");
		std::vector<char> seen(S.size(), 0);
		for (size_t r = 0; r < C.rows(); r++) {
			const size_t i = size_t(C.rowOwner[r]);
			need(!seen[i] && (waiting || r == 0 || C.rowOwner[r - 1] < C.rowOwner[r]), "two rows of contacts of one automaton");
			seen[i] = 1;
			for (int32_t c = C.rowBegin[r]; c < C.rowBegin[r + 1]; c++) need(size_t(C.owner[size_t(c)]) == i, "a row of contacts");
		}
		for (size_t c = 0; c < m; c++) {
			need(C.owner[c] != C.other[c] && S.id[size_t(C.owner[c])] >= 0 && S.id[size_t(C.other[c])] >= 0, "a contact");
			if (C.reverse.empty()) continue;
			const size_t q = size_t(C.reverse[c]);
			need(C.owner[q] == C.other[c] && C.other[q] == C.owner[c], "a contact that is listed on one side only");
		}
		need(notNegative(C.rest) && notNegative(C.twoG) && positive(C.d) && notNegative(C.friction) && notNegative(C.viscLinear)
		             && notNegative(C.viscQuadratic) && positive(C.arm),
		     "a constant of a contact");
		need(stopped || sidesFinite(C), "the stress of a contact");
	}
} // namespace

/// Broken pairs that hold together.
void Solver::checkBonds() const
{
	const Bonds& B = bonds;
	const size_t n = B.first.size();
	need(B.second.size() == n && size({ &B.rest, &B.stiffness, &B.from, &B.until, &B.most }, n) && sidesAre(B, n), "the length of the cohesive pairs");
	need(finite(B.rest) && positive(B.stiffness) && positive(B.from) && positive(B.until) && positive(B.most)
	             && finiteSides(n, [&](size_t q) { return sideOf(B, q); }),
	     "a cohesive pair");
	for (size_t q = 0; q < n; q++)
		need(indexOf(B.first[q]) >= 0 && indexOf(B.second[q]) >= 0 && B.first[q] != B.second[q] && B.until[q] > B.from[q] && B.most[q] >= B.from[q],
		     "a cohesive pair");
}

/// Links that have broken, and those that shall.
void Solver::checkBroken() const
{
	const auto&  b = broken;
	const size_t n = b.time.size();
	need(b.first.size() == n && b.second.size() == n && b.cause.size() == n && sized(b.middle, n) && sized(b.normal, n), "the length of the broken links");
	need(allOf(finite, b.time, b.middle, b.normal), "a broken link");
	for (size_t q = 0; q < n; q++) need(b.first[q] >= 0 && b.second[q] >= 0 && b.cause[q] >= 0 && b.cause[q] < breakCauses, "a broken link");
	need(asked.size() % 2 == 0, "a link to be cut");
	for (int32_t id : asked) need(indexOf(id) >= 0, "a link to be cut");
}

void Solver::checkState() const
{
	const Store& S = store;
	const size_t n = S.size(), blocks = S.blocks.size();
	for (double v : { options.linkFactor, options.skin, options.volumeFilter }) need(v >= 0 && v < 1e3, "an option");
	checkBlocks(S, place);
	need(results.size() == blocks, "the length of an array");
	bool stopped = false;
	for (const BlockResult& r : results) {
		need(r.bad >= -1 && r.bad < int64_t(n) && r.clamped >= 0, "the result of a block");
		stopped |= r.bad >= 0;
	}
	for (const BlockResult& r : results)
		need(stopped
		             || (r.stiffest >= 0 && r.stiffest < largest && std::fabs(r.closing) < largest && r.widest >= 1 && r.widest < largest
		                 && r.nearest >= 0 && std::fabs(r.criterion) < largest),
		     "the result of a block");
	checkArrays(S, stopped);
	checkLinks(S);
	checkBroken(), checkBonds();
	checkContacts(contacts, S, stopped, searchDue && options.contacts);
	const bool used = contacts.size() > 0 && !(searchDue && options.contacts);
	const auto sum  = [&](const Doubles& v, bool optional) {
                need(v.size() == n || (optional && v.empty()), "the length of an array");
                need(stopped || finite(v), "the force of a contact");
	};
	const_cast<ContactScratch&>(scratch).eachArray([&](const Doubles& v, Presence p) { sum(v, p == Presence::whenUsed || !used); });
	for (const Vectors* v : { &accountForce.volumetric, &accountForce.viscous })
		for (const Doubles& plane : *v) sum(plane, true);
	for (const Block& b : S.blocks) need(!b.contact || scratch.sum.size() == n, "a block with contacts");
	need(within(watch, n) && (sized(searched, n) || (watch.empty() && sized(searched, 0))) && allOf(finite, searched), "the list of watched automata");
	need(offsets(adjacentBegin, blocks, adjacent.size()) && within(adjacent, blocks), "the neighbours of blocks");
	need(within(awake, blocks), "the list of blocks awake");
	for (size_t k = 1; k < awake.size(); k++) need(awake[k] > awake[k - 1], "the list of blocks awake");
	need(within(tied, n) && sized(tiedVelocity, tied.size()) && turnPlane(tiedSpin, 0).size() == tied.size() && allOf(finite, tiedVelocity, tiedSpin),
	     "the list of tied automata");
	size_t carried = 0;
	for (Flags f : S.flags) carried += (f & tiedBit) != 0;
	std::vector<char> seen(n, 0);
	for (int32_t i : tied) {
		need(S.id[size_t(i)] >= 0 && (S.flags[size_t(i)] & tiedBit) && !seen[size_t(i)], "the list of tied automata");
		seen[size_t(i)] = 1;
	}
	need(carried == tied.size(), "the list of tied automata");
	for (double v : { time, lastDt, lastMove, dtLimit, filterTime }) need(v >= 0 && v <= 1e300, "a time");
	need(contactSpeed2 >= 0 && contactSpeed2 < largest, "a speed");
	const auto* booked = reinterpret_cast<const double*>(&sums);
	for (size_t k = 0; k < sizeof sums / sizeof(double); k++) need(stopped || std::fabs(booked[k]) < largest, "the account of energy");
	need(counters.steps >= 0 && counters.searches >= 0 && counters.localSearches >= 0 && counters.blockSteps >= 0 && counters.brokenLinks >= 0
	             && counters.clamped >= 0 && counters.sorts >= 0 && lastSort >= 0,
	     "a counter");
	for (double v : { counters.deepest, counters.nsDensity, counters.nsStress, counters.nsForce, counters.nsContact, counters.nsSearch,
	                  counters.nsIntegrate, counters.nsFracture })
		need(v >= 0 && v <= 1e300, "a counter");
}
} // namespace mca::automata
