// SPDX-License-Identifier: GPL-2.0-or-later
// What the automata solver keeps: flat arrays, one entry per automaton, in blocks of 64 that hold one species (material and diameter) each,
// ordered in space. The links of an automaton are planes of 64 inside its block; contacts are a separate list, since few automata have any.
#pragma once
#include "../kernels/automaton/contact.hpp"
#include "../kernels/automaton/force.hpp"
#include "../kernels/automaton/fracture.hpp"
#include "../kernels/automaton/links.hpp"
#include "../kernels/automaton/outline.hpp"
#include "fields.hpp"
#include "pair_rules.hpp"
#include "sides.hpp"
#include "vectors.hpp"
#include <algorithm>
#include <cstdint>
#include <vector>

namespace mca::automata {

struct Species {
	int    material = 0;
	double d        = 0; ///< diameter [m]
};

struct Block {
	int32_t species = 0;
	int32_t count   = 0;     ///< automata in it; lanes above are padding
	bool    intact  = false; ///< every lane holds all links with full weight, and no outline is near
	bool    outline = false; ///< some automaton, or one that it is linked to, ends at an outline
	bool    mixed   = false; ///< some link leads to another species
	bool    weighted = false; ///< some link counts less than a whole one, or some automaton lies on a plane of symmetry
	bool    contact = false; ///< some automaton has contacts
	bool    awake   = true;
	bool    moving  = true; ///< some velocity is or was not exactly zero
	bool    ringsAwake = false; ///< the blocks around it have been woken
};

struct Store : LinkStresses {
#define MCA_NUMBER(name, type, presence, shown, text) std::vector<type> name;
#define MCA_VECTOR(name, presence, scripts, text, ...) Vectors name;
	MCA_AUTOMATON_FIELDS(MCA_NUMBER, MCA_VECTOR)
#undef MCA_VECTOR
#undef MCA_NUMBER
	// links: nLinks planes per block
	std::vector<int32_t> neighbour; ///< automaton at the other end, itself where there is none; there the same link is Lattice::opposite(k)
	// records that neighbours read; rebuilt in every step, so not part of the saved state
	std::vector<double> node; ///< nodeSize per automaton: position, velocity, omega; in the plane dTheta and what the account needs of the pressures, too
	std::vector<double> push; ///< pushSize per automaton, affine rule: with what links are pushed
	/// All records anew: after building, sorting, loading.
	void packAll()
	{
		node.assign(size() * nodeSize, 0.);
		push.resize(size() * pushSize, 0.);
		for (size_t b = 0; b < blocks.size(); b++)
			packBlock(b);
	}
	/// Copies motion into the records of a block.
	void packBlock(size_t b);
	std::vector<Block>   blocks;
	std::vector<Species> species;
	std::vector<Material> materials;

	size_t  size() const { return id.size(); }
	int32_t speciesOf(size_t i) const { return blocks[i / blockSize].species; }
	double  largestDiameter() const ///< [m]
	{
		double most = 0;
		for (const Species& sp : species) most = std::max(most, sp.d);
		return most;
	}
	/// of the pair of this species with automaton j [Pa]; q = arm of this side / distance
	double pairTwoG(int32_t mine, size_t j, double q) const
	{
		return seriesTwoG(materials[species[mine].material].G, materials[species[speciesOf(j)].material].G, q);
	}
	PairRules       pairRules; ///< of materials
	const PairRule& ruleOf(int32_t mine, int32_t other) const { return pairRules.of(species[mine].material, species[other].material); }
	PairViscosity pairViscosity(int32_t mine, size_t j) const
	{
		return viscosityOf(materials[species[mine].material], materials[species[speciesOf(j)].material], ruleOf(mine, speciesOf(j)));
	}
	const Material& materialOf(const Block& b) const { return materials[species[b.species].material]; }
	const Material& materialOf(size_t i) const { return materials[species[speciesOf(i)].material]; }
	Vec<double>     between(size_t i, size_t j) const { return position.at(j) - position.at(i); }        ///< from i to j [m]
	double          distance2(size_t i, size_t j) const { return plainSquare(between(i, j)); }           ///< [m2]
	double          restDistance(size_t i, size_t j) const { return 0.5 * (diameter[i] + diameter[j]); } ///< [m]

	/// f(array, presence) for every array with one entry per automaton
	template <class F> void eachArray(F&& f)
	{
#define MCA_NUMBER(name, type, presence, shown, text) f(name, Presence::presence);
#define MCA_VECTOR(name, presence, scripts, text, ...) \
	for (auto& plane : name) f(plane, Presence::presence);
		MCA_AUTOMATON_FIELDS(MCA_NUMBER, MCA_VECTOR)
#undef MCA_VECTOR
#undef MCA_NUMBER
	}
	/// f(name for scripts, array) for every array that McaEngine.field() shows
	template <class F> void eachShown(F&& f) const
	{
		const auto components = [&](Scripts scripts, const Vectors& v, std::initializer_list<const char*> names) {
			for (int c = 0; scripts == Scripts::shown && c < dim; c++) f(names.begin()[c], v[c]);
		};
#define MCA_NUMBER(name, type, presence, shown, text) \
	if (*shown) f(shown, name);
#define MCA_VECTOR(name, presence, scripts, text, ...) components(Scripts::scripts, name, { __VA_ARGS__ });
		MCA_AUTOMATON_FIELDS(MCA_NUMBER, MCA_VECTOR)
#undef MCA_VECTOR
#undef MCA_NUMBER
	}
};

/// Half-contacts: every contact stands twice, once for each side, sorted by owner; rows of one owner are contiguous.
struct Contacts {
#define MCA_NUMBER(name, type, presence, text) std::vector<type> name;
#define MCA_VECTOR(name, presence, text, ...) Vectors name;
	MCA_CONTACT_FIELDS(MCA_NUMBER, MCA_VECTOR)
#undef MCA_VECTOR
#undef MCA_NUMBER
	std::vector<int32_t> rowOwner, rowBegin; ///< rows: owner and first half-contact; rowBegin has one entry more
	size_t               size() const { return owner.size(); }
	size_t               rows() const { return rowOwner.size(); }
	/// f(array, presence) for every array with one entry per half-contact
	template <class F> void eachArray(F&& f)
	{
#define MCA_NUMBER(name, type, presence, text) f(name, Presence::presence);
#define MCA_VECTOR(name, presence, text, ...) \
	for (auto& plane : name) f(plane, Presence::presence);
		MCA_CONTACT_FIELDS(MCA_NUMBER, MCA_VECTOR)
#undef MCA_VECTOR
#undef MCA_NUMBER
	}
	/// What a step fills anew; sized by the search.
	void sizeScratch()
	{
		eachArray([&](auto& v, Presence p) {
			if (p == Presence::scratch) v.resize(size());
		});
	}
};

inline void Store::packBlock(size_t b)
{
	for (size_t i = b * blockSize; i < (b + 1) * blockSize; i += lanes) packRecords(*this, node.data() + i * nodeSize, i);
}
}
