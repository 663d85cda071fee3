// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts: pairs that are not linked. The search looks only at automata that may touch something (rim, broken, flowing);
// the passes run over half-contacts as one flat list and add up the rows of each owner in a fixed order.
#pragma once
#include "cell_grid.hpp"
#include "passes.hpp"

namespace mca::automata {

/// Arrays of one entry per automaton that the contact passes fill for the passes over links.
struct ContactScratch {
#define MCA_NUMBER(name, presence, text) std::vector<double> name;
#define MCA_VECTOR(name, presence, text, ...) Vectors name;
	MCA_CONTACT_SUMS(MCA_NUMBER, MCA_VECTOR)
#undef MCA_VECTOR
#undef MCA_NUMBER
	std::vector<double> terms; ///< per half-contact
	struct Shared {
		int32_t contact; ///< half
		double  share;
	};
	std::vector<Shared> shared; ///< contacts within planes of symmetry, of which a share is on this side (S9); made anew in each step
	void                resize(size_t n, bool account)
	{
		eachArray([&](auto& v, Presence p) {
			if (p == Presence::always || account) v.resize(n, 0.);
		});
	}
	/// f(array, presence) for every array with one entry per automaton
	template <class F> void eachArray(F&& f)
	{
#define MCA_NUMBER(name, presence, text) f(name, Presence::presence);
#define MCA_VECTOR(name, presence, text, ...) \
	for (auto& plane : name) \
		f(plane, Presence::presence);
		MCA_CONTACT_SUMS(MCA_NUMBER, MCA_VECTOR)
#undef MCA_VECTOR
#undef MCA_NUMBER
	}
};

/// Boxes around the automata of each block: whose are near a place is found without looking at all.
struct BlockBoxes {
	Vectors low, high; ///< [m]
	/// Around these places.
	void make(const Store& S, const Vectors& at);
	/// f(block) for those that have a point within `reach` in each direction.
	template <class F> void eachNear(Vec<double> x, double reach, F&& f) const
	{
		for (size_t b = 0; b < low.size(); b++) {
			bool near = true;
			for (int c = 0; c < dim; c++)
				near &= x[c] >= low[c][b] - reach && x[c] <= high[c][b] + reach;
			if (near) f(b);
		}
	}
};

/// The exposed automata, and the interior ones that have something foreign in their cell or in one around it, in the order of the arrays.
std::vector<int32_t> watched(const Store& S, const Vectors& place, const std::vector<int32_t>& exposed, const Cells& cells);
/// New list of contacts from all exposed automata (in the order of the arrays) that were closer than (1 + skin) times their rest distance when they were at
/// these places; stresses of pairs that go on are kept. `old` becomes the list before.
/// Deterministic: rows in the order of the arrays, entries of a row in the order of their callers' numbers.
void searchContacts(Store& S, const Vectors& place, const std::vector<int32_t>& exposed, Contacts& C, Contacts& old, double skin, int threads);
/// The list that searchContacts() would make of the same places after links have broken, from the one before. ends: of those links, ascending;
/// boxes: around the places.
void addContacts(Store& S, const Vectors& at, const BlockBoxes& boxes, const std::vector<int32_t>& ends, Contacts& C, double skin);

/// Fills perTwoG and perOwnG, which are not part of the saved state.
void contactReciprocals(const Store& S, Contacts& C);
/// Geometry of this step and volume terms: fills scratch.sum. Returns (r/d)^2 of the closest contact; closest: its place in the list when it is too deep.
double contactVolumes(const Store& S, Contacts& C, VolumeRule rule, ContactScratch& out, size_t& closest);
/// Trial stresses; fills scratch.square, and for the account scratch.old, the products of old and trial stresses. Returns the largest relative speed squared
/// [m2/s2] of listed pairs.
double contactTrial(const Store& S, Contacts& C, double dt, ContactScratch& out, bool account);
/// Pressure of the pairs that push, from the volumes after the density pass.
void contactPressure(const Store& S, Contacts& C, VolumeRule rule);
/// Radial return by scratch.scale, then no tension and Coulomb friction.
void contactFriction(const Store& S, Contacts& C, const ContactScratch& in, ContactWork* work);
/// Forces; fills scratch.force, torque (and the shares of pressure and viscosity for the account).
void contactForces(Contacts& C, ContactScratch& out, bool account);
}
