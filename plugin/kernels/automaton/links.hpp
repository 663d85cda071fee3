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

/// An exposed automaton touches an interior one, too, when it is no part of its body: debris (links that span no volume) or another group. Both may come
/// through a rim that has been stretched. Automata of one body keep to their links there.
inline bool mayTouch(Flags a, Flags b, bool sameGroup)
{
	const auto foreign = [&](Flags flags) { return linkCount(flags) < Lattice::volumeLinks || !sameGroup; };
	return a & exposedBit ? (b & exposedBit) || foreign(a) : (b & exposedBit) && foreign(b);
}
}
}
