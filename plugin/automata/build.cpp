// SPDX-License-Identifier: GPL-2.0-or-later
// Set-up: checks, order in space, blocks, links.
#include "solver.hpp"
#include "space_order.hpp"
#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <unordered_map>

namespace mca::automata {
namespace {
	void check(const Automaton& a, size_t nMaterials)
	{
		auto refuse = [&](const std::string& what) { throw Error("automaton " + std::to_string(a.id) + ": " + what); };
		auto number = [](auto v) {
			std::ostringstream s;
			s << v;
			return s.str();
		};
		auto finite = [&](double v) {
			if (!std::isfinite(v))
				refuse("position, velocity, mass, inertia, diameter, weight or strength is not finite (" + number(v)
				       + "); give finite numbers.");
		};
		for (const Vec<double>& v : { a.position, a.velocity }) std::for_each(v.component, v.component + dim, finite);
		for (const Turn<double>& v : { a.omega, a.angle })
			for (int c = 0; c < turns; c++) finite(turnComponent(v, c));
		for (double v : { a.mass, a.inertia, a.diameter, a.weight, a.strength }) finite(v);
		if (!(a.diameter > 0)) refuse("diameter " + number(a.diameter) + " m must be above zero.");
		for (double x : a.position.component)
			if (!(std::fabs(x) < 1e9 * a.diameter)) refuse("position " + number(a.position) + " m must be within 1e9 diameters of the origin.");
		if (!(a.temperature >= 0 && std::isfinite(a.temperature)))
			refuse("temperature " + number(a.temperature) + " K must be finite and not negative.");
		if (!(a.mass > 0)) refuse("mass " + number(a.mass) + " kg/m must be above zero; set state.mass (rho times area).");
		if (any(a.freeR) && !(a.inertia > 0)) refuse("inertia " + number(a.inertia) + " kg m must be above zero, or block the rotation.");
		if (!(a.weight > 0 && a.weight <= 2)) refuse("weight " + number(a.weight) + " must be in (0, 2].");
		if (!(a.eqps >= 0 && std::isfinite(a.eqps))) refuse("plastic strain " + number(a.eqps) + " must be finite and not negative.");
		if (!(a.damage >= 0 && std::isfinite(a.damage))) refuse("damage " + number(a.damage) + " must be finite and not negative.");
		if (!(a.strength > 0)) refuse("strength factor " + number(a.strength) + " must be above zero.");
		if (a.material < 0 || size_t(a.material) >= nMaterials) refuse("unknown material number " + std::to_string(a.material) + ".");
		if (a.triangles < 0 || a.triangles > nLinks)
			refuse("triangles " + std::to_string(a.triangles) + " must be from 0 to " + std::to_string(nLinks) + ".");
		if (a.id < 0) refuse("negative number.");
	}
}

void Solver::makeBlocks(const std::vector<Automaton>& in)
{
	Store& S = store;
	std::vector<SpaceKey> keys;
	keys.reserve(in.size());
	for (auto& a : in) {
		int sp = -1;
		for (size_t q = 0; q < S.species.size(); q++)
			if (S.species[q].material == a.material && S.species[q].d == a.diameter) sp = int(q);
		if (sp < 0) sp = int(S.species.size()), S.species.push_back({ a.material, a.diameter });
		keys.emplace_back(sp, a.position, a.diameter, a.id, int32_t(keys.size()));
	}
	checkCohesion(S.pairRules);
	std::sort(keys.begin(), keys.end());
	std::vector<int64_t> source; // entry of the input for each lane, -1 = padding
	for (const SpaceKey& key : keys) {
		const int32_t sp = key.species;
		if (S.blocks.empty() || S.blocks.back().species != sp || S.blocks.back().count == blockSize) {
			source.resize(S.blocks.size() * blockSize, -1);
			S.blocks.emplace_back();
			S.blocks.back().species = sp;
		}
		source.push_back(key.place);
		S.blocks.back().count++;
	}
	source.resize(S.blocks.size() * blockSize, -1);
	const size_t n = source.size();
	S.eachArray([&](auto& v, Presence p) { v.assign(p == Presence::always ? n : 0, {}); });
	if (std::any_of(S.materials.begin(), S.materials.end(), [](const Material& m) { return m.eos.heats(); })) S.heat.assign(n, 0.);
	if (std::any_of(S.materials.begin(), S.materials.end(), [](const Material& m) { return m.fracture.damage.active(); })) S.damage.assign(n, 0.);
	int32_t maxId = -1;
	for (auto& a : in)
		maxId = std::max(maxId, a.id);
	place.assign(maxId + 1, -1);
	isNew.assign(place.size(), 0);
	for (auto& a : in)
		isNew[size_t(a.id)] = a.isNew;
	for (size_t i = 0; i < n; i++) {
		const Species& sp = S.species[S.blocks[i / blockSize].species];
		S.diameter[i]     = sp.d;
		S.J[i] = 1., S.mass[i] = 1., S.inertia[i] = 1., S.invN[i] = 1. / nLinks, S.cell[i] = Lattice::cell(sp.d), S.id[i] = -1, S.strength[i] = 1.,
		S.weight[i]      = 1.;
		S.temperature[i] = S.materials[sp.material].yield.referenceTemperature;
		if (source[i] < 0) { // padding sits on its block's first automaton, without links
			const size_t first = i - i % blockSize;
			S.position.set(i, S.position.at(first));
			continue;
		}
		const Automaton& a = in[source[i]];
		if (place[a.id] >= 0) throw Error("automaton " + std::to_string(a.id) + " is given twice.");
		place[a.id] = int32_t(i);
		S.position.set(i, a.position), S.velocity.set(i, a.velocity), setTurn(S.omega, i, a.omega), setTurn(S.angle, i, a.angle);
		S.mass[i] = a.mass, S.inertia[i] = a.inertia, S.weight[i] = a.weight, S.strength[i] = a.strength, S.eqps[i] = a.eqps;
		for (int c = 0; c < dim; c++) S.perMass[c][i] = a.free[c] ? 1. / a.mass : 0.;
		for (int c = 0; c < turns; c++) turnPlane(S.perInertia, c)[i] = turnComponent(a.freeR, c) ? 1. / a.inertia : 0.;
		S.id[i] = a.id, S.group[i] = a.group;
		if (a.temperature > 0) S.temperature[i] = a.temperature;
		if (!S.damage.empty()) S.damage[i] = a.damage;
		S.cell[i] *= a.weight;
	}
}

void Solver::makeLinks(const Solver* old)
{
	Store&       S = store;
	const size_t n = S.size();
	double       dMax = 0;
	for (auto& sp : S.species)
		dMax = std::max(dMax, sp.d);
	const double size = dMax * options.linkFactor;
	std::unordered_map<int64_t, std::vector<int32_t>> cells;
	auto                                              key = [&](size_t i, Vec<int64_t> offset) {
                int64_t hash = 0;
                for (int c = 0; c < dim; c++) hash = hash * 4294967291LL + int64_t(std::floor(S.position[c][i] / size)) + offset[c];
                return hash;
	};
	for (size_t i = 0; i < n; i++)
		if (S.id[i] >= 0) cells[key(i, {})].push_back(int32_t(i));
	S.neighbour.resize(S.blocks.size() * nLinks * blockSize);
	for (size_t i = 0; i < n; i++)
		for (int k = 0; k < nLinks; k++)
			S.neighbour[linkSlot(i, k)] = int32_t(i);
	S.resizeStresses(S.neighbour.size());
	if (old) inheritLinks(*old);
	auto              known = [&](size_t i) { return old && indexIn(*old, S.id[i]) >= 0; };
	std::vector<Near> near(n);
	int64_t           crowded = -1; // told after all overlaps, which may be its cause
	int               most = 0;
	for (size_t i = 0; i < n; i++) {
		if (S.id[i] < 0) continue;
		int found = 0;
		eachNeighbour([&](Vec<int64_t> offset) {
			auto it = cells.find(key(i, offset));
			if (it == cells.end()) return;
			for (int32_t j : it->second) {
				if (size_t(j) == i || (known(i) && known(j))) continue;
				const double r = std::sqrt(S.distance2(i, j)), d = S.restDistance(i, j);
				if (r < 0.5 * d) overlapError(i, j, r / d);
				if (S.group[i] != S.group[j] || r >= options.linkFactor * d) continue;
				if (found < nLinks) near[i].other[found] = j, near[i].bearing[found] = Lattice::bearing(S.between(i, j));
				found++;
			}
		});
		if (found > nLinks && crowded < 0) crowded = int64_t(i), most = found;
		near[i].count = std::min(found, nLinks);
	}
	if (crowded >= 0) {
		std::ostringstream s;
		s << "automaton " << S.id[crowded] << " at " << S.position.at(crowded) << " m has " << most << " neighbours within " << options.linkFactor
		  << " diameters; the " << Lattice::name << " packing has at most " << nLinks
		  << ". The spacing of the packing does not match the diameter " << S.diameter[crowded]
		  << " m: build the packing with this spacing.";
		throw Error(s.str());
	}
	placeLinks(near, old);
	checkPlaces();
	for (size_t i = 0; i < n; i++)
		if (S.id[i] >= 0 && (S.flags[i] & linkBits) != linkBits) S.flags[i] |= exposedBit;
	makeOutlines(old);
}

/// That both ends of each link know it as one.
void Solver::checkPlaces() const
{
	const Store& S = store;
	for (size_t i = 0; i < S.size(); i++)
		for (int k = 0; k < nLinks; k++)
			if (((S.flags[i] >> k) & 1) && S.neighbour[linkSlot(S.neighbour[linkSlot(i, k)], Lattice::opposite(k))] != int32_t(i))
				throw Error(
					"automata " + std::to_string(S.id[i]) + " and " + std::to_string(S.id[S.neighbour[linkSlot(i, k)]])
					+ " see each other in directions that do not belong to one " + Lattice::name
					+ " packing; build the body as one packing.");
}

std::vector<std::pair<int32_t, int32_t>> Solver::links() const
{
	const Store&                             S = store;
	std::vector<std::pair<int32_t, int32_t>> out;
	for (size_t i = 0; i < S.size(); i++)
		for (int k = 0; k < nLinks; k++)
			if (holds(S.flags[i], k) && S.id[i] < S.id[S.neighbour[linkSlot(i, k)]]) out.push_back({ S.id[i], S.id[S.neighbour[linkSlot(i, k)]] });
	std::sort(out.begin(), out.end());
	return out;
}

void Solver::makeAdjacency()
{
	const Store& S = store;
	adjacentBegin.assign(1, 0);
	adjacent.clear();
	for (size_t b = 0; b < S.blocks.size(); b++) {
		std::vector<int32_t> near;
		for (int q = 0; q < nLinks * blockSize; q++)
			near.push_back(S.neighbour[b * nLinks * blockSize + q] / blockSize);
		std::sort(near.begin(), near.end());
		near.erase(std::unique(near.begin(), near.end()), near.end());
		for (int32_t q : near)
			if (size_t(q) != b) adjacent.push_back(q);
		adjacentBegin.push_back(int32_t(adjacent.size()));
	}
}

void Solver::classify()
{
	Store& S = store;
	for (size_t b = 0; b < S.blocks.size(); b++) {
		Block& B = S.blocks[b];
		B.intact  = B.count == blockSize;
		B.mixed   = false;
		B.outline = false;
		B.weighted = false;
		for (int l = 0; l < blockSize; l++) {
			const Flags f = S.flags[b * blockSize + l];
			if (!isWhole(f)) B.intact = false;
			B.outline |= trianglesIn(f) != 0, B.weighted |= (f & halfBits) != 0 || isMirrored(S, b * blockSize + size_t(l));
			for (int k = 0; k < nLinks; k++) {
				const int32_t j = S.neighbour[(b * nLinks + k) * blockSize + l];
				if (!holds(f, k)) continue;
				B.mixed |= S.speciesOf(j) != B.species;
				B.outline |= trianglesIn(S.flags[j]) != 0;
			}
		}
		B.intact &= !B.outline;
	}
}

void Solver::build(const std::vector<Automaton>& automata, const std::vector<Material>& materials, const Options& o, const Solver* old)
{
	for (auto& a : automata)
		check(a, materials.size());
	if (Lattice::affineOnly && o.volumeRule != VolumeRule::affine)
		throw Error(
			std::string("the volume rule must be affine in the ") + Lattice::name
			+ " packing: with inversePower its stiffness under pressure depends on the direction, with meanDistance it collapses.");
	options         = o;
	store           = Store();
	contacts        = Contacts();
	scratch         = ContactScratch();
	counters        = Counters();
	sums            = Account();
	store.materials = materials;
	flows           = false;
	for (auto& m : materials)
		flows |= m.yield.yields() && o.volumeRule == VolumeRule::affine;
	filterTime = 0;
	tied.clear(), tiedVelocity = {}, tiedSpin.clear(), watch.clear(), searched = {}, contactAdjacent.clear();
	time = lastDt = lastMove = dtLimit = contactSpeed2 = 0, lastSort = 0;
	unsettled.clear();
	makeBlocks(automata);
	makeLinks(old);
	checkOutlines(automata, old);
	makeMirrors(automata, old);
	makeAdjacency();
	classify();
	Store& S = store;
	results.assign(S.blocks.size(), {});
	works.assign(S.blocks.size(), {});
	S.packAll();
	for (size_t b = 0; b < S.blocks.size(); b++)
		volumePass(S, b, options.volumeRule, {}, true, results[b]), stressPass(S, b, options.volumeRule, 0., {}, results[b], nullptr);
	if (old) return inheritState(*old);
	// automata that enter with a plastic history keep it; nothing else is stressed
	for (auto& B : S.blocks)
		B.awake = !options.sleeping, B.moving = false;
	for (size_t i = 0; i < S.size(); i++)
		if (!isZero(S.velocity.at(i)) || !isZero(turnAt(S.omega, i))) S.blocks[i / blockSize].moving = true;
	topologyChanged = true;
	sums.kineticStart = 0;
	sums.kineticStart = account().kinetic;
	if (options.contacts) search();
	wake();
}
}
