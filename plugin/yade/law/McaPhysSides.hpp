// SPDX-License-Identifier: GPL-2.0-or-later
// Stresses of pairs and automata as McaPhys, McaState and McaLawState keep them, for the law in YADE's loop.
#pragma once
#include "../McaPhys.hpp"
#include "../McaVec.hpp"
#include <kernels/automaton/cohesion.hpp>
#include <kernels/automaton/contact.hpp>
#include <kernels/automaton/energy.hpp>
#include <kernels/automaton/force.hpp>
#include <kernels/automaton/outline.hpp>
#include <kernels/automaton/volume.hpp>

namespace yade {
namespace MCA_SPACE {

using Stress = mca::Side<Real>; ///< of one side of a pair [Pa]
using Vec    = mca::Vec<Real>;
using Turn   = mca::Turn<Real>;

inline mca::Bond bondOf(const McaPhys& p) { return { p.bondRest, p.bondStiffness, p.bondFirst, p.bondLast, p.bondMost }; }
inline void      setBond(McaPhys& p, const mca::Bond& b)
{
	p.bondRest = b.rest, p.bondStiffness = b.stiffness, p.bondFirst = b.first, p.bondLast = b.last, p.bondMost = b.most;
}

} // namespace MCA_SPACE
} // namespace yade
#if MCA_DIM == 2
#include "plane/McaPhysSides.hpp"
#else
#include "space/McaPhysSides.hpp"
#endif
