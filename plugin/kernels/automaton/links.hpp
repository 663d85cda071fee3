// SPDX-License-Identifier: GPL-2.0-or-later
// What an automaton knows of its links, as bits of one number.
#pragma once
#include "../lattice.hpp"
#include <cstdint>

namespace mca {
inline namespace MCA_SPACE {

using Flags = Lattice::Flags;
enum Flag : Flags {
	linkBits     = (Flags(1) << nLinks) - 1, ///< bit k: link k holds
	halfShift    = Lattice::flagField,       ///< bits from here: link k counts half (on a weighted rim)
	halfBits     = linkBits << halfShift,
	hadShift     = 2 * Lattice::flagField,                ///< bits from here: link k once held (a broken pair stays broken)
	exposedBit   = Flags(1) << 3 * Lattice::flagField,       ///< may touch something: rim, broken or flowing
	tiedBit      = Flags(1) << (3 * Lattice::flagField + 1), ///< carried by the grid
	outlineShift = 3 * Lattice::flagField + 2,            ///< bits from here: see outline.hpp
	edgeBits     = dim == 3 ? linkBits << outlineShift : 0, ///< link k counts but a quarter (along the edge of two faces); its bit of halfBits is set, too
};
static_assert(nLinks <= Lattice::flagField, "the bits of the links overlap");

inline bool   holds(Flags flags, int k) { return (flags >> k) & 1; }
inline bool   hasHeld(Flags flags, int k) { return (flags >> (hadShift + k)) & 1; }
inline bool   alongEdge(Flags flags, int k) { return dim == 3 && (flags >> (outlineShift + k)) & 1; }
inline double linkWeight(Flags flags, int k) { return (flags >> (halfShift + k)) & 1 ? (alongEdge(flags, k) ? 0.25 : 0.5) : 1.; }
inline int    linkCount(Flags flags) { return __builtin_popcount(unsigned(flags & linkBits)); }
inline int    brokenCount(Flags flags) { return __builtin_popcount(unsigned((flags >> hadShift) & linkBits)) - linkCount(flags); }
/// All links, with full weight.
inline bool isWhole(Flags flags) { return (flags & (linkBits | halfBits)) == linkBits; }
/// All bits of link k.
constexpr Flags slotBits(int k)
{
	return (Flags(1) << k) | (Flags(1) << (halfShift + k)) | (Flags(1) << (hadShift + k)) | (edgeBits & Flags(1) << (outlineShift + k));
}

/// Whether two automata are held apart by a neighbour that both are linked to, as long as both have a volume by their links: in strong compression they come
/// closer than a contact may be, and are parts of one body all the same. Not those that were linked themselves. ofA(k), ofB(k): at the other end of a link of a
/// or b; factorA, factorB: of their volumes.
template <class Id, class A, class B> bool heldByNeighbour(Id a, Flags flagsA, double factorA, A&& ofA, Id b, Flags flagsB, double factorB, B&& ofB)
{
	if (!Lattice::neighboursHold || !(factorA > 0.) || !(factorB > 0.)) return false;
	bool common = false;
	for (int k = 0; k < nLinks; k++) {
		if ((hasHeld(flagsA, k) && ofA(k) == b) || (hasHeld(flagsB, k) && ofB(k) == a)) return false;
		for (int l = 0; holds(flagsA, k) && l < nLinks; l++) common |= holds(flagsB, l) && ofA(k) == ofB(l);
	}
	return common;
}

/// An exposed automaton touches an interior one, too, when it is no part of its body: debris (links that span no volume) or another group. Both may come
/// through a rim that has been stretched. Automata of one body keep to their links there.
inline bool mayTouch(Flags a, Flags b, bool sameGroup)
{
	const auto foreign = [&](Flags flags) { return linkCount(flags) < Lattice::volumeLinks || !sameGroup; };
	return a & exposedBit ? (b & exposedBit) || foreign(a) : (b & exposedBit) && foreign(b);
}
}
}
