// SPDX-License-Identifier: GPL-2.0-or-later
// In how many dimensions the automata move: 2 in plane strain, 3 in space. What depends on it is compiled for each, in a namespace of its own inside mca, so
// that one library holds both: what needs vectors is written once, what differs in kind stands in the folders plane and space under the same names.
#pragma once

#ifndef MCA_DIM
#define MCA_DIM 2
#endif
#if MCA_DIM == 2
#define MCA_SPACE plane
#elif MCA_DIM == 3
#define MCA_SPACE space
#else
#error "MCA_DIM must be 2 or 3"
#endif

namespace mca {
inline namespace MCA_SPACE {
	constexpr int dim = MCA_DIM;
	namespace automata { } // opened here, so that mca::automata is that of this dimension wherever it is opened again
}
}
