// SPDX-License-Identifier: GPL-2.0-or-later
// What crosses the interface in a step: masses once, forces of the row to the nodes, motion of the nodes to the row. The transposed interpolation
// carries the forces, so momentum and work are the same on both sides whatever the forces are; on a straight edge so is angular momentum.
// It knows forces, velocities and positions only, not who computed them.
#pragma once
#include "../grid/boundary.hpp"
#include "../kernels/vector.hpp"
#include "map.hpp"

namespace mca::interface {

struct Motion {
	Vec<double> position, velocity; ///< [m], [m/s]
};

/// Position and velocity of a carried automaton.
inline Motion motion(const Carried& c, const grid::OpenNodes& n)
{
	const size_t a = size_t(c.a), b = size_t(c.b);
	return { { (c.Na * n.x[a] + c.Nb * n.x[b]) + c.rx, (c.Na * n.y[a] + c.Nb * n.y[b]) + c.ry },
		 { c.Na * n.vx[a] + c.Nb * n.vx[b], c.Na * n.vy[a] + c.Nb * n.vy[b] } };
}

/// Force [N/m] on a carried automaton to the ends of its edge.
inline void addForce(const Carried& c, Vec<double> f, grid::OpenNodes& n)
{
	n.ex[size_t(c.a)] += c.Na * f[0], n.ey[size_t(c.a)] += c.Na * f[1];
	n.ex[size_t(c.b)] += c.Nb * f[0], n.ey[size_t(c.b)] += c.Nb * f[1];
}

/// Mass to add to each node [kg/m], as (node, mass), ascending nodes: row sums of the interpolated mass. A lumped mass is never below the
/// consistent one, so the tied nodes are stable at any step that is stable for both sides alone.
MCA_API std::vector<std::pair<int, double>> nodeMasses(const std::vector<Carried>& row);
}
