// SPDX-License-Identifier: GPL-2.0-or-later
// Which automaton hangs on which edge of the grid: made once from geometry. Plane strain, SI units.
#pragma once
#include "../kernels/api.hpp"
#include "../kernels/error.hpp"
#include "../kernels/material.hpp"
#include <string>
#include <vector>

namespace mca::interface {

/// An automaton that may belong to the row.
struct RowPoint {
	int             id       = 0;
	double          x = 0, y = 0;  ///< centre [m]
	double          diameter = 0;  ///< [m]
	double          mass     = 0;  ///< [kg/m]
	double          weight   = 0;  ///< share of its full cell [-]
	const Material* material = nullptr;
};

/// The side it is tied to: nodes in order along the side.
struct SideNodes {
	std::string         block;       ///< name, for messages
	std::vector<int>    node;        ///< numbers of open nodes
	std::vector<double> x, y;        ///< [m]
	double              inX = 0, inY = 0; ///< a point inside the block next to the side [m]
	const Material*     material = nullptr;
};

struct MapOptions {
	double tolerance      = 1e-4; ///< allowed distance from the line and deviation of the spacing, over the diameter [-]
	double smallestRatio  = 0.5;  ///< edge of the grid over the diameter [-]
	double largestRatio   = 4.5;
	bool   otherMaterials = false; ///< allow unlike densities and moduli on the two sides
	bool   onlyGiven      = false; ///< the points are the row; otherwise it is picked from all automata by geometry
};

/// x = Na X_a + Nb X_b + (rx, ry), Na + Nb = 1.
struct Carried {
	int    id = 0, a = 0, b = 0; ///< automaton; open nodes at the ends of its edge
	double Na = 0, Nb = 0;       ///< linear interpolation on the edge [-]
	double rx = 0, ry = 0;       ///< what the interpolation leaves at set-up: round-off, at most the tolerance [m]
	double mass = 0;             ///< [kg/m]
};

/// The row on the side, in order along it. Throws Error naming bodies and distances: side not straight, row off the line, gap, overlap, full weight,
/// unlike materials, edge length out of range, nothing there.
MCA_API std::vector<Carried> makeMap(const std::vector<RowPoint>& points, const SideNodes& side, const MapOptions& options);

/// A map that was read from a file: throws Error unless nodes are below openNodes, shares add to 1, numbers are finite and no automaton stands there twice.
MCA_API void checkRow(const std::vector<Carried>& row, int openNodes);
}
