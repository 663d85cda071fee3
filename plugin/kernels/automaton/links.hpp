// SPDX-License-Identifier: GPL-2.0-or-later
// What an automaton knows of its links, as bits of one number.
#pragma once
#include "../lattice.hpp"
#include <cstdint>

namespace mca {

enum Flag : int32_t {
	linkBits   = (1 << nLinks) - 1, ///< bit k: link k holds
	halfShift  = 8,                 ///< bits from here: link k counts half (on a weighted rim)
	halfBits   = linkBits << halfShift,
	hadShift   = 16,      ///< bits from here: link k once held (a broken pair stays broken)
	exposedBit = 1 << 24, ///< may touch something: rim, broken or flowing
	tiedBit    = 1 << 25, ///< carried by the grid
	outlineShift = 26,    ///< bits from here: triangle k belongs to the body, see outline.hpp
};
constexpr uint32_t outlineBits = uint32_t(linkBits) << outlineShift;
static_assert(halfShift + nLinks <= hadShift && hadShift + nLinks <= 24, "the bits of the links overlap");
static_assert(outlineShift + nLinks <= 32, "the bits of the triangles do not fit");

inline bool   holds(int32_t flags, int k) { return (flags >> k) & 1; }
inline bool   hasHeld(int32_t flags, int k) { return (flags >> (hadShift + k)) & 1; }
inline double linkWeight(int32_t flags, int k) { return (flags >> (halfShift + k)) & 1 ? 0.5 : 1.; }
inline int    linkCount(int32_t flags) { return __builtin_popcount(unsigned(flags & linkBits)); }
inline int    brokenCount(int32_t flags) { return __builtin_popcount(unsigned((flags >> hadShift) & linkBits)) - linkCount(flags); }
/// All links, with full weight.
inline bool isWhole(int32_t flags) { return (flags & (linkBits | halfBits)) == linkBits; }
/// All bits of link k.
constexpr int32_t slotBits(int k) { return (1 << k) | (1 << (halfShift + k)) | (1 << (hadShift + k)); }

/// An exposed automaton touches an interior one, too, when it is no part of its body: debris (links that span no volume) or another group. Both may come
/// through a rim that has been stretched. Automata of one body keep to their links there.
inline bool mayTouch(int32_t a, int32_t b, bool sameGroup)
{
	const auto foreign = [&](int32_t flags) { return linkCount(flags) < 3 || !sameGroup; };
	return a & exposedBit ? (b & exposedBit) || foreign(a) : (b & exposedBit) && foreign(b);
}
}
